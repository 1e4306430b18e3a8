//! The parts every model of the gyro is built from, checked once.

use crate::gyro::GyroConfig;
use crate::gyro::controller::gain_limit;
use crate::gyro::noise::budget::NoiseBudget;
use crate::gyro::optics::modulation::Timing;
use crate::gyro::optics::second_order::{Optics, spike_share};
use crate::gyro::thermal::condition::{Condition, power_range};
use crate::gyro::{Coil, Controller, Detector, GyroError, Modulator};
use crate::units::{deg_per_sqrt_h_to_rad_per_sqrt_s, rad_per_s_to_deg_per_s};

/// Least Sagnac phase per rate that counts as a gyro, s: a billionth of a usual coil's.
const SCALE_FACTOR_MIN_S: f64 = 1e-9;

/// Coil, modulator, detector and controller of one configuration in one condition.
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
    /// With the gain that the detected power gives.
    pub(super) controller: Controller,
    pub(super) condition: Condition,
}

impl Parts {
    /// The parts at the start of the simulation; they then exist in every condition of the run.
    ///
    /// # Errors
    /// Any [`GyroError`] of the parts, or a rate word that is no whole number of loop periods.
    pub(super) fn new(config: &GyroConfig) -> Result<Self, GyroError> {
        let start = Condition::at_start(config);
        let parts = Self::at(config, &start)?;
        if parts.coil.scale_factor_s < SCALE_FACTOR_MIN_S {
            return Err(GyroError::NoScaleFactor {
                scale_factor_s: parts.coil.scale_factor_s,
                least_s: SCALE_FACTOR_MIN_S,
            });
        }
        parts.noise_within_fringe()?;
        let (least, most) = power_range(config)?;
        for power_ratio in [least, most] {
            let extreme = Condition {
                power_ratio,
                ..start
            };
            let parts = Self::at(config, &extreme)?;
            parts.noise_within_fringe()?;
            let controller = parts.controller;
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
        let mut detector = Detector::new(config, &modulator, condition)?;
        if config.detector.gate_spikes {
            // The gate cannot be longer than what is left between the spikes.
            let plateau = 1.0 - spike_share(optics.mismatch);
            detector = detector.with_gate_within(plateau);
        }
        let half_period_s = half_period_s(config);
        let mut controller = Controller::new(
            config.controller.loop_bandwidth_hz,
            config.controller.loop_latency_periods,
            f64::from(timing.half_periods) * half_period_s,
        )?
        .with_states(timing.states);
        if !config.controller.automatic_gain_control {
            controller.gain *= condition.power_ratio;
        }
        Ok(Self {
            half_periods,
            half_period_s,
            timing,
            optics,
            coil,
            modulator,
            detector,
            controller,
            condition: *condition,
        })
    }

    /// Refuses noise beside which nothing shows, and which ends in numbers that are not finite.
    fn noise_within_fringe(&self) -> Result<(), GyroError> {
        let budget = NoiseBudget::new(&self.detector, &self.coil).detection_deg_per_sqrt_h();
        let word_s = f64::from(self.half_periods) * self.half_period_s;
        let noise = deg_per_sqrt_h_to_rad_per_sqrt_s(budget) / word_s.sqrt();
        let limit = self.coil.single_fringe_rate_rad_per_s();
        if noise.is_finite() && noise < limit {
            return Ok(());
        }
        Err(GyroError::NoiseBeyondFringe {
            noise_deg_per_s: rad_per_s_to_deg_per_s(noise),
            limit_deg_per_s: rad_per_s_to_deg_per_s(limit),
        })
    }

    /// The parts in a condition of a run whose start has been checked.
    pub(super) fn under_way(config: &GyroConfig, condition: &Condition) -> Self {
        Self::at(config, condition)
            .expect("the extremes of the power have been checked, and nothing else depends on it")
    }
}

/// Half modulation period of a configuration, s.
pub(super) fn half_period_s(config: &GyroConfig) -> f64 {
    let coil = Coil::new(&config.coil, &config.source);
    coil.half_period_s(config.modulator.half_period_mismatch)
}

/// The cubic that an instant of a sample falls into, and its normalised time there.
pub(super) fn place_in_cubics(instant: usize, instants: usize, cubics: usize) -> (usize, f64) {
    let within = (instant * cubics % instants) as f64;
    (instant * cubics / instants, within / instants as f64)
}
