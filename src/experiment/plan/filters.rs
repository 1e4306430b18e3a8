//! The checks of a plan that concern its filters.

use std::f64::consts::TAU;

use super::checker::Checker;
use crate::experiment::outside::{Outside, read_replay};
use crate::experiment::run::{RecordLength, rate_deg_per_h_max};
use crate::filters::{ExpectedRun, ExpectedWords, FilterConfig};
use crate::gyro;
use crate::scenario::{FilterState, MotionClass};
use crate::signal::GyroFacts;

/// Peak of the noise of a word that filters are to reckon with, standard deviations.
const PEAK_SIGMAS: f64 = 4.0;

impl Checker<'_> {
    /// Refuses filters that cannot be or cannot keep up, and warns of those that will not do well.
    pub(crate) fn filters(&mut self, words: &ExpectedWords) {
        let filters = &self.resolved.scenario.filters;
        for (index, filter) in filters.iter().enumerate() {
            self.words_from_outside(index, filter);
            let complaints = filter.check_on(index, words);
            if complaints.is_empty() {
                // No place: warnings stand in the results, which name no folder.
                self.warnings.extend(filter.notes(words));
            }
            for complaint in complaints {
                self.complain(&complaint.key, complaint.message);
            }
        }
    }

    /// Refuses words from outside that are not those of this record, or that no one record has, and
    /// programs that are to start afresh within theirs.
    fn words_from_outside(&mut self, index: usize, filter: &FilterConfig) {
        let Some(outside) = Outside::of(&filter.kind) else {
            return;
        };
        let scenario = &self.resolved.scenario;
        let table = format!("filter[{index}].{}", filter.kind.name());
        let is_reset = scenario.trial.filter_state == FilterState::Reset;
        let reset = is_reset.then_some(
            "trial.filter_state = \"reset\" starts filters afresh within the record: leave it out",
        );
        let several = match outside {
            Outside::Replay(_) => [
                scenario
                    .gyro
                    .assembly
                    .is_some()
                    .then_some("its words are those of one record, gyro.assembly has three"),
                (scenario.repeats > 1)
                    .then_some("its words are those of one record, repeats above 1 gives several"),
            ],
            Outside::Process(_) => [None, None],
        };
        let reasons = several.into_iter().chain([reset]).flatten();
        let mut complaints: Vec<(String, String)> = reasons
            .map(|reason| (table.clone(), format!("{table}: {reason}")))
            .collect();
        if let Outside::Replay(config) = outside {
            let key = format!("{table}.samples");
            let samples = RecordLength::of(self.resolved).total();
            let file = self.resolved.named_file(&key);
            let read = file.map(|file| read_replay(&file.path, &config.samples, samples));
            let lack = read.and_then(Result::err);
            complaints.extend(lack.map(|lack| (key.clone(), format!("{key} = {lack}"))));
        }
        for (key, message) in complaints {
            self.complain(&key, message);
        }
    }

    /// The words of the gyro, as far as they are known before it runs.
    pub(crate) fn expected_words(&self, facts: &GyroFacts) -> ExpectedWords {
        let scenario = &self.resolved.scenario;
        let rate_max_deg_per_h = rate_deg_per_h_max(scenario);
        let noise_std_deg_per_h = noise_std_deg_per_h(facts);
        let swing_step_rad = match scenario.turntable.motion.class() {
            MotionClass::Swing { frequency_hz, .. } => {
                Some(TAU * frequency_hz * gyro::sample_period_s(&scenario.gyro))
            }
            _ => None,
        };
        ExpectedWords {
            sample_rate_hz: facts.output_rate_hz,
            peak_deg_per_h: rate_max_deg_per_h + PEAK_SIGMAS * noise_std_deg_per_h,
            run: Some(ExpectedRun {
                rate_max_deg_per_h,
                swing_step_rad,
                noise_std_deg_per_h,
                warm_up_s: scenario.warm_up_s,
                duration_s: scenario.duration_s,
            }),
        }
    }
}

/// Standard deviation of white noise with the budget's angle random walk, deg/h.
fn noise_std_deg_per_h(facts: &GyroFacts) -> f64 {
    let total = facts
        .angle_random_walk_budget_deg_per_sqrt_h
        .iter()
        .find(|(source, _)| *source == "total")
        .map_or(0.0, |(_, value)| *value);
    crate::units::deg_per_sqrt_h_to_deg_per_h_sqrt_s(total) * facts.output_rate_hz.sqrt()
}
