//! Several sines at once: the motion, the joint fit, and the gyro's response against theory.

use std::f64::consts::TAU;

use fogbench::gyro::{Gyro, word_response};
use fogbench::metrics::{
    ChannelMetrics, Motion, Record, ToneClock, aggregate, bandwidth_hz, fit_tones, measure, support,
};
use fogbench::random::Streams;
use fogbench::scenario::{
    Fidelity, GyroConfig, MotionConfig, MultiSineConfig, ServoConfig, SiteConfig, TurntableConfig,
};
use fogbench::signal::Rates;
use fogbench::turntable::Turntable;
use fogbench::units::{deg_per_s_to_rad_per_s, rad_per_s_to_deg_per_h};
use fogbench::vocabulary::PhaseRule;

use crate::support::assert_close;
use crate::support::records::{PERIOD_S, every_metric_is_answered, facts, settings, value, white};
use crate::support::reference_gyro::reference_gyro;
use crate::support::transcript::{Transcript, said_to_each};
use crate::support::turntable_cases::{no_encoder, true_axis, true_mounting};
use crate::support::{field, fogbench, run_audits, stderr, summary};

const TONES_HZ: [f64; 5] = [7.0, 31.0, 120.0, 300.0, 480.0];

fn clock(frequencies_hz: &[f64]) -> ToneClock<'_> {
    ToneClock {
        frequencies_hz,
        sample_period_s: PERIOD_S,
        first_stamp_s: 3.000_1,
    }
}

/// `offset + sum gain(f) cos(2 pi f (t - delay))` with tones of falling amplitude.
fn tones(count: usize, gain: impl Fn(f64) -> f64, delay_s: f64, offset: f64) -> Vec<f64> {
    (0..count)
        .map(|index| {
            let time_s = 3.000_1 + index as f64 * PERIOD_S;
            let tone = |(order, frequency_hz): (usize, &f64)| {
                let amplitude = 1000.0 / (1.0 + order as f64);
                let turns = (frequency_hz * time_s).fract() - frequency_hz * delay_s;
                amplitude * gain(*frequency_hz) * (TAU * turns + order as f64).cos()
            };
            offset + TONES_HZ.iter().enumerate().map(tone).sum::<f64>()
        })
        .collect()
}

#[test]
fn a_joint_fit_is_exact_for_any_window_and_follows_the_phase_beyond_a_turn() {
    let gain = |frequency_hz: f64| 1.0 / (1.0 + frequency_hz / 500.0);
    // 5 ms are 2.4 cycles of the highest tone.
    for (count, delay_s) in [(4000, 250e-6), (6137, 5e-3), (9001, -1e-3)] {
        let reference = tones(count, |_| 1.0, 0.0, -40.0);
        let values = tones(count, gain, delay_s, 8.5);
        let fits = fit_tones(&[&values, &reference], &clock(&TONES_HZ)).unwrap();
        for (response, frequency_hz) in fits.response(0, 1).iter().zip(TONES_HZ) {
            assert_close(response.gain.value, gain(frequency_hz), 1e-9, 0.0);
            assert_close(response.delay_s.value, delay_s, 0.0, 1e-9);
            assert_close(
                response.phase_rad.value,
                -TAU * frequency_hz * delay_s,
                0.0,
                1e-6,
            );
        }
        assert_close(fits.offset(0).value, 8.5, 0.0, 1e-6);
        let largest = fits
            .residuals(0, &values)
            .iter()
            .fold(0.0_f64, |max, left| max.max(left.abs()));
        assert!(largest < 1e-6, "{largest}");
    }
}

#[test]
fn gain_and_delay_reach_the_cramer_rao_bound_and_their_intervals_cover() {
    const RUNS: u64 = 300;
    let (count, noise) = (4000, 200.0);
    let reference = tones(count, |_| 1.0, 0.0, 0.0);
    let (mut squares, mut covered) = ([0.0; 2], [0_u64; 2]);
    for seed in 0..RUNS {
        let mut values = white(70_000 + seed, count, noise);
        for (value, clean) in values.iter_mut().zip(&reference) {
            *value += clean;
        }
        let fits = fit_tones(&[&values, &reference], &clock(&TONES_HZ)).unwrap();
        // The third tone: amplitude 1000 / 3.
        let tone = fits.response(0, 1)[2];
        squares[0] += (tone.gain.value - 1.0).powi(2);
        squares[1] += tone.phase_rad.value.powi(2);
        covered[0] += u64::from((tone.gain.low..=tone.gain.high).contains(&1.0));
        covered[1] += u64::from((tone.phase_rad.low..=tone.phase_rad.high).contains(&0.0));
    }
    // Relative amplitude and phase alike: sqrt(2 s^2 / (A^2 N)).
    let bound = (2.0 / count as f64).sqrt() * noise / (1000.0 / 3.0);
    for square in squares {
        // Standard error of a standard deviation of 300: 4.1 %; four of them.
        assert_close((square / RUNS as f64).sqrt(), bound, 0.165, 0.0);
    }
    // 285 of 300, binomial standard deviation 3.8.
    for count in covered {
        assert!((270..=300).contains(&count), "{covered:?}");
    }
}

