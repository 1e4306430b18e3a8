//! Suites: order, interruption, parts, folders and their files on disk.

mod determinism;
mod flush_order;
mod growth;
mod interruption;
mod outcomes;
mod output_folder;
mod records;
mod resume;
mod selection;
mod shards;
