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
pub(super) mod infer;
pub(super) mod noise_delay;
pub(super) mod rate;
pub(super) mod rate_gain;
pub(super) mod response;
pub(super) mod scale_factor;
pub(super) mod spectrum;
pub(super) mod sweep;
pub(super) mod swing;
pub(super) mod temperature;
pub(super) mod thermal;
pub(super) mod word_length;

pub(super) use budget::budget_svg;
pub(super) use calibration::calibration_svg;

pub(super) use drawing::picture::{Picture, stamped};

use std::collections::BTreeMap;

use crate::comparison::ComparedTable;
use crate::report::record::run::RunOutcome;

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
            None => self.notes.push(too_large(&name)),
        }
    }

    /// Enters all pictures of another set.
    pub fn extend(&mut self, other: Self) {
        self.drawn.extend(other.drawn);
        self.notes.extend(other.notes);
    }
}

/// Why a picture is left out.
fn too_large(name: &str) -> String {
    format!(
        "{name} is left out: it would be larger than {} kB with all that it has to show; fewer filters \
         or channels make it smaller",
        SVG_BYTES_MAX / 1000
    )
}

/// The pictures of a sweep, in the folder of its points.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct SweepPictures {
    /// Name of the sweep, which is that of its folder.
    pub sweep: String,
    /// Those that are small enough: file name, what is shown, text.
    pub drawn: Vec<[String; 3]>,
    /// What to say of each that is not, and is left out.
    pub notes: Vec<String>,
}

/// The pictures of every sweep of two points or more of which all have ended; `is_whole` says of a name
/// whether the runs are all of its points.
#[must_use]
pub fn sweep_pictures(runs: &[RunOutcome], is_whole: &dyn Fn(&str) -> bool) -> Vec<SweepPictures> {
    let mut sweeps: BTreeMap<&str, Vec<&RunOutcome>> = BTreeMap::new();
    for run in runs.iter().filter(|run| run.sweep.is_some()) {
        sweeps.entry(&run.name).or_default().push(run);
    }
    let has_ended = |points: &[&RunOutcome]| points.iter().all(|point| !point.is_not_run);
    let ended = sweeps.into_iter();
    let ended =
        ended.filter(|(name, points)| points.len() > 1 && is_whole(name) && has_ended(points));
    ended
        .map(|(name, points)| pictures_of(name, &points))
        .collect()
}

fn pictures_of(name: &str, points: &[&RunOutcome]) -> SweepPictures {
    let mut all = SweepPictures {
        sweep: name.to_owned(),
        ..SweepPictures::default()
    };
    for sweep::SweepPicture {
        name,
        holds,
        picture,
    } in sweep::pictures(name, points)
    {
        match picture.svg() {
            Some(svg) => {
                let svg = stamped(&svg, env!("CARGO_PKG_VERSION"), None);
                all.drawn.push([name, holds, svg]);
            }
            None => all.notes.push(too_large(&name)),
        }
    }
    all
}

/// A table over several scenarios; nothing if the picture would be too large.
pub(super) fn comparison_svg(table: &ComparedTable) -> Option<String> {
    let svg = comparison::picture(table).svg()?;
    Some(stamped(&svg, env!("CARGO_PKG_VERSION"), None))
}
