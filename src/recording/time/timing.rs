//! Time columns: the sample period they imply, and what speaks against equal spacing.

use std::ops::Range;
use std::path::Path;

use super::column::TimeColumn;
use super::unit::TimeUnit;
use crate::recording::column::Columns;
use crate::recording::error::LogError;
use crate::recording::log::format::LogFormat;
use crate::recording::log::gaps::Gaps;
use crate::recording::text::lines::shown;
use crate::units::s_to_us;
use crate::wording::{counted, plain};

/// A step is a gap when it exceeds the sample period by this part of it.
const STEP_TOLERANCE: f64 = 0.5;
/// A rate that was given may differ from that of the time column by this part.
const RATE_TOLERANCE: f64 = 1e-3;
/// Logarithm of the ratio beyond which a given rate is another one, whatever the gaps.
const RATE_CLEARLY_OTHER: f64 = 0.25;
/// Steps less than this part of the unit of the column ask whether that is the unit.
const ODD_STEP: f64 = 0.05;
/// Most steps whose median is the period.
const MEDIAN_STEPS: usize = 1 << 16;
/// Fewest steps of either half of a record whose periods are compared.
const DRIFT_STEPS_MIN: usize = 50;

/// What a time column says about the spacing of the samples.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Timing {
    /// Sample rate over the whole record, Hz: the steps between stamps over the time they take.
    pub sample_rate_hz: f64,
    /// Largest distance of a stamp from equal spacing, s.
    pub jitter_max_s: f64,
    /// One in the last digit of a stamp, s: what they resolve.
    pub resolution_s: f64,
    /// Period of the second half of the record over that of the first, less one; none where the stamps do
    /// not tell it from 0.
    pub drift: Option<f64>,
}

/// Rows that are samples at equal spacing, and their rate.
#[derive(Clone, Debug)]
pub(in crate::recording) struct Spacing {
    pub(in crate::recording) timing: Option<Timing>,
    pub(in crate::recording) sample_rate_hz: f64,
    /// Stretches of rows between which samples are missing.
    pub(in crate::recording) stretches: Vec<Range<usize>>,
    /// Gaps within them that are spanned: the row behind each, and how many samples are missing before it.
    pub(in crate::recording) spanned: Vec<(usize, usize)>,
    /// What is worth saying.
    pub(in crate::recording) notes: Vec<String>,
    /// What a step between stamps may be; none where there are none.
    pub(in crate::recording) steps: Option<Steps>,
}

/// What a step between stamps may be.
#[derive(Clone, Copy, Debug)]
pub(in crate::recording) struct Steps {
    period: f64,
    /// What the last digit of a stamp resolves, where that is not far below the period; else 0.
    coarseness: f64,
    /// Whether stamps that are alike are two samples in the time that the last digit resolves.
    may_repeat: bool,
    /// Longest step that is jitter, if it is given.
    max_gap_s: Option<f64>,
    unit: &'static str,
    gaps: Gaps,
}

/// A log where samples are missing.
#[derive(Default)]
struct Cut {
    /// Stretches of rows between gaps that are not spanned.
    stretches: Vec<Range<usize>>,
    /// Those between gaps of any length.
    pieces: Vec<Range<usize>>,
    /// As in [`Spacing`].
    spanned: Vec<(usize, usize)>,
}

/// How stamps are looked at.
struct Clock<'a> {
    path: &'a Path,
    columns: &'a Columns,
    time: &'a TimeColumn,
    format: &'a LogFormat,
    /// The period that the stamps tell.
    found: f64,
    /// What the stamps resolve, s.
    last_digit: f64,
    /// What a step may be; the period is that which was given, if one was.
    steps: Steps,
}

