//! A frame with two axes, and the legend beside it.

use super::axis::Axis;
use super::picture::{Anchor, BLACK, Colour, PALE, Picture, Point, Shape, Stroke, text_width};
use crate::gate::three_digits;
use crate::metrics::ChannelMetrics;
use crate::metrics::catalogue::DC_GAIN;
use crate::report::layout::json::object;

/// Width of every picture, pixels.
pub(in crate::report::plot) const WIDTH: f64 = 1200.0;
/// Left edge of the frames.
pub(in crate::report::plot) const LEFT: f64 = 90.0;
/// Right edge of the frames; the legend stands to the right of it.
pub(in crate::report::plot) const RIGHT: f64 = 880.0;
/// Left edge of the legend.
const LEGEND: f64 = 900.0;
const SMALL: f64 = 13.0;
/// What is left free at the right edge of a picture.
const EDGE: f64 = 8.0;
/// DC gains below this one are told beside the curves that they lower.
const GAIN_MIN: f64 = 0.98;

/// A frame that maps data to pixels.
pub(in crate::report::plot) struct Panel {
    left: f64,
    top: f64,
    bottom: f64,
    x: Axis,
    y: Axis,
}

impl Panel {
    /// Draws frame, grid, ticks and titles, and returns the frame.
    pub(in crate::report::plot) fn new(
        picture: &mut Picture,
        frame: (f64, f64),
        x: Axis,
        y: Axis,
    ) -> Self {
        Self::from_left(picture, LEFT, frame, (x, y))
    }

    /// As [`Self::new`], with a left edge that leaves room for long labels.
    pub(in crate::report::plot) fn from_left(
        picture: &mut Picture,
        left: f64,
        (top, bottom): (f64, f64),
        (x, y): (Axis, Axis),
    ) -> Self {
        let panel = Self {
            left,
            top,
            bottom,
            x,
            y,
        };
        let frame = object([
            ("left", left.into()),
            ("right", RIGHT.into()),
            ("top", top.into()),
            ("bottom", bottom.into()),
            ("x", panel.x.json()),
            ("y", panel.y.json()),
        ]);
        picture.frame(frame.into());
        for (axis, is_x) in [(&panel.x, true), (&panel.y, false)] {
            for value in axis
                .minor
                .iter()
                .chain(axis.ticks.iter().map(|(value, _)| value))
            {
                picture.line(panel.grid_line(*value, is_x), Stroke::solid(PALE, 0.75));
            }
            for (value, label) in &axis.ticks {
                if is_x {
                    let at = (panel.place_x(*value), bottom + 14.0);
                    picture.text(at, label, SMALL, Anchor::Middle);
                } else {
                    let at = (left - 7.0, panel.place_y(*value));
                    picture.text(at, label, SMALL, Anchor::End);
                }
            }
        }
        panel.outline(picture);
        let below = (0.5 * (left + RIGHT), bottom + 34.0);
        picture.text(below, &panel.x.title, 14.0, Anchor::Middle);
        picture.upright_text((22.0, 0.5 * (top + bottom)), &panel.y.title, 14.0);
        panel
    }

    /// Draws the frame, once more over what fills it to its edges.
    pub(in crate::report::plot) fn outline(&self, picture: &mut Picture) {
        let (top, bottom) = (self.top, self.bottom);
        let corners = [
            (self.left, top),
            (RIGHT, top),
            (RIGHT, bottom),
            (self.left, bottom),
            (self.left, top),
        ];
        picture.line(corners.to_vec(), Stroke::solid(BLACK, 1.0));
    }

    /// The abscissa that stands some pixels beside another.
    pub(in crate::report::plot) fn beside(&self, x: f64, pixels: f64) -> f64 {
        self.x.moved(x, pixels / (RIGHT - self.left))
    }

    fn grid_line(&self, value: f64, is_x: bool) -> Vec<Point> {
        if is_x {
            let x = self.place_x(value);
            vec![(x, self.top), (x, self.bottom)]
        } else {
            let y = self.place_y(value);
            vec![(self.left, y), (RIGHT, y)]
        }
    }

    fn place_x(&self, value: f64) -> f64 {
        self.left + self.x.fraction(value) * (RIGHT - self.left)
    }

    fn place_y(&self, value: f64) -> f64 {
        self.bottom - self.y.fraction(value) * (self.bottom - self.top)
    }

