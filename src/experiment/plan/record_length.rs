//! Whether the record of a plan holds a sample and fits into memory.

use super::checker::Checker;
use crate::experiment::run::count;
use crate::scenario::SamplesFormat;
use crate::signal::GyroFacts;
use crate::wording::plain;

/// Longest record held in memory, samples (two hours at 4 kHz).
const SAMPLES_MAX: f64 = 3.0e7;
/// Most words held in memory, truth and channels of every gyro together (1.44 GB): an hour at 4 kHz
/// of three axes with two filters, or two hours of one with four.
const WORDS_MAX: f64 = 1.8e8;

impl Checker<'_> {
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
