//! Campaigns over inputs nobody thought of: generated scenarios, kills and simultaneous runs.
//!
//! In `cargo test` each is small. At length they are run by hand, one test at a time:
//!
//! ```text
//! FOGBENCH_SCENARIOS=20000 FOGBENCH_SEED=7 cargo test --test integration campaign::scenarios -- --nocapture
//! ```
//!
//! A failing case prints its seed, and its file is kept below the target folder. `FOGBENCH_CASE`
//! draws one case again by that seed.

mod case;
mod draft;
mod generator;
mod hints;
mod invariants;
mod kills;
mod pairs;
mod scenarios;
pub(crate) mod schema;
mod tally;
mod texts;
mod values;
mod watchdog;
mod yard;

use std::str::FromStr;

/// A number from the environment, or the one of the small form.
fn setting<T: FromStr>(name: &str, small: T) -> T {
    match std::env::var(name) {
        Ok(text) => text
            .parse()
            .unwrap_or_else(|_| panic!("{name} = {text} is not a number")),
        Err(_) => small,
    }
}
