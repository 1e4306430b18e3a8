//! Trapezoids, sweeps, test signals and scripts against their closed forms.

use std::f64::consts::TAU;

use fogbench::scenario::{
    ChirpConfig, MotionConfig, MountingConfig, Progression, ScriptConfig, ScriptPoints,
    SecondOrderServoConfig, ServoConfig, SignalShape, SiteConfig, TestSignalConfig,
    TrapezoidConfig, TurntableConfig,
};
use fogbench::signal::MotionSegment;
use fogbench::turntable::{CommandExtremes, Surroundings, Turntable};
use fogbench::units::{deg_per_s_to_rad_per_s, rad_per_s_to_deg_per_s, rad_to_deg};

use crate::support::assert_close;
use crate::support::turntable_cases::{no_encoder, true_axis, true_mounting};

const PERIOD_S: f64 = 0.000_25;
/// Samples of the warm-up.
const WARM_UP: usize = 4000;

fn config(motion: MotionConfig) -> TurntableConfig {
    TurntableConfig {
        motion,
        servo: ServoConfig::ideal(),
        encoder: no_encoder(),
        // Level and eastward: no Earth rate to speak of.
        site: SiteConfig {
            latitude_deg: 34.27,
            axis_elevation_deg: 0.0,
            axis_azimuth_deg: 90.0,
            ..SiteConfig::reference()
        },
        axis: true_axis(),
        mounting: true_mounting(),
        ..TurntableConfig::reference()
    }
}

fn extremes(motion: &MotionConfig) -> CommandExtremes {
    motion.extremes(Surroundings {
        warm_up_s: 1.0,
        servo: &ServoConfig::ideal(),
    })
}

fn table(motion: MotionConfig) -> Turntable {
    Turntable::new(&config(motion), 1.0, PERIOD_S)
}

/// Rates (deg/s) and table angles (deg) at the stamps after the warm-up, `count` of them.
fn recorded(mut table: Turntable, count: usize) -> Vec<(f64, f64)> {
    for _ in 0..WARM_UP {
        let _ = table.next_segment();
    }
    let rates = std::iter::repeat_with(|| {
        let rate = table.next_segment().rate_at(1.0);
        (rad_per_s_to_deg_per_s(rate), rad_to_deg(table.angle_rad()))
    });
    rates.take(count).collect()
}

fn end_slope(segment: &MotionSegment) -> f64 {
    let [_, c1, c2, c3] = segment.rate_rad_per_s;
    c1 + 2.0 * c2 + 3.0 * c3
}

/// Rates and slopes agree where segments meet; returns the largest rate and acceleration.
fn assert_joined(mut table: Turntable, count: usize) -> (f64, f64) {
    let mut before = table.next_segment();
    let (mut rate, mut acceleration): (f64, f64) = (0.0, 0.0);
    for _ in 1..count {
        let after = table.next_segment();
        assert_close(after.rate_at(0.0), before.rate_at(1.0), 1e-13, 1e-15);
        assert_close(after.rate_rad_per_s[1], end_slope(&before), 1e-9, 1e-15);
        rate = rate.max(after.rate_at(1.0).abs());
        acceleration = acceleration.max(end_slope(&after).abs() / PERIOD_S);
        before = after;
    }
    (rate, acceleration)
}

fn trapezoid(both_senses: bool) -> TrapezoidConfig {
    TrapezoidConfig {
        rate_deg_per_s: 10.0,
        acceleration_deg_per_s2: 40.0,
        hold_s: 0.5,
        rest_s: 0.25,
        cycles: 2,
        both_senses,
        ..TrapezoidConfig::reference()
    }
}

#[test]
fn a_trapezoid_turns_by_its_area_and_rests() {
    let motion = MotionConfig::Trapezoid(trapezoid(false));
    let record = recorded(table(motion), 10_000);
    // Ramps of 0.25 s, a top of 0.5 s, a rest of 0.25 s: 1.25 s or 5000 samples each.
    for (index, (rate, angle)) in record.iter().enumerate() {
        let time_s = (index + 1) as f64 * PERIOD_S;
        let within = time_s % 1.25;
        let want = if time_s >= 2.5 {
            0.0
        } else {
            (40.0 * within.min(1.0 - within)).clamp(0.0, 10.0)
        };
        assert_close(*rate, want, 0.0, 1e-9);
        // 7.5 deg each; a corner inside a sample may cost an eighth of what it turns by.
        if index == 4500 || index == 9500 {
            let count = if index < 5000 { 1.0 } else { 2.0 };
            assert_close(*angle, 7.5 * count, 0.0, 1e-5);
        }
    }
}

