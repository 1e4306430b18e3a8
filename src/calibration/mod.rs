//! Turntable calibration of a three-axis gyro assembly, after patent CN101221046.
//!
//! A table turns the assembly in three mountings at known rates; group means of outputs and
//! temperatures give scale errors, misalignments and biases ([`estimate`](fn@estimate)), which
//! [`Compensation`] takes out of the outputs. [`check_plan`] says beforehand what a plan of
//! mountings and rates can determine.
//!
//! # Model
//! Three gyros sit in one case. Their outputs for rates W about the case axes are, after the patent's
//! equations (1) to (8),
//!
//! ```text
//! Wm = XA W + XB      XA = I + K_G + theta_G      XB = B_G
//! ```
//!
//! with scale-factor errors K_G on the diagonal, six small rotations theta_G of the input axes off it
//! and biases B_G: twelve numbers, x1 to x12 row by row of `[XA | XB]`. Every row belongs to one
//! gyro alone, so that the problem of twelve unknowns splits into three of four with the same
//! regressors `a = [Wx Wy Wz 1]` (equation 12).
//!
//! # Campaign
//! In mounting a, b or c the case axis x, y or z points up along the table axis. At table rate w and
//! latitude L the case then turns at `we sin L + w` about that axis (equations 20 to 22). The
//! horizontal Earth rate `we cos L` turns once about the two level gyros in each turn of the table:
//! over whole turns its mean is zero, over a part of a turn it is not ([`horizontal_residue_deg_per_s`]).
//!
//! # What a plan can tell
//! A gyro's four unknowns need four rows of full rank: every mounting once, and in one of them a second
//! rate. With one rate w only, a bias b looks the same as b / w in all three coefficients of its
//! row of XA; without a mounting, one column of XA has no effect. [`check_plan`] finds such directions and names
//! the missing motion. A plan of full rank may still hide effects that the model lacks:
//!
//! * Rates of one sense cannot show an asymmetry of the scale factor: half of it goes into K_G.
//! * A curvature of the scale factor goes mostly into K_G and, with one sense, partly into B_G.
//! * Errors of the mountings add to the misalignments and those of the table rate to K_G; no
//!   estimator separates them.
//! * A drift of the bias between mountings goes into B_G and K_G, unless a temperature column
//!   ([`TemperatureColumns`]) or forgetting ([`Forgetting`]) deals with it.
//!
//! # Where the patent's equations stand
//!
//! | equations | what | where |
//! |---|---|---|
//! | (1) to (8), (19) | error model, names of the parameters | [`ErrorParameters`] |
//! | (9) to (13) | group means, regressors | [`GroupObservation`], [`GroupDesign`] |
//! | (14) to (16), (18) | recursion, its start | [`Estimator`], [`Reading`] |
//! | (17) | forgetting factor from temperature; lost, four forms assumed | [`ForgettingForm`](crate::vocabulary::ForgettingForm) |
//! | (20) to (22) | reference rates | [`reference_rate`] |
//! | (23), (24) | compensation | [`CompensationForm`](crate::vocabulary::CompensationForm) |
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
mod sample_rates;
mod settings;
mod solver;

pub use compensation::Compensation;
pub use consistency::{normalised_error_squared, unmodelled_rms};
pub use design::{Column, GroupDesign, TemperatureColumns};
pub use diagnose::{Finding, SCALE_ERROR_MAX, Scope, diagnose};
pub use error::CalibrationError;
pub use error_model::{ErrorParameters, Misalignment, PARAMETER_NAMES};
pub use estimate::estimate;
pub use estimator::{Estimator, RecursiveSettings};
pub use forgetting::{FORGETTING_FACTOR_MIN, Forgetting, Reading};
pub use inseparable::Inseparable;
pub use observations::{
    Averaging, GroupMeans, GroupObservation, GroupSamples, OUTLIER_THRESHOLD, group_means,
};
pub use plan::{AxisPlan, PlanDefect, PlanReport, RANK_TOLERANCE, check_plan};
pub use reference::{TableGroup, horizontal_residue_deg_per_s, reference_rate, whole_turns_s};
pub use result::{
    AxisCoefficients, Calibration, RoundingLoss, SampleFindings, TemperatureCoefficients,
};
pub use sample_rates::{RateSample, SampleSettings, estimate_samples};
pub use settings::{
    CalibrationConfig, CompensationConfig, CompensationParameters, TemperatureParameters,
};
