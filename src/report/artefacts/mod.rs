//! Table of the files that commands write: name, what each holds, when it is written and by what.
//!
//! A file is one row here, a curve's CSV file one word in the row of the curve. Writing, the
//! documentation and the tests read the table.

mod samples;
mod table;

use std::borrow::Cow;

use super::log::LogReport;
use super::page::pictures::Shown;
use super::page::run::Beside;
use super::plot::{Picture, Pictures, stamped};
use crate::metrics::{CurveKey, known_curves};
use crate::report::calibration::documents::CalibrationProvenance;
use crate::report::csv::curves::curve_csv;
use crate::report::record::measured::Measured;
use crate::report::record::run::{RunOutcome, RunReport};
use crate::scenario::{AssumedValue, SamplesFormat};
use crate::signal::{BudgetSheet, CalibrationSheet, RunSignals};

pub use samples::input_digest_toml;
pub use table::{FILTERS, INDEX, JUNIT, METRICS, PAGE, SUITE_SUMMARY};

use samples::Samples;
use table::{RUN_AND_LOG, SUITE, TABLE};

/// Folder that a file is written into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Output folder of a suite.
    Suite,
    /// Folder of a sweep, beside the folders of its points.
    Sweep,
    /// Folder of a run.
    Run,
    /// Folder of a recorded log.
    Log,
    /// Folder of a calibration.
    Calibration,
    /// Folder of a noise budget.
    Budget,
}

impl Place {
    /// Commands that write there.
    #[must_use]
    pub fn commands(self) -> &'static [&'static str] {
        match self {
            Self::Suite | Self::Sweep | Self::Run => &["run"],
            Self::Log => &["analyze", "filter"],
            Self::Calibration => &["calibrate"],
            Self::Budget => &["budget"],
        }
    }

    /// The folder in words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Suite => "output folder",
            Self::Sweep => "folder of a sweep",
            Self::Run => "folder of a run",
            Self::Log => "folder of a log",
            Self::Calibration => "folder of a calibration",
            Self::Budget => "folder of a budget",
        }
    }
}

/// What is drawn: the channels of one gyro of a run, or of a log.
pub(super) struct Scene<'a> {
    measured: Measured<'a>,
    signals: &'a RunSignals<'a>,
    /// The run; none of a log.
    run: Option<&'a RunReport<'a>>,
}

impl<'a> Scene<'a> {
    /// Version of the tool and, of a run, the digest of its scenario.
    fn origin(&self) -> (&'a str, Option<&'a str>) {
        match self.run {
            Some(run) => (run.tool_version, Some(run.digest)),
            None => (env!("CARGO_PKG_VERSION"), None),
        }
    }
}

/// What makes a file.
#[derive(Clone, Copy)]
enum Made {
    /// Text of a run.
    Run(fn(&RunReport) -> Option<String>),
    /// Text of a log.
    Log(fn(&LogReport) -> Option<String>),
    /// CSV of a curve, of runs and logs.
    Curve(&'static CurveKey),
    /// Page of a run with its pictures.
    Page(for<'a> fn(&RunReport, &[Shown<'a>], &Beside<'a>) -> String),
    /// Picture of one gyro.
    Drawn(fn(&Scene) -> Option<Picture>),
    /// Text of a calibration, of a campaign or of groups.
    Sheet(fn(&CalibrationSheet, &CalibrationProvenance) -> String),
    /// Picture of the calibration of a campaign.
    SheetDrawn(fn(&str, &CalibrationSheet) -> Option<String>),
    /// Files of samples, of runs and logs.
    Samples(for<'a> fn(&Artefact, &Samples<'a, '_>) -> Vec<OutputFile<'a>>),
    /// Text of a noise budget.
    Budget(fn(&str, &BudgetSheet) -> Option<String>),
    /// The part of the program that is named.
    By(&'static str),
}

/// A file to be written into a folder.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct OutputFile<'a> {
    /// Name within the folder; it may lead through folders.
    pub name: String,
    /// What it holds.
    pub contents: Contents<'a>,
}

/// Contents of an [`OutputFile`].
#[derive(Clone, Debug, PartialEq)]
pub enum Contents<'a> {
    /// Text, UTF-8.
    Text(String),
    /// Numbers, to be written as NPY of binary64.
    Npy(Cow<'a, [f64]>),
    /// Rate words, to be written as text with their stamps.
    TimedCsv {
        /// Words, deg/h.
        rate_deg_per_h: &'a [f64],
        /// Sample period, s.
        sample_period_s: f64,
    },
}

impl OutputFile<'_> {
    fn text(name: &str, text: String) -> Self {
        Self {
            name: name.to_owned(),
            contents: Contents::Text(text),
        }
    }
}

/// Declaration of a file that a command writes.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct Artefact {
    /// Name within its folder; `<...>` stands for what differs.
    pub name: &'static str,
    /// What it holds.
    pub holds: &'static str,
    /// When it is written.
    pub when: &'static str,
    /// Folders that have it.
    pub places: &'static [Place],
    made: Made,
}

