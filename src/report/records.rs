//! The data sheet of the reference records.

use std::fmt::Write as _;

use crate::gate::{estimate_text, plain};
use crate::metrics::{Estimate, three_digits};
use crate::signal::GyroFacts;

/// Digits of an interval's half width.
const DIGITS: i32 = 2;

/// A record in the data sheet.
#[derive(Clone, Debug)]
pub struct RecordLine {
    /// Name of its folder.
    pub name: &'static str,
    /// What it is of.
    pub about: &'static str,
    /// Seed of its noise.
    pub seed: u32,
    /// Words a second, Hz.
    pub rate_hz: f64,
    /// Words.
    pub words: usize,
    /// Mean of the words.
    pub mean_deg_per_h: Option<Estimate>,
    /// Standard deviation of their noise.
    pub noise_deg_per_h: Option<Estimate>,
}

/// What the data sheet tells.
#[derive(Clone, Copy, Debug)]
pub struct RecordSheet<'a> {
    /// The gyro in closed form.
    pub facts: Option<&'a GyroFacts>,
    /// Columns of every record with what they hold.
    pub columns: &'a [(&'static str, &'static str)],
    /// The records.
    pub lines: &'a [RecordLine],
    /// Name of the file of checksums.
    pub checksums: &'a str,
}

/// The data sheet as Markdown.
#[must_use]
pub fn record_sheet(sheet: &RecordSheet) -> String {
    let mut text = format!(
        "# Reference records of a closed-loop fibre-optic gyro\n\n\
         Words of a simulated gyro on a rate table, each record with its true rate: written by `fogbench records`, \
         version {}. The same version writes the same bytes. Each folder holds a record as `record.csv`, each column \
         of it as an NPY file of binary64, and the scenario that made it: `fogbench run <folder>/scenario.toml` \
         makes it again. The warm-up of a scenario is left out.\n\n",
        env!("CARGO_PKG_VERSION")
    );
    text += "## Records\n\n| folder | what | seed | rate (Hz) | words | mean (deg/h) | noise of a word (deg/h) |\n\
             |---|---|---|---|---|---|---|\n";
    for line in sheet.lines {
        let figure = |estimate: Option<Estimate>| {
            estimate.map_or_else(|| "-".to_owned(), |known| estimate_text(&known, DIGITS))
        };
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "| `{}` | {} | {} | {} | {} | {} | {} |",
            line.name,
            line.about,
            line.seed,
            plain(line.rate_hz),
            line.words,
            figure(line.mean_deg_per_h),
            figure(line.noise_deg_per_h)
        );
    }
    text += "\n## Columns\n\n| column | holds |\n|---|---|\n";
    for (name, holds) in sheet.columns {
        let _ = writeln!(text, "| `{name}` | {holds} |");
    }
    if let Some(facts) = sheet.facts {
        text += &gyro(facts);
    }
    text += "\n## Measure of a filter\n\n\
             Compare its words with `truth_deg_per_h`, not with a fit to `raw_deg_per_h`: noise and the gain for a small \
             rate at rest, delay and gain on the swings, settling on the steps, and say its memory and whether it looks \
             ahead. `fogbench filter <folder>/record.csv --column raw_deg_per_h --reference-column truth_deg_per_h` does.\n";
    let _ = write!(
        text,
        "\n## Checksums\n\n`{}` has the BLAKE3 digest of every file: `b3sum --check {0}`.\n",
        sheet.checksums
    );
    text
}

/// What the gyro is in closed form.
fn gyro(facts: &GyroFacts) -> String {
    let mut text = "\n## Gyro\n\n| property | value |\n|---|---|\n".to_owned();
    let budget = facts.angle_random_walk_budget_deg_per_sqrt_h.last();
    let rows = [
        ("Sagnac scale factor", facts.scale_factor_s, "s"),
        ("transit time of the coil", facts.transit_time_us, "us"),
        ("loop bandwidth", facts.loop_bandwidth_hz, "Hz"),
        ("delay of a word", facts.delay_ms, "ms"),
    ];
    let walk = budget.map(|(_, walk)| ("angle random walk", *walk, "deg/sqrt(h)"));
    for (name, value, unit) in rows.into_iter().chain(walk) {
        let _ = writeln!(text, "| {name} | {} {unit} |", three_digits(value));
    }
    text
}
