//! Frequency response from several sines at once, by one joint least-squares fit.

use std::f64::consts::TAU;

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::metrics::estimate::interval;
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::curve::{Column, CurveKey};
use crate::units;
use crate::wording::counted;

/// Blocks that leave the fit in turn, for the jackknife.
const BLOCKS: usize = 20;

/// When the samples were taken and which tones the motion has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToneClock<'a> {
    /// Frequencies, Hz, ascending, known from the table.
    pub frequencies_hz: &'a [f64],
    /// Sample period, s.
    pub sample_period_s: f64,
    /// Stamp of the first sample, s; phases refer to time zero.
    pub first_stamp_s: f64,
}

impl ToneClock<'_> {
    /// Cosine and sine of every tone at sample `index`, then 1.
    fn fill_basis(&self, index: usize, basis: &mut [f64]) {
        let time_s = self.first_stamp_s + index as f64 * self.sample_period_s;
        for (pair, frequency_hz) in basis.chunks_exact_mut(2).zip(self.frequencies_hz) {
            // Whole cycles are dropped before the sine, which keeps full precision for hours.
            let (sine, cosine) = ((time_s * frequency_hz).fract() * TAU).sin_cos();
            pair[0] = cosine;
            pair[1] = sine;
        }
        if let Some(constant) = basis.last_mut() {
            *constant = 1.0;
        }
    }

    fn parameters(&self) -> usize {
        2 * self.frequencies_hz.len() + 1
    }
}

/// `offset + sum (a cos 2 pi f t + b sin 2 pi f t)`: the parameters a, b, a, b, ..., offset.
type Parameters = DVector<f64>;

/// Sums from which the fits of all series follow.
#[derive(Clone, Debug)]
struct Sums {
    normal: DMatrix<f64>,
    right: Vec<DVector<f64>>,
}

impl Sums {
    fn zero(parameters: usize, series: usize) -> Self {
        Self {
            normal: DMatrix::zeros(parameters, parameters),
            right: vec![DVector::zeros(parameters); series],
        }
    }

    /// Sums over a range of samples.
    fn of(series: &[&[f64]], clock: &ToneClock, range: std::ops::Range<usize>) -> Self {
        let parameters = clock.parameters();
        let mut sums = Self::zero(parameters, series.len());
        let mut basis = vec![0.0; parameters];
        for index in range {
            clock.fill_basis(index, &mut basis);
            for (column, factor) in basis.iter().enumerate() {
                // The upper triangle is enough: row <= column.
                let upper = &mut sums.normal.column_mut(column);
                for (entry, other) in upper.iter_mut().zip(&basis[..=column]) {
                    *entry += factor * other;
                }
            }
            for (right, values) in sums.right.iter_mut().zip(series) {
                for (entry, factor) in right.iter_mut().zip(&basis) {
                    *entry += factor * values[index];
                }
            }
        }
        sums.normal.fill_lower_triangle_with_upper_triangle();
        sums
    }

    /// Parameters of every series; `None` if the samples do not determine them.
    fn solve(&self) -> Option<Vec<Parameters>> {
        let factors: Cholesky<f64, Dyn> = self.normal.clone().cholesky()?;
        Some(
            self.right
                .iter()
                .map(|right| factors.solve(right))
                .collect(),
        )
    }

    fn without(&self, block: &Self) -> Self {
        let pairs = self.right.iter().zip(&block.right);
        Self {
            normal: &self.normal - &block.normal,
            right: pairs.map(|(all, own)| all - own).collect(),
        }
    }
}

/// Joint fits of several series over the same samples.
#[derive(Clone, Debug)]
pub struct ToneFits<'a> {
    clock: ToneClock<'a>,
    samples: usize,
    /// Parameters by series.
    whole: Vec<Parameters>,
    /// The same with each block left out in turn.
    left_out: Vec<Vec<Parameters>>,
}

/// Response of one series to another at one tone.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ToneResponse {
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Amplitude over the reference's.
    pub gain: Estimate,
    /// Phase against the reference, rad, negative for a lag; continued from tone to tone.
    pub phase_rad: Estimate,
    /// Phase delay behind the reference, s.
    pub delay_s: Estimate,
}

