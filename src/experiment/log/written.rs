//! What is printed and written of a recorded log.

use super::trial::{COMPENSATED, LogTrial, RAW};
use crate::experiment::build::VERSION;
use crate::experiment::output_file::write_file;
use crate::metrics::{Unavailable, noise_state_space};
use crate::report::{
    KalmanReport, LogReport, TemperatureReport, TemperatureTableError, kalman_json, log_files,
    with_temperature,
};
use crate::scenario::{TemperatureParameters, WITHOUT_OUTLIERS};
use crate::seal::digest_of_words;
use crate::signal::RunSignals;
use crate::store::{OutputFolder, StoreError};

impl LogTrial {
    /// Gives the report of the trial, printed or written, to `then`.
    pub fn with_report<T>(&self, then: impl FnOnce(&LogReport) -> T) -> T {
        let unit = self.log.unit.to_string();
        let filters = self.source.as_ref();
        then(&LogReport {
            tool_version: VERSION,
            file: &self.log.file,
            column: self.log.column.as_deref(),
            unit: &unit,
            sample_rate_hz: self.log.sample_rate_hz,
            samples: self.present(),
            warm_up_samples: self.length.warm_up,
            filters: filters.map(|(file, digest)| (file.as_str(), digest.as_str())),
            motion: &self.motion,
            channels: &self.channels,
            verdicts: &self.verdicts,
            notes: &self.notes,
        })
    }

    /// Words that were measured, missing ones not counted.
    fn present(&self) -> usize {
        // Those of a log that streamed are not kept, and none of them is missing.
        let kept = self.record.raw_deg_per_h.get(self.length.warm_up..);
        let missing = kept.unwrap_or_default().iter().filter(|word| word.is_nan());
        self.length.measured - missing.count()
    }

    /// The noise of the words as a linear system, JSON; that without outliers where there are any.
    ///
    /// # Errors
    /// Why the words have no fit of noise terms.
    pub fn kalman(&self) -> Result<String, Unavailable> {
        let clean = format!("{RAW}{WITHOUT_OUTLIERS}");
        let mut channels = self.channels.iter();
        let clean = channels.find(|(name, _)| *name == clean);
        let (_, raw) = clean.unwrap_or(&self.channels[0]);
        let system = noise_state_space(raw)?;
        Ok(kalman_json(&KalmanReport {
            tool_version: VERSION,
            file: &self.log.file,
            system: &system,
        }))
    }

    /// What the temperature does to the words, as a table of a calibration file that keeps all else that it
    /// holds.
    ///
    /// * `file`: what the file holds, nothing of one that is not there. The axis of the log names the table.
    ///
    /// # Errors
    /// Words without a significant coefficient; a file whose table is not replaced.
    pub fn temperature_toml(&self, file: &str) -> Result<String, TemperatureTableError> {
        let Some(fitted) = &self.temperature else {
            return Err(TemperatureTableError::NoCoefficient);
        };
        let (lowest_c, highest_c) = fitted.range_c;
        let fitted_c = [Some(lowest_c), Some(highest_c)];
        let report = TemperatureReport {
            tool_version: VERSION,
            file: &self.log.file,
            column: self.log.column.as_deref(),
            axis: self.log.format.axis,
            parameters: &TemperatureParameters::of(&fitted.model, fitted_c),
        };
        with_temperature(file, &report)
    }

    /// Writes `summary.json`, curves and pictures into `folder`, and the words of every filter
    /// below `samples/` as NPY, with `as_csv` as CSV as well; in place of what stood there, as one.
    ///
    /// # Errors
    /// Whatever the file system says, with the path.
    pub fn write(&self, folder: &OutputFolder, as_csv: bool) -> Result<(), StoreError> {
        let staged = folder.stage()?;
        for file in self.with_report(|report| log_files(report, &self.signals(), as_csv)) {
            write_file(&staged, &file)?;
        }
        staged.seal_plainly()?;
        staged.put_files_in_place()
    }

    /// The words of the filters that did not fail.
    fn filter_words(&self) -> impl Iterator<Item = (&str, &[f64])> {
        self.filters.iter().filter_map(|filter| {
            let words = filter.words.as_ref().ok()?;
            Some((filter.name.as_str(), words.output_deg_per_h.as_slice()))
        })
    }

    fn compensated_words(&self) -> Option<(&str, &[f64])> {
        let words = self.record.compensated_deg_per_h.as_deref();
        words.map(|words| (COMPENSATED, words))
    }

    fn signals(&self) -> RunSignals<'_> {
        let raw = (RAW, self.record.raw_deg_per_h.as_slice());
        RunSignals {
            sample_period_s: self.log.sample_period_s(),
            first_measured: self.length.warm_up,
            prefix: "",
            truth_deg_per_h: self.record.truth_deg_per_h.rates(),
            encoder_rad: None,
            input_digest: (!self.filters.is_empty())
                .then(|| digest_of_words(self.record.filter_input_deg_per_h())),
            channels: std::iter::once(raw)
                .chain(self.compensated_words())
                .chain(self.filter_words())
                .collect(),
            temperature: None,
        }
    }
}
