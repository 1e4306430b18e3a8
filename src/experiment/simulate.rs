//! One repeat of one scenario: motion to gyro to filters, sample by sample, into records.

use rayon::prelude::*;

use super::channel_filter::{ChannelFilter, FinishedFilter};
use super::suite::Observer;
use crate::gyro::{Gyro, GyroError};
use crate::random::Streams;
use crate::scenario::Scenario;
use crate::turntable::{Turntable, first_measured_index};
use crate::units::rad_per_s_to_deg_per_h;

/// Samples of one block: long against the cost of handing it over, short against the caches.
const BLOCK_SAMPLES: usize = 1 << 14;

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
///
/// The gyro makes the next block while the filters work on the one before, so that two threads
/// share even a single run; every word depends on the words before it alone.
pub(super) fn simulate(
    scenario: &Scenario,
    length: RecordLength,
    repeat: u32,
    observer: &dyn Observer,
) -> Result<Simulation, GyroError> {
    let mut source = Source::new(scenario, length, repeat)?;
    let mut filters: Vec<_> = scenario
        .filters
        .iter()
        .map(|config| ChannelFilter::new(config, length, source.sample_period_s))
        .collect();
    let mut raw = Vec::with_capacity(length.total());
    let mut block = source.next_block();
    while !block.is_empty() {
        let (next, ()) = rayon::join(
            || source.next_block(),
            || {
                filters
                    .par_iter_mut()
                    .for_each(|filter| filter.take(&block))
            },
        );
        raw.extend_from_slice(&block);
        observer.advanced(source.sample_period_s * count(block.len()));
        block = next;
    }
    Ok(Simulation {
        truth_deg_per_h: source.truth_deg_per_h,
        raw_deg_per_h: raw,
        filters: filters.into_iter().map(ChannelFilter::finish).collect(),
        faults: Faults {
            saturated: source.gyro.saturated_half_periods(),
            unlocked: source.gyro.unlocked_half_periods(),
        },
    })
}

/// The first rate words of the first repeat, deg/h, warm-up included.
pub(super) fn first_words(scenario: &Scenario, samples: usize) -> Result<Vec<f64>, GyroError> {
    let length = RecordLength {
        warm_up: 0,
        measured: samples,
    };
    let mut source = Source::new(scenario, length, 0)?;
    let mut words = Vec::with_capacity(samples);
    while words.len() < samples {
        words.extend(source.next_block());
    }
    Ok(words)
}

/// Table and gyro: where the words come from.
struct Source {
    table: Turntable,
    gyro: Gyro,
    sample_period_s: f64,
    truth_deg_per_h: Vec<f64>,
    samples: usize,
}

impl Source {
    fn new(scenario: &Scenario, length: RecordLength, repeat: u32) -> Result<Self, GyroError> {
        let streams = Streams::new(scenario.seed, u64::from(repeat));
        let simulated_s = scenario.warm_up_s + scenario.duration_s;
        let gyro = Gyro::new(&scenario.gyro, scenario.fidelity, simulated_s, &streams)?;
        let sample_period_s = gyro.sample_period_s();
        Ok(Self {
            table: Turntable::new(&scenario.turntable, scenario.warm_up_s, sample_period_s),
            gyro,
            sample_period_s,
            truth_deg_per_h: Vec::with_capacity(length.total()),
            samples: length.total(),
        })
    }

    /// The next rate words, deg/h; empty when the record is complete.
    fn next_block(&mut self) -> Vec<f64> {
        let left = self.samples - self.truth_deg_per_h.len();
        let mut words = Vec::with_capacity(left.min(BLOCK_SAMPLES));
        for _ in 0..left.min(BLOCK_SAMPLES) {
            let segment = self.table.next_segment();
            words.push(self.gyro.next_word(&segment));
            self.truth_deg_per_h
                .push(rad_per_s_to_deg_per_h(segment.rate_at(1.0)));
        }
        words
    }
}

#[expect(
    clippy::cast_precision_loss,
    reason = "sample counts are far below 2^53"
)]
fn count(samples: usize) -> f64 {
    samples as f64
}
