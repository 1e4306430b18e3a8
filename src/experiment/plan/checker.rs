//! The checks of one run that need physics.

use std::sync::Arc;

use super::checked::Plan;
use crate::experiment::campaign::{self, CompensationPlan};
use crate::experiment::run::motion_extremes;
use crate::filters::ExpectedWords;
use crate::gyro;
use crate::scenario::{Resolved, ScenarioError};
use crate::signal::GyroFacts;

/// The campaign that passed its checks last: the points of a sweep share one.
#[derive(Default)]
pub(crate) struct SoundCampaigns(Option<Arc<Resolved>>);

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

pub(crate) fn plan(
    resolved: Resolved,
    campaigns: &mut SoundCampaigns,
) -> Result<Plan, Vec<ScenarioError>> {
    let mut checker = Checker::new(&resolved);
    checker.names();
    let is_log = checker.resolved.log.is_some();
    let facts = if is_log { None } else { checker.gyro() };
    let compensation = checker.compensation(campaigns);
    if let Some(facts) = &facts {
        checker.gyro_limits();
        checker.record_length(facts);
        checker.campaign();
        let words = checker.expected_words(facts);
        checker.filters(&words);
        checker.metrics();
    }
    if let Some(log) = &resolved.log {
        checker.log_length(log);
        checker.filters(&ExpectedWords {
            sample_rate_hz: log.sample_rate_hz,
            peak_deg_per_h: 0.0,
            run: None,
        });
        checker.metrics();
    }
    let Checker {
        errors,
        warnings,
        calibration,
        ..
    } = checker;
    // A gyro that is none has said why.
    match errors.is_empty() && (is_log || facts.is_some()) {
        true => Ok(Plan {
            resolved,
            facts,
            warnings,
            compensation,
            calibration,
        }),
        false => Err(errors),
    }
}

/// Collects every complaint about one run.
pub(crate) struct Checker<'a> {
    pub(crate) resolved: &'a Resolved,
    pub(crate) errors: Vec<ScenarioError>,
    pub(crate) warnings: Vec<String>,
    calibration: Option<String>,
}

impl<'a> Checker<'a> {
    pub(crate) fn new(resolved: &'a Resolved) -> Self {
        Self {
            resolved,
            errors: Vec::new(),
            warnings: resolved.warnings.clone(),
            calibration: None,
        }
    }
}

impl Checker<'_> {
    pub(crate) fn complain(&mut self, key: &str, message: String) {
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
            Err(error) => self.complain(error.key(), error.to_string()),
        }
    }
}
