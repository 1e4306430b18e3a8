//! Forms of printed results.

use clap::ValueEnum;

/// Form of printed results.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Format {
    /// Tables for people
    Text,
    /// One JSON document
    Json,
    /// One JSON document per line and run
    Jsonl,
}
