//! Known answers of the rate table: Earth rate, swing kinematics, servo, soft start, staircase.

use std::f64::consts::{PI, TAU};

use fogbench::scenario::{
    MotionConfig, RotationConfig, SecondOrderServoConfig, ServoConfig, SiteConfig, Stairs,
    StepsConfig, SwingConfig, TurntableConfig,
};
use fogbench::signal::MotionSegment;
use fogbench::turntable::{Turntable, earth_rate_rad_per_s, first_measured_index, step_indices};
use fogbench::units::{
    deg_per_s_to_rad_per_s, deg_to_rad, rad_per_s_to_deg_per_h, rad_per_s_to_deg_per_s,
    rad_to_arcsec, rad_to_deg,
};

use crate::support::assert_close;
use crate::support::turntable_cases::{no_encoder, true_axis, true_mounting};

/// Four kilohertz, commensurate with the swings, so that records hold whole cycles.
const PERIOD_S: f64 = 0.000_25;

/// East-west horizontal axis: no Earth rate.
fn eastward() -> SiteConfig {
    site(34.27, 0.0, 90.0)
}

fn site(latitude_deg: f64, axis_elevation_deg: f64, axis_azimuth_deg: f64) -> SiteConfig {
    SiteConfig {
        latitude_deg,
        axis_elevation_deg,
        axis_azimuth_deg,
        ..SiteConfig::reference()
    }
}

fn swing(frequency_hz: f64, soft_start_s: f64) -> MotionConfig {
    MotionConfig::Swing(SwingConfig {
        rate_amplitude_deg_per_s: Some(1.0),
        frequency_hz,
        soft_start_s,
        ..SwingConfig::reference()
    })
}

fn second_order(natural_frequency_hz: f64, damping_ratio: f64) -> ServoConfig {
    ServoConfig::SecondOrder(SecondOrderServoConfig {
        natural_frequency_hz,
        damping_ratio,
        ..SecondOrderServoConfig::reference()
    })
}

fn ideal() -> ServoConfig {
    ServoConfig::ideal()
}

fn table(
    motion: MotionConfig,
    servo: ServoConfig,
    site: SiteConfig,
    warm_up_s: f64,
    sample_period_s: f64,
) -> Turntable {
    let config = TurntableConfig {
        motion,
        servo,
        encoder: no_encoder(),
        site,
        axis: true_axis(),
        mounting: true_mounting(),
        ..TurntableConfig::reference()
    };
    Turntable::new(&config, warm_up_s, sample_period_s)
}

/// Truth at the stamps `from + 1 ..= from + count`, deg/s.
fn truth_deg_per_s(mut table: Turntable, from: usize, count: usize) -> Vec<f64> {
    let rates = std::iter::repeat_with(|| table.next_segment().rate_at(1.0));
    rates
        .skip(from)
        .take(count)
        .map(rad_per_s_to_deg_per_s)
        .collect()
}

/// Amplitude and phase (rad, of a sine from time 0) over whole cycles; index 0 is stamp `from + 1`.
fn fit_sine(samples: &[f64], from: usize, cycles_per_sample: f64) -> (f64, f64) {
    let (mut in_phase, mut quadrature) = (0.0, 0.0);
    for (index, sample) in samples.iter().enumerate() {
        let phase = TAU * (cycles_per_sample * (from + index + 1) as f64).fract();
        in_phase += sample * phase.sin();
        quadrature += sample * phase.cos();
    }
    let scale = 2.0 / samples.len() as f64;
    (
        scale * in_phase.hypot(quadrature),
        quadrature.atan2(in_phase),
    )
}

#[test]
fn known_answer_k28_earth_rate_on_a_vertical_axis() {
    let up = |latitude| rad_per_s_to_deg_per_h(earth_rate_rad_per_s(&site(latitude, 90.0, 0.0)));
    for (latitude_deg, rate_deg_per_h) in [(26.65, 6.747), (34.27, 8.470), (45.0, 10.636)] {
        let exact = 15.041_07 * deg_to_rad(latitude_deg).sin();
        assert_close(up(latitude_deg), exact, 1e-6, 0.0);
        // Half a unit of the published last digit.
        assert_close(up(latitude_deg), rate_deg_per_h, 0.0, 0.000_5);
        assert_close(up(-latitude_deg), -exact, 1e-6, 0.0);
    }
}

