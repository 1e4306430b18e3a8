//! Settings of the digital controller.

use crate::declare::table;

table! {
    /// Digital controller.
    pub struct ControllerConfig {
        /// Closed-loop -3 dB bandwidth; sets the integrator gain. Source of the default: assumed, half of the
        /// output rate.
        loop_bandwidth_hz: f64 = 2000.0, in 1e-3..=100000.0, "Hz";
        /// Pipeline latency in modulation periods. Source of the default: assumed, one period to compute.
        loop_latency_periods: u32 = 1, in 0..=3;
        /// Whether the loop gain is held against changes of the detected power; if not, bandwidth and delay
        /// change with it. Source of the default: assumed, a plain integrator.
        automatic_gain_control: bool = false;
        /// Gain of the second loop, which corrects the modulator's gain; 0 is off. Source of the default: none.
        second_loop_gain: f64 = 0.0, in 0.0..=1.0;
        /// Bits of the ramp's step over 2 pi, the rest cut off; 0 is ideal. Source of the default: none.
        step_bits: u32 = 0, in 0..=48;
        /// Largest magnitude of the ramp's step; 0 is not limited. Source of the default: none.
        step_limit_deg: f64 = 0.0, in 0.0..=3600.0, "deg";
    }
}
