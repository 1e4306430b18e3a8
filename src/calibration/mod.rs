//! Turntable calibration of a three-axis gyro assembly, after patent CN101221046.
//!
//! A table turns the assembly in three mountings at known rates; group means of outputs and
//! temperatures give scale errors, misalignments and biases ([`estimate`](fn@estimate)), which
//! [`Compensation`] takes out of the outputs. [`check_plan`] says beforehand what a plan of
//! mountings and rates can determine.
//!
//! Invariant: pure mathematics; never sees a scenario or a simulated gyro. Rates and biases are in
//! deg/s, as in the patent: the prior `P_0 = xi I` and condition numbers depend on the unit.

mod compensation;
mod consistency;
mod covariance_recursion;
mod design;
mod diagnose;
mod error;
mod error_model;
mod estimate;
mod estimator;
mod forgetting;
mod inseparable;
mod observations;
mod plan;
mod reference;
mod result;
mod solver;

pub use compensation::{Compensation, CompensationForm};
pub use consistency::{normalised_error_squared, unmodelled_rms};
pub use design::{Column, GroupDesign, TemperatureColumns};
pub use diagnose::{Finding, SCALE_ERROR_MAX, Scope, diagnose};
pub use error::CalibrationError;
pub use error_model::{ErrorParameters, Misalignment, PARAMETER_NAMES};
pub use estimate::estimate;
pub use estimator::{Estimator, RecursiveSettings};
pub use forgetting::{FORGETTING_FACTOR_MIN, Forgetting, ForgettingForm, Reading};
pub use inseparable::Inseparable;
pub use observations::{
    Averaging, GroupMeans, GroupObservation, GroupSamples, OUTLIER_THRESHOLD, group_means,
};
pub use plan::{AxisPlan, PlanDefect, PlanReport, RANK_TOLERANCE, check_plan};
pub use reference::{TableGroup, horizontal_residue_deg_per_s, reference_rate, whole_turns_s};
pub use result::{AxisCoefficients, Calibration, RoundingLoss, TemperatureCoefficients};
