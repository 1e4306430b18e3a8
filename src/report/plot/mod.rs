//! Pictures as SVG: no fonts, no clock, the same bytes from the same records.
//!
//! A file for each picture; what they are drawn with stands in [`drawing`].

pub(super) mod against;
pub(super) mod allan;
pub(super) mod before_after;
pub(super) mod bode;
mod budget;
mod calibration;
mod comparison;
mod drawing;
pub(super) mod filter_response;
pub(super) mod noise_delay;
pub(super) mod rate;
pub(super) mod rate_gain;
pub(super) mod response;
pub(super) mod scale_factor;
pub(super) mod spectrum;
pub(super) mod swing;
pub(super) mod thermal;

pub(super) use budget::budget_svg;
pub(super) use calibration::calibration_svg;

pub(super) use drawing::picture::{Picture, stamped};

use crate::comparison::ComparedTable;

/// Largest size of a picture, bytes: long records are drawn as an envelope per pixel column.
pub const SVG_BYTES_MAX: usize = 500_000;

/// Pictures as file name and SVG text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Pictures {
    /// Those that are small enough.
    pub drawn: Vec<(String, String)>,
    /// What to say of each that is not, and is left out.
    pub notes: Vec<String>,
}

impl Pictures {
    /// Enters the text of a picture, or the note that it is left out: none stands for one that is too large.
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

/// A table over several scenarios; nothing if the picture would be too large.
pub(super) fn comparison_svg(table: &ComparedTable) -> Option<String> {
    let svg = comparison::picture(table).svg()?;
    Some(stamped(&svg, env!("CARGO_PKG_VERSION"), None))
}
