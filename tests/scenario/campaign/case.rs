//! One drawn scenario on its way from draft to checked results.

use std::collections::BTreeMap;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use fogbench::experiment::{Plan, SuiteOptions, SuiteOutcome, plan_suite, run_suite};
use fogbench::scenario::{Fidelity, NoiseDraw, ScenarioError};

use super::draft::Draft;
use super::hints;
use super::invariants::{self, Listener};
use super::schema::{self, Leaf, Table};
use super::values::{self, Setting, toml};
use crate::support::seeded::Draws;

/// How often a refused scenario is mended before it is given up.
const ROUNDS_MAX: usize = 60;

/// How often a needed key is redrawn before the part that needs it goes.
const REDRAWS_MAX: u32 = 6;

/// Largest work of a run, half periods of the loop or words, all repeats and gyros together.
const STEPS_MAX: f64 = 2.0e5;

/// Most output samples of a run, filters counted by the square of their taps.
const SAMPLES_MAX: f64 = 8.0e5;

/// What is wrong with a case.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Fault {
    /// The same for the same defect: kind and place.
    pub(crate) key: String,
    /// What was seen.
    pub(crate) message: String,
}

impl Fault {
    pub(crate) fn new(key: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            key: key.into(),
            message: message.into(),
        }
    }
}

/// Why a draft does not run.
pub(crate) enum Refusal {
    /// Every mending ended in another refusal, the last of which is told.
    Refused(String),
    /// It cannot be made short.
    TooLong,
    /// The reader itself broke.
    Broken(Fault),
}

/// A folder for the files of one case.
pub(crate) struct Workshop {
    folder: tempfile::TempDir,
}

impl Workshop {
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().expect("a scratch folder");
        let motion = "time_s,rate_deg_per_s\n0,0\n0.01,10\n0.02,-500\n1,2000\n1000,0\n";
        fs::write(folder.path().join("motion.csv"), motion).expect("writable");
        Self { folder }
    }

    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Plans a draft.
    pub(crate) fn plan(&self, draft: &Draft) -> Result<Vec<Plan>, Complaint> {
        let file = self.path().join("case.toml");
        fs::write(&file, draft.render().0).expect("writable");
        self.plan_file(&file)
    }

    /// Plans a file.
    pub(crate) fn plan_file(&self, file: &Path) -> Result<Vec<Plan>, Complaint> {
        let paths = [file.to_owned()];
        match caught(|| plan_suite(&paths, &[])) {
            Ok(Ok(plans)) => Ok(plans),
            Ok(Err(errors)) => Err(Complaint::Errors(errors)),
            Err(fault) => Err(Complaint::Broken(fault)),
        }
    }

    /// Runs plans into a folder of this name and checks what they leave there.
    pub(crate) fn run(&self, plans: &[Plan], name: &str, threads: usize) -> Result<Ran, Fault> {
        let output = self.path().join(name);
        let options = SuiteOptions {
            threads,
            ..SuiteOptions::new(output.clone())
        };
        let listener = Listener::default();
        let outcome = caught(|| run_suite(plans, &options, &listener))?
            .map_err(|error| Fault::new("suite error", error.to_string()))?;
        invariants::check(&outcome, &listener, &output)?;
        Ok(Ran { outcome, output })
    }
}

/// What came of a run.
pub(crate) struct Ran {
    pub(crate) outcome: SuiteOutcome,
    pub(crate) output: PathBuf,
}

/// Why a file gives no plans.
pub(crate) enum Complaint {
    Errors(Vec<ScenarioError>),
    Broken(Fault),
}

/// Runs something that must not panic.
pub(crate) fn caught<T>(run: impl FnOnce() -> T) -> Result<T, Fault> {
    invariants::forget_panics();
    catch_unwind(AssertUnwindSafe(run)).map_err(|_| invariants::panic_fault("panic"))
}

/// Mends a draft until it is accepted and short.
pub(crate) fn accept(
    workshop: &Workshop,
    draft: &mut Draft,
    draws: &mut Draws,
    setting: Setting,
    table: &Table,
) -> Result<Vec<Plan>, Refusal> {
    let leaves = schema::leaves(table);
    let mut last = String::new();
    let mut shortened = 0;
    for _ in 0..ROUNDS_MAX {
        match workshop.plan(draft) {
            Ok(plans) => {
                let excess = excess(&plans);
                if excess <= 1.0 {
                    return Ok(plans);
                }
                shortened += 1;
                if shortened > 6 {
                    return Err(Refusal::TooLong);
                }
                shorten(draft, draws, excess, &leaves);
            }
            Err(Complaint::Broken(fault)) => return Err(Refusal::Broken(fault)),
            Err(Complaint::Errors(errors)) => {
                last = errors.first().map(ToString::to_string).unwrap_or_default();
                let duration_s = draft
                    .value("duration_s")
                    .and_then(|value| value.parse().ok());
                let setting = Setting {
                    duration_s: duration_s.unwrap_or(setting.duration_s),
                    ..setting
                };
                if !mend(draft, draws, &errors, setting, &leaves) {
                    break;
                }
            }
        }
    }
    Err(Refusal::Refused(last))
}

