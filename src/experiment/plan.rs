//! From scenario files to checked plans: the checks that need physics or metrics.

use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::path::PathBuf;
use std::sync::Arc;

use super::campaign;
use super::comparison::contradictions;
use super::compensation::CompensationPlan;
use super::motion::motion_extremes;
use crate::gyro;
use crate::scenario::{
    Fidelity, Reading, Resolved, ScenarioError, UnsoundReading, in_both, in_order, read_suite,
};
use crate::signal::GyroFacts;

/// Most scenarios of a suite that are not sound and are checked further: nobody reads on.
const UNSOUND_MAX: usize = 100;

/// One run that has passed every check.
#[derive(Clone, Debug)]
pub struct Plan {
    resolved: Resolved,
    facts: GyroFacts,
    warnings: Vec<String>,
    compensation: Option<CompensationPlan>,
    calibration: Option<String>,
}

impl Plan {
    /// The resolved scenario.
    #[must_use]
    pub fn resolved(&self) -> &Resolved {
        &self.resolved
    }

    /// The gyro in closed form.
    #[must_use]
    pub fn facts(&self) -> &GyroFacts {
        &self.facts
    }

    /// What is allowed but worth saying.
    #[must_use]
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// What a calibration campaign can determine, in a sentence.
    #[must_use]
    pub fn calibration(&self) -> Option<&str> {
        self.calibration.as_deref()
    }

    /// Channels in order, raw ones first.
    #[must_use]
    pub fn channel_names(&self) -> Vec<String> {
        self.resolved.scenario.channel_names()
    }

    /// What is taken out of the outputs.
    pub(super) fn compensation(&self) -> Option<&CompensationPlan> {
        self.compensation.as_ref()
    }

    /// Period of the output samples, s.
    pub(super) fn sample_period_s(&self) -> f64 {
        gyro::sample_period_s(&self.resolved.scenario.gyro)
    }

    /// Shortest averaging time that sees the white noise of the gyro and not the low pass of loop
    /// and averager, s: ten samples and 20 time constants of the loop.
    pub(super) fn fit_tau_min_s(&self) -> f64 {
        const SAMPLES: f64 = 10.0;
        const TIME_CONSTANTS: f64 = 20.0;
        let time_constant_s = 1.0 / (TAU * self.facts.loop_bandwidth_hz);
        (SAMPLES * self.sample_period_s()).max(TIME_CONSTANTS * time_constant_s)
    }

    /// Gyro time of all repeats, s.
    #[must_use]
    pub fn simulated_s(&self) -> f64 {
        let scenario = &self.resolved.scenario;
        f64::from(scenario.repeats) * (scenario.warm_up_s + scenario.duration_s)
    }

    /// Relative cost of the run, for the order of work only.
    pub(super) fn cost(&self) -> f64 {
        const LOOP_COST: f64 = 10.0;
        let gyros = count(self.resolved.scenario.axis_prefixes().len());
        let words = gyros * self.simulated_s() / gyro::word_period_s(&self.resolved.scenario.gyro);
        match self.resolved.scenario.fidelity {
            Fidelity::Loop => LOOP_COST * words,
            Fidelity::Rate => words,
        }
    }
}

/// Reads and checks everything under `paths`, `--set` overrides applied.
///
/// # Errors
/// Every complaint about every file; then nothing may run.
pub fn plan_suite(paths: &[PathBuf], sets: &[String]) -> Result<Vec<Plan>, Vec<ScenarioError>> {
    gather_plans(&|take| read_suite(paths, sets, take))
}

/// Hands over each run that was read, sound or not; returns the complaints of the reader.
pub(super) type Read<'a> = dyn Fn(&mut dyn FnMut(Reading)) -> Vec<ScenarioError> + 'a;

/// Checks everything that `read` reads.
///
/// # Errors
/// Every complaint about every run.
pub(super) fn gather_plans(read: &Read) -> Result<Vec<Plan>, Vec<ScenarioError>> {
    let mut plans = Vec::new();
    let errors = visit_plans(read, &mut |plan| plans.push(plan));
    compared(plans, errors)
}

/// The plans of a suite in their order, if they do not contradict one another and nothing was wrong
/// before.
pub(super) fn compared(
    mut plans: Vec<Plan>,
    mut errors: Vec<ScenarioError>,
) -> Result<Vec<Plan>, Vec<ScenarioError>> {
    // By folder, so that the order of the arguments leaves no trace in the results.
    plans.sort_by_cached_key(|plan: &Plan| plan.resolved.folder());
    errors.extend(contradictions(&plans));
    if errors.is_empty() {
        Ok(plans)
    } else {
        Err(in_order(errors))
    }
}

/// Hands over each run that `read` reads and that passes its own checks; returns the complaints about
/// the others.
pub(super) fn visit_plans(read: &Read, visit: &mut dyn FnMut(Plan)) -> Vec<ScenarioError> {
    let (mut found, mut known) = (Vec::new(), BTreeSet::new());
    let mut campaigns = SoundCampaigns::default();
    let mut unsound_count = 0;
    let mut errors = read(&mut |reading| {
        let more = match reading {
            Ok(resolved) => match plan(resolved, &mut campaigns) {
                Ok(plan) => return visit(plan),
                Err(more) => more,
            },
            Err(reading) => {
                unsound_count += 1;
                if unsound_count > UNSOUND_MAX {
                    return;
                }
                unsound(reading, &mut campaigns)
            }
        };
        // The points of a sweep share most of what is wrong with them.
        found.extend(more.into_iter().filter(|error| known.insert(error.clone())));
    });
    errors.extend(found);
    errors
}

