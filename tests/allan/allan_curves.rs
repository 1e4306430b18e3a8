//! The Allan curve a scenario asks for, the autocovariance, and where the fit begins behind a filter.

use fogbench::metrics::{
    AllanEstimator, AllanOptions, ChannelMetrics, FilterFacts, Motion, Settings, aggregate,
    allan_variant, autocovariance, measure, record_fit_tau_min_s,
};
use fogbench::signal::{Section, WeightRule};
use fogbench::vocabulary::AveragingTimes;

use crate::support::records::{PERIOD_S, facts, raw_record, settings, shape, white};
use crate::support::{assert_close, code, fogbench, stderr, write};

fn measured(values: &[f64], allan: AllanOptions) -> ChannelMetrics {
    let settings = Settings {
        allan,
        ..settings(Motion::Steady)
    };
    measure(&raw_record(values, &[]), &settings, None)
}

#[test]
fn the_curve_is_that_of_the_settings_and_the_fit_stays_on_the_overlapping_one() {
    let values = white(3, 40_000, 1.0);
    let modified = AllanOptions {
        estimator: AllanEstimator::Modified,
        taus: AveragingTimes::Decade,
        ..AllanOptions::default()
    };
    let usual = measured(&values, AllanOptions::default());
    let other = measured(&values, modified);
    let wanted = allan_variant(&values, PERIOD_S, &modified);
    let curve = &other.curves["allan"];
    assert_eq!(curve["tau_s"].len(), wanted.len());
    for (index, variant) in wanted.iter().enumerate() {
        let point = variant.point;
        let deviation = point.deviation_deg_per_h;
        for (column, value) in [
            ("tau_s", point.tau_s),
            ("deviation_deg_per_h", deviation.value),
            ("low_deg_per_h", deviation.low),
            ("high_deg_per_h", deviation.high),
            ("edf", point.degrees_of_freedom),
            ("noise_alpha", variant.noise.alpha().into()),
        ] {
            assert_close(curve[column][index], value, 1e-12, 1e-12);
        }
        assert_eq!(
            other.curve_labels["allan"]["noise"][index],
            variant.noise.name()
        );
    }
    assert_eq!(other.curve_labels["allan"]["estimator"], ["modified"]);
    assert_eq!(usual.curve_labels["allan"]["estimator"], ["overlapping"]);
    assert!(!curve.contains_key("fitted_deg_per_h"));
    assert!(usual.curves["allan"].contains_key("fitted_deg_per_h"));
    assert_eq!(usual.metrics, other.metrics);
    assert_eq!(usual.curves["allan_fit"], other.curves["allan_fit"]);
}

#[test]
fn repeats_pool_the_curve_of_the_settings() {
    let repeats: Vec<ChannelMetrics> = (0..4)
        .map(|seed| measured(&white(seed, 20_000, 1.0), AllanOptions::default()))
        .collect();
    let pooled = aggregate(&repeats);
    let (one, all) = (&repeats[0].curves["allan"], &pooled.curves["allan"]);
    let at = 3;
    let squares = repeats
        .iter()
        .map(|repeat| repeat.curves["allan"]["deviation_deg_per_h"][at].powi(2));
    let wanted = (squares.sum::<f64>() / 4.0).sqrt();
    assert_close(all["deviation_deg_per_h"][at], wanted, 1e-12, 0.0);
    let sum: f64 = repeats
        .iter()
        .map(|repeat| repeat.curves["allan"]["edf"][at])
        .sum();
    assert_close(all["edf"][at], sum, 1e-12, 0.0);
    assert_eq!(one.len(), all.len());
    assert_eq!(pooled.curve_labels["allan"]["noise"][at], "white rate");
    assert_eq!(pooled.curve_labels["allan"]["estimator"], ["overlapping"]);
    assert_eq!(pooled.curves["autocovariance"]["lag_s"].len(), 51);
}

#[test]
fn all_averaging_times_are_every_one_then_a_thousand_and_fewer_in_a_long_record() {
    let every: Vec<usize> = (1..=1000).collect();
    assert_eq!(AveragingTimes::All.averaging_factors(1000), every);
    assert_eq!(AveragingTimes::All.averaging_factors(7), every[..7]);
    assert!(AveragingTimes::All.averaging_factors(0).is_empty());
    for (largest, count) in [(250_000, 1000), (2_500_000, 200), (1_000_000_000, 100)] {
        let factors = AveragingTimes::All.averaging_factors(largest);
        assert_eq!((factors.len(), factors[count - 1]), (count, largest));
        assert!(factors.windows(2).all(|two| two[0] < two[1]));
        let ratio = |at: usize| factors[at + 1] as f64 / factors[at] as f64;
        assert_close(ratio(count - 2), ratio(count / 2), 0.02, 0.0);
    }
}

