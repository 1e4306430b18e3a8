//! Forms of printed results.

use std::io;

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

impl Format {
    /// What a command prints of one result: its tables, or its document as it is or on one line.
    ///
    /// # Errors
    ///
    /// The document is no JSON.
    pub(in crate::cli) fn of(
        self,
        tables: impl FnOnce() -> String,
        document: impl FnOnce() -> String,
    ) -> io::Result<String> {
        Ok(match self {
            Self::Text => tables(),
            Self::Json => document(),
            Self::Jsonl => {
                let document: serde_json::Value = serde_json::from_str(&document())?;
                format!("{document}\n")
            }
        })
    }
}
