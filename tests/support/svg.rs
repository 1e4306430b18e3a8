//! Pictures read back: texts, markers and lines with their places in pixels.

use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;
use serde_json::Value;

/// Units of a picture per pixel.
const SCALE: f64 = 4.0;

/// Corners of a line or an area.
pub(crate) type Points = Vec<(f64, f64)>;

/// A text: the point that it stands at, its anchor, its size and what it says.
#[derive(Clone, Debug)]
pub(crate) struct Label {
    pub(crate) at: (f64, f64),
    pub(crate) anchor: String,
    pub(crate) size: f64,
    pub(crate) text: String,
}

/// What a picture holds.
#[derive(Clone, Debug, Default)]
pub(crate) struct Svg {
    /// Width and height.
    pub(crate) size: (f64, f64),
    pub(crate) labels: Vec<Label>,
    /// Middles of the circles.
    pub(crate) circles: Vec<(f64, f64)>,
    /// Lines: colour and points.
    pub(crate) lines: Vec<(String, Points)>,
    /// Areas: colour, opacity and corners.
    pub(crate) areas: Vec<(String, f64, Points)>,
    /// What it says of its frames.
    pub(crate) panels: Vec<Value>,
}

impl Svg {
    /// Reads a picture, which must be well-formed.
    pub(crate) fn read(text: &str) -> Self {
        let mut svg = Self::default();
        let mut reader = Reader::from_str(text);
        let mut open = String::new();
        loop {
            match reader.read_event().expect("well-formed") {
                Event::Start(start) => {
                    open = String::from_utf8_lossy(start.name().as_ref()).into_owned();
                    svg.enter(&open, &start);
                }
                Event::Empty(start) => {
                    let name = String::from_utf8_lossy(start.name().as_ref()).into_owned();
                    svg.enter(&name, &start);
                }
                Event::Text(text) => {
                    let text = String::from_utf8_lossy(&text).trim().to_owned();
                    match (open.as_str(), svg.labels.last_mut()) {
                        ("text", Some(label)) => label.text.push_str(&text),
                        ("metadata", _) if !text.is_empty() => {
                            let about: Value = serde_json::from_str(&text).expect("JSON");
                            svg.panels = about["panels"].as_array().expect("panels").clone();
                        }
                        _ => {}
                    }
                }
                Event::End(_) => open.clear(),
                Event::Eof => return svg,
                _ => {}
            }
        }
    }

    fn enter(&mut self, name: &str, start: &BytesStart) {
        let word = |name: &str| {
            let found = start.try_get_attribute(name).expect("attributes");
            found.map_or_else(String::new, |it| {
                String::from_utf8_lossy(&it.value).into_owned()
            })
        };
        let number = |name: &str| word(name).parse::<f64>().unwrap_or(f64::NAN);
        let points = || -> Vec<(f64, f64)> {
            let points = word("points");
            let pairs = points.split_whitespace().map(|pair| {
                let (x, y) = pair.split_once(',').expect("a pair");
                let of = |text: &str| text.parse::<f64>().expect("a number") / SCALE;
                (of(x), of(y))
            });
            pairs.collect()
        };
        match name {
            "svg" => self.size = (number("width"), number("height")),
            "text" => self.labels.push(Label {
                at: (number("x") / SCALE, number("y") / SCALE),
                anchor: word("text-anchor"),
                size: number("font-size") / SCALE,
                text: String::new(),
            }),
            "circle" => self
                .circles
                .push((number("cx") / SCALE, number("cy") / SCALE)),
            "polyline" => self.lines.push((word("stroke"), points())),
            "polygon" => self.areas.push((word("fill"), number("opacity"), points())),
            _ => {}
        }
    }

    /// Whether a text stands in the picture.
    pub(crate) fn says(&self, text: &str) -> bool {
        self.labels.iter().any(|label| label.text == text)
    }

    /// Whether a point lies within a frame.
    pub(crate) fn is_in_frame(&self, (x, y): (f64, f64)) -> bool {
        let within = |panel: &Value| {
            let of = |name: &str| panel[name].as_f64().expect("an edge");
            (of("left")..=of("right")).contains(&x) && (of("top")..=of("bottom")).contains(&y)
        };
        self.panels.iter().any(within)
    }
}
