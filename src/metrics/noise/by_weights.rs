//! The noise of a channel as its filter's weights make it of raw's.

use crate::metrics::estimate::influence::Learned;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::noise::autocovariance::LaggedProducts;
use crate::metrics::record::{FilterFacts, WeightScatter};

/// Autocovariance of a channel as a function of its filter's mean weights, with how these scatter.
pub(crate) struct NoiseByWeights {
    weights: Vec<f64>,
    raw: Vec<f64>,
    scatter: WeightScatter,
}

impl NoiseByWeights {
    /// Of a channel without weights that learn.
    pub(crate) fn none() -> Self {
        Self {
            weights: Vec::new(),
            raw: Vec::new(),
            scatter: WeightScatter::Blocks,
        }
    }

    /// Of a filter over a record of so many samples, from the part `from` of it on, in which raw's
    /// noise has these products.
    pub(crate) fn new(
        facts: &FilterFacts,
        raw: &LaggedProducts,
        samples: usize,
        from: f64,
    ) -> Self {
        let scatter = facts.weight_scatter(samples, from);
        let raw = raw.autocovariance();
        match &facts.mean_weights {
            Some(weights) if raw.len() > weights.len() => Self {
                weights: weights.clone(),
                raw,
                scatter,
            },
            _ => Self {
                scatter,
                ..Self::none()
            },
        }
    }

    /// What each stretch adds, through the weights, to a function of the channel's autocovariance at
    /// lags 0 and 1; `None` where it is in the blocks of the channel.
    pub(crate) fn of(&self, of: impl Fn([f64; 2]) -> f64) -> Option<Learned> {
        if self.weights.is_empty() {
            return None;
        }
        let noise = |weights: &[f64]| [0, 1].map(|lag| filtered(weights, &self.raw, lag));
        self.scatter
            .of(Some(&self.weights), |weights| of(noise(weights)))
    }

    /// Variance of raw's noise.
    pub(crate) fn raw_power(&self) -> f64 {
        self.raw.first().copied().unwrap_or(f64::NAN)
    }

    /// The estimate, without its interval where the scatter of the weights is not known.
    pub(crate) fn unless_unknown(&self, estimate: Estimate) -> Estimate {
        self.scatter.unless_unknown(estimate)
    }
}

/// Autocovariance at a lag of what weights make of noise: `sum w_i w_j R(lag + i - j)`.
fn filtered(weights: &[f64], raw: &[f64], lag: usize) -> f64 {
    let products = weights.iter().enumerate().flat_map(|(i, a)| {
        let others = weights.iter().enumerate();
        others.map(move |(j, b)| a * b * raw[(lag + i).abs_diff(j)])
    });
    products.sum()
}
