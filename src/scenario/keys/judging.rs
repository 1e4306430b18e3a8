//! Keys of the trial of filters, gates, published figures, output and sweep.

use super::key;
use crate::scenario::schema::{
    Key, Kind,
    Presence::{Defaulted, Optional, Required},
    Range,
};

#[rustfmt::skip]
pub(super) const KEYS: &[Key] = &[
    key("trial.rate_gain", Kind::Boolean, "", Defaulted,
        "Measure every filter's gain for constant rates from 0.001 to 100 deg/s."),
    key("trial.filter_state", Kind::Choice(&["carried", "reset"]), "", Defaulted,
        "Filters go on from one rate of a staircase to the next, or start afresh at each."),
    key("gate[].metric", Kind::Text, "", Required,
        "Channel and metric, split at the last dot."),
    key("gate[].min", Kind::Float(Range::ANY), "", Optional,
        "Lower limit, in the unit of the metric."),
    key("gate[].max", Kind::Float(Range::ANY), "", Optional,
        "Upper limit, in the unit of the metric."),
    key("gate[].relative_to", Kind::Text, "", Optional,
        "Channel whose same metric divides this one."),
    key("gate[].decide", Kind::Choice(&["interval", "value"]), "", Defaulted,
        "What is compared."),
    key("gate[].inconclusive", Kind::Choice(&["fail", "allow"]), "", Defaulted,
        "What becomes of an interval that reaches over a limit."),
    key("published[].metric", Kind::Text, "", Required,
        "Channel and metric, split at the last dot."),
    key("published[].value", Kind::Float(Range::ANY), "", Required,
        "The published figure."),
    key("published[].unit", Kind::FreeText, "", Required,
        "Its unit, that of the metric; \"1\" or \"\" for a ratio."),
    key("published[].source", Kind::Text, "", Required,
        "Where it was published."),
    key("output.samples", Kind::Choice(&["none", "npy"]), "", Defaulted,
        "Rate words of every channel and the truth, written as NPY or not."),
    key("matrix", Kind::Matrix, "", Optional,
        "Swept keys and their values; the runs are the Cartesian product."),
];
