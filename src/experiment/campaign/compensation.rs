//! The compensation stage: from three words of an assembly to three compensated ones.

use crate::calibration::{
    Calibration, CalibrationError, Compensation, ErrorParameters, Misalignment,
};
use crate::gyro::CoilThermometer;
use crate::scenario::{CompensationParameters, GyroConfig};
use crate::signal::{CompensationSheet, TemperatureModel};
use crate::units::{
    MICRO, arcsec_to_rad, deg_per_h_to_deg_per_s, deg_per_s_to_deg_per_h, rad_to_arcsec,
    ratio_to_ppm,
};
use crate::vocabulary::CompensationForm;

/// What is taken out of the outputs, and how.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Parameters {
    compensation: Compensation,
    form: CompensationForm,
    found: ErrorParameters,
    /// What the temperature does to the gyros x, y, z beside a bias that is linear in it.
    beyond_linear: [TemperatureModel; 3],
    /// Where the parameters come from, for people.
    source: String,
}

impl Parameters {
    /// The parameters that a scenario gives.
    ///
    /// # Errors
    /// [`CalibrationError::SingularSensitivity`] if their matrix has no inverse.
    pub(crate) fn given(
        form: CompensationForm,
        given: &CompensationParameters,
    ) -> Result<Self, CalibrationError> {
        let found = error_parameters(given);
        let coefficient = given.bias_deg_per_h_per_k.map(deg_per_h_to_deg_per_s);
        let compensation = Compensation::new(found)?
            .following_temperature(coefficient, given.reference_temperature_c);
        Ok(Self {
            compensation,
            form,
            found,
            beyond_linear: std::array::from_fn(|axis| TemperatureModel {
                reference_temperature_c: given.reference_temperature_c[axis],
                bias_deg_per_h_per_k: 0.0,
                bias_deg_per_h_per_k2: given.bias_deg_per_h_per_k2[axis],
                bias_deg_per_h_per_k_per_min: given.bias_deg_per_h_per_k_per_min[axis],
                scale_factor_ppm_per_k: given.scale_factor_ppm_per_k[axis],
            }),
            source: "given parameters".to_owned(),
        })
    }

    /// The parameters that a campaign has found.
    ///
    /// # Errors
    /// [`CalibrationError::SingularSensitivity`] if their matrix has no inverse.
    pub(crate) fn found(
        form: CompensationForm,
        calibration: &Calibration,
        source: String,
    ) -> Result<Self, CalibrationError> {
        Ok(Self {
            compensation: Compensation::of(calibration)?,
            form,
            found: calibration.parameters,
            beyond_linear: [TemperatureModel::default(); 3],
            source,
        })
    }

    /// Whether words follow the temperatures of the gyros.
    pub(crate) fn needs_temperature(&self) -> bool {
        let is_linear = self.beyond_linear.iter().all(TemperatureModel::is_flat);
        self.compensation.needs_temperature() || !is_linear
    }

    /// Whether biases follow the rates of the temperatures.
    pub(crate) fn needs_temperature_rate(&self) -> bool {
        let mut models = self.beyond_linear.iter();
        models.any(|model| model.bias_deg_per_h_per_k_per_min.abs() > 0.0)
    }

    /// Rates about the case axes for one word of each gyro, deg/h.
    ///
    /// * `warmth`: temperature of the gyros, which are one case, deg C, and its rate, K/min.
    pub(crate) fn rates_deg_per_h(
        &self,
        mut output_deg_per_h: [f64; 3],
        warmth: Option<(f64, f64)>,
    ) -> [f64; 3] {
        if let Some((temperature_c, rate_k_per_min)) = warmth {
            let models = self.beyond_linear.iter().zip(&mut output_deg_per_h);
            for (model, output) in models.filter(|(model, _)| !model.is_flat()) {
                *output = model.compensated(*output, temperature_c, rate_k_per_min);
            }
        }
        let output = output_deg_per_h.map(deg_per_h_to_deg_per_s);
        let temperature_c = warmth.map(|(temperature_c, _)| [temperature_c; 3]);
        let rates = self.compensation.rates(self.form, output, temperature_c);
        rates.map(deg_per_s_to_deg_per_h)
    }

