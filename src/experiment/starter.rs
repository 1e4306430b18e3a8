//! A first scenario for somebody's own gyro.
//!
//! What a data sheet does not say is chosen here, so that the file runs: an output rate of a few kilohertz, a
//! loop that is stable, and converters under whose rounding the noise stays white.

use crate::gyro::{self, Fidelity, GyroConfig, GyroError, MotionExtremes};
use crate::report::{Starter, starter_toml};
use crate::units::{
    EARTH_RATE_RAD_PER_S, deg_per_h_to_deg_per_s, deg_per_sqrt_h_to_deg_per_h_sqrt_s,
};

/// Highest output rate, Hz: that of the paper's gyro.
const OUTPUT_RATE_MAX_HZ: f64 = 4000.0;
/// Highest loop bandwidth over the loop rate: far from where a latency of one period makes it oscillate.
const BANDWIDTH_SHARE_MAX: f64 = 0.08;
/// Noise of a word over the step to which it is rounded, at least.
const STEPS_MIN: f64 = 3.0;
/// Noise of a word over the step that is chosen otherwise, at least.
const STEPS_CHOSEN: f64 = 10.0;
/// Bits of the converter that are tried; the last rounds nothing.
const ADC_BITS: [u32; 6] = [12, 14, 16, 18, 24, 0];
/// Time measured and time before it, s.
const DURATION_S: f64 = 100.0;
const WARM_UP_S: f64 = 5.0;
/// Most half periods that the loop model is asked for: some seconds.
const HALF_PERIODS_MAX: f64 = 2e8;

/// What somebody knows of a gyro.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StarterGyro {
    /// Length of the fibre, m.
    pub length_m: f64,
    /// Mean diameter of the coil, mm.
    pub diameter_mm: f64,
    /// Mean wavelength, nm.
    pub wavelength_nm: f64,
    /// Angle random walk, deg/sqrt(h).
    pub walk_deg_per_sqrt_h: Option<f64>,
    /// Power on the detector, uW.
    pub power_uw: Option<f64>,
    /// Bias instability, deg/h.
    pub bias_instability_deg_per_h: Option<f64>,
}

/// The scenario of a gyro, named `name`.
///
/// # Errors
/// A gyro that cannot be.
pub fn starter_scenario(name: &str, given: &StarterGyro) -> Result<String, GyroError> {
    let mut config = at_hand(given);
    set_clocks(&mut config);
    let half_period_s =
        gyro::word_period_s(&config) / f64::from(config.output.half_periods_per_sample);
    let fidelity = if (DURATION_S + WARM_UP_S) / half_period_s <= HALF_PERIODS_MAX {
        Fidelity::Loop
    } else {
        Fidelity::Rate
    };
    let mut config = with_converters(&config)?;
    set_word_step(&mut config)?;
    let facts = gyro::facts(&config)?;
    Ok(starter_toml(&Starter {
        name,
        gyro: &config,
        facts: &facts,
        fidelity,
        has_power: given.power_uw.is_some(),
        has_bias_instability: given.bias_instability_deg_per_h.is_some(),
        duration_s: DURATION_S,
        warm_up_s: WARM_UP_S,
    }))
}

/// The reference gyro with what is known; the words are not rounded yet.
fn at_hand(given: &StarterGyro) -> GyroConfig {
    let mut config = GyroConfig::reference();
    config.coil.length_m = given.length_m;
    config.coil.diameter_mm = given.diameter_mm;
    config.source.wavelength_nm = given.wavelength_nm;
    config.noise.angle_random_walk_deg_per_sqrt_h = given.walk_deg_per_sqrt_h;
    if let Some(power_uw) = given.power_uw {
        // The voltage of the bias point stays where it is.
        let gain = config.detector.post_gain * config.source.power_uw / power_uw;
        config.detector.post_gain = two_digits(gain).clamp(1e-3, 1e6);
        config.source.power_uw = power_uw;
    }
    if let Some(instability) = given.bias_instability_deg_per_h {
        config.slow_noise.bias_instability_deg_per_h = instability;
    }
    config.output.rate_lsb_deg_per_s = 0.0;
    config
}

/// Sets the output rate and the bandwidth of the loop.
fn set_clocks(config: &mut GyroConfig) {
    config.output.half_periods_per_sample = 2;
    let pair_s = gyro::word_period_s(config);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a positive whole number: the shortest coil takes nanoseconds"
    )]
    let pairs = (1.0 / (OUTPUT_RATE_MAX_HZ * pair_s)).ceil() as u32;
    config.output.half_periods_per_sample = 2 * pairs;
    let half_of_output = 0.5 / gyro::word_period_s(config);
    let bandwidth_hz = half_of_output.min(BANDWIDTH_SHARE_MAX / pair_s);
    config.controller.loop_bandwidth_hz = two_digits(bandwidth_hz);
}

/// The coarsest converters under which neither model has anything to say.
fn with_converters(config: &GyroConfig) -> Result<GyroConfig, GyroError> {
    let rest = MotionExtremes {
        rate_rad_per_s: EARTH_RATE_RAD_PER_S,
        jump_rad_per_s: EARTH_RATE_RAD_PER_S,
        ..MotionExtremes::default()
    };
    // The walk of a data sheet has the rounding in it.
    let is_of_sheet = config.noise.angle_random_walk_deg_per_sqrt_h.is_some();
    let bits = if is_of_sheet {
        &ADC_BITS[ADC_BITS.len() - 1..]
    } else {
        &ADC_BITS
    };
    let mut tried = config.clone();
    for dac_bits in [config.modulator.dac_bits, 0] {
        for adc_bits in bits {
            tried.modulator.dac_bits = dac_bits;
            tried.adc.bits = *adc_bits;
            if [Fidelity::Loop, Fidelity::Rate]
                .into_iter()
                .all(|model| gyro::cautions(&tried, model, &rest).is_ok_and(|said| said.is_empty()))
            {
                return Ok(tried);
            }
        }
    }
    // Whatever is said of it then is not about converters.
    gyro::cautions(&tried, Fidelity::Loop, &rest).map(|_| tried)
}

/// Sets the step of the words: the default one, or one that is small beside the noise.
fn set_word_step(config: &mut GyroConfig) -> Result<(), GyroError> {
    let facts = gyro::facts(config)?;
    let budget = facts.angle_random_walk_budget_deg_per_sqrt_h.last();
    let walk = budget.map_or(0.0, |(_, walk)| deg_per_sqrt_h_to_deg_per_h_sqrt_s(*walk));
    let noise_deg_per_s = deg_per_h_to_deg_per_s(walk * facts.output_rate_hz.sqrt());
    let usual = GyroConfig::reference().output.rate_lsb_deg_per_s;
    config.output.rate_lsb_deg_per_s = if noise_deg_per_s >= STEPS_MIN * usual {
        usual
    } else {
        10.0_f64.powf((noise_deg_per_s / STEPS_CHOSEN).log10().floor())
    };
    Ok(())
}

/// A number to two significant digits.
fn two_digits(value: f64) -> f64 {
    crate::wording::to_digits(value, 2)
}