#[test]
fn trapezoids_of_both_senses_come_back() {
    let config = trapezoid(true);
    assert_eq!(config.count(), 4);
    assert_close(config.length_s(), 4.75, 1e-15, 0.0);
    let record = recorded(table(MotionConfig::Trapezoid(config)), 25_000);
    let (_, end) = record[24_999];
    assert_close(end, 0.0, 0.0, 1e-12);
    assert_close(record[2000].0, 10.0, 1e-12, 0.0);
    assert_close(record[7000].0, -10.0, 1e-12, 0.0);
    assert_close(record[4200].1, 7.5, 0.0, 1e-5);
}

#[test]
fn trapezoids_join_and_keep_to_their_extremes() {
    let motion = MotionConfig::Trapezoid(trapezoid(true));
    let (rate, acceleration) = assert_joined(table(motion.clone()), 25_000);
    let extremes = extremes(&motion);
    assert_close(rate, motion.rate_max_rad_per_s(), 1e-12, 0.0);
    assert_close(acceleration, extremes.acceleration_rad_per_s2, 1e-9, 0.0);
    assert_close(extremes.jump_rad_per_s, 0.0, 0.0, 0.0);
}

/// One of the four signals of Donoho and Johnstone at a share of its length, by the words of their table.
fn donoho_johnstone(shape: SignalShape, t: f64) -> f64 {
    let sign = |t: f64| if t < 0.0 { -1.0 } else { 1.0 };
    match shape {
        SignalShape::Blocks => {
            let at = [
                0.1, 0.13, 0.15, 0.23, 0.25, 0.4, 0.44, 0.65, 0.76, 0.78, 0.81,
            ];
            let heights = [4.0, -5.0, 3.0, -4.0, 5.0, -4.2, 2.1, 4.3, -3.1, 2.1, -4.2];
            let jumps = at.iter().zip(heights);
            let sum: f64 = jumps
                .map(|(at, height)| height * 0.5 * (1.0 + sign(t - at)))
                .sum();
            sum / 5.2
        }
        SignalShape::Step => 0.5 * (1.0 + sign(t - 0.5)),
        SignalShape::Heavisine => {
            (4.0 * (2.0 * TAU * t).sin() - sign(t - 0.3) - sign(0.72 - t)) / 6.0
        }
        SignalShape::Doppler => 2.0 * (t * (1.0 - t)).sqrt() * (TAU * 1.05 / (t + 0.05)).sin(),
    }
}

#[test]
fn known_answer_of_the_signals_that_wavelet_methods_are_tried_on() {
    let shapes = [
        SignalShape::Blocks,
        SignalShape::Step,
        SignalShape::Heavisine,
        SignalShape::Doppler,
    ];
    for shape in shapes {
        let config = TestSignalConfig {
            shape,
            rate_amplitude_deg_per_s: 3.0,
            length_s: 5.0,
            ..TestSignalConfig::reference()
        };
        let motion = MotionConfig::TestSignal(config);
        let bound = extremes(&motion);
        let record = recorded(table(motion), 24_000);
        let mut before = 0.0;
        let (mut largest, mut jump): (f64, f64) = (0.0, 0.0);
        for (index, (rate, _)) in record.iter().enumerate() {
            // A word ends its sample, and a jump begins the next.
            let t = (index + 1) as f64 / 20_000.0;
            let just_before = t - 1e-9;
            let want = if t > 1.0 {
                if shape == SignalShape::Step { 3.0 } else { 0.0 }
            } else {
                3.0 * donoho_johnstone(shape, just_before)
            };
            assert!((rate - want).abs() < 1e-5, "{shape:?} {t}: {rate} {want}");
            largest = largest.max(rate.abs());
            jump = jump.max((rate - before).abs());
            before = *rate;
        }
        let jump = deg_per_s_to_rad_per_s(jump);
        let turned = bound.acceleration_rad_per_s2 * PERIOD_S;
        assert!(
            jump <= (bound.jump_rad_per_s + turned) * (1.0 + 1e-9),
            "{shape:?} {jump} {bound:?}"
        );
        let least = if shape == SignalShape::Doppler {
            2.7
        } else {
            2.9999
        };
        assert!(
            (least..=3.0 + 1e-9).contains(&largest),
            "{shape:?} {largest}"
        );
    }
}