impl Artefact {
    /// The name with what differs filled in.
    #[must_use]
    pub fn named(&self, own: &str) -> String {
        match (self.name.find('<'), self.name.find('>')) {
            (Some(start), Some(end)) => {
                format!("{}{own}{}", &self.name[..start], &self.name[end + 1..])
            }
            _ => self.name.to_owned(),
        }
    }

    /// The part of the program that writes it.
    #[must_use]
    pub fn made_by(&self) -> &'static str {
        match self.made {
            Made::By(part) => part,
            Made::Drawn(_) | Made::SheetDrawn(_) => "report::plot",
            Made::Curve(_) => "report::csv",
            Made::Samples(_) => "report::artefacts",
            Made::Page(_) => "report::page",
            Made::Run(_) | Made::Log(_) | Made::Sheet(_) | Made::Budget(_) => "report",
        }
    }
}

/// Every file that a command writes into a folder of results.
#[must_use]
pub fn artefacts() -> Vec<Artefact> {
    let curves = known_curves().iter().filter_map(|key| {
        Some(Artefact {
            name: key.csv?,
            holds: key.definition,
            when: "a channel has the curve",
            places: RUN_AND_LOG,
            made: Made::Curve(key),
        })
    });
    TABLE.iter().copied().chain(curves).collect()
}

/// The files of a folder.
fn of(place: Place) -> impl Iterator<Item = Artefact> {
    let all = artefacts().into_iter();
    all.filter(move |artefact| artefact.places.contains(&place))
}

/// Files of the folder of a run but for its pictures ([`run_pictures`]).
#[must_use]
pub fn run_files<'a>(report: &RunReport, gyros: &[RunSignals<'a>]) -> Vec<OutputFile<'a>> {
    let provenance = CalibrationProvenance {
        tool_version: report.tool_version,
        file: report.file,
        digest: report.digest,
    };
    let samples = Samples {
        gyros,
        as_npy: report.scenario.output.samples == SamplesFormat::Npy,
        as_csv: false,
    };
    files_of(Place::Run, &samples, |made| match made {
        Made::Run(text) => text(report),
        Made::Curve(key) => curve_csv(key, report.channels),
        Made::Sheet(text) => report.calibration.map(|sheet| text(sheet, &provenance)),
        _ => None,
    })
}

/// Names of the files that every suite has in its output folder, but for the record of them.
#[must_use]
pub fn suite_files() -> Vec<&'static str> {
    let is_own = |artefact: &Artefact| matches!(artefact.made, Made::By(SUITE));
    let own = of(Place::Suite).filter(is_own);
    own.map(|artefact| artefact.name).collect()
}

/// Names of the files but for pictures and samples that the folder of a run has.
#[must_use]
pub fn run_file_names(report: &RunReport) -> Vec<String> {
    let files = run_files(report, &[]).into_iter();
    files.map(|file| file.name).collect()
}

/// Samples and texts of a folder, in the order of the rows.
fn files_of<'a>(
    place: Place,
    samples: &Samples<'a, '_>,
    text: impl Fn(&Made) -> Option<String>,
) -> Vec<OutputFile<'a>> {
    let files = |artefact: Artefact| match artefact.made {
        Made::Samples(files) => files(&artefact, samples),
        ref made => {
            let text = text(made).map(|text| OutputFile::text(artefact.name, text));
            text.into_iter().collect()
        }
    };
    of(place).flat_map(files).collect()
}

/// Pages of a run: name and text; none where it gets none.
///
/// * `assumed`: values that nobody set.
#[must_use]
pub fn run_pages(
    report: &RunReport,
    pictures: &Pictures,
    assumed: &[AssumedValue],
) -> Vec<(&'static str, String)> {
    if !RunOutcome::from_report(report, "").has_page {
        return Vec::new();
    }
    let rows: Vec<Artefact> = of(Place::Run).collect();
    let holds = |name: &str| {
        // Those of an assembly stand behind the axis.
        let is_row = |row: &&Artefact| name == row.name || name.get(2..) == Some(row.name);
        rows.iter().find(is_row).map_or("picture", |row| row.holds)
    };
    let drawn = pictures.drawn.iter();
    let shown = drawn.map(|(name, svg)| Shown {
        name,
        holds: holds(name),
        svg,
    });
    let shown: Vec<Shown> = shown.collect();
    let drawn = pictures.drawn.iter().map(|(name, _)| name.clone());
    let manifest = std::iter::once("manifest.toml".to_owned());
    let beside = Beside {
        files: &manifest
            .chain(run_file_names(report))
            .chain(drawn)
            .collect::<Vec<_>>(),
        assumed,
    };
    let pages = rows.iter().filter_map(|row| match row.made {
        Made::Page(page) => Some((row.name, page(report, &shown, &beside))),
        _ => None,
    });
    pages.collect()
}

