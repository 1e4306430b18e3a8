//! Pictures as SVG: no fonts, no clock, the same bytes from the same records.
//!
//! plotters stands behind [`picture`] only.

mod allan;
mod axis;
mod before_after;
mod bode;
mod budget;
mod calibration;
mod noise_delay;
mod panel;
mod picture;
mod rate;
mod rate_gain;
mod response;
mod series;
mod spectrum;
mod swing;
mod theory;
mod thermal;

pub use budget::budget_svg;
pub use calibration::calibration_svg;

use picture::Picture;

use crate::report::RunReport;
use crate::report::measured::Measured;
use crate::scenario::MotionConfig;
use crate::signal::RunSignals;

/// Largest size of a picture, bytes: long records are drawn as an envelope per pixel column.
pub const SVG_BYTES_MAX: usize = 500_000;

/// The pictures of one gyro of a run as file name and SVG text: `rate.svg`; `before-after.svg` where
/// the words are compensated; `allan.svg` and
/// `spectrum.svg` where a channel has the curve; `swing.svg` for a swing, `bode.svg` for several
/// sines, `response.svg` for a staircase of three rates or more; `thermal.svg` where the temperature
/// changes; `noise-delay.svg` where a filter's noise was measured at rest or in a swing, and
/// `rate-gain.svg` where its gain was over the rate. Those of an assembly stand behind the axis, as in `x-rate.svg`: nine channels in one picture would hide one another.
///
/// # Panics
/// If a picture exceeds [`SVG_BYTES_MAX`], which its fixed number of points rules out.
#[must_use]
pub fn plots(report: &RunReport, signals: &RunSignals) -> Vec<(String, String)> {
    let own = report.channels.iter();
    let own: Vec<_> = own
        .filter(|(name, _)| name.starts_with(signals.prefix))
        .cloned()
        .collect();
    let report = &RunReport {
        channels: &own,
        calibration: None,
        ..report.clone()
    };
    let axis = signals.prefix.replace('_', "-");
    let swing = match &report.scenario.turntable.motion {
        MotionConfig::Swing(swing) => swing::picture(report, signals, swing.frequency_hz),
        _ => None,
    };
    let pictures = [
        ("rate.svg", rate::picture(&report.measured(), signals)),
        ("before-after.svg", before_after::picture(report, signals)),
        ("allan.svg", allan::picture(&report.measured())),
        ("swing.svg", swing),
        ("bode.svg", bode::picture(report)),
        ("response.svg", response::picture(report)),
        ("spectrum.svg", spectrum::picture(&report.measured())),
        ("thermal.svg", thermal::picture(report, signals)),
        ("noise-delay.svg", noise_delay::picture(report)),
        ("rate-gain.svg", rate_gain::picture(report)),
    ];
    drawn(pictures, &axis)
}

/// The pictures of a recorded log: `rate.svg`; `allan.svg` and `spectrum.svg` where a channel has
/// the curve.
pub(super) fn log_plots(log: &Measured, signals: &RunSignals) -> Vec<(String, String)> {
    let pictures = [
        ("rate.svg", rate::picture(log, signals)),
        ("allan.svg", allan::picture(log)),
        ("spectrum.svg", spectrum::picture(log)),
    ];
    drawn(pictures, "")
}

/// Those that there are, as SVG, named behind the axis.
fn drawn<const N: usize>(
    pictures: [(&str, Option<Picture>); N],
    axis: &str,
) -> Vec<(String, String)> {
    pictures
        .into_iter()
        .filter_map(|(name, picture)| Some((format!("{axis}{name}"), picture?.svg())))
        .inspect(|(name, svg)| {
            let bytes = svg.len();
            assert!(bytes <= SVG_BYTES_MAX, "{name} has {bytes} bytes");
        })
        .collect()
}
