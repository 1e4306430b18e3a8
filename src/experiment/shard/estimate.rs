//! How long runs will take, from a short measurement of their parts on this machine.

use std::collections::BTreeMap;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

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
    // On one thread: the seconds are those of a core.
    match pool(1) {
        Ok(pool) => pool.install(|| of_plans(plans)),
        Err(_) => of_plans(plans),
    }
}

fn of_plans(plans: &[Plan]) -> f64 {
    let began = Instant::now();
    let mut known: BTreeMap<&str, f64> = BTreeMap::new();
    let (mut total_s, mut cost, mut unmeasured) = (0.0, 0.0, 0.0);
    for plan in plans {
        let name = plan.resolved().scenario.name.as_str();
        if !known.contains_key(name)
            && began.elapsed() < BUDGET
            && let Ok(word_s) = of_word(plan)
        {
            known.insert(name, word_s);
        }
        match known.get(name) {
            Some(word_s) => {
                total_s += word_s * words(plan);
                cost += plan.cost();
            }
            None => unmeasured += plan.cost(),
        }
    }
    if cost > 0.0 {
        total_s * (1.0 + unmeasured / cost)
    } else {
        total_s
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
