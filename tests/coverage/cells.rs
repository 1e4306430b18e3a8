//! One metric of one channel under one motion over many seeds, and its verdict.

use statrs::distribution::{Beta, ContinuousCDF};

use fogbench::metrics::{Estimate, IntervalKind};

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

/// Part of the cells that may have no interval.
const ABSENT_MAX: f64 = 0.05;

/// Metrics that other rules judge: the fit's terms and what stands beside them.
const OF_THE_FIT: [&str; 2] = ["angle_random_walk", "bias_instability"];

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
/// settling time once in a hundred records, by definition. Their ensemble value is the median.
const RARE: [&str; 1] = ["settling_time"];

/// Cells that are not judged yet, by motion, channel and the first letters of the metric; an empty text
/// stands for all: no run of many seeds has shown yet that they hold. The long form prints them.
const PENDING: [(&str, &str, &str); 13] = [
    ("", "", "noise_delay_bound"),
    ("", "", "noise_gain_over_bound"),
    ("", "", "weight_noise"),
    ("rest", "rls", "dc_gain_predicted"),
    ("rest", "rls", "delay_at_dc"),
    ("swing", "rls", ""),
    ("swing", "", "delay_vs_raw"),
    ("swing", "", "delay_by_correlation"),
    ("swing", "", "amplitude_ratio"),
    ("steps", "rls", ""),
    ("staircase", "rls", ""),
    ("", "", "settled_gain"),
    ("st", "", "mean_ratio"),
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
    is_pending: bool,
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
        let mean = if is(&RARE) {
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
            width: half / robust.min(deviation),
            ratio: half / deviation,
            is_normal: !is(&NOT_NORMAL),
            is_pending: PENDING.iter().any(|(of_motion, of_channel, of_metric)| {
                motion.name().starts_with(of_motion)
                    && channel.starts_with(of_channel)
                    && metric.starts_with(of_metric)
            }),
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
        // Cells that rounding makes exact in nearly all records have nothing to count.
        if self.intervals <= self.exact || self.is_pending {
            return None;
        }
        let [low, high] = self.coverage_interval();
        let is_covered = low <= COVERAGE[1] && high >= COVERAGE[0];
        let is_narrow = !self.is_normal || self.width <= WIDTH_MAX;
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
    let all: Vec<Cell> = Motion::ALL
        .into_iter()
        .flat_map(|motion| cells(motion, &run(motion, duration_s, FIRST_SEED, seeds)))
        .collect();
    if long.is_some() {
        for cell in &all {
            println!("{}", cell.line());
        }
    }
    let complaints: Vec<String> = all.iter().filter_map(Cell::complaint).collect();
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
    // Cells without an interval are few.
    let absent = all.iter().filter(|cell| cell.absent > 0).count();
    assert!(
        absent as f64 <= ABSENT_MAX * all.len() as f64,
        "{absent} of {}",
        all.len()
    );
}
