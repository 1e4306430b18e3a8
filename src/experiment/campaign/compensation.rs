//! The compensation stage: from three words of an assembly to three compensated ones.

use crate::calibration::{
    Calibration, CalibrationError, Compensation, ErrorParameters, Misalignment,
};
use crate::gyro::CoilThermometer;
use crate::scenario::{CompensationParameters, GyroConfig};
use crate::signal::CompensationSheet;
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
            source,
        })
    }

    /// Whether the biases follow the temperatures of the gyros.
    pub(crate) fn needs_temperature(&self) -> bool {
        self.compensation.needs_temperature()
    }

    /// Rates about the case axes for one word of each gyro, deg/h.
    pub(crate) fn rates_deg_per_h(
        &self,
        output_deg_per_h: [f64; 3],
        temperature_c: Option<[f64; 3]>,
    ) -> [f64; 3] {
        let output = output_deg_per_h.map(deg_per_h_to_deg_per_s);
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
            follows_temperature: self.compensation.needs_temperature(),
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
        let needs_temperature = parameters.compensation.needs_temperature();
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
            let output = [*x, *y, *z].map(deg_per_h_to_deg_per_s);
            let temperature_c = self.thermometer.as_mut().map(|coil| [coil.next_c(); 3]);
            let Parameters {
                compensation, form, ..
            } = &self.parameters;
            let rates = compensation.rates(*form, output, temperature_c);
            for (words, rate) in compensated.iter_mut().zip(rates) {
                words.push(deg_per_s_to_deg_per_h(rate));
            }
        }
        compensated.into()
    }
}
