//! The key table: every key of a scenario file with its type, range, unit and meaning.
//!
//! The one source of unknown-key detection, type and range messages, the JSON Schema and the
//! test of `reference.toml`, which holds the defaults.

mod calibration;
mod compensation;
mod filter;
mod gyro;
mod judging;
mod run;
mod thermal;
mod turntable;

use super::schema::{Group, Integers, Key, Kind, Presence};

/// A row of the table.
const fn key(
    path: &'static str,
    kind: Kind,
    unit: &'static str,
    presence: Presence,
    doc: &'static str,
) -> Key {
    Key {
        path,
        kind,
        unit,
        presence,
        doc,
    }
}

/// Whole numbers `min..=max`.
const fn integer(min: i64, max: i64) -> Kind {
    Kind::Integer(Integers {
        min,
        max,
        is_even: false,
    })
}

/// Tables of which exactly one alternative stands.
pub(crate) const GROUPS: &[Group] = &[
    Group {
        table: "turntable",
        noun: "motion",
        alternatives: &[
            "static",
            "swing",
            "multi_sine",
            "steps",
            "scale_factor_test",
            "rotation",
            "trapezoid",
            "chirp",
            "script",
            "calibration",
        ],
    },
    Group {
        table: "turntable.swing",
        noun: "amplitude",
        alternatives: &["rate_amplitude_deg_per_s", "angle_amplitude_deg"],
    },
    Group {
        table: "turntable.chirp",
        noun: "amplitude",
        alternatives: &["rate_amplitude_deg_per_s", "angle_amplitude_deg"],
    },
    Group {
        table: "turntable.script",
        noun: "source of points",
        alternatives: &["file", "points"],
    },
    Group {
        table: "turntable.script.points",
        noun: "kind of values",
        alternatives: &["rate_deg_per_s", "angle_deg"],
    },
    Group {
        table: "turntable.servo",
        noun: "servo",
        alternatives: &["ideal", "second_order", "direct_drive"],
    },
    Group {
        table: "gyro.temperature",
        noun: "temperature profile",
        alternatives: &["soak", "ramp", "profile"],
    },
    Group {
        table: "gyro.thermal.power",
        noun: "power law",
        alternatives: &["quadratic", "exponential", "constant"],
    },
    Group {
        table: "gyro.vibration",
        noun: "vibration",
        alternatives: &["off", "sine", "random"],
    },
    Group {
        table: "compensation",
        noun: "source of parameters",
        alternatives: &["file", "campaign", "campaign_scenario", "parameters"],
    },
    Group {
        table: "filter[]",
        noun: "filter kind",
        alternatives: crate::filters::KINDS,
    },
];

/// Tables that are absent unless a file gives them, though every key inside has a default.
pub(crate) const OPTIONAL_TABLES: &[&str] = &["gyro.assembly", "gyro.injection", "compensation"];

/// Every key, in the order in which resolved scenarios are written.
pub(crate) fn keys() -> impl Iterator<Item = &'static Key> {
    [
        run::KEYS,
        turntable::KEYS,
        gyro::KEYS,
        thermal::KEYS,
        compensation::KEYS,
        calibration::KEYS,
        filter::KEYS,
        judging::KEYS,
    ]
    .into_iter()
    .flatten()
}
