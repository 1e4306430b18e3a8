//! The reference records: a seeded set of words of one gyro with their truth, for others to publish against.
//!
//! Each record is a scenario that stands in its folder beside the words, so that it can be run again, changed
//! or put before any filter. The same version of the program writes the same bytes.

use std::fmt::Write as _;

use super::run::{Run, RunError};
use super::scenario::Scenario;
use crate::gyro::{coil_temperatures_c, facts};
use crate::metrics::MetricKey;
use crate::metrics::catalogue::{MEAN, NOISE_STD};
use crate::report::{RecordLine, RecordSheet, record_sheet};
use crate::seal::digest_of_bytes;
use crate::signal::GyroFacts;
use crate::store::{Staged, StoreError, put_npy};
use crate::units::rad_to_arcsec;

/// File of the data sheet.
const SHEET: &str = "datasheet.md";

/// File of the checksums.
const CHECKSUMS: &str = "checksums.txt";

/// What every record has in common: the default gyro on a table with an encoder.
const COMMON: &str = "fidelity = \"rate\"\n\n[turntable.encoder]\nresolution_arcsec = 0.36\n";

/// A record of the set.
#[derive(Clone, Copy, Debug)]
pub struct ReferenceRecord {
    /// Name of its folder.
    pub name: &'static str,
    /// What it is of.
    pub about: &'static str,
    seed: u32,
    duration_s: f64,
    warm_up_s: f64,
    /// Tables of the scenario beside [`COMMON`].
    tables: &'static str,
}

/// The set.
#[must_use]
pub fn reference_records() -> &'static [ReferenceRecord] {
    &RECORDS
}

static RECORDS: [ReferenceRecord; 9] = [
    ReferenceRecord {
        name: "rest",
        about: "at rest for a thousand seconds, each word a mean of a hundred",
        seed: 1,
        duration_s: 1000.0,
        warm_up_s: 10.0,
        tables: "[turntable.static]\n\n[gyro.output]\naverage_samples = 100\n",
    },
    ReferenceRecord {
        name: "rest-fast",
        about: "at rest, every word",
        seed: 2,
        duration_s: 20.0,
        warm_up_s: 5.0,
        tables: "[turntable.static]\n",
    },
    ReferenceRecord {
        name: "swing-1hz",
        about: "a swing of 1 deg/s at 1 Hz",
        seed: 3,
        duration_s: 10.0,
        warm_up_s: 5.0,
        tables: "[turntable.swing]\nrate_amplitude_deg_per_s = 1.0\nfrequency_hz = 1.0\n",
    },
    ReferenceRecord {
        name: "swing-5hz",
        about: "a swing of 1 deg/s at 5 Hz",
        seed: 4,
        duration_s: 10.0,
        warm_up_s: 5.0,
        tables: "[turntable.swing]\nrate_amplitude_deg_per_s = 1.0\nfrequency_hz = 5.0\n",
    },
    ReferenceRecord {
        name: "swing-slow",
        about: "a swing of 0.01 deg/s at 0.2 Hz, near the noise of a word",
        seed: 5,
        duration_s: 20.0,
        warm_up_s: 5.0,
        tables: "[turntable.swing]\nrate_amplitude_deg_per_s = 0.01\nfrequency_hz = 0.2\n",
    },
    ReferenceRecord {
        name: "steps",
        about: "steps to 0.01, 0, 1, -1 and 10 deg/s, two seconds at each",
        seed: 6,
        duration_s: 12.0,
        warm_up_s: 5.0,
        tables: "[turntable.steps]\nrates_deg_per_s = [0.0, 0.01, 0.0, 1.0, -1.0, 10.0]\ndwell_s = 2.0\n",
    },
    ReferenceRecord {
        name: "warm-up",
        about: "the first half hour of a gyro that heats itself by 8 K, each word a mean of a thousand",
        seed: 7,
        duration_s: 1800.0,
        warm_up_s: 0.0,
        tables: "[turntable.static]\n\n[gyro.output]\naverage_samples = 1000\n\n[gyro.thermal]\n\
                 self_heating_c = 8.0\nwarm_up = \"cold\"\nbias_deg_per_h_per_c_per_min = 0.02\n",
    },
    ReferenceRecord {
        name: "vibration-sine",
        about: "at rest in a vibration of 1 g and 0.01 deg/s at 300 Hz, which the truth leaves out",
        seed: 8,
        duration_s: 10.0,
        warm_up_s: 5.0,
        tables: "[turntable.static]\n\n[gyro.vibration.sine]\nfrequency_hz = 300.0\nacceleration_g = 1.0\n\
                 rate_amplitude_deg_per_s = 0.01\n",
    },
    ReferenceRecord {
        name: "vibration-random",
        about: "at rest in a vibration of 0.01 g^2/Hz from 20 to 2000 Hz, which the truth leaves out",
        seed: 9,
        duration_s: 10.0,
        warm_up_s: 5.0,
        tables: "[turntable.static]\n\n[gyro.vibration.random]\nfrom_hz = 20.0\nto_hz = 2000.0\n\
                 acceleration_psd_g2_per_hz = 0.01\n",
    },
];

/// A column of a record: name of its file and heading, and what it holds.
type Column = (&'static str, &'static str);

/// The columns, in the order of the CSV file.
const COLUMNS: [Column; 5] = [
    ("time_s", "end of the word, from the start of the record, s"),
    ("raw_deg_per_h", "word of the gyro, deg/h"),
    (
        "truth_deg_per_h",
        "true rate about the input axis at the end of the word, deg/h",
    ),
    (
        "encoder_arcsec",
        "angle of the table by its encoder, arcsec",
    ),
    ("temperature_c", "mean temperature of the coil, deg C"),
];

