//! A list of things to draw, and the only code that knows plotters.

use super::thin::thinned;
use crate::report::layout::json::object;
use crate::report::plot::SVG_BYTES_MAX;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use serde_json::Value;

/// Distances from where they were that lines may be drawn at, pixels; the first at which the picture is
/// small enough is taken.
const TOLERANCES: [f64; 4] = [0.0, 0.25, 0.5, 1.0];
/// User units per pixel: plotters writes whole numbers, so a finer grid keeps lines smooth.
const SCALE: f64 = 4.0;
/// Font sizes are given as the em; plotters divides what it is told by this.
const FONT_FACTOR: f64 = 1.24;

/// Beginning of what a picture says of itself.
const METADATA: &str = "<metadata>";
/// Room for where a picture comes from.
const ORIGIN_BYTES_MAX: usize = 200;

/// A picture with the version that drew it and, of one scenario, the digest of that.
pub(in crate::report) fn stamped(svg: &str, version: &str, digest: Option<&str>) -> String {
    let scenario = digest.map_or_else(String::new, |digest| format!("\"scenario\":\"{digest}\","));
    let origin =
        format!("{METADATA}{{\"program\":\"fogbench\",\"version\":\"{version}\",{scenario}");
    svg.replacen(&format!("{METADATA}{{"), &origin, 1)
}

/// A colour.
pub(in crate::report) type Colour = (u8, u8, u8);
/// Text, frames, truth.
pub(in crate::report) const BLACK: Colour = (0x22, 0x22, 0x22);
/// Grid lines.
pub(in crate::report) const PALE: Colour = (0xdd, 0xdd, 0xdd);
/// Lines that help the eye.
pub(in crate::report) const GREY: Colour = (0x66, 0x66, 0x66);

/// Pattern of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::report) enum Dash {
    Solid = 0,
    Long = 1,
    Mixed = 2,
    Dotted = 3,
}

impl Dash {
    /// The SVG dash array in pixels.
    fn array(self) -> &'static [u32] {
        match self {
            Self::Solid => &[],
            Self::Long => &[9, 4],
            Self::Mixed => &[9, 3, 2, 3],
            Self::Dotted => &[2, 3],
        }
    }
}

/// How a line looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::report) struct Stroke {
    pub(in crate::report) colour: Colour,
    /// Pixels, in quarters.
    pub(in crate::report) width: f64,
    pub(in crate::report) dash: Dash,
    pub(in crate::report) opacity: f64,
}

impl Stroke {
    pub(in crate::report) fn solid(colour: Colour, width: f64) -> Self {
        Self {
            colour,
            width,
            dash: Dash::Solid,
            opacity: 1.0,
        }
    }
}

/// Which end of a text stands at its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::report) enum Anchor {
    Start,
    Middle,
    End,
}

/// Shape of a marker.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::report) enum Shape {
    Circle,
    Square,
    Triangle,
    /// A triangle on its point.
    Wedge,
    Diamond,
}

/// A point in pixels from the upper left corner.
pub(in crate::report) type Point = (f64, f64);

enum Item {
    Line(Vec<Point>, Stroke),
    Area(Vec<Point>, Colour, f64),
    Marker(Point, Shape, Colour),
    Text {
        at: Point,
        text: String,
        size: f64,
        anchor: Anchor,
        colour: Colour,
        upright: bool,
        bold: bool,
    },
}

/// Width of a text of a size, pixels, as wide as sans-serif fonts of common systems draw it.
pub(in crate::report) fn text_width(text: &str, size: f64) -> f64 {
    const WIDE: f64 = 0.9;
    const NARROW: f64 = 0.33;
    const USUAL: f64 = 0.6;
    let of = |letter: char| match letter {
        'm' | 'w' | 'M' | 'W' | '%' => WIDE,
        'i' | 'j' | 'l' | 't' | 'f' | 'r' | ' ' | '.' | ',' | ':' | '(' | ')' | '/' | '[' | ']' => {
            NARROW + 0.05
        }
        _ => USUAL,
    };
    size * text.chars().map(of).sum::<f64>()
}

/// A picture under construction.
pub(in crate::report) struct Picture {
    size: (f64, f64),
    items: Vec<Item>,
    /// Frames with their axes, in JSON.
    frames: Vec<Value>,
}

impl Picture {
    /// An empty picture of a size in pixels.
    pub(in crate::report) fn new(width: f64, height: f64) -> Self {
        Self {
            size: (width, height),
            items: Vec::new(),
            frames: Vec::new(),
        }
    }

    /// Makes the picture high enough for what ends at a height, pixels.
    pub(in crate::report) fn reach(&mut self, bottom: f64) {
        self.size.1 = self.size.1.max(bottom.ceil());
    }

