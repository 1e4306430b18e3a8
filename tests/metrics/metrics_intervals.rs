//! Whether the intervals of the metrics hold the truth as often as they say.

use fogbench::Scenario;
use fogbench::metrics::catalogue::{DELAY_AT_DC, DELAY_VS_RAW, MEAN_RATIO, NOISE_GAIN};
use fogbench::metrics::{
    AllanOptions, ChannelMetrics, MetricKey, Motion, Record, Settings, measure,
};
use fogbench::random::Streams;
use fogbench::signal::{Rates, SlowDrift};

use crate::support::assert_close;

/// White noise of deviation 0.36 deg/h at 1 s plus flicker of coefficient B, deg/h.
///
/// Flicker: Gauss-Markov processes of variance `B^2 ln 4 / pi`, correlation times in the ratio 4
/// from half a sample to ten records or more, each started from its stationary distribution.
fn gyro_noise(seed: u64, count: usize, period_s: f64, flicker_deg_per_h: f64) -> Vec<f64> {
    let streams = Streams::new(seed, 0);
    let mut values = vec![0.0; count];
    streams.stream("white").fill_normal(&mut values);
    for value in &mut values {
        *value *= 0.36 / period_s.sqrt();
    }
    let deviation = flicker_deg_per_h * (4.0_f64.ln() / std::f64::consts::PI).sqrt();
    let mut stream = streams.stream("flicker");
    let mut correlation: f64 = 0.57;
    loop {
        let decay = (-1.0 / correlation).exp();
        let innovation = (1.0 - decay * decay).sqrt();
        let mut state = stream.normal();
        for value in &mut values {
            *value += deviation * state;
            state = decay * state + innovation * stream.normal();
        }
        if correlation > 10.0 * count as f64 {
            return values;
        }
        correlation *= 4.0;
    }
}

/// That noise in closed form.
fn drift(count: usize, period_s: f64, flicker_deg_per_h: f64) -> SlowDrift {
    let variance = flicker_deg_per_h * flicker_deg_per_h * 4.0_f64.ln() / std::f64::consts::PI;
    let next = |time: &f64| (*time <= 10.0 * count as f64).then_some(4.0 * time);
    let times = std::iter::successors(Some(0.57), next);
    SlowDrift {
        processes: times.map(|time| (variance, time * period_s)).collect(),
        walk_deg2_per_h2_per_s: 0.0,
    }
}

fn measured(values: &[f64], period_s: f64) -> ChannelMetrics {
    measured_with(values, period_s, None)
}

fn measured_with(values: &[f64], period_s: f64, drift: Option<&SlowDrift>) -> ChannelMetrics {
    let truth = vec![0.0; values.len()];
    let record = Record {
        channel_deg_per_h: values,
        raw_deg_per_h: values,
        truth_deg_per_h: Rates::Words(&truth),
        response_deg_per_h: &[],
        encoder_rad: None,
        sample_period_s: period_s,
        first_stamp_s: 0.0,
        drift,
    };
    let settings = Settings {
        motion: Motion::Steady,
        bias_averaging_time_s: 10.0,
        fit_tau_min_s: period_s,
        allan: AllanOptions::default(),
        bridges: Vec::new(),
    };
    measure(&record, &settings, None)
}

struct MeanTrial {
    covered: u64,
    /// Mean half width over 1.96 standard deviations of the mean that the runs show.
    width: f64,
    found: [u64; 3],
}

fn try_means(runs: u64, count: usize, period_s: f64, flicker_deg_per_h: f64) -> MeanTrial {
    let mut trial = MeanTrial {
        covered: 0,
        width: 0.0,
        found: [0; 3],
    };
    let mut square = 0.0;
    let drift = drift(count, period_s, flicker_deg_per_h);
    for seed in 0..runs {
        let metrics = measured_with(
            &gyro_noise(seed, count, period_s, flicker_deg_per_h),
            period_s,
            Some(&drift),
        );
        let error = metrics.metrics["mean_error_deg_per_h"].estimate;
        trial.covered += u64::from(error.low <= 0.0 && 0.0 <= error.high);
        trial.width += (error.high - error.low) / 2.0 / runs as f64;
        square += error.value * error.value / runs as f64;
        for (found, name) in trial.found.iter_mut().zip([
            "bias_instability_deg_per_h",
            "rate_random_walk_deg_per_h_per_sqrt_h",
            "rate_ramp_deg_per_h_per_h",
        ]) {
            // Found means told from zero: B is also given with an interval that begins there.
            let metric = metrics.metrics.get(name);
            *found += u64::from(metric.is_some_and(|metric| metric.estimate.low > 0.0));
        }
    }
    trial.width /= 1.96 * square.sqrt();
    trial
}

#[test]
fn mean_error_intervals_hold_the_true_rate_with_flicker_and_without() {
    const RUNS: u64 = 300;
    // No record of a minute tells flicker from white noise: what is known of the gyro does.
    for (flicker, count, period_s) in [
        (0.0, 600, 0.1),
        (0.0, 1200, 0.5),
        (0.0, 3600, 1.0),
        (0.045, 600, 0.1),
        (0.045, 1200, 0.5),
        (0.045, 3600, 1.0),
    ] {
        let trial = try_means(RUNS, count, period_s, flicker);
        let text = format!(
            "B {flicker}, {count} x {period_s} s: {} of {RUNS}, width {:.2}, B, K, R found {:?}",
            trial.covered, trial.width, trial.found
        );
        assert!(10 * trial.covered >= 9 * RUNS, "{text}");
        // Mean half width in units of 1.96 standard deviations that 300 runs show, good to 4 %.
        assert!((0.85..1.2).contains(&trial.width), "{text}");
        // Neither a walk nor a ramp is there; the tail below a 95 % interval holds one in 40, of 300
        // up to 15 with a probability of 99.6 %.
        assert!(trial.found[1] <= RUNS / 20, "{text}");
        assert!(trial.found[2] <= RUNS / 20, "{text}");
        if flicker <= 0.0 {
            assert!(trial.found[0] <= RUNS / 20, "{text}");
        }
    }
}

