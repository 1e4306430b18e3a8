//! One picture for each headline metric.

use super::super::drawing::panel::WIDTH;
use super::super::drawing::picture::{Anchor, Picture};
use super::super::drawing::series::real;
use super::keys::SweptKey;
use super::sheet::{Layout, Sheet};
use super::{cells, lines};
use crate::metrics::{MetricKey, known_metrics};
use crate::report::record::run::RunOutcome;

/// Most settings of the other keys that have lines of their own.
const LINES_MAX: usize = 6;
/// First line of a picture below its heading, and room below it for the keys that stay the same.
const TOP: f64 = 64.0;
/// Heights of a lone panel, of one of several, and of what stands below each.
const LONE: f64 = 430.0;
const PANEL: f64 = 270.0;
const BELOW: f64 = 78.0;

/// A picture of a sweep.
pub(in crate::report) struct SweepPicture {
    /// Name of its file, in the folder of the sweep.
    pub(in crate::report) name: String,
    /// What it shows.
    pub(in crate::report) holds: String,
    pub(in crate::report) picture: Picture,
}

/// The pictures of the points of a sweep, in their order: one for each headline metric that a channel has.
pub(in crate::report) fn pictures(name: &str, points: &[&RunOutcome]) -> Vec<SweepPicture> {
    let keys = SweptKey::of(points);
    let Some(plan) = Layout::of(&keys, points.len()) else {
        return Vec::new();
    };
    let is_shown = |key: &&&MetricKey| {
        let mut figures = points.iter().flat_map(|point| &point.swept);
        figures.any(|figure| figure.key == **key)
    };
    let shown = known_metrics().iter().filter(is_shown);
    let drawn = shown.map(|key| {
        let sheet = Sheet::of(points, key, &plan);
        let title = format!("{name}: {} over {}", key.title(), plan.along.name);
        SweepPicture {
            name: format!("{}.svg", key.name.replace('_', "-")),
            holds: format!("{} over {}", key.title(), plan.names()),
            picture: picture(&sheet, &title, &plan),
        }
    });
    drawn.collect()
}

/// The picture of a metric.
fn picture(sheet: &Sheet, title: &str, plan: &Layout) -> Picture {
    let is_lone = plan.others.is_empty();
    let (panels, height) = if is_lone {
        (1, LONE)
    } else {
        (sheet.channels.len(), PANEL)
    };
    let mut picture = Picture::new(WIDTH, TOP + (height + BELOW) * real(panels));
    picture.heading((90.0, 26.0), title, 18.0);
    let fixed = plan.fixed_text();
    if !fixed.is_empty() {
        picture.text((90.0, 46.0), &fixed, 12.5, Anchor::Start);
    }
    for (place, channel) in sheet.channels.iter().enumerate() {
        let top = TOP + (height + BELOW) * real(place);
        let frame = (top, top + height);
        if is_lone {
            lines::channels(&mut picture, frame, sheet, plan);
            break;
        } else if plan.settings.len() <= LINES_MAX {
            lines::settings(&mut picture, frame, (sheet, channel), plan);
        } else {
            cells::draw(&mut picture, frame, (sheet, channel), plan);
        }
    }
    picture
}