#[test]
fn neighbours_of_filtered_white_noise_correlate_as_its_taps_say() {
    let raw = white(8, 50_000, 2.0);
    // Mean of two neighbours: R = 2, 1, 0, ... of a variance of 4.
    let mut halves: Vec<f64> = raw.windows(2).map(|two| (two[0] + two[1]) / 2.0).collect();
    halves.push(0.0);
    let metrics = measured(&halves, AllanOptions::default());
    let found = metrics.metrics["lag1_correlation"].estimate;
    assert!(found.low < 0.5 && 0.5 < found.high, "{found:?}");
    assert!(found.high - found.low < 0.04, "{found:?}");
    let curve = &metrics.curves["autocovariance"];
    let covariance = &curve["autocovariance_deg2_per_h2"];
    for (lag, wanted) in [(0, 2.0), (1, 1.0), (2, 0.0), (50, 0.0)] {
        // Standard errors below 4 sqrt(3/2) / sqrt(2 x 50 000) = 0.016.
        assert!((covariance[lag] - wanted).abs() < 0.06, "{lag}");
        assert_close(curve["lag_s"][lag], lag as f64 * PERIOD_S, 1e-12, 0.0);
    }
    for (got, wanted) in covariance.iter().zip(autocovariance(&halves, 50)) {
        assert_close(*got, wanted, 1e-9, 1e-12);
    }
    let white = measured(&raw, AllanOptions::default());
    let none = white.metrics["lag1_correlation"].estimate;
    assert!(none.value.abs() < 0.02 && none.low < none.high);
}

const POLE_SAMPLES: f64 = 100.0;

/// White noise through a one-pole filter, and the white noise.
fn one_pole(seed: u64, count: usize) -> (Vec<f64>, Vec<f64>) {
    let pole = (-1.0 / POLE_SAMPLES).exp();
    let raw = white(seed, count, 1.0);
    let mut state = 0.0;
    let smooth = raw.iter().map(|rate| {
        state += (1.0 - pole) * (rate - state);
        state
    });
    (smooth.collect(), raw)
}

#[test]
fn a_one_pole_filter_of_a_hundred_samples_leaves_the_fitted_angle_random_walk_alone() {
    const RUNS: u64 = 8;
    let pole = (-1.0 / POLE_SAMPLES).exp();
    let section = Section {
        numerator: [1.0 - pole, 0.0, 0.0],
        denominator: [-pole, 0.0],
    };
    let known = FilterFacts {
        shape: fogbench::signal::FilterShape {
            rule: WeightRule::Sections(vec![section]),
            ..shape(1, 0, vec![1.0])
        },
        ..facts()
    };
    // What the fit did before it knew: the shape of a filter of one tap.
    let unknown = FilterFacts {
        shape: shape(1, 0, vec![1.0]),
        ..facts()
    };
    let wanted = fogbench::units::deg_per_h_sqrt_s_to_deg_per_sqrt_h(PERIOD_S.sqrt());
    let (mut sum, mut blind, mut covered) = (0.0, 0.0, 0);
    for seed in 0..RUNS {
        let (smooth, raw) = one_pole(seed, 600_000);
        let mut record = raw_record(&raw, &[]);
        record.channel_deg_per_h = &smooth;
        let name = "angle_random_walk_deg_per_sqrt_h";
        let of = |facts: &FilterFacts| measure(&record, &settings(Motion::Steady), Some(facts));
        let found = of(&known).metrics[name].clone();
        assert!(found.fields["tau_min_s"] > 13.0 * POLE_SAMPLES * PERIOD_S);
        let estimate = found.estimate;
        // The square is what is unbiased; its root is zero where the square comes out below it.
        let fit = of(&known).noise_fit.expect("a fit");
        sum += fit.terms[name].square / (wanted * wanted);
        covered += u32::from(estimate.low <= wanted && wanted <= estimate.high);
        blind += of(&unknown)
            .metrics
            .get(name)
            .map_or(0.0, |metric| metric.estimate.value / wanted);
    }
    let (mean, blind) = (sum / RUNS as f64, blind / RUNS as f64);
    // Beside signed terms of slow noise the square of N has a standard error of some 20 % from 1300
    // samples to a ninth, 7 % in the mean of eight.
    assert!((mean - 1.0).abs() < 0.2, "{mean}");
    assert!(covered >= 6, "{covered} of {RUNS}");
    assert!((blind - 1.0).abs() > 0.15, "{blind}");
}