/// Fits all tones and an offset to every series at once.
///
/// Whole cycles are not needed: the joint fit separates what the record's ends would mix. The
/// intervals are jackknifed over twenty blocks that leave all series together, so that noise they
/// share cancels in their ratio.
///
/// # Errors
/// The reason, in words, if the series differ in length or do not determine the tones.
pub fn fit_tones<'a>(
    series: &[&[f64]],
    clock: &ToneClock<'a>,
) -> Result<ToneFits<'a>, Unavailable> {
    let samples = series.first().map_or(0, |values| values.len());
    let undetermined = || -> Unavailable {
        format!(
            "{} do not determine {}",
            counted(samples, "sample"),
            counted(clock.frequencies_hz.len(), "sine")
        )
        .into()
    };
    if series.iter().any(|values| values.len() != samples) {
        return Err("the series differ in length".into());
    }
    if samples < 2 * clock.parameters().max(BLOCKS) {
        return Err(undetermined());
    }
    let borders = |block: usize| samples * block / BLOCKS;
    let blocks: Vec<Sums> = (0..BLOCKS)
        .map(|block| Sums::of(series, clock, borders(block)..borders(block + 1)))
        .collect();
    let mut total = Sums::zero(clock.parameters(), series.len());
    for block in &blocks {
        total.normal += &block.normal;
        for (sum, right) in total.right.iter_mut().zip(&block.right) {
            *sum += right;
        }
    }
    let left_out = blocks.iter().map(|block| total.without(block).solve());
    Ok(ToneFits {
        clock: *clock,
        samples,
        whole: total.solve().ok_or_else(undetermined)?,
        left_out: left_out.collect::<Option<_>>().ok_or_else(undetermined)?,
    })
}

impl ToneFits<'_> {
    /// Offset of a series.
    #[must_use]
    pub fn offset(&self, series: usize) -> Estimate {
        let last = self.clock.parameters() - 1;
        let parts: Vec<f64> = self
            .left_out
            .iter()
            .map(|fits| fits[series][last])
            .collect();
        interval::jackknife(self.whole[series][last], &parts)
    }

    /// Offset of a series over a reference's.
    #[must_use]
    pub fn offset_ratio(&self, series: usize, reference: usize) -> Estimate {
        let last = self.clock.parameters() - 1;
        let ratio = |fits: &[Parameters]| fits[series][last] / fits[reference][last];
        let parts: Vec<f64> = self.left_out.iter().map(|fits| ratio(fits)).collect();
        interval::jackknife(ratio(&self.whole), &parts)
    }

    /// Samples of a series minus its offset and tones.
    #[must_use]
    pub fn residuals(&self, series: usize, values: &[f64]) -> Vec<f64> {
        let mut basis = vec![0.0; self.clock.parameters()];
        values[..self.samples]
            .iter()
            .enumerate()
            .map(|(index, value)| {
                self.clock.fill_basis(index, &mut basis);
                let fitted: f64 = basis
                    .iter()
                    .zip(&self.whole[series])
                    .map(|(factor, parameter)| factor * parameter)
                    .sum();
                value - fitted
            })
            .collect()
    }

    /// Response of one series to another, tone by tone.
    ///
    /// The phase of the first tone lies in (-pi, pi]; each further one takes the turn nearest to
    /// the delay of the tone before.
    #[must_use]
    pub fn response(&self, series: usize, reference: usize) -> Vec<ToneResponse> {
        let mut delay_s = 0.0;
        let tones = self.clock.frequencies_hz.iter().enumerate();
        tones
            .map(|(tone, &frequency_hz)| {
                let angular = TAU * frequency_hz;
                let (gain, phase) = ratio(&self.whole, (series, reference), tone);
                let phase = near(phase, -angular * delay_s);
                let parts = self.left_out.iter().map(|fits| {
                    let (gain, part) = ratio(fits, (series, reference), tone);
                    (gain, near(part, phase))
                });
                let (gains, phases): (Vec<f64>, Vec<f64>) = parts.unzip();
                delay_s = -phase / angular;
                let phase_rad = interval::jackknife(phase, &phases);
                ToneResponse {
                    frequency_hz,
                    gain: interval::jackknife(gain, &gains),
                    phase_rad,
                    delay_s: Estimate::with_interval(
                        delay_s,
                        -phase_rad.high / angular,
                        -phase_rad.low / angular,
                    ),
                }
            })
            .collect()
    }

    /// Lowest frequency at which the gain falls through `1/sqrt(2)` of the lowest tone's, Hz.
    ///
    /// The interval is that of the noise; it leaves out the error of the interpolation between two
    /// tones (see [`bandwidth_hz`]).
    ///
    /// # Errors
    /// The reason, in words, if the tones do not bracket it in every part of the record.
    pub fn bandwidth_hz(&self, series: usize, reference: usize) -> Result<Estimate, Unavailable> {
        let frequencies_hz = self.clock.frequencies_hz;
        let crossing = |fits: &[Parameters]| {
            let gains: Vec<f64> = (0..frequencies_hz.len())
                .map(|tone| ratio(fits, (series, reference), tone).0)
                .collect();
            bandwidth_hz(frequencies_hz, &gains)
        };
        let unbracketed = || {
            Unavailable::from("the gain does not fall through 1/sqrt(2) between two of the tones")
        };
        let whole = crossing(&self.whole).ok_or_else(unbracketed)?;
        let parts: Option<Vec<f64>> = self.left_out.iter().map(|fits| crossing(fits)).collect();
        Ok(interval::jackknife(whole, &parts.ok_or_else(unbracketed)?))
    }
}

