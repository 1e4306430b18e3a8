//! The parts every model of the gyro is built from, checked once.

use crate::gyro::{Coil, Controller, Detector, GyroError, Modulator};
use crate::scenario::GyroConfig;

/// Coil, modulator, detector and controller of one configuration.
pub(super) struct Parts {
    /// Half modulation periods in one rate word, even.
    pub(super) half_periods: u32,
    pub(super) coil: Coil,
    pub(super) modulator: Modulator,
    pub(super) detector: Detector,
    pub(super) controller: Controller,
}

impl Parts {
    /// # Errors
    /// Any [`GyroError`] of the parts, or an odd number of half periods in a rate word.
    pub(super) fn new(config: &GyroConfig) -> Result<Self, GyroError> {
        let half_periods = config.output.half_periods_per_sample;
        if half_periods < 2 || !half_periods.is_multiple_of(2) {
            return Err(GyroError::OddOutputSample { half_periods });
        }
        let coil = Coil::new(&config.coil, &config.source);
        let modulator = Modulator::new(&config.modulator);
        let detector = Detector::new(config, &modulator)?;
        let controller = Controller::new(
            config.controller.loop_bandwidth_hz,
            config.controller.loop_latency_periods,
            coil.loop_period_s(),
        )?;
        Ok(Self {
            half_periods,
            coil,
            modulator,
            detector,
            controller,
        })
    }
}
