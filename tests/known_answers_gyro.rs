//! Known answers of the gyro: closed forms that the models must meet.

use fogbench::gyro::{
    Coil, LoopModel, RateModel, SlowNoise, facts, gain_limit, optimum_depth_rad,
    relative_intensity_noise_per_hz,
};
use fogbench::random::Streams;
use fogbench::scenario::{GyroConfig, NoiseDraw};
use fogbench::signal::MotionSegment;
use fogbench::units::{
    deg_per_s_to_rad_per_s, rad_per_s_to_deg_per_h, rad_per_s_to_deg_per_s, rad_to_arcsec,
};
use std::f64::consts::{PI, TAU};

use crate::plain_loop::PlainLoop;
use crate::support::assert_close;
use crate::support::reference_gyro::reference_gyro;

const SECOND_HARMONIC_FREE_AMPLITUDE_RAD: f64 = 1e-3;

fn budget_of(config: &GyroConfig, source: &str) -> f64 {
    let facts = facts(config).unwrap();
    facts
        .angle_random_walk_budget_deg_per_sqrt_h
        .iter()
        .find(|(name, _)| *name == source)
        .unwrap()
        .1
}

#[test]
fn known_answer_k1_geometry_of_the_reference_coil() {
    let config = reference_gyro();
    let coil = Coil::new(&config.coil, &config.source);
    assert_close(coil.scale_factor_s, 0.895_933_7, 1e-6, 0.0);
    assert_close(
        rad_per_s_to_deg_per_s(coil.single_fringe_rate_rad_per_s()),
        200.907_7,
        1e-6,
        0.0,
    );
    assert_close(coil.transit_time_s, 3.916_576e-6, 1e-6, 0.0);
    assert_close(
        rad_to_arcsec(coil.angle_per_reset_rad()),
        5.665_467,
        1e-6,
        0.0,
    );
    let facts = facts(&config).unwrap();
    assert_close(facts.proper_frequency_khz, 127.663, 1e-5, 0.0);
    assert_close(facts.output_rate_hz, 3989.45, 1e-5, 0.0);
}

#[test]
fn the_reference_budget_is_six_thousandths() {
    let config = reference_gyro();
    for (source, walk) in [
        ("shot", 0.00183),
        ("thermal", 0.00457),
        ("amplifier", 0.00151),
        ("rin", 0.00096),
        ("adc", 0.00294),
        ("total", 0.00600),
    ] {
        // The figures are given to 1e-5.
        assert_close(budget_of(&config, source), walk, 0.0, 1e-5);
    }
}
