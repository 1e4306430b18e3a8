//! The direct-drive servo against its transfer function, closed-form motions and balances.

use std::f64::consts::{FRAC_PI_4, TAU};

use fogbench::scenario::{DirectDriveServoConfig, EncoderConfig, MotionConfig, ServoConfig};
use fogbench::units::{deg_per_s_to_rad_per_s, rad_to_arcsec, rad_to_deg};
use nalgebra::Complex;

use crate::support::assert_close;
use crate::support::tables::{
    PERIOD_S, component, ideal_encoder, linear_drive, record, rotation, steps, swing, table,
};

/// Rate and angle of the axis under a drive that reads the angle itself.
fn run(motion: MotionConfig, drive: &DirectDriveServoConfig, count: usize) -> (Vec<f64>, Vec<f64>) {
    run_with(motion, drive, ideal_encoder(), count)
}

fn run_with(
    motion: MotionConfig,
    drive: &DirectDriveServoConfig,
    encoder: EncoderConfig,
    count: usize,
) -> (Vec<f64>, Vec<f64>) {
    let servo = ServoConfig::DirectDrive(drive.clone());
    record(table(motion, servo, encoder, PERIOD_S), count)
}

/// Friction, cogging and integral part of the reference, fed forward.
fn default_drive() -> DirectDriveServoConfig {
    DirectDriveServoConfig {
        integral_ratio: 0.1,
        rate_feed_forward: 1.0,
        acceleration_feed_forward: 1.0,
        viscous_n_m_s_per_rad: 0.01,
        coulomb_n_m: 0.05,
        static_n_m: 0.07,
        cogging_n_m: 0.01,
        ..linear_drive()
    }
}

/// From commanded to actual angle: the plant `1 / (J s^2 + b s)` behind current loop and hold, the
/// controller in `z = exp(s T)`. Images of the controller's clock are left out: `(f / f_c)^2` of the
/// rate and less, one order by the hold and one by the inertia.
fn transfer(drive: &DirectDriveServoConfig, latency_s: f64, frequency_hz: f64) -> Complex<f64> {
    let one = Complex::new(1.0, 0.0);
    let s = Complex::new(0.0, TAU * frequency_hz);
    let tick_s = 1.0 / drive.controller_rate_hz;
    let delay = (-s * tick_s).exp();
    let hold = (one - delay) / (s * tick_s);
    let current = one / (one + s / (TAU * drive.current_loop_bandwidth_hz));
    let axis = one / (s * s * drive.inertia_kg_m2 + s * drive.viscous_n_m_s_per_rad);
    let natural = TAU * drive.natural_frequency_hz;
    let proportional = drive.inertia_kg_m2 * natural * natural;
    let derivative = 2.0 * drive.damping_ratio * natural * drive.inertia_kg_m2;
    let share = 1.0 - (-TAU * drive.derivative_filter_hz * tick_s).exp();
    let rate = (one - delay) / tick_s * share / (one - delay * (1.0 - share));
    let integral = drive.integral_ratio * proportional * natural * tick_s / (one - delay);
    let forward = s * drive.rate_feed_forward * derivative
        + s * s * drive.acceleration_feed_forward * drive.inertia_kg_m2;
    let plant = axis * current * hold;
    let shown = (-s * latency_s).exp();
    plant * (integral + proportional + forward)
        / (one + plant * shown * (integral + proportional + rate * derivative))
}

/// Rate over commanded rate of a swing of 1 deg/s, from 4 s on.
fn measured_response(
    drive: &DirectDriveServoConfig,
    encoder: EncoderConfig,
    frequency_hz: f64,
) -> Complex<f64> {
    let (rates, _) = run_with(swing(1.0, frequency_hz), drive, encoder, 20_000);
    let (cosine, sine) = component(&rates[16_000..], 16_001, frequency_hz * PERIOD_S);
    Complex::new(sine, cosine) / deg_per_s_to_rad_per_s(1.0)
}

#[test]
fn known_answer_k29_a_frictionless_drive_follows_by_the_second_order_transfer_function() {
    // A fast controller: hold, difference, low pass and current loop delay by 21 us in all, which
    // takes 2 zeta wn 21 us = 0.7 % off the effective inertia and 0.3 % off the damping.
    let fast = DirectDriveServoConfig {
        controller_rate_hz: 100_000.0,
        derivative_filter_hz: 50_000.0,
        current_loop_bandwidth_hz: 20_000.0,
        ..linear_drive()
    };
    let response = measured_response(&fast, ideal_encoder(), 10.0);
    assert_close(response.norm(), 0.999_30, 1e-3, 0.0);
    assert_close(rad_to_deg(response.arg()), -20.472, 0.005, 0.0);
}

