//! Settings of the noise sources, fast and slow.

use crate::declare::table;
use crate::vocabulary::words;

table! {
    /// Fast noise sources.
    pub struct NoiseConfig {
        /// Shot noise of the photocurrent.
        shot: bool = true;
        /// Thermal (Johnson) noise of the transimpedance.
        thermal: bool = true;
        /// Amplifier voltage and current noise.
        amplifier: bool = true;
        /// Relative intensity noise of the source.
        rin: bool = true;
        /// Technical phase noise, one-sided: whatever else jitters the demodulated phase (modulator, ramp,
        /// clock). White up to half the half-period rate, so that the gate does not alter it; phase noise
        /// that is white far beyond the gate's band counts 1 / sqrt(gate_duty) of its density. Source of the
        /// default: none.
        technical_phase_urad_per_sqrt_hz: f64 = 0.0, in 0.0..=1e6, "urad/sqrt(Hz)";
        /// One normal per half period with the variance of all sources, or every source and every sample of
        /// the converter drawn on its own.
        draw: NoiseDraw = "combined";
    }
}

words! {
    /// How fast noise is drawn in the loop model.
    pub enum NoiseDraw {
        /// One normal per half period with the variance of all sources.
        Combined = "combined",
        /// Every source and every ADC sample drawn on its own.
        Exact = "exact",
    }
}

table! {
    /// Slow noise of the rate.
    pub struct SlowNoiseConfig {
        /// Constant bias.
        bias_deg_per_h: f64 = 0.0, in -1e6..=1e6, "deg/h";
        /// Standard deviation of a bias drawn at each start, which is each repeat; 0 is none. Source of the
        /// default: none.
        turn_on_bias_deg_per_h: f64 = 0.0, in 0.0..=1e6, "deg/h";
        /// Flicker coefficient B (bias instability). Source of the default: derived: with K and 0.0060 deg/sqrt(h),
        /// 100 s means scatter by 0.0606 deg/h, against 0.0603 deg/h in the paper (25 C, after LMS).
        bias_instability_deg_per_h: f64 = 0.045, in 0.0..=1e6, "deg/h";
        /// Exponentially correlated (Gauss-Markov) rate, 1 sigma; 0 is none. Source of the default: none.
        gauss_markov_deg_per_h: f64 = 0.0, in 0.0..=1e6, "deg/h";
        /// Correlation time Tc of the Gauss-Markov rate; its Allan deviation is greatest at 1.89 Tc. Of no
        /// effect while the rate above is 0. Source of the default: assumed.
        gauss_markov_correlation_time_s: f64 = 100.0, in 1e-6..=1e7, "s";
        /// Rate random walk coefficient K. Source of the default: assumed.
        rate_random_walk_deg_per_h_per_sqrt_h: f64 = 0.005, in 0.0..=1e6, "deg/h/sqrt(h)";
        /// Rate ramp R. Source of the default: none.
        rate_ramp_deg_per_h_per_h: f64 = 0.0, in -1e6..=1e6, "deg/h/h";
    }
}
