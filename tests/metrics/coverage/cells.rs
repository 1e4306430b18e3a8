//! One metric of one channel under one motion over many seeds, and its verdict.

use statrs::distribution::{Beta, ContinuousCDF, StudentsT};

use fogbench::metrics::{Estimate, IntervalKind};
use fogbench::random::Streams;

use super::trial::{Key, Motion, Records, run};

/// Seeds of each motion in the short form, and the first of them.
const SEEDS: u64 = 150;
const FIRST_SEED: u64 = 1000;

/// Length of their records, s.
const DURATION_S: f64 = 60.0;

/// Coverage that a cell may have, in parts of 1.
const COVERAGE: [f64; 2] = [0.93, 0.97];

/// Tail of the interval of a coverage: 99.9 % between both.
const TAIL: f64 = 0.0005;

/// Mean half width over 1.96 robust standard deviations of the seeds, at most.
const WIDTH_MAX: f64 = 1.25;

/// Standard error of the robust scatter of one normal value, as a part of it, and how many of them it may
/// be off: 99.9 % between both sides.
const SCATTER_ERROR: f64 = 1.17;
const SCATTER_QUANTILE: f64 = 3.29;

/// Part of the cells that may have no interval.
const ABSENT_MAX: f64 = 0.05;

/// Terms of the noise fit that are zero in half of the records or more, or found in few; their coverage is
/// that of `allan_coverage`.
const OF_THE_FIT: [&str; 7] = [
    "bias_instability",
    "quantisation",
    "rate_random_walk",
    "rate_ramp",
    "correlated_noise",
    "correlation_time",
    "sine_",
];

/// Metrics whose values over seeds are far from a normal law, so that their widths are not judged:
/// standard deviations of a few means, magnitudes near zero, whole numbers of samples.
const NOT_NORMAL: [&str; 8] = [
    "bias_stability",
    "harmonic_distortion",
    "overshoot",
    "settling_time",
    "readaptation_time",
    "scale_factor_nonlinearity",
    "scale_factor_asymmetry",
    "weight_noise",
];

/// Metrics with a rare branch, whose mean over seeds a few records make: noise leaves the band of the
/// settling time once in a hundred records, by definition, and the overshoot is then that of the noise.
/// Their ensemble value is the median.
const RARE: [&str; 2] = ["settling_time", "overshoot"];

/// Metrics whose interval is the resolution of the record, a sample: the ensemble value lies in nearly
/// all of them, by construction.
const RESOLUTION: [&str; 2] = ["settling_time", "readaptation_time"];

/// Metrics that are 0 in all but few records, whose interval has its own value: it holds a median of 0 in
/// all of these, by construction. That it is no wider for it, and right where a signal stands out, is
/// tested where it is derived.
const AT_ZERO: [&str; 1] = ["overshoot"];

/// Cells whose interval comes from few runs of the filter on other noise, by motion, channel and metric:
/// Student's t of so many degrees of freedom is wider than the normal law, and their width is judged
/// against it. Runs of a tenth of a swing show what noise left in the weights, and how it fades.
const OF_FEW_RUNS: [(&str, &str, &str, f64); 3] = [
    ("swing", "lms", "noise_gain", 6.0),
    ("swing", "lms", "dc_gain", 6.0),
    ("swing", "lms", "mean_ratio", 6.0),
];

/// Cells whose coverage alone is judged, as that of [`NOT_NORMAL`]: half a second after the last step is six
/// blocks, of which Student's t is as wide as it covers; noise before a swing leaves the weights of a gradient
/// somewhere, and how far this moves its amplitude differs from seed to seed, so that the middle half of the
/// seeds scatters by half of what a normal law of their standard deviation would.
const BY_COVERAGE: [(&str, &str, &str); 2] = [
    ("staircase", "rls", "noise_gain"),
    ("swing", "lms", "amplitude_ratio"),
];