#[test]
fn earth_rate_follows_the_pointing_of_the_axis() {
    let rate = |site| rad_per_s_to_deg_per_h(earth_rate_rad_per_s(&site));
    assert_close(rate(eastward()), 0.0, 0.0, 1e-14);
    // North and level: the horizontal component. Along the pole: all of it.
    let horizontal = 15.041_07 * deg_to_rad(34.27).cos();
    assert_close(rate(site(34.27, 0.0, 0.0)), horizontal, 1e-6, 0.0);
    assert_close(rate(site(34.27, 34.27, 0.0)), 15.041_07, 1e-6, 0.0);
    // A vertical axis tilted 0.1 deg towards north gains 0.0217 deg/h.
    let gained = rate(site(34.27, 89.9, 0.0)) - rate(site(34.27, 90.0, 0.0));
    assert_close(gained, 0.0217, 0.0, 0.000_05);
}

#[test]
fn known_answer_k29_angle_amplitude_of_a_swing() {
    let rate_rad_per_s = SwingConfig {
        rate_amplitude_deg_per_s: Some(1.0),
        frequency_hz: 5.0,
        soft_start_s: 1.0,
        ..SwingConfig::reference()
    }
    .rate_amplitude_rad_per_s();
    let angle_rad = rate_rad_per_s / (TAU * 5.0);
    assert_close(rad_to_arcsec(angle_rad), 114.592, 0.0, 0.000_5);
    // The same motion given by its angle.
    let by_angle = SwingConfig {
        angle_amplitude_deg: Some(rad_to_deg(angle_rad)),
        frequency_hz: 5.0,
        soft_start_s: 1.0,
        ..SwingConfig::reference()
    };
    let rate = by_angle.rate_amplitude_rad_per_s();
    assert_close(rad_per_s_to_deg_per_s(rate), 1.0, 1e-12, 0.0);
    let max = MotionConfig::Swing(by_angle).rate_max_rad_per_s();
    assert_close(max, rate, 1e-15, 0.0);
}

#[test]
#[should_panic(expected = "a swing has one amplitude")]
fn a_swing_with_two_amplitudes_is_refused() {
    let _ = SwingConfig {
        rate_amplitude_deg_per_s: Some(1.0),
        angle_amplitude_deg: Some(1.0),
        frequency_hz: 5.0,
        soft_start_s: 1.0,
        ..SwingConfig::reference()
    }
    .rate_amplitude_rad_per_s();
}

#[test]
fn known_answer_k29_the_servo_lags_its_command_by_its_transfer_function() {
    // Under-, critically and over-damped; the soft start has died out 3 s after its end.
    for (frequency_hz, natural_hz, zeta) in [
        (10.0, 40.0, 0.7),
        (5.0, 40.0, 0.7),
        (10.0, 80.0, 0.7),
        (10.0, 40.0, 1.0),
        (10.0, 40.0, 1.000_001),
        (10.0, 40.0, 3.0),
        (50.0, 40.0, 0.2),
    ] {
        let table = table(
            swing(frequency_hz, 1.0),
            second_order(natural_hz, zeta),
            eastward(),
            4.0,
            PERIOD_S,
        );
        let truth = truth_deg_per_s(table, 16_000, 4000);
        let (amplitude, phase) = fit_sine(&truth, 16_000, frequency_hz * PERIOD_S);
        let ratio = frequency_hz / natural_hz;
        let (real, imaginary) = (1.0 - ratio * ratio, 2.0 * zeta * ratio);
        // The command enters as cubics, low by at most (w T)^4 / 384 in amplitude, not in phase.
        let cubic = (TAU * frequency_hz * PERIOD_S).powi(4) / 384.0;
        assert_close(amplitude, 1.0 / real.hypot(imaginary), cubic, 1e-12);
        assert_close(phase, -imaginary.atan2(real), 0.0, 1e-9);
    }
}

#[test]
fn known_answer_k29_figures_of_the_40_hz_table() {
    let table = table(
        swing(10.0, 1.0),
        second_order(40.0, 0.7),
        eastward(),
        2.0,
        PERIOD_S,
    );
    let (amplitude, phase) = fit_sine(&truth_deg_per_s(table, 8000, 4000), 8000, 0.0025);
    assert_close(amplitude, 0.999_30, 0.0, 5e-6);
    assert_close(rad_to_deg(phase), -20.472, 0.0, 5e-4);
    // The lag, 5.69 ms, is that of the table, not of a gyro: truth is not the command.
    assert_close(-phase / (TAU * 10.0), 5.687e-3, 0.0, 5e-7);
}

#[test]
fn without_a_servo_the_axis_is_the_command() {
    let table = table(swing(10.0, 1.0), ideal(), eastward(), 2.0, PERIOD_S);
    let (amplitude, phase) = fit_sine(&truth_deg_per_s(table, 8000, 4000), 8000, 0.0025);
    assert_close(amplitude, 1.0, 1e-13, 0.0);
    assert_close(phase, 0.0, 0.0, 1e-12);
}

