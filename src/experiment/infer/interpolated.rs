//! Figures without a closed form: simulated at points of the priors, to be interpolated between them.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::bench::{Bench, sets_of};
use super::simulated::{Settings, figures_of};
use super::surface::{Surface, Surfaces};
use crate::inference::first_points;
use crate::scenario::Problem;

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
