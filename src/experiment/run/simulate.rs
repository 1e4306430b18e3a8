//! One repeat of one scenario: motion to gyro to filters, sample by sample, into records.

use rayon::prelude::*;

use super::output_average::{mean, table_warm_up_s};
use super::progress::{Progress, Unfinished, unless_stopped};
use super::records::{RecordLength, count};
use crate::experiment::campaign::{Compensator, Parameters};
use crate::experiment::channel_filter::{ChannelFilter, FinishedFilter, Restarts};
use crate::experiment::outside::Outside;
use crate::filters::FilterKind;
use crate::gyro::{self, CaseGyro, Gyro, GyroError, LoopFaults};
use crate::random::Streams;
use crate::scenario::{FilterState, Scenario};
use crate::signal::{MotionSegment, RateRecord, cubics_per_word};
use crate::turntable::{
    InjectedSignal, MotionClass, ServoConfig, Turntable, first_measured_index, step_indices,
};
use crate::units::rad_per_s_to_deg_per_h;

/// Samples of one block: long against the cost of handing it over, short against the caches.
const BLOCK_SAMPLES: usize = 1 << 14;

/// The records of one repeat; index 0 is the first sample of the warm-up.
pub(crate) struct Simulation {
    /// One gyro, or those of the case axes x, y, z.
    pub(crate) gyros: Vec<GyroRecord>,
    /// The filters in the order of the file, each on every gyro in turn, with the index of the gyro; until
    /// [`outside::complete`](crate::experiment::outside::complete) those of the bench alone.
    pub(in crate::experiment) filters: Vec<(usize, FinishedFilter)>,
    /// What the table's encoder shows at each stamp, rad; none if the table has none.
    pub(crate) encoder_rad: Option<Vec<f64>>,
    /// Half modulation periods in which a gyro did not work as meant.
    pub(crate) faults: Faults,
}

/// What one gyro was given and what it made of it.
pub(crate) struct GyroRecord {
    /// Inertial rate of the input axis, or of the case axis of an assembly, at each stamp, with the
    /// rate that an injected signal equals, deg/h; empty for a recorded log.
    pub(crate) truth_deg_per_h: RateRecord,
    /// What the gyro makes of the motion without noise at each stamp, deg/h; absent where nothing moves,
    /// of an assembly and of a recorded log.
    pub(crate) response_deg_per_h: Option<Vec<f64>>,
    /// The gyro's rate words, deg/h.
    pub(crate) raw_deg_per_h: Vec<f64>,
    /// The same with the constant errors of the assembly taken out, where that is done, deg/h.
    pub(crate) compensated_deg_per_h: Option<Vec<f64>>,
}

impl GyroRecord {
    /// What the filters are given and compared with, deg/h.
    pub(crate) fn filter_input_deg_per_h(&self) -> &[f64] {
        let compensated = self.compensated_deg_per_h.as_ref();
        compensated.unwrap_or(&self.raw_deg_per_h)
    }
}

/// Half modulation periods in which the gyro did not work as meant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Faults {
    /// The converter was driven beyond its range.
    pub(crate) saturated: u64,
    /// The phase error was beyond +-pi/2, where the loop pushes the wrong way.
    pub(crate) unlocked: u64,
    /// The loop's limits and the fringe it locked onto.
    pub(crate) limits: LoopFaults,
}

impl Faults {
    /// Sum over repeats.
    pub(crate) fn plus(self, other: Self) -> Self {
        Self {
            saturated: self.saturated + other.saturated,
            unlocked: self.unlocked + other.unlocked,
            limits: self.limits.plus(other.limits),
        }
    }

    /// What the reader of a report must know.
    pub(crate) fn notes(self) -> Vec<String> {
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
            .chain(self.limits.notes())
            .collect()
    }
}

