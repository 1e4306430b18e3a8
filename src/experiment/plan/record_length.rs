//! Whether the record of a plan holds a sample and fits into memory.

use super::checker::Checker;
use crate::experiment::run::count;
use crate::scenario::LogFacts;
use crate::scenario::{MotionClass, SamplesFormat};
use crate::signal::GyroFacts;
use crate::wording::{counted, plain};

/// Longest record held in memory, samples (two hours at 4 kHz).
const SAMPLES_MAX: f64 = 3.0e7;
/// Most words held in memory, truth and channels of every gyro together (1.44 GB): an hour at 4 kHz
/// of three axes with two filters, or two hours of one with four.
const WORDS_MAX: f64 = 1.8e8;

impl Checker<'_> {
    /// Refuses logs that are too long to hold with what their filters make of them, and settings that want
    /// several records.
    pub(crate) fn log_length(&mut self, log: &LogFacts) {
        let records = self.resolved.scenario.channel_names().len();
        let words = count(log.samples) * count(records);
        let scenario = &self.resolved.scenario;
        let needs = match scenario.measured_motion().class() {
            _ if !scenario.filters.is_empty() => Some("a filter needs every word"),
            MotionClass::Swing { .. } => Some("the phase of a swing needs every word"),
            _ => None,
        };
        if let Some(needs) = needs.filter(|_| log.has_gaps) {
            let message = format!(
                "log.file: samples are missing ({}), and {needs}: log.rows, or log.from_s and log.to_s, takes a \
                 part without gaps",
                counted(log.parts, "part")
            );
            self.complain("log.file", message);
        }
        if let MotionClass::Swing { frequency_hz, .. } = scenario.measured_motion().class()
            && frequency_hz > 0.25 * log.sample_rate_hz
        {
            let message = format!(
                "log.motion: a swing of {frequency_hz} Hz needs four samples a cycle: the log has {} Hz",
                plain(log.sample_rate_hz)
            );
            self.complain("log.motion", message);
        }
        if words > WORDS_MAX {
            self.complain(
                "log.file",
                format!(
                    "log.file holds {} samples, {words:.3e} words with what its filters make of them: at most                      {WORDS_MAX:e} are held in memory; use log.rows or fewer filters",
                    log.samples
                ),
            );
        }
    }

    /// Refuses records of no sample and those too long to hold.
    pub(crate) fn record_length(&mut self, facts: &GyroFacts) {
        let scenario = &self.resolved.scenario;
        let rate_hz = facts.output_rate_hz;
        let (duration_s, warm_up_s) = (scenario.duration_s, scenario.warm_up_s);
        if duration_s * rate_hz < 1.0 {
            self.complain(
                "duration_s",
                format!(
                    "duration_s = {duration_s} s holds no sample: one sample of this gyro takes \
                     {} s",
                    plain(1.0 / rate_hz)
                ),
            );
        }
        let samples = (duration_s + warm_up_s) * rate_hz;
        if samples > SAMPLES_MAX {
            self.complain(
                "duration_s",
                format!(
                    "duration_s + warm_up_s = {} s at {rate_hz:.2} Hz are {samples:.3e} samples: \
                     at most {SAMPLES_MAX:e} are held in memory; use `repeats`, or a larger \
                     gyro.output.average_samples",
                    plain(duration_s + warm_up_s)
                ),
            );
        }
        let records = scenario.channel_names().len() + scenario.axis_prefixes().len();
        let words = samples * count(records);
        if samples <= SAMPLES_MAX && words > WORDS_MAX {
            self.complain(
                "duration_s",
                format!(
                    "duration_s + warm_up_s = {} s at {rate_hz:.2} Hz are {words:.3e} words in \
                     {records} records (the true rate and the channels of every gyro): at most \
                     {WORDS_MAX:e} are held in memory; use `repeats`, fewer filters, or a larger \
                     gyro.output.average_samples",
                    plain(duration_s + warm_up_s)
                ),
            );
        }
        if scenario.repeats > 1 && scenario.output.samples != SamplesFormat::None {
            self.complain(
                "output.samples",
                format!(
                    "output.samples needs repeats = 1: {} repeats would write as many records to \
                     the same files",
                    scenario.repeats
                ),
            );
        }
    }
}
