//! Pictures of a run as their readers see them: nothing cut, nothing hidden, every sample of a legend like
//! what it stands for.

use std::fs;
use std::path::Path;

use crate::support::svg::{Label, Svg};
use crate::support::{code, fogbench, repository, stderr, write};

/// The shipped trial of every filter, for some seconds.
fn trial(folder: &Path) -> Vec<(String, Svg)> {
    let path = repository("scenarios/audit/trial.toml");
    let path = path.to_str().expect("UTF-8");
    let sets = [
        "duration_s=4.0",
        "warm_up_s=2.0",
        "bias_averaging_time_s=0.5",
    ];
    let sets = sets.iter().flat_map(|set| ["--set", *set]);
    let arguments: Vec<&str> = ["run", path].into_iter().chain(sets).collect();
    let output = fogbench(folder, &arguments);
    assert!(code(&output) < 2, "{}", stderr(&output));
    let mut pictures = Vec::new();
    for entry in fs::read_dir(folder.join("output/trial")).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|it| it == "svg") {
            let name = path.file_name().expect("a name").to_string_lossy();
            let text = fs::read_to_string(&path).expect("a picture");
            pictures.push((name.into_owned(), Svg::read(&text)));
        }
    }
    pictures
}

fn named<'a>(pictures: &'a [(String, Svg)], name: &str) -> &'a Svg {
    let found = pictures.iter().find(|(own, _)| own == name);
    &found.unwrap_or_else(|| panic!("no {name}")).1
}

/// The box of a level text, as narrow as fonts draw it: left, top, right, bottom.
fn cover(label: &Label) -> [f64; 4] {
    let width = 0.45 * label.size * label.text.chars().count() as f64;
    let left = match label.anchor.as_str() {
        "end" => label.at.0 - width,
        "middle" => label.at.0 - width / 2.0,
        _ => label.at.0,
    };
    let half = 0.35 * label.size;
    [left, label.at.1 - half, left + width, label.at.1 + half]
}

fn meet(one: [f64; 4], other: [f64; 4]) -> bool {
    one[0] < other[2] && other[0] < one[2] && one[1] < other[3] && other[1] < one[3]
}

#[test]
fn pictures_of_many_filters_can_be_read() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let pictures = trial(folder.path());
    for (name, svg) in &pictures {
        for label in &svg.labels {
            let [left, top, right, bottom] = cover(label);
            let is_inside =
                left >= 0.0 && top >= 0.0 && right <= svg.size.0 && bottom <= svg.size.1;
            assert!(is_inside || label.at.0 < 30.0, "{name} cuts {label:?}");
        }
    }

    // Labels of points that are close together meet neither each other nor a marker.
    let plane = named(&pictures, "noise-delay.svg");
    let is_of_point = |label: &&Label| label.text.ends_with(" 1.00") && plane.is_in_frame(label.at);
    let labels: Vec<&Label> = plane.labels.iter().filter(is_of_point).collect();
    assert!(labels.len() >= 5, "{labels:?}");
    for (index, label) in labels.iter().enumerate() {
        for other in &labels[..index] {
            assert!(!meet(cover(label), cover(other)), "{label:?} {other:?}");
        }
        for (x, y) in plane.circles.iter().filter(|at| plane.is_in_frame(**at)) {
            let marker = [x - 4.0, y - 4.0, x + 4.0, y + 4.0];
            assert!(!meet(cover(label), marker), "{label:?} at {x} {y}");
        }
    }
    let words: Vec<&str> = plane
        .labels
        .iter()
        .map(|label| label.text.as_str())
        .collect();
    assert!(
        words
            .join(" ")
            .contains("bound: least noise of as many weights in a row")
    );

    // What falls below the picture leaves it, and does not run along its edge.
    let response = named(&pictures, "filter-response.svg");
    assert!(response.says("gains below -40 dB lie below the picture"));
    let bottom = response.panels[0]["bottom"].as_f64().expect("an edge");
    assert_eq!(response.panels[0]["y"]["low"], -40.0);
    for (colour, points) in &response.lines {
        let is_flat = |pair: &[(f64, f64)]| {
            let is_at_edge = |at: (f64, f64)| (at.1 - bottom).abs() < 0.5;
            is_at_edge(pair[0]) && is_at_edge(pair[1])
        };
        let is_frame = points.len() == 5 || points.len() == 2;
        assert!(is_frame || !points.windows(2).any(is_flat), "{colour}");
    }

    // Bands have filled samples, lines have lines.
    let rate = named(&pictures, "rate.svg");
    let right = rate.panels[0]["right"].as_f64().expect("an edge");
    let samples = rate.areas.iter().filter(|area| area.2[0].0 > right);
    let bands = rate
        .areas
        .iter()
        .filter(|area| rate.is_in_frame(area.2[0]) && area.1 < 1.0);
    let (samples, bands) = (samples.count(), bands.count());
    assert_eq!((samples, bands), (9, 9), "a sample for each band");

    // Of nine bands that coincide none hides the lines behind it.
    let allan = named(&pictures, "allan.svg");
    let mut bands = (allan.areas.iter()).filter(|it| it.1 < 1.0 && allan.is_in_frame(it.2[0]));
    assert!(bands.all(|area| area.1 <= 0.1));
    assert!(allan.says("95 % interval") && allan.says("fit") && allan.says("its terms"));
}

#[test]
fn labels_of_a_table_stay_apart_and_published_figures_wear_their_columns_colour() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    let table = "schema = 1\nname = \"s\"\nduration_s = 1.0\nwarm_up_s = 0.5\nfidelity = \"rate\"\n\
                 [[filter]]\nname = \"l\"\n[filter.lms]\n\
                 [[published]]\nmetric = \"l.noise_std_deg_per_h\"\nvalue = 15.0\nunit = \"deg/h\"\n\
                 source = \"here\"\n\
                 [[comparison]]\nname = \"T\"\ntitle = \"t\"\nkind = \"published\"\n\
                 columns = [\"raw.noise_std_deg_per_h\", \"l.noise_std_deg_per_h\"]\n";
    let mut text = table.to_owned();
    for row in 0..12 {
        let label = format!("a label of some length, number {row}");
        text.push_str(&format!(
            "[[comparison_row]]\ncomparison = \"T\"\nlabel = \"{label}\"\nscenarios = [\"s\"]\n"
        ));
    }
    write(at, "s.toml", &text);
    let output = fogbench(at, &["run", "s.toml"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let text = fs::read_to_string(at.join("output/published-t.svg")).expect("a picture");
    let svg = Svg::read(&text);
    let bottom = svg.panels[0]["bottom"].as_f64().expect("an edge");
    let below = svg.labels.iter();
    let below: Vec<&Label> = below
        .filter(|label| label.at.1 > bottom && label.anchor == "middle" && label.at.0 > 30.0)
        .collect();
    assert!(below.len() > 12, "labels are wrapped: {below:?}");
    for (index, label) in below.iter().enumerate() {
        for other in &below[..index] {
            assert!(!meet(cover(label), cover(other)), "{label:?} {other:?}");
        }
    }
    let squares = svg.areas.iter().filter(|area| svg.is_in_frame(area.2[0]));
    let circles = text.matches("<circle").count();
    assert!(squares.count() == 12 && circles > 24, "{circles}");
    assert!(svg.says("published, in the colour of its column"));
}
