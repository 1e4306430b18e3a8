//! Pictures as SVG: no fonts, no clock, the same bytes from the same records.
//!
//! plotters stands behind [`picture`] only.

mod allan;
mod axis;
mod before_after;
mod bode;
mod budget;
mod calibration;
mod comparison;
mod filter_response;
mod noise_delay;
mod panel;
mod picture;
mod rate;
mod rate_gain;
mod response;
mod scale_factor;
mod series;
mod spectrum;
mod swing;
mod theory;
mod thermal;
mod thin;

pub use budget::budget_svg;
pub use calibration::calibration_svg;

use picture::Picture;

use crate::report::RunReport;
use crate::report::comparison::ComparedTable;
use crate::report::measured::Measured;
use crate::scenario::MotionClass;
use crate::signal::RunSignals;

/// Largest size of a picture, bytes: long records are drawn as an envelope per pixel column.
pub const SVG_BYTES_MAX: usize = 500_000;

/// Pictures as file name and SVG text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Pictures {
    /// Those that are small enough.
    pub drawn: Vec<(String, String)>,
    /// What to say of each that is not, and is left out.
    pub notes: Vec<String>,
}

impl Pictures {
    /// Enters a picture, or the note that it is left out.
    fn add(&mut self, name: String, picture: &Picture) {
        self.add_svg(name, picture.svg());
    }

    /// Enters the text of a picture; none stands for one that is too large.
    pub fn add_svg(&mut self, name: String, svg: Option<String>) {
        match svg {
            Some(svg) => self.drawn.push((name, svg)),
            None => self.notes.push(format!(
                "{name} is left out: it would be larger than {} kB with all that it has to show; \
                 fewer filters or channels make it smaller",
                SVG_BYTES_MAX / 1000
            )),
        }
    }

    /// Enters all pictures of another set.
    pub fn extend(&mut self, other: Self) {
        self.drawn.extend(other.drawn);
        self.notes.extend(other.notes);
    }
}

/// The pictures of one gyro of a run as file name and SVG text: `rate.svg`; `before-after.svg` where
/// the words are compensated; `allan.svg` and
/// `spectrum.svg` where a channel has the curve; `swing.svg` for a swing, `bode.svg` for several
/// sines, `response.svg` for a staircase of three rates or more and `scale-factor.svg`
/// for what it leaves of its line; `thermal.svg` where the temperature
/// changes; `noise-delay.svg` where a filter's noise was measured at rest or in a swing, and
/// `rate-gain.svg` where its gain was over the rate; `filter-response.svg` where there are filters.
/// Those of an assembly stand behind the axis, as in `x-rate.svg`: nine channels in one picture would hide one another.
/// A picture that even with fewer points would exceed [`SVG_BYTES_MAX`] is left out with a note.
#[must_use]
pub fn plots(report: &RunReport, signals: &RunSignals) -> Pictures {
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
    let swing = match report.scenario.turntable.motion.class() {
        MotionClass::Swing { frequency_hz, .. } => swing::picture(report, signals, frequency_hz),
        _ => None,
    };
    let pictures = [
        ("rate.svg", rate::picture(&report.measured(), signals)),
        ("before-after.svg", before_after::picture(report, signals)),
        ("allan.svg", allan::picture(&report.measured())),
        ("swing.svg", swing),
        ("bode.svg", bode::picture(report)),
        ("response.svg", response::picture(report)),
        ("scale-factor.svg", scale_factor::picture(report)),
        ("spectrum.svg", spectrum::picture(&report.measured())),
        ("thermal.svg", thermal::picture(report, signals)),
        ("noise-delay.svg", noise_delay::picture(report)),
        ("rate-gain.svg", rate_gain::picture(report)),
        ("filter-response.svg", filter_response::picture(report)),
    ];
    drawn(pictures, &axis)
}

/// A table over several scenarios; nothing if the picture would be too large.
pub(super) fn comparison_svg(table: &ComparedTable) -> Option<String> {
    comparison::picture(table).svg()
}

/// The pictures of a recorded log: `rate.svg`; `allan.svg` and `spectrum.svg` where a channel has
/// the curve.
pub(super) fn log_plots(log: &Measured, signals: &RunSignals) -> Pictures {
    let pictures = [
        ("rate.svg", rate::picture(log, signals)),
        ("allan.svg", allan::picture(log)),
        ("spectrum.svg", spectrum::picture(log)),
    ];
    drawn(pictures, "")
}

/// Those that there are, as SVG, named behind the axis.
fn drawn<const N: usize>(pictures: [(&str, Option<Picture>); N], axis: &str) -> Pictures {
    let mut all = Pictures::default();
    for (name, picture) in pictures {
        if let Some(picture) = picture {
            all.add(format!("{axis}{name}"), &picture);
        }
    }
    all
}
