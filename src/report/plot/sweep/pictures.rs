//! One picture for each headline metric.

use super::super::drawing::panel::{LEFT, WIDTH};
use super::super::drawing::picture::{Anchor, Picture, text_width};
use super::super::drawing::series::real;
use super::keys::SweptKey;
use super::names::start;
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

/// Sizes of the heading and of what stands below it, and the room for both, pixels.
const HEADING_SIZE: f64 = 18.0;
const FIXED_SIZE: f64 = 12.5;
const ROOM: f64 = WIDTH - LEFT - 8.0;

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
        let title = heading(name, &key.title(), &plan);
        SweepPicture {
            name: format!("{}.svg", key.name.replace('_', "-")),
            holds: format!("{} over {}", key.title(), plan.names(|key| &key.name)),
            picture: picture(&sheet, &title, &plan),
        }
    });
    drawn.collect()
}

/// What a picture shows, in words that end before its edge.
fn heading(name: &str, metric: &str, plan: &Layout) -> String {
    let text = |keys: String| format!("{name}: {metric} over {keys}");
    let whole = text(plan.names(|key| &key.name));
    if text_width(&whole, HEADING_SIZE) <= ROOM {
        return whole;
    }
    start(&text(plan.names(|key| &key.short)), HEADING_SIZE, ROOM)
}

/// Whether the settings of the other keys have lines of their own, or else are the rows of a map.
fn has_lines(plan: &Layout) -> bool {
    plan.settings.len() <= LINES_MAX
}

