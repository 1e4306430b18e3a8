//! The encoder channel: delays against it, its latency, its steps and its cyclic errors.

use std::f64::consts::TAU;

use fogbench::experiment::plan_suite;
use fogbench::metrics::{ChannelMetrics, Motion, Record, SwingClock, fit_swing, measure};
use fogbench::scenario::{EncoderConfig, MotionConfig, ServoConfig};
use fogbench::signal::Rates;
use fogbench::units::{deg_per_s_to_rad_per_s, rad_per_s_to_deg_per_h, rad_per_s_to_deg_per_s};

use crate::support::records::{settings, value};
use crate::support::tables::{PERIOD_S, ideal_encoder, record, rotation, swing, table};
use crate::support::transcript::said_to_each;
use crate::support::{assert_close, code, field, fogbench, stderr, stdout, summary, write};

fn ideal_table(motion: MotionConfig, encoder: EncoderConfig, count: usize) -> (Vec<f64>, Vec<f64>) {
    let servo = ServoConfig::ideal();
    record(table(motion, servo, encoder, PERIOD_S), count)
}

/// Metrics of a gyro without noise, 203 us late, on a table that swings by 1 deg/s.
fn measured(encoder: EncoderConfig, frequency_hz: f64) -> ChannelMetrics {
    let (truth, angles) = ideal_table(swing(1.0, frequency_hz), encoder, 12_000);
    let truth: Vec<f64> = truth.into_iter().map(rad_per_s_to_deg_per_h).collect();
    let amplitude = rad_per_s_to_deg_per_h(deg_per_s_to_rad_per_s(1.0));
    let gyro: Vec<f64> = (1..=truth.len())
        .map(|stamp| {
            let time_s = stamp as f64 * PERIOD_S - 203e-6;
            amplitude * (TAU * (frequency_hz * time_s)).sin()
        })
        .collect();
    let record = Record {
        channel_deg_per_h: &gyro[4000..],
        raw_deg_per_h: &gyro[4000..],
        truth_deg_per_h: Rates::Words(&truth[4000..]),
        response_deg_per_h: &[],
        encoder_rad: Some(&angles[4000..]),
        sample_period_s: PERIOD_S,
        first_stamp_s: 4001.0 * PERIOD_S,
        drift: None,
    };
    measure(&record, &settings(Motion::Swing { frequency_hz }), None)
}

#[test]
fn the_delay_behind_an_ideal_encoder_is_the_delay_behind_truth() {
    for frequency_hz in [5.0, 10.0] {
        let metrics = measured(ideal_encoder(), frequency_hz);
        let behind_truth = value(&metrics, "delay_vs_truth_ms");
        assert_close(behind_truth, 0.203, 0.0, 1e-8);
        // A picosecond is rounding: 1e-12 of the phase of some hundred radians.
        let behind_encoder = value(&metrics, "delay_vs_encoder_ms");
        assert_close(behind_encoder, behind_truth, 0.0, 1e-8);
    }
}

#[test]
fn the_latency_of_the_encoder_comes_off_the_delay_behind_it() {
    // Within a sample, a whole sample, and across several.
    for latency_us in [50.0, 250.0, 1130.0] {
        let encoder = EncoderConfig {
            latency_us,
            ..ideal_encoder()
        };
        let metrics = measured(encoder, 10.0);
        let expected = 0.203 - latency_us * 1e-3;
        // The cubics between stamps err by (w T)^4 / 384 = 1.6e-10 of the swing.
        assert_close(value(&metrics, "delay_vs_encoder_ms"), expected, 0.0, 1e-8);
        assert_close(value(&metrics, "delay_vs_truth_ms"), 0.203, 0.0, 1e-8);
    }
}

#[test]
fn the_steps_of_an_encoder_leave_the_fit_within_its_interval() {
    let encoder = EncoderConfig {
        resolution_arcsec: Some(0.36),
        ..ideal_encoder()
    };
    let metrics = measured(encoder, 5.0);
    let delay = metrics.metrics["delay_vs_encoder_ms"].estimate;
    // Rounded alike before and after the turns of a swing without noise, the angles leave no error at all.
    let rounding = 1e-12;
    let (low, high) = (delay.low - rounding, delay.high + rounding);
    assert!(low <= 0.203 && 0.203 <= high, "{delay:?}");
    // Rounding leaves delta / sqrt(12) = 0.104 arcsec a sample on 114.6 arcsec: over 8000 samples
    // sqrt(2 / 8000) 0.104 / 114.6 = 14 urad or 0.46 us at 5 Hz; the same in every cycle, the
    // rounding does not average out as noise would, so that up to four of them are allowed.
    assert_close(delay.value, 0.203, 0.0, 4.0 * 0.46e-3);
}

#[test]
fn differencing_an_encoder_drowns_the_swing_in_its_steps() {
    // Why the fit is of the angle: steps of 0.36 arcsec at 4 kHz are delta / (sqrt(6) T) = 0.163
    // deg/s. The swing of 10 deg/s sweeps through 25 steps a sample, which makes them uniform.
    let encoder = EncoderConfig {
        resolution_arcsec: Some(0.36),
        ..ideal_encoder()
    };
    let (_, shown) = ideal_table(swing(10.0, 5.0), encoder, 24_000);
    let (_, exact) = ideal_table(swing(10.0, 5.0), ideal_encoder(), 24_000);
    let errors: Vec<f64> = (8001..24_000)
        .map(|k| (shown[k] - shown[k - 1] - exact[k] + exact[k - 1]) / PERIOD_S)
        .collect();
    let square = errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64;
    let expected = 0.36 / 3600.0 / 6.0_f64.sqrt() / PERIOD_S;
    assert_close(expected, 0.163, 0.0, 5e-4);
    // 800 samples a cycle, repeated: some 2 % of scatter.
    assert_close(rad_per_s_to_deg_per_s(square.sqrt()), expected, 0.06, 0.0);
}

