//! The parts every model of the gyro is built from, checked once.

use crate::gyro::modulation::Timing;
use crate::gyro::optics::{Optics, spike_share};
use crate::gyro::{Coil, Controller, Detector, GyroError, Modulator};
use crate::scenario::GyroConfig;

/// Coil, modulator, detector and controller of one configuration.
pub(super) struct Parts {
    /// Half modulation periods in one rate word, whole loop periods.
    pub(super) half_periods: u32,
    /// Half modulation period, s: the transit time but for the mismatch.
    pub(super) half_period_s: f64,
    /// States and half periods of a loop period.
    pub(super) timing: Timing,
    /// Second-order effects.
    pub(super) optics: Optics,
    pub(super) coil: Coil,
    pub(super) modulator: Modulator,
    pub(super) detector: Detector,
    pub(super) controller: Controller,
}

impl Parts {
    /// # Errors
    /// Any [`GyroError`] of the parts, or a rate word that is no whole number of loop periods.
    pub(super) fn new(config: &GyroConfig) -> Result<Self, GyroError> {
        let half_periods = config.output.half_periods_per_sample;
        if half_periods < 2 || !half_periods.is_multiple_of(2) {
            return Err(GyroError::OddOutputSample { half_periods });
        }
        let timing = Timing::new(config.modulator.scheme);
        if !half_periods.is_multiple_of(timing.half_periods) {
            return Err(GyroError::BrokenLoopPeriod {
                half_periods,
                per_period: timing.half_periods,
            });
        }
        let optics = Optics::new(config);
        let coil = Coil::new(&config.coil, &config.source);
        let modulator = Modulator::new(&config.modulator);
        let mut detector = Detector::new(config, &modulator)?;
        if config.detector.gate_spikes {
            // The gate cannot be longer than what is left between the spikes.
            let plateau = 1.0 - spike_share(optics.mismatch);
            detector.gate_duty = detector.gate_duty.min(plateau);
        }
        let half_period_s = half_period_s(config);
        let controller = Controller::new(
            config.controller.loop_bandwidth_hz,
            config.controller.loop_latency_periods,
            f64::from(timing.half_periods) * half_period_s,
        )?
        .with_states(timing.states);
        Ok(Self {
            half_periods,
            half_period_s,
            timing,
            optics,
            coil,
            modulator,
            detector,
            controller,
        })
    }
}

/// Half modulation period of a configuration, s.
pub(super) fn half_period_s(config: &GyroConfig) -> f64 {
    let coil = Coil::new(&config.coil, &config.source);
    coil.transit_time_s * (1.0 + config.modulator.half_period_mismatch)
}
