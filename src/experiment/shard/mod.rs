//! A suite in parts that run anywhere, in any order: the numbered list, the file of each shard, and their
//! merge into what one suite would have written.

mod codec;
mod estimate;
mod file;
mod gather;
mod list;
mod listing;
mod measured;
mod merge;
mod plan_file;
mod result;
mod run;

pub use estimate::estimated_s;
pub use file::{Damaged, Selected, ShardHead};
pub use gather::{GatherError, Gathered, ShardStatus, ranges_text, shard_status};
pub use list::RunList;
pub use listing::{Listing, Wanted, list_suite};
pub use merge::merge_shards;
pub use plan_file::{PlanFile, PlanFileError};
pub use run::{ShardError, ShardObserver, ShardOptions, ShardOutcome, run_shard};
