//! Least squares under noise that is white and, in part, correlated over an unknown time.
//!
//! The noise of equally spaced means is taken as white noise and one exponentially correlated noise. How much
//! of it is correlated, and over how many means, is not fixed but averaged over: every pair of a grid has a
//! weight by its restricted likelihood, under which a drift of any kind from white to a random walk is the
//! right one or near it. What is told apart only by trusting one of them gets the interval that follows.
//!
//! # Source
//! Harville, Maximum likelihood approaches to variance component estimation, JASA 72 (1977), for the
//! restricted likelihood; Harvey, Forecasting, structural time series models and the Kalman filter, 1989,
//! section 3.4, for least squares by the filter's innovations.

use nalgebra::{DMatrix, DVector};

/// Most columns of a design, the values not counted.
pub(crate) const COLUMNS_MAX: usize = 8;

/// Correlation times, means: powers of two up to several records.
const CORRELATION_TIMES: i32 = 12;

/// Variances of the correlated noise over that of the white: half decades from the least that shows.
const RATIOS: (i32, i32) = (-3, 8);

/// Coefficients with their covariance.
#[derive(Clone, Debug)]
pub(crate) struct CorrelatedFit {
    /// Coefficients, by column.
    pub(crate) coefficients: Vec<f64>,
    /// Variance of each.
    pub(crate) variances: Vec<f64>,
    /// Degrees of freedom of the variance of the noise.
    pub(crate) freedom: f64,
}

/// A row of a design with its value behind the columns.
type Wide = [f64; COLUMNS_MAX + 1];

/// Least squares under one noise.
struct Candidate {
    /// Variance of the white noise.
    variance: f64,
    coefficients: DVector<f64>,
    covariance: DMatrix<f64>,
    log_likelihood: f64,
}

/// Sums of products under one noise: of all columns and the values, and the logarithm of its determinant.
struct Whitened {
    products: [Wide; COLUMNS_MAX + 1],
    log_determinant: f64,
    rows: usize,
}

/// Fits the columns of a design to values; nothing where they do not determine their coefficients.
///
/// * `columns`: by column, of one length with the values; a row with a number that is none is missing.
pub(crate) fn fit_correlated(columns: &[Vec<f64>], values: &[f64]) -> Option<CorrelatedFit> {
    let count = columns.len();
    let rows = rows_of(columns, values)?;
    let sizes = sizes_of(&rows, count)?;
    let candidates: Vec<Candidate> = noises()
        .filter_map(|noise| candidate(&whitened(&rows, count, noise), &sizes))
        .collect();
    averaged(&candidates, rows.iter().flatten().count() - count)
}

/// The rows of a design with the value behind them; nothing of one with a number missing.
fn rows_of(columns: &[Vec<f64>], values: &[f64]) -> Option<Vec<Option<Wide>>> {
    if columns.len() > COLUMNS_MAX {
        return None;
    }
    let rows = (0..values.len()).map(|row| {
        let mut all = [0.0; COLUMNS_MAX + 1];
        for (place, column) in all.iter_mut().zip(columns) {
            *place = column[row];
        }
        all[columns.len()] = values[row];
        all.iter().all(|it| it.is_finite()).then_some(all)
    });
    Some(rows.collect())
}

/// Sizes of the columns; nothing where one is empty, or there are too few rows.
fn sizes_of(rows: &[Option<Wide>], count: usize) -> Option<Vec<f64>> {
    let present = || rows.iter().flatten();
    let size = |column: usize| {
        let squares: f64 = present().map(|row| row[column].powi(2)).sum();
        squares.sqrt()
    };
    let sizes: Vec<f64> = (0..count).map(size).collect();
    let is_sound = sizes.iter().all(|size| *size > 0.0) && present().count() > count + 2;
    is_sound.then_some(sizes)
}