/// Checks the stamps of some stretches of rows.
///
/// # Errors
/// Stamps that do not ascend, a gap with place and size where the log is not to be cut there, two samples in
/// the time of one, a given rate that the column contradicts, steps that doubt the unit.
pub(in crate::recording) fn timing(
    path: &Path,
    columns: &Columns,
    time: &TimeColumn,
    (format, gaps): (&LogFormat, Gaps),
    stretches: &[Range<usize>],
) -> Result<Spacing, LogError> {
    let steps = stretches.iter().map(|rows| rows.len().saturating_sub(1));
    let steps: usize = steps.sum();
    if let (0, Some(sample_rate_hz), true) = (steps, format.rate_hz, time.is_found) {
        return Ok(Spacing {
            timing: None,
            sample_rate_hz,
            stretches: stretches.to_vec(),
            spanned: Vec::new(),
            notes: Vec::new(),
            steps: None,
        });
    }
    if steps == 0 {
        let message = "the time column holds fewer than two stamps: give --rate-hz";
        return Err(LogError::of_file(path, message));
    }
    let clock = Clock::of(path, columns, time, (format, gaps), stretches);
    if clock.found.is_nan() || clock.found <= 0.0 {
        let message = format!(
            "column {}: most stamps stand still: if they are no time, say --time none and give --rate-hz",
            shown(&time.name)
        );
        return Err(LogError::of_file(path, message).about(Some("time")));
    }
    // Stamps of another clock altogether have no gaps.
    if (clock.steps.period / clock.found).ln().abs() > RATE_CLEARLY_OTHER {
        return Err(clock.contradiction(1.0 / clock.found));
    }
    let mut cut = Cut::default();
    for rows in stretches {
        clock.cut(rows, &mut cut)?;
    }
    let mut notes: Vec<String> = time.note.iter().cloned().collect();
    if let Some((count, after_s)) = time.roll_overs {
        notes.push(format!(
            "column {} begins again {}, each after {}: taken to go on",
            shown(&time.name),
            counted(count, "time"),
            clock.span(after_s)
        ));
    }
    if time.is_counter() {
        return clock.counted(cut, notes);
    }
    let spacing = clock.measured(&cut.pieces);
    if let Some(rate) = format.rate_hz
        && (rate / spacing.sample_rate_hz - 1.0).abs() > clock.rate_tolerance(&spacing, &cut.pieces)
    {
        return Err(clock.contradiction(spacing.sample_rate_hz));
    }
    if let Some(odd) = clock.odd(spacing.sample_rate_hz) {
        if format.time_unit.is_none() && format.rate_hz.is_none() {
            return Err(LogError::of_file(path, odd));
        }
        notes.push(odd);
    }
    Ok(Spacing {
        sample_rate_hz: format.rate_hz.unwrap_or(spacing.sample_rate_hz),
        timing: Some(spacing),
        stretches: cut.stretches,
        spanned: cut.spanned,
        notes,
        steps: Some(clock.steps),
    })
}

impl Steps {
    /// Checks a step.
    ///
    /// # Errors
    /// What speaks against equal spacing.
    pub(in crate::recording) fn check(&self, step: f64) -> Result<(), StepError> {
        let Self {
            period, unit, gaps, ..
        } = *self;
        let gap = || StepError::Gap {
            step,
            period,
            unit,
            gaps,
        };
        if let Some(most_s) = self.max_gap_s {
            if step < 0.0 {
                return Err(StepError::Descent { step, unit });
            }
            return match step > most_s {
                true => Err(gap()),
                false => Ok(()),
            };
        }
        if step < 0.0 || (step <= 0.0 && !self.may_repeat) {
            return Err(StepError::Descent { step, unit });
        }
        // Stamps that are rounded down stand up to a last digit from where they belong, either way.
        let rounded = self.coarseness * if self.may_repeat { 1.01 } else { 0.99 };
        let open = rounded.max(STEP_TOLERANCE * period);
        if step > period + open {
            return Err(gap());
        }
        if step < period - open {
            return Err(StepError::Crowd { step, period, unit });
        }
        Ok(())
    }
}