/// What the seeds say of one cell.
struct Cell {
    name: String,
    intervals: usize,
    exact: usize,
    absent: usize,
    coverage: f64,
    /// Mean half width over 1.96 robust standard deviations.
    width: f64,
    /// Stated over true standard error.
    ratio: f64,
    is_normal: bool,
    /// Whether the interval holds the ensemble value in nearly all records by construction.
    is_by_construction: bool,
    /// Half width of an interval from its few runs over that by the normal law.
    by_few_runs: f64,
}

impl Cell {
    fn of(motion: Motion, (channel, metric): &Key, row: &[Option<Estimate>]) -> Self {
        let kind = |wanted: fn(IntervalKind) -> bool| {
            let found = row.iter().flatten();
            found.filter(|estimate| wanted(estimate.interval)).count()
        };
        let held: Vec<&Estimate> = row
            .iter()
            .flatten()
            .filter(|it| it.has_interval())
            .collect();
        let count = held.len().max(1) as f64;
        let is = |names: &[&str]| names.iter().any(|name| metric.starts_with(name));
        let mean = if is(&RARE) || is(&RESOLUTION) {
            let mut values: Vec<f64> = held.iter().map(|it| it.value).collect();
            values.sort_by(f64::total_cmp);
            values.get(values.len() / 2).copied().unwrap_or(0.0)
        } else {
            held.iter().map(|it| it.value).sum::<f64>() / count
        };
        let square: f64 = held.iter().map(|it| (it.value - mean).powi(2)).sum();
        let deviation = (square / (count - 1.0).max(1.0)).sqrt();
        let mut distances: Vec<f64> = held.iter().map(|it| (it.value - mean).abs()).collect();
        distances.sort_by(f64::total_cmp);
        let robust = 1.4826 * distances.get(distances.len() / 2).copied().unwrap_or(0.0);
        let halves = held.iter().map(|it| 0.5 * (it.high - it.low) / 1.96);
        let half = halves.sum::<f64>() / count;
        let inside = held
            .iter()
            .filter(|it| it.low <= mean && mean <= it.high)
            .count();
        Self {
            name: format!("{} {channel} {metric}", motion.name()),
            intervals: held.len(),
            exact: kind(|it| it == IntervalKind::Exact),
            absent: kind(|it| matches!(it, IntervalKind::Absent(_))),
            coverage: inside as f64 / count,
            width: half / robust,
            ratio: half / deviation,
            is_normal: !is(&NOT_NORMAL)
                && !BY_COVERAGE.contains(&(motion.name(), channel.as_str(), metric.as_str())),
            is_by_construction: is(&RESOLUTION) || is(&AT_ZERO) && mean.abs() < f64::MIN_POSITIVE,
            by_few_runs: OF_FEW_RUNS
                .iter()
                .find(|cell| {
                    (cell.0, cell.1, cell.2) == (motion.name(), channel.as_str(), metric.as_str())
                })
                .map_or(1.0, |cell| student_quantile(cell.3) / 1.96),
        }
    }

    /// Exact binomial interval of the coverage (Clopper and Pearson).
    fn coverage_interval(&self) -> [f64; 2] {
        let n = self.intervals as f64;
        let inside = (self.coverage * n).round();
        let quantile = |a: f64, b: f64, p: f64| Beta::new(a, b).expect("counts").inverse_cdf(p);
        let low = if inside > 0.0 {
            quantile(inside, n - inside + 1.0, TAIL)
        } else {
            0.0
        };
        let high = if inside < n {
            quantile(inside + 1.0, n - inside, 1.0 - TAIL)
        } else {
            1.0
        };
        [low, high]
    }

