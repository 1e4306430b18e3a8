//! Keys of the compensation of an assembly's constant errors.

use super::key;
use crate::scenario::schema::{
    Key, Kind,
    Presence::{Defaulted, Optional},
    Range,
};

#[rustfmt::skip]
pub(super) const KEYS: &[Key] = &[
    key("compensation.form", Kind::Choice(&["exact", "first-order"]), "", Defaulted,
        "How rates follow from the outputs: by the inverse matrix, or by the patent's first order."),
    key("compensation.file", Kind::Text, "", Optional,
        "Path of a calibration.toml, whose parameters take the place of this key."),
    key("compensation.campaign", Kind::Text, "", Optional,
        "Path of a calibration scenario that is run first; its result is applied."),
    key("compensation.campaign_scenario", Kind::Text, "", Optional,
        "The calibration scenario itself, as the manifest of a run holds it."),
    key("compensation.parameters.bias_deg_per_h", Kind::Triple(Range::closed(-1e6, 1e6)), "deg/h", Defaulted,
        "Bias of the gyros x, y, z at their reference temperatures."),
    key("compensation.parameters.scale_factor_error_ppm", Kind::Triple(Range::closed(-1e6, 1e6)), "ppm", Defaulted,
        "Scale-factor error of the gyros x, y, z."),
    key("compensation.parameters.theta_xy_arcsec", Kind::Float(Range::closed(-1e6, 1e6)), "arcsec", Defaulted,
        "Small right-hand rotation of gyro x's input axis about case axis y."),
    key("compensation.parameters.theta_xz_arcsec", Kind::Float(Range::closed(-1e6, 1e6)), "arcsec", Defaulted,
        "Small right-hand rotation of gyro x's input axis about case axis z."),
    key("compensation.parameters.theta_yx_arcsec", Kind::Float(Range::closed(-1e6, 1e6)), "arcsec", Defaulted,
        "Small right-hand rotation of gyro y's input axis about case axis x."),
    key("compensation.parameters.theta_yz_arcsec", Kind::Float(Range::closed(-1e6, 1e6)), "arcsec", Defaulted,
        "Small right-hand rotation of gyro y's input axis about case axis z."),
    key("compensation.parameters.theta_zx_arcsec", Kind::Float(Range::closed(-1e6, 1e6)), "arcsec", Defaulted,
        "Small right-hand rotation of gyro z's input axis about case axis x."),
    key("compensation.parameters.theta_zy_arcsec", Kind::Float(Range::closed(-1e6, 1e6)), "arcsec", Defaulted,
        "Small right-hand rotation of gyro z's input axis about case axis y."),
    key("compensation.parameters.reference_temperature_c", Kind::Triple(Range::closed(-100.0, 150.0)), "C", Defaulted,
        "Temperature of the gyros x, y, z at which the biases hold."),
    key("compensation.parameters.bias_deg_per_h_per_k", Kind::Triple(Range::closed(-1000.0, 1000.0)), "deg/h/K", Defaulted,
        "Temperature coefficient of the biases of the gyros x, y, z."),
];