fn chirp(progression: Progression, is_angle: bool) -> ChirpConfig {
    ChirpConfig {
        rate_amplitude_deg_per_s: (!is_angle).then_some(2.0),
        angle_amplitude_deg: is_angle.then_some(0.5),
        start_frequency_hz: 2.0,
        end_frequency_hz: 32.0,
        sweep_s: 4.0,
        progression,
        soft_start_s: 0.5,
        soft_stop_s: 0.5,
        ..ChirpConfig::reference()
    }
}

/// Phase of the sweep, cycles, by Simpson's rule on the frequency
/// and apart from the closed form.
fn integrated_cycles(config: &ChirpConfig, time_s: f64) -> f64 {
    const STEPS: u32 = 2000;
    let frequency = |t: f64| match config.progression {
        Progression::Linear => 2.0 + 30.0 * t / 4.0,
        Progression::Logarithmic => 2.0 * 16.0_f64.powf(t / 4.0),
    };
    let h = time_s / f64::from(STEPS);
    let sum: f64 = (0..=STEPS)
        .map(|i| {
            let weight = match i {
                0 | STEPS => 1.0,
                _ if i % 2 == 1 => 4.0,
                _ => 2.0,
            };
            weight * frequency(h * f64::from(i))
        })
        .sum();
    sum * h / 3.0
}

#[test]
fn a_sweep_has_the_phase_of_its_frequency() {
    for progression in [Progression::Linear, Progression::Logarithmic] {
        let config = chirp(progression, false);
        let record = recorded(table(MotionConfig::Chirp(config.clone())), 16_000);
        for index in (0..16_000).step_by(371) {
            let cycles = integrated_cycles(&config, (index + 1) as f64 * PERIOD_S);
            assert_close(record[index].0, 2.0 * (TAU * cycles).sin(), 0.0, 1e-9);
        }
        // (f0 + f1) / 2 D and (f1 - f0) D / ln(f1 / f0) cycles: two changes of sign in each.
        let changes = record.windows(2).filter(|p| p[0].0 * p[1].0 < 0.0).count();
        let cycles = match progression {
            Progression::Linear => 68.0,
            Progression::Logarithmic => 120.0 / 16.0_f64.ln(),
        };
        assert_close(changes as f64, 2.0 * cycles, 0.0, 2.0);
    }
}

#[test]
fn a_sweep_of_constant_angle_keeps_its_angle() {
    let config = chirp(Progression::Logarithmic, true);
    let mut table = table(MotionConfig::Chirp(config.clone()));
    for _ in 0..WARM_UP {
        let _ = table.next_segment();
    }
    let start = rad_to_deg(table.angle_rad());
    for index in 0..16_000 {
        let _ = table.next_segment();
        if index % 371 == 0 {
            let cycles = integrated_cycles(&config, f64::from(index + 1) * PERIOD_S);
            let exact = start + 0.5 * (1.0 - (TAU * cycles).cos());
            // The cubics miss (w T)^4 / 720 of the angle: 1e-8 of it at 32 Hz.
            assert_close(rad_to_deg(table.angle_rad()), exact, 0.0, 1e-8);
        }
    }
}

#[test]
fn a_sweep_starts_and_stops_softly_and_then_rests() {
    for is_angle in [false, true] {
        let motion = MotionConfig::Chirp(chirp(Progression::Logarithmic, is_angle));
        let (rate, acceleration) = assert_joined(table(motion.clone()), 24_000);
        let extremes = extremes(&motion);
        assert!(rate <= motion.rate_max_rad_per_s() * (1.0 + 1e-12));
        assert!(acceleration <= extremes.acceleration_rad_per_s2);
        assert!(acceleration > 0.9 * extremes.acceleration_rad_per_s2);
        let record = recorded(table(motion), 19_000);
        assert!(record[17_999].0.abs() < 1e-9 && record[18_500].0.abs() <= 1e-12);
        assert!(
            record[16_000..17_000]
                .iter()
                .any(|(rate, _)| rate.abs() > 1.0)
        );
    }
}

#[test]
fn a_sweep_between_equal_frequencies_is_a_swing() {
    for progression in [Progression::Linear, Progression::Logarithmic] {
        let config = ChirpConfig {
            end_frequency_hz: 2.0,
            ..chirp(progression, false)
        };
        let record = recorded(table(MotionConfig::Chirp(config)), 16_000);
        for (index, (rate, _)) in record.iter().enumerate() {
            let phase = TAU * 2.0 * (index + 1) as f64 * PERIOD_S;
            assert_close(*rate, 2.0 * phase.sin(), 0.0, 1e-10);
        }
    }
}

