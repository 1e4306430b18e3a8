//! Pictures of an inference: pulls of the figures, densities of the parameters, what is not told apart.

use super::Pictures;
use super::drawing::axis::Axis;
use super::drawing::panel::{Legend, Panel, WIDTH};
use super::drawing::picture::{BLACK, Dash, Picture, Shape, Stroke, stamped};
use super::drawing::series::{index, real, stroke_of, truth_stroke};
use crate::inference::{Found, Judged, Parameter, Ridge};
use crate::report::infer::InferenceSheet;
use crate::report::infer::text::answers;
use crate::vocabulary::Prior;

/// Files of the pictures, with what they show.
pub(in crate::report) const INFER_PICTURES: [(&str, &str); 3] = [
    ("pulls.svg", "figures beside what all others make of them"),
    ("profile.svg", "what the figures say of each parameter"),
    ("ridge.svg", "parameters that are not told apart"),
];
/// Height of one panel with its title, pixels.
const PANEL: f64 = 250.0;
/// Bins of a density.
const BINS: usize = 20;
/// Most limits of a pull that the axis of the pulls reaches.
const LIMITS_SHOWN: f64 = 3.0;
/// Most readings that are drawn.
const READINGS_MAX: usize = 4;
/// Most ridges that are drawn.
const RIDGES_MAX: usize = 6;
/// Most points of a ridge.
const POINTS_MAX: usize = 200;
/// Letters of a reading or a figure in a legend.
const LETTERS_MAX: usize = 38;

/// The pictures of an inference: those of `INFER_PICTURES` that there is something to draw of.
#[must_use]
pub fn infer_pictures(sheet: &InferenceSheet) -> Pictures {
    let drawn = [pulls(sheet), profile(sheet), ridge(sheet)];
    let mut pictures = Pictures::default();
    for ((name, _), picture) in INFER_PICTURES.iter().zip(drawn) {
        if let Some(picture) = picture {
            let svg = picture.svg();
            let svg = svg.map(|svg| stamped(&svg, env!("CARGO_PKG_VERSION"), None));
            pictures.add_svg((*name).to_owned(), svg);
        }
    }
    pictures
}

/// A text cut short to the width of a legend.
fn short(text: &str) -> String {
    if text.chars().count() <= LETTERS_MAX {
        return text.to_owned();
    }
    let kept: String = text.chars().take(LETTERS_MAX - 1).collect();
    kept + "\u{2026}"
}

/// Pulls of the figures by their number, with the limits.
fn pulls(sheet: &InferenceSheet) -> Option<Picture> {
    let figures = &sheet.answer.figures;
    let limit = sheet.answer.pull_limit;
    let told = figures.iter().filter_map(|figure| figure.pull);
    let most = told.map(f64::abs).reduce(f64::max)?.max(limit);
    // One far out would press all others onto the line: it stands at the edge, its pull in the legend.
    let shown = most.min(LIMITS_SHOWN * limit);
    let mut picture = Picture::new(WIDTH, 420.0);
    let heading = format!(
        "{}: figures beside what all others make of them",
        sheet.problem.name
    );
    picture.heading((90.0, 28.0), &heading, 18.0);
    let last = real(figures.len());
    let mut x = Axis::linear(
        (0.5, last + 0.5),
        0.0,
        "figure, in the order of the problem",
    );
    x.minor = Vec::new();
    x.ticks = (1..=figures.len())
        .map(|number| (real(number), number.to_string()))
        .collect();
    let y = Axis::linear(
        (-1.1 * shown, 1.1 * shown),
        0.0,
        "pull, standard deviations",
    );
    let panel = Panel::new(&mut picture, (56.0, 360.0), x, y);
    for at in [-limit, 0.0, limit] {
        let line = [(0.5, at), (last + 0.5, at)];
        panel.line(&mut picture, &line, truth_stroke());
    }
    let (fine, poor) = (stroke_of(2).colour, stroke_of(1).colour);
    let mut legend = Legend::new(56.0);
    legend.marker(&mut picture, (Shape::Circle, fine), "explained");
    legend.marker(&mut picture, (Shape::Diamond, poor), "unexplained");
    legend.line(&mut picture, truth_stroke(), "limit of the pull");
    for (number, figure) in figures.iter().enumerate() {
        let Some(pull) = figure.pull else { continue };
        let drawn = pull.clamp(-shown, shown);
        let (shape, colour) = if figure.is_explained == Some(true) {
            (Shape::Circle, fine)
        } else {
            (Shape::Diamond, poor)
        };
        let at = real(number + 1);
        panel.line(
            &mut picture,
            &[(at, 0.0), (at, drawn)],
            Stroke::solid(colour, 1.25),
        );
        panel.marker(&mut picture, (at, drawn), shape, colour);
        if figure.is_explained != Some(true) {
            let printed = &sheet.problem.published[number];
            let name = format!(
                "{}: {pull:+.1}, {} {}",
                number + 1,
                printed.record,
                printed.metric
            );
            legend.text(&mut picture, &short(&name));
        }
    }
    Some(picture)
}

/// The axis of a parameter.
fn axis(parameter: &Parameter) -> Axis {
    let unit = match parameter.unit {
        "" => String::new(),
        unit => format!(" [{unit}]"),
    };
    let title = format!("{}{unit}", parameter.name);
    let range = (parameter.low, parameter.high);
    match parameter.prior {
        Prior::Uniform => Axis::linear(range, 0.0, &title),
        Prior::LogUniform => Axis::log(range, 0.0, &title),
    }
}

