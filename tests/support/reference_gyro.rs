//! The reference gyro, written out: 800 m of fibre on 70 mm, 0.87 uW, 2 kHz.

use fogbench::scenario::{
    AdcConfig, CoilConfig, ControllerConfig, DetectorConfig, GyroConfig, ModulationScheme,
    ModulatorConfig, NoiseConfig, NoiseDraw, RateOutputConfig, ResetSample, SlowNoiseConfig,
    SoakConfig, SourceConfig, TemperatureConfig,
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
            scheme: ModulationScheme::TwoState,
            gain_error_ppm: 0.0,
            reset_sample: ResetSample::Demodulated,
            cross_coupling_urad: 0.0,
            cross_coupling_phase_deg: 0.0,
            dither_deg: 0.0,
            dither_interval_periods: 16,
            half_period_mismatch: 0.0,
            intensity_modulation: 0.0,
        },
        detector: DetectorConfig {
            responsivity_a_per_w: 0.9,
            dark_current_na: 1.0,
            transimpedance_kohm: 20.0,
            post_gain: 10.0,
            voltage_noise_nv_per_sqrt_hz: 6.0,
            current_noise_pa_per_sqrt_hz: 0.0,
            gate_duty: 0.7,
            gate_spikes: true,
        },
        adc: AdcConfig {
            bits: 12,
            range_v: 2.0,
            samples_per_half_period: 8,
        },
        controller: ControllerConfig {
            loop_bandwidth_hz: 2000.0,
            loop_latency_periods: 1,
            second_loop_gain: 0.0,
            step_bits: 0,
            step_limit_deg: 0.0,
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
        output: RateOutputConfig {
            half_periods_per_sample: 64,
            rate_lsb_deg_per_s: 0.0,
        },
    }
}
