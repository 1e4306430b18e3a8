//! The reference gyro, written out: 800 m of fibre on 70 mm, 0.87 uW, 2 kHz.

use fogbench::scenario::{
    AdcConfig, CoilConfig, ControllerConfig, DetectorConfig, GyroConfig, ModulatorConfig,
    NoiseConfig, NoiseDraw, RateOutputConfig, SlowNoiseConfig, SoakConfig, SourceConfig,
    StaticConfig, TemperatureConfig, VibrationConfig, VibrationMotion,
};

/// All fast noise on, drawn combined; no slow noise; rate word not rounded.
pub(crate) fn reference_gyro() -> GyroConfig {
    GyroConfig {
        coil: CoilConfig {
            length_m: 800.0,
            diameter_mm: 70.0,
            group_index: 1.4677,
        },
        source: SourceConfig {
            wavelength_nm: 1310.0,
            power_uw: 0.87,
            linewidth_nm: 35.0,
            polarisation_degree: 1.0,
            visibility: 0.95,
        },
        modulator: ModulatorConfig {
            depth_deg: 120.0,
            dac_bits: 16,
        },
        detector: DetectorConfig {
            responsivity_a_per_w: 0.9,
            dark_current_na: 1.0,
            transimpedance_kohm: 20.0,
            post_gain: 10.0,
            voltage_noise_nv_per_sqrt_hz: 6.0,
            current_noise_pa_per_sqrt_hz: 0.0,
            gate_duty: 0.7,
        },
        adc: AdcConfig {
            bits: 12,
            range_v: 2.0,
            samples_per_half_period: 8,
        },
        controller: ControllerConfig {
            loop_bandwidth_hz: 2000.0,
            loop_latency_periods: 1,
        },
        noise: NoiseConfig {
            shot: true,
            thermal: true,
            amplifier: true,
            rin: true,
            draw: NoiseDraw::Combined,
        },
        slow_noise: SlowNoiseConfig {
            bias_deg_per_h: 0.0,
            bias_instability_deg_per_h: 0.0,
            rate_random_walk_deg_per_h_per_sqrt_h: 0.0,
            rate_ramp_deg_per_h_per_h: 0.0,
        },
        temperature: TemperatureConfig::Soak(SoakConfig {
            temperature_c: 25.0,
        }),
        vibration: VibrationConfig {
            intensity_per_g: 1e-3,
            rate_error_deg_per_h_per_g: 0.0,
            motion: VibrationMotion::Off(StaticConfig {}),
        },
        output: RateOutputConfig {
            half_periods_per_sample: 64,
            rate_lsb_deg_per_s: 0.0,
        },
    }
}
