//! Keys of the calibration campaign and of what is made of it.

use super::key;
use crate::scenario::schema::{
    Key, Kind,
    Presence::{Defaulted, Required},
    Range,
};

/// Estimators by name.
const ESTIMATORS: &[&str] = &[
    "batch",
    "batch-temperature",
    "arls",
    "arls-covariance",
    "arls-temperature",
];

#[rustfmt::skip]
pub(super) const KEYS: &[Key] = &[
    key("turntable.calibration.axes", Kind::Choices(&["x", "y", "z"]), "", Required,
        "Case axis along the table axis, one for each group of the campaign."),
    key("turntable.calibration.rates_deg_per_s", Kind::Floats(Range::closed(-2000.0, 2000.0)), "deg/s", Required,
        "Rate of the table in each group, right-handed about the table axis; 0 is a static position."),
    key("turntable.calibration.record_s", Kind::Float(Range::closed(1e-3, 1e6)), "s", Defaulted,
        "Time at each rate."),
    key("turntable.calibration.change_s", Kind::Float(Range::closed(1e-3, 1e6)), "s", Defaulted,
        "Pause between two rates in one mounting; the table changes its rate in the middle half."),
    key("turntable.calibration.remount_s", Kind::Float(Range::closed(1e-3, 1e6)), "s", Defaulted,
        "Pause in which the case is mounted anew; the table stops, waits and runs up in it."),
    key("turntable.calibration.whole_turns", Kind::Boolean, "", Defaulted,
        "Means are taken over the longest whole turns within the time at each rate."),
    key("calibration.estimators", Kind::Choices(ESTIMATORS), "", Defaulted,
        "Estimators that run side by side."),
    key("calibration.apply", Kind::Choice(ESTIMATORS), "", Defaulted,
        "The one whose parameters are applied; it runs also if it is not among the others."),
    key("calibration.forgetting_form", Kind::Choice(&["linear", "exponential", "rational", "gaussian"]), "", Defaulted,
        "How the forgetting factor falls with the step of temperature between groups."),
    key("calibration.forgetting_constant_per_k", Kind::Float(Range::closed(0.0, 1000.0)), "1/K", Defaulted,
        "Its constant c for the estimators without a temperature coefficient."),
    key("calibration.forgetting_constant_with_temperature_per_k", Kind::Float(Range::closed(0.0, 1000.0)), "1/K", Defaulted,
        "Its constant c beside a fitted temperature coefficient."),
    key("calibration.initial_covariance", Kind::Float(Range::closed(1e-15, 1e15)), "", Defaulted,
        "xi of the prior P0 = xi I of the recursions, in deg/s and ratios."),
    key("calibration.outlier_threshold", Kind::Float(Range::closed(0.0, 1000.0)), "", Defaulted,
        "Samples beyond so many robust standard deviations from the median are left out; 0 keeps all."),
];
