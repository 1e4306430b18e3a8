//! Closed forms of the modulation below the transit time, against the loop as waveforms.
//!
//! Letters: `delta` = mismatch, the half period being `tau (1 + delta)`; `f` = `|delta| / (1 +
//! delta)`, the part of a half period in which both waves meet the same bias (the gap); `m` =
//! intensity modulation by the bias wave; V = visibility; `phi_e = phi_s - r`. In the gap the
//! fringe stands at `1 + V cos phi_s`, near its top.

use std::f64::consts::{FRAC_PI_3, PI};

use crate::support::assert_close;
use crate::support::waveform_gyro::{BiasWave, IntensityModulation, WaveformGyro, WaveformLoop};

/// Modulation depth, 2 pi / 3.
const DEPTH_RAD: f64 = 2.0 * FRAC_PI_3;
/// Offset of the four-state modulations from pi.
const OFFSET_RAD: f64 = FRAC_PI_3;
const VISIBILITY: f64 = 0.95;
/// Rounding of a settled loop.
const EXACT_RAD: f64 = 1e-12;

fn two_state() -> BiasWave {
    BiasWave {
        bias_rad: vec![0.5 * DEPTH_RAD, -0.5 * DEPTH_RAD],
        rate_signs: vec![-1.0, 1.0],
        gain_signs: vec![0.0, 0.0],
        states_per_transit: 1.0,
        slope: DEPTH_RAD.sin(),
    }
}

/// States of a transit time each.
fn four_state() -> BiasWave {
    BiasWave {
        bias_rad: vec![PI - OFFSET_RAD, 0.0, PI + OFFSET_RAD, 0.0],
        rate_signs: vec![-1.0, 1.0, 1.0, -1.0],
        gain_signs: vec![-1.0, -1.0, 1.0, 1.0],
        states_per_transit: 1.0,
        slope: OFFSET_RAD.sin(),
    }
}

/// States of half a transit time each.
fn fast_four_state() -> BiasWave {
    let (high, low) = (0.5 * (PI + OFFSET_RAD), 0.5 * (PI - OFFSET_RAD));
    BiasWave {
        bias_rad: vec![high, low, -high, -low],
        rate_signs: vec![1.0, -1.0, -1.0, 1.0],
        gain_signs: vec![1.0, -1.0, 1.0, -1.0],
        states_per_transit: 2.0,
        slope: OFFSET_RAD.sin(),
    }
}

fn gyro(wave: BiasWave, mismatch: f64) -> WaveformGyro {
    WaveformGyro {
        wave,
        mismatch,
        visibility: VISIBILITY,
        modulator_gain_error: 0.0,
        intensity: IntensityModulation::default(),
        is_gated: false,
    }
}

/// Register less Sagnac phase of the settled loop, rad.
fn bias_rad(gyro: WaveformGyro, sagnac_rad: f64) -> f64 {
    WaveformLoop::new(gyro).settle(sagnac_rad, 0.5, 200) - sagnac_rad
}

/// Part of the half period in the gap.
fn gap(mismatch: f64) -> f64 {
    mismatch.abs() / (1.0 + mismatch)
}

#[test]
fn two_state_demodulation_is_the_sine_of_the_phase_error() {
    for sagnac_rad in [-1.2_f64, -0.3, 1e-6, 0.02, 0.8, 1.5] {
        let error = WaveformLoop::new(gyro(two_state(), 0.0)).cycle(sagnac_rad);
        assert_close(error.rate, sagnac_rad.sin(), 1e-9, 1e-14);
        let mut gain_error = gyro(two_state(), 0.0);
        gain_error.modulator_gain_error = 0.02;
        let got = WaveformLoop::new(gain_error).cycle(sagnac_rad).rate;
        let slope = (1.02 * DEPTH_RAD).sin() / DEPTH_RAD.sin();
        assert_close(got, slope * sagnac_rad.sin(), 1e-9, 1e-14);
    }
}

#[test]
fn a_growing_phase_counts_with_its_mean_over_each_half_period() {
    // From 0 by a slope per transit time: means 1/2 and 3/2, the error is their mean. A model that
    // samples the motion at the start of each half leads by half a transit time.
    let slope_rad = 1e-5;
    let mut growing = WaveformLoop::new(gyro(two_state(), 0.0));
    growing.sagnac_slope_rad = slope_rad;
    assert_close(growing.cycle(0.0).rate, slope_rad, 1e-4, 0.0);
}

