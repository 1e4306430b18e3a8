//! How a fitted square scatters about the true one, and the interval that follows.

/// Halvings of an interval in which an end is sought.
const BISECTIONS: usize = 60;

/// True squares, in units of a scale, at which the third cumulant is worked out.
pub(crate) const THIRD_AT: [f64; 4] = [0.0, 1.0, 2.0, 4.0];

/// Largest skewness of the shifted gamma variable, that of one degree of freedom.
const SKEWNESS_MAX: f64 = 2.8;

/// How an estimated square scatters, as a function of the true one.
pub(crate) struct Sampling {
    /// Variance: coefficients of the powers 0, 1, 2 of the true square.
    pub(crate) powers: [f64; 3],
    /// Third cumulant at [`THIRD_AT`] times the scale; a cubic goes through them.
    pub(crate) thirds: [f64; 4],
    /// Unit of [`THIRD_AT`].
    pub(crate) scale: f64,
}

impl Sampling {
    /// Quantile of the estimate for a true square, given that of the standard normal distribution.
    ///
    /// The estimate is taken as a gamma variable shifted to the right mean, variance and third
    /// cumulant. Source: Wilson and Hilferty, PNAS 17 (1931) 684.
    fn quantile(&self, truth: f64, normal: f64) -> f64 {
        let [p0, p1, p2] = self.powers;
        let deviation = (p0 + p1 * truth + p2 * truth * truth).max(0.0).sqrt();
        let skewness = self.third(truth) / deviation.powi(3).max(f64::MIN_POSITIVE);
        let skewness = skewness.clamp(-SKEWNESS_MAX, SKEWNESS_MAX);
        let standard = if skewness.abs() > 1e-6 {
            let cube = 1.0 + skewness * normal / 6.0 - skewness * skewness / 36.0;
            (2.0 / skewness) * (cube.max(0.0).powi(3) - 1.0)
        } else {
            normal
        };
        truth + deviation * standard
    }

    /// Third cumulant by Lagrange's cubic.
    fn third(&self, truth: f64) -> f64 {
        let x = truth / self.scale.max(f64::MIN_POSITIVE);
        let weight = |node: usize| -> f64 {
            (0..THIRD_AT.len())
                .filter(|&other| other != node)
                .map(|other| (x - THIRD_AT[other]) / (THIRD_AT[node] - THIRD_AT[other]))
                .product()
        };
        (0..THIRD_AT.len())
            .map(|node| weight(node) * self.thirds[node])
            .sum()
    }

    /// The true square under which the found one is the quantile; 0 at least.
    pub(crate) fn end(&self, found: f64, normal: f64) -> f64 {
        let at = |truth: f64| self.quantile(truth, normal);
        let mut low = 0.0;
        if at(low) >= found {
            return low;
        }
        let mut high = self.scale;
        for _ in 0..BISECTIONS {
            if at(high) >= found {
                break;
            }
            low = high;
            high *= 2.0;
        }
        for _ in 0..BISECTIONS {
            let middle = (low + high) / 2.0;
            if at(middle) >= found {
                high = middle;
            } else {
                low = middle;
            }
        }
        (low + high) / 2.0
    }
}
