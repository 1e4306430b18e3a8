//! Forecasts of figures that one record or several give, and how likely printed ones are beside them.

use statrs::function::erf::erfc;

/// How a figure scatters from record to record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scatter {
    /// As a normal deviate.
    Normal,
    /// As the root of a sum of squares with so many degrees of freedom.
    Squares {
        /// Degrees of freedom.
        freedom: f64,
    },
}

/// What a figure is expected to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forecast {
    /// Expected value; of squares the root of their expectation.
    pub value: f64,
    /// Standard deviation over records.
    pub deviation: f64,
    /// How it scatters.
    pub scatter: Scatter,
}

impl Forecast {
    /// A figure that scatters as a normal deviate.
    #[must_use]
    pub fn normal(value: f64, deviation: f64) -> Self {
        Self {
            value,
            deviation,
            scatter: Scatter::Normal,
        }
    }

    /// The root of a mean square with its degrees of freedom.
    #[must_use]
    pub fn squares(square: f64, freedom: f64) -> Self {
        let value = square.sqrt();
        Self {
            value,
            deviation: value / (2.0 * freedom).sqrt(),
            scatter: Scatter::Squares { freedom },
        }
    }

    /// The same with another standard deviation.
    #[must_use]
    pub fn with_deviation(&self, deviation: f64) -> Self {
        match self.scatter {
            Scatter::Normal => Self { deviation, ..*self },
            Scatter::Squares { .. } => {
                let freedom = (0.5 * (self.value / deviation).powi(2)).max(1.0);
                Self::squares(self.value * self.value, freedom)
            }
        }
    }

    /// The figure as a unit normal deviate.
    ///
    /// Of squares by the cube root.
    ///
    /// # Source
    /// Wilson and Hilferty, Proc. Nat. Acad. Sci. 17 (1931) 684.
    #[must_use]
    pub fn deviate(&self, figure: f64) -> f64 {
        match self.scatter {
            Scatter::Normal => (figure - self.value) / self.deviation.max(f64::MIN_POSITIVE),
            Scatter::Squares { freedom } => {
                let spread = 2.0 / (9.0 * freedom);
                let root = (figure.max(0.0) / self.value).powf(2.0 / 3.0);
                (root - (1.0 - spread)) / spread.sqrt()
            }
        }
    }

    /// The figure at a unit normal deviate.
    #[must_use]
    pub fn figure(&self, deviate: f64) -> f64 {
        match self.scatter {
            Scatter::Normal => self.value + deviate * self.deviation,
            Scatter::Squares { freedom } => {
                let spread = 2.0 / (9.0 * freedom);
                let root = (1.0 - spread + deviate * spread.sqrt()).max(0.0);
                self.value * root.powf(1.5)
            }
        }
    }
}

/// Forecasts of all figures.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Forecasts {
    /// By figure; none where there is none.
    pub figures: Vec<Option<Forecast>>,
    /// Correlations of deviates of figures of one record, each pair once, the earlier figure first.
    pub correlations: Vec<(usize, usize, f64)>,
}

/// How a figure was printed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Print {
    /// Rounded to a step: it lies within half a step.
    Rounded {
        /// Step.
        step: f64,
    },
    /// With a standard uncertainty.
    Stated {
        /// Standard uncertainty.
        deviation: f64,
    },
}

/// A printed figure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Printed {
    /// Value.
    pub value: f64,
    /// How it was printed.
    pub print: Print,
}

impl Printed {
    /// Standard deviation of what printing adds.
    #[must_use]
    pub fn deviation(&self) -> f64 {
        match self.print {
            Print::Rounded { step } => step / 12.0_f64.sqrt(),
            Print::Stated { deviation } => deviation,
        }
    }

    /// Width of the values that the print stands for.
    fn width(&self) -> f64 {
        match self.print {
            Print::Rounded { step } => step,
            Print::Stated { deviation } => deviation * std::f64::consts::TAU.sqrt(),
        }
    }

    /// Probability of the print if the metric is not what its name says: equally likely by the
    /// logarithm over ten orders of magnitude.
    fn anywhere(&self) -> f64 {
        const SPAN: f64 = 23.0;
        (self.width() / self.value.abs().max(self.width()) / SPAN).min(1.0)
    }

