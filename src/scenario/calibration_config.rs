//! The configuration of a calibration campaign: names are the keys of the scenario file.

use serde::Deserialize;

use crate::vocabulary::{EstimatorKind, ForgettingForm};

use super::turntable_config::CaseAxis;

/// A calibration campaign: groups of constant rate, the case re-mounted between some of them.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CampaignConfig {
    /// Case axis along the table axis, one for each group.
    pub axes: Vec<CaseAxis>,
    /// Rate of the table, deg/s, one for each group; 0 is a static position.
    pub rates_deg_per_s: Vec<f64>,
    /// Time at each rate, s.
    pub record_s: f64,
    /// Pause between two rates in one mounting, s.
    pub change_s: f64,
    /// Pause in which the case is mounted anew, s.
    pub remount_s: f64,
    /// Whether means are taken over whole turns of the table.
    pub whole_turns: bool,
}

/// One group of a campaign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CampaignGroup {
    /// Case axis along the table axis.
    pub axis: CaseAxis,
    /// Rate of the table, deg/s.
    pub rate_deg_per_s: f64,
    /// Start of its record, s from the start of the measured time.
    pub start_s: f64,
    /// Length of its record, s.
    pub record_s: f64,
    /// Whether the case is mounted anew in the pause before it.
    pub is_remounted: bool,
}

impl CampaignConfig {
    /// The groups with their times.
    #[must_use]
    pub fn groups(&self) -> Vec<CampaignGroup> {
        let mut start_s = 0.0;
        let mut before: Option<CaseAxis> = None;
        let pairs = self.axes.iter().zip(&self.rates_deg_per_s);
        pairs
            .map(|(&axis, &rate_deg_per_s)| {
                let is_remounted = before.is_some_and(|old| old != axis);
                if before.is_some() {
                    start_s += self.record_s + self.pause_s(is_remounted);
                }
                before = Some(axis);
                CampaignGroup {
                    axis,
                    rate_deg_per_s,
                    start_s,
                    record_s: self.record_s,
                    is_remounted,
                }
            })
            .collect()
    }

    /// Length of the pause before a group, s.
    #[must_use]
    pub fn pause_s(&self, is_remounted: bool) -> f64 {
        if is_remounted {
            self.remount_s
        } else {
            self.change_s
        }
    }

    /// Time from the start of the first group to the end of the last, s.
    #[must_use]
    pub fn length_s(&self) -> f64 {
        let last = self.groups().last().copied();
        last.map_or(0.0, |group| group.start_s + group.record_s)
    }
}

/// How the means of a campaign become parameters.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CalibrationConfig {
    /// Estimators that run side by side.
    pub estimators: Vec<EstimatorKind>,
    /// The one whose parameters are applied.
    pub apply: EstimatorKind,
    /// How the forgetting factor falls with the step of temperature between groups.
    pub forgetting_form: ForgettingForm,
    /// Its constant where no temperature coefficient is fitted, 1/K.
    pub forgetting_constant_per_k: f64,
    /// Its constant beside a fitted temperature coefficient, 1/K.
    pub forgetting_constant_with_temperature_per_k: f64,
    /// `xi` of the prior `P_0 = xi I` of the recursions, in deg/s and ratios.
    pub initial_covariance: f64,
    /// Outliers lie beyond so many robust standard deviations; 0 rejects none.
    pub outlier_threshold: f64,
}

impl CalibrationConfig {
    /// The estimators that run, each once and in order, the applied one among them.
    #[must_use]
    pub fn kinds(&self) -> Vec<EstimatorKind> {
        let mut kinds: Vec<EstimatorKind> = Vec::new();
        for kind in self.estimators.iter().copied().chain([self.apply]) {
            if !kinds.contains(&kind) {
                kinds.push(kind);
            }
        }
        kinds
    }
}
