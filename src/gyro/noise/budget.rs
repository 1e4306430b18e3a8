//! Angle random walk by source, in closed form.

use crate::gyro::optics::coil::Coil;
use crate::gyro::optics::detector::Detector;
use crate::units::rad_per_sqrt_s_to_deg_per_sqrt_h;

/// Angle random walk of each source, deg/sqrt(h); a source switched off has 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseBudget {
    /// Shot noise.
    pub shot_deg_per_sqrt_h: f64,
    /// Johnson noise of the transimpedance.
    pub thermal_deg_per_sqrt_h: f64,
    /// Amplifier.
    pub amplifier_deg_per_sqrt_h: f64,
    /// Relative intensity noise.
    pub rin_deg_per_sqrt_h: f64,
    /// Rounding in the analogue-to-digital converter.
    pub adc_deg_per_sqrt_h: f64,
    /// Technical phase noise.
    pub technical_deg_per_sqrt_h: f64,
}

impl NoiseBudget {
    /// The budget of a detection chain behind a coil.
    ///
    /// A white current noise of one-sided density `S` gives
    /// `N = sqrt(S / (2 gate_duty)) / (Ks slope)` rad/sqrt(s), whatever the loop gain; rounding to
    /// `q` with n samples averaged gives `N = sqrt(tau / (12 n)) q / (G Ks slope)`. They add in
    /// quadrature. Technical phase noise of density `S1` gives `N = sqrt(S1 / 2) / Ks`: a pair
    /// averages the independent phases of its halves, so that the error of one loop period `T_L` has
    /// the variance `S1 / (4 tau) = S1 / (2 T_L)`; neither slope nor gate enters. Rounding counts as white noise of variance `q^2 / 12`, which holds while the
    /// noise of one sample exceeds about half a step.
    ///
    /// # Source
    /// Derived from the variance of the pair difference that is demodulated. Checked by known
    /// answer K13 against the loop model, source by source.
    #[must_use]
    pub fn new(detector: &Detector, coil: &Coil) -> Self {
        let slope = coil.scale_factor_s * detector.slope_a_per_rad;
        let walk = |density_a2_per_hz: f64| {
            let white = (density_a2_per_hz / (2.0 * detector.gate_duty)).sqrt();
            rad_per_sqrt_s_to_deg_per_sqrt_h(white / slope)
        };
        let step_a = detector.converter_step_v / detector.transimpedance_v_per_a;
        let rounding =
            (coil.transit_time_s / (12.0 * detector.samples_per_half_period)).sqrt() * step_a;
        Self {
            shot_deg_per_sqrt_h: walk(detector.noise.shot_a2_per_hz),
            thermal_deg_per_sqrt_h: walk(detector.noise.thermal_a2_per_hz),
            amplifier_deg_per_sqrt_h: walk(detector.noise.amplifier_a2_per_hz),
            rin_deg_per_sqrt_h: walk(detector.noise.rin_a2_per_hz),
            adc_deg_per_sqrt_h: rad_per_sqrt_s_to_deg_per_sqrt_h(rounding / slope),
            technical_deg_per_sqrt_h: rad_per_sqrt_s_to_deg_per_sqrt_h(
                (0.5 * detector.technical_phase_rad2_per_hz).sqrt() / coil.scale_factor_s,
            ),
        }
    }

    /// Sum in quadrature, deg/sqrt(h).
    #[must_use]
    pub fn total_deg_per_sqrt_h(&self) -> f64 {
        [
            self.shot_deg_per_sqrt_h,
            self.thermal_deg_per_sqrt_h,
            self.amplifier_deg_per_sqrt_h,
            self.rin_deg_per_sqrt_h,
            self.adc_deg_per_sqrt_h,
            self.technical_deg_per_sqrt_h,
        ]
        .iter()
        .map(|walk| walk * walk)
        .sum::<f64>()
        .sqrt()
    }

    /// Name and angle random walk of each source and of the total, deg/sqrt(h), in report order.
    #[must_use]
    pub fn entries(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("shot", self.shot_deg_per_sqrt_h),
            ("thermal", self.thermal_deg_per_sqrt_h),
            ("amplifier", self.amplifier_deg_per_sqrt_h),
            ("rin", self.rin_deg_per_sqrt_h),
            ("adc", self.adc_deg_per_sqrt_h),
            ("technical", self.technical_deg_per_sqrt_h),
            ("total", self.total_deg_per_sqrt_h()),
        ]
    }
}
