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
    /// The output sample is not a whole number of loop periods.
    #[error("{half_periods} half periods per output sample: expected an even number of at least 2")]
    OddOutputSample {
        /// Half periods per sample asked for.
        half_periods: u32,
    },
}
