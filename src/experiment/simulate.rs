//! One repeat of one scenario: motion to gyro to filters, sample by sample, into records.

use super::channel_filter::{ChannelFilter, FinishedFilter};
use super::suite::Observer;
use crate::gyro::{Gyro, GyroError};
use crate::random::Streams;
use crate::scenario::Scenario;
use crate::turntable::{Turntable, first_measured_index};
use crate::units::rad_per_s_to_deg_per_h;

/// Samples between two reports of progress.
const PROGRESS_SAMPLES: usize = 1 << 16;

/// How many samples the warm-up and the measured record hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct RecordLength {
    /// Samples before the record.
    pub(super) warm_up: usize,
    /// Samples of the record.
    pub(super) measured: usize,
}

impl RecordLength {
    /// `ceil(warm_up_s f)` and `floor(duration_s f)` samples.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the plan bounds both counts and the reader refuses negative times"
    )]
    pub(super) fn new(scenario: &Scenario, sample_period_s: f64) -> Self {
        let rate_hz = 1.0 / sample_period_s;
        Self {
            warm_up: first_measured_index(scenario.warm_up_s, sample_period_s) as usize,
            measured: (scenario.duration_s * rate_hz).floor() as usize,
        }
    }

    /// All samples.
    pub(super) fn total(self) -> usize {
        self.warm_up + self.measured
    }
}

/// The records of one repeat; index 0 is the first sample of the warm-up.
pub(super) struct Simulation {
    /// Inertial rate of the input axis at each stamp, deg/h.
    pub(super) truth_deg_per_h: Vec<f64>,
    /// The gyro's rate words, deg/h.
    pub(super) raw_deg_per_h: Vec<f64>,
    /// The filters, in the order of the file.
    pub(super) filters: Vec<FinishedFilter>,
    /// Half modulation periods in which the gyro did not work as meant.
    pub(super) faults: Faults,
}

/// Half modulation periods in which the gyro did not work as meant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Faults {
    /// The converter was driven beyond its range.
    pub(super) saturated: u64,
    /// The phase error was beyond +-pi/2, where the loop pushes the wrong way.
    pub(super) unlocked: u64,
}

impl Faults {
    /// Sum over repeats.
    pub(super) fn plus(self, other: Self) -> Self {
        Self {
            saturated: self.saturated + other.saturated,
            unlocked: self.unlocked + other.unlocked,
        }
    }

    /// What the reader of a report must know.
    pub(super) fn notes(self) -> Vec<String> {
        let sentences = [
            (
                self.saturated,
                "the converter (gyro.adc) was driven beyond its range",
            ),
            (
                self.unlocked,
                "the loop was out of lock: its error was beyond a quarter fringe",
            ),
        ];
        let happened = sentences.iter().filter(|(count, _)| *count > 0);
        happened
            .map(|(count, what)| format!("{what} in {count} half modulation periods"))
            .collect()
    }
}

/// Runs repeat `repeat` of `scenario`.
pub(super) fn simulate(
    scenario: &Scenario,
    length: RecordLength,
    repeat: u32,
    observer: &dyn Observer,
) -> Result<Simulation, GyroError> {
    let streams = Streams::new(scenario.seed, u64::from(repeat));
    let simulated_s = scenario.warm_up_s + scenario.duration_s;
    let mut gyro = Gyro::new(&scenario.gyro, scenario.fidelity, simulated_s, &streams)?;
    let sample_period_s = gyro.sample_period_s();
    let mut table = Turntable::new(&scenario.turntable, scenario.warm_up_s, sample_period_s);
    let mut filters: Vec<_> = scenario
        .filters
        .iter()
        .map(|config| ChannelFilter::new(config, length.total()))
        .collect();
    let mut truth = Vec::with_capacity(length.total());
    let mut raw = Vec::with_capacity(length.total());
    let block_s = sample_period_s * count(PROGRESS_SAMPLES);
    for index in 0..length.total() {
        let segment = table.next_segment();
        let word = gyro.next_word(&segment);
        truth.push(rad_per_s_to_deg_per_h(segment.rate_at(1.0)));
        raw.push(word);
        let measured = index >= length.warm_up;
        for filter in &mut filters {
            filter.step(word, measured);
        }
        if (index + 1) % PROGRESS_SAMPLES == 0 {
            observer.advanced(block_s);
        }
    }
    observer.advanced(sample_period_s * count(length.total() % PROGRESS_SAMPLES));
    Ok(Simulation {
        truth_deg_per_h: truth,
        raw_deg_per_h: raw,
        filters: filters.into_iter().map(ChannelFilter::finish).collect(),
        faults: Faults {
            saturated: gyro.saturated_half_periods(),
            unlocked: gyro.unlocked_half_periods(),
        },
    })
}

#[expect(
    clippy::cast_precision_loss,
    reason = "sample counts are far below 2^53"
)]
fn count(samples: usize) -> f64 {
    samples as f64
}
