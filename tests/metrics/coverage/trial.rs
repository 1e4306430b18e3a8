//! Records of many seeds, and the intervals that each of them gives.

use std::collections::BTreeMap;

use fogbench::Scenario;
use fogbench::metrics::Estimate;
use rayon::prelude::*;

/// The channels on trial: the gyro alone and one filter of each kind.
const CHANNELS: &str = r#"
schema = 1
name = "coverage"
extends = "scenarios/base/fog70.toml"
fidelity = "rate"
warm_up_s = 1.0

[gyro.output]
average_samples = 4

[[filter]]
name = "lms"
[filter.lms]
taps = 10
step_size = 0.8
desired = "two-sample-mean"

[[filter]]
name = "rls"
[filter.rls]

[[filter]]
name = "mean"
[filter.moving_average]
taps = 8

[[filter]]
name = "kalman"
[filter.kalman]
"#;

/// What the table does while a record is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Motion {
    Rest,
    Swing,
    Steps,
    Staircase,
}

impl Motion {
    pub(crate) const ALL: [Self; 4] = [Self::Rest, Self::Swing, Self::Steps, Self::Staircase];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Rest => "rest",
            Self::Swing => "swing",
            Self::Steps => "steps",
            Self::Staircase => "staircase",
        }
    }

    /// Keys of the scenario, with a length of about `duration_s`.
    fn keys(self, duration_s: f64) -> String {
        let motion = match self {
            Self::Rest => String::new(),
            Self::Swing => {
                "[turntable.swing]\nrate_amplitude_deg_per_s = 1.0\nfrequency_hz = 5.0\n".to_owned()
            }
            Self::Steps => format!(
                "[turntable.steps]\nrates_deg_per_s = [0.0, 1.0]\ndwell_s = {}\n",
                duration_s / 2.0
            ),
            // Two rests, eleven rates of either sense, each after 0.25 s.
            Self::Staircase => format!(
                "[turntable.scale_factor_test]\npreferred_series = \"R5\"\nfrom_deg_per_s = 0.4\n\
                 to_deg_per_s = 40.0\ndwell_s = {dwell_s}\nstatic_s = {dwell_s}\nsettle_s = 0.25\n",
                dwell_s = duration_s / 24.0 - 0.26
            ),
        };
        format!("duration_s = {duration_s}\n{motion}")
    }
}

/// One metric of one channel.
pub(crate) type Key = (String, String);

/// What each of the seeds says of one metric; nothing where its record lacks it.
pub(crate) type Records = BTreeMap<Key, Vec<Option<Estimate>>>;

/// Runs the seeds from `first` on, each a record of its own, and gathers what they say.
pub(crate) fn run(motion: Motion, duration_s: f64, first: u64, seeds: u64) -> Records {
    let (head, filters) = CHANNELS
        .split_once("\n\n")
        .expect("keys of the scenario stand above its tables");
    let text = format!("{head}\n{}\n{filters}", motion.keys(duration_s));
    let scenario = Scenario::from_toml(&text).expect("a sound scenario");
    let records: Vec<BTreeMap<Key, Estimate>> = (first..first + seeds)
        .into_par_iter()
        .map(|seed| {
            let seeded = scenario
                .clone()
                .set("seed", i64::try_from(seed).expect("a seed"));
            let run = seeded.expect("a seed").run().expect("a run");
            let mut record = BTreeMap::new();
            for (channel, metrics) in run.channels() {
                for (name, metric) in &metrics.metrics {
                    record.insert((channel.to_owned(), name.clone()), metric.estimate);
                }
            }
            record
        })
        .collect();
    let mut table = Records::new();
    for (index, record) in records.iter().enumerate() {
        for (key, estimate) in record {
            let row = table
                .entry(key.clone())
                .or_insert_with(|| vec![None; records.len()]);
            row[index] = Some(*estimate);
        }
    }
    table
}
