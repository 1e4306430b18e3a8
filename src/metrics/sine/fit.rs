//! Delay, amplitude ratio and distortion of a swing record by sine fits of known frequency.

use std::f64::consts::TAU;

use nalgebra::{Matrix3, Vector3};

use crate::metrics::estimate::interval;
use crate::metrics::estimate::interval::round_to_count;
use crate::metrics::estimate::magnitude::RootOfPower;
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::value::Estimate;

/// Most sub-blocks whose scatter gives the intervals.
const BLOCKS_MAX: usize = 20;

/// Fewest whole cycles from which intervals are given.
pub(crate) const CYCLES_MIN: usize = 3;

/// Highest harmonic that counts as distortion.
const HARMONICS_MAX: usize = 5;

/// When the samples were taken and how fast the table swings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwingClock {
    /// Swing frequency, Hz, known from the table.
    pub frequency_hz: f64,
    /// Sample period, s.
    pub sample_period_s: f64,
    /// Stamp of the first sample, s; phases refer to time zero.
    pub first_stamp_s: f64,
}

/// `offset + amplitude cos(2 pi f t + phase)`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SineFit {
    /// Amplitude, in the unit of the samples.
    pub amplitude: f64,
    /// Phase at time zero, rad, in (-pi, pi].
    pub phase_rad: f64,
    /// Offset, in the unit of the samples.
    pub offset: f64,
}

impl SwingClock {
    /// Angular phase of sample `index`, reduced to one turn before it loses digits, rad.
    pub(crate) fn phase_rad(&self, index: usize) -> f64 {
        let time_s = self.first_stamp_s + index as f64 * self.sample_period_s;
        (time_s * self.frequency_hz).fract() * TAU
    }

    fn samples_per_cycle(&self) -> f64 {
        1.0 / (self.frequency_hz * self.sample_period_s)
    }

    /// The largest whole number of cycles in `samples` samples.
    #[must_use]
    pub fn whole_cycles(&self, samples: usize) -> usize {
        // Half a sample of slack: the window of n cycles is rounded to whole samples.
        let cycles = (samples as f64 + 0.5) / self.samples_per_cycle();
        round_to_count(cycles.floor())
    }

    /// Samples nearest to `cycles` whole cycles.
    pub(crate) fn samples_in(&self, cycles: usize) -> usize {
        round_to_count(cycles as f64 * self.samples_per_cycle())
    }
}

/// Sums from which one three-parameter fit follows.
#[derive(Clone, Copy, Debug)]
struct FitSums {
    normal: Matrix3<f64>,
    right: Vector3<f64>,
}

impl FitSums {
    fn zero() -> Self {
        Self {
            normal: Matrix3::zeros(),
            right: Vector3::zeros(),
        }
    }

    fn of(values: &[f64], clock: &SwingClock, start: usize) -> Self {
        let mut sums = Self::zero();
        let (mut cc, mut cs, mut ss, mut c_sum, mut s_sum) = (0.0, 0.0, 0.0, 0.0, 0.0);
        let mut count = 0.0;
        for (index, value) in values.iter().enumerate() {
            if value.is_nan() {
                continue;
            }
            count += 1.0;
            let (s, c) = clock.phase_rad(start + index).sin_cos();
            cc += c * c;
            cs += c * s;
            ss += s * s;
            c_sum += c;
            s_sum += s;
            sums.right += Vector3::new(c * value, s * value, *value);
        }
        sums.normal = Matrix3::new(cc, cs, c_sum, cs, ss, s_sum, c_sum, s_sum, count);
        sums
    }

    fn solve(&self) -> Option<SineFit> {
        let solved = self.normal.cholesky()?.solve(&self.right);
        let (a, b) = (solved[0], solved[1]);
        Some(SineFit {
            amplitude: a.hypot(b),
            phase_rad: (-b).atan2(a),
            offset: solved[2],
        })
    }
}

/// Least-squares sine of known frequency: `y ~ a cos wt + b sin wt + c`; missing samples (NaN) are
/// left out.
///
/// Amplitude `sqrt(a^2 + b^2)`, phase `atan2(-b, a)`. `None` if the samples do not determine three
/// parameters.
///
/// Source: IEEE Std 1057, three-parameter fit.
#[must_use]
pub fn fit_sine(values: &[f64], clock: &SwingClock) -> Option<SineFit> {
    FitSums::of(values, clock, 0).solve()
}

/// A record cut to whole cycles and into sub-blocks of whole cycles, with the fits of each.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct SwingFit {
    /// Fit over all whole cycles.
    pub whole: SineFit,
    /// Whole cycles used.
    pub cycles: usize,
    /// First sample of every sub-block, and the end of the last.
    borders: Vec<usize>,
    blocks: Vec<SineFit>,
    clock: SwingClock,
}