/// Runs repeat `repeat` of `scenario`.
///
/// The gyros make the next block while the filters work on the one before, so that two threads
/// share even a single run; every word depends on the words before it alone. The listener can stop it
/// between two blocks.
pub(crate) fn simulate(
    scenario: &Scenario,
    length: RecordLength,
    repeat: u32,
    parameters: Option<&Parameters>,
    progress: &dyn Progress,
) -> Result<Simulation, Unfinished> {
    let mut source = Source::new(scenario, length, repeat)?;
    let sample_period_s = source.sample_period_s;
    let mut compensator =
        parameters.map(|known| Compensator::new(known, &scenario.gyro, sample_period_s));
    let mut filters = channel_filters(scenario, length, sample_period_s);
    let mut records: Vec<Words> = scenario
        .axis_prefixes()
        .iter()
        .map(|_| Words::with_capacity(length.total(), parameters.is_some()))
        .collect();
    let mut next_block = || {
        let raw = source.next_block();
        let compensated = compensator.as_mut().map(|stage| stage.take(&raw));
        (raw, compensated)
    };
    unless_stopped(progress)?;
    let (mut raw, mut compensated) = next_block();
    while !raw[0].is_empty() {
        unless_stopped(progress)?;
        let given = compensated.as_ref().unwrap_or(&raw);
        let (next, ()) = rayon::join(&mut next_block, || {
            filters
                .par_iter_mut()
                .for_each(|(gyro, filter)| filter.process(&given[*gyro]));
        });
        for (gyro, record) in records.iter_mut().enumerate() {
            record.extend(&raw[gyro], compensated.as_ref().map(|words| &words[gyro]));
        }
        progress.advanced(sample_period_s * count(raw[0].len()));
        (raw, compensated) = next;
    }
    let faults = source.gyros.faults();
    let truth = std::mem::take(&mut source.truth_deg_per_h);
    let records = truth.into_iter().zip(records);
    Ok(Simulation {
        gyros: records
            .map(|(truth_deg_per_h, words)| GyroRecord {
                truth_deg_per_h,
                response_deg_per_h: source.response.take().map(|response| response.words),
                raw_deg_per_h: words.raw,
                compensated_deg_per_h: words.compensated,
            })
            .collect(),
        filters: filters
            .into_iter()
            .map(|(gyro, filter)| (gyro, filter.finish()))
            .collect(),
        encoder_rad: source.encoder_rad,
        faults,
    })
}

/// Words of one gyro while they come in, deg/h.
struct Words {
    raw: Vec<f64>,
    compensated: Option<Vec<f64>>,
}

impl Words {
    fn with_capacity(samples: usize, is_compensated: bool) -> Self {
        Self {
            raw: Vec::with_capacity(samples),
            compensated: is_compensated.then(|| Vec::with_capacity(samples)),
        }
    }

    fn extend(&mut self, raw: &[f64], compensated: Option<&Vec<f64>>) {
        self.raw.extend_from_slice(raw);
        if let (Some(record), Some(words)) = (&mut self.compensated, compensated) {
            record.extend_from_slice(words);
        }
    }
}

/// The filters in the order of the file, each on every gyro in turn, with the index of the gyro.
fn channel_filters(
    scenario: &Scenario,
    length: RecordLength,
    sample_period_s: f64,
) -> Vec<(usize, ChannelFilter)> {
    let prefixes = scenario.axis_prefixes();
    // Words from outside are put in place when the record stands.
    let inside = scenario.filters.iter();
    let inside = inside.filter(|config| Outside::of(&config.kind).is_none());
    let filters = inside.flat_map(|config| {
        let gyros = prefixes.iter().enumerate();
        gyros.map(move |(gyro, prefix)| {
            let name = format!("{prefix}{}", config.name);
            let filter = ChannelFilter::new(
                name,
                &config.kind,
                length,
                sample_period_s,
                scenario.trial.rate_gain,
            );
            let restarts = restarts(scenario, &config.kind, sample_period_s);
            (gyro, filter.restarting(restarts))
        })
    });
    filters.collect()
}