#[test]
fn bandwidth_between_tones_is_exact_for_one_pole() {
    // A first-order low pass of 100 Hz between tones that are far apart.
    let frequencies_hz: Vec<f64> = (0..12).map(|step| 10.0 * 1.4_f64.powi(step)).collect();
    let gains: Vec<f64> = frequencies_hz
        .iter()
        .map(|frequency_hz| 2.0 / (1.0 + (frequency_hz / 100.0).powi(2)).sqrt())
        .collect();
    // Relative to the lowest tone, whose own gain is 2 / sqrt(1.01): 1 + x^2 = 2.02.
    let expected = 100.0 * 1.02_f64.sqrt();
    assert_close(
        bandwidth_hz(&frequencies_hz, &gains).unwrap(),
        expected,
        1e-12,
        0.0,
    );
    assert_eq!(bandwidth_hz(&frequencies_hz[..7], &gains[..7]), None);
    assert_eq!(bandwidth_hz(&[], &[]), None);
}

/// The reference gyro without noise and rounding.
fn quiet_gyro(bandwidth_hz: f64) -> GyroConfig {
    let mut config = reference_gyro();
    config.controller.loop_bandwidth_hz = bandwidth_hz;
    config.noise.shot = false;
    config.noise.thermal = false;
    config.noise.amplifier = false;
    config.noise.rin = false;
    config.adc.bits = 0;
    config.modulator.dac_bits = 0;
    config
}

fn shaken(soft_start_s: f64) -> MultiSineConfig {
    MultiSineConfig {
        frequencies_hz: TONES_HZ.to_vec(),
        rate_amplitudes_deg_per_s: vec![0.01],
        phases: PhaseRule::Schroeder,
        soft_start_s,
        ..MultiSineConfig::reference()
    }
}

fn table(motion: MultiSineConfig) -> TurntableConfig {
    TurntableConfig {
        motion: MotionConfig::MultiSine(motion),
        servo: ServoConfig::ideal(),
        encoder: no_encoder(),
        axis: true_axis(),
        mounting: true_mounting(),
        site: SiteConfig {
            latitude_deg: 34.27,
            axis_elevation_deg: 90.0,
            ..SiteConfig::reference()
        },
        ..TurntableConfig::reference()
    }
}

#[test]
fn both_gyro_models_answer_the_motion_as_the_closed_form_says() {
    for (fidelity, bandwidth) in [
        (Fidelity::Loop, 500.0),
        (Fidelity::Loop, 2000.0),
        (Fidelity::Rate, 1000.0),
    ] {
        let config = quiet_gyro(bandwidth);
        let mut gyro = Gyro::new(&config, fidelity, 2.0, &Streams::new(1, 0)).unwrap();
        let period_s = gyro.sample_period_s();
        let mut turntable = Turntable::new(&table(shaken(0.2)), 0.25, period_s);
        let (mut truth, mut words) = (Vec::new(), Vec::new());
        for _ in 0..6000 {
            let segment = turntable.next_segment();
            truth.push(rad_per_s_to_deg_per_h(segment.rate_at(1.0)));
            words.push(gyro.next_word(&segment));
        }
        let settled = 1000;
        let clock = ToneClock {
            frequencies_hz: &TONES_HZ,
            sample_period_s: period_s,
            first_stamp_s: (settled + 1) as f64 * period_s,
        };
        let fits = fit_tones(&[&words[settled..], &truth[settled..]], &clock).unwrap();
        let theory = word_response(&config, &TONES_HZ).unwrap();
        for (measured, (gain, phase)) in fits.response(0, 1).iter().zip(theory) {
            let angle = TAU * measured.frequency_hz * period_s;
            // The cubics of the motion have their mean low by (w T)^4 / 720.
            let allowed = angle.powi(4) / 700.0 + 1e-5;
            assert_close(measured.gain.value, gain, allowed, 0.0);
            assert_close(measured.phase_rad.value, phase, 0.0, 1e-4);
        }
    }
}

