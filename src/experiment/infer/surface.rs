//! A figure between points of the priors at which it was simulated.

use nalgebra::{DMatrix, DVector};

use crate::inference::Forecast;

/// Points beyond the terms of a surface that its scatter is told from.
const FREEDOM_MIN: usize = 8;

/// A figure as a quadratic in the parts of the priors, with how far records scatter about it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Surface {
    /// Place of the figure.
    pub(super) figure: usize,
    /// Parameters that move its record.
    acting: Vec<usize>,
    /// Whether the logarithm is fitted: of figures that are all above 0.
    is_logarithmic: bool,
    /// Whether it scatters as the root of a sum of squares.
    is_squares: bool,
    coefficients: DVector<f64>,
    /// Inverse of the normal matrix.
    inverse: DMatrix<f64>,
    /// Variance of what is left.
    variance: f64,
}

/// What stands for figures under a reading.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Surfaces {
    /// By figure.
    pub(super) surfaces: Vec<Surface>,
    /// Correlations of what is left of figures of one record.
    pub(super) correlations: Vec<(usize, usize, f64)>,
}

impl Surface {
    /// Fits a surface by least squares, with what is left at each point; none of too few points.
    ///
    /// * `points`: parts of the priors, and the figure there.
    pub(super) fn fit(
        (figure, is_squares): (usize, bool),
        acting: &[usize],
        points: &[(&[f64], f64)],
    ) -> Option<(Self, Vec<f64>)> {
        let is_logarithmic = points.iter().all(|(_, value)| *value > 0.0);
        let rows: Vec<DVector<f64>> = points
            .iter()
            .map(|(parts, _)| terms(acting, parts))
            .collect();
        let count = rows.first()?.len();
        let freedom = points.len().checked_sub(count)?;
        (freedom >= FREEDOM_MIN).then_some(())?;
        let design = DMatrix::from_fn(points.len(), count, |row, column| rows[row][column]);
        let values = points.iter().map(
            |(_, value)| {
                if is_logarithmic { value.ln() } else { *value }
            },
        );
        let values = DVector::from_iterator(points.len(), values);
        let inverse = (design.transpose() * &design).cholesky()?.inverse();
        let coefficients = &inverse * design.transpose() * &values;
        let left = values - design * &coefficients;
        let surface = Self {
            figure,
            acting: acting.to_vec(),
            is_logarithmic,
            is_squares,
            coefficients,
            inverse,
            variance: left.norm_squared() / freedom as f64,
        };
        Some((surface, left.iter().copied().collect()))
    }

    /// The figure at parts of the priors: its scatter is that of records and of the surface itself.
    pub(super) fn at(&self, parts: &[f64]) -> Forecast {
        let terms = terms(&self.acting, parts);
        let fitted = terms.dot(&self.coefficients);
        let leverage = terms.dot(&(&self.inverse * &terms));
        let variance = self.variance * (1.0 + leverage);
        match (self.is_logarithmic, self.is_squares) {
            (false, _) => Forecast::normal(fitted, variance.sqrt()),
            (true, false) => {
                let value = fitted.exp();
                Forecast::normal(value, value * variance.sqrt())
            }
            // Of n degrees of freedom the logarithm of the root has the variance 1/(2n), and a mean as much
            // below that of its expectation.
            (true, true) => {
                let value = (fitted + variance).exp();
                Forecast::squares(value * value, (0.5 / variance).max(1.0))
            }
        }
    }
}

/// Terms of a surface: 1, every part from -1 to 1, its square, and the products.
fn terms(acting: &[usize], parts: &[f64]) -> DVector<f64> {
    let centred: Vec<f64> = acting.iter().map(|own| 2.0 * parts[*own] - 1.0).collect();
    let mut terms = vec![1.0];
    for (place, own) in centred.iter().enumerate() {
        terms.push(*own);
        terms.extend(centred[..=place].iter().map(|other| own * other));
    }
    DVector::from_vec(terms)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Streams;

    #[test]
    fn a_surface_has_the_value_and_the_scatter_of_what_it_was_fitted_to() {
        let mut stream = Streams::new(1, 0).stream("test");
        let truth = |parts: &[f64]| (0.3 + parts[0] - 0.5 * parts[0] * parts[2]).exp();
        let points: Vec<Vec<f64>> = (0..400)
            .map(|_| (0..3).map(|_| stream.uniform()).collect())
            .collect();
        let told: Vec<(&[f64], f64)> = points
            .iter()
            .map(|parts| {
                (
                    parts.as_slice(),
                    truth(parts) * (1.0 + 0.02 * stream.normal()),
                )
            })
            .collect();
        let (surface, left) = Surface::fit((4, false), &[0, 2], &told).expect("a surface");
        assert_eq!((surface.figure, left.len()), (4, 400));
        let at = [0.7, 0.1, 0.4];
        let found = surface.at(&at);
        assert!((found.value / truth(&at) - 1.0).abs() < 0.01, "{found:?}");
        assert!(
            (found.deviation / found.value - 0.02).abs() < 0.004,
            "{found:?}"
        );
        // Two parameters have six terms.
        assert!(Surface::fit((0, false), &[0, 2], &told[..13]).is_none());
    }
}
