//! `fogbench claim`: what reads the same as a claimed reduction of noise.

use std::io;

use crate::cli::options::claim::ClaimOptions;
use crate::cli::options::format::Format;
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;
use crate::report::{claim_json, claim_text};

/// Prints the gain and the low passes that would give the same figure.
pub(in crate::cli) fn claim(options: &ClaimOptions) -> io::Result<Exit> {
    let claim = options.claim();
    output::data(&match options.format {
        Format::Text => claim_text(&claim, options.rate_hz),
        Format::Json => claim_json(&claim, options.rate_hz),
        Format::Jsonl => {
            let text = claim_json(&claim, options.rate_hz);
            let document: serde_json::Value = serde_json::from_str(&text)?;
            format!("{document}\n")
        }
    })?;
    Ok(Exit::Success)
}
