//! From scenario files to checked plans: the checks that need physics or metrics.

use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::path::PathBuf;
use std::sync::Arc;

use super::assembly_motion;
use super::campaign;
use super::comparison::contradictions;
use super::compensation::CompensationPlan;
use super::motion::{motion, motion_extremes};
use super::pipeline_check;
use super::published_check::wrong_unit;
use crate::gyro;
use crate::metrics::catalogue::DIVERGED_AT;
use crate::metrics::{self, MetricKey};
use crate::scenario::{Fidelity, Resolved, Scenario, ScenarioError, visit_suite};
use crate::signal::GyroFacts;

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
    let mut plans = Vec::new();
    let errors = visit_plans(paths, sets, &mut |plan| plans.push(plan))?;
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
        Err(errors)
    }
}

/// Reads everything under `paths` and hands over each run that passes its own checks; returns the
/// complaints about the others, each once.
///
/// # Errors
/// Every complaint, if there are some about what was read.
pub(super) fn visit_plans(
    paths: &[PathBuf],
    sets: &[String],
    visit: &mut dyn FnMut(Plan),
) -> Result<Vec<ScenarioError>, Vec<ScenarioError>> {
    let (mut errors, mut known) = (Vec::new(), BTreeSet::new());
    let mut campaigns = SoundCampaigns::default();
    let mut take = |resolved| match plan(resolved, &mut campaigns) {
        Ok(plan) => visit(plan),
        // The points of a sweep share most of what is wrong with them.
        Err(found) => errors.extend(
            found
                .into_iter()
                .filter(|error| known.insert(error.clone())),
        ),
    };
    match visit_suite(paths, sets, &mut take) {
        Ok(()) => Ok(errors),
        Err(mut read) => {
            read.extend(errors);
            Err(read)
        }
    }
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
    let mut checker = Checker {
        resolved: &resolved,
        errors: Vec::new(),
        warnings: resolved.warnings.clone(),
        calibration: None,
    };
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

    /// Refuses gates and published figures that this record can never support.
    fn metrics(&mut self, facts: &GyroFacts) {
        let scenario = &self.resolved.scenario;
        let motion = motion(scenario, 1.0 / facts.output_rate_hz);
        let mut requested: Vec<(String, &str, &str)> = Vec::new();
        for (index, gate) in scenario.gates.iter().enumerate() {
            // The reader has checked that there is a dot and that the channel exists.
            let Some((channel, name)) = gate.metric.rsplit_once('.') else {
                continue;
            };
            requested.push((format!("gate[{index}].metric"), channel, name));
            if let Some(reference) = &gate.relative_to {
                requested.push((format!("gate[{index}].relative_to"), reference, name));
            }
        }
        for (index, figure) in scenario.published.iter().enumerate() {
            let Some((channel, name)) = figure.metric.rsplit_once('.') else {
                continue;
            };
            requested.push((format!("published[{index}].metric"), channel, name));
            if let Some((key, message)) = wrong_unit(index, name, &figure.unit) {
                self.complain(&key, message);
            }
        }
        for (key, channel, name) in requested {
            // The divergence of a channel may be what the gate expects.
            if name == DIVERGED_AT.name {
                continue;
            }
            if let Some(estimator) = campaign::estimator_of(scenario, channel) {
                if let Err(reason) = campaign::supports(estimator, name) {
                    self.complain(&key, format!("{key}: {channel}.{name}: {reason}"));
                }
                continue;
            }
            let supported = metrics::support(
                name,
                scenario.duration_s,
                1.0 / facts.output_rate_hz,
                &motion,
                !scenario.is_unfiltered(channel),
                scenario.bias_averaging_time_s,
            );
            let lack = || metrics::find(name).and_then(|key| lacks(scenario, channel, key));
            if let Some(reason) = supported.err().or_else(lack) {
                self.complain(&key, format!("{key}: {channel}.{name}: {reason}"));
            }
        }
    }
}

/// Why a channel of this scenario can never have a metric, whatever the length of its record.
fn lacks(scenario: &Scenario, channel: &str, key: &MetricKey) -> Option<String> {
    let has_encoder = scenario.turntable.encoder.resolution_arcsec.is_some();
    let repeats = usize::try_from(scenario.repeats).unwrap_or(usize::MAX);
    pipeline_check::lacks(scenario, channel, key)
        .or_else(|| assembly_motion::lacks(scenario, channel, key))
        .or_else(|| campaign::lacks(scenario, key))
        .or_else(|| metrics::encoder_lack(key, has_encoder))
        .map(str::to_owned)
        .or_else(|| metrics::repeats_lack(key, repeats))
}

/// A small count as a number.
#[expect(
    clippy::cast_precision_loss,
    reason = "counts of gyros and channels lie far below 2^53"
)]
pub(super) fn count(things: usize) -> f64 {
    things as f64
}
