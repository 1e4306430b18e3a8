//! The parts every model of the gyro is built from, checked once.

use crate::gyro::condition::{Condition, power_range};
use crate::gyro::controller::gain_limit;
use crate::gyro::{Coil, Controller, Detector, GyroError, Modulator};
use crate::scenario::GyroConfig;

/// Coil, modulator, detector and controller of one configuration in one condition.
pub(super) struct Parts {
    /// Half modulation periods in one rate word, even.
    pub(super) half_periods: u32,
    pub(super) coil: Coil,
    pub(super) modulator: Modulator,
    pub(super) detector: Detector,
    /// With the gain that the detected power gives.
    pub(super) controller: Controller,
    pub(super) condition: Condition,
}

impl Parts {
    /// The parts at the start of the simulation; they then exist in every condition of the run.
    ///
    /// # Errors
    /// Any [`GyroError`] of the parts, or an odd number of half periods in a rate word.
    pub(super) fn new(config: &GyroConfig) -> Result<Self, GyroError> {
        let start = Condition::at_start(config);
        let parts = Self::at(config, &start)?;
        let (least, most) = power_range(config)?;
        for power_ratio in [least, most] {
            let extreme = Condition {
                power_ratio,
                ..start
            };
            let controller = Self::at(config, &extreme)?.controller;
            let gain_limit = gain_limit(controller.latency_periods);
            if controller.gain >= gain_limit {
                return Err(GyroError::UnstableAtPower {
                    power_ratio,
                    gain: controller.gain,
                    gain_limit,
                });
            }
        }
        Ok(parts)
    }

    /// The parts in a condition.
    ///
    /// Without automatic gain control the loop gain goes with the power: the pair difference does,
    /// while the register's codes per level stay.
    ///
    /// # Errors
    /// As [`Parts::new`], the stability at this power left out.
    pub(super) fn at(config: &GyroConfig, condition: &Condition) -> Result<Self, GyroError> {
        let half_periods = config.output.half_periods_per_sample;
        if half_periods < 2 || !half_periods.is_multiple_of(2) {
            return Err(GyroError::OddOutputSample { half_periods });
        }
        let coil = Coil::new(&config.coil, &config.source);
        let modulator = Modulator::new(&config.modulator);
        let detector = Detector::new(config, &modulator, condition)?;
        let mut controller = Controller::new(
            config.controller.loop_bandwidth_hz,
            config.controller.loop_latency_periods,
            coil.loop_period_s(),
        )?;
        if !config.controller.automatic_gain_control {
            controller.gain *= condition.power_ratio;
        }
        Ok(Self {
            half_periods,
            coil,
            modulator,
            detector,
            controller,
            condition: *condition,
        })
    }

    /// The parts in a condition of a run whose start has been checked.
    pub(super) fn under_way(config: &GyroConfig, condition: &Condition) -> Self {
        Self::at(config, condition)
            .expect("the extremes of the power have been checked, and nothing else depends on it")
    }
}
