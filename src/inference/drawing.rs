//! Figures as a record would print them: drawn from their forecasts, and printed.

use nalgebra::{DMatrix, DVector};

use crate::inference::forecast::{Forecasts, Print, Printed};
use crate::random::Stream;

/// Least pivot of a factor: correlations of one half and more of a percent of a variance are not told apart
/// from 1.
const PIVOT_MIN: f64 = 1e-9;

impl Forecasts {
    /// Correlations of the deviates as a matrix; figures without a forecast stand alone.
    #[must_use]
    pub fn correlation_matrix(&self) -> DMatrix<f64> {
        let count = self.figures.len();
        let mut matrix = DMatrix::identity(count, count);
        for &(one, other, correlation) in &self.correlations {
            matrix[(one, other)] = correlation;
            matrix[(other, one)] = correlation;
        }
        matrix
    }

    /// Figures of one draw of all records, each without the print; none of one without a forecast.
    #[must_use]
    pub fn drawn(&self, stream: &mut Stream) -> Vec<Option<f64>> {
        let count = self.figures.len();
        let normals = DVector::from_fn(count, |_, _| stream.normal());
        let deviates = lower_factor(self.correlation_matrix(), |_| PIVOT_MIN) * normals;
        let figures = self.figures.iter().zip(deviates.iter());
        figures
            .map(|(forecast, deviate)| forecast.as_ref().map(|own| own.figure(*deviate)))
            .collect()
    }
}

impl Printed {
    /// The same print with another figure in it.
    #[must_use]
    pub fn with(&self, figure: f64, stream: &mut Stream) -> Self {
        let value = match self.print {
            Print::Rounded { step } => (figure / step).round() * step,
            Print::Stated { deviation } => figure + deviation * stream.normal(),
        };
        Self { value, ..*self }
    }
}

/// Lower factor of a covariance matrix.
///
/// * `floor`: least pivot of a variance, in place of one that is not positive by rounding.
pub(crate) fn lower_factor(mut matrix: DMatrix<f64>, floor: impl Fn(f64) -> f64) -> DMatrix<f64> {
    let count = matrix.nrows();
    for column in 0..count {
        let done: f64 = (0..column).map(|k| matrix[(column, k)].powi(2)).sum();
        let own = matrix[(column, column)];
        let pivot = (own - done).max(floor(own)).sqrt();
        matrix[(column, column)] = pivot;
        for row in column + 1..count {
            let done: f64 = (0..column)
                .map(|k| matrix[(row, k)] * matrix[(column, k)])
                .sum();
            matrix[(row, column)] = (matrix[(row, column)] - done) / pivot;
        }
    }
    matrix.lower_triangle()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inference::forecast::Forecast;
    use crate::random::Streams;

    #[test]
    fn drawn_figures_have_the_mean_spread_and_correlation_of_their_forecasts() {
        let forecasts = Forecasts {
            figures: vec![
                Some(Forecast::normal(10.0, 2.0)),
                None,
                Some(Forecast::squares(4.0, 50.0)),
            ],
            correlations: vec![(0, 2, 0.8)],
        };
        let mut stream = Streams::new(1, 0).stream("test");
        let draws = 4000;
        let mut sums = [0.0; 5];
        for _ in 0..draws {
            let drawn = forecasts.drawn(&mut stream);
            assert_eq!(drawn[1], None);
            let (Some(one), Some(two)) = (drawn[0], drawn[2]) else {
                panic!("both have forecasts");
            };
            let (one, two) = ((one - 10.0) / 2.0, (two - 2.0) / 0.2);
            let products = [one, two, one * one, two * two, one * two];
            for (sum, product) in sums.iter_mut().zip(products) {
                *sum += product / f64::from(draws);
            }
        }
        let expected = [0.0, 0.0, 1.0, 1.0, 0.8];
        for (found, expected) in sums.iter().zip(expected) {
            assert!((found - expected).abs() < 0.06, "{sums:?}");
        }
    }

    #[test]
    fn a_print_rounds_to_its_step() {
        let mut stream = Streams::new(1, 0).stream("test");
        let print = Print::Rounded { step: 0.01 };
        let printed = Printed { value: 0.0, print };
        assert!((printed.with(0.3764, &mut stream).value - 0.38).abs() < 1e-12);
    }
}