impl<'a> Clock<'a> {
    fn of(
        path: &'a Path,
        columns: &'a Columns,
        time: &'a TimeColumn,
        (format, gaps): (&'a LogFormat, Gaps),
        stretches: &[Range<usize>],
    ) -> Self {
        let median = median_step(&time.stamps, stretches);
        // Where most stamps repeat, they are rounded to their least rise, whatever digits they are spelled with.
        let last_digit = match median > 0.0 {
            true => time.last_digit(),
            false => time.last_digit().max(least_rise(&time.stamps, stretches)),
        };
        // The median of a few multiples of the last digit is one of them.
        let mean = mean_of_steps_up_to(1.5 * median + last_digit, &time.stamps, stretches);
        let found = if 2.0 * last_digit >= mean {
            mean
        } else {
            median
        };
        let given = format.rate_hz.filter(|_| !time.is_counter());
        let period = given.map_or(found, |rate| 1.0 / rate);
        let is_coarse = 2.0 * last_digit >= period && !time.is_counter();
        Self {
            path,
            columns,
            time,
            format,
            found,
            last_digit,
            steps: Steps {
                period,
                coarseness: if is_coarse { last_digit } else { 0.0 },
                may_repeat: is_coarse && repeats_by_rounding(&time.stamps, median, last_digit),
                max_gap_s: format.max_gap_s,
                unit: if time.is_counter() { "" } else { " s" },
                gaps,
            },
        }
    }

    /// Cuts a stretch where samples are missing.
    fn cut(&self, rows: &Range<usize>, found: &mut Cut) -> Result<(), LogError> {
        let (mut first, mut first_of_piece) = (rows.start, rows.start);
        let stamps = &self.time.stamps[rows.clone()];
        for (offset, pair) in stamps.windows(2).enumerate() {
            let step = pair[1] - pair[0];
            let Err(complaint) = self.steps.check(step) else {
                continue;
            };
            let row = rows.start + offset + 1;
            let is_gap = matches!(complaint, StepError::Gap { .. });
            let spanned = self.spanned(step).filter(|_| is_gap);
            if spanned.is_some() || (is_gap && self.format.split_gaps == Some(true)) {
                found.pieces.push(first_of_piece..row);
                first_of_piece = row;
                match spanned {
                    Some(missing) => found.spanned.push((row, missing)),
                    None => {
                        found.stretches.push(first..row);
                        first = row;
                    }
                }
                continue;
            }
            let message = format!("column {}: {complaint}", shown(&self.time.name));
            return Err(LogError::at(self.path, self.columns.place(row), message));
        }
        found.pieces.push(first_of_piece..rows.end);
        found.stretches.push(first..rows.end);
        Ok(())
    }

    /// Samples that are missing in a step, where differences may span so many.
    fn spanned(&self, step: f64) -> Option<usize> {
        let most = f64::from(self.format.gap_aware?);
        let missing = (step / self.steps.period).round() - 1.0;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a whole number up to the most that may be missing"
        )]
        let count = missing.max(1.0) as usize;
        (missing <= most).then_some(count)
    }

    /// The rate that was given against that of the stamps.
    fn contradiction(&self, found_hz: f64) -> LogError {
        let way_out = if self.time.is_found {
            "--time none takes it to be none, --time-unit says what its stamps are"
        } else {
            "leave one of them out"
        };
        let message = format!(
            "--rate-hz {} contradicts the time column {}, whose mean rate is {found_hz:.6} Hz: {way_out}",
            self.format.rate_hz.unwrap_or_default(),
            shown(&self.time.name),
        );
        LogError::of_file(self.path, message).about(Some("rate_hz"))
    }

    /// A counter of samples: the rate is the one that was given.
    fn counted(&self, cut: Cut, notes: Vec<String>) -> Result<Spacing, LogError> {
        let Some(sample_rate_hz) = self.format.rate_hz else {
            let message = format!(
                "column {} counts samples and tells no time: give --rate-hz",
                shown(&self.time.name)
            );
            return Err(LogError::of_file(self.path, message));
        };
        Ok(Spacing {
            timing: None,
            sample_rate_hz,
            stretches: cut.stretches,
            spanned: cut.spanned,
            notes,
            steps: Some(self.steps),
        })
    }

    /// What the stamps say of the spacing.
    fn measured(&self, stretches: &[Range<usize>]) -> Timing {
        let stamps = &self.time.stamps;
        // The first and the last of stamps that are rounded to more than a sample stand anywhere in that.
        let mean = match self.steps.coarseness > 1.01 * self.steps.period {
            true => slope(stamps, stretches),
            false => mean_step(stamps, stretches),
        };
        let mut jitter_max_s = 0.0_f64;
        for rows in stretches {
            let mut ordinal = 0.0;
            for stamp in &stamps[rows.clone()] {
                let from_first = stamp - stamps[rows.start];
                jitter_max_s = jitter_max_s.max((from_first - ordinal * mean).abs());
                ordinal += 1.0;
            }
        }
        let resolution_s = self.last_digit;
        Timing {
            sample_rate_hz: 1.0 / mean,
            jitter_max_s,
            resolution_s,
            drift: drift(stamps, stretches, resolution_s),
        }
    }

    /// Part by which a rate that was given may differ from that of the stamps: of a short record no more is
    /// known than their jitter lets them tell.
    fn rate_tolerance(&self, found: &Timing, stretches: &[Range<usize>]) -> f64 {
        let stamps = &self.time.stamps;
        let spans = stretches
            .iter()
            .map(|rows| stamps[rows.end - 1] - stamps[rows.start]);
        RATE_TOLERANCE.max(2.0 * found.jitter_max_s / spans.sum::<f64>())
    }

    /// What doubts the unit of the column: steps that are hardly any part of it.
    fn odd(&self, rate_hz: f64) -> Option<String> {
        let [unit] = self.time.units[..] else {
            return None;
        };
        let unit_s = unit.seconds()?;
        let is_fine = matches!(
            unit,
            TimeUnit::Milliseconds | TimeUnit::Microseconds | TimeUnit::Nanoseconds
        );
        (is_fine && self.steps.period < ODD_STEP * unit_s).then(|| {
            format!(
                "column {}: steps of {} {unit} would be samples at {} Hz: --time-unit says what its stamps \
                 are, in seconds it were {} Hz",
                shown(&self.time.name),
                plain(self.steps.period / unit_s),
                plain(rate_hz),
                plain(rate_hz * unit_s)
            )
        })
    }

    fn span(&self, span: f64) -> String {
        match self.time.is_counter() {
            true => format!("{} counts", plain(span)),
            false => format!("{} s", plain(span)),
        }
    }
}