    /// Where a point of data stands, pixels.
    pub(in crate::report::plot) fn place(&self, (x, y): (f64, f64)) -> Point {
        (self.place_x(x), self.place_y(y))
    }

    /// Range of the x axis.
    pub(in crate::report::plot) fn x_range(&self) -> (f64, f64) {
        self.x.range()
    }

    /// Draws a line through points of data, cut off at the frame.
    pub(in crate::report::plot) fn line(
        &self,
        picture: &mut Picture,
        data: &[(f64, f64)],
        stroke: Stroke,
    ) {
        let mut piece: Vec<Point> = Vec::new();
        for pair in data.windows(2) {
            let Some((start, end)) = self.clipped(self.place(pair[0]), self.place(pair[1])) else {
                picture.line(std::mem::take(&mut piece), stroke);
                continue;
            };
            let continues = piece
                .last()
                .is_some_and(|(x, y)| (x - start.0).abs() + (y - start.1).abs() < 1e-6);
            if !continues {
                picture.line(std::mem::take(&mut piece), stroke);
                piece.push(start);
            }
            piece.push(end);
        }
        picture.line(piece, stroke);
    }

    /// Draws an upright interval, cut off at the frame.
    pub(in crate::report::plot) fn bar(
        &self,
        picture: &mut Picture,
        x: f64,
        (low, high): (f64, f64),
        stroke: Stroke,
    ) {
        // What has no place on a logarithmic axis lies below it.
        let low = if self.place_y(low).is_finite() {
            low
        } else {
            self.y.range().0
        };
        self.line(picture, &[(x, low), (x, high)], stroke);
    }

    /// Fills between two lines over the same abscissae, cut off at the frame.
    pub(in crate::report::plot) fn band(
        &self,
        picture: &mut Picture,
        data: &[(f64, f64, f64)],
        colour: Colour,
        opacity: f64,
    ) {
        let inside = |(x, y): Point| (x.clamp(self.left, RIGHT), y.clamp(self.top, self.bottom));
        let lower = data
            .iter()
            .map(|(x, low, _)| inside(self.place((*x, *low))));
        let upper = data
            .iter()
            .rev()
            .map(|(x, _, high)| inside(self.place((*x, *high))));
        picture.area(lower.chain(upper).collect(), colour, opacity);
    }

    /// Draws a marker if it lies inside the frame.
    pub(in crate::report::plot) fn marker(
        &self,
        picture: &mut Picture,
        data: (f64, f64),
        shape: Shape,
        colour: Colour,
    ) {
        let (x, y) = self.place(data);
        if (self.left..=RIGHT).contains(&x) && (self.top..=self.bottom).contains(&y) {
            picture.marker((x, y), shape, colour);
        }
    }

    /// The part of a segment inside the frame (Liang and Barsky).
    fn clipped(&self, start: Point, end: Point) -> Option<(Point, Point)> {
        let (dx, dy) = (end.0 - start.0, end.1 - start.1);
        let mut enter = 0.0_f64;
        let mut leave = 1.0_f64;
        let edges = [
            (-dx, start.0 - self.left),
            (dx, RIGHT - start.0),
            (-dy, start.1 - self.top),
            (dy, self.bottom - start.1),
        ];
        for (speed, distance) in edges {
            if !(speed.is_finite() && distance.is_finite()) {
                return None;
            }
            if speed.abs() < 1e-12 {
                if distance < 0.0 {
                    return None;
                }
            } else if speed < 0.0 {
                enter = enter.max(distance / speed);
            } else {
                leave = leave.min(distance / speed);
            }
        }
        let at = |part: f64| (start.0 + part * dx, start.1 + part * dy);
        (enter <= leave).then(|| (at(enter), at(leave)))
    }
}

/// Room for the name beside a sample, and its size, pixels.
pub(in crate::report::plot) const NAME_ROOM: f64 = WIDTH - LEGEND - SAMPLE - EDGE;
pub(in crate::report::plot) const NAME_SIZE: f64 = 14.0;
const SAMPLE: f64 = 42.0;

/// Text and samples to the right of the frames.
pub(in crate::report::plot) struct Legend {
    y: f64,
}

impl Legend {
    /// A legend that starts at a height.
    pub(in crate::report::plot) fn new(top: f64) -> Self {
        Self { y: top + 10.0 }
    }

