//! Temperature of the gyro: chamber, thermal network, winding and sensitivities.

use serde::Deserialize;

/// Chamber temperature against time, counted from the start of the simulation (the warm-up
/// included): exactly one course.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TemperatureConfig {
    /// Constant temperature.
    Soak(SoakConfig),
    /// One ramp between two constant temperatures.
    Ramp(TemperatureRampConfig),
    /// Straight lines between points.
    Profile(TemperatureProfileConfig),
}

/// Constant temperature.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SoakConfig {
    /// Temperature of the chamber, deg C.
    pub temperature_c: f64,
}

/// One ramp; constant before and after.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TemperatureRampConfig {
    /// Temperature before the ramp, deg C.
    pub start_c: f64,
    /// Temperature after it, deg C.
    pub end_c: f64,
    /// Slope, K/min; its sign is that of `end_c - start_c`.
    pub rate_c_per_min: f64,
    /// Time at which the ramp starts, s.
    pub start_s: f64,
}

/// Points joined by straight lines; constant before the first and after the last.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TemperatureProfileConfig {
    /// Times, s, increasing.
    pub times_s: Vec<f64>,
    /// Temperature at each time, deg C.
    pub temperatures_c: Vec<f64>,
}

/// How temperature reaches the gyro and what it does there.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ThermalConfig {
    /// Temperature at which the gyro was calibrated, deg C.
    pub reference_c: f64,
    /// Amplitude of the chamber's control ripple, K.
    pub ripple_amplitude_c: f64,
    /// Period of the ripple, s.
    pub ripple_period_s: f64,
    /// Rise of the case above the chamber by the gyro's own power, K.
    pub self_heating_c: f64,
    /// Whether the self-heating has settled when the simulation starts.
    pub warm_up: ThermalWarmUp,
    /// Time constant chamber to case, s.
    pub case_time_constant_s: f64,
    /// Time constant case to outer coil layer, s.
    pub outer_time_constant_s: f64,
    /// Time constant outer to inner coil layer, s.
    pub inner_time_constant_s: f64,
    /// Order of the coil's layers.
    pub winding: Winding,
    /// Number of layers M.
    pub layers: u32,
    /// Distance of the middle of the fibre from the middle of the winding, m.
    pub midpoint_offset_m: f64,
    /// Temperature coefficient of the fibre's index, 1/K.
    pub index_per_k: f64,
    /// Thermal expansion of the fibre's length, ppm/K.
    pub length_ppm_per_k: f64,
    /// Thermal expansion of the coil's diameter, ppm/K.
    pub diameter_ppm_per_k: f64,
    /// Temperature coefficient of the source's wavelength, nm per kelvin of its chip.
    pub wavelength_nm_per_k: f64,
    /// Kelvins of the chip per kelvin of the case; 0 is a perfect temperature control.
    pub wavelength_feed_through: f64,
    /// Linear scale-factor coefficient that the rate word is compensated by, ppm/K.
    pub compensation_ppm_per_k: f64,
    /// Quadratic scale-factor coefficient that the rate word is compensated by, ppm/K^2.
    pub compensation_ppm_per_k2: f64,
    /// Linear bias coefficient, deg/h/K.
    pub bias_deg_per_h_per_k: f64,
    /// Quadratic bias coefficient, deg/h/K^2.
    pub bias_deg_per_h_per_k2: f64,
    /// Bias per temperature rate of the coil, deg/h per K/min.
    pub bias_deg_per_h_per_c_per_min: f64,
    /// Drift of the modulator's half-wave voltage, ppm/K.
    pub half_wave_voltage_ppm_per_k: f64,
    /// Detected power against temperature.
    pub power: PowerConfig,
}

/// State of the self-heating at the start of the simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ThermalWarmUp {
    /// Powered long before.
    Settled,
    /// Powered at the start, at the temperature of the chamber.
    Cold,
}

/// Order in which the layers of the coil are wound.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Winding {
    /// Layer after layer from one end of the fibre to the other.
    Plain,
    /// The halves of the fibre alternate layer by layer.
    Dipole,
    /// The halves alternate as A B B A.
    Quadrupole,
}

/// Detected power against the temperature of the case: exactly one law.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PowerConfig {
    /// Parabola through the reference and two points.
    Quadratic(QuadraticPowerConfig),
    /// Exponential fall with temperature.
    Exponential(ExponentialPowerConfig),
    /// The same at every temperature.
    Constant(ConstantPowerConfig),
}

/// Parabola through (cold, ratio), (reference, 1) and (hot, ratio).
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct QuadraticPowerConfig {
    /// Temperature below the reference, deg C.
    pub cold_c: f64,
    /// Power there over the power at the reference.
    pub cold_ratio: f64,
    /// Temperature above the reference, deg C.
    pub hot_c: f64,
    /// Power there over the power at the reference.
    pub hot_ratio: f64,
}

/// `exp(-(T - reference) / fall)`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExponentialPowerConfig {
    /// Kelvins over which the power falls by e.
    pub fall_k: f64,
}

/// Nothing to set.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConstantPowerConfig {}
