//! Calibration campaigns: what a plan can determine, the groups, their calibration, and the
//! compensation that applies it.

mod compensation;
mod compensation_plan;
mod encoder_rate;
#[cfg(feature = "report")]
mod findings;
mod groups;
mod metrics;
mod sheet;
#[cfg(feature = "report")]
mod trial;
mod units;

pub(crate) use compensation::{Compensator, Parameters};
pub(crate) use compensation_plan::CompensationPlan;
pub(crate) use groups::{calibrate_simulation, campaign, check_campaign};
pub(crate) use metrics::{drop_lacking, estimate_channels, estimator_of, lacks, ranked, supports};
#[cfg(feature = "report")]
pub use trial::{
    CalibrateError, CalibrationTrial, GroupsSettings, calibrate_campaign, calibrate_groups,
};
