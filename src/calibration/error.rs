//! Why a calibration is refused.

use thiserror::Error;

use super::plan::PlanDefect;

/// Reason why no calibration can be given.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CalibrationError {
    /// The groups do not determine the unknowns.
    #[error("the groups do not determine the parameters: {0}")]
    Unobservable(PlanDefect),
    /// A number that is not finite, or a standard error below zero.
    #[error("group {group}, {quantity} of axis {axis} = {value}: expected {expected}")]
    BadValue {
        /// Group, from 1.
        group: usize,
        /// What the number is.
        quantity: &'static str,
        /// Axis: `x`, `y` or `z`.
        axis: &'static str,
        /// The number.
        value: f64,
        /// What is allowed.
        expected: &'static str,
    },
    /// The decomposition of the rows of a gyro has no result.
    #[error(
        "the rows of gyro {axis} have no singular values: rates and temperatures of the groups are \
         too far apart in size"
    )]
    Unresolved {
        /// Axis: `x`, `y` or `z`.
        axis: &'static str,
    },
    /// An estimate that came out as no finite number.
    #[error(
        "the {what} came out as {value}: standard errors, outputs or temperatures of the groups are \
         too far apart in size"
    )]
    NotFinite {
        /// What came out.
        what: &'static str,
        /// As which number.
        value: f64,
    },
    /// A setting of an estimator out of range.
    #[error("{name} = {value} is out of range: expected {expected}")]
    BadSetting {
        /// Name of the setting, with its unit.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What is allowed.
        expected: &'static str,
    },
    /// Forgetting left too few groups with weight.
    #[error(
        "the forgetting factors leave gyro {axis} with too few groups of weight (condition number \
         {condition_number:.1e}): lower the constant or add groups at a steady temperature"
    )]
    Forgotten {
        /// Axis: `x`, `y` or `z`.
        axis: &'static str,
        /// Condition number of the weighted rows.
        condition_number: f64,
    },
    /// A scale-factor error that no gyro has: the data do not belong to the stated motion.
    #[error(
        "the scale-factor error of gyro {axis} comes out as {scale_error:.4}, beyond \
         {limit}: {hint}"
    )]
    Implausible {
        /// Axis: `x`, `y` or `z`.
        axis: &'static str,
        /// The scale-factor error found.
        scale_error: f64,
        /// Largest magnitude allowed.
        limit: f64,
        /// What it may come from, in words.
        hint: String,
    },
    /// The sensitivity matrix has no inverse.
    #[error("the sensitivity matrix XA is singular: outputs cannot be turned back into rates")]
    SingularSensitivity,
    /// Too few samples for a mean and its standard error.
    #[error("gyro {axis} has {count} samples in the group: expected at least {needed}")]
    TooFewSamples {
        /// Axis: `x`, `y` or `z`.
        axis: &'static str,
        /// Samples at hand.
        count: usize,
        /// Samples needed.
        needed: usize,
    },
    /// Samples that do not determine the parameters of a gyro.
    #[error(
        "the samples do not determine the parameters of gyro {axis}: they want three mountings, two rates in one of \
         them, and a change of rate"
    )]
    SamplesUndetermined {
        /// Axis: `x`, `y` or `z`.
        axis: &'static str,
    },
    /// A record too short for a covariance by its stretches.
    #[error("the samples make {stretches} stretches of 20 s: expected at least {needed}")]
    TooFewStretches {
        /// Stretches at hand.
        stretches: usize,
        /// Stretches needed.
        needed: usize,
    },
    /// Samples without the angle of an encoder.
    #[error("the table has no encoder, which tells the rate of every sample")]
    NoEncoder,
    /// Averaging over whole turns was asked for, but the group is shorter than one.
    #[error(
        "the group lasts {duration_s} s, less than one turn of the table ({turn_s} s): average over a \
         fixed time or record longer"
    )]
    NoWholeTurn {
        /// Duration of the group, s.
        duration_s: f64,
        /// Duration of one turn, s.
        turn_s: f64,
    },
}

/// Names of the axes in messages.
pub(super) const AXES: [&str; 3] = ["x", "y", "z"];