/// Gain and phase (rad) of one series over another at a tone.
fn ratio(fits: &[Parameters], (series, reference): (usize, usize), tone: usize) -> (f64, f64) {
    // a cos + b sin is the real part of (a - i b) exp(i w t).
    let polar = |fit: &Parameters| {
        let (a, b) = (fit[2 * tone], fit[2 * tone + 1]);
        (a.hypot(b), (-b).atan2(a))
    };
    let (own, other) = (polar(&fits[series]), polar(&fits[reference]));
    (own.0 / other.0, near(own.1 - other.1, 0.0))
}

/// The angle plus the whole turns that bring it nearest to another.
pub(crate) fn near(angle_rad: f64, target_rad: f64) -> f64 {
    angle_rad - TAU * ((angle_rad - target_rad) / TAU).round()
}

/// Lowest frequency at which gains fall through `1/sqrt(2)` of the first, Hz; `None` if they do not.
///
/// Between two tones the inverse of the squared gain is taken as a straight line over the squared
/// frequency, which is exact for one pole; elsewhere the error goes with the square of the spacing.
#[must_use]
pub fn bandwidth_hz(frequencies_hz: &[f64], gains: &[f64]) -> Option<f64> {
    let limit = 2.0 / gains.first()?.powi(2);
    let points = || frequencies_hz.iter().zip(gains);
    points().zip(points().skip(1)).find_map(|(low, high)| {
        let (above, below) = (low.1.powi(-2), high.1.powi(-2));
        (above <= limit && below > limit).then(|| {
            let part = (limit - above) / (below - above);
            let squares = [low.0 * low.0, high.0 * high.0];
            (squares[0] + part * (squares[1] - squares[0])).sqrt()
        })
    })
}

/// Frequency of a tone.
pub static FREQUENCY: Column = Column::new("frequency_hz", "Hz", "frequency of the tone");

/// Gain.
pub static GAIN: Column = Column::new("gain", "1", "amplitude over that of the reference");

/// Lower end of the gain.
pub static GAIN_LOW: Column = Column::low("gain_low", &GAIN);

/// Upper end of the gain.
pub static GAIN_HIGH: Column = Column::high("gain_high", &GAIN);

/// Phase.
pub static PHASE: Column = Column::new(
    "phase_deg",
    "deg",
    "phase against the reference, negative for a lag; continued from tone to tone",
);

/// Lower end of the phase.
pub static PHASE_LOW: Column = Column::low("phase_low_deg", &PHASE);

/// Upper end of the phase.
pub static PHASE_HIGH: Column = Column::high("phase_high_deg", &PHASE);

/// Phase delay.
pub static DELAY: Column = Column::new("delay_ms", "ms", "phase delay behind the reference");

/// Lower end of the delay.
pub static DELAY_LOW: Column = Column::low("delay_low_ms", &DELAY);

/// Upper end of the delay.
pub static DELAY_HIGH: Column = Column::high("delay_high_ms", &DELAY);

/// Columns of every curve of responses.
pub(crate) const RESPONSE_COLUMNS: &[&Column] = &[
    &FREQUENCY,
    &GAIN,
    &GAIN_LOW,
    &GAIN_HIGH,
    &PHASE,
    &PHASE_LOW,
    &PHASE_HIGH,
    &DELAY,
    &DELAY_LOW,
    &DELAY_HIGH,
];

/// Enters gain, phase and delay of every tone with their intervals, where all are finite.
pub(crate) fn put_responses(
    key: &CurveKey,
    responses: &[ToneResponse],
    metrics: &mut ChannelMetrics,
) {
    type Pick = fn(&ToneResponse) -> Estimate;
    let quantities: [([&'static Column; 3], Pick); 3] = [
        ([&GAIN, &GAIN_LOW, &GAIN_HIGH], |response| response.gain),
        ([&PHASE, &PHASE_LOW, &PHASE_HIGH], |response| {
            response.phase_rad.scaled(units::rad_to_deg(1.0))
        }),
        ([&DELAY, &DELAY_LOW, &DELAY_HIGH], |response| {
            response.delay_s.scaled(units::s_to_ms(1.0))
        }),
    ];
    let frequencies_hz = responses.iter().map(|response| response.frequency_hz);
    let mut columns = vec![(&FREQUENCY, frequencies_hz.collect::<Vec<f64>>())];
    for ([value, low, high], pick) in quantities {
        let column = |end: fn(Estimate) -> f64| responses.iter().map(|of| end(pick(of))).collect();
        columns.push((value, column(|estimate| estimate.value)));
        columns.push((low, column(|estimate| estimate.low)));
        columns.push((high, column(|estimate| estimate.high)));
    }
    let mut values = columns.iter().flat_map(|(_, values)| values);
    if values.all(|value| value.is_finite()) {
        metrics.put_curve(key, columns);
    }
}