    /// Notes a frame with its axes, by which a program reads values off the picture.
    pub(in crate::report) fn frame(&mut self, frame: Value) {
        self.frames.push(frame);
    }

    pub(in crate::report) fn line(&mut self, points: Vec<Point>, stroke: Stroke) {
        if points.len() > 1 {
            self.items.push(Item::Line(points, stroke));
        }
    }

    pub(in crate::report) fn area(&mut self, points: Vec<Point>, colour: Colour, opacity: f64) {
        if points.len() > 2 {
            self.items.push(Item::Area(points, colour, opacity));
        }
    }

    pub(in crate::report) fn marker(&mut self, at: Point, shape: Shape, colour: Colour) {
        self.items.push(Item::Marker(at, shape, colour));
    }

    /// Level text of a size in pixels.
    pub(in crate::report) fn text(&mut self, at: Point, text: &str, size: f64, anchor: Anchor) {
        self.push_text(at, text, size, anchor, (BLACK, false, false));
    }

    /// Level text in a colour.
    pub(in crate::report) fn coloured_text(
        &mut self,
        at: Point,
        text: &str,
        size: f64,
        colour: Colour,
    ) {
        self.push_text(at, text, size, Anchor::Start, (colour, false, false));
    }

    /// Level text in a colour with its middle at a point.
    pub(in crate::report) fn centred_text(
        &mut self,
        at: Point,
        text: &str,
        size: f64,
        colour: Colour,
    ) {
        self.push_text(at, text, size, Anchor::Middle, (colour, false, false));
    }

    /// Bold level text.
    pub(in crate::report) fn heading(&mut self, at: Point, text: &str, size: f64) {
        self.push_text(at, text, size, Anchor::Start, (BLACK, false, true));
    }

    /// Text that reads from bottom to top, centred on its point.
    pub(in crate::report) fn upright_text(&mut self, at: Point, text: &str, size: f64) {
        self.push_text(at, text, size, Anchor::Middle, (BLACK, true, false));
    }

    fn push_text(
        &mut self,
        at: Point,
        text: &str,
        size: f64,
        anchor: Anchor,
        (colour, upright, bold): (Colour, bool, bool),
    ) {
        self.items.push(Item::Text {
            at,
            text: text.to_owned(),
            size,
            anchor,
            colour,
            upright,
            bold,
        });
    }

    /// The picture as SVG text of at most [`SVG_BYTES_MAX`] bytes; nothing if it cannot be had.
    ///
    /// A picture that would be larger is drawn with fewer points: lines and edges stay within a part
    /// of a pixel, at last within one, of where they were.
    pub(in crate::report) fn svg(&self) -> Option<String> {
        let mut svgs = TOLERANCES
            .into_iter()
            .map(|tolerance| self.drawn(tolerance));
        svgs.find(|svg| svg.len() + ORIGIN_BYTES_MAX <= SVG_BYTES_MAX)
    }

    /// What the picture is, for programs: its size and its frames; [`stamped`] adds where it comes from.
    fn metadata(&self) -> String {
        let record = object([
            ("width", self.size.0.into()),
            ("height", self.size.1.into()),
            ("panels", self.frames.clone().into()),
        ]);
        let text = Value::from(record).to_string();
        let text = text
            .replace('&', "&amp;")
            .replace('<', "&lt;")
            .replace('>', "&gt;");
        format!("\n{METADATA}{text}</metadata>")
    }

    /// The picture with lines within a distance of where they were, pixels.
    ///
    /// plotters has no dashes: the pattern travels in the last two bits of the stroke width, which
    /// is otherwise a multiple of four, and is written out here.
    fn drawn(&self, tolerance: f64) -> String {
        let mut svg = String::new();
        let (width, height) = (units_u32(self.size.0), units_u32(self.size.1));
        {
            let root = SVGBackend::with_string(&mut svg, (width, height)).into_drawing_area();
            let drawn = root
                .fill(&WHITE)
                .and_then(|()| {
                    self.items
                        .iter()
                        .try_for_each(|item| draw(&root, item, tolerance))
                })
                .and_then(|()| root.present());
            drawn.expect("drawing into memory cannot fail");
        }
        let head = format!("<svg width=\"{width}\" height=\"{height}\"");
        let shown = format!(
            "<svg width=\"{}\" height=\"{}\" stroke-linejoin=\"round\"",
            self.size.0, self.size.1
        );
        svg = svg.replacen(&head, &shown, 1);
        let end = svg.find('>').map_or(0, |at| at + 1);
        svg.insert_str(end, &self.metadata());
        for quarter_pixels in 1..=12_u32 {
            for dash in [Dash::Long, Dash::Mixed, Dash::Dotted] {
                let coded = coded_width(quarter_pixels, dash);
                let pattern: Vec<String> = dash
                    .array()
                    .iter()
                    .map(|pixels| (pixels * 4).to_string())
                    .collect();
                svg = svg.replace(
                    &format!("stroke-width=\"{coded}\""),
                    &format!(
                        "stroke-width=\"{quarter_pixels}\" stroke-dasharray=\"{}\"",
                        pattern.join(",")
                    ),
                );
            }
        }
        svg
    }
}