    /// Probability of the print and what it leaves of a deviate of the given mean and variance: its
    /// mean and variance after.
    fn of(&self, forecast: &Forecast, mean: f64, variance: f64) -> (f64, f64, f64) {
        let spread = variance.max(1e-12).sqrt();
        match self.print {
            Print::Rounded { step } => {
                let low = (forecast.deviate(self.value - 0.5 * step) - mean) / spread;
                let high = (forecast.deviate(self.value + 0.5 * step) - mean) / spread;
                let (probability, centre, left) = truncated(low, high);
                (probability, mean + spread * centre, variance * left)
            }
            Print::Stated { deviation } => {
                let at = forecast.deviate(self.value);
                let slope = forecast.deviate(self.value + 0.5 * deviation)
                    - forecast.deviate(self.value - 0.5 * deviation);
                let noise = slope * slope;
                let total = variance + noise;
                let gain = variance / total;
                let chi = (at - mean) * (at - mean) / total;
                let probability = (noise / total).sqrt() * (-0.5 * chi).exp();
                (
                    probability,
                    mean + gain * (at - mean),
                    variance * (1.0 - gain),
                )
            }
        }
    }
}

/// Probability of a unit normal deviate between two limits, and its mean and variance there.
fn truncated(low: f64, high: f64) -> (f64, f64, f64) {
    let density = |z: f64| (-0.5 * z * z).exp() / std::f64::consts::TAU.sqrt();
    let width = high - low;
    let middle = 0.5 * (low + high);
    if width < 1e-3 {
        return (density(middle) * width, middle, width * width / 12.0);
    }
    let probability = between(low, high);
    if probability < 1e-300 {
        let nearest = if low > 0.0 { low } else { high };
        return (0.0, nearest, 0.0);
    }
    let mean = ((density(low) - density(high)) / probability).clamp(low, high);
    let edge = |z: f64| if z.is_finite() { z * density(z) } else { 0.0 };
    let variance = 1.0 + (edge(low) - edge(high)) / probability - mean * mean;
    (probability, mean, variance.clamp(0.0, 1.0))
}

/// Probability of a unit normal deviate between two limits.
fn between(low: f64, high: f64) -> f64 {
    let above = |z: f64| 0.5 * erfc(z / std::f64::consts::SQRT_2);
    if low > 0.0 {
        above(low) - above(high)
    } else {
        above(-high) - above(-low)
    }
}

/// How likely printed figures are beside a forecast.
#[derive(Clone, Debug, PartialEq)]
pub struct Likelihood {
    /// Logarithm of the probability of all.
    pub logarithm: f64,
    /// Mean and variance of the deviate of the figure that was left to the end, given all others.
    pub last: Option<(f64, f64)>,
}

/// Probability of all printed figures that have a forecast, one after the other, each given those before.
///
/// A figure is with the probability `doubt` not what its name says and then tells nothing. With `left_out`
/// that figure comes last and its own probability is left out.
///
/// # Source
/// Mendell and Elston, Biometrics 30 (1974) 41: each interval is passed on by its mean and variance,
/// which is exact for narrow ones and for figures that are independent.
#[must_use]
pub fn likelihood(
    printed: &[Printed],
    forecasts: &Forecasts,
    doubt: f64,
    left_out: Option<usize>,
) -> Likelihood {
    let count = printed.len();
    let mut group: Vec<usize> = (0..count).collect();
    for &(own, other, _) in &forecasts.correlations {
        let (from, to) = (group[other], group[own]);
        if from != to {
            for name in &mut group {
                if *name == from {
                    *name = to;
                }
            }
        }
    }
    let mut logarithm = 0.0;
    let mut last = None;
    for name in 0..count {
        let of_group = |index: &usize| group[*index] == name && forecasts.figures[*index].is_some();
        let mut members: Vec<usize> = (0..count).filter(of_group).collect();
        if let Some(left_out) = left_out
            && let Some(place) = members.iter().position(|member| *member == left_out)
        {
            members.remove(place);
            members.push(left_out);
        }
        let found = one_after_the_other(printed, forecasts, doubt, (&members, left_out));
        logarithm += found.logarithm;
        last = last.or(found.last);
    }
    Likelihood { logarithm, last }
}

