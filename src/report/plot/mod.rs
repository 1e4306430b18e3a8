//! Pictures as SVG: no fonts, no clock, the same bytes from the same records.
//!
//! plotters stands behind [`picture`] only.

mod allan;
mod axis;
mod budget;
mod panel;
mod picture;
mod rate;
mod series;
mod spectrum;
mod swing;

pub use budget::budget_svg;

use crate::report::RunReport;
use crate::scenario::MotionConfig;
use crate::signal::RunSignals;

/// Largest size of a picture, bytes: long records are drawn as an envelope per pixel column.
pub const SVG_BYTES_MAX: usize = 500_000;

/// The pictures of a run as file name and SVG text: `rate.svg`; `allan.svg` and `spectrum.svg`
/// where a channel has the curve; `swing.svg` for a swing.
///
/// # Panics
/// If a picture exceeds [`SVG_BYTES_MAX`], which its fixed number of points rules out.
#[must_use]
pub fn plots(report: &RunReport, signals: &RunSignals) -> Vec<(String, String)> {
    let swing = match &report.scenario.turntable.motion {
        MotionConfig::Swing(swing) => swing::picture(report, signals, swing.frequency_hz),
        _ => None,
    };
    let pictures = [
        ("rate.svg", rate::picture(report, signals)),
        ("allan.svg", allan::picture(report)),
        ("swing.svg", swing),
        ("spectrum.svg", spectrum::picture(report)),
    ];
    pictures
        .into_iter()
        .filter_map(|(name, picture)| Some((name.to_owned(), picture?.svg())))
        .inspect(|(name, svg)| {
            let bytes = svg.len();
            assert!(bytes <= SVG_BYTES_MAX, "{name} has {bytes} bytes");
        })
        .collect()
}