#[test]
fn the_response_begins_with_the_delay_of_the_gyro() {
    for bandwidth in [500.0, 1000.0, 2000.0] {
        let config = quiet_gyro(bandwidth);
        let delay_ms = fogbench::gyro::facts(&config).unwrap().delay_ms;
        let (gain, phase) = word_response(&config, &[0.1]).unwrap()[0];
        assert_close(gain, 1.0, 1e-6, 0.0);
        assert_close(-phase / (TAU * 0.1), delay_ms * 1e-3, 1e-6, 0.0);
    }
}

#[test]
fn the_motion_starts_softly_and_stays_within_its_bounds() {
    let config = shaken(0.2);
    let bound = MotionConfig::MultiSine(config.clone()).rate_max_rad_per_s();
    assert_close(bound, deg_per_s_to_rad_per_s(0.05), 1e-12, 0.0);
    let acceleration = config.acceleration_max_rad_per_s2();
    let expected = TAU * deg_per_s_to_rad_per_s(0.01) * TONES_HZ.iter().sum::<f64>();
    assert_close(acceleration, expected, 1e-12, 0.0);
    let mut on_equator = table(config);
    on_equator.site.axis_elevation_deg = 0.0;
    on_equator.site.axis_azimuth_deg = 90.0;
    let mut turntable = Turntable::new(&on_equator, 0.25, PERIOD_S);
    let first = turntable.next_segment();
    assert!(first.rate_at(0.0).abs() < 1e-12 && first.rate_at(1.0).abs() < 1e-3 * bound);
    let mut last = first.rate_at(1.0);
    for _ in 0..4000 {
        let segment = turntable.next_segment();
        assert_close(segment.rate_at(0.0), last, 0.0, 1e-12);
        last = segment.rate_at(1.0);
        assert!(last.abs() <= bound);
    }
}

fn record<'a>(channel: &'a [f64], raw: &'a [f64], truth: &'a [f64]) -> Record<'a> {
    Record {
        channel_deg_per_h: channel,
        raw_deg_per_h: raw,
        truth_deg_per_h: Rates::Words(truth),
        response_deg_per_h: &[],
        encoder_rad: None,
        sample_period_s: PERIOD_S,
        first_stamp_s: 3.000_1,
        drift: None,
    }
}

#[test]
fn records_of_every_length_are_measured_or_refused() {
    let motion = Motion::MultiSine {
        frequencies_hz: TONES_HZ.to_vec(),
    };
    let facts = facts();
    for count in [1, 40, 63, 64, 200, 1700, 1720, 4000] {
        let truth = tones(count, |_| 1.0, 0.0, 8.0);
        let raw = tones(count, |_| 0.9, 3e-4, 8.0);
        let filtered = tones(count, |_| 0.8, 8e-4, 4.0);
        for (channel, filter) in [(&raw, None), (&filtered, Some(&facts))] {
            let metrics = measure(
                &record(channel, &raw, &truth),
                &settings(motion.clone()),
                filter,
            );
            every_metric_is_answered(&metrics);
            let delay = metrics.metrics.get("delay_vs_truth_ms");
            let asked = support(
                "delay_vs_truth_ms",
                count as f64 * PERIOD_S,
                PERIOD_S,
                &motion,
                filter.is_some(),
                100.0,
            );
            assert!(asked.is_err() || delay.is_some(), "{count}");
        }
    }
}

