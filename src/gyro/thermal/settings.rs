//! Settings of how temperature reaches the gyro and what it does there.

use crate::declare::table;
use crate::gyro::thermal::power::PowerConfig;
use crate::vocabulary::words;

table! {
    /// How temperature reaches the gyro (chamber -> case -> outer -> inner coil layer, each of first
    /// order) and what it does there. At the reference temperature, at rest, it does nothing.
    pub struct ThermalConfig {
        /// Temperature at which the gyro was calibrated. Source of the default: the paper's room temperature.
        reference_c: f64 = 25.0, in -100.0..=150.0, "C";
        /// Amplitude of the chamber's control ripple. Source of the default: none; chambers show about 0.5 K.
        ripple_amplitude_c: f64 = 0.0, in 0.0..=50.0, "K";
        /// Period of the ripple; of no effect without amplitude. Source of the default: assumed, 5 to 10
        /// minutes are usual.
        ripple_period_s: f64 = 480.0, in 10.0..=1e6, "s";
        /// Rise of the case above the chamber by the gyro's own power. Source of the default: none, so that
        /// a soak is the temperature of everything; 8 K is typical of a gyro of this size.
        self_heating_c: f64 = 0.0, in 0.0..=100.0, "K";
        /// Whether the self-heating has settled when the simulation starts, or starts then ("cold").
        warm_up: ThermalWarmUp = "settled";
        /// Time constant from chamber to case. Source of the default: assumed.
        case_time_constant_s: f64 = 600.0, in 10.0..=1e6, "s";
        /// Time constant from case to outer coil layer. Source of the default: assumed.
        outer_time_constant_s: f64 = 300.0, in 10.0..=1e6, "s";
        /// Time constant from outer to inner coil layer. Source of the default: derived, a winding of 6.6 mm
        /// with a diffusivity of 1e-7 m^2/s has 44 s heated from both sides and 176 s from one.
        inner_time_constant_s: f64 = 100.0, in 10.0..=1e6, "s";
        /// Order of the coil's layers. Source of the default: the practice for gyros of this class.
        winding: Winding = "quadrupole", told in Account;
        /// Number of layers; even for a dipole, a multiple of 4 for a quadrupole. Source of the default:
        /// derived, 3638 turns as 40 layers of 91.
        layers: u32 = 40, in 2..=1024, told in Account;
        /// Distance of the middle of the fibre from the middle of the winding; the leads have the temperature
        /// of the case. Source of the default: none, perfectly trimmed.
        midpoint_offset_m: f64 = 0.0, in -1000.0..=1000.0, "m";
        /// Temperature coefficient of the fibre's index. Source of the default: silica.
        index_per_k: f64 = 1.0e-5, in -1e-3..=1e-3, "1/K";
        /// Thermal expansion of the fibre's length. Source of the default: silica.
        length_ppm_per_k: f64 = 0.55, in -1000.0..=1000.0, "ppm/K";
        /// Thermal expansion of the coil's diameter. Source of the default: assumed, between free fibre (0.55) and
        /// aluminium (23).
        diameter_ppm_per_k: f64 = 10.0, in -1000.0..=1000.0, "ppm/K";
        /// Temperature coefficient of the source's wavelength, per kelvin of its chip. Source of the default: assumed,
        /// superluminescent diodes have 0.3 to 0.5.
        wavelength_nm_per_k: f64 = 0.4, in -10.0..=10.0, "nm/K";
        /// Kelvins of the chip per kelvin of the case; 0 is a perfect temperature control. Source of the default: assumed.
        wavelength_feed_through: f64 = 0.01, in 0.0..=1.0;
        /// Linear scale-factor coefficient that the rate word is compensated by. Source of the default: none.
        compensation_ppm_per_k: f64 = 0.0, in -1000.0..=1000.0, "ppm/K";
        /// Quadratic scale-factor coefficient that the rate word is compensated by. Source of the default: none.
        compensation_ppm_per_k2: f64 = 0.0, in -10.0..=10.0, "ppm/K^2";
        /// Linear bias coefficient. Source of the default: assumed.
        bias_deg_per_h_per_k: f64 = 5e-4, in -1000.0..=1000.0, "deg/h/K";
        /// Quadratic bias coefficient. Source of the default: assumed.
        bias_deg_per_h_per_k2: f64 = 3e-6, in -100.0..=100.0, "deg/h/K^2";
        /// Bias per temperature rate of the coil (stress on the fibre). Source of the default: assumed.
        bias_deg_per_h_per_c_per_min: f64 = 0.02, in -1000.0..=1000.0, "deg/h per K/min";
        /// Drift of the modulator's half-wave voltage, which the second loop corrects if it is on. Source of
        /// the default: none; lithium niobate has about 662 (Yang, 1999).
        half_wave_voltage_ppm_per_k: f64 = 0.0, in -5000.0..=5000.0, "ppm/K";
        power: PowerConfig;
    }
}

words! {
    /// State of the self-heating at the start of the simulation.
    pub enum ThermalWarmUp {
        /// Powered long before.
        Settled = "settled",
        /// Powered at the start, at the temperature of the chamber.
        Cold = "cold",
    }

    /// Order in which the layers of the coil are wound.
    pub enum Winding {
        /// Layer after layer from one end of the fibre to the other.
        Plain = "plain",
        /// The halves of the fibre alternate layer by layer.
        Dipole = "dipole",
        /// The halves alternate as A B B A.
        Quadrupole = "quadrupole",
    }
}