/// Stroke widths of dashed lines lie above all real ones, so that none is mistaken for another.
fn coded_width(quarter_pixels: u32, dash: Dash) -> u32 {
    match dash {
        Dash::Solid => quarter_pixels,
        other => 1000 + 4 * quarter_pixels + other as u32,
    }
}

fn units(pixels: f64) -> i32 {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a saturating cast of a pixel position is what is wanted"
    )]
    let units = (pixels * SCALE).round() as i32;
    units
}

fn units_u32(pixels: f64) -> u32 {
    u32::try_from(units(pixels)).unwrap_or(0)
}

fn units_of(points: &[Point]) -> Vec<(i32, i32)> {
    points.iter().map(|(x, y)| (units(*x), units(*y))).collect()
}

/// [`units_of`] the points that keep a line within a distance of where it was; all of them at 0.
fn units_within(points: &[Point], tolerance: f64) -> Vec<(i32, i32)> {
    if tolerance > 0.0 {
        units_of(&thinned(points, tolerance))
    } else {
        units_of(points)
    }
}

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;
type DrawError<'a> = DrawingAreaErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>;

fn draw<'a>(root: &Area<'a>, item: &Item, tolerance: f64) -> Result<(), DrawError<'a>> {
    let rgb = |colour: &Colour| RGBColor(colour.0, colour.1, colour.2);
    match item {
        Item::Line(points, stroke) => {
            let width = coded_width(units_u32(stroke.width).max(1), stroke.dash);
            let colour = rgb(&stroke.colour).mix(stroke.opacity);
            root.draw(&PathElement::new(
                units_within(points, tolerance),
                colour.stroke_width(width),
            ))
        }
        Item::Area(points, colour, opacity) => {
            let colour = rgb(colour).mix(*opacity);
            root.draw(&Polygon::new(
                units_within(points, tolerance),
                colour.filled(),
            ))
        }
        Item::Marker(at, shape, colour) => draw_marker(root, *at, *shape, rgb(colour)),
        Item::Text {
            at,
            text,
            size,
            anchor,
            colour,
            upright,
            bold,
        } => {
            let horizontal = match anchor {
                Anchor::Start => HPos::Left,
                Anchor::Middle => HPos::Center,
                Anchor::End => HPos::Right,
            };
            let weight = if *bold {
                FontStyle::Bold
            } else {
                FontStyle::Normal
            };
            let mut font = FontDesc::new(FontFamily::SansSerif, size * SCALE * FONT_FACTOR, weight);
            if *upright {
                font = font.transform(FontTransform::Rotate270);
            }
            let colour = rgb(colour);
            let style = TextStyle::from(font)
                .color(&colour)
                .pos(Pos::new(horizontal, VPos::Center));
            let at = (units(at.0), units(at.1));
            root.draw(&Text::new(text.as_str(), at, style))
        }
    }
}

fn draw_marker<'a>(
    root: &Area<'a>,
    (x, y): Point,
    shape: Shape,
    colour: RGBColor,
) -> Result<(), DrawError<'a>> {
    let radius = 5.0;
    let corners = match shape {
        Shape::Circle => {
            root.draw(&Circle::new(
                (units(x), units(y)),
                units(radius),
                colour.filled(),
            ))?;
            let ring = BLACK_RING.stroke_width(4);
            return root.draw(&Circle::new((units(x), units(y)), units(radius), ring));
        }
        Shape::Square => vec![
            (-1.0, -1.0),
            (1.0, -1.0),
            (1.0, 1.0),
            (-1.0, 1.0),
            (-1.0, -1.0),
        ],
        Shape::Triangle => vec![(0.0, -1.2), (1.1, 0.9), (-1.1, 0.9), (0.0, -1.2)],
        Shape::Wedge => vec![(0.0, 1.2), (1.1, -0.9), (-1.1, -0.9), (0.0, 1.2)],
        Shape::Diamond => vec![
            (0.0, -1.3),
            (1.3, 0.0),
            (0.0, 1.3),
            (-1.3, 0.0),
            (0.0, -1.3),
        ],
    };
    let corners: Vec<Point> = corners
        .into_iter()
        .map(|(dx, dy): Point| (x + radius * dx, y + radius * dy))
        .collect();
    root.draw(&Polygon::new(units_of(&corners), colour.filled()))?;
    root.draw(&PathElement::new(
        units_of(&corners),
        BLACK_RING.stroke_width(4),
    ))
}

const BLACK_RING: RGBColor = RGBColor(BLACK.0, BLACK.1, BLACK.2);
