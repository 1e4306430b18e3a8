//! Figures without a closed form: simulated at points of the priors and interpolated between them.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::bench::{Bench, sets_of};
use super::simulated::{Settings, figures_of};
use crate::inference::{Forecast, first_points};
use crate::scenario::Problem;

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
    fn fit(
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

/// A record as several readings have it, with the figures to simulate.
struct Design {
    record: usize,
    readings: Vec<usize>,
    figures: Vec<usize>,
}

/// Simulates what has no closed form at so many points of the priors, on the rate model.
///
/// A point that no gyro has, or whose run does not end, is left out.
pub(super) fn surfaces(problem: &Problem, bench: &Bench) -> Vec<Surfaces> {
    let count = problem.config.simulations as usize;
    let designs = designs(problem, bench);
    let points = first_points(count, bench.parameters.len());
    let jobs: Vec<(usize, usize)> = (0..designs.len())
        .flat_map(|design| (0..count).map(move |point| (design, point)))
        .collect();
    let told: Vec<Vec<(usize, f64)>> = jobs
        .par_iter()
        .with_max_len(1)
        .enumerate()
        .map(|(job, (design, point))| {
            let seed = (problem.config.seed + 1 + job as u64) % (1 << 32);
            simulated(problem, bench, &designs[*design], (&points[*point], seed))
        })
        .collect();
    let mut found = vec![Surfaces::default(); bench.readings.len()];
    for (place, design) in designs.iter().enumerate() {
        let rows = &told[place * count..(place + 1) * count];
        let own = of_design(bench, design, rows, &points);
        for reading in &design.readings {
            found[*reading]
                .surfaces
                .extend(own.surfaces.iter().cloned());
            found[*reading].correlations.extend(&own.correlations);
        }
    }
    found
}

/// Records that readings share are simulated once.
fn designs(problem: &Problem, bench: &Bench) -> Vec<Design> {
    let mut known: BTreeMap<(usize, Vec<String>), Design> = BTreeMap::new();
    for (reading, lacking) in bench.lacking.iter().enumerate() {
        for (record, figure) in lacking {
            let sets = sets_of(&problem.config, *record, &bench.readings[reading]);
            let design = known.entry((*record, sets)).or_insert_with(|| Design {
                record: *record,
                readings: Vec::new(),
                figures: Vec::new(),
            });
            if design.readings.last() != Some(&reading) {
                design.readings.push(reading);
            }
            if !design.figures.contains(figure) {
                design.figures.push(*figure);
            }
        }
    }
    known.into_values().collect()
}

/// Figures of one run; none of one that does not end.
fn simulated(
    problem: &Problem,
    bench: &Bench,
    design: &Design,
    (parts, seed): (&[f64], u64),
) -> Vec<(usize, f64)> {
    let settings = Settings {
        reading: design.readings[0],
        values: bench.values(parts),
    };
    let more = [
        "fidelity=\"rate\"".to_owned(),
        "repeats=1".to_owned(),
        format!("seed={seed}"),
    ];
    let plan = settings.plan(problem, bench, design.record, &more);
    let run = plan.and_then(|plan| figures_of(problem, design.record, &plan, &()));
    let figures = run.unwrap_or_default().into_iter();
    let wanted = figures.filter(|(figure, _)| design.figures.contains(figure));
    wanted.map(|(figure, own)| (figure, own.value)).collect()
}

/// Surfaces of a design with what its figures have in common.
fn of_design(
    bench: &Bench,
    design: &Design,
    rows: &[Vec<(usize, f64)>],
    points: &[Vec<f64>],
) -> Surfaces {
    let acting = bench.acting(design.readings[0], design.record);
    let mut found = Surfaces::default();
    let mut left: Vec<BTreeMap<usize, f64>> = Vec::new();
    for figure in &design.figures {
        let of_figure = |row: &Vec<(usize, f64)>| {
            let own = row.iter().find(|(own, _)| own == figure);
            own.map(|(_, value)| *value)
        };
        let told = rows.iter().zip(points).enumerate();
        let told =
            told.filter_map(|(run, (row, parts))| Some((run, parts.as_slice(), of_figure(row)?)));
        let told: Vec<(usize, &[f64], f64)> = told.collect();
        let own: Vec<(&[f64], f64)> = told.iter().map(|row| (row.1, row.2)).collect();
        let is_squares = bench.scatters_as_squares(*figure);
        let fitted = Surface::fit((*figure, is_squares), &acting, &own);
        let Some((surface, own_left)) = fitted else {
            continue;
        };
        found.surfaces.push(surface);
        left.push(told.iter().map(|row| row.0).zip(own_left).collect());
    }
    for one in 0..left.len() {
        for other in one + 1..left.len() {
            let correlation = correlation(&left[one], &left[other]);
            let [first, second] = [one, other].map(|own| found.surfaces[own].figure);
            found
                .correlations
                .push((first.min(second), first.max(second), correlation));
        }
    }
    found
}

/// Correlation of what is left of two figures over the runs that have both.
fn correlation(one: &BTreeMap<usize, f64>, other: &BTreeMap<usize, f64>) -> f64 {
    let both = one
        .iter()
        .filter_map(|(run, own)| Some((*own, *other.get(run)?)));
    let (mut product, mut own, mut against) = (0.0, 0.0, 0.0);
    for (x, y) in both {
        product += x * y;
        own += x * x;
        against += y * y;
    }
    let scale: f64 = (own * against).sqrt();
    if scale > 0.0 { product / scale } else { 0.0 }
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
