//! The reference gyro, written out: 800 m of fibre on 70 mm, 0.87 uW, 2 kHz.

use fogbench::scenario::{
    AdcConfig, CoilConfig, ControllerConfig, DetectorConfig, GyroConfig, ModulatorConfig,
    NoiseConfig, NoiseDraw, PowerConfig, QuadraticPowerConfig, RateOutputConfig, SlowNoiseConfig,
    SoakConfig, SourceConfig, TemperatureConfig, ThermalConfig, ThermalWarmUp, Winding,
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
            automatic_gain_control: false,
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
        thermal: reference_thermal(),
        output: RateOutputConfig {
            half_periods_per_sample: 64,
            rate_lsb_deg_per_s: 0.0,
        },
    }
}

/// A 40-layer quadrupole; everything temperature does at its default.
fn reference_thermal() -> ThermalConfig {
    ThermalConfig {
        reference_c: 25.0,
        ripple_amplitude_c: 0.0,
        ripple_period_s: 480.0,
        self_heating_c: 0.0,
        warm_up: ThermalWarmUp::Settled,
        case_time_constant_s: 600.0,
        outer_time_constant_s: 300.0,
        inner_time_constant_s: 100.0,
        winding: Winding::Quadrupole,
        layers: 40,
        midpoint_offset_m: 0.0,
        index_per_k: 1.0e-5,
        length_ppm_per_k: 0.55,
        diameter_ppm_per_k: 10.0,
        wavelength_nm_per_k: 0.4,
        wavelength_feed_through: 0.01,
        compensation_ppm_per_k: 0.0,
        compensation_ppm_per_k2: 0.0,
        bias_deg_per_h_per_k: 5e-4,
        bias_deg_per_h_per_k2: 3e-6,
        bias_deg_per_h_per_c_per_min: 0.02,
        half_wave_voltage_ppm_per_k: 0.0,
        power: PowerConfig::Quadratic(QuadraticPowerConfig {
            cold_c: -40.0,
            cold_ratio: 0.853,
            hot_c: 60.0,
            hot_ratio: 0.967,
        }),
    }
}