/// Plain least squares, its variances those of noise as [`fit_correlated`] finds it: for columns that only say in
/// outline what the values do, of which weights would pick a part.
pub(crate) fn fit_plainly(columns: &[Vec<f64>], values: &[f64]) -> Option<CorrelatedFit> {
    let count = columns.len();
    let rows = rows_of(columns, values)?;
    let sizes = sizes_of(&rows, count)?;
    let plain = whitened(&rows, count, (0.0, 0.0));
    let plain = candidate(&plain, &sizes)?;
    // The covariance of the plain fit is the inverse of the products times the variance of its residuals.
    let inverse = &plain.covariance / plain.variance;
    let candidates = noises().filter_map(|noise| {
        let found = candidate(&whitened(&rows, count, noise), &sizes)?;
        let covariance =
            &inverse * correlated_products(&rows, count, noise) * &inverse * found.variance;
        Some(Candidate {
            coefficients: plain.coefficients.clone(),
            covariance,
            ..found
        })
    });
    let candidates: Vec<Candidate> = candidates.collect();
    averaged(&candidates, rows.iter().flatten().count() - count)
}

/// `X' V X`, the white noise of variance 1.
fn correlated_products(
    rows: &[Option<Wide>],
    count: usize,
    (correlation, ratio): (f64, f64),
) -> DMatrix<f64> {
    let mut products = DMatrix::zeros(count, count);
    // Sums of the rows before, by their correlation with the one at hand.
    let mut before = [0.0; COLUMNS_MAX + 1];
    for row in rows {
        for sum in &mut before {
            *sum *= correlation;
        }
        let Some(row) = row else { continue };
        for one in 0..count {
            for other in 0..count {
                let across = before[one] * row[other] + row[one] * before[other];
                products[(one, other)] += (1.0 + ratio) * row[one] * row[other] + ratio * across;
            }
        }
        for (sum, value) in before.iter_mut().zip(row) {
            *sum += value;
        }
    }
    products
}

/// Correlation from one mean to the next and ratio of the variances: none correlated, then the grid.
fn noises() -> impl Iterator<Item = (f64, f64)> {
    let times = (0..CORRELATION_TIMES).map(|power| (-(0.5_f64.powi(power))).exp());
    let grid = times.flat_map(|correlation| {
        (RATIOS.0..=RATIOS.1)
            .map(move |half_decade| (correlation, 10.0_f64.powf(0.5 * f64::from(half_decade))))
    });
    std::iter::once((0.0, 0.0)).chain(grid)
}

/// What the innovations of a filter for the noise leave of every column: white, of variance 1.
fn whitened(rows: &[Option<Wide>], count: usize, (correlation, ratio): (f64, f64)) -> Whitened {
    let mut found = Whitened {
        products: [[0.0; COLUMNS_MAX + 1]; COLUMNS_MAX + 1],
        log_determinant: 0.0,
        rows: 0,
    };
    let (mut state, mut variance) = ([0.0; COLUMNS_MAX + 1], ratio);
    for row in rows {
        if let Some(row) = row {
            let innovation = variance + 1.0;
            let gain = variance / innovation;
            let mut own = [0.0; COLUMNS_MAX + 1];
            for column in 0..=count {
                own[column] = row[column] - state[column];
                state[column] += gain * own[column];
            }
            variance -= gain * variance;
            found.log_determinant += innovation.ln();
            found.rows += 1;
            let own = &own[..=count];
            for (one, sums) in found.products[..=count].iter_mut().enumerate() {
                let weighted = own[one] / innovation;
                let later = sums[one..=count].iter_mut().zip(&own[one..]);
                for (sum, value) in later {
                    *sum += weighted * value;
                }
            }
        }
        for value in &mut state[..=count] {
            *value *= correlation;
        }
        variance = correlation * correlation * variance + ratio * (1.0 - correlation * correlation);
    }
    found
}

/// Least part of the squares of a column that those before it do not explain; less is rounding.
const OWN_MIN: f64 = 1e-10;