/// Files and pictures of a log's folder, the samples as NPY, with `as_csv` as CSV as well. A picture
/// that would be too large is left out with a note in `summary.json`.
#[must_use]
pub fn log_files<'a>(
    report: &LogReport,
    signals: &RunSignals<'a>,
    as_csv: bool,
) -> Vec<OutputFile<'a>> {
    let scene = Scene {
        measured: report.measured(),
        signals,
        run: None,
    };
    let pictures = drawn_of(Place::Log, &scene, "");
    let notes = [report.notes, &pictures.notes].concat();
    let report = &LogReport {
        notes: &notes,
        ..report.clone()
    };
    let samples = Samples {
        gyros: std::slice::from_ref(signals),
        as_npy: true,
        as_csv,
    };
    let mut files = files_of(Place::Log, &samples, |made| match made {
        Made::Log(text) => text(report),
        Made::Curve(key) => curve_csv(key, report.channels),
        _ => None,
    });
    let pictures = pictures.drawn.into_iter();
    files.extend(pictures.map(|(name, svg)| OutputFile::text(&name, svg)));
    files
}

/// Files of a calibration: name and text.
#[must_use]
pub fn calibration_files(
    sheet: &CalibrationSheet,
    provenance: &CalibrationProvenance,
) -> Vec<(String, String)> {
    let text = |artefact: Artefact| match artefact.made {
        Made::Sheet(text) => Some((artefact.name.to_owned(), text(sheet, provenance))),
        _ => None,
    };
    of(Place::Calibration).filter_map(text).collect()
}

/// Files of a noise budget, of a scenario file: name and text.
#[must_use]
pub fn budget_files(file: &str, sheet: &BudgetSheet) -> Vec<(String, String)> {
    let text = |artefact: Artefact| match artefact.made {
        Made::Budget(text) => Some((artefact.name.to_owned(), text(file, sheet)?)),
        _ => None,
    };
    of(Place::Budget).filter_map(text).collect()
}

/// Pictures of one gyro of a run. Those of an assembly stand behind the axis, as in `x-rate.svg`:
/// nine channels in one picture would hide one another. A picture that even with fewer points would
/// exceed [`SVG_BYTES_MAX`](super::SVG_BYTES_MAX) is left out with a note.
#[must_use]
pub fn plots(report: &RunReport, signals: &RunSignals) -> Pictures {
    let own = report.channels.iter();
    let own: Vec<_> = own
        .filter(|(name, _)| name.starts_with(signals.prefix))
        .cloned()
        .collect();
    let report = &RunReport {
        channels: &own,
        calibration: None,
        ..report.clone()
    };
    let scene = Scene {
        measured: report.measured(),
        signals,
        run: Some(report),
    };
    drawn_of(Place::Run, &scene, &signals.prefix.replace('_', "-"))
}

/// Pictures of a run: of every gyro, and of the calibration of a campaign.
#[must_use]
pub fn run_pictures(report: &RunReport, gyros: &[RunSignals]) -> Pictures {
    let mut pictures = Pictures::default();
    for signals in gyros {
        pictures.extend(plots(report, signals));
    }
    if let Some(sheet) = report.calibration {
        for artefact in of(Place::Run) {
            if let Made::SheetDrawn(draw) = artefact.made {
                let svg = draw(&report.scenario.name, sheet);
                let svg = svg.map(|svg| stamped(&svg, report.tool_version, Some(report.digest)));
                pictures.add_svg(artefact.name.to_owned(), svg);
            }
        }
    }
    pictures
}

/// The pictures that there are, named behind the axis.
fn drawn_of(place: Place, scene: &Scene, axis: &str) -> Pictures {
    let mut all = Pictures::default();
    for artefact in of(place) {
        if let Made::Drawn(draw) = artefact.made
            && let Some(picture) = draw(scene)
        {
            let (version, digest) = scene.origin();
            let svg = picture.svg().map(|svg| stamped(&svg, version, digest));
            all.add_svg(format!("{axis}{}", artefact.name), svg);
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn a_folder_has_one_file_of_a_name_and_every_row_says_what_it_holds() {
        let mut seen = BTreeSet::new();
        for artefact in artefacts() {
            let Artefact {
                name, holds, when, ..
            } = artefact;
            assert!(!holds.is_empty() && !when.is_empty(), "{name}");
            assert!(!artefact.places.is_empty(), "{name}");
            for place in artefact.places {
                assert!(seen.insert((name, place.words())), "{name} twice");
            }
        }
    }

    #[test]
    fn every_curve_is_drawn_in_a_picture_that_there_is() {
        let is_picture = |name: &str| {
            let found = artefacts().into_iter().find(|row| row.name == name);
            found.is_some_and(|row| matches!(row.made, Made::Drawn(_)))
        };
        for key in known_curves() {
            assert!(key.picture.is_none_or(is_picture), "{}", key.name);
        }
    }

    #[test]
    fn what_differs_in_a_name_is_filled_in() {
        let named = |name: &str, own: &str| {
            let found = artefacts().into_iter().find(|row| row.name == name);
            found.expect("a row").named(own)
        };
        assert_eq!(named("samples/<channel>.npy", "raw"), "samples/raw.npy");
        assert_eq!(
            named("samples/<axis>truth.npy", "x_"),
            "samples/x_truth.npy"
        );
        assert_eq!(named("samples/time_s.npy", ""), "samples/time_s.npy");
    }
}