#[test]
fn truth_of_a_swing_averages_to_the_earth_rate_over_whole_cycles() {
    for servo in [ideal(), second_order(40.0, 0.7)] {
        let table = table(
            swing(5.0, 1.0),
            servo,
            site(34.27, 90.0, 0.0),
            2.0,
            PERIOD_S,
        );
        let truth = truth_deg_per_s(table, 8000, 8000);
        let mean = truth.iter().sum::<f64>() / truth.len() as f64;
        // Sums of 8000 values near 1 deg/s are good to about 1e-13 deg/s.
        assert_close(
            mean * 3600.0,
            15.041_07 * deg_to_rad(34.27).sin(),
            1e-6,
            0.0,
        );
    }
}

#[test]
fn phase_holds_after_hours() {
    const SAMPLES: usize = 10_000_000;
    const PERIOD: f64 = 64.0 * 3.916_58e-6;
    let table = table(swing(10.0, 1.0), ideal(), eastward(), 2.0, PERIOD);
    let last = truth_deg_per_s(table, SAMPLES - 1, 1)[0];
    // Exact count of cycles in units of 1e-14: 10 Hz x 64 x 3.91658e-6 s = 0.00250661120 cycles.
    let cycles = (SAMPLES as u128 * 250_661_120) % 100_000_000_000;
    let exact = (TAU * cycles as f64 / 1e11).sin();
    // 25,066 cycles with a relative rounding of 2.2e-16 or two: 1e-11 cycles.
    assert_close(last, exact, 0.0, 1e-10);
}

#[test]
fn soft_start_is_a_raised_cosine_without_kinks() {
    const RATE_DEG_PER_S: f64 = 10.0;
    let rotation = MotionConfig::Rotation(RotationConfig {
        rate_deg_per_s: RATE_DEG_PER_S,
        soft_start_s: 0.5,
        ..RotationConfig::reference()
    });
    let mut table = table(rotation, ideal(), eastward(), 2.0, PERIOD_S);
    let segments: Vec<_> = (0..8000).map(|_| table.next_segment()).collect();
    let amplitude = deg_per_s_to_rad_per_s(RATE_DEG_PER_S);
    for (index, segment) in segments.iter().enumerate() {
        let time_s = (index + 1) as f64 * PERIOD_S;
        let ramp = 0.5 * (1.0 - (PI * time_s.min(0.5) / 0.5).cos());
        assert_close(segment.rate_at(1.0), amplitude * ramp, 1e-12, 1e-14);
    }
    assert_joined(&segments);
    // The steepest point: pi / 2 of the mean slope.
    let steepest = segments
        .iter()
        .map(|segment| segment.rate_rad_per_s[1] / PERIOD_S)
        .fold(0.0, f64::max);
    assert_close(steepest, amplitude * PI / 2.0 / 0.5, 1e-6, 0.0);
}

/// Rates and slopes agree where segments meet.
fn assert_joined(segments: &[MotionSegment]) {
    for pair in segments.windows(2) {
        let [_, c1, c2, c3] = pair[0].rate_rad_per_s;
        let slope = c1 + 2.0 * c2 + 3.0 * c3;
        assert_close(pair[1].rate_at(0.0), pair[0].rate_at(1.0), 1e-13, 1e-15);
        assert_close(pair[1].rate_rad_per_s[1], slope, 1e-9, 1e-15);
    }
}

#[test]
fn segments_of_a_swing_join_with_and_without_servo() {
    for servo in [ideal(), second_order(40.0, 0.7)] {
        let mut table = table(swing(10.0, 0.7), servo, eastward(), 2.0, PERIOD_S);
        let segments: Vec<_> = (0..8000).map(|_| table.next_segment()).collect();
        assert_joined(&segments);
    }
}

#[test]
fn soft_start_lasts_one_second_at_most_and_never_longer_than_the_warm_up() {
    let full_from = |soft_start_s, warm_up_s| {
        let rotation = MotionConfig::Rotation(RotationConfig {
            rate_deg_per_s: 1.0,
            soft_start_s,
            ..RotationConfig::reference()
        });
        let table = table(rotation, ideal(), eastward(), warm_up_s, PERIOD_S);
        let truth = truth_deg_per_s(table, 0, 20_000);
        truth.iter().position(|rate| *rate > 1.0 - 1e-12).unwrap() + 1
    };
    assert_eq!(full_from(0.5, 2.0), 2000);
    assert_eq!(full_from(3.0, 4.0), 4000);
    assert_eq!(full_from(1.0, 0.25), 1000);
    assert_eq!(full_from(1.0, 0.0), 1);
}

