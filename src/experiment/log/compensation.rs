//! A calibration applied to the recorded words of three gyros.

use std::path::Path;

use super::own_temperature::{RATE_NOT_TOLD, warm_record};
use crate::experiment::campaign::Parameters;
use crate::metrics::temperature_rates_k_per_min;
use crate::recording::{AssemblyLog, Log};
use crate::scenario::{Location, ScenarioError, load_calibration};
use crate::vocabulary::CompensationForm;

/// The parameters of a calibration file, to be taken out of a log.
#[derive(Clone, Debug)]
pub struct LogCompensation {
    parameters: Parameters,
    /// Name of the file, its digest and the form, for people.
    source: String,
}

/// Reads a calibration file.
///
/// # Errors
/// Every complaint about the file; parameters whose matrix has no inverse.
pub fn load_log_compensation(
    path: &Path,
    form: CompensationForm,
) -> Result<LogCompensation, Vec<ScenarioError>> {
    let (parameters, digest) = load_calibration(path)?;
    let words = match form {
        CompensationForm::Exact => "exact inverse",
        CompensationForm::FirstOrder => "first-order form",
    };
    let parameters = Parameters::given(form, &parameters).map_err(|error| {
        let location = Location::of_file(path.display().to_string());
        vec![ScenarioError::at(location, error.to_string())]
    })?;
    let file = path.file_name().unwrap_or(path.as_os_str());
    let file = file.to_string_lossy();
    Ok(LogCompensation {
        parameters,
        source: format!("{words} with {file} (BLAKE3 {})", &digest[..16]),
    })
}

/// One axis of a log with the constant errors of the assembly taken out.
#[derive(Clone, Debug)]
pub struct CompensatedLog {
    /// The words of the gyro as they were recorded.
    pub(crate) log: Log,
    /// Rates about the case axis of the same name, deg/h.
    pub(crate) words: Vec<f64>,
    /// What was done.
    pub(crate) notes: Vec<String>,
}

/// Takes the constant errors of an assembly out of the words of its gyros x, y, z.
///
/// * `axis`: the one that is kept, 0 to 2. Without temperatures the biases stay at their reference.
#[must_use]
pub fn compensate_log(
    assembly: AssemblyLog,
    compensation: &LogCompensation,
    axis: usize,
) -> CompensatedLog {
    let [x, y, z] = &assembly.gyros;
    let parameters = &compensation.parameters;
    let temperature_c = assembly.temperature_c.as_deref();
    let rates = match (parameters.needs_temperature_rate(), temperature_c) {
        (true, Some(temperature_c)) => temperature_rates_k_per_min(&warm_record(x, temperature_c)),
        _ => None,
    };
    let words = (0..x.rate_deg_per_h.len()).map(|sample| {
        let output = [x, y, z].map(|log| log.rate_deg_per_h[sample]);
        let rate = rates.as_ref().map_or(0.0, |rates| rates[sample]);
        let warmth = temperature_c.map(|all| (all[sample], rate));
        parameters.rates_deg_per_h(output, warmth)[axis]
    });
    let words = words.collect();
    let mut notes = vec![format!("channel compensated: {}", compensation.source)];
    match (parameters.needs_temperature(), temperature_c) {
        (true, None) => notes.push(
            "the calibration has temperature coefficients of the biases, which are left at their \
             reference temperatures: name the column of the temperature with --temperature-column"
                .to_owned(),
        ),
        (false, Some(_)) => notes.push(
            "the calibration has no temperature coefficient: the temperature column has no effect"
                .to_owned(),
        ),
        (true, Some(_)) if parameters.needs_temperature_rate() && rates.is_none() => {
            notes.push(RATE_NOT_TOLD.to_owned());
        }
        _ => {}
    }
    let [x, y, z] = assembly.gyros;
    let log = match axis {
        0 => x,
        1 => y,
        _ => z,
    };
    CompensatedLog { log, words, notes }
}
