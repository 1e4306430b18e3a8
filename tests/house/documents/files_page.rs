//! Page of the files that commands write: the rows of the table of files, and the curves in them.

use std::fmt::Write as _;

use fogbench::metrics::{CurveKey, known_curves};
use fogbench::report::{Artefact, Place, artefacts};

const HEAD: &str = "\
# Files

<!-- Generated from the table of files in src/report by the test `generated_page_of_the_files`. -->

Every file that a command writes into a folder of results. `<...>` stands for what differs. The pictures
of an assembly of three stand behind the axis, as in `x-rate.svg`. [Results](output.md) says how the folders
are kept.
";

/// Folders in the order of the page.
const PLACES: [Place; 6] = [
    Place::Suite,
    Place::Sweep,
    Place::Run,
    Place::Log,
    Place::Calibration,
    Place::Budget,
];

fn folder(place: Place, rows: &[Artefact], page: &mut String) {
    let words = place.words();
    let commands: Vec<String> = place.commands().iter().map(|c| format!("`{c}`")).collect();
    let title = words[..1].to_uppercase() + &words[1..];
    write!(page, "\n## {title}\n\n").expect("a string takes it");
    write!(page, "Written by {}.\n\n", commands.join(" and ")).expect("a string takes it");
    page.push_str("| file | holds | when |\n|---|---|---|\n");
    for row in rows.iter().filter(|row| row.places.contains(&place)) {
        let (name, holds, when) = (row.name, row.holds, row.when);
        writeln!(page, "| `{name}` | {holds} | {when} |").expect("a string takes it");
    }
}

fn curve(key: &CurveKey, page: &mut String) {
    write!(page, "\n### {}\n\n{}", key.name, sentence(key.definition)).expect("a string takes it");
    let files: Vec<String> = [key.csv, key.picture]
        .into_iter()
        .flatten()
        .map(|file| format!("`{file}`"))
        .collect();
    if !files.is_empty() {
        write!(page, " Files: {}.", files.join(", ")).expect("a string takes it");
    }
    write!(page, " Repeats: {}.\n\n", key.pooling()).expect("a string takes it");
    page.push_str("| column | unit | meaning |\n|---|---|---|\n");
    for column in key.columns.iter().chain(key.words) {
        let (name, unit, meaning) = (column.name, column.unit(), column.definition());
        writeln!(page, "| `{name}` | {unit} | {meaning} |").expect("a string takes it");
    }
}

fn sentence(text: &str) -> String {
    format!("{}{}.", text[..1].to_uppercase(), &text[1..])
}

/// Markdown page of the files.
pub(crate) fn page() -> String {
    let rows = artefacts();
    let mut page = HEAD.to_owned();
    for row in &rows {
        let places = row.places.iter();
        assert!(
            places.clone().all(|place| PLACES.contains(place)),
            "{}",
            row.name
        );
    }
    for place in PLACES {
        folder(place, &rows, &mut page);
    }
    page.push_str(
        "\n## Curves\n\nA curve stands in `summary.json` under `channels.<name>.curves`.\n",
    );
    for key in known_curves() {
        curve(key, &mut page);
    }
    page
}