/// The coefficients under one noise, with the restricted likelihood of it.
fn candidate(whitened: &Whitened, sizes: &[f64]) -> Option<Candidate> {
    let count = sizes.len();
    let product = |one: usize, other: usize| whitened.products[one.min(other)][one.max(other)];
    // Columns of one size, as their units have nothing to do with what they determine.
    let normal = DMatrix::from_fn(count, count, |row, column| {
        product(row, column) / (sizes[row] * sizes[column])
    });
    let right = DVector::from_fn(count, |row, _| product(row, count) / sizes[row]);
    let sums = normal.diagonal();
    let decomposed = normal.cholesky()?;
    let own = decomposed
        .l_dirty()
        .diagonal()
        .component_mul(&decomposed.l_dirty().diagonal());
    if own
        .iter()
        .zip(&sums)
        .any(|(own, sum)| *own <= OWN_MIN * sum)
    {
        return None;
    }
    let scaled = decomposed.solve(&right);
    let explained = scaled.dot(&right);
    let freedom = (whitened.rows - count) as f64;
    let variance = ((product(count, count) - explained) / freedom).max(f64::MIN_POSITIVE);
    let factor = decomposed.l();
    let log_normal: f64 = (0..count).map(|at| 2.0 * factor[(at, at)].ln()).sum();
    let log_likelihood = -0.5 * (freedom * variance.ln() + whitened.log_determinant + log_normal);
    let inverse = decomposed.inverse();
    Some(Candidate {
        variance,
        coefficients: DVector::from_fn(count, |row, _| scaled[row] / sizes[row]),
        covariance: DMatrix::from_fn(count, count, |row, column| {
            variance * inverse[(row, column)] / (sizes[row] * sizes[column])
        }),
        log_likelihood,
    })
    .filter(|found| found.log_likelihood.is_finite())
}

/// Mean of the candidates by their likelihood; what they differ by adds to the variances.
fn averaged(candidates: &[Candidate], freedom: usize) -> Option<CorrelatedFit> {
    let most = candidates
        .iter()
        .map(|found| found.log_likelihood)
        .reduce(f64::max)?;
    let weights: Vec<f64> = candidates
        .iter()
        .map(|found| (found.log_likelihood - most).exp())
        .collect();
    let total: f64 = weights.iter().sum();
    let count = candidates.first()?.coefficients.len();
    let average = |of: &dyn Fn(&Candidate) -> f64| {
        let parts = candidates.iter().zip(&weights);
        parts.map(|(found, weight)| weight * of(found)).sum::<f64>() / total
    };
    let coefficients: Vec<f64> = (0..count)
        .map(|at| average(&|found| found.coefficients[at]))
        .collect();
    let variances = (0..count)
        .map(|at| {
            average(&|found| {
                let apart = found.coefficients[at] - coefficients[at];
                found.covariance[(at, at)] + apart * apart
            })
        })
        .collect();
    Some(CorrelatedFit {
        coefficients,
        variances,
        freedom: freedom as f64,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Streams;

    /// White noise of 1 and a random walk with steps of `walk`.
    fn noise(seed: u64, count: usize, walk: f64) -> Vec<f64> {
        let mut random = Streams::new(seed, 0).stream("means");
        let mut state = 0.0;
        (0..count)
            .map(|_| {
                state += walk * random.normal();
                random.normal() + state
            })
            .collect()
    }

    type Fit = fn(&[Vec<f64>], &[f64]) -> Option<CorrelatedFit>;

    /// How often the interval of 95 % of a slope along a rise and fall holds the true one.
    fn coverage(walk: f64, fit: Fit) -> usize {
        let count = 160;
        let rise: Vec<f64> = (0..count)
            .map(|at| 1.0 - (2.0 * at as f64 / count as f64 - 1.0).abs())
            .collect();
        let held = (0..60).filter(|seed| {
            let noise = noise(*seed, count, walk);
            let values: Vec<f64> = rise.iter().zip(&noise).map(|(x, e)| 3.0 * x + e).collect();
            let fit = fit(&[vec![1.0; count], rise.clone()], &values).unwrap();
            (fit.coefficients[1] - 3.0).abs() < 1.98 * fit.variances[1].sqrt()
        });
        held.count()
    }

    #[test]
    fn intervals_hold_under_white_noise_and_under_a_random_walk() {
        // Of 60 intervals of 95 %, fewer than 51 hold in one case of 1500.
        for walk in [0.0, 0.2, 1.0] {
            for fit in [fit_correlated as Fit, fit_plainly as Fit] {
                let held = coverage(walk, fit);
                assert!(held >= 51, "walk {walk}: {held} of 60");
            }
        }
    }

    #[test]
    fn columns_that_say_the_same_determine_nothing() {
        let rise: Vec<f64> = (0..50).map(f64::from).collect();
        let values = noise(1, 50, 0.0);
        assert!(fit_correlated(&[rise.clone(), rise.clone()], &values).is_none());
        assert!(fit_correlated(&[vec![0.0; 50]], &values).is_none());
    }
}