/// Where a filter starts afresh, if that was asked for: half-way through the settling of every
/// dwell. Table and loop settle before, as one word of the old rate would stay in a filter that
/// forgets nothing, and the filter afterwards.
fn restarts(scenario: &Scenario, kind: &FilterKind, sample_period_s: f64) -> Option<Restarts> {
    if scenario.trial.filter_state == FilterState::Carried {
        return None;
    }
    let stairs = scenario.turntable.motion.stairs()?;
    let first = first_measured_index(scenario.warm_up_s, sample_period_s);
    let changes = step_indices(&stairs, scenario.warm_up_s, sample_period_s);
    let settled = first_measured_index(0.5 * stairs.settle_s, sample_period_s);
    let samples = std::iter::once(first).chain(changes).map(|change| {
        let index = change.saturating_add(settled);
        usize::try_from(index).unwrap_or(usize::MAX)
    });
    Some(Restarts::new(samples.collect(), kind, sample_period_s))
}

/// The first rate words of the first repeat, deg/h, warm-up included; of an assembly those of x.
pub(crate) fn first_words(scenario: &Scenario, samples: usize) -> Result<Vec<f64>, GyroError> {
    let length = RecordLength {
        warm_up: 0,
        measured: samples,
    };
    let mut source = Source::new(scenario, length, 0)?;
    let mut words = Vec::with_capacity(samples);
    while words.len() < samples {
        words.append(&mut source.next_block()[0]);
    }
    Ok(words)
}

/// Table and gyros: where the words come from.
struct Source {
    table: Turntable,
    /// Added to what a single gyro feels of the table.
    injected: Option<InjectedSignal>,
    gyros: Gyros,
    sample_period_s: f64,
    /// Rate words in one output sample.
    average_samples: u32,
    /// Cubics in one rate word.
    cubics: usize,
    /// The answer of a single gyro to the motion.
    response: Option<Response>,
    /// Of each gyro.
    truth_deg_per_h: Vec<RateRecord>,
    encoder_rad: Option<Vec<f64>>,
    samples: usize,
}

/// The linear model of a gyro without noise, and its words, deg/h.
struct Response {
    gyro: Gyro,
    words: Vec<f64>,
}

impl Response {
    /// The answer of a gyro alone on a table that moves; nothing where there is none to tell from noise.
    fn new(scenario: &Scenario, length: RecordLength) -> Option<Self> {
        let is_still = match scenario.measured_motion().class() {
            // A servo that is no closed form may shake at rest.
            MotionClass::Rest => !matches!(scenario.turntable.servo, ServoConfig::DirectDrive(_)),
            MotionClass::Campaign(_) => true,
            _ => false,
        };
        if is_still || scenario.gyro.assembly.is_some() {
            return None;
        }
        Some(Self {
            gyro: Gyro::without_noise(&scenario.gyro).ok()?,
            words: Vec::with_capacity(length.total()),
        })
    }
}

/// What stands on the table.
enum Gyros {
    /// One gyro, its input axis along the table axis.
    Alone(Box<Gyro>),
    /// A case with three.
    InCase(Vec<CaseGyro>),
}

impl Gyros {
    fn new(scenario: &Scenario, repeat: u32) -> Result<Self, GyroError> {
        let streams = Streams::new(scenario.seed, u64::from(repeat));
        let simulated_s = scenario.warm_up_s + scenario.duration_s;
        let (config, fidelity) = (&scenario.gyro, scenario.fidelity);
        if config.assembly.is_some() {
            CaseGyro::assembly(config, fidelity, simulated_s, &streams).map(Self::InCase)
        } else {
            let gyro = Gyro::new(config, fidelity, simulated_s, &streams)?;
            Ok(Self::Alone(Box::new(gyro)))
        }
    }

    fn faults(&self) -> Faults {
        let of = |gyro: &Gyro| Faults {
            saturated: gyro.saturated_half_periods(),
            unlocked: gyro.unlocked_half_periods(),
            limits: gyro.loop_faults(),
        };
        match self {
            Self::Alone(gyro) => of(gyro),
            Self::InCase(gyros) => gyros
                .iter()
                .map(|gyro| of(gyro.gyro()))
                .fold(Faults::default(), Faults::plus),
        }
    }
}

