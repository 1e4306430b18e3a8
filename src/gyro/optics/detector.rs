//! Photodetector, amplifier and converter: levels at the bias point and noise densities.

use crate::gyro::error::GyroError;
use crate::gyro::noise::rin::relative_intensity_noise_per_hz;
use crate::gyro::optics::modulator::Modulator;
use crate::gyro::thermal::condition::Condition;
use crate::scenario::GyroConfig;
use crate::units::{
    BOLTZMANN_J_PER_K, ELEMENTARY_CHARGE_C, KILO, MICRO, NANO, PICO, celsius_to_kelvin,
};

/// One-sided current noise density of each source at the bias point, A^2/Hz.
///
/// A source that is switched off has 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurrentNoise {
    /// Shot noise `2 e (I_b + I_dark)`.
    pub shot_a2_per_hz: f64,
    /// Johnson noise `4 k T / R_f`.
    pub thermal_a2_per_hz: f64,
    /// Amplifier `(e_n / R_f)^2 + i_n^2`.
    pub amplifier_a2_per_hz: f64,
    /// Intensity noise `RIN I_b^2`.
    pub rin_a2_per_hz: f64,
}

impl CurrentNoise {
    /// Sum of all sources, A^2/Hz.
    #[must_use]
    pub fn total_a2_per_hz(&self) -> f64 {
        self.shot_a2_per_hz + self.thermal_a2_per_hz + self.amplifier_a2_per_hz + self.rin_a2_per_hz
    }
}

/// Detection chain at the bias point.
///
/// The power on the detector is `P = P0 (1 + V cos D)` with `D` the phase difference of the two
/// waves; the square-wave bias alternates `D = phi_e +- phi_m`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detector {
    /// Photocurrent of the nominal mean power, A.
    pub nominal_current_a: f64,
    /// Photocurrent of the mean power, `R P0`, A.
    pub mean_current_a: f64,
    /// Fringe visibility V.
    pub visibility: f64,
    /// Dark current, A.
    pub dark_current_a: f64,
    /// Photocurrent at the bias point, `R P0 (1 + V cos phi_m)`, A.
    pub bias_current_a: f64,
    /// Slope at the bias point, `R P0 V sin phi_m`, A/rad.
    pub slope_a_per_rad: f64,
    /// Converter volts per ampere of photocurrent, `G = R_f G_v`.
    pub transimpedance_v_per_a: f64,
    /// Relative intensity noise, 1/Hz; 0 when switched off.
    pub rin_per_hz: f64,
    /// Noise densities at the bias point.
    pub noise: CurrentNoise,
    /// One-sided technical phase noise of the half periods, rad^2/Hz; 0 when there is none.
    pub technical_phase_rad2_per_hz: f64,
    /// Gated fraction of a half period.
    pub gate_duty: f64,
    /// Converter step q, V; 0 for an ideal converter.
    pub converter_step_v: f64,
    /// Largest code of the converter; infinite for an ideal one.
    pub converter_code_max: f64,
    /// Samples averaged per half period.
    pub samples_per_half_period: f64,
}