#[test]
fn cyclic_errors_ripple_the_implied_rate_by_their_count_and_the_rate() {
    // 3.6 deg/s: a line of 36 arcsec every 11.1 samples, a turn in 100 s.
    let rate = deg_per_s_to_rad_per_s(3.6);
    let encoder = EncoderConfig {
        interpolation_error_arcsec: 0.5,
        interpolation_phase_deg: 40.0,
        ..ideal_encoder()
    };
    let (_, angles) = ideal_table(rotation(3.6), encoder, 8000);
    let errors: Vec<f64> = angles
        .iter()
        .zip(1..)
        .map(|(angle, stamp)| angle - rate * f64::from(stamp) * PERIOD_S)
        .collect();
    let clock = SwingClock {
        frequency_hz: 360.0,
        sample_period_s: PERIOD_S,
        first_stamp_s: PERIOD_S,
    };
    let fit = fit_swing(&errors, &clock).expect("720 cycles");
    let error = deg_per_s_to_rad_per_s(0.5 / 3600.0);
    assert_close(fit.whole.amplitude, error, 1e-6, 0.0);
    // 36 000 x 3.6 deg/s x 0.5 arcsec: 0.31 deg/s, a twelfth of the rotation.
    let ripple = fit.derivative().whole.amplitude;
    assert_close(ripple, 36_000.0 * rate * error, 1e-6, 0.0);
}

#[test]
fn eccentricity_repeats_once_a_turn_from_its_phase() {
    let encoder = EncoderConfig {
        eccentricity_error_arcsec: 2.0,
        eccentricity_phase_deg: 30.0,
        ..ideal_encoder()
    };
    // A turn a second: 4000 samples.
    let (_, angles) = ideal_table(rotation(360.0), encoder, 8000);
    for (stamp, phase_deg) in [(1, 30.09_f64), (1000, 120.0), (4000, 30.0), (6000, 210.0)] {
        let exact = TAU * stamp as f64 / 4000.0;
        let error = deg_per_s_to_rad_per_s(2.0 / 3600.0) * phase_deg.to_radians().sin();
        assert_close(angles[stamp - 1], exact + error, 0.0, 1e-12);
    }
}

#[test]
fn before_the_start_a_rotating_table_has_rotated_for_ever() {
    let encoder = EncoderConfig {
        latency_us: 1000.0,
        ..ideal_encoder()
    };
    let (_, angles) = ideal_table(rotation(90.0), encoder, 10);
    let rate = deg_per_s_to_rad_per_s(90.0);
    for (angle, stamp) in angles.iter().zip(1..) {
        let expected = rate * (f64::from(stamp) * PERIOD_S - 1e-3);
        assert_close(*angle, expected, 0.0, 1e-15);
    }
}

fn refusals(more: &str) -> Vec<String> {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let text = format!(
        "schema = 1\nname = \"s\"\nduration_s = 4.0\nwarm_up_s = 1.0\n[turntable.swing]\n\
         rate_amplitude_deg_per_s = 1.0\nfrequency_hz = 10.0\n{more}"
    );
    let path = write(folder.path(), "s.toml", &text);
    let errors = plan_suite(&[path], &[]).err().unwrap_or_default();
    errors.iter().map(ToString::to_string).collect()
}

#[test]
fn what_makes_no_sense_of_servo_and_encoder_is_refused_with_the_reason() {
    let gate = "[[gate]]\nmetric = \"raw.delay_vs_encoder_ms\"\nmax = 1.0\n";
    let encoder = "[turntable.encoder]\nresolution_arcsec = 0.0\n";
    assert_eq!(refusals(&format!("{encoder}{gate}")), Vec::<String>::new());
    let drive = "[turntable.servo.direct_drive]\n";
    let refused = [
        gate.to_owned(),
        "[turntable.encoder]\nlatency_us = 20.0\n".to_owned(),
        format!("{encoder}latency_us = 251.0\n{drive}"),
        format!("{drive}static_n_m = 0.04\n"),
        format!("{drive}friction_smoothing_rad_per_s = 1e-6\n"),
        format!("{drive}controller_rate_hz = 399.0\n"),
        format!("{drive}integral_ratio = 1.4\n"),
    ];
    said_to_each(
        "motion",
        "Servos and encoders that make no sense",
        refused,
        |more| refusals(more).join("\n"),
    );
}

#[test]
fn a_run_with_an_encoder_keeps_its_readings_beside_truth() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let text = "schema = 1\nname = \"s\"\nduration_s = 2.0\nwarm_up_s = 1.0\n\
                fidelity = \"rate\"\n[turntable.swing]\nrate_amplitude_deg_per_s = 1.0\n\
                frequency_hz = 10.0\n[turntable.encoder]\nresolution_arcsec = 0.36\n\
                latency_us = 100.0\n[output]\nsamples = \"npy\"\n";
    write(folder.path(), "s.toml", text);
    let output = fogbench(folder.path(), &["run", "s.toml"]);
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    let samples = folder.path().join("output/s/samples");
    let length = |name: &str| {
        let file = samples.join(name);
        std::fs::metadata(file).expect("a file of samples").len()
    };
    assert_eq!(length("encoder_arcsec.npy"), length("truth.npy"));
    let summary = summary(&folder.path().join("output"), "s");
    let difference = field(&summary, "raw.delay_vs_truth_ms", "value")
        - field(&summary, "raw.delay_vs_encoder_ms", "value");
    // 0.36 arcsec on 57 arcsec, 8000 samples: 0.46 us for 10 Hz; four of them.
    assert_close(difference, 0.1, 0.0, 4.0 * 0.46e-3);
}
