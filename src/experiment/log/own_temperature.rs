//! What the temperature does to one gyro, as another log has shown it, taken out of recorded words.

use std::path::Path;

use super::compensation::CompensatedLog;
use crate::experiment::run::stamp_s;
use crate::metrics::{WarmRecord, words_at_reference};
use crate::recording::{Log, LogFormat};
use crate::scenario::{
    ScenarioError, TemperatureParameters, TemperatureTables, load_log_temperature,
};
use crate::signal::TemperatureModel;
use crate::wording::plain;

/// Kelvins beyond the temperatures of the fit from which the coefficients are extrapolated.
const BEYOND_K: f64 = 1.0;

/// What is said where the rate of the temperature has no effect.
pub(super) const RATE_NOT_TOLD: &str = "the rate of the temperature is not told from the noise of its readings and \
                                        taken to be 0: the coefficient on it has no effect";

/// Coefficients of a calibration file, to be taken out of the words of one gyro.
#[derive(Clone, Debug)]
pub struct LogTemperature {
    model: TemperatureModel,
    /// Temperatures that they were fitted to, deg C, where that is known.
    fitted_c: Option<(f64, f64)>,
    /// Name of the table.
    table: String,
    /// Name of the file and its digest, for people; none beside what says so.
    source: Option<String>,
}

/// The coefficients that the calibration of a log of one gyro has; nothing of a log without one.
///
/// # Errors
/// Every complaint about the file; a calibration that does nothing, or has no table of the gyro.
pub fn load_own_temperature(
    format: &LogFormat,
) -> Result<Option<LogTemperature>, Vec<ScenarioError>> {
    let Some((parameters, digest)) = load_log_temperature(format)? else {
        return Ok(None);
    };
    let path = Path::new(format.calibration.as_deref().unwrap_or_default());
    let file = path
        .file_name()
        .unwrap_or(path.as_os_str())
        .to_string_lossy();
    let table = TemperatureTables::name(format.axis);
    Ok(Some(LogTemperature {
        source: Some(format!("[{table}] of {file} (BLAKE3 {})", &digest[..16])),
        ..LogTemperature::of(&parameters, table)
    }))
}

/// Takes the effect of the temperature out of the words of a log.
#[must_use]
pub fn compensate_temperature(log: Log, temperature: &LogTemperature) -> CompensatedLog {
    let (words, said) = temperature.words(&log, &log.temperature_c);
    let source = temperature.source.iter();
    let notes = source.map(|source| format!("channel compensated: {source}"));
    let notes = notes.chain(said).collect();
    let mut own = log.with_words(words);
    own.take_about_common_mean();
    CompensatedLog {
        words: own.rate_deg_per_h,
        log,
        notes,
    }
}

impl LogTemperature {
    fn of(parameters: &TemperatureParameters, table: String) -> Self {
        Self {
            model: parameters.model(),
            fitted_c: parameters.lowest_c.zip(parameters.highest_c),
            table,
            source: None,
        }
    }

    /// The words of a log as they would be at the reference temperature, and what is worth saying.
    fn words(&self, log: &Log, temperature_c: &[f64]) -> (Vec<f64>, Vec<String>) {
        let record = warm_record(log, temperature_c);
        let table = &self.table;
        let Some(found) = words_at_reference(&self.model, &record) else {
            let note = format!("[{table}] has no effect: no temperature is known");
            return (log.rate_deg_per_h.clone(), vec![note]);
        };
        let mut notes = Vec::new();
        let (low_c, high_c) = found.range_c;
        if let Some((lowest_c, highest_c)) = self.fitted_c
            && (low_c < lowest_c - BEYOND_K || high_c > highest_c + BEYOND_K)
        {
            notes.push(format!(
                "[{table}] is extrapolated: fitted from {} to {} C, and the log has {} to {} C",
                plain(lowest_c),
                plain(highest_c),
                tenths(low_c),
                tenths(high_c)
            ));
        }
        if !found.tells_rate && self.model.bias_deg_per_h_per_k_per_min.abs() > 0.0 {
            notes.push(RATE_NOT_TOLD.to_owned());
        }
        (found.words_deg_per_h, notes)
    }
}

/// A log with temperatures at its words.
pub(super) fn warm_record<'a>(log: &'a Log, temperature_c: &'a [f64]) -> WarmRecord<'a> {
    let sample_period_s = log.sample_period_s();
    WarmRecord {
        words_deg_per_h: &log.rate_deg_per_h,
        truth_deg_per_h: &[],
        temperature_c,
        sample_period_s,
        first_stamp_s: stamp_s(0, sample_period_s),
        swing_hz: None,
    }
}

/// A temperature as people read it.
fn tenths(temperature_c: f64) -> String {
    plain((10.0 * temperature_c).round() / 10.0)
}
