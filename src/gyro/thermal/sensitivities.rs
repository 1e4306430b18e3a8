//! What temperature does to scale factor, bias and power.

use crate::gyro::error::GyroError;
use crate::gyro::thermal::condition::Condition;
use crate::gyro::thermal::{NetworkState, Shupe};
use crate::gyro::{GyroConfig, PowerConfig};
use crate::units::{MICRO, deg_per_h_to_rad_per_s, k_per_s_to_k_per_min};

/// Largest change of the scale factor, and of its compensation, for which their laws count as such.
const SCALE_CHANGE_MAX: f64 = 0.5;
/// The same of the half-wave voltage: as much as `gyro.modulator.gain_error_ppm` allows.
const HALF_WAVE_CHANGE_MAX: f64 = 0.2;

/// Laws of the gyro against temperature, x being kelvins above the reference.
///
/// * Scale factor `2 pi L D / (lambda c)`: `1 + (alpha_L + alpha_D) x_coil - k x_case / lambda`
///   with k the wavelength's coefficient times its feed-through, divided by the compensation
///   `1 + k1 x_coil + k2 x_coil^2` of the rate word. The index does not enter.
/// * Bias `b1 x_coil + b2 x_coil^2 + b' dT_coil/dt` + Shupe bias.
/// * Power `P0 (1 + a x_case + b x_case^2)`, or exponential, or constant.
/// * Half-wave voltage: the modulator applies `1 + eps` of the commanded phase. The phase for a
///   fixed voltage goes with the inverse of V_pi: `eps = 1 / (1 + v x_case) - 1`.
///
/// # Source
/// Lefevre, The Fiber-Optic Gyroscope, 2nd ed., section 2.1 (scale factor); the rest are the
/// customary polynomials.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::gyro) struct Sensitivities {
    reference_c: f64,
    coil_per_k: f64,
    case_per_k: f64,
    compensation: [f64; 2],
    bias_rad_per_s: [f64; 2],
    bias_rad_per_s_per_k_per_min: f64,
    half_wave_per_k: f64,
    shupe: Shupe,
    power: PowerLaw,
}

/// Power against kelvins above the reference, as a ratio.
#[derive(Clone, Copy, Debug, PartialEq)]
enum PowerLaw {
    Quadratic { linear: f64, square: f64 },
    Exponential { fall_k: f64 },
    Constant,
}

impl Sensitivities {
    pub(in crate::gyro) fn new(config: &GyroConfig) -> Self {
        let thermal = &config.thermal;
        let wavelength_per_k = thermal.wavelength_nm_per_k / config.source.wavelength_nm;
        Self {
            reference_c: thermal.reference_c,
            coil_per_k: (thermal.length_ppm_per_k + thermal.diameter_ppm_per_k) * MICRO,
            case_per_k: -wavelength_per_k * thermal.wavelength_feed_through,
            compensation: [
                thermal.compensation_ppm_per_k * MICRO,
                thermal.compensation_ppm_per_k2 * MICRO,
            ],
            bias_rad_per_s: [
                deg_per_h_to_rad_per_s(thermal.bias_deg_per_h_per_k),
                deg_per_h_to_rad_per_s(thermal.bias_deg_per_h_per_k2),
            ],
            bias_rad_per_s_per_k_per_min: deg_per_h_to_rad_per_s(
                thermal.bias_deg_per_h_per_c_per_min,
            ),
            half_wave_per_k: thermal.half_wave_voltage_ppm_per_k * MICRO,
            shupe: Shupe::new(config),
            power: PowerLaw::new(&thermal.power, thermal.reference_c),
        }
    }

    /// The condition at the temperatures and temperature rates (K/s) of the network.
    pub(in crate::gyro) fn condition(
        &self,
        state: &NetworkState,
        slopes_c_per_s: &NetworkState,
    ) -> Condition {
        let coil_k = state.coil_c() - self.reference_c;
        let case_k = state.case_c - self.reference_c;
        let optical = 1.0 + self.coil_per_k * coil_k + self.case_per_k * case_k;
        let [linear, square] = self.compensation;
        let [bias, bias_square] = self.bias_rad_per_s;
        let rate_k_per_min = k_per_s_to_k_per_min(slopes_c_per_s.coil_c());
        Condition {
            case_c: state.case_c,
            coil_c: state.coil_c(),
            power_ratio: self.power.ratio(case_k),
            scale_ratio: optical / (1.0 + (linear + square * coil_k) * coil_k),
            bias_rad_per_s: (bias + bias_square * coil_k) * coil_k
                + self.bias_rad_per_s_per_k_per_min * rate_k_per_min
                + self.shupe.bias_rad_per_s(slopes_c_per_s),
            modulator_gain_error: (1.0 + self.half_wave_per_k * case_k).recip() - 1.0,
        }
    }

