//! Folders of results: whose they are, one writer at a time, swapped whole.
//!
//! Every folder written carries a record of its files with their BLAKE3 digests, in `manifest.toml` where
//! there is one, else in `.fogbench.toml`. What a record does not tell of belongs to the user, and nothing
//! of the user's is replaced unless asked for. What is being written, the lock of the writer and the
//! journals of what a kill may cut short stand in `.fogbench/` of the output folder, and nowhere else.
//!
//! Invariant: knows files and digests, not what they mean; imports nothing of the crate but `seal`.

mod error;
mod files;
mod flush;
mod journal;
mod legacy;
mod lock;
mod output_folder;
mod ownership;
mod program_log;
mod record;
mod shard_slot;
mod single_file;
mod staged;
mod suite_files;
mod swap;
mod sweep_files;
mod update;

pub use error::{Foreign, Spared, StoreError};
pub use files::{put_npy, write_npy};
pub use output_folder::{OutputFolder, StoreOptions, refuse_theirs};
pub use ownership::{Ownership, holds_result, inspect};
pub use program_log::ProgramLog;
pub use record::{Head, MANIFEST_FILE, RECORD_FILE, Record, digest_of};
pub use shard_slot::{
    HeldFolder, ShardSlot, ShardWork, TakeRecord, WORK_SUFFIX, holder_of_place, open_place,
    read_records, record_path,
};
pub use single_file::SingleFile;
pub use staged::Staged;
pub use suite_files::SuiteFileNames;
pub use swap::Swap;
pub use sweep_files::sweep_files;

/// Folder of the lock, the journals and what is being written.
pub const WORKSHOP: &str = ".fogbench";
