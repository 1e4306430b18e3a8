//! `budget.svg`: the noise budget against modulation depth and against power.

use super::drawing::axis::Axis;
use super::drawing::panel::{Legend, Panel, WIDTH};
use super::drawing::picture::{BLACK, Dash, Picture, Point, Shape, Stroke};
use super::drawing::series::{extent, stroke_of};
use crate::gate::plain;
use crate::report::budget::{TOTAL, sources};
use crate::report::plot::stamped;
use crate::signal::{BudgetPoint, BudgetSheet};

/// Sources below this part of the least total are cut off.
const FLOOR: f64 = 0.02;

/// Two panels: every source against depth, and the total against power; nothing if the picture would
/// be too large.
#[must_use]
pub(crate) fn budget_svg(file: &str, sheet: &BudgetSheet) -> Option<String> {
    let mut picture = Picture::new(WIDTH, 900.0);
    let title = format!("{file}: noise budget in closed form");
    picture.heading((90.0, 28.0), &title, 18.0);
    against_depth(&mut picture, sheet, (56.0, 420.0));
    against_power(&mut picture, sheet, (500.0, 840.0));
    let svg = picture.svg()?;
    Some(stamped(&svg, env!("CARGO_PKG_VERSION"), None))
}

fn total_stroke() -> Stroke {
    Stroke::solid(BLACK, 2.5)
}

/// The points of a source that are positive, in runs without gaps.
fn runs(
    points: &[BudgetPoint],
    source: &str,
    abscissa: impl Fn(&BudgetPoint) -> f64,
) -> Vec<Vec<Point>> {
    points
        .chunk_by(|a, b| a.walk(source).is_some() == b.walk(source).is_some())
        .map(|run| {
            run.iter()
                .filter_map(|point| Some((abscissa(point), point.walk(source)?)))
                .filter(|(_, walk)| *walk > 0.0)
                .collect()
        })
        .collect()
}

/// The y axis over totals, with room for the sources below them.
fn walk_axis<'a>(points: impl Iterator<Item = &'a BudgetPoint>, floor: f64) -> Axis {
    let totals = points.filter_map(|point| point.walk(TOTAL));
    let (low, high) = extent(totals.filter(|walk| *walk > 0.0)).unwrap_or((1e-3, 1e-2));
    Axis::log((floor * low, high), 0.03, "angle random walk [deg/sqrt(h)]")
}

fn against_depth(picture: &mut Picture, sheet: &BudgetSheet, place: (f64, f64)) {
    let depth = |point: &BudgetPoint| point.modulation_depth_deg;
    let range = extent(sheet.by_depth.iter().map(depth)).unwrap_or((0.0, 180.0));
    let x = Axis::linear(
        range,
        0.0,
        "modulation depth [deg], at the configured power",
    );
    let y = walk_axis(sheet.by_depth.iter(), FLOOR);
    let panel = Panel::new(picture, place, x, y);
    let mut legend = Legend::new(place.0);
    for (index, source) in sources(&sheet.by_depth).into_iter().enumerate() {
        let stroke = if source == TOTAL {
            total_stroke()
        } else {
            // The first colour is that of the raw channel, which is no source.
            stroke_of(index + 1)
        };
        let lines = runs(&sheet.by_depth, source, depth);
        let is_on = lines.iter().any(|line| !line.is_empty());
        for line in lines {
            panel.line(picture, &line, stroke);
        }
        legend.line(picture, stroke, source);
        if !is_on {
            legend.detail(picture, "none");
        } else if let Some(walk) = sheet.configured.walk(source) {
            legend.detail(picture, &format!("{walk:.2e} deg/sqrt(h) as configured"));
        }
    }
    if let Some((last, others)) = sheet.replaced_sources.split_last() {
        legend.text(picture, "equivalent: of a data sheet, for");
        legend.text(picture, &format!("{} and {last}", others.join(", ")));
    }
    legend.space();
    let configured = &sheet.configured;
    let looks = [
        (Some(configured), Shape::Circle, "configured"),
        (sheet.optimum.as_ref(), Shape::Triangle, "least noise"),
    ];
    for (point, shape, name) in looks {
        let Some((point, total)) = point.and_then(|point| Some((point, point.walk(TOTAL)?))) else {
            continue;
        };
        panel.marker(picture, (depth(point), total), shape, BLACK);
        let text = format!("{name}: {:.1} deg, {total:.2e}", depth(point));
        legend.marker(picture, (shape, BLACK), &text);
    }
    say_where_lines_end(picture, &mut legend, &sheet.by_depth, is_replaced(sheet));
}

/// Whether the walk of a data sheet stands in the place of sources.
fn is_replaced(sheet: &BudgetSheet) -> bool {
    !sheet.replaced_sources.is_empty()
}

fn say_where_lines_end(
    picture: &mut Picture,
    legend: &mut Legend,
    points: &[BudgetPoint],
    is_replaced: bool,
) {
    if points.iter().any(|point| point.walk(TOTAL).is_none()) {
        legend.text(picture, "a line ends where the bias point leaves");
        legend.text(picture, "the converter's range");
        if is_replaced {
            legend.text(picture, "or rounding takes most of the walk");
        }
    }
}

fn against_power(picture: &mut Picture, sheet: &BudgetSheet, place: (f64, f64)) {
    let power = |point: &BudgetPoint| point.power_uw;
    let range = extent(sheet.by_power.iter().map(power)).unwrap_or((0.1, 10.0));
    let x = Axis::log(range, 0.0, "power [uW], mean over a fringe at the detector");
    let both = sheet
        .by_power
        .iter()
        .chain(&sheet.by_power_at_optimum_depth);
    let panel = Panel::new(picture, place, x, walk_axis(both, 1.0));
    let mut legend = Legend::new(place.0);
    let configured = &sheet.configured;
    let at_depth = format!("total at {} deg", plain(configured.modulation_depth_deg));
    let best = Stroke {
        dash: Dash::Long,
        ..stroke_of(2)
    };
    for (points, stroke, name) in [
        (&sheet.by_power, total_stroke(), at_depth.as_str()),
        (
            &sheet.by_power_at_optimum_depth,
            best,
            "total, each at its best depth",
        ),
    ] {
        for line in runs(points, TOTAL, power) {
            panel.line(picture, &line, stroke);
        }
        legend.line(picture, stroke, name);
    }
    if let Some(total) = configured.walk(TOTAL) {
        panel.marker(picture, (power(configured), total), Shape::Circle, BLACK);
        let text = format!("configured: {} uW", plain(power(configured)));
        legend.marker(picture, (Shape::Circle, BLACK), &text);
    }
    say_where_lines_end(picture, &mut legend, &sheet.by_power, is_replaced(sheet));
}