#[test]
fn a_filter_is_compared_with_truth_and_with_raw() {
    let truth = tones(8000, |_| 1.0, 0.0, 8.0);
    let raw = tones(8000, |_| 1.0, 3e-4, 8.0);
    let filtered = tones(8000, |_| 0.8, 8e-4, 4.0);
    let motion = Motion::MultiSine {
        frequencies_hz: TONES_HZ.to_vec(),
    };
    let metrics = measure(
        &record(&filtered, &raw, &truth),
        &settings(motion),
        Some(&facts()),
    );
    assert_close(value(&metrics, "delay_vs_truth_ms"), 0.8, 0.0, 1e-6);
    assert_close(value(&metrics, "delay_vs_raw_ms"), 0.5, 0.0, 1e-6);
    assert_close(value(&metrics, "amplitude_ratio"), 0.8, 1e-9, 0.0);
    assert_close(value(&metrics, "mean_ratio"), 0.5, 1e-9, 0.0);
    let mut transcript = Transcript::of("metrics", "A response that does not fall");
    let reason = &metrics.unavailable["bandwidth_hz"];
    transcript.case("bandwidth_hz", reason.as_str());
    transcript.check();
    let (truth, raw) = (
        &metrics.curves["frequency_response"],
        &metrics.curves["frequency_response_vs_raw"],
    );
    assert_eq!(truth["frequency_hz"], TONES_HZ);
    for tone in 0..TONES_HZ.len() {
        assert_close(truth["delay_ms"][tone], 0.8, 0.0, 1e-6);
        assert_close(raw["delay_ms"][tone], 0.5, 0.0, 1e-6);
        assert_close(raw["phase_deg"][tone], -0.18 * TONES_HZ[tone], 0.0, 1e-4);
    }
}

#[test]
fn repeats_pool_the_points_of_a_response() {
    let repeat = |delay_ms: f64, half_width_ms: f64| {
        let mut metrics = ChannelMetrics::default();
        let column = |name: &str, value: f64| (name.to_owned(), vec![value]);
        let curve = [
            column("frequency_hz", 7.0),
            column("delay_ms", delay_ms),
            column("delay_low_ms", delay_ms - half_width_ms),
            column("delay_high_ms", delay_ms + half_width_ms),
        ];
        let curve = curve.into_iter().collect();
        metrics
            .curves
            .insert("frequency_response".to_owned(), curve);
        metrics
    };
    let pooled = aggregate(&[
        repeat(1.0, 0.2),
        repeat(2.0, 0.2),
        repeat(3.0, 0.4),
        repeat(4.0, 0.4),
    ]);
    let curve = &pooled.curves["frequency_response"];
    assert_close(curve["frequency_hz"][0], 7.0, 1e-12, 0.0);
    assert_close(curve["delay_ms"][0], 2.5, 1e-12, 0.0);
    // The mean half width, 0.3, over the root of four.
    assert_close(curve["delay_low_ms"][0], 2.35, 1e-12, 0.0);
    assert_close(curve["delay_high_ms"][0], 2.65, 1e-12, 0.0);
}

fn check(motion: &str) -> Vec<String> {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let text = format!(
        "schema = 1\nname = \"x\"\nduration_s = 2.0\nwarm_up_s = 1.0\n[turntable.multi_sine]\n{motion}\n"
    );
    crate::support::write(folder.path(), "x.toml", &text);
    let output = fogbench(folder.path(), &["check", "x.toml"]);
    let lines = stderr(&output);
    lines.lines().map(str::to_owned).collect()
}

#[test]
fn tones_that_cannot_be_sampled_or_told_apart_are_refused() {
    let one = "rate_amplitudes_deg_per_s = [1.0]";
    let cases = [
        format!("frequencies_hz = [5.0, 1200.0]\n{one}"),
        format!("frequencies_hz = [1.0, 5.0]\n{one}"),
        format!("frequencies_hz = [20.0, 5.0]\n{one}"),
        format!("frequencies_hz = [20.0, 20.4]\n{one}"),
        "frequencies_hz = [5.0, 20.0, 80.0]\nrate_amplitudes_deg_per_s = [1.0, 2.0]".to_owned(),
        format!("frequencies_hz = [5.0, 400.0]\n{one}\nsoft_start_s = 1.5"),
    ];
    said_to_each(
        "motion",
        "Tones that cannot be sampled or told apart",
        cases,
        |motion| check(motion).join("\n"),
    );
}

#[test]
fn the_shipped_bandwidths_pass_and_draw_their_response() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let files = [
        "loop-bandwidth-500",
        "loop-bandwidth-1000",
        "loop-bandwidth-2000",
        "loop-response",
    ];
    run_audits(folder.path(), &files);
    let out = folder.path().join("out");
    for name in files {
        let run = summary(&out, name);
        let half_width = 0.5
            * (field(&run, "raw.delay_vs_truth_ms", "high")
                - field(&run, "raw.delay_vs_truth_ms", "low"));
        assert!(half_width < 0.002, "{name}: {half_width} ms");
        assert!(out.join(name).join("bode.svg").exists());
    }
}