impl ReferenceRecord {
    /// Its scenario.
    #[must_use]
    fn scenario_toml(&self) -> String {
        format!(
            "# {}, of the reference records of fogbench.\nschema = 1\nname = \"{}\"\nseed = {}\n\
             duration_s = {:?}\nwarm_up_s = {:?}\n{COMMON}\n{}",
            self.about, self.name, self.seed, self.duration_s, self.warm_up_s, self.tables
        )
    }
}

/// Why the records are not written.
#[derive(Debug, thiserror::Error)]
pub enum RecordsError {
    /// One cannot be simulated.
    #[error("{0}: {1}")]
    Run(&'static str, RunError),
    /// The file system refuses.
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// Simulates and writes records, their data sheet and checksums; `begun` hears of each.
///
/// # Errors
/// [`RecordsError`].
pub fn write_records<'a>(
    staged: &Staged,
    records: impl Iterator<Item = &'a ReferenceRecord>,
    begun: &dyn Fn(&ReferenceRecord),
) -> Result<(), RecordsError> {
    let mut files = Files {
        staged,
        checksums: String::new(),
    };
    let mut lines = Vec::new();
    let mut of_gyro = None;
    for record in records {
        begun(record);
        let failed = |error| RecordsError::Run(record.name, error);
        let scenario = Scenario::from_toml(&record.scenario_toml());
        let scenario = scenario.map_err(|errors| failed(errors.into()))?;
        let run = scenario.run().map_err(failed)?;
        files.put_record(record, &run)?;
        lines.push(line(record, &run));
        let gyro = facts(&run.plan().resolved().scenario.gyro);
        of_gyro = gyro.ok().or(of_gyro);
    }
    files.finish(&lines, of_gyro.as_ref())?;
    Ok(())
}

/// The line of a record in the data sheet.
fn line(record: &ReferenceRecord, run: &Run) -> RecordLine {
    let figure = |key: &MetricKey| run["raw"].get(key).map(|metric| metric.estimate);
    RecordLine {
        name: record.name,
        about: record.about,
        seed: record.seed,
        rate_hz: 1.0 / run.plan().sample_period_s(),
        words: run.plan().record_length().measured,
        mean_deg_per_h: figure(&MEAN),
        noise_deg_per_h: figure(&NOISE_STD),
    }
}

/// Files of the set while they are written.
struct Files<'a> {
    staged: &'a Staged<'a>,
    /// Digest and name of each.
    checksums: String,
}

impl Files<'_> {
    fn put(&mut self, name: &str, bytes: &[u8]) -> Result<(), StoreError> {
        self.staged.write(name, bytes)?;
        // Writing to a String cannot fail.
        let _ = writeln!(self.checksums, "{}  {name}", digest_of_bytes(bytes));
        Ok(())
    }

    fn put_record(&mut self, record: &ReferenceRecord, run: &Run) -> Result<(), StoreError> {
        let name = record.name;
        let scenario = record.scenario_toml();
        self.put(&format!("{name}/scenario.toml"), scenario.as_bytes())?;
        let columns = columns(run);
        for ((heading, _), values) in COLUMNS.iter().zip(&columns) {
            let mut bytes = Vec::new();
            // Memory refuses nothing.
            drop(put_npy(&mut bytes, values));
            self.put(&format!("{name}/{heading}.npy"), &bytes)?;
        }
        self.put(&format!("{name}/record.csv"), csv(&columns).as_bytes())
    }

    /// Writes data sheet and checksums.
    fn finish(mut self, lines: &[RecordLine], facts: Option<&GyroFacts>) -> Result<(), StoreError> {
        let sheet = record_sheet(&RecordSheet {
            facts,
            columns: &COLUMNS,
            lines,
            checksums: CHECKSUMS,
        });
        self.put(SHEET, sheet.as_bytes())?;
        self.staged.write(CHECKSUMS, self.checksums.as_bytes())
    }
}

/// Values of every column.
fn columns(run: &Run) -> [Vec<f64>; COLUMNS.len()] {
    let period_s = run.plan().sample_period_s();
    let warm_up = run.plan().record_length().warm_up;
    let words = |name: &str| {
        let samples = run.samples(name).ok();
        samples.map_or_else(Vec::new, |samples| samples.measured().to_vec())
    };
    let raw = words("raw");
    let ordinals = (1_u32..).take(raw.len()).map(f64::from);
    let first_s = (f64::from(u32::try_from(warm_up).unwrap_or(u32::MAX)) + 1.0) * period_s;
    let scenario = &run.plan().resolved().scenario;
    let count = u32::try_from(raw.len()).unwrap_or(u32::MAX);
    let encoder = run.encoder();
    let encoder = encoder.map_or_else(Vec::new, |angles| {
        let angles = angles.measured().iter();
        angles.map(|angle| rad_to_arcsec(*angle)).collect()
    });
    [
        ordinals.map(|ordinal| ordinal * period_s).collect(),
        raw,
        words("truth"),
        encoder,
        coil_temperatures_c(&scenario.gyro, first_s, period_s, count),
    ]
}

/// All columns below their headings.
fn csv(columns: &[Vec<f64>]) -> String {
    let headings: Vec<&str> = COLUMNS.iter().map(|(heading, _)| *heading).collect();
    let mut text = headings.join(",") + "\n";
    for row in 0..columns[0].len() {
        let cells: Vec<String> = columns
            .iter()
            .map(|column| format!("{:?}", column[row]))
            .collect();
        text.push_str(&cells.join(","));
        text.push('\n');
    }
    text
}