impl Detector {
    /// The chain of a configuration in a condition: its power, and its temperature for the
    /// Johnson noise.
    ///
    /// # Errors
    /// [`GyroError::NoSlope`] if the slope at the bias point is not positive;
    /// [`GyroError::ConverterRange`] if the bias point lies outside the converter's range.
    pub fn new(
        config: &GyroConfig,
        modulator: &Modulator,
        condition: &Condition,
    ) -> Result<Self, GyroError> {
        let (sine, cosine) = modulator.depth_rad.sin_cos();
        let visibility = config.source.visibility;
        let nominal_current_a =
            config.detector.responsivity_a_per_w * config.source.power_uw * MICRO;
        let mean_current_a = nominal_current_a * condition.power_ratio;
        let transimpedance_v_per_a =
            config.detector.transimpedance_kohm * KILO * config.detector.post_gain;
        let bits = config.adc.bits;
        let codes = 2.0_f64.powi(bits.cast_signed());
        let bias_current_a = mean_current_a * (1.0 + visibility * cosine);
        let detector = Self {
            nominal_current_a,
            mean_current_a,
            visibility,
            dark_current_a: config.detector.dark_current_na * NANO,
            bias_current_a,
            slope_a_per_rad: mean_current_a * visibility * sine,
            transimpedance_v_per_a,
            rin_per_hz: if config.noise.rin {
                relative_intensity_noise_per_hz(&config.source)
            } else {
                0.0
            },
            noise: current_noise(config, bias_current_a, condition.case_c),
            technical_phase_rad2_per_hz: (config.noise.technical_phase_urad_per_sqrt_hz * MICRO)
                .powi(2),
            gate_duty: config.detector.gate_duty,
            converter_step_v: if bits == 0 {
                0.0
            } else {
                config.adc.range_v / codes
            },
            converter_code_max: if bits == 0 {
                f64::INFINITY
            } else {
                codes - 1.0
            },
            samples_per_half_period: f64::from(config.adc.samples_per_half_period),
        };
        if detector.slope_a_per_rad.is_nan() || detector.slope_a_per_rad <= 1e-9 * mean_current_a {
            return Err(GyroError::NoSlope {
                depth_deg: config.modulator.depth_deg,
            });
        }
        let bias_v = transimpedance_v_per_a * (detector.bias_current_a + detector.dark_current_a);
        if bits > 0 && bias_v >= config.adc.range_v {
            return Err(GyroError::ConverterRange {
                bias_v,
                range_v: config.adc.range_v,
            });
        }
        Ok(detector)
    }

    /// Variance of the mean current over the gate of one half period, A^2.
    ///
    /// White noise of one-sided density `S` averaged over `gate_duty * tau` has variance
    /// `S / (2 gate_duty tau)`.
    #[must_use]
    pub fn half_period_variance_a2(&self, density_a2_per_hz: f64, transit_time_s: f64) -> f64 {
        density_a2_per_hz / (2.0 * self.gate_duty * transit_time_s)
    }

    /// Variance of the technical phase noise of one half period, rad^2.
    ///
    /// `S1 / (2 tau)`: one independent phase per half period, of one-sided density `S1` up to half
    /// the half-period rate. Noise of that band passes the gate unaltered; if it were white far
    /// beyond the gate's band, each gate would alias it up to `S1 / (2 gate_duty tau)`.
    #[must_use]
    pub fn half_period_phase_variance_rad2(&self, transit_time_s: f64) -> f64 {
        self.technical_phase_rad2_per_hz / (2.0 * transit_time_s)
    }

    /// Variance of the mean current of one half period, all sources together, A^2.
    ///
    /// Phase noise counts through the slope at the bias point, as the linear loop sees it.
    #[must_use]
    pub fn half_period_noise_a2(&self, transit_time_s: f64) -> f64 {
        let phase_rad2 = self.half_period_phase_variance_rad2(transit_time_s);
        self.half_period_variance_a2(self.noise.total_a2_per_hz(), transit_time_s)
            + phase_rad2 * self.slope_a_per_rad * self.slope_a_per_rad
    }
}

fn current_noise(config: &GyroConfig, bias_current_a: f64, case_c: f64) -> CurrentNoise {
    let kelvin = celsius_to_kelvin(case_c);
    let feedback_ohm = config.detector.transimpedance_kohm * KILO;
    let dark_current_a = config.detector.dark_current_na * NANO;
    let voltage_noise = config.detector.voltage_noise_nv_per_sqrt_hz * NANO / feedback_ohm;
    let current_noise = config.detector.current_noise_pa_per_sqrt_hz * PICO;
    let rin_per_hz = relative_intensity_noise_per_hz(&config.source);
    let when = |is_on: bool, density: f64| if is_on { density } else { 0.0 };
    CurrentNoise {
        shot_a2_per_hz: when(
            config.noise.shot,
            2.0 * ELEMENTARY_CHARGE_C * (bias_current_a + dark_current_a),
        ),
        thermal_a2_per_hz: when(
            config.noise.thermal,
            4.0 * BOLTZMANN_J_PER_K * kelvin / feedback_ohm,
        ),
        amplifier_a2_per_hz: when(
            config.noise.amplifier,
            voltage_noise * voltage_noise + current_noise * current_noise,
        ),
        rin_a2_per_hz: when(
            config.noise.rin,
            rin_per_hz * bias_current_a * bias_current_a,
        ),
    }
}
