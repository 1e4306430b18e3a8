//! The units of a report in others that data sheets use.

use maud::{Markup, html};

use super::document::{section, wide};
use crate::gate::plain;
use crate::units::{
    RAD_PER_SQRT_S_IN_DEG_PER_SQRT_H, arcsec_to_rad, deg_per_h_per_h_to_deg_per_h_per_s,
    deg_per_h_per_sqrt_h_to_deg_per_h_per_sqrt_s, deg_per_h_to_arcsec_per_s,
    deg_per_h_to_deg_per_s, deg_per_h_to_rad_per_s, deg_per_sqrt_h_to_deg_per_h_sqrt_s,
    rad_to_urad,
};

/// A quantity, one of its unit, and what that is in others.
type Row = (&'static str, &'static str, Vec<(f64, &'static str)>);

/// What one of each unit is.
pub(super) fn units() -> Markup {
    let walk = deg_per_sqrt_h_to_deg_per_h_sqrt_s(1.0);
    let rows: [Row; 5] = [
        (
            "rate, bias, noise of a word",
            "1 deg/h",
            vec![
                (deg_per_h_to_deg_per_s(1.0), "deg/s"),
                (deg_per_h_to_rad_per_s(1.0), "rad/s"),
                (deg_per_h_to_arcsec_per_s(1.0), "arcsec/s"),
            ],
        ),
        (
            "angle random walk N",
            "1 deg/sqrt(h)",
            vec![
                (walk, "deg/h/sqrt(Hz), two-sided"),
                (2.0_f64.sqrt() * walk, "deg/h/sqrt(Hz), one-sided"),
                (1.0 / RAD_PER_SQRT_S_IN_DEG_PER_SQRT_H, "rad/sqrt(s)"),
            ],
        ),
        (
            "rate random walk K",
            "1 deg/h/sqrt(h)",
            vec![(
                deg_per_h_per_sqrt_h_to_deg_per_h_per_sqrt_s(1.0),
                "deg/h/sqrt(s)",
            )],
        ),
        (
            "rate ramp R",
            "1 deg/h/h",
            vec![(deg_per_h_per_h_to_deg_per_h_per_s(1.0), "deg/h/s")],
        ),
        (
            "quantisation Q",
            "1 arcsec",
            vec![(rad_to_urad(arcsec_to_rad(1.0)), "urad")],
        ),
    ];
    let table = html! {
        table {
            thead { tr { th scope="col" { "quantity" } th scope="col" { "one" } th scope="col" { "is" } } }
            tbody { @for (quantity, one, others) in &rows { tr {
                th scope="row" { (quantity) }
                td { (one) }
                td { @for (value, unit) in others { div { (plain(*value)) " " (unit) } } }
            } } }
        }
    };
    section("units", "Units", &wide("units", &table))
}
