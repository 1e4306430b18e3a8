//! Keys of the run itself.

use super::{integer, key};
use crate::scenario::schema::{
    Key, Kind,
    Presence::{Defaulted, Optional, Required},
    Range,
};

#[rustfmt::skip]
pub(super) const KEYS: &[Key] = &[
    key("schema", integer(1, 1), "", Defaulted,
        "Version of the file format."),
    key("name", Kind::Name, "", Required,
        "Name of the scenario and of its folder under the output folder; never inherited."),
    key("description", Kind::Text, "", Optional,
        "What the experiment shows, one sentence."),
    key("extends", Kind::Text, "", Optional,
        "Path of the file this one builds on, relative to this file."),
    key("seed", integer(0, i64::MAX), "", Defaulted,
        "Seed of every noise stream."),
    key("repeats", integer(1, 100_000), "", Defaulted,
        "Number of independent noise records, all else equal."),
    key("duration_s", Kind::Float(Range::closed(1e-6, 1e7)), "s", Required,
        "Time measured."),
    key("warm_up_s", Kind::Float(Range::closed(0.0, 1e6)), "s", Defaulted,
        "Time simulated and filtered before it, left out of every metric."),
    key("fidelity", Kind::Choice(&["loop", "rate"]), "", Defaulted,
        "Gyro model: every half modulation period, or its equivalent at the output rate."),
    key("bias_averaging_time_s", Kind::Float(Range::closed(1e-6, 1e6)), "s", Defaulted,
        "Averaging time of the plain bias stability."),
];