#[test]
fn an_ungated_mismatch_lowers_the_gain_by_the_gap() {
    for mismatch in [-0.2_f64, -1e-3, 1e-3, 0.2] {
        let got = |is_gated: bool| {
            let mut gyro = gyro(two_state(), mismatch);
            gyro.is_gated = is_gated;
            WaveformLoop::new(gyro).cycle(1e-4).rate / 1e-4_f64.sin()
        };
        assert_close(got(false), 1.0 - gap(mismatch), 1e-9, 0.0);
        assert_close(got(true), 1.0, 1e-9, 0.0);
    }
    // A long half period: tau / T_h. A short one loses the gap and what the gap displaces.
    assert_close(1.0 - gap(0.2), 1.0 / 1.2, 1e-15, 0.0);
    assert_close(1.0 - gap(-0.2), (2.0 * 0.8 - 1.0) / 0.8, 1e-15, 0.0);
}

#[test]
fn a_mismatch_alone_leaves_the_staircase_unbiased() {
    for mismatch in [-0.2_f64, -1e-3, 1e-3, 0.2] {
        for is_gated in [false, true] {
            for sagnac_rad in [0.0, 1e-3, -0.7, 2.0] {
                let mut gyro = gyro(two_state(), mismatch);
                gyro.is_gated = is_gated;
                assert_close(bias_rad(gyro, sagnac_rad), 0.0, 0.0, EXACT_RAD);
            }
        }
    }
}

/// Bias of an ungated loop with intensity modulation in one arm of the modulator, rad.
///
/// `-m q (1 + V cos phi_s) / (V sin phi_m)`, `q = f / (1 - f)`: delta of a long half period,
/// `|delta| / (1 - 2 |delta|)` of a short one.
fn arm_bias_rad(intensity: f64, mismatch: f64, sagnac_rad: f64) -> f64 {
    let ratio = gap(mismatch) / (1.0 - gap(mismatch));
    -intensity * ratio * (1.0 + VISIBILITY * sagnac_rad.cos()) / (VISIBILITY * DEPTH_RAD.sin())
}

#[test]
fn intensity_modulation_in_an_arm_biases_by_the_gap_alone() {
    for intensity in [1e-3, -1e-3] {
        for mismatch in [-0.05, -1e-3, 1e-3, 0.05] {
            for arms in [[intensity, 0.0], [0.4 * intensity, 0.6 * intensity]] {
                for sagnac_rad in [0.0, 0.01, -1.0] {
                    let mut gyro = gyro(two_state(), mismatch);
                    gyro.intensity.arms = arms;
                    let want = arm_bias_rad(intensity, mismatch, sagnac_rad);
                    // Left out: the gap of a short half period stands at phi_s - 2 r, twice the
                    // bias of 1e-4 rad off.
                    assert_close(bias_rad(gyro.clone(), sagnac_rad), want, 2e-4, EXACT_RAD);
                    gyro.is_gated = true;
                    assert_close(bias_rad(gyro, sagnac_rad), 0.0, 0.0, EXACT_RAD);
                }
            }
        }
    }
}

#[test]
fn intensity_bias_at_full_visibility_is_twice_the_modulation_times_the_mismatch() {
    for mismatch in [-1e-3_f64, 1e-3] {
        let mut gyro = gyro(two_state(), mismatch);
        gyro.visibility = 1.0;
        gyro.intensity.arms = [1e-3, 0.0];
        let want = -2.0 * 1e-3 * mismatch.abs() / DEPTH_RAD.sin();
        // The short half period departs from it by 2 |delta|, 0.2 %.
        assert_close(bias_rad(gyro, 0.0), want, 0.0021, 0.0);
    }
}

#[test]
fn opposite_arms_cancel_and_matched_clocks_have_no_gap() {
    for (arms, mismatch) in [
        ([1e-3, -1e-3], 1e-3),
        ([1e-3, -1e-3], -0.05),
        ([1e-3, 0.0], 0.0),
    ] {
        let mut gyro = gyro(two_state(), mismatch);
        gyro.intensity.arms = arms;
        assert_close(bias_rad(gyro, 0.0), 0.0, 0.0, EXACT_RAD);
    }
}

