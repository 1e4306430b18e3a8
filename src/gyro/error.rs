//! What can be wrong with a gyro's configuration.

use thiserror::Error;

/// A gyro that cannot be built.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum GyroError {
    /// The asked bandwidth reaches half the loop rate.
    #[error(
        "loop bandwidth {bandwidth_hz} Hz is not below half the loop rate, {half_loop_rate_hz:.0} Hz: \
         lower gyro.controller.loop_bandwidth_hz"
    )]
    BandwidthAboveNyquist {
        /// Bandwidth asked for, Hz.
        bandwidth_hz: f64,
        /// Half of the loop rate, `1 / 4 tau`, Hz.
        half_loop_rate_hz: f64,
    },
    /// The gain that would give the bandwidth makes the loop oscillate.
    #[error(
        "loop bandwidth {bandwidth_hz} Hz needs a loop gain of {gain:.4}, but the loop is stable only below \
         {gain_limit:.4} at a latency of {latency_periods} periods: lower gyro.controller.loop_bandwidth_hz"
    )]
    UnstableLoop {
        /// Bandwidth asked for, Hz.
        bandwidth_hz: f64,
        /// Gain it needs.
        gain: f64,
        /// Gain at which the loop starts to oscillate.
        gain_limit: f64,
        /// Latency in loop periods.
        latency_periods: u32,
    },
    /// Latency beyond what the model holds.
    #[error("loop latency of {latency_periods} periods is out of range: expected 0 to 3")]
    LatencyOutOfRange {
        /// Latency in loop periods.
        latency_periods: u32,
    },
    /// The modulation depth leaves no slope.
    #[error(
        "modulation depth {depth_deg} deg leaves no slope: expected more than 0 and less than 180 deg, \
         and light of non-zero power and visibility"
    )]
    NoSlope {
        /// Modulation depth, deg.
        depth_deg: f64,
    },
    /// The bias point lies beyond the converter's range.
    #[error(
        "the bias point of {bias_v:.4} V lies outside the converter's range of {range_v} V: \
         lower gyro.detector.post_gain or gyro.source.power_uw"
    )]
    ConverterRange {
        /// Voltage at the bias point, V.
        bias_v: f64,
        /// Range of the converter, V.
        range_v: f64,
    },
    /// The power law leaves no light at a temperature of the run.
    #[error(
        "the detected power is {power_ratio:.3} of nominal at {temperature_c:.1} C: the law \
         gyro.thermal.power does not reach this far"
    )]
    NoPower {
        /// Power over its nominal value.
        power_ratio: f64,
        /// Temperature of the case, deg C.
        temperature_c: f64,
    },
    /// A linear law of the temperature is asked for more than a small change.
    #[error(
        "{what} becomes {ratio:.3} of nominal at {temperature_c:.1} C: the law is one of small changes, \
         within {limit} of 1"
    )]
    ThermalLawTooSteep {
        /// Key of the coefficient.
        key: &'static str,
        /// What changes.
        what: &'static str,
        /// Its value over its nominal one.
        ratio: f64,
        /// Largest departure of that ratio from 1.
        limit: f64,
        /// Temperature, deg C.
        temperature_c: f64,
    },
    /// Less turns the Sagnac phase than a number can well hold.
    #[error(
        "the scale factor of {scale_factor_s:.3e} s is that of no coil: expected at least {least_s:.0e} s, \
         2 pi L D / (lambda c)"
    )]
    NoScaleFactor {
        /// Sagnac phase per rate, s.
        scale_factor_s: f64,
        /// Least scale factor, s.
        least_s: f64,
    },
    /// White noise as great as the range.
    #[error(
        "white noise of {noise_deg_per_s:.3e} deg/s rms in a rate word, as much as the single-fringe range of \
         +-{limit_deg_per_s:.3e} deg/s: this gyro shows nothing else; \
         lower the noise of gyro.noise: raise gyro.source.power_uw, or lower its angle random walk where that \
         is given"
    )]
    NoiseBeyondFringe {
        /// Standard deviation of a word, deg/s.
        noise_deg_per_s: f64,
        /// Rate of a Sagnac phase of pi, deg/s.
        limit_deg_per_s: f64,
    },
    /// More light at some temperature makes the loop oscillate.
    #[error(
        "the detected power reaches {power_ratio:.3} of nominal and the loop gain {gain:.4} with it, but \
         the loop is stable only below {gain_limit:.4}: lower gyro.controller.loop_bandwidth_hz or set \
         gyro.controller.automatic_gain_control = true"
    )]
    UnstableAtPower {
        /// Largest power over its nominal value.
        power_ratio: f64,
        /// Gain with it.
        gain: f64,
        /// Gain at which the loop starts to oscillate.
        gain_limit: f64,
    },
    /// The output sample is not a whole number of loop periods.
    #[error("{half_periods} half periods per output sample: expected an even number of at least 2")]
    OddOutputSample {
        /// Half periods per sample asked for.
        half_periods: u32,
    },
    /// The output sample breaks a loop period of the four-state bias wave.
    #[error(
        "{half_periods} half periods per output sample: one loop period of this gyro.modulator.scheme takes \
         {per_period}: expected a multiple of it"
    )]
    BrokenLoopPeriod {
        /// Half periods per sample asked for.
        half_periods: u32,
        /// Half periods of one loop period.
        per_period: u32,
    },
    /// The rate model is asked for an effect that it leaves out.
    #[error("fidelity = \"rate\" does not hold: {reason}; use fidelity = \"loop\"")]
    RateModelLacks {
        /// Key of the effect.
        key: &'static str,
        /// Why it does not hold.
        reason: String,
    },
    /// The rate model is asked for rates beyond its fringe.
    #[error(
        "up to {rate_deg_per_s:.3} deg/s on the input axis, but fidelity = \"rate\" holds within \
         +-{limit_deg_per_s:.3} deg/s: beyond a Sagnac phase of pi the fringe onto which the loop locks \
         depends on its history; use fidelity = \"loop\""
    )]
    RateBeyondFringe {
        /// Largest rate, bias included, deg/s.
        rate_deg_per_s: f64,
        /// Rate of a Sagnac phase of pi, deg/s.
        limit_deg_per_s: f64,
    },
    /// The rate model is asked for a motion under which the loop loses its slope.
    #[error(
        "the motion drives the phase error to {phase_error_rad:.3} rad, but fidelity = \"rate\" is linear: \
         beyond pi/2 the loop pulls the less the further it is off, beyond pi it locks onto another \
         fringe; use fidelity = \"loop\", a smaller step or a slower motion"
    )]
    PhaseErrorBeyondSlope {
        /// Largest phase error, rad.
        phase_error_rad: f64,
    },
    /// The rate model is asked for a converter whose rounding is not white noise.
    #[error(
        "{noise_lsb:.3} LSB of noise per sample at the converter, but fidelity = \"rate\" counts rounding \
         as white noise, which takes {limit_lsb:.3} LSB: the slope of this converter lies between \
         {}; use fidelity = \"loop\" with \
         gyro.noise.draw = \"exact\", more bits, or bits = 0",
        slopes_text(*slope_min, *slope_max)
    )]
    ConverterTooCoarse {
        /// Noise of one sample, converter steps.
        noise_lsb: f64,
        /// Least noise at which rounding counts as white, converter steps.
        limit_lsb: f64,
        /// Slope of the mean level at a code, nominal 1.
        slope_min: f64,
        /// Slope of the mean level between two codes, nominal 1.
        slope_max: f64,
    },
    /// A data sheet's angle random walk that rounding alone nearly reaches.
    #[error(
        "rounding alone makes an angle random walk of {:.3e} deg/sqrt(h) ({converter_deg_per_sqrt_h:.3e} in the \
         converter, {words_deg_per_sqrt_h:.3e} of the rate words), too much of the {walk_deg_per_sqrt_h} deg/sqrt(h) \
         asked for to be white noise: {}, or ask for {:.3e} or more",
        converter_deg_per_sqrt_h.hypot(*words_deg_per_sqrt_h),
        remedy(*converter_deg_per_sqrt_h, *words_deg_per_sqrt_h),
        least_deg_per_sqrt_h
    )]
    RoundingBeyondWalk {
        /// Least walk of which such rounding is a small enough part, deg/sqrt(h).
        least_deg_per_sqrt_h: f64,
        /// Walk asked for, deg/sqrt(h).
        walk_deg_per_sqrt_h: f64,
        /// Walk of the rounding in the converter, deg/sqrt(h).
        converter_deg_per_sqrt_h: f64,
        /// Walk of the rounding of the words, deg/sqrt(h).
        words_deg_per_sqrt_h: f64,
    },
    /// The rate model is asked for a ramp converter whose rounding it leaves out.
    #[error(
        "the ramp converter steps by {step_rad:.3e} rad, up to {rounding_deg_per_h:.3} deg/h rms per word \
         beside {noise_deg_per_h:.3} deg/h of white noise, but fidelity = \"rate\" leaves its rounding \
         out; use fidelity = \"loop\", more bits, or dac_bits = 0"
    )]
    RampTooCoarse {
        /// Phase of one code, rad.
        step_rad: f64,
        /// Largest standard deviation of a word from rounding, deg/h.
        rounding_deg_per_h: f64,
        /// Standard deviation of a word of white noise, deg/h.
        noise_deg_per_h: f64,
    },
}