#[test]
fn a_frictionless_drive_follows_by_the_transfer_function_of_its_sampled_loop() {
    let late = EncoderConfig {
        latency_us: 200.0,
        ..ideal_encoder()
    };
    let fed_forward = DirectDriveServoConfig {
        rate_feed_forward: 1.0,
        acceleration_feed_forward: 1.0,
        ..linear_drive()
    };
    let with_integral = DirectDriveServoConfig {
        integral_ratio: 0.3,
        viscous_n_m_s_per_rad: 2.0,
        ..linear_drive()
    };
    let odd_clock = DirectDriveServoConfig {
        controller_rate_hz: 3777.0,
        ..with_integral.clone()
    };
    for (drive, encoder, frequency_hz) in [
        (linear_drive(), ideal_encoder(), 10.0),
        (linear_drive(), ideal_encoder(), 50.0),
        (linear_drive(), late, 10.0),
        (fed_forward, ideal_encoder(), 25.0),
        (with_integral, ideal_encoder(), 10.0),
        (odd_clock, ideal_encoder(), 10.0),
    ] {
        let expected = transfer(&drive, encoder.latency_us * 1e-6, frequency_hz);
        let response = measured_response(&drive, encoder, frequency_hz);
        let images = (frequency_hz / drive.controller_rate_hz).powi(2);
        let error = (response - expected).norm();
        assert!(
            error < images,
            "{frequency_hz} Hz: {response} {expected} {error:e}"
        );
    }
}

#[test]
fn feed_forward_removes_the_lag() {
    let fed_forward = DirectDriveServoConfig {
        rate_feed_forward: 1.0,
        acceleration_feed_forward: 1.0,
        ..linear_drive()
    };
    let lag = |drive: &DirectDriveServoConfig| {
        rad_to_deg(-measured_response(drive, ideal_encoder(), 10.0).arg())
    };
    // Without: 20.5 deg, delays of the loop apart. With: those delays alone, which enter the error
    // as Kd s and J s^2 times some 0.4 ms over Kp: below a tenth.
    assert!(lag(&linear_drive()) > 18.0);
    assert!(lag(&fed_forward).abs() < 2.0, "{}", lag(&fed_forward));
}

#[test]
fn friction_adds_odd_harmonics_of_a_square_wave() {
    // A tenth of the torque that turns the swing about, so that the axis does not stick: friction
    // is a square wave, whose harmonic k of 4 Tc / (pi k) the servo's stiffness resists.
    let drive = DirectDriveServoConfig {
        coulomb_n_m: 0.005,
        static_n_m: 0.005,
        rate_feed_forward: 1.0,
        acceleration_feed_forward: 1.0,
        controller_rate_hz: 20_000.0,
        derivative_filter_hz: 10_000.0,
        current_loop_bandwidth_hz: 10_000.0,
        ..linear_drive()
    };
    let (rates, _) = run(swing(1.0, 10.0), &drive, 12_000);
    let amplitude = |order: f64| {
        let (cosine, sine) = component(&rates[8000..], 8001, order * 10.0 * PERIOD_S);
        cosine.hypot(sine)
    };
    let natural = TAU * 40.0;
    for order in [3.0, 5.0] {
        let w = order * TAU * 10.0;
        let (real, imaginary) = (natural * natural - w * w, 2.0 * 0.7 * natural * w);
        let friction = 0.005 / (FRAC_PI_4 * order);
        let expected = w * friction / (0.05 * real.hypot(imaginary));
        // Delays of 50 us turn the loop at 50 Hz by 1 deg: some 3 % of the stiffness.
        assert_close(amplitude(order), expected, 0.04, 0.0);
    }
    for order in [2.0, 4.0] {
        assert!(amplitude(order) < 1e-3 * amplitude(3.0), "{order}");
    }
}

#[test]
fn friction_of_the_default_table_disturbs_a_swing_by_its_torque_over_the_stiffness() {
    // Tc / (J wn^2) = 3.3 arcsec of the 57 arcsec that 1 deg/s at 10 Hz swings.
    let expected = rad_to_arcsec(0.05 / (0.05 * (TAU * 40.0).powi(2)));
    assert_close(expected, 3.27, 0.0, 0.005);
    let rough = DirectDriveServoConfig {
        integral_ratio: 0.0,
        static_n_m: 0.05,
        cogging_n_m: 0.0,
        viscous_n_m_s_per_rad: 0.0,
        ..default_drive()
    };
    let smooth = DirectDriveServoConfig {
        coulomb_n_m: 0.0,
        static_n_m: 0.0,
        ..rough.clone()
    };
    let (_, disturbed) = run(swing(1.0, 10.0), &rough, 12_000);
    let (_, undisturbed) = run(swing(1.0, 10.0), &smooth, 12_000);
    let peak = disturbed[8000..]
        .iter()
        .zip(&undisturbed[8000..])
        .fold(0.0_f64, |peak, (a, b)| peak.max(rad_to_arcsec(a - b).abs()));
    // A square wave of 10 Hz on a loop of 40 Hz and zeta 0.7: the response to each reversal of
    // 2 Tc overshoots by 4.6 % of it, 9 % of Tc, and has half a cycle to settle.
    assert_close(peak, expected, 0.2, 0.0);
}

