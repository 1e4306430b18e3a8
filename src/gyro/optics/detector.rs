//! Photodetector, amplifier and converter: levels at the bias point and noise densities.

use crate::gyro::GyroConfig;
use crate::gyro::error::GyroError;
use crate::gyro::noise::Densities;
use crate::gyro::noise::equivalent::equivalent_walk_rad_per_sqrt_s;
use crate::gyro::noise::law::WorkingPoint;
use crate::gyro::optics::coil::Coil;
use crate::gyro::optics::converter::{converter_code_max, converter_step_v};
use crate::gyro::optics::modulator::Modulator;
use crate::gyro::thermal::condition::Condition;
use crate::units::MICRO;

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
    /// Noise densities of all sources.
    pub densities: Densities,
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
    /// [`GyroError::ConverterRange`] if the bias point lies outside the converter's range;
    /// [`GyroError::RoundingBeyondWalk`] if rounding is most of the angle random walk that is asked for.
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
        let transimpedance_v_per_a = config.detector.transimpedance_v_per_a();
        let bits = config.adc.bits;
        let bias_current_a = mean_current_a * (1.0 + visibility * cosine);
        let mut point = WorkingPoint {
            source: &config.source,
            detector: &config.detector,
            adc: &config.adc,
            case_c: condition.case_c,
            equivalent_a2_per_hz: 0.0,
        };
        let mut detector = Self {
            nominal_current_a,
            mean_current_a,
            visibility,
            dark_current_a: config.detector.dark_current_a(),
            bias_current_a,
            slope_a_per_rad: mean_current_a * visibility * sine,
            transimpedance_v_per_a,
            densities: Densities::new(&config.noise, &point),
            gate_duty: config.detector.gate_duty,
            converter_step_v: converter_step_v(&config.adc),
            converter_code_max: converter_code_max(&config.adc),
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
        if let Some(walk) = config.noise.angle_random_walk_deg_per_sqrt_h {
            let coil = Coil::new(&config.coil, &config.source);
            let converter = detector.converter_walk_rad_per_sqrt_s(&coil);
            let walk = equivalent_walk_rad_per_sqrt_s(walk, config, &coil, converter)?;
            let current_a = walk * coil.scale_factor_s * detector.slope_a_per_rad;
            point.equivalent_a2_per_hz = 2.0 * detector.gate_duty * current_a * current_a;
            detector.densities = Densities::new(&config.noise, &point);
        }
        Ok(detector)
    }

    /// The chain behind a gate of at most so much of a half period.
    #[must_use]
    pub(in crate::gyro) fn with_gate_within(self, plateau: f64) -> Self {
        let gate_duty = self.gate_duty.min(plateau);
        Self {
            densities: self.densities.behind_gate(gate_duty / self.gate_duty),
            gate_duty,
            ..self
        }
    }

    /// Angle random walk of the rounding in the converter, `sqrt(tau / (12 n)) q / (G Ks slope)`,
    /// rad/sqrt(s).
    #[must_use]
    pub fn converter_walk_rad_per_sqrt_s(&self, coil: &Coil) -> f64 {
        let slope = coil.scale_factor_s * self.slope_a_per_rad;
        let step_a = self.converter_step_v / self.transimpedance_v_per_a;
        let count = self.samples_per_half_period;
        (coil.transit_time_s / (12.0 * count)).sqrt() * step_a / slope
    }

    /// Variance of the mean current over the gate of one half period, A^2.
    ///
    /// White noise of one-sided density `S` averaged over `gate_duty * tau` has variance
    /// `S / (2 gate_duty tau)`.
    #[must_use]
    pub fn half_period_variance_a2(&self, density_a2_per_hz: f64, transit_time_s: f64) -> f64 {
        density_a2_per_hz / (2.0 * self.gate_duty * transit_time_s)
    }

    /// Current noise of all sources at the bias point, A^2/Hz.
    #[must_use]
    pub fn noise_a2_per_hz(&self) -> f64 {
        self.densities
            .a2_per_hz(self.bias_current_a, self.dark_current_a)
    }

    /// Noise of one sample before it is converted, steps of the converter; none of a converter without steps.
    #[must_use]
    pub fn noise_steps(&self, transit_time_s: f64) -> Option<f64> {
        let mean_a2 = self.half_period_variance_a2(self.noise_a2_per_hz(), transit_time_s);
        let sample_a = (self.samples_per_half_period * mean_a2).sqrt();
        let step_a = self.converter_step_v / self.transimpedance_v_per_a;
        (step_a > 0.0).then(|| sample_a / step_a)
    }

    /// Variance of the mean current of one half period, all sources together, A^2.
    ///
    /// Phase noise counts through the slope at the bias point, as the linear loop sees it.
    #[must_use]
    pub fn half_period_noise_a2(&self, transit_time_s: f64) -> f64 {
        let density_rad2_per_hz = self.densities.phase_rad2_per_hz();
        let phase_rad2 = half_period_phase_variance_rad2(density_rad2_per_hz, transit_time_s);
        self.half_period_variance_a2(self.noise_a2_per_hz(), transit_time_s)
            + phase_rad2 * self.slope_a_per_rad * self.slope_a_per_rad
    }
}

/// Variance of phase noise of one half period, rad^2.
///
/// `S1 / (2 tau)`: one independent phase per half period, of one-sided density `S1` up to half
/// the half-period rate. Noise of that band passes the gate unaltered; if it were white far
/// beyond the gate's band, each gate would alias it up to `S1 / (2 gate_duty tau)`.
pub(in crate::gyro) fn half_period_phase_variance_rad2(
    density_rad2_per_hz: f64,
    transit_time_s: f64,
) -> f64 {
    density_rad2_per_hz / (2.0 * transit_time_s)
}