impl Timing {
    /// What is said of a time column without a gap, or cut at its gaps.
    pub(in crate::recording) fn note(&self, gaps: usize) -> String {
        let gaps = match gaps {
            0 => "no gap".to_owned(),
            gaps => counted(gaps, "gap"),
        };
        let is_rounding =
            (0.1 * self.resolution_s..=self.resolution_s).contains(&self.jitter_max_s);
        let resolved = match is_rounding {
            true => format!(
                ", no more than the {:.3} us that they resolve",
                s_to_us(self.resolution_s)
            ),
            false => String::new(),
        };
        let jitter = format!(
            "stamps within {:.3} us of equal spacing{resolved}",
            s_to_us(self.jitter_max_s)
        );
        let drift = self.drift.map_or_else(String::new, |drift| {
            format!(
                ", the second half {} ppm slower than the first",
                plain((drift * 1e7).round() / 10.0)
            )
        });
        format!(
            "time column: {:.6} Hz, {gaps}, {jitter}{drift}",
            self.sample_rate_hz
        )
    }
}

#[expect(
    clippy::cast_precision_loss,
    reason = "sample counts are far below 2^53"
)]
fn mean_step(stamps: &[f64], stretches: &[Range<usize>]) -> f64 {
    let (mut time, mut steps) = (0.0, 0.0);
    for rows in stretches.iter().filter(|rows| rows.len() > 1) {
        time += stamps[rows.end - 1] - stamps[rows.start];
        steps += (rows.len() - 1) as f64;
    }
    time / steps
}

/// Steps from one stamp to the next within stretches.
fn steps<'a>(stamps: &'a [f64], stretches: &'a [Range<usize>]) -> impl Iterator<Item = f64> + 'a {
    let pairs = stretches
        .iter()
        .flat_map(|rows| stamps[rows.clone()].windows(2));
    pairs.map(|pair| pair[1] - pair[0])
}

/// Step of the straight lines of one slope that fit the stamps of all stretches best.
#[expect(
    clippy::cast_precision_loss,
    reason = "sample counts are far below 2^53"
)]
fn slope(stamps: &[f64], stretches: &[Range<usize>]) -> f64 {
    let (mut products, mut squares) = (0.0, 0.0);
    for rows in stretches {
        let own = &stamps[rows.clone()];
        let count = own.len() as f64;
        let middle = 0.5 * (count - 1.0);
        let mean = own.iter().sum::<f64>() / count;
        let mut ordinal = 0.0;
        for stamp in own {
            products += (ordinal - middle) * (stamp - mean);
            squares += (ordinal - middle) * (ordinal - middle);
            ordinal += 1.0;
        }
    }
    products / squares
}