    /// What is wrong with the cell; nothing if it holds.
    fn complaint(&self) -> Option<String> {
        // Cells that rounding makes exact, or the motion leaves without interval, in nearly all records have
        // nothing to count.
        if self.intervals <= self.exact.max(self.absent) {
            return None;
        }
        let [low, high] = self.coverage_interval();
        let is_covered = (low <= COVERAGE[1] || self.is_by_construction) && high >= COVERAGE[0];
        let chance = SCATTER_QUANTILE * SCATTER_ERROR / (self.intervals as f64).sqrt();
        let width_max = WIDTH_MAX * self.by_few_runs * (1.0 + chance);
        let is_narrow = !self.is_normal || self.width <= width_max;
        (!is_covered || !is_narrow).then(|| self.line())
    }

    fn line(&self) -> String {
        format!(
            "{:<62} n {:>4} coverage {:>5.1} stated/true {:>6.2} width {:>6.2} exact {} absent {}",
            self.name,
            self.intervals,
            100.0 * self.coverage,
            self.ratio,
            self.width,
            self.exact,
            self.absent
        )
    }
}

/// Quantile 0.975 of Student's t distribution.
fn student_quantile(degrees_of_freedom: f64) -> f64 {
    let law = StudentsT::new(0.0, 1.0, degrees_of_freedom).expect("degrees of freedom");
    law.inverse_cdf(0.975)
}

fn cells(motion: Motion, records: &Records) -> Vec<Cell> {
    let of_fit = |metric: &str| OF_THE_FIT.iter().any(|name| metric.starts_with(name));
    records
        .iter()
        .filter(|((_, metric), _)| !of_fit(metric))
        .map(|(key, row)| Cell::of(motion, key, row))
        .collect()
}

fn from_environment(name: &str) -> Option<f64> {
    std::env::var(name).ok()?.parse().ok()
}

/// What is wrong with the cells of so many seeds; the long form prints them all.
pub(crate) fn complaints(seeds: u64, duration_s: f64, prints: bool) -> Vec<String> {
    let mut all = Vec::new();
    let only = std::env::var("FOGBENCH_COVERAGE_MOTION").ok();
    let asked = |motion: &Motion| only.as_ref().is_none_or(|only| only == motion.name());
    for motion in Motion::ALL.into_iter().filter(asked) {
        let found = cells(motion, &run(motion, duration_s, FIRST_SEED, seeds));
        // Each motion as it ends: the long form takes an hour and more.
        if prints {
            for cell in &found {
                println!("{}", cell.line());
            }
        }
        all.extend(found);
    }
    let mut complaints: Vec<String> = all.iter().filter_map(Cell::complaint).collect();
    let absent = all.iter().filter(|cell| cell.absent > 0).count();
    // Of all motions together.
    if only.is_none() && absent as f64 > ABSENT_MAX * all.len() as f64 {
        complaints.push(format!("{absent} of {} without an interval", all.len()));
    }
    complaints
}

#[test]
fn intervals_hold_the_mean_over_seeds_nineteen_times_in_twenty() {
    let long = from_environment("FOGBENCH_COVERAGE");
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a number of seeds"
    )]
    let seeds = long.map_or(SEEDS, |seeds| seeds as u64);
    let duration_s = from_environment("FOGBENCH_COVERAGE_S").unwrap_or(DURATION_S);
    let complaints = complaints(seeds, duration_s, long.is_some());
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

/// Intervals of `stretch` times the right width about normal values.
fn normal_row(stretch: f64) -> Vec<Option<Estimate>> {
    let mut stream = Streams::new(7, 0).stream("white");
    (0..SEEDS)
        .map(|_| Some(Estimate::symmetric(stream.normal(), 1.96 * stretch)))
        .collect()
}

#[test]
fn a_cell_with_intervals_of_the_wrong_width_is_found() {
    let key = ("raw".to_owned(), "mean_deg_per_h".to_owned());
    let complaint = |stretch: f64| Cell::of(Motion::Rest, &key, &normal_row(stretch)).complaint();
    assert_eq!(complaint(1.0), None);
    assert!(complaint(0.5).is_some());
    assert!(complaint(2.0).is_some());
}