impl Source {
    fn new(scenario: &Scenario, length: RecordLength, repeat: u32) -> Result<Self, GyroError> {
        let sample_period_s = gyro::sample_period_s(&scenario.gyro);
        let word_period_s = gyro::word_period_s(&scenario.gyro);
        let warm_up = RecordLength::new(scenario, sample_period_s).warm_up;
        let sines = scenario.injected_sines();
        let fastest_hz = scenario.measured_motion().frequency_max_hz();
        let cubics = cubics_per_word(fastest_hz, word_period_s);
        let part_s = word_period_s / count(cubics);
        let parts = cubics * scenario.gyro.output.average_samples as usize;
        let warm_up_s = table_warm_up_s(scenario, warm_up, (parts, part_s));
        let has_encoder = scenario.turntable.encoder.resolution_arcsec.is_some();
        Ok(Self {
            table: Turntable::new(&scenario.turntable, warm_up_s, part_s),
            injected: sines.map(|sines| InjectedSignal::new(&sines, warm_up_s, part_s)),
            cubics,
            encoder_rad: has_encoder.then(|| Vec::with_capacity(length.total())),
            gyros: Gyros::new(scenario, repeat)?,
            sample_period_s,
            average_samples: scenario.gyro.output.average_samples,
            response: Response::new(scenario, length),
            truth_deg_per_h: scenario
                .axis_prefixes()
                .iter()
                .map(|_| RateRecord::with_capacity(length.total()))
                .collect(),
            samples: length.total(),
        })
    }

    /// The next output samples of each gyro, deg/h; empty when the records are complete.
    fn next_block(&mut self) -> Vec<Vec<f64>> {
        let (table, truth) = (&mut self.table, &mut self.truth_deg_per_h);
        let average = self.average_samples as usize;
        let encoder = &mut self.encoder_rad;
        let response = &mut self.response;
        let mut read = |table: &Turntable| {
            if let Some(readings) = encoder {
                readings.extend(table.encoder_rad());
            }
        };
        let cubics = self.cubics;
        let left = self.samples - truth[0].len();
        let block = left.min((BLOCK_SAMPLES / (average * cubics)).max(1));
        match &mut self.gyros {
            Gyros::Alone(gyro) => {
                let mut samples = Vec::with_capacity(block);
                let mut word = vec![MotionSegment::constant(0.0); cubics];
                for _ in 0..block {
                    let mut end = 0.0;
                    let mut answer = 0.0;
                    samples.push(mean(average, || {
                        for segment in &mut word {
                            *segment = table.next_segment();
                            if let Some(signal) = &mut self.injected {
                                *segment = segment.plus(&signal.next_segment());
                            }
                            end = segment.rate_at(1.0);
                        }
                        if let Some(response) = response {
                            answer += response.gyro.next_word_over(&word);
                        }
                        gyro.next_word_over(&word)
                    }));
                    truth[0].push(rad_per_s_to_deg_per_h(end));
                    if let Some(response) = response {
                        response.words.push(answer / count(average));
                    }
                    read(table);
                }
                vec![samples]
            }
            Gyros::InCase(gyros) => {
                let parts = average * cubics;
                let mut case = Vec::with_capacity(block * parts);
                for _ in 0..block {
                    case.extend((0..parts).map(|_| table.next_platform_segments()));
                    read(table);
                }
                let gyros = gyros.par_iter_mut().zip(truth).enumerate();
                gyros
                    .map(|(axis, (gyro, truth))| {
                        let ends = case.chunks_exact(parts).map(|cubics| &cubics[parts - 1]);
                        let rates = ends.map(|segments| segments[axis].rate_at(1.0));
                        truth.extend(rates.map(rad_per_s_to_deg_per_h));
                        let words = case.chunks_exact(cubics);
                        let mut words = words.map(|segments| gyro.next_word_over(segments));
                        let mut next = || words.next().unwrap_or(f64::NAN);
                        (0..block).map(|_| mean(average, &mut next)).collect()
                    })
                    .collect()
            }
        }
    }
}