#[test]
fn an_axis_at_rest_sticks_and_hunts_within_the_static_friction_over_the_stiffness() {
    let encoder = EncoderConfig {
        resolution_arcsec: Some(0.36),
        ..ideal_encoder()
    };
    let motion = steps(&[1.0, 0.0], 1.0);
    let (rates, angles) = run_with(motion, &default_drive(), encoder, 40_000);
    let stiffness = 0.05 * (TAU * 40.0_f64).powi(2);
    let tail = &angles[16_000..];
    let (low, high) = tail
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &angle| {
            (low.min(angle), high.max(angle))
        });
    let bound = 2.0 * rad_to_arcsec(0.07 / stiffness) + 0.36;
    assert!(
        rad_to_arcsec(high - low) <= bound,
        "{}",
        rad_to_arcsec(high - low)
    );
    // It creeps below the smoothing rate nearly all the time.
    let sticking = rates[16_000..]
        .iter()
        .filter(|rate| rate.abs() < 1e-4)
        .count();
    assert!(
        sticking > 9 * tail.len() / 10,
        "{sticking} of {}",
        tail.len()
    );
}

#[test]
fn cogging_ripples_the_rate_at_its_count_per_turn() {
    let drive = DirectDriveServoConfig {
        cogging_n_m: 0.02,
        controller_rate_hz: 20_000.0,
        derivative_filter_hz: 10_000.0,
        current_loop_bandwidth_hz: 10_000.0,
        rate_feed_forward: 1.0,
        ..linear_drive()
    };
    // A quarter turn a second: one turn is 4 s or 16 000 samples.
    let (rates, _) = run(rotation(90.0), &drive, 20_000);
    let amplitude = |order: f64| {
        let (cosine, sine) = component(&rates[4000..], 4001, order / 16_000.0);
        cosine.hypot(sine)
    };
    let w = 24.0 * TAU / 4.0;
    let natural = TAU * 40.0;
    let resisted = (natural * natural - w * w).hypot(2.0 * 0.7 * natural * w);
    // The cogs pass unevenly by 24 times the disturbed angle, 24 x 0.02 / 3158 = 1.5e-4 rad; the
    // delays of the loop of 50 us enter as w 50 us = 0.2 %.
    assert_close(amplitude(24.0), w * 0.02 / (0.05 * resisted), 0.003, 0.0);
    assert!(amplitude(23.0) < 1e-3 * amplitude(24.0));
    assert!(amplitude(25.0) < 1e-3 * amplitude(24.0));
}

#[test]
fn the_torque_limit_limits_the_acceleration() {
    let drive = DirectDriveServoConfig {
        torque_limit_n_m: 0.5,
        integral_ratio: 0.1,
        rate_feed_forward: 1.0,
        ..linear_drive()
    };
    let (rates, _) = run(steps(&[0.0, 10.0], 0.5), &drive, 12_000);
    let accelerations = rates.windows(2).map(|pair| (pair[1] - pair[0]) / PERIOD_S);
    let peak = accelerations.fold(0.0_f64, |peak, value| peak.max(value.abs()));
    // 0.5 / 0.05 = 10 rad/s^2: reached, and never passed.
    assert!(peak <= 10.0 * (1.0 + 1e-9), "{peak}");
    assert_close(peak, 10.0, 1e-3, 0.0);
    // It settles for all that: 10 deg/s take 17 ms at full torque, and as long again to make up
    // the angle.
    assert_close(rates[11_999], deg_per_s_to_rad_per_s(10.0), 1e-4, 0.0);
}

/// A drive without a motor worth the name, so that the axis coasts.
fn coasting() -> DirectDriveServoConfig {
    DirectDriveServoConfig {
        torque_limit_n_m: 1e-12,
        ..linear_drive()
    }
}

