//! The closed loop as one would write it down: the yardstick of the fast one.
//!
//! Written from the equations, in volts and radians, independently of the library: library cosine
//! and rounding, no approximation, no reordering. Same quantisers, same generator, same draws.

use fogbench::random::{Stream, Streams};
use fogbench::scenario::{GyroConfig, TemperatureConfig};
use std::f64::consts::{LN_2, PI, TAU};

const C: f64 = 299_792_458.0;
const E: f64 = 1.602_176_634e-19;
const K: f64 = 1.380_649e-23;

pub(crate) struct PlainLoop {
    depth: f64,
    visibility: f64,
    mean_v: f64,
    dark_v: f64,
    noise_v: f64,
    adc_step_v: f64,
    adc_max_v: f64,
    dac_step: f64,
    gain_per_v: f64,
    scale_factor_s: f64,
    ramp: f64,
    output: f64,
    register: f64,
    delayed: [f64; 3],
    latency: usize,
    half_periods: u32,
    stream: Stream,
}

impl PlainLoop {
    pub(crate) fn new(config: &GyroConfig, loop_gain: f64, streams: &Streams) -> Self {
        let lambda = config.source.wavelength_nm * 1e-9;
        let tau = config.coil.group_index * config.coil.length_m / C;
        let depth = config.modulator.depth_deg.to_radians();
        let mean_a = config.detector.responsivity_a_per_w * config.source.power_uw * 1e-6;
        let dark_a = config.detector.dark_current_na * 1e-9;
        let feedback = config.detector.transimpedance_kohm * 1e3;
        let gain = feedback * config.detector.post_gain;
        let bias_a = mean_a * (1.0 + config.source.visibility * depth.cos());
        let linewidth = C * config.source.linewidth_nm * 1e-9 / lambda.powi(2);
        let rin = (1.0 + config.source.polarisation_degree.powi(2)) * (2.0 * LN_2 / PI).sqrt()
            / linewidth;
        let TemperatureConfig::Soak(soak) = &config.temperature else {
            panic!("the plain loop has one temperature");
        };
        let density = 2.0 * E * (bias_a + dark_a)
            + 4.0 * K * (soak.temperature_c + 273.15) / feedback
            + (config.detector.voltage_noise_nv_per_sqrt_hz * 1e-9 / feedback).powi(2)
            + (config.detector.current_noise_pa_per_sqrt_hz * 1e-12).powi(2)
            + rin * bias_a.powi(2);
        let samples = f64::from(config.adc.samples_per_half_period);
        let codes = 2.0_f64.powi(config.adc.bits.cast_signed());
        let slope = mean_a * config.source.visibility * depth.sin();
        Self {
            depth,
            visibility: config.source.visibility,
            mean_v: gain * mean_a,
            dark_v: gain * dark_a,
            noise_v: gain * (density / (2.0 * config.detector.gate_duty * tau)).sqrt(),
            adc_step_v: config.adc.range_v / codes / samples.sqrt(),
            adc_max_v: config.adc.range_v * (codes - 1.0) / codes,
            dac_step: TAU / 2.0_f64.powi(config.modulator.dac_bits.cast_signed()),
            gain_per_v: loop_gain / (2.0 * gain * slope),
            scale_factor_s: TAU * config.coil.length_m * config.coil.diameter_mm * 1e-3
                / (lambda * C),
            ramp: 0.0,
            output: 0.0,
            register: 0.0,
            delayed: [0.0; 3],
            latency: config.controller.loop_latency_periods as usize,
            half_periods: config.output.half_periods_per_sample,
            stream: streams.stream("combined"),
        }
    }

    /// Rate word over an output sample with a rate polynomial in normalised time, rad/s.
    pub(crate) fn next_word_rad_per_s(&mut self, rate: &[f64; 4]) -> f64 {
        let to_code = 1.0 / self.dac_step;
        let to_step = 1.0 / self.adc_step_v;
        let mut sum = 0.0;
        for period in 0..self.half_periods / 2 {
            let mut error = 0.0;
            for half in 0..2 {
                let sign = if half == 0 { 1.0 } else { -1.0 };
                let time = f64::from(2 * period + half) / f64::from(self.half_periods);
                let omega = rate[0] + time * (rate[1] + time * (rate[2] + time * rate[3]));
                self.ramp += self.register;
                if self.ramp >= TAU {
                    self.ramp -= TAU;
                } else if self.ramp < 0.0 {
                    self.ramp += TAU;
                }
                let output = (self.ramp * to_code).round() * self.dac_step;
                let phase =
                    self.scale_factor_s * omega - (output - self.output) + sign * self.depth;
                self.output = output;
                let volts = self.mean_v * (1.0 + self.visibility * phase.cos())
                    + self.dark_v
                    + self.noise_v * self.stream.normal();
                let sampled =
                    (volts.clamp(0.0, self.adc_max_v) * to_step).round() * self.adc_step_v;
                error -= sign * sampled;
            }
            let due = if self.latency == 0 {
                error
            } else {
                let due = self.delayed[self.latency - 1];
                for slot in (1..self.latency).rev() {
                    self.delayed[slot] = self.delayed[slot - 1];
                }
                self.delayed[0] = error;
                due
            };
            self.register += self.gain_per_v * due;
            sum += self.register;
        }
        sum / f64::from(self.half_periods / 2) / self.scale_factor_s
    }
}
