//! Pages for a browser: a run and a suite, each in one file that asks nothing of anyone.
//!
//! What a scenario says is text and never markup: every value goes through the escaping of the templates.
//! All can be read without the script, which sorts, filters and reads values under the cursor.

pub(super) mod against;
pub(super) mod beside;
mod channels;
mod document;
mod gates;
pub(super) mod infer;
pub(super) mod pictures;
mod repeats;
pub(super) mod run;
pub(super) mod suite;
mod units;