#[test]
fn the_fit_of_a_log_begins_beyond_the_correlation_it_shows() {
    let samples = |values: &[f64]| record_fit_tau_min_s(values, 0.5) / 0.5;
    let (smooth, raw) = one_pole(4, 200_000);
    assert!((samples(&raw) - 4.0).abs() < 1e-9);
    let of_pole = samples(&smooth) / POLE_SAMPLES;
    assert!((8.0..20.0).contains(&of_pole), "{of_pole} time constants");
    let average: Vec<f64> = raw
        .windows(100)
        .map(|window| window.iter().sum::<f64>() / 100.0)
        .collect();
    let of_average = samples(&average) / 100.0;
    assert!((3.0..6.0).contains(&of_average), "{of_average} lengths");
    // Drift is no low pass, alone or below white noise.
    let mut walk = 0.0;
    let drift: Vec<f64> = white(9, 200_000, 0.01)
        .iter()
        .map(|step| {
            walk += step;
            walk
        })
        .collect();
    let sum: Vec<f64> = drift
        .iter()
        .zip(&raw)
        .map(|(slow, fast)| slow + fast)
        .collect();
    assert!((samples(&drift) - 4.0).abs() < 1e-9);
    assert!((samples(&sum) - 4.0).abs() < 1e-9);
    assert!((samples(&raw[..100]) - 4.0).abs() < 1e-9);
    // Nor does it hide one.
    let hidden: Vec<f64> = drift
        .iter()
        .zip(&average)
        .map(|(slow, fast)| 0.1 * slow + fast)
        .collect();
    let of_hidden = samples(&hidden) / 100.0;
    assert!((3.0..6.0).contains(&of_hidden), "{of_hidden} lengths");
    // Nor is noise with a correlation time beside white noise: a fit beyond it would take it for N.
    for (time, level) in [(300.0, 0.3), (300.0, 3.0), (60.0, 1.0)] {
        let decay = f64::exp(-1.0 / time);
        let mut state = 0.0;
        let beside: Vec<f64> = white(10, 200_000, level * (1.0 - decay * decay).sqrt())
            .iter()
            .zip(&raw)
            .map(|(drive, fast)| {
                state = decay * state + drive;
                state + fast
            })
            .collect();
        let found = samples(&beside);
        assert!((found - 10.0).abs() < 1e-9, "{time} {level}: {found}");
    }
}

#[test]
fn a_scenario_and_a_log_show_the_estimator_they_ask_for() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let scenario = "schema = 1
name = \"rest\"
duration_s = 5.0
warm_up_s = 0.0
bias_averaging_time_s = 1.0
fidelity = \"rate\"
[allan]
estimator = \"hadamard\"
averaging_times = \"decade\"
[output]
samples = \"npy\"
";
    write(folder.path(), "rest.toml", scenario);
    let run = fogbench(folder.path(), &["run", "rest.toml"]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let rest = folder.path().join("output/rest");
    let read = |path: &str| std::fs::read_to_string(rest.join(path)).expect("a result");
    let csv = read("allan.csv");
    let mut lines = csv.lines();
    let head = lines.next().unwrap_or_default();
    assert!(
        head.starts_with("channel,tau_s,count,deviation_deg_per_h,edf,"),
        "{head}"
    );
    assert!(head.ends_with(",estimator,noise"), "{head}");
    let first = lines.next().unwrap_or_default();
    assert!(
        first.starts_with("raw,") && first.ends_with(",hadamard,white rate"),
        "{first}"
    );
    assert!(read("allan.svg").contains("overlapping Hadamard deviation"));
    assert!(read("autocovariance.csv").starts_with("channel,lag_s,autocovariance_deg2_per_h2\n"));
    let summary = crate::support::summary(&folder.path().join("output"), "rest");
    let curve = &summary["channels"]["raw"]["curves"]["allan"];
    assert_eq!(curve["estimator"], "hadamard");
    assert_eq!(curve["noise"][0], "white rate");
    assert_eq!(curve["noise_alpha"][0], 0.0);
    let log = fogbench(
        folder.path(),
        &[
            "analyze",
            "output/rest/samples/raw.npy",
            "--rate-hz",
            "4000",
            "--unit",
            "deg/h",
            "--allan-estimator",
            "modified",
            "--averaging-times",
            "all",
            "--output",
            "log",
        ],
    );
    assert_eq!(code(&log), 0, "{}", stderr(&log));
    let csv = std::fs::read_to_string(folder.path().join("log/allan.csv")).expect("a curve");
    assert_eq!(csv.lines().count(), 1001);
    assert!(csv.lines().skip(1).all(|line| line.contains(",modified,")));
    let wrong = fogbench(
        folder.path(),
        &["run", "rest.toml", "--set", "allan.estimator=total"],
    );
    assert_eq!(code(&wrong), 2, "{}", stderr(&wrong));
}
