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
pub(crate) use conclude::layout;
pub(crate) use entry::{Suite, enter_files, enter_report, files_of_result};
pub(crate) use files::{Names, failed, report_of_plan, signals};
pub(crate) use ledger::{Ledger, wait};
pub use options::{Earlier, Resume, SuiteOptions};
pub use outcome::{Observer, SuiteError, SuiteOutcome};
pub(crate) use output::SuiteOutput;
pub use runner::run_suite;
pub(crate) use runner::{conduct, enter_failure, enter_unwritten, panic_text};
pub(crate) use threads::pool;
pub use threads::{THREADS_MAX, start_threads, thread_count};
pub use write::write_runs;