#[test]
fn modulation_of_the_detected_power_biases_without_any_mismatch() {
    let (intensity, slope) = (1e-5, VISIBILITY * DEPTH_RAD.sin());
    let plateau = 1.0 + VISIBILITY * DEPTH_RAD.cos();
    for mismatch in [-0.05, 0.0, 1e-3, 0.05] {
        for is_gated in [false, true] {
            let mut gyro = gyro(two_state(), mismatch);
            gyro.intensity.detected = intensity;
            gyro.is_gated = is_gated;
            let share = if is_gated { 0.0 } else { gap(mismatch) };
            let top = 1.0 + VISIBILITY;
            let want = -intensity * (plateau + top * share / (1.0 - share)) / slope;
            assert_close(bias_rad(gyro, 0.0), want, 1e-6, EXACT_RAD);
        }
    }
}

#[test]
fn four_state_demodulations_of_rate_and_gain_are_orthogonal() {
    for wave in [four_state(), fast_four_state()] {
        for sagnac_rad in [-0.4_f64, 0.0, 1e-3, 0.9] {
            for error in [-0.03, 0.0, 1e-3] {
                let mut gyro = gyro(wave.clone(), 0.0);
                gyro.modulator_gain_error = error;
                let got = WaveformLoop::new(gyro).cycle(sagnac_rad);
                let slope = ((1.0 + error) * OFFSET_RAD).sin() / OFFSET_RAD.sin();
                let (sine, cosine) = (PI * error).sin_cos();
                let want = sagnac_rad.sin() * cosine * slope;
                assert_close(got.rate, want, 1e-9, 1e-14);
                let want = sagnac_rad.cos() * sine * slope / PI;
                assert_close(got.gain, want, 1e-9, 1e-14);
            }
        }
    }
}

#[test]
fn a_short_clock_gives_ungated_states_of_a_transit_time_a_scale_error() {
    let sagnac_rad = 1e-3;
    for mismatch in [-0.01_f64, -1e-3, 1e-3, 0.01] {
        let share = gap(mismatch);
        let mut closed = WaveformLoop::new(gyro(four_state(), mismatch));
        let register = closed.settle(sagnac_rad, 0.5, 200);
        let gain = closed.cycle(sagnac_rad).gain;
        // A long clock: no modulation in the gap. A short one compares each state with the last
        // but one: (1 - f) sin(phi_e) = f cos(a) sin(phi_e - r), for small phases.
        let ratio = if mismatch > 0.0 {
            0.0
        } else {
            -share * OFFSET_RAD.cos() / (1.0 - share - share * OFFSET_RAD.cos())
        };
        assert_close(register, sagnac_rad / (1.0 + ratio), 1e-6, 0.0);
        let false_gain = if mismatch > 0.0 {
            0.0
        } else {
            share * OFFSET_RAD.cos() / PI
        };
        assert_close(gain, false_gain * sagnac_rad, 0.02, 1e-14);

        let mut gated = gyro(four_state(), mismatch);
        gated.is_gated = true;
        let mut gated = WaveformLoop::new(gated);
        assert_close(
            gated.settle(sagnac_rad, 0.5, 200),
            sagnac_rad,
            0.0,
            EXACT_RAD,
        );
        assert_close(gated.cycle(sagnac_rad).gain, 0.0, 0.0, 1e-14);
    }
}

#[test]
fn ungated_states_of_half_a_transit_time_turn_a_mismatch_into_scale_and_gain_errors() {
    for mismatch in [-0.01_f64, -1e-3, 1e-3, 0.01] {
        let sagnac_rad = 1e-3;
        let share = 2.0 * gap(mismatch);
        let mut closed = WaveformLoop::new(gyro(fast_four_state(), mismatch));
        let register = closed.settle(sagnac_rad, 0.5, 200);
        // (1 - f) sin(phi_e) = f / 2 sin(phi_e + sgn(delta) r / 2), for small phases.
        let ratio = 0.25 * share * mismatch.signum() / (1.0 - 1.5 * share);
        assert_close(register, sagnac_rad / (1.0 + ratio), 1e-6, 0.0);
        assert_close(register / sagnac_rad - 1.0, -0.5 * mismatch, 0.05, 0.0);
        let got = closed.cycle(sagnac_rad).gain;
        assert_close(got, -mismatch / (PI * (0.5 * OFFSET_RAD).tan()), 0.02, 0.0);

        let mut gated = gyro(fast_four_state(), mismatch);
        gated.is_gated = true;
        let mut gated = WaveformLoop::new(gated);
        assert_close(
            gated.settle(sagnac_rad, 0.5, 200),
            sagnac_rad,
            0.0,
            EXACT_RAD,
        );
        assert_close(gated.cycle(sagnac_rad).gain, 0.0, 0.0, 1e-14);
    }
}
