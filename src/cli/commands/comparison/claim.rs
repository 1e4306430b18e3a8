//! `fogbench claim`: what reads the same as a claimed reduction of noise.

use std::io;

use crate::cli::options::claim::ClaimOptions;
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;
use crate::report::{claim_json, claim_text};

/// Prints the gain and the low passes that would give the same figure.
pub(in crate::cli) fn claim(options: &ClaimOptions) -> io::Result<Exit> {
    let claim = options.claim();
    output::data(&options.format.of(
        || claim_text(&claim, options.rate_hz),
        || claim_json(&claim, options.rate_hz),
    )?)?;
    Ok(Exit::Success)
}