/// Takes the way out that a complaint offers, redraws the blamed keys or takes them away; any, if
/// none is blamed. Whether there was anything to do.
fn mend(
    draft: &mut Draft,
    draws: &mut Draws,
    errors: &[ScenarioError],
    setting: Setting,
    leaves: &BTreeMap<String, Leaf>,
) -> bool {
    let offered = errors
        .iter()
        .any(|error| hints::way_out(draft, draws, &error.message));
    if offered {
        return true;
    }
    let mut blamed = draft.blamed(errors);
    if blamed.is_empty() {
        let free = |needed: bool| {
            (0..draft.lines.len())
                .filter(|&index| draft.may_change(index) && draft.lines[index].is_needed == needed)
                .collect::<Vec<usize>>()
        };
        let others = [free(false), free(true)];
        let Some(others) = others.iter().find(|others| !others.is_empty()) else {
            return false;
        };
        blamed.push(*draws.pick(others));
    }
    for index in blamed {
        // A removed part may have taken others with it.
        if index < draft.lines.len() {
            redraw_or_remove(draft, draws, index, setting, leaves);
        }
    }
    true
}

/// Gives a needed key a milder value, a few times; everything else goes.
fn redraw_or_remove(
    draft: &mut Draft,
    draws: &mut Draws,
    index: usize,
    setting: Setting,
    leaves: &BTreeMap<String, Leaf>,
) {
    let count = draft.count_beside(index, draws);
    let line = &mut draft.lines[index];
    line.blamed += 1;
    let leaf = leaves.get(&line.schema_path);
    let is_time = leaf.is_some_and(|leaf| leaf.unit.as_deref() == Some("s"));
    // A time that does not fit is too long, but an array of times lasts as long as the record.
    let shorter = if is_time && !line.value.starts_with('[') {
        draws.log_uniform(0.02, 1.0)
    } else {
        1.0
    };
    let milder = Setting {
        extreme: 0.0,
        duration_s: setting.duration_s * shorter,
        count,
    };
    match leaf.and_then(|leaf| values::value(draws, leaf, milder)) {
        Some(value) if line.is_needed && line.blamed <= REDRAWS_MAX => line.value = value,
        _ => draft.remove(index),
    }
}

/// Work of the plans over what a case may cost.
fn excess(plans: &[Plan]) -> f64 {
    let mut steps = 0.0;
    let mut samples = 0.0;
    for plan in plans {
        let scenario = &plan.resolved().scenario;
        let output = &scenario.gyro.output;
        let rate_hz = plan.facts().expect("a simulation").output_rate_hz;
        let records = (plan.channel_names().len() + scenario.axis_prefixes().len()) as f64;
        let words = plan.simulated_s() * rate_hz * f64::from(output.average_samples) * records;
        let draws = match (scenario.fidelity, scenario.gyro.noise.draw) {
            (Fidelity::Rate, _) => 1.0,
            (Fidelity::Loop, NoiseDraw::Combined) => f64::from(output.half_periods_per_sample),
            (Fidelity::Loop, NoiseDraw::Exact) => {
                f64::from(output.half_periods_per_sample)
                    * f64::from(scenario.gyro.adc.samples_per_half_period)
            }
        };
        steps += words * draws;
        // Sixty-four taps cost as much in every adaptive filter.
        samples += plan.simulated_s() * rate_hz * records * 64.0;
    }
    (steps / STEPS_MAX).max(samples / SAMPLES_MAX)
}

/// Shortens the record, and every time with it.
fn shorten(draft: &mut Draft, draws: &mut Draws, excess: f64, leaves: &BTreeMap<String, Leaf>) {
    let factor = (1.0 / excess).max(1e-6) * draws.log_uniform(0.1, 1.0);
    if draft.value("repeats") != Some("1") {
        draft.set("repeats", "1".to_owned());
    }
    for line in &mut draft.lines {
        let unit = leaves
            .get(&line.schema_path)
            .and_then(|leaf| leaf.unit.as_deref());
        let scale = match unit {
            Some("s") => factor,
            Some("Hz") if line.is_needed => 1.0 / factor,
            _ => continue,
        };
        let items = line.value.trim_matches(['[', ']']).split(", ");
        let scaled: Option<Vec<String>> = items
            .map(|item| Some(toml(item.parse::<f64>().ok()? * scale)))
            .collect();
        let Some(scaled) = scaled else { continue };
        line.value = if line.value.starts_with('[') {
            format!("[{}]", scaled.join(", "))
        } else {
            scaled.concat()
        };
    }
}