    /// A legend that starts at a height, or below another that reaches further down.
    pub(in crate::report::plot) fn below(above: &Self, top: f64) -> Self {
        Self {
            y: above.y.max(top + 10.0),
        }
    }

    /// A line sample with its name.
    pub(in crate::report::plot) fn line(
        &mut self,
        picture: &mut Picture,
        stroke: Stroke,
        text: &str,
    ) {
        let points = vec![(LEGEND, self.y), (LEGEND + 34.0, self.y)];
        picture.line(
            points,
            Stroke {
                opacity: 1.0,
                ..stroke
            },
        );
        self.text_at(picture, LEGEND + SAMPLE, text, NAME_SIZE);
    }

    /// A marker with its meaning.
    pub(in crate::report::plot) fn marker(
        &mut self,
        picture: &mut Picture,
        look: (Shape, Colour),
        text: &str,
    ) {
        picture.marker((LEGEND + 17.0, self.y), look.0, look.1);
        self.text_at(picture, LEGEND + SAMPLE, text, 12.5);
    }

    /// A line sample with the marker on it.
    pub(in crate::report::plot) fn curve(
        &mut self,
        picture: &mut Picture,
        stroke: Stroke,
        shape: Shape,
        text: &str,
    ) {
        let y = self.y;
        self.line(picture, stroke, text);
        picture.marker((LEGEND + 17.0, y), shape, stroke.colour);
    }

    /// A filled sample with its meaning, for a band or an area of a colour.
    pub(in crate::report::plot) fn area(
        &mut self,
        picture: &mut Picture,
        (colour, opacity): (Colour, f64),
        text: &str,
    ) {
        let (left, right) = (LEGEND, LEGEND + 34.0);
        let (top, bottom) = (self.y - 6.0, self.y + 6.0);
        let corners = vec![(left, top), (right, top), (right, bottom), (left, bottom)];
        picture.area(corners, colour, opacity);
        self.text_at(picture, LEGEND + SAMPLE, text, 12.5);
    }

    /// A remark.
    pub(in crate::report::plot) fn text(&mut self, picture: &mut Picture, text: &str) {
        self.text_at(picture, LEGEND, text, 12.5);
    }

    /// An indented remark that belongs to the entry above.
    pub(in crate::report::plot) fn detail(&mut self, picture: &mut Picture, text: &str) {
        self.text_at(picture, LEGEND + SAMPLE, text, 12.5);
    }

    /// Leaves room.
    pub(in crate::report::plot) fn space(&mut self) {
        self.y += 10.0;
    }

    /// Says of a channel that its DC gain lowers what is drawn of it.
    pub(in crate::report::plot) fn gain(
        &mut self,
        picture: &mut Picture,
        channel: &ChannelMetrics,
    ) {
        let gain = channel.get(&DC_GAIN).map(|metric| metric.estimate);
        if let Some(gain) = gain.filter(|gain| gain.high.abs() < GAIN_MIN) {
            let text = format!("DC gain {}: lower by that alone", three_digits(gain.value));
            self.detail(picture, &text);
        }
    }

    /// A text in as many lines as end before the edge of the picture.
    fn text_at(&mut self, picture: &mut Picture, x: f64, text: &str, size: f64) {
        let room = WIDTH - x - EDGE;
        let mut line = String::new();
        for word in unbroken(text) {
            let longer = match line.as_str() {
                "" => word.clone(),
                line => format!("{line} {word}"),
            };
            if !line.is_empty() && text_width(&longer, size) > room {
                picture.text((x, self.y), &line, size, Anchor::Start);
                self.y += size + 3.0;
                word.clone_into(&mut line);
            } else {
                line = longer;
            }
        }
        picture.text((x, self.y), &line, size, Anchor::Start);
        picture.reach(self.y + size);
        self.y += size + 7.0;
    }
}

/// The parts of a text between which a line may end: words, and of a setting all three.
fn unbroken(text: &str) -> Vec<String> {
    let mut parts: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match parts.last_mut() {
            Some(last) if word == "=" || last.ends_with(" =") => {
                last.push(' ');
                last.push_str(word);
            }
            _ => parts.push(word.to_owned()),
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_setting_stays_on_one_line() {
        let parts = unbroken("rls.taps = 2, mean.taps = 4 at rest");
        assert_eq!(parts, ["rls.taps = 2,", "mean.taps = 4", "at", "rest"]);
    }
}
