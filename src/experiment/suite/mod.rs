//! Many runs at once: threads, files, what an earlier suite left, and the moment it ends.

mod against;
mod conclude;
mod entry;
mod files;
mod ledger;
mod options;
mod outcome;
mod output;
mod resume;
mod runner;
mod threads;
mod write;

pub use against::Against;
pub use options::{Earlier, Resume, SuiteOptions};
pub use outcome::{Observer, SuiteError, SuiteOutcome};
pub use runner::run_suite;
pub use threads::{THREADS_MAX, start_threads, thread_count};
pub use write::write_runs;
