//! What a claimed reduction of noise shows by itself: what else would read the same.
//!
//! A low pass does not change the noise of a gyro at averaging times well beyond its memory, but it
//! lowers every deviation that is read inside it. With `x = T / tau` of a one-pole low pass of time
//! constant T, and `l = L / tau` of a mean over L, white noise has these parts of its variance left:
//!
//! | read as | one pole | mean |
//! |---|---|---|
//! | Allan variance | `1 - x/2 (3 - 4 exp(-1/x) + exp(-2/x))` | `1 - l/2` up to l = 1, `2 / (3 l^2)` from 2 on |
//! | variance of means | `1 - x (1 - exp(-1/x))` | `1 - l/3` up to l = 1, `(1 - 1 / (3 l)) / l` from there on |
//!
//! Derivation: the variance is `N^2 int |W(f)|^2 |H(f)|^2 df`, or over the lags s of the two
//! autocorrelations, `N^2 int R_w(s) R_h(s) ds`. For the mean, `R_w = (tau - |s|) / tau^2` within tau; for
//! the Allan variance, half the square of the difference of two neighbouring means,
//! `R_w = (tau - 3 |s| / 2) / tau^2` within tau and `(|s| / 2 - tau) / tau^2` from there to 2 tau. Of the
//! low passes, `R_h = exp(-|s| / T) / (2 T)` and `R_h = (L - |s|) / L^2` within L. Each row divides by
//! `N^2 / tau`, which is left without a filter. Between l = 1 and 2 the Allan variance of the mean keeps
//! `(l/2 - (l - 1)^2 / 2 + (l - 1)^3 / 6) / l^2`.
//!
//! Source: derived; the one-pole Allan variance is the known one of a first-order low pass on white noise.

/// Figure that a claim is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClaimedFigure {
    /// Angle random walk, read off the Allan deviation at one averaging time; deg/sqrt(h).
    AngleRandomWalk,
    /// Standard deviation of means over one averaging time; deg/h.
    BiasStability,
}

impl ClaimedFigure {
    /// Part of the variance of white noise that a one-pole low pass leaves; `x` is its time constant
    /// over the averaging time.
    fn left_by_one_pole(self, x: f64) -> f64 {
        let u = x.recip();
        match self {
            Self::AngleRandomWalk if u < 1.0 => {
                // The closed form loses its digits here. Terms of 3 - 4 exp(-u) + exp(-2 u):
                // (-u)^k (2^k - 4) / k!, of which the first to count is k = 3.
                0.5 * series(u, |k| 2_f64.powi(k) - 4.0)
            }
            Self::AngleRandomWalk => 1.0 - 0.5 * x * (3.0 - 4.0 * (-u).exp() + (-2.0 * u).exp()),
            Self::BiasStability if u < 1.0 => 0.5 * u - series(u, |_| 1.0),
            Self::BiasStability => 1.0 - x * (1.0 - (-u).exp()),
        }
    }

    /// Part of the variance of white noise that a mean leaves; `l` is its length over the averaging
    /// time.
    fn left_by_mean(self, l: f64) -> f64 {
        match self {
            Self::AngleRandomWalk if l <= 1.0 => 1.0 - 0.5 * l,
            Self::AngleRandomWalk if l <= 2.0 => {
                let beyond = l - 1.0;
                (0.5 * l - 0.5 * beyond.powi(2) + beyond.powi(3) / 6.0) / (l * l)
            }
            Self::AngleRandomWalk => 2.0 / (3.0 * l * l),
            Self::BiasStability if l <= 1.0 => 1.0 - l / 3.0,
            Self::BiasStability => (1.0 - 1.0 / (3.0 * l)) / l,
        }
    }
}

/// `sum over k >= 3 of (-1)^(k+1) c(k) u^(k-1) / k!`, for u up to 1.
fn series(u: f64, coefficient: impl Fn(i32) -> f64) -> f64 {
    let mut power = 0.5 * u;
    (3..=30)
        .map(|k| {
            power *= u / f64::from(k);
            let sign = if k % 2 == 1 { 1.0 } else { -1.0 };
            sign * coefficient(k) * power
        })
        .sum()
}

/// A claimed reduction of noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Claim {
    /// What was reduced.
    pub figure: ClaimedFigure,
    /// Figure before; in the unit of the figure, above 0.
    pub before: f64,
    /// Figure afterwards; in the same unit, above 0.
    pub after: f64,
    /// Averaging time at which both were read, s, above 0.
    pub averaging_time_s: f64,
}

/// What reads the same as a claimed reduction, without any noise of the gyro being less.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Lookalikes {
    /// Gain that lowers every rate, and with it the noise.
    pub dc_gain: f64,
    /// Time constant of the one-pole low pass that does it on white noise, s: its delay at DC.
    pub one_pole_time_constant_s: f64,
    /// Length of the mean that does it on white noise, s: twice its delay.
    pub mean_length_s: f64,
    /// Averaging time at which the figures were read, s.
    averaging_time_s: f64,
}