#[test]
fn a_coasting_axis_loses_its_energy_as_friction_takes_it() {
    // The motor's own torque, which has held the friction, decays in 1 / (2 pi 1 kHz).
    let start = deg_per_s_to_rad_per_s(10.0);
    let drain_s = 1.0 / (TAU * 1000.0);
    let coulomb = DirectDriveServoConfig {
        coulomb_n_m: 0.005,
        static_n_m: 0.005,
        ..coasting()
    };
    let (rates, _) = run(steps(&[10.0], 1.0), &coulomb, 12_000);
    for index in [400, 2000, 4000] {
        let elapsed_s = index as f64 * PERIOD_S - drain_s;
        assert_close(rates[index - 1], start - 0.1 * elapsed_s, 1e-6, 0.0);
    }
    // 0.1745 rad/s at 0.1 rad/s^2 stop after 1.75 s, and do not turn back.
    assert!(rates[8000].abs() < 1e-9, "{}", rates[8000]);
    let falls = rates
        .windows(2)
        .all(|pair| pair[1] <= pair[0] && pair[1] > -1e-9);
    assert!(falls, "energy was gained");
    let viscous = DirectDriveServoConfig {
        viscous_n_m_s_per_rad: 0.05,
        ..coasting()
    };
    let (rates, _) = run(steps(&[10.0], 1.0), &viscous, 4000);
    // Rate constant b / J = 1 / s with the decaying torque as a forcing: wi / (wi - 1) e^-t.
    let forced = 1.0 / (1.0 - drain_s);
    assert_close(rates[3999], start * forced * (-1.0_f64).exp(), 1e-6, 0.0);
}

#[test]
fn cogging_alone_conserves_energy() {
    let drive = DirectDriveServoConfig {
        cogging_n_m: 0.02,
        ..coasting()
    };
    let (rates, angles) = run(steps(&[5.0], 1.0), &drive, 20_000);
    let energy =
        |rate: f64, angle: f64| 0.5 * 0.05 * rate * rate - 0.02 / 24.0 * (24.0 * angle).cos();
    let start = energy(deg_per_s_to_rad_per_s(5.0), 0.0);
    let swing = rates.iter().fold(0.0_f64, |max, rate| max.max(rate.abs()))
        - rates
            .iter()
            .fold(f64::INFINITY, |min, rate| min.min(rate.abs()));
    assert!(swing > 0.01, "the cogs matter: {swing}");
    for (rate, angle) in rates.iter().zip(&angles) {
        assert_close(energy(*rate, *angle), start, 1e-6, 0.0);
    }
}

#[test]
fn the_axis_does_not_depend_on_the_clock_it_is_looked_at_with() {
    // A gyro four times as fast sees the same axis at the common stamps: the integration errs by
    // 3e-5 of what happens within a time constant of friction at a reversal, 0.07 N m / J x 71 us.
    let reversal = 0.07 / 0.05 * 71e-6;
    let servo = ServoConfig::DirectDrive(DirectDriveServoConfig {
        integral_ratio: 0.0,
        ..default_drive()
    });
    let encoder = ideal_encoder;
    let coarse = table(swing(1.0, 10.0), servo.clone(), encoder(), PERIOD_S);
    let fine = table(swing(1.0, 10.0), servo, encoder(), PERIOD_S / 4.0);
    let (coarse, coarse_angles) = record(coarse, 8000);
    let (fine, fine_angles) = record(fine, 32_000);
    for (index, rate) in coarse.iter().enumerate() {
        assert_close(*rate, fine[4 * index + 3], 0.0, 1e-3 * reversal);
    }
    // Cubics between coarse stamps turn the same angle, within a hundredth of an arcsecond.
    for (index, angle) in coarse_angles.iter().enumerate() {
        let difference = rad_to_arcsec(angle - fine_angles[4 * index + 3]);
        assert!(difference.abs() < 0.01, "{index}: {difference}");
    }
}

#[test]
fn the_motion_handed_on_does_not_drift_from_the_axis_the_controller_holds() {
    let (_, angles) = run(swing(1.0, 10.0), &default_drive(), 84_000);
    let mean = |from: usize| rad_to_arcsec(angles[from..from + 400].iter().sum::<f64>() / 400.0);
    // The integral part, Ki = 0.1 Kp wn, has settled after some 1 / (0.1 wn) = 40 ms.
    assert_close(mean(80_000), mean(8000), 0.0, 0.01);
}

#[test]
fn equal_drives_move_equally_to_the_last_bit() {
    let run = || run(swing(1.0, 10.0), &default_drive(), 8000);
    let bits = |values: &[f64]| {
        values
            .iter()
            .map(|value| value.to_bits())
            .collect::<Vec<_>>()
    };
    let ((first, first_angles), (again, again_angles)) = (run(), run());
    assert_eq!(bits(&first), bits(&again));
    assert_eq!(bits(&first_angles), bits(&again_angles));
}