/// The picture of a metric.
fn picture(sheet: &Sheet, title: &str, plan: &Layout) -> Picture {
    let is_lone = plan.others.is_empty();
    let (panels, height) = if is_lone {
        (1, LONE)
    } else {
        let height = if has_lines(plan) {
            PANEL
        } else {
            cells::height(plan).max(PANEL)
        };
        (sheet.channels.len(), height)
    };
    let mut picture = Picture::new(WIDTH, TOP + (height + BELOW) * real(panels));
    picture.heading((LEFT, 26.0), title, HEADING_SIZE);
    let fixed = plan.fixed_text(FIXED_SIZE, ROOM);
    if !fixed.is_empty() {
        picture.text((LEFT, 46.0), &fixed, FIXED_SIZE, Anchor::Start);
    }
    for (place, channel) in sheet.channels.iter().enumerate() {
        let top = TOP + (height + BELOW) * real(place);
        let frame = (top, top + height);
        if is_lone {
            lines::channels(&mut picture, frame, sheet, plan);
            break;
        } else if has_lines(plan) {
            lines::settings(&mut picture, frame, (sheet, channel), plan);
        } else {
            cells::draw(&mut picture, frame, (sheet, channel), plan);
        }
    }
    picture
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::{Estimate, find};
    use crate::report::plot::SVG_BYTES_MAX;
    use crate::report::record::run::ChannelOutcome;
    use crate::report::record::sweep::PointFigure;

    /// A point with the mean of one channel; none has no value.
    fn point(index: usize, set: &[(&str, String)], mean: Option<f64>) -> RunOutcome {
        let set = set
            .iter()
            .map(|(key, toml)| ((*key).to_owned(), toml.clone()));
        let key = find("mean_deg_per_h").expect("a metric");
        let figure = mean.map(|mean| PointFigure {
            channel: 0,
            key,
            estimate: Estimate::with_interval(mean, mean - 0.1, mean + 0.1),
            averaging_time_s: None,
        });
        RunOutcome {
            sweep: Some((index, set.collect())),
            channels: vec![ChannelOutcome {
                name: "raw".to_owned(),
                headline: Vec::new(),
                failure: None,
                expected_failure: false,
            }],
            swept: figure.into_iter().collect(),
            ..RunOutcome::not_run("s", "s", "s.toml")
        }
    }

    fn svg(points: &[RunOutcome]) -> String {
        let points: Vec<&RunOutcome> = points.iter().collect();
        let mut pictures = pictures("s", &points);
        assert_eq!(pictures.len(), 1);
        let only = pictures.remove(0);
        assert_eq!(only.name, "mean-deg-per-h.svg");
        only.picture.svg().expect("small enough")
    }

    fn grid(columns: usize, rows: usize) -> Vec<RunOutcome> {
        let points = (0..columns * rows).map(|index| {
            let (x, y) = (real(index / rows), real(index % rows));
            let set = [
                ("gyro.source.power_uw", format!("{:?}", 1.0 + x)),
                ("gyro.coil.length_m", format!("{:?}", 100.0 + y)),
            ];
            point(index, &set, Some((0.01 * x).sin() * (0.01 * y).cos()))
        });
        points.collect()
    }

    #[test]
    fn ten_thousand_points_make_a_picture_of_either_kind() {
        let lone = |index: usize| {
            let set = [("gyro.coil.length_m", format!("{:?}", 100.0 + real(index)))];
            let noise = (real(index) * 12.9898).sin();
            point(index, &set, (!index.is_multiple_of(97)).then_some(noise))
        };
        let line: Vec<RunOutcome> = (0..10_000).map(lone).collect();
        let line = svg(&line);
        assert!(line.contains("no value at 104 of 10000 points"));
        assert!(line.contains("95 % intervals: in metrics.csv"));
        let cells = svg(&grid(100, 100));
        for svg in [line, cells] {
            assert!(svg.len() < SVG_BYTES_MAX, "{}", svg.len());
        }
    }

    #[test]
    fn a_second_key_has_lines_where_it_is_short_and_cells_where_it_is_long() {
        let lines = svg(&grid(9, 6));
        assert!(
            lines.contains("length_m = 105")
                && !lines.contains("<polygon opacity=\"1\" fill=\"#440154\"")
        );
        let cells = svg(&grid(9, 7));
        assert!(!cells.contains("length_m = 105"));
        assert!(cells.contains("gyro.coil.length_m [m]"));
        // The values stand in the cells, the classes beside them.
        assert!(cells.contains("#440154") && cells.contains(" to "));
        assert!(cells.contains("0.0798"), "a value in its cell");
    }

    /// A grid of nine by seven, by a figure of each point.
    fn map(figure: impl Fn(usize) -> Option<f64>) -> String {
        let mut points = grid(9, 7);
        for (index, point) in points.iter_mut().enumerate() {
            let value = figure(index);
            point.swept.retain(|_| value.is_some());
            for own in &mut point.swept {
                own.estimate = Estimate::exact(value.unwrap_or_default());
            }
        }
        svg(&points)
    }

    fn colours(svg: &str) -> std::collections::BTreeSet<&str> {
        let areas = svg.lines().filter(|line| line.starts_with("<polygon"));
        areas
            .filter_map(|line| line.split("fill=\"").nth(1)?.split('"').next())
            .collect()
    }

    #[test]
    fn a_map_of_one_value_has_one_colour_which_its_legend_names() {
        for (low, text) in [(0.0, "0 everywhere"), (-12.5, "-12.5 everywhere")] {
            for other in [low, low * (1.0 + 1e-15)] {
                let svg = map(|index| Some(if index == 5 { other } else { low }));
                assert!(svg.contains(text), "{low}");
                assert_eq!(colours(&svg).len(), 1, "{low}: {:?}", colours(&svg));
            }
        }
        let lacking = map(|index| (index != 5).then_some(7.0));
        assert!(lacking.contains("no value at 1 of 63 points"));
        assert_eq!(colours(&lacking).len(), 2);
    }

    #[test]
    fn the_classes_of_close_values_are_told_apart() {
        let svg = map(|index| Some(1.0 + 1e-6 * real(index)));
        assert!(svg.contains("1.000008 to 1.000015"));
        assert!(!svg.contains("1.00 to 1.00"));
        assert_eq!(colours(&svg).len(), 8);
    }

    /// Texts of a picture with their anchors and places, pixels.
    fn texts(svg: &str) -> Vec<(String, String, f64, f64)> {
        let mut lines = svg.lines();
        let mut texts = Vec::new();
        while let Some(line) = lines.next() {
            let of = |name: &str| {
                let value = line.split(&format!(" {name}=\"")).nth(1)?;
                Some(value.split('"').next()?.to_owned())
            };
            let number = |name: &str| of(name).and_then(|it| it.parse::<f64>().ok());
            if let (true, Some(text)) = (line.starts_with("<text"), lines.clone().next()) {
                let anchor = of("text-anchor").unwrap_or_default();
                let (x, size) = (number("x"), number("font-size"));
                let (x, size) = (x.unwrap_or_default(), size.unwrap_or_default());
                texts.push((text.to_owned(), anchor, x / 4.0, size / 4.0));
            }
        }
        texts
    }

    const LONG: [&str; 4] = [
        "turntable.servo.direct_drive.friction_smoothing_rad_per_s",
        "turntable.servo.direct_drive.current_loop_bandwidth_hz",
        "filter.a_filter_with_a_long_name.taps",
        "filter.another_filter_with_a_long_name.taps",
    ];

    /// Points over long keys, each with as many values as asked for.
    fn long(counts: [usize; 4]) -> Vec<RunOutcome> {
        let total: usize = counts.iter().product();
        let points = (0..total).map(|index| {
            let mut rest = index;
            let set = LONG.iter().zip(counts).map(|(key, count)| {
                let value = rest % count;
                rest /= count;
                (*key, format!("{:?}", 1000.5 + real(value)))
            });
            point(index, &set.collect::<Vec<_>>(), Some(real(index)))
        });
        points.collect()
    }

    #[test]
    fn rows_of_several_long_keys_have_whole_labels_that_differ() {
        let svg = svg(&long([4, 2, 2, 3]));
        let texts = texts(&svg);
        let labels = texts
            .iter()
            .filter(|(text, anchor, ..)| anchor == "end" && text.contains(", "));
        let labels: Vec<_> = labels.collect();
        assert_eq!(labels.len(), 12, "{texts:?}");
        let distinct: std::collections::BTreeSet<&str> =
            labels.iter().map(|(text, ..)| text.as_str()).collect();
        assert_eq!(distinct.len(), 12);
        for (text, _, x, size) in labels {
            assert!(x - text_width(text, *size) > 29.0, "{text} meets the title");
        }
        let rows = "current_loop_bandwidth_hz, a_filter_with_a_long_name.taps, \
                    another_filter_with_a_long_name.taps";
        let is_title = |text: &str| {
            let end = text.strip_prefix('\u{2026}');
            end.is_some_and(|end| rows.ends_with(end))
        };
        assert!(texts.iter().any(|(text, ..)| is_title(text)), "{texts:?}");
        for (text, anchor, x, size) in &texts {
            let is_start = anchor == "start";
            assert!(!is_start || x + text_width(text, *size) <= WIDTH, "{text}");
        }
        let heading = &texts[0].0;
        assert!(
            heading.starts_with("s: mean over friction") && heading.ends_with('\u{2026}'),
            "{heading}"
        );
    }

    #[test]
    fn a_title_beside_a_panel_is_as_short_as_it_asks_for() {
        let svg = svg(&long([9, 7, 1, 1]));
        let texts = texts(&svg);
        let says = |text: &str| texts.iter().any(|(said, ..)| said == text);
        assert!(says(&format!("{} [rad/s]", LONG[0])), "{texts:?}");
        assert!(says("current_loop_bandwidth_hz [Hz]"), "{texts:?}");
    }

    #[test]
    fn a_legend_names_each_key_by_an_end_of_its_own_and_breaks_no_setting() {
        let points = (0..12).map(|index| {
            let set = [
                (
                    "gyro.source.power_uw",
                    format!("{:?}", 1.5 + real(index / 4)),
                ),
                ("filter.rls.taps", (2 + index / 2 % 2).to_string()),
                ("filter.mean.taps", (4 + index % 2).to_string()),
            ];
            point(index, &set, Some(real(index)))
        });
        let legend = svg(&points.collect::<Vec<_>>());
        assert!(legend.contains("rls.taps = 2, mean.taps = 5"));
        // Names that have no room beside a line stand once above all.
        let texts = texts(&svg(&long([3, 2, 2, 1])));
        let says = |text: &str| texts.iter().any(|(said, ..)| said == text);
        assert!(
            says("current_loop_bandwidth_hz") && says("1002, 1000"),
            "{texts:?}"
        );
        assert!(!texts.iter().any(|(text, ..)| text.ends_with('=')));
    }

    #[test]
    fn lines_end_where_a_value_is_lacking() {
        let at = |index: usize, mean| {
            let set = [("gyro.coil.length_m", format!("{:?}", 100.0 + real(index)))];
            point(index, &set, mean)
        };
        let whole: Vec<_> = (0..5).map(|index| at(index, Some(real(index)))).collect();
        let gap: Vec<_> = (0..5)
            .map(|index| at(index, (index != 2).then_some(real(index))))
            .collect();
        let pieces = |points: &[RunOutcome]| {
            let svg = svg(points);
            let lines = svg.lines().filter(|line| {
                line.starts_with("<polyline")
                    && line.contains("stroke=\"#8A8A8A\" stroke-width=\"7\"")
            });
            // The sample of the legend is one of them.
            lines.count() - 1
        };
        assert_eq!((pieces(&whole), pieces(&gap)), (1, 2));
    }
}