/// Fits a record over the largest whole number of cycles and over up to twenty sub-blocks of it.
///
/// Ten sub-blocks or more when the record holds ten cycles; as many as cycles below that.
///
/// # Errors
/// The reason, in words, if there are fewer than three whole cycles or four samples per cycle.
pub fn fit_swing(values: &[f64], clock: &SwingClock) -> Result<SwingFit, Unavailable> {
    let cycles = clock.whole_cycles(values.len());
    if cycles < CYCLES_MIN || clock.samples_per_cycle() < 4.0 {
        return Err(format!(
            "the record holds {cycles} whole cycles of {} Hz at {:.1} samples each; a sine fit \
             with an interval needs {CYCLES_MIN} cycles of at least 4 samples",
            clock.frequency_hz,
            clock.samples_per_cycle(),
        )
        .into());
    }
    let count = cycles.min(BLOCKS_MAX);
    let borders: Vec<usize> = (0..=count)
        .map(|block| clock.samples_in(cycles * block / count).min(values.len()))
        .collect();
    let mut total = FitSums::zero();
    let mut blocks = Vec::with_capacity(count);
    for ends in borders.windows(2) {
        let sums = FitSums::of(&values[ends[0]..ends[1]], clock, ends[0]);
        total.normal += sums.normal;
        total.right += sums.right;
        blocks.push(sums.solve());
    }
    match (total.solve(), blocks.into_iter().collect()) {
        (Some(whole), Some(blocks)) => Ok(SwingFit {
            whole,
            cycles,
            borders,
            blocks,
            clock: *clock,
        }),
        _ => Err("the samples do not determine a sine".into()),
    }
}

impl SwingFit {
    /// The fit of the rate whose angle was fitted: `d/dt` of every sine, its offset dropped.
    ///
    /// `B cos(w t + phase)` has the derivative `w B cos(w t + phase + pi/2)`. The samples are never
    /// differenced: a step `delta` of the angle would put `delta / (sqrt(6) T)` of noise on each.
    #[must_use]
    pub fn derivative(&self) -> Self {
        let of = |sine: &SineFit| SineFit {
            amplitude: TAU * self.clock.frequency_hz * sine.amplitude,
            phase_rad: TAU * wrap_turns(sine.phase_rad / TAU + 0.25),
            offset: 0.0,
        };
        Self {
            whole: of(&self.whole),
            cycles: self.cycles,
            borders: self.borders.clone(),
            blocks: self.blocks.iter().map(of).collect(),
            clock: self.clock,
        }
    }