    /// Refuses laws that leave the small changes they hold for between two temperatures, deg C.
    ///
    /// # Errors
    /// [`GyroError::ThermalLawTooSteep`].
    pub(in crate::gyro) fn check(&self, (low_c, high_c): (f64, f64)) -> Result<(), GyroError> {
        for temperature_c in [low_c, high_c] {
            let kelvin = temperature_c - self.reference_c;
            let [linear, square] = self.compensation;
            let ratios = [
                (
                    "gyro.thermal",
                    "the scale factor",
                    1.0 + (self.coil_per_k + self.case_per_k) * kelvin,
                    SCALE_CHANGE_MAX,
                ),
                (
                    "gyro.thermal.compensation_ppm_per_k",
                    "the compensated scale factor",
                    1.0 + (linear + square * kelvin) * kelvin,
                    SCALE_CHANGE_MAX,
                ),
                (
                    "gyro.thermal.half_wave_voltage_ppm_per_k",
                    "the half-wave voltage",
                    1.0 + self.half_wave_per_k * kelvin,
                    HALF_WAVE_CHANGE_MAX,
                ),
            ];
            for (key, what, ratio, limit) in ratios {
                if (ratio - 1.0).abs() > limit {
                    return Err(GyroError::ThermalLawTooSteep {
                        key,
                        what,
                        ratio,
                        limit,
                        temperature_c,
                    });
                }
            }
        }
        Ok(())
    }

    /// Smallest and largest power ratio while the case is between two temperatures, deg C.
    ///
    /// # Errors
    /// [`GyroError::NoPower`] if the law gives no light somewhere between.
    pub(in crate::gyro) fn power_range(
        &self,
        (low_c, high_c): (f64, f64),
    ) -> Result<(f64, f64), GyroError> {
        let (low_k, high_k) = (low_c - self.reference_c, high_c - self.reference_c);
        let vertex_k = match self.power {
            PowerLaw::Quadratic { linear, square } => -0.5 * linear / square,
            PowerLaw::Exponential { .. } | PowerLaw::Constant => low_k,
        };
        let inner_k = if (low_k..high_k).contains(&vertex_k) {
            vertex_k
        } else {
            low_k
        };
        let ratios = [low_k, inner_k, high_k].map(|kelvin| (kelvin, self.power.ratio(kelvin)));
        let compare = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
        let (least_k, least) = *ratios.iter().min_by(compare).unwrap_or(&ratios[0]);
        let (_, most) = *ratios.iter().max_by(compare).unwrap_or(&ratios[0]);
        if least > 0.0 {
            Ok((least, most))
        } else {
            Err(GyroError::NoPower {
                power_ratio: least,
                temperature_c: least_k + self.reference_c,
            })
        }
    }
}

impl PowerLaw {
    fn new(config: &PowerConfig, reference_c: f64) -> Self {
        match config {
            PowerConfig::Quadratic(points) => {
                // Chords from the reference; a parabola's chord slope is linear in the distance.
                let (cold_k, hot_k) = (points.cold_c - reference_c, points.hot_c - reference_c);
                let cold_chord = (points.cold_ratio - 1.0) / cold_k;
                let hot_chord = (points.hot_ratio - 1.0) / hot_k;
                let square = (hot_chord - cold_chord) / (hot_k - cold_k);
                Self::Quadratic {
                    linear: cold_chord - square * cold_k,
                    square,
                }
            }
            PowerConfig::Exponential(law) => Self::Exponential { fall_k: law.fall_k },
            PowerConfig::Constant(_) => Self::Constant,
        }
    }

    fn ratio(self, kelvin: f64) -> f64 {
        match self {
            Self::Quadratic { linear, square } => 1.0 + (linear + square * kelvin) * kelvin,
            Self::Exponential { fall_k } => (-kelvin / fall_k).exp(),
            Self::Constant => 1.0,
        }
    }
}