impl GyroError {
    /// Scenario key at which the error is to be mended.
    #[must_use]
    pub fn key(&self) -> &'static str {
        match self {
            Self::BandwidthAboveNyquist { .. } | Self::UnstableLoop { .. } => {
                "gyro.controller.loop_bandwidth_hz"
            }
            Self::NoPower { .. } => "gyro.thermal.power",
            Self::ThermalLawTooSteep { key, .. } => key,
            Self::NoScaleFactor { .. } => "gyro.coil",
            Self::NoiseBeyondFringe { .. } => "gyro.noise",
            Self::UnstableAtPower { .. } => "gyro.controller.automatic_gain_control",
            Self::LatencyOutOfRange { .. } => "gyro.controller.loop_latency_periods",
            Self::NoSlope { .. } => "gyro.modulator.depth_deg",
            Self::ConverterRange { .. } => "gyro.adc.range_v",
            Self::RateModelLacks { key, .. } => key,
            Self::OddOutputSample { .. } | Self::BrokenLoopPeriod { .. } => {
                "gyro.output.half_periods_per_sample"
            }
            Self::RateBeyondFringe { .. } | Self::PhaseErrorBeyondSlope { .. } => "turntable",
            Self::ConverterTooCoarse { .. } => "gyro.adc.bits",
            Self::RampTooCoarse { .. } => "gyro.modulator.dac_bits",
            Self::RoundingBeyondWalk { .. } => "gyro.noise.angle_random_walk_deg_per_sqrt_h",
        }
    }
}

/// What to do about rounding, the greater part of it first.
fn remedy(converter: f64, words: f64) -> &'static str {
    if converter > words {
        "raise gyro.source.power_uw or gyro.adc.bits (0 rounds nothing)"
    } else {
        "lower gyro.output.rate_lsb_deg_per_s (0 rounds nothing)"
    }
}

/// Least and greatest slope of a converter over nominal. Without noise it has none within a code, and
/// at the edge of one it jumps.
pub(super) fn slopes_text(least: f64, greatest: f64) -> String {
    if greatest.is_finite() {
        format!("{least:.3} and {greatest:.3} of nominal")
    } else {
        "nothing within a code and a jump at its edge".to_owned()
    }
}