impl Claim {
    /// Part of the figure that is left.
    #[must_use]
    pub fn ratio(&self) -> f64 {
        self.after / self.before
    }

    /// What reads the same; `None` where nothing is lower than before.
    #[must_use]
    pub fn lookalikes(&self) -> Option<Lookalikes> {
        let ratio = self.ratio();
        (ratio > 0.0 && ratio < 1.0).then(|| {
            let square = ratio * ratio;
            let of = |left: &dyn Fn(f64) -> f64| self.averaging_time_s * crossing(left, square);
            Lookalikes {
                dc_gain: ratio,
                one_pole_time_constant_s: of(&|x| self.figure.left_by_one_pole(x)),
                mean_length_s: of(&|l| self.figure.left_by_mean(l)),
                averaging_time_s: self.averaging_time_s,
            }
        })
    }
}

impl Lookalikes {
    /// Taps of the mean at a rate of words, the nearest whole number; nothing where fewer than two come near,
    /// or the averaging time is shorter than a word.
    ///
    /// m words at the rate f leave `1 - (m - 1/m) / (2 tau f)` of the Allan variance: `m - 1/m` stands
    /// where the mean over a time has `L f`. The same holds for the variance of means with a third.
    #[must_use]
    pub fn mean_taps(&self, rate_hz: f64) -> Option<f64> {
        let words = 0.5 * self.mean_length_s * rate_hz;
        let taps = (words + words.hypot(1.0)).round();
        (taps >= 2.0 && self.averaging_time_s * rate_hz >= 1.0 - 1e-9).then_some(taps)
    }

    /// Delay of that mean, s: that of the middle of its taps, or of its length.
    #[must_use]
    pub fn mean_delay_s(&self, rate_hz: Option<f64>) -> f64 {
        let of_taps = rate_hz.and_then(|rate_hz| {
            let taps = self.mean_taps(rate_hz)?;
            Some(0.5 * (taps - 1.0) / rate_hz)
        });
        of_taps.unwrap_or(0.5 * self.mean_length_s)
    }

    /// Half-power frequency of the one-pole low pass, Hz.
    #[must_use]
    pub fn one_pole_cutoff_hz(&self) -> f64 {
        (std::f64::consts::TAU * self.one_pole_time_constant_s).recip()
    }
}

/// Where a function that falls from 1 to 0 passes a value; bisected in the logarithm.
fn crossing(falls: &dyn Fn(f64) -> f64, value: f64) -> f64 {
    let (mut low, mut high) = (-120.0_f64, 120.0_f64);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if falls(middle.exp()) > value {
            low = middle;
        } else {
            high = middle;
        }
    }
    (0.5 * (low + high)).exp()
}

#[cfg(test)]
mod tests {
    use super::*;
    use ClaimedFigure::{AngleRandomWalk, BiasStability};

    fn arw(before: f64, after: f64) -> Lookalikes {
        let claim = Claim {
            figure: AngleRandomWalk,
            before,
            after,
            averaging_time_s: 1.0,
        };
        claim.lookalikes().unwrap()
    }

    #[test]
    fn known_answer_published_reductions_have_their_equal_low_passes() {
        // ARW before and after, time constant and length in s, rounded as the table of claims has them.
        let table = [
            (0.0060, 0.0029, 0.78, Some(1.7)),
            (1.0, 1.0 - 0.191, 0.24, Some(0.69)),
            (7.803, 7.211, 0.10, Some(0.29)),
            (1.0, 1.0 - 0.172, 0.21, None),
            (4.58e-3, 9.03e-4, 2.5, Some(4.1)),
            (0.03741, 0.00976, 1.8, Some(3.1)),
            (1.0, 0.28, 1.7, None),
        ];
        // The table holds two digits, of which the last may be off by one.
        let is_near = |value: f64, shown: f64| (value / shown - 1.0).abs() < 0.03;
        for (before, after, time_constant_s, length_s) in table {
            let found = arw(before, after);
            let (time_s, mean_s) = (found.one_pole_time_constant_s, found.mean_length_s);
            assert!(
                is_near(time_s, time_constant_s),
                "{before} {after} {found:?}"
            );
            assert!(
                length_s.is_none_or(|shown| is_near(mean_s, shown)),
                "{before} {after} {found:?}"
            );
        }
    }

