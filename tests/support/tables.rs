//! Tables with a direct drive and an encoder, for their tests.

use std::f64::consts::TAU;

use fogbench::scenario::{
    DirectDriveServoConfig, EncoderConfig, MotionConfig, RotationConfig, ServoConfig, SiteConfig,
    StepsConfig, SwingConfig, TurntableConfig,
};
use fogbench::turntable::Turntable;

use super::turntable_cases::{no_encoder, true_axis, true_mounting};

/// Four kilohertz, commensurate with the swings, so that records hold whole cycles.
pub(crate) const PERIOD_S: f64 = 0.000_25;

pub(crate) fn swing(rate_amplitude_deg_per_s: f64, frequency_hz: f64) -> MotionConfig {
    MotionConfig::Swing(SwingConfig {
        rate_amplitude_deg_per_s: Some(rate_amplitude_deg_per_s),
        frequency_hz,
        soft_start_s: 1.0,
        ..SwingConfig::reference()
    })
}

pub(crate) fn rotation(rate_deg_per_s: f64) -> MotionConfig {
    MotionConfig::Rotation(RotationConfig {
        rate_deg_per_s,
        soft_start_s: 0.0,
        ..RotationConfig::reference()
    })
}

/// The first rate until 1 s, the end of the warm-up of [`table`], and another `dwell_s` longer.
pub(crate) fn steps(rates_deg_per_s: &[f64], dwell_s: f64) -> MotionConfig {
    MotionConfig::Steps(StepsConfig {
        rates_deg_per_s: rates_deg_per_s.to_vec(),
        dwell_s,
        settle_s: 0.0,
        ..StepsConfig::reference()
    })
}

/// 0.05 kg m^2 steered at 40 Hz, zeta 0.7 and 4 kHz; no feed-forward, no integral part, and no
/// torque but the motor's.
pub(crate) fn linear_drive() -> DirectDriveServoConfig {
    DirectDriveServoConfig {
        inertia_kg_m2: 0.05,
        natural_frequency_hz: 40.0,
        damping_ratio: 0.7,
        integral_ratio: 0.0,
        rate_feed_forward: 0.0,
        acceleration_feed_forward: 0.0,
        controller_rate_hz: 4000.0,
        derivative_filter_hz: 1000.0,
        current_loop_bandwidth_hz: 1000.0,
        torque_limit_n_m: 2.0,
        viscous_n_m_s_per_rad: 0.0,
        coulomb_n_m: 0.0,
        static_n_m: 0.0,
        stribeck_rate_rad_per_s: 1e-3,
        friction_smoothing_rad_per_s: 1e-4,
        cogging_n_m: 0.0,
        cogging_per_revolution: 24,
        ..DirectDriveServoConfig::reference()
    }
}

/// An encoder without errors.
pub(crate) fn ideal_encoder() -> EncoderConfig {
    EncoderConfig {
        resolution_arcsec: Some(0.0),
        lines_per_revolution: 36_000,
        ..no_encoder()
    }
}

/// A table without Earth rate (axis level and east), one second before its record.
pub(crate) fn table(
    motion: MotionConfig,
    servo: ServoConfig,
    encoder: EncoderConfig,
    sample_period_s: f64,
) -> Turntable {
    let config = TurntableConfig {
        motion,
        servo,
        encoder,
        site: SiteConfig {
            latitude_deg: 34.27,
            axis_elevation_deg: 0.0,
            axis_azimuth_deg: 90.0,
            ..SiteConfig::reference()
        },
        axis: true_axis(),
        mounting: true_mounting(),
        ..TurntableConfig::reference()
    };
    Turntable::new(&config, 1.0, sample_period_s)
}

/// Rate of the axis, rad/s, and angle shown, rad, at the stamps `1 ..= count`.
pub(crate) fn record(mut table: Turntable, count: usize) -> (Vec<f64>, Vec<f64>) {
    (0..count)
        .map(|_| {
            let rate = table.next_segment().rate_at(1.0);
            (rate, table.encoder_rad().expect("the table has an encoder"))
        })
        .unzip()
}

/// Cosine and sine amplitude at `cycles_per_sample` over whole cycles; the first sample is stamped
/// `first` periods after the start.
pub(crate) fn component(samples: &[f64], first: usize, cycles_per_sample: f64) -> (f64, f64) {
    let (mut cosine, mut sine) = (0.0, 0.0);
    for (index, sample) in samples.iter().enumerate() {
        let (s, c) = (TAU * (cycles_per_sample * (first + index) as f64).fract()).sin_cos();
        cosine += sample * c;
        sine += sample * s;
    }
    let scale = 2.0 / samples.len() as f64;
    (scale * cosine, scale * sine)
}