fn script(rates: Option<Vec<f64>>, angles: Option<Vec<f64>>) -> MotionConfig {
    MotionConfig::Script(ScriptConfig {
        points: ScriptPoints {
            time_s: vec![0.0, 0.5, 0.75, 2.0],
            rate_deg_per_s: rates,
            angle_deg: angles,
        },
        ..ScriptConfig::reference()
    })
}

#[test]
fn scripted_rates_are_joined_by_straight_lines() {
    let motion = script(Some(vec![1.0, 5.0, -3.0, 2.0]), None);
    let record = recorded(table(motion.clone()), 10_000);
    for (index, (rate, _)) in record.iter().enumerate() {
        let t = (index + 1) as f64 * PERIOD_S;
        let want = match t {
            t if t < 0.5 => 1.0 + 8.0 * t,
            t if t < 0.75 => 5.0 - 32.0 * (t - 0.5),
            t if t < 2.0 => -3.0 + 4.0 * (t - 0.75),
            _ => 2.0,
        };
        assert_close(*rate, want, 0.0, 1e-9);
    }
    // The first rate is held from the start: one second of 1 deg/s, then the areas of the lines.
    assert_close(record[7999].1, 1.0 + 1.5 + 0.25 - 0.625, 0.0, 1e-6);
    let extremes = extremes(&motion);
    assert_close(
        extremes.jump_rad_per_s,
        deg_per_s_to_rad_per_s(1.0),
        1e-15,
        0.0,
    );
    assert_close(
        extremes.acceleration_rad_per_s2,
        deg_per_s_to_rad_per_s(32.0),
        1e-12,
        0.0,
    );
    assert_close(
        motion.rate_max_rad_per_s(),
        deg_per_s_to_rad_per_s(5.0),
        1e-15,
        0.0,
    );
}

#[test]
fn scripted_angles_are_met_and_never_exceeded() {
    let angles = vec![0.0, 10.0, 40.0, 20.0];
    let motion = script(None, Some(angles));
    let record = recorded(table(motion.clone()), 10_000);
    let extremes = extremes(&motion);
    // The slope at a point is that after it: each jump of it turns the sample before the point by
    // T^2 / 12 of the jump, of which the record holds four.
    let jump = 2.0 * rad_per_s_to_deg_per_s(extremes.acceleration_rad_per_s2);
    let missed = 4.0 * PERIOD_S * PERIOD_S / 12.0 * jump;
    assert!(missed < 1e-3);
    for (sample, angle) in [(1999, 10.0), (2999, 40.0), (7999, 20.0), (9999, 20.0)] {
        assert_close(record[sample].1, angle, 0.0, missed);
    }
    assert!(
        record[..3000]
            .windows(2)
            .all(|pair| pair[1].1 >= pair[0].1 - 1e-9)
    );
    assert!(
        record[3000..8000]
            .windows(2)
            .all(|pair| pair[1].1 <= pair[0].1 + 1e-9)
    );
    // At rest before, at the turning point and after.
    for sample in [2999, 7999, 9000] {
        assert_close(record[sample].0, 0.0, 0.0, 1e-9);
    }
    // Weighted harmonic mean of 20 and 120 deg/s over 0.5 and 0.25 s: weights 1.0 and 1.25.
    assert_close(
        record[1999].0,
        2.25 / (1.0 / 20.0 + 1.25 / 120.0),
        1e-9,
        0.0,
    );
    let (rate, acceleration) = assert_joined(table(motion.clone()), 14_000);
    assert_close(rate, motion.rate_max_rad_per_s(), 1e-5, 0.0);
    assert!(acceleration <= extremes.acceleration_rad_per_s2 * (1.0 + 1e-9));
    assert!(acceleration > 0.99 * extremes.acceleration_rad_per_s2);
    assert_close(extremes.jump_rad_per_s, 0.0, 0.0, 0.0);
}

#[test]
fn a_servo_follows_a_script_and_an_askew_gyro_senses_it() {
    let mut config = config(script(Some(vec![0.0, 5.0, -3.0, 2.0]), None));
    config.servo = ServoConfig::SecondOrder(SecondOrderServoConfig {
        natural_frequency_hz: 40.0,
        damping_ratio: 0.7,
        ..SecondOrderServoConfig::reference()
    });
    config.mounting = MountingConfig {
        misalignment_arcsec: 3600.0 * 60.0,
        ..true_mounting()
    };
    let record = recorded(Turntable::new(&config, 1.0, PERIOD_S), 12_000);
    // Settled on 2 deg/s, of which an axis 60 deg away senses half; the Earth gives 4 mdeg/s.
    assert_close(record[11_999].0, 1.0, 0.0, 5e-3);
}