/// The likelihood of figures that are correlated.
fn one_after_the_other(
    printed: &[Printed],
    forecasts: &Forecasts,
    doubt: f64,
    (members, left_out): (&[usize], Option<usize>),
) -> Likelihood {
    let count = members.len();
    let mut means = vec![0.0; count];
    let mut covariance = vec![0.0; count * count];
    for index in 0..count {
        covariance[index * count + index] = 1.0;
    }
    let place = |figure: usize| members.iter().position(|member| *member == figure);
    for &(own, other, correlation) in &forecasts.correlations {
        if let (Some(row), Some(column)) = (place(own), place(other)) {
            covariance[row * count + column] = correlation;
            covariance[column * count + row] = correlation;
        }
    }
    let mut logarithm = 0.0;
    for (index, &member) in members.iter().enumerate() {
        let (mean, variance) = (means[index], covariance[index * count + index]);
        if left_out == Some(member) {
            let last = Some((mean, variance));
            return Likelihood { logarithm, last };
        }
        let Some(forecast) = &forecasts.figures[member] else {
            continue;
        };
        let (probability, after, left) = printed[member].of(forecast, mean, variance);
        let trusted = (1.0 - doubt) * probability;
        let whole = trusted + doubt * printed[member].anywhere();
        logarithm += whole.ln();
        if count == 1 || variance <= 1e-12 {
            continue;
        }
        let trust = trusted / whole;
        let column: Vec<f64> = (0..count)
            .map(|row| covariance[row * count + index] / variance)
            .collect();
        let shrink = trust * (variance - left);
        for row in 0..count {
            means[row] += trust * column[row] * (after - mean);
            for other in 0..count {
                covariance[row * count + other] -= column[row] * column[other] * shrink;
            }
        }
    }
    Likelihood {
        logarithm,
        last: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_turn_into_normal_deviates_and_back() {
        let forecast = Forecast::squares(4.0, 30.0);
        for figure in [1.2, 1.9, 2.0, 2.7] {
            assert!((forecast.figure(forecast.deviate(figure)) - figure).abs() < 1e-12);
        }
        // 97.5 % of chi-square with 30 degrees of freedom: 46.979.
        let high = forecast.figure(1.959_964);
        assert!(
            (high / 2.0 - (46.979_f64 / 30.0).sqrt()).abs() < 2e-3,
            "{high}"
        );
    }

    #[test]
    fn the_probability_of_two_correlated_boxes_is_that_of_quadrature() {
        let forecast = Forecast::normal(0.0, 1.0);
        let rounded = |value, step| Printed {
            value,
            print: Print::Rounded { step },
        };
        for (rho, steps) in [(0.0, (1.0, 2.0)), (0.7, (0.1, 0.1)), (0.9, (1.0, 0.5))] {
            let printed = [rounded(0.4, steps.0), rounded(0.1, steps.1)];
            let forecasts = Forecasts {
                figures: vec![Some(forecast); 2],
                correlations: vec![(0, 1, rho)],
            };
            let found = likelihood(&printed, &forecasts, 1e-12, None)
                .logarithm
                .exp();
            // Midpoint rule over the first, closed form for the second.
            let nodes = 4000;
            let cell = steps.0 / f64::from(nodes);
            let exact: f64 = (0..nodes)
                .map(|node| {
                    let x = 0.4 - 0.5 * steps.0 + (f64::from(node) + 0.5) * cell;
                    let spread = (1.0_f64 - rho * rho).sqrt();
                    let at = |y: f64| (y - rho * x) / spread;
                    let inner = between(at(0.1 - 0.5 * steps.1), at(0.1 + 0.5 * steps.1));
                    cell * (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt() * inner
                })
                .sum();
            assert!((found / exact - 1.0).abs() < 0.02, "{rho}: {found} {exact}");
        }
    }

    #[test]
    fn a_figure_that_is_left_out_is_forecast_from_the_others() {
        let forecast = Forecast::normal(10.0, 1.0);
        let printed = [11.0, 10.0].map(|value| Printed {
            value,
            print: Print::Stated { deviation: 1e-6 },
        });
        let forecasts = Forecasts {
            figures: vec![Some(forecast); 2],
            correlations: vec![(0, 1, 0.8)],
        };
        let found = likelihood(&printed, &forecasts, 1e-9, Some(1)).last;
        let (mean, variance) = found.expect("the second figure comes last");
        assert!(
            (mean - 0.8).abs() < 1e-3 && (variance - 0.36).abs() < 1e-3,
            "{mean} {variance}"
        );
    }
}