/// Least step that is none of the same stamp again; 0 without one.
fn least_rise(stamps: &[f64], stretches: &[Range<usize>]) -> f64 {
    let rises = steps(stamps, stretches).filter(|step| *step > 0.0);
    let least = rises.fold(f64::INFINITY, f64::min);
    if least.is_finite() { least } else { 0.0 }
}

/// Mean of the steps that are no gaps.
fn mean_of_steps_up_to(most: f64, stamps: &[f64], stretches: &[Range<usize>]) -> f64 {
    // Where a clock begins again, it does not run backwards.
    let steps = steps(stamps, stretches).filter(|step| (0.0..=most).contains(step));
    let (sum, count) = steps.fold((0.0, 0.0), |(sum, count), step| (sum + step, count + 1.0));
    sum / count
}

/// Whether stamps repeat because their last digit is coarse: many to the digit, or as often as others leave
/// one out.
fn repeats_by_rounding(stamps: &[f64], median: f64, last_digit: f64) -> bool {
    let steps = || stamps.windows(2).map(|pair| pair[1] - pair[0]);
    let repeats = steps().filter(|step| *step <= 0.0).count();
    let doubles = steps().filter(|step| *step > 1.5 * last_digit).count();
    median <= 0.0 || repeats <= 2 * doubles
}

/// Median of the steps, of a long record of some of them: what gaps do not move.
fn median_step(stamps: &[f64], stretches: &[Range<usize>]) -> f64 {
    let count: usize = stretches
        .iter()
        .map(|rows| rows.len().saturating_sub(1))
        .sum();
    let every = count.div_ceil(MEDIAN_STEPS).max(1);
    let mut steps: Vec<f64> = steps(stamps, stretches).step_by(every).collect();
    let middle = steps.len() / 2;
    let (_, median, _) = steps.select_nth_unstable_by(middle, f64::total_cmp);
    *median
}

/// How much longer the periods of the second half are than those of the first, as a part, if that is more
/// than the ends of the halves leave open: their resolution, and the scatter of stamps.
fn drift(stamps: &[f64], stretches: &[Range<usize>], resolution_s: f64) -> Option<f64> {
    let [rows] = stretches else { return None };
    let stamps = &stamps[rows.clone()];
    if stamps.len() <= 2 * DRIFT_STEPS_MIN {
        return None;
    }
    let half = (stamps.len() - 1) / 2;
    let mean_of = |rows: Range<usize>| mean_step(stamps, std::slice::from_ref(&rows));
    let first = mean_of(0..half + 1);
    let second = mean_of(half..2 * half + 1);
    let mean = mean_of(0..2 * half + 1);
    // Scatter of steps about their neighbours: what a stamp alone is off by.
    let scatter = stamps
        .windows(3)
        .map(|three| three[2] - 2.0 * three[1] + three[0]);
    let scatter = scatter.fold(0.0_f64, |most, it| most.max(it.abs()));
    let open = (resolution_s.min(mean) + scatter) * 2.0 / (as_float(half) * mean);
    let drift = second / first - 1.0;
    (drift.abs() > 2.0 * open && drift.abs() > 1e-7).then_some(drift)
}

#[expect(
    clippy::cast_precision_loss,
    reason = "sample counts are far below 2^53"
)]
fn as_float(count: usize) -> f64 {
    count as f64
}

/// What speaks against equal spacing between two stamps.
#[derive(Debug, thiserror::Error)]
pub(in crate::recording) enum StepError {
    #[error(
        "the time goes from one stamp to the next by {step:.9}{unit}: stamps must ascend; --roll-over says \
         after how much a counter begins again; if they are rounded too coarsely, say --time none and give \
         --rate-hz"
    )]
    Descent { step: f64, unit: &'static str },
    #[error(
        "gap of {step:.9}{unit} where samples are {period:.9}{unit} apart ({:.0} missing){}",
        (step / period - 1.0).max(1.0),
        gaps.at_stamps()
    )]
    Gap {
        step: f64,
        period: f64,
        unit: &'static str,
        gaps: Gaps,
    },
    #[error(
        "the stamp is {step:.9}{unit} after the one before where samples are {period:.9}{unit} apart: \
         spacing must be equal within half of that; --max-gap-s takes all steps up to one for jitter"
    )]
    Crowd {
        step: f64,
        period: f64,
        unit: &'static str,
    },
}