    /// Part left of the variance of unit white words, by the sum over the taps of filter and
    /// averaging together: independent of the closed forms.
    fn left_by_sum(figure: ClaimedFigure, words: usize, filter: &[f64]) -> f64 {
        let window: Vec<f64> = match figure {
            AngleRandomWalk => (0..2 * words)
                .map(|k| if k < words { 1.0 } else { -1.0 } * 0.5_f64.sqrt())
                .collect(),
            BiasStability => vec![1.0; words],
        };
        let square: f64 = window.iter().map(|it| it * it).sum();
        let mut both = vec![0.0; window.len() + filter.len()];
        for (k, weight) in filter.iter().enumerate() {
            for (j, share) in window.iter().enumerate() {
                both[k + j] += weight * share;
            }
        }
        both.iter().map(|it| it * it).sum::<f64>() / square
    }

    #[test]
    fn the_closed_forms_are_the_sums_over_the_taps() {
        const WORDS: usize = 400;
        for figure in [AngleRandomWalk, BiasStability] {
            for length in [40_usize, 400, 600, 800, 1200] {
                let mean = vec![1.0 / length as f64; length];
                let sum = left_by_sum(figure, WORDS, &mean);
                let form = figure.left_by_mean(length as f64 / WORDS as f64);
                assert!(
                    (sum / form - 1.0).abs() < 1e-3,
                    "{figure:?} {length}: {sum} {form}"
                );
            }
            for x in [0.1, 0.5, 0.999, 1.001, 3.0] {
                let decay = (-1.0 / (x * WORDS as f64)).exp();
                let pole: Vec<f64> = (0..12_000).map(|k| (1.0 - decay) * decay.powi(k)).collect();
                let sum = left_by_sum(figure, WORDS, &pole);
                let form = figure.left_by_one_pole(x);
                assert!(
                    (sum / form - 1.0).abs() < 1e-3,
                    "{figure:?} {x}: {sum} {form}"
                );
            }
        }
    }

    #[test]
    fn the_series_meets_the_closed_form_and_its_limit() {
        for figure in [AngleRandomWalk, BiasStability] {
            let (above, below) = (
                figure.left_by_one_pole(1.0 - 1e-9),
                figure.left_by_one_pole(1.0 + 1e-9),
            );
            assert!((above / below - 1.0).abs() < 1e-8, "{figure:?}");
        }
        let far = 1e8_f64;
        assert!((AngleRandomWalk.left_by_one_pole(far) * 3.0 * far * far - 1.0).abs() < 1e-7);
        assert!((BiasStability.left_by_one_pole(far) * 2.0 * far - 1.0).abs() < 1e-7);
    }

    #[test]
    fn what_is_found_leaves_the_claimed_part() {
        for figure in [AngleRandomWalk, BiasStability] {
            for ratio in [1e-9, 1e-3, 0.1, 0.3, 0.5, 0.7, 0.9, 0.999] {
                let claim = Claim {
                    figure,
                    before: 2.0,
                    after: 2.0 * ratio,
                    averaging_time_s: 10.0,
                };
                let found = claim.lookalikes().unwrap();
                let pole = figure.left_by_one_pole(found.one_pole_time_constant_s / 10.0);
                let mean = figure.left_by_mean(found.mean_length_s / 10.0);
                assert!(
                    (pole.sqrt() / ratio - 1.0).abs() < 1e-9,
                    "{figure:?} {ratio} {pole}"
                );
                assert!(
                    (mean.sqrt() / ratio - 1.0).abs() < 1e-9,
                    "{figure:?} {ratio} {mean}"
                );
            }
        }
    }

    #[test]
    fn taps_leave_the_claimed_part_to_the_nearest_whole_one() {
        // A mean of m of 1000 words in a second leaves 1 - (m - 1/m) / 2000 of the Allan variance.
        for m in [2.0_f64, 3.0, 10.0, 999.0] {
            let found = arw(1.0, (1.0 - (m - m.recip()) / 2000.0).sqrt());
            let taps = found.mean_taps(1000.0).unwrap();
            assert!((taps - m).abs() < 1e-9, "{m} {found:?}");
            assert!((found.mean_delay_s(Some(1000.0)) - (m - 1.0) / 2000.0).abs() < 1e-12);
        }
    }

    #[test]
    fn words_that_are_too_slow_have_no_taps() {
        // Two words in a second leave half of the deviation, not 98 %; of ten seconds each nothing is read at 1 s.
        let found = arw(1.0, 0.98);
        assert_eq!(found.mean_taps(1.0), None);
        let delay_s = found.mean_delay_s(Some(1.0));
        assert!((delay_s - 0.5 * found.mean_length_s).abs() < 1e-15);
        assert_eq!(arw(1.0, 0.01).mean_taps(0.1), None);
        assert_eq!(arw(1.0, 0.5).mean_taps(1.0), Some(2.0));
    }

    #[test]
    fn no_reduction_is_none() {
        for after in [1.0, 1.5, f64::INFINITY, f64::NAN] {
            let claim = Claim {
                figure: AngleRandomWalk,
                before: 1.0,
                after,
                averaging_time_s: 1.0,
            };
            assert_eq!(claim.lookalikes(), None, "{after}");
        }
    }
}