/// What else is wrong with a scenario that is not sound: the complaints that all its variants give.
fn unsound(reading: UnsoundReading, campaigns: &mut SoundCampaigns) -> Vec<ScenarioError> {
    let mut variants = reading.variants.into_iter().map(|resolved| {
        if reading.is_contradictory {
            let mut checker = Checker::new(&resolved);
            checker.names();
            checker.errors
        } else {
            plan(resolved, campaigns).err().unwrap_or_default()
        }
    });
    let first = variants.next().unwrap_or_default();
    variants.fold(first, |common, found| in_both(common, &found))
}

/// The campaign that passed its checks last: the points of a sweep share one.
#[derive(Default)]
struct SoundCampaigns(Option<Arc<Resolved>>);

impl SoundCampaigns {
    /// Checks a campaign unless it has just been checked.
    fn check(&mut self, campaign: &Arc<Resolved>) -> Result<(), Vec<ScenarioError>> {
        let is_last = |last: &Arc<Resolved>| Arc::ptr_eq(last, campaign);
        if !self.0.as_ref().is_some_and(is_last) {
            plan(Resolved::clone(campaign), &mut Self::default())?;
            self.0 = Some(Arc::clone(campaign));
        }
        Ok(())
    }
}

fn plan(resolved: Resolved, campaigns: &mut SoundCampaigns) -> Result<Plan, Vec<ScenarioError>> {
    let mut checker = Checker::new(&resolved);
    checker.names();
    let facts = checker.gyro();
    let compensation = checker.compensation(campaigns);
    if let Some(facts) = &facts {
        checker.gyro_limits();
        checker.record_length(facts);
        checker.campaign();
        checker.filters(facts);
        checker.metrics(facts);
    }
    let Checker {
        errors,
        warnings,
        calibration,
        ..
    } = checker;
    match facts {
        Some(facts) if errors.is_empty() => Ok(Plan {
            resolved,
            facts,
            warnings,
            compensation,
            calibration,
        }),
        _ => Err(errors),
    }
}

/// Collects every complaint about one run.
pub(super) struct Checker<'a> {
    pub(super) resolved: &'a Resolved,
    errors: Vec<ScenarioError>,
    pub(super) warnings: Vec<String>,
    calibration: Option<String>,
}

impl<'a> Checker<'a> {
    fn new(resolved: &'a Resolved) -> Self {
        Self {
            resolved,
            errors: Vec::new(),
            warnings: resolved.warnings.clone(),
            calibration: None,
        }
    }
}

impl Checker<'_> {
    pub(super) fn complain(&mut self, key: &str, message: String) {
        self.errors
            .push(ScenarioError::at(self.resolved.locate(key), message));
    }

    fn gyro(&mut self) -> Option<GyroFacts> {
        gyro::facts(&self.resolved.scenario.gyro)
            .map_err(|error| self.complain(error.key(), format!("{}: {error}", error.key())))
            .ok()
    }

    /// Refuses parameters that no rates follow from, and campaigns that cannot be run.
    fn compensation(&mut self, campaigns: &mut SoundCampaigns) -> Option<CompensationPlan> {
        const CAMPAIGN: &str = "compensation.campaign_scenario";
        const PARAMETERS: &str = "compensation.parameters";
        if let Some(campaign) = &self.resolved.campaign {
            if campaign::campaign(&campaign.scenario).is_none() {
                let name = &campaign.scenario.name;
                let message = format!(
                    "compensation.campaign: the scenario {name} is no calibration: it has no \
                     [turntable.calibration]"
                );
                self.complain(CAMPAIGN, message);
                return None;
            }
            if let Err(errors) = campaigns.check(campaign) {
                self.errors.extend(errors);
                return None;
            }
        }
        CompensationPlan::of(self.resolved)
            .map_err(|error| self.complain(PARAMETERS, format!("{PARAMETERS}: {error}")))
            .ok()
            .flatten()
    }

    /// Refuses what the gyro model cannot represent, and warns where its budget does not hold.
    fn gyro_limits(&mut self) {
        let scenario = &self.resolved.scenario;
        let extremes = motion_extremes(scenario);
        match gyro::cautions(&scenario.gyro, scenario.fidelity, &extremes) {
            Ok(cautions) => self.warnings.extend(cautions),
            Err(error) => self.complain(error.key(), format!("{}: {error}", error.key())),
        }
    }

    /// Refuses a calibration that leaves parameters open, and says what a sound one hides.
    fn campaign(&mut self) {
        let scenario = &self.resolved.scenario;
        let Some(config) = campaign::campaign(scenario) else {
            return;
        };
        match campaign::check_campaign(scenario, config) {
            Ok((summary, notes)) => {
                self.calibration = Some(summary);
                self.warnings.extend(notes);
            }
            Err((key, message)) => self.complain(key, message),
        }
    }
}

/// A small count as a number.
#[expect(
    clippy::cast_precision_loss,
    reason = "counts of gyros and channels lie far below 2^53"
)]
pub(super) fn count(things: usize) -> f64 {
    things as f64
}