    /// What the report shows of it.
    ///
    /// * `rate_deg_per_h`: mean true rates of the record.
    pub(crate) fn sheet(&self, rate_deg_per_h: [f64; 3]) -> CompensationSheet {
        let rate_deg_per_s = rate_deg_per_h.map(deg_per_h_to_deg_per_s);
        let left = |form| {
            let residual = self.compensation.residual(form, rate_deg_per_s);
            residual.map(deg_per_s_to_deg_per_h)
        };
        let angles = &self.found.misalignment_rad;
        CompensationSheet {
            form: self.form.word(),
            source: self.source.clone(),
            bias_deg_per_h: self.found.bias_deg_per_h(),
            scale_factor_error_ppm: self.found.scale_error.map(ratio_to_ppm),
            theta_arcsec: [
                ("xy", angles.xy),
                ("xz", angles.xz),
                ("yx", angles.yx),
                ("yz", angles.yz),
                ("zx", angles.zx),
                ("zy", angles.zy),
            ]
            .map(|(name, angle_rad)| (name, rad_to_arcsec(angle_rad))),
            follows_temperature: self.needs_temperature(),
            rate_deg_per_h,
            exact_residual_deg_per_h: left(CompensationForm::Exact),
            first_order_residual_deg_per_h: left(CompensationForm::FirstOrder),
        }
    }
}

/// The twelve parameters in the units of the calibration.
fn error_parameters(given: &CompensationParameters) -> ErrorParameters {
    ErrorParameters {
        scale_error: given.scale_factor_error_ppm.map(|error| MICRO * error),
        misalignment_rad: Misalignment {
            xy: arcsec_to_rad(given.theta_xy_arcsec),
            xz: arcsec_to_rad(given.theta_xz_arcsec),
            yx: arcsec_to_rad(given.theta_yx_arcsec),
            yz: arcsec_to_rad(given.theta_yz_arcsec),
            zx: arcsec_to_rad(given.theta_zx_arcsec),
            zy: arcsec_to_rad(given.theta_zy_arcsec),
        },
        bias_deg_per_s: given.bias_deg_per_h.map(deg_per_h_to_deg_per_s),
    }
}

/// The stage while it runs.
#[derive(Debug)]
pub(crate) struct Compensator {
    parameters: Parameters,
    /// One for all three gyros, whose coils share one temperature; none where no bias follows it.
    thermometer: Option<CoilThermometer>,
}

impl Compensator {
    /// The stage before the first sample of the warm-up.
    pub(crate) fn new(parameters: &Parameters, gyro: &GyroConfig, sample_period_s: f64) -> Self {
        let needs_temperature = parameters.needs_temperature();
        Self {
            parameters: parameters.clone(),
            thermometer: needs_temperature.then(|| CoilThermometer::new(gyro, sample_period_s)),
        }
    }

    /// The next words of the gyros x, y, z, compensated, deg/h.
    pub(crate) fn take(&mut self, raw_deg_per_h: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let [x, y, z] = raw_deg_per_h else {
            // The reader refuses a compensation without an assembly.
            return raw_deg_per_h.to_vec();
        };
        let mut compensated: [Vec<f64>; 3] = [x, y, z].map(|words| Vec::with_capacity(words.len()));
        for ((x, y), z) in x.iter().zip(y).zip(z) {
            let warmth = self.thermometer.as_mut().map(|coil| {
                let temperature_c = coil.next_c();
                (temperature_c, coil.rate_k_per_min())
            });
            let rates = self.parameters.rates_deg_per_h([*x, *y, *z], warmth);
            for (words, rate) in compensated.iter_mut().zip(rates) {
                words.push(rate);
            }
        }
        compensated.into()
    }
}