#[test]
fn the_cubic_errs_by_its_bound_and_no_more() {
    const PERIOD: f64 = 64.0 * 3.916_58e-6;
    let mut table = table(swing(10.0, 0.0), ideal(), eastward(), 0.0, PERIOD);
    let amplitude = deg_per_s_to_rad_per_s(1.0);
    let mut largest: f64 = 0.0;
    for index in 0..800 {
        let segment = table.next_segment();
        for sixteenth in 0..=16 {
            let u = f64::from(sixteenth) / 16.0;
            let exact = amplitude * (TAU * 10.0 * (f64::from(index) + u) * PERIOD).sin();
            largest = largest.max((segment.rate_at(u) - exact).abs() / amplitude);
        }
    }
    let bound = (TAU * 10.0 * PERIOD).powi(4) / 384.0;
    // Between the samples the bound is reached, so that the check is not an empty one.
    assert!(largest <= bound + 1e-14, "{largest} above {bound}");
    assert!(largest > 0.99 * bound, "{largest} far below {bound}");
    assert!(bound < 2e-10);
}

fn staircase() -> StepsConfig {
    StepsConfig {
        rates_deg_per_s: vec![2.0, -1.0, 0.5],
        dwell_s: 0.1,
        settle_s: 0.0,
        ..StepsConfig::reference()
    }
}

#[test]
fn steps_fall_on_sample_boundaries() {
    const PERIOD: f64 = 64.0 * 3.916_58e-6;
    let changes = step_indices(&Stairs::from(&staircase()), 0.05, PERIOD);
    // 0.05 s = 199.47 samples, 0.1 s = 398.945 samples, 0.2 s = 797.89 samples.
    assert_eq!(first_measured_index(0.05, PERIOD), 200);
    assert_eq!(changes, [599, 998]);
    let steps = MotionConfig::Steps(staircase());
    assert_close(
        rad_per_s_to_deg_per_s(steps.rate_max_rad_per_s()),
        2.0,
        1e-15,
        0.0,
    );
    let mut table = table(steps, ideal(), eastward(), 0.05, PERIOD);
    for index in 0..3000 {
        let want_deg_per_s = match index {
            0..599 => 2.0,
            599..998 => -1.0,
            _ => 0.5,
        };
        let segment = table.next_segment();
        for u in [0.0, 0.5, 1.0] {
            let rate_deg_per_s = rad_per_s_to_deg_per_s(segment.rate_at(u));
            assert_close(rate_deg_per_s, want_deg_per_s, 1e-12, 0.0);
        }
    }
}

#[test]
fn a_staircase_of_one_rate_has_no_step() {
    let steps = StepsConfig {
        rates_deg_per_s: vec![3.0],
        dwell_s: 0.1,
        settle_s: 0.0,
        ..StepsConfig::reference()
    };
    assert!(step_indices(&Stairs::from(&steps), 1.0, PERIOD_S).is_empty());
    // Settled from the start: no transient with a servo either.
    let table = table(
        MotionConfig::Steps(steps),
        second_order(40.0, 0.7),
        eastward(),
        1.0,
        PERIOD_S,
    );
    for rate in truth_deg_per_s(table, 0, 8000) {
        assert_close(rate, 3.0, 1e-12, 0.0);
    }
}

#[test]
fn a_servo_answers_a_step_as_the_textbook_says() {
    let (natural_hz, zeta) = (40.0, 0.7_f64);
    let steps = StepsConfig {
        rates_deg_per_s: vec![0.0, 1.0],
        dwell_s: 0.1,
        settle_s: 0.0,
        ..StepsConfig::reference()
    };
    let first = usize::try_from(step_indices(&Stairs::from(&steps), 0.0, PERIOD_S)[0]).unwrap();
    assert_eq!(first, 400);
    let table = table(
        MotionConfig::Steps(steps),
        second_order(natural_hz, zeta),
        eastward(),
        0.0,
        PERIOD_S,
    );
    let truth = truth_deg_per_s(table, first, 400);
    let omega = TAU * natural_hz;
    let damped = omega * (1.0 - zeta * zeta).sqrt();
    for (index, rate) in truth.iter().enumerate() {
        let time_s = (index + 1) as f64 * PERIOD_S;
        let ringing = (damped * time_s).cos() + zeta * omega / damped * (damped * time_s).sin();
        let exact = 1.0 - (-zeta * omega * time_s).exp() * ringing;
        assert_close(*rate, exact, 0.0, 1e-12);
    }
    // Overshoot exp(-pi zeta / sqrt(1 - zeta^2)) = 4.60 %.
    let peak = truth.iter().copied().fold(0.0, f64::max);
    assert_close(peak, 1.0460, 0.0, 1e-4);
}

#[test]
fn a_table_at_rest_turns_with_the_earth() {
    let config = site(45.0, 90.0, 0.0);
    let table = table(
        MotionConfig::rest(),
        second_order(40.0, 0.7),
        config,
        1.0,
        PERIOD_S,
    );
    for rate in truth_deg_per_s(table, 0, 100) {
        assert_close(rate * 3600.0, 10.636, 0.0, 0.000_5);
    }
}
