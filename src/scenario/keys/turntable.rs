//! Keys of the rate table.

use super::key;
use crate::scenario::schema::{
    Key, Kind,
    Presence::{Defaulted, Optional, Required},
    Range,
};

#[rustfmt::skip]
pub(super) const KEYS: &[Key] = &[
    key("turntable.static", Kind::EmptyTable, "", Defaulted,
        "The table is at rest."),
    key("turntable.swing.rate_amplitude_deg_per_s", Kind::Float(Range::above(0.0, 2000.0)), "deg/s", Optional,
        "Rate amplitude; exactly one of the two amplitudes is given."),
    key("turntable.swing.angle_amplitude_deg", Kind::Float(Range::above(0.0, 360.0)), "deg", Optional,
        "Angle amplitude; the rate amplitude is 2 pi f times this."),
    key("turntable.swing.frequency_hz", Kind::Float(Range::above(0.0, 1000.0)), "Hz", Required,
        "Swing frequency; a cycle must span at least 8 output samples."),
    key("turntable.swing.soft_start_s", Kind::Float(Range::closed(0.0, 1.0)), "s", Defaulted,
        "Raised-cosine start of the motion, inside the warm-up."),
    key("turntable.steps.rates_deg_per_s", Kind::Floats(Range::closed(-2000.0, 2000.0)), "deg/s", Required,
        "Rates in order; the last one is held for ever."),
    key("turntable.steps.dwell_s", Kind::Float(Range::above(0.0, 1e6)), "s", Required,
        "Time at each rate; all of them must fit into the duration."),
    key("turntable.rotation.rate_deg_per_s", Kind::Float(Range::closed(-2000.0, 2000.0)), "deg/s", Required,
        "Constant rate."),
    key("turntable.rotation.soft_start_s", Kind::Float(Range::closed(0.0, 1.0)), "s", Defaulted,
        "Raised-cosine start of the motion, inside the warm-up."),
    key("turntable.servo.ideal", Kind::EmptyTable, "", Defaulted,
        "The axis is the command."),
    key("turntable.servo.second_order.natural_frequency_hz", Kind::Float(Range::above(0.0, 10000.0)), "Hz", Required,
        "Natural frequency."),
    key("turntable.servo.second_order.damping_ratio", Kind::Float(Range::above(0.0, 10.0)), "", Required,
        "Damping ratio."),
    key("turntable.site.latitude_deg", Kind::Float(Range::closed(-90.0, 90.0)), "deg", Defaulted,
        "Geodetic latitude, north positive."),
    key("turntable.site.axis_elevation_deg", Kind::Float(Range::closed(-90.0, 90.0)), "deg", Defaulted,
        "Elevation of the input axis above the horizon, 90 is up."),
    key("turntable.site.axis_azimuth_deg", Kind::Float(Range::closed(-360.0, 360.0)), "deg", Defaulted,
        "Azimuth of the input axis from north towards east."),
    key("turntable.mounting.axis_along_table", Kind::Choice(&["x", "y", "z"]), "", Defaulted,
        "Case axis along the table axis; the others follow cyclically."),
];
