//! How long runs will take, from a short measurement of their parts on this machine.

use std::collections::BTreeMap;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use rayon::ThreadPool;

use crate::experiment::plan::Plan;
use crate::experiment::run::{Cut, RecordLength, Unfinished, allan_options, count, simulate};
use crate::experiment::suite::pool;
use crate::metrics::{Motion, Settings};

/// Words that are simulated of a scenario.
const WORDS: usize = 8192;
/// Time after which no further scenario is measured; the rest follows from the costs that plans are put in
/// order by.
const BUDGET: Duration = Duration::from_secs(2);

/// CPU seconds of one core that some plans will take, programs of the user's not counted.
#[must_use]
pub fn estimated_s(plans: &[Plan]) -> f64 {
    let mut estimate = Estimate::default();
    plans.iter().for_each(|plan| estimate.add(plan));
    estimate.seconds()
}

/// CPU seconds of one core for plans that are seen one after the other.
#[derive(Default)]
pub(super) struct Estimate {
    /// Seconds for a word by scenario; none of one that could not be measured.
    of_word: BTreeMap<String, Option<f64>>,
    /// One thread, so that the seconds are those of a core.
    thread: Option<ThreadPool>,
    measuring: Duration,
    total_s: f64,
    cost: f64,
    unmeasured_cost: f64,
}

impl Estimate {
    /// Takes in one more plan, and measures the first of a scenario.
    pub(super) fn add(&mut self, plan: &Plan) {
        let name = plan.resolved().scenario.name.as_str();
        if !self.of_word.contains_key(name) && self.measuring < BUDGET {
            let began = Instant::now();
            let word_s = self.measure(plan);
            self.measuring += began.elapsed();
            self.of_word.insert(name.to_owned(), word_s);
        }
        match self.of_word.get(name).copied().flatten() {
            Some(word_s) => {
                self.total_s += word_s * words(plan);
                self.cost += plan.cost();
            }
            None => self.unmeasured_cost += plan.cost(),
        }
    }

    fn measure(&mut self, plan: &Plan) -> Option<f64> {
        if self.thread.is_none() {
            self.thread = pool(1).ok();
        }
        let measured = match &self.thread {
            Some(thread) => thread.install(|| of_word(plan)),
            None => of_word(plan),
        };
        measured.ok()
    }

    /// What all of them will take.
    pub(super) fn seconds(&self) -> f64 {
        if self.cost > 0.0 {
            self.total_s * (1.0 + self.unmeasured_cost / self.cost)
        } else {
            self.total_s
        }
    }
}

/// Output words of one gyro over all repeats.
fn words(plan: &Plan) -> f64 {
    plan.simulated_s() / plan.sample_period_s()
}

/// Seconds for one word of a plan: simulated, filtered, and measured in each channel.
fn of_word(plan: &Plan) -> Result<f64, Unfinished> {
    let scenario = &plan.resolved().scenario;
    let length = RecordLength {
        warm_up: 0,
        measured: RecordLength::new(scenario, plan.sample_period_s())
            .total()
            .clamp(1, WORDS),
    };
    let began = Instant::now();
    let simulation = simulate(scenario, length, 0, None, &())?;
    let simulated_s = began.elapsed().as_secs_f64();
    let settings = Settings {
        motion: Motion::Steady,
        bias_averaging_time_s: scenario.bias_averaging_time_s,
        fit_tau_min_s: plan.fit_tau_min_s(),
        allan: allan_options(scenario.allan),
        bridges: Vec::new(),
    };
    let began = Instant::now();
    let measured = simulation.gyros.first().map(|record| {
        let cut = Cut {
            record,
            encoder_rad: None,
            length,
            sample_period_s: plan.sample_period_s(),
            settings: &settings,
            drift: None,
            black_box: None,
            motion: OnceLock::new(),
        };
        cut.measure_raw()
    });
    drop(measured);
    let measured_s = began.elapsed().as_secs_f64() * count(plan.channel_names().len());
    Ok((simulated_s + measured_s) / count(length.total()))
}