#[test]
fn a_walk_that_is_there_is_found() {
    const RUNS: u64 = 60;
    let k = 0.02;
    let (mut found, mut covered) = (0, 0);
    for seed in 0..RUNS {
        let mut values = gyro_noise(seed, 3600, 1.0, 0.045);
        let mut stream = Streams::new(seed, 1).stream("walk");
        let mut walk = 0.0;
        for value in &mut values {
            walk += k * stream.normal();
            *value += walk;
        }
        let metrics = measured(&values, 1.0);
        if let Some(metric) = metrics.metrics.get("rate_random_walk_deg_per_h_per_sqrt_h") {
            found += 1;
            let truth = 60.0 * k;
            covered += u64::from(metric.estimate.low <= truth && truth <= metric.estimate.high);
        }
    }
    // Such a walk rules all averaging times beyond 30 s (287 of 300 such records showed it).
    assert!(10 * found >= 8 * RUNS, "{found} of {RUNS}");
    assert!(10 * covered >= 8 * found, "{covered} of {found}");
}

#[test]
fn bias_stability_stands_beside_what_the_fitted_noise_makes_one_expect() {
    let metrics = measured(&gyro_noise(1, 40_000, 0.1, 0.0), 0.1);
    for (name, averaging_time_s) in [
        ("bias_stability_1s_deg_per_h", 1.0_f64),
        ("bias_stability_10s_deg_per_h", 10.0),
    ] {
        // White noise alone: N over the root of the time; N of the fit is good to 1.5 % here.
        let expected = metrics.metrics[name].fields["expected_deg_per_h"];
        assert_close(expected, 0.36 / averaging_time_s.sqrt(), 0.06, 0.0);
    }
}

/// Mean stated standard error over the scatter of so many seeds, which tell that to 18 %.
fn stated_over_true(scenario: &str, channel: &str, metric: &MetricKey) -> f64 {
    const SEEDS: i64 = 16;
    let scenario = Scenario::from_toml(scenario).expect("a sound scenario");
    let (mut values, mut errors) = (Vec::new(), Vec::new());
    for seed in 1..=SEEDS {
        let seeded = scenario.clone().set("seed", seed).expect("a key");
        let run = seeded.run().expect("a run");
        let found = run.channel(channel).expect("a channel").get(metric);
        let estimate = found.expect("the record gives it").estimate;
        values.push(estimate.value);
        errors.push((estimate.high - estimate.low) / 2.0 / 1.96);
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let centre = mean(&values);
    let squares: Vec<f64> = values.iter().map(|it| (it - centre).powi(2)).collect();
    let scatter = (mean(&squares) * SEEDS as f64 / (SEEDS as f64 - 1.0)).sqrt();
    mean(&errors) / scatter
}

#[test]
fn the_ratio_of_means_in_a_short_swing_scatters_as_its_interval_says() {
    let swing = "schema = 1\nname = \"short\"\nfidelity = \"rate\"\nduration_s = 2.0\nwarm_up_s = 1.0\n\
                 [turntable.swing]\nrate_amplitude_deg_per_s = 1.0\nfrequency_hz = 10.0\n\
                 [[filter]]\nname = \"rls\"\n[filter.rls]\n";
    // The interval was 0.004 of the scatter.
    let stated = stated_over_true(swing, "rls", &MEAN_RATIO);
    assert!((0.6..1.8).contains(&stated), "{stated}");
}

#[test]
fn weights_that_a_fast_rotation_keeps_as_noise_left_them_scatter_as_their_intervals_say() {
    let rotation = "schema = 1\nname = \"turn\"\nfidelity = \"rate\"\nduration_s = 6.0\nwarm_up_s = 1.5\n\
                    [turntable.rotation]\nrate_deg_per_s = 50.0\n\
                    [[filter]]\nname = \"lms\"\n[filter.lms]\n";
    // Blocks of the record agree to a millionth where seeds differ by an eighth. Student's t of six degrees
    // of freedom, those of the runs on other noise, is 1.25 times that of the normal law.
    let delay = stated_over_true(rotation, "lms", &DELAY_AT_DC);
    assert!((0.75..2.0).contains(&delay), "{delay}");
    // A power of weights errs on the wide side; it was 0.16 of the scatter.
    let gain = stated_over_true(rotation, "lms", &NOISE_GAIN);
    assert!((0.75..4.0).contains(&gain), "{gain}");
    let swing = rotation.replace(
        "[turntable.rotation]\nrate_deg_per_s = 50.0",
        "[turntable.swing]\nrate_amplitude_deg_per_s = 10.0\nfrequency_hz = 5.0",
    );
    let stated = stated_over_true(&swing, "lms", &DELAY_VS_RAW);
    assert!((0.6..2.0).contains(&stated), "{stated}");
}