/// Readings that are drawn, with what was found of each.
fn drawn<'a>(sheet: &'a InferenceSheet) -> Vec<(&'a Judged, &'a Found)> {
    let accepted = sheet.answer.accepted();
    let found = accepted.filter_map(|own| Some((own, sheet.found[own.reading].as_ref()?)));
    found.take(READINGS_MAX).collect()
}

/// Density of a parameter over that of its prior, by part of the prior.
fn density(found: &Found, parameter: usize) -> Vec<f64> {
    let mut bins = vec![0.0; BINS];
    for point in &found.points {
        let bin = index(point.parts[parameter] * real(BINS)).min(BINS - 1);
        bins[bin] += real(BINS) / real(found.points.len());
    }
    bins
}

/// One panel for each parameter, a line for each accepted reading.
fn profile(sheet: &InferenceSheet) -> Option<Picture> {
    let readings = drawn(sheet);
    if readings.is_empty() || sheet.parameters.is_empty() {
        return None;
    }
    let mut picture = Picture::new(WIDTH, 60.0 + PANEL * real(sheet.parameters.len()));
    let heading = format!(
        "{}: what the figures say of each parameter",
        sheet.problem.name
    );
    picture.heading((90.0, 28.0), &heading, 18.0);
    for (place, parameter) in sheet.parameters.iter().enumerate() {
        let densities: Vec<Vec<f64>> = readings
            .iter()
            .map(|(_, found)| density(found, place))
            .collect();
        let most = densities.iter().flatten().copied().fold(1.0, f64::max);
        let top = 56.0 + PANEL * real(place);
        let y = Axis::linear((0.0, 1.05 * most), 0.0, "density over the prior's");
        let panel = Panel::new(&mut picture, (top, top + PANEL - 66.0), axis(parameter), y);
        let prior = [(parameter.low, 1.0), (parameter.high, 1.0)];
        panel.line(&mut picture, &prior, truth_stroke());
        for (number, bins) in densities.iter().enumerate() {
            let steps = bins.iter().enumerate().flat_map(|(bin, value)| {
                [bin, bin + 1].map(|edge| (parameter.at(real(edge) / real(BINS)), *value))
            });
            let steps: Vec<(f64, f64)> = steps.collect();
            panel.line(&mut picture, &steps, stroke_of(number + 1));
        }
    }
    let mut legend = Legend::new(56.0);
    legend.line(&mut picture, truth_stroke(), "prior");
    for (number, (judged, _)) in readings.iter().enumerate() {
        let share = format!("reading {}: {:.1} %", number + 1, 100.0 * judged.weight);
        legend.line(&mut picture, stroke_of(number + 1), &share);
        for (question, answer) in &sheet.readings[judged.reading].answers {
            legend.detail(&mut picture, &short(&format!("{question}:")));
            legend.detail(&mut picture, &short(answer));
        }
    }
    Some(picture)
}

/// One panel for each pair of parameters that the figures do not tell apart.
fn ridge(sheet: &InferenceSheet) -> Option<Picture> {
    let ridges = &sheet.answer.ridges;
    let shown: Vec<&Ridge> = ridges.iter().take(RIDGES_MAX).collect();
    (!shown.is_empty()).then_some(())?;
    let mut picture = Picture::new(WIDTH, 60.0 + PANEL * real(shown.len()));
    let heading = format!("{}: parameters that are not told apart", sheet.problem.name);
    picture.heading((90.0, 28.0), &heading, 18.0);
    for (place, ridge) in shown.iter().enumerate() {
        let top = 56.0 + PANEL * real(place);
        let [one, other] = ridge.parameters.map(|own| &sheet.parameters[own]);
        let frame = (top, top + PANEL - 66.0);
        let panel = Panel::new(&mut picture, frame, axis(one), axis(other));
        let stroke = stroke_of(2);
        if let Some(found) = &sheet.found[ridge.reading] {
            let stride = found.points.len().div_ceil(POINTS_MAX).max(1);
            for point in found.points.iter().step_by(stride) {
                let at = ridge
                    .parameters
                    .map(|own| sheet.parameters[own].at(point.parts[own]));
                panel.marker(&mut picture, (at[0], at[1]), Shape::Circle, stroke.colour);
            }
        }
        let ends = sheet.ends(ridge).map(|end| (end[0], end[1]));
        let line = Stroke {
            dash: Dash::Long,
            ..Stroke::solid(BLACK, 1.5)
        };
        panel.line(&mut picture, &ends, line);
        let mut legend = Legend::new(top);
        legend.marker(
            &mut picture,
            (Shape::Circle, stroke.colour),
            "as likely as each other",
        );
        legend.line(&mut picture, line, "from end to end");
        legend.text(
            &mut picture,
            &format!("correlation {:+.2}", ridge.correlation),
        );
        let reading = answers(&sheet.readings[ridge.reading]);
        for answer in reading.split("; ") {
            legend.text(&mut picture, &short(answer));
        }
    }
    Some(picture)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_names_are_cut_short() {
        assert_eq!(short("taps: 4"), "taps: 4");
        let cut = short(&"a".repeat(60));
        assert!(cut.chars().count() == LETTERS_MAX && cut.ends_with('\u{2026}'));
    }
}