    /// Samples in the whole cycles.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.borders[self.borders.len() - 1]
    }

    /// Number of sub-blocks.
    #[must_use]
    pub fn block_count(&self) -> usize {
        self.blocks.len()
    }

    /// Samples of the whole cycles minus the fitted sine and offset.
    #[must_use]
    pub fn residuals(&self, values: &[f64]) -> Vec<f64> {
        let SineFit {
            amplitude,
            phase_rad,
            offset,
        } = self.whole;
        values[..self.samples()]
            .iter()
            .enumerate()
            .map(|(index, value)| {
                value - offset - amplitude * (self.clock.phase_rad(index) + phase_rad).cos()
            })
            .collect()
    }

    /// Offset with the Student t interval of the sub-blocks' offsets.
    #[must_use]
    pub fn offset(&self) -> Estimate {
        let parts: Vec<f64> = self.blocks.iter().map(|block| block.offset).collect();
        interval::from_parts(self.whole.offset, &parts)
    }

    /// Offset over a reference's, with the Student t interval of the sub-blocks.
    #[must_use]
    pub fn offset_ratio(&self, reference: &Self) -> Estimate {
        // The reference's mean offset divides every part, so that a part near zero cannot blow up.
        let ratio = self.whole.offset / reference.whole.offset;
        let parts: Vec<f64> = self
            .blocks
            .iter()
            .zip(&reference.blocks)
            .map(|(block, other)| {
                ratio + (block.offset - ratio * other.offset) / reference.whole.offset
            })
            .collect();
        interval::from_parts(ratio, &parts)
    }

    /// Delay behind a reference fitted over the same samples, s.
    ///
    /// `(phase_ref - phase) / 2 pi f`, unwrapped into (-1/2f, 1/2f]. The interval is Student's t on
    /// the scatter of the sub-blocks' delays: noise common to both series cancels in each.
    #[must_use]
    pub fn delay_behind_s(&self, reference: &Self) -> Estimate {
        let delay = |own: &SineFit, other: &SineFit| {
            wrap_turns((other.phase_rad - own.phase_rad) / TAU) / self.clock.frequency_hz
        };
        let whole = delay(&self.whole, &reference.whole);
        let parts: Vec<f64> = self
            .blocks
            .iter()
            .zip(&reference.blocks)
            .map(|(own, other)| {
                // Unwrapped around the whole record's delay, so that no part jumps a turn.
                let difference = delay(own, other) - whole;
                whole + wrap_turns(difference * self.clock.frequency_hz) / self.clock.frequency_hz
            })
            .collect();
        interval::from_parts(whole, &parts)
    }

    /// Amplitude over a reference's, with the Student t interval of the sub-blocks.
    #[must_use]
    pub fn amplitude_over(&self, reference: &Self) -> Estimate {
        let parts: Vec<f64> = self
            .blocks
            .iter()
            .zip(&reference.blocks)
            .map(|(own, other)| own.amplitude / other.amplitude)
            .collect();
        interval::from_parts(self.whole.amplitude / reference.whole.amplitude, &parts)
    }

    /// Mean square of values over each of so many blocks of whole cycles, at most one a cycle.
    #[must_use]
    pub fn block_mean_squares(&self, values: &[f64], blocks: usize) -> Vec<f64> {
        let count = blocks.clamp(1, self.cycles);
        let border = |block: usize| {
            let samples = self.clock.samples_in(self.cycles * block / count);
            samples.min(values.len())
        };
        (0..count)
            .map(|block| {
                let own = &values[border(block)..border(block + 1)];
                own.iter().map(|value| value * value).sum::<f64>() / own.len() as f64
            })
            .collect()
    }

    /// Total harmonic distortion of the residuals, percent of the fundamental.
    ///
    /// `sqrt(sum of squared amplitudes of harmonics 2..=5) / amplitude`, harmonics at or above half
    /// the sampling rate left out. The power that noise alone would put into the harmonics, known
    /// from the scatter over the sub-blocks, is subtracted. The interval is that of the mean of such a
    /// root, which noise alone keeps above zero.
    #[must_use]
    pub fn harmonic_distortion_percent(&self, residuals: &[f64]) -> Estimate {
        let highest = (1..=HARMONICS_MAX)
            .take_while(|&order| 2.0 * (order as f64) < self.clock.samples_per_cycle())
            .count();
        let parts: Vec<Vec<f64>> = self
            .borders
            .windows(2)
            .map(|ends| self.harmonics(&residuals[ends[0]..ends[1]], ends[0], highest))
            .collect();
        let components: Vec<(f64, f64)> = (0..parts[0].len())
            .map(|coefficient| {
                let values: Vec<f64> = parts.iter().map(|part| part[coefficient]).collect();
                let variance = interval::sample_variance(&values) / values.len() as f64;
                (interval::mean(&values), variance)
            })
            .collect();
        RootOfPower::of(&components, parts.len()).scaled(100.0 / self.whole.amplitude)
    }

    /// Cosine and sine amplitudes of harmonics 2 ..= highest in one sub-block.
    fn harmonics(&self, residuals: &[f64], start: usize, highest: usize) -> Vec<f64> {
        let mut sums = vec![0.0; 2 * highest.saturating_sub(1)];
        let present = residuals.iter().enumerate();
        let present = present.filter(|(_, value)| !value.is_nan());
        let mut count = 0_usize;
        for (index, value) in present {
            count += 1;
            let (s, c) = self.clock.phase_rad(start + index).sin_cos();
            let (mut cosine, mut sine) = (c, s);
            for pair in sums.chunks_exact_mut(2) {
                (cosine, sine) = (cosine * c - sine * s, sine * c + cosine * s);
                pair[0] += value * cosine;
                pair[1] += value * sine;
            }
        }
        let scale = 2.0 / count.max(1) as f64;
        sums.iter().map(|sum| sum * scale).collect()
    }
}

/// Reduces a number of turns to (-1/2, 1/2].
fn wrap_turns(turns: f64) -> f64 {
    turns - (turns - 0.5).ceil()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_wrap_to_the_half_open_interval() {
        for (turns, wrapped) in [(0.5, 0.5), (-0.5, 0.5), (0.75, -0.25), (-1.75, 0.25)] {
            assert!((wrap_turns(turns) - wrapped).abs() < 1e-15);
        }
    }

    #[test]
    fn distortion_of_a_known_third_harmonic_is_found() {
        let clock = SwingClock {
            frequency_hz: 5.0,
            sample_period_s: 1.0 / 3989.45,
            first_stamp_s: 12.3,
        };
        let values: Vec<f64> = (0..20_000)
            .map(|k| {
                let phase = clock.phase_rad(k);
                100.0 * phase.cos() + 2.0 * (3.0 * phase + 0.4).cos()
            })
            .collect();
        let fit = fit_swing(&values, &clock).unwrap();
        let distortion = fit.harmonic_distortion_percent(&fit.residuals(&values));
        assert!((distortion.value - 2.0).abs() < 0.01, "{distortion:?}");
    }
}
