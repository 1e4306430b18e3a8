//! Intervals from what each stretch of a record adds to a figure, and what a filter has learned from it.

use super::interval;
use super::value::Estimate;

/// What each stretch of the words adds to a figure through the weights of a filter.
#[derive(Clone, Debug)]
pub(crate) struct Learned {
    /// By stretch, those of the warm-up first.
    pub(crate) parts: Vec<f64>,
    /// Stretches before the record.
    pub(crate) warm_up: usize,
    /// Degrees of freedom of their scatter.
    pub(crate) freedom: f64,
}

impl Learned {
    /// Spread of the figure by the weights alone.
    pub(crate) fn spread(&self) -> Spread {
        Spread {
            variance: self.parts.iter().map(|part| part * part).sum(),
            freedom: self.freedom,
        }
    }

    /// The same of the figure over something, or in another unit.
    pub(crate) fn scaled(mut self, factor: f64) -> Self {
        for part in &mut self.parts {
            *part *= factor;
        }
        self
    }
}

/// Half width of an interval, as a part of its value, that sums of millions of rounded samples make.
const ROUNDING: f64 = 1e-10;

/// A variance and its degrees of freedom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Spread {
    /// Variance of the estimate.
    pub(crate) variance: f64,
    /// Degrees of freedom of that variance.
    pub(crate) freedom: f64,
}

impl Spread {
    /// The spread of a sum with an independent part.
    ///
    /// Source: Welch and Satterthwaite for the degrees of freedom.
    pub(crate) fn plus(self, other: Self) -> Self {
        let variance = self.variance + other.variance;
        let share = |of: Self| of.variance * of.variance / of.freedom.max(1.0);
        let squares = share(self) + share(other);
        let freedom = if squares > 0.0 {
            variance * variance / squares
        } else {
            self.freedom.min(other.freedom)
        };
        Self { variance, freedom }
    }

    /// A variance that is known.
    pub(crate) fn known(variance: f64) -> Self {
        Self {
            variance,
            freedom: f64::INFINITY,
        }
    }

    /// The spread that an estimate's interval says it has.
    pub(crate) fn of(estimate: &Estimate) -> Self {
        let half_width = 0.5 * (estimate.high - estimate.low);
        Self::known((half_width / interval::NORMAL_QUANTILE).powi(2))
    }

    /// The spread of the quantity times a factor.
    pub(crate) fn scaled(self, factor: f64) -> Self {
        Self {
            variance: self.variance * factor * factor,
            ..self
        }
    }

    /// Half width of the 95 % interval by Student's t.
    pub(crate) fn half_width(self) -> f64 {
        interval::student_quantile(self.freedom) * self.variance.max(0.0).sqrt()
    }

    /// `value` with the symmetric interval of this spread; an interval no wider than rounding makes
    /// it is none, and the value exact.
    pub(crate) fn about(self, value: f64) -> Estimate {
        let half_width = self.half_width();
        if half_width <= ROUNDING * value.abs() {
            return Estimate::exact(value);
        }
        Estimate::symmetric(value, half_width)
    }
}

/// Spread of a figure from its versions with each block of the record left out and, where its filter
/// forgets nothing, from what each of these blocks, and those before the record, taught the filter.
///
/// A block adds `(n - 1) / n (mean - theta_i)` to the figure by its output, and its part by the
/// weights; both come from the same noise, so that they are added before they are squared.
pub(crate) fn spread(left_out: &[f64], learned: Option<&Learned>) -> Spread {
    let count = left_out.len() as f64;
    let jackknifed = Spread {
        variance: interval::sample_variance(left_out) * (count - 1.0) * (count - 1.0) / count,
        freedom: count - 1.0,
    };
    let Some(learned) = learned else {
        return jackknifed;
    };
    let together = jackknifed.plus(learned.spread());
    if learned.parts.len() != left_out.len() + learned.warm_up {
        return together;
    }
    let centre = interval::mean(left_out);
    let shrink = ((count - 1.0) / count).sqrt();
    let (before, within) = learned.parts.split_at(learned.warm_up);
    let squares = |parts: &[f64]| parts.iter().map(|part| part * part).sum::<f64>();
    let sums: Vec<f64> = left_out
        .iter()
        .zip(within)
        .map(|(without, part)| shrink * (centre - without) + part)
        .collect();
    Spread {
        variance: squares(before) + squares(&sums),
        ..together
    }
}

/// `value` with the interval of [`spread`]; fewer than two blocks give none.
pub(crate) fn resampled(value: f64, left_out: &[f64], learned: Option<&Learned>) -> Estimate {
    if left_out.len() < 2 {
        return Estimate::without_interval(value, interval::TOO_FEW_BLOCKS);
    }
    spread(left_out, learned).about(value)
}
