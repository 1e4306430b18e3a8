//! Table of the files that commands write: name, what each holds, when it is written and by what.
//!
//! A file is one row here, a curve's CSV file one word in the row of the curve. Writing, the
//! documentation and the tests read the table.

use super::budget::budget_csv;
use super::calibration::{CalibrationProvenance, calibration_toml, groups_csv};
use super::csv::curve_csv;
use super::log::{LogReport, log_json};
use super::measured::Measured;
use super::plot::{self, Picture, Pictures};
use super::record::RunReport;
use super::repeats::runs_csv;
use super::summary::run_summary_json;
use crate::metrics::{CurveKey, known_curves};
use crate::scenario::MotionClass;
use crate::signal::{BudgetSheet, CalibrationSheet, RunSignals};

/// Folder that a file is written into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Output folder of a suite.
    Suite,
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
            Self::Suite | Self::Run => &["run"],
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

/// What makes a file.
#[derive(Clone, Copy)]
enum Made {
    /// Text of a run.
    Run(fn(&RunReport) -> Option<String>),
    /// Text of a log.
    Log(fn(&LogReport) -> Option<String>),
    /// CSV of a curve, of runs and logs.
    Curve(&'static CurveKey),
    /// Picture of one gyro.
    Drawn(fn(&Scene) -> Option<Picture>),
    /// Text of a calibration, of a campaign or of groups.
    Sheet(fn(&CalibrationSheet, &CalibrationProvenance) -> String),
    /// Picture of the calibration of a campaign.
    SheetDrawn(fn(&str, &CalibrationSheet) -> Option<String>),
    /// Text of a noise budget.
    Budget(fn(&str, &BudgetSheet) -> Option<String>),
    /// The part of the program that is named.
    By(&'static str),
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
            Made::Run(_) | Made::Log(_) | Made::Sheet(_) | Made::Budget(_) => "report",
        }
    }
}

const ALWAYS: &str = "always";
const RUN: &[Place] = &[Place::Run];
const RUN_AND_LOG: &[Place] = &[Place::Run, Place::Log];

/// Summary of a suite.
pub const SUITE_SUMMARY: Artefact = Artefact {
    name: "summary.json",
    holds: "outcome of every run with its gates, and the tables over several scenarios",
    when: "after every run, so that a stopped suite has one",
    places: &[Place::Suite],
    made: Made::By("experiment::suite"),
};

/// Verdict of a suite for a build server.
pub const JUNIT: Artefact = Artefact {
    name: "junit.xml",
    holds: "gates and failures as JUnit test cases",
    when: "after every run, so that a stopped suite has one",
    places: &[Place::Suite],
    made: Made::By("experiment::suite"),
};

/// Words of a channel.
pub const SAMPLES: Artefact = Artefact {
    name: "samples/<channel>.npy",
    holds: "words of a channel, deg/h, warm-up included",
    when: "output.samples = \"npy\"; of a log for every filter and the compensated channel",
    places: RUN_AND_LOG,
    made: Made::By("experiment"),
};

/// Words of a filter as text.
pub const SAMPLES_CSV: Artefact = Artefact {
    name: "samples/<channel>.csv",
    holds: "time, s, and words of a filter, deg/h",
    when: "with --csv",
    places: &[Place::Log],
    made: Made::By("experiment"),
};

/// True rate.
pub const TRUTH_SAMPLES: Artefact = Artefact {
    name: "samples/<axis>truth.npy",
    holds: "true rate at the stamps, deg/h",
    when: "output.samples = \"npy\"",
    places: RUN,
    made: Made::By("experiment"),
};

/// Angle of the encoder.
pub const ENCODER_SAMPLES: Artefact = Artefact {
    name: "samples/encoder_arcsec.npy",
    holds: "angle of the table's encoder at the stamps, arcsec",
    when: "output.samples = \"npy\" and the table has an encoder",
    places: RUN,
    made: Made::By("experiment"),
};

/// Stamps.
pub const TIME_SAMPLES: Artefact = Artefact {
    name: "samples/time_s.npy",
    holds: "stamps, s",
    when: "output.samples = \"npy\"",
    places: RUN,
    made: Made::By("experiment"),
};

/// Every file but the CSV files of curves, which [`artefacts`] adds. Pictures stand in the order in
/// which those that are left out are told.
const TABLE: &[Artefact] = &[
    SUITE_SUMMARY,
    JUNIT,
    Artefact {
        name: "<published or sensitivity>-<table>.csv",
        holds: "a table over several scenarios: published and simulated values, changes per unit",
        when: "several scenarios have a [[published]] or [[comparison]] table of that name",
        places: &[Place::Suite],
        made: Made::By("report::comparison_files"),
    },
    Artefact {
        name: "<published or sensitivity>-<table>.svg",
        holds: "the same drawn",
        when: "with the table, unless it would be too large",
        places: &[Place::Suite],
        made: Made::By("report::comparison_files"),
    },
    Artefact {
        name: "manifest.toml",
        holds: "scenario as resolved, seed, version and build, digests of the folder's files",
        when: ALWAYS,
        places: RUN,
        made: Made::By("store"),
    },
    Artefact {
        name: ".fogbench.toml",
        holds: "digests of the folder's files",
        when: "where no manifest holds them",
        places: &[Place::Suite, Place::Log, Place::Calibration, Place::Budget],
        made: Made::By("store"),
    },
    Artefact {
        name: "summary.json",
        holds: "metrics, curves, reasons for what is missing, gates",
        when: ALWAYS,
        places: RUN,
        made: Made::Run(|report| Some(run_summary_json(report))),
    },
    Artefact {
        name: "summary.json",
        holds: "metrics, curves and reasons for what is missing",
        when: ALWAYS,
        places: &[Place::Log],
        made: Made::Log(|report| Some(log_json(report))),
    },
    Artefact {
        name: "runs.csv",
        holds: "main metrics of every repeat",
        when: "several repeats",
        places: RUN,
        made: Made::Run(runs_csv),
    },
    Artefact {
        name: "calibration.toml",
        holds: "calibration parameters to apply, with their source",
        when: "calibrate; a campaign of calibration",
        places: &[Place::Run, Place::Calibration],
        made: Made::Sheet(calibration_toml),
    },
    Artefact {
        name: "groups.csv",
        holds: "means of every group that the calibration rests on",
        when: "calibrate; a campaign of calibration",
        places: &[Place::Run, Place::Calibration],
        made: Made::Sheet(|sheet, _| groups_csv(&sheet.groups)),
    },
    drawn(
        "rate.svg",
        "rate over time with the true one",
        ALWAYS,
        RUN_AND_LOG,
        |scene| plot::rate::picture(&scene.measured, scene.signals),
    ),
    drawn(
        "before-after.svg",
        "words before and after compensation",
        "the words are compensated",
        RUN,
        |scene| plot::before_after::picture(scene.run?, scene.signals),
    ),
    drawn(
        "allan.svg",
        "Allan deviation with intervals and the fitted terms",
        "a channel has the curve `allan`",
        RUN_AND_LOG,
        |scene| plot::allan::picture(&scene.measured),
    ),
    drawn(
        "swing.svg",
        "mean cycle of a swing and the delay of every channel",
        "swing",
        RUN,
        |scene| match scene.run?.scenario.turntable.motion.class() {
            MotionClass::Swing { frequency_hz, .. } => {
                plot::swing::picture(scene.run?, scene.signals, frequency_hz)
            }
            _ => None,
        },
    ),
    drawn(
        "bode.svg",
        "gain and phase against the true rate",
        "several sines at once",
        RUN,
        |scene| plot::bode::picture(scene.run?),
    ),
    drawn(
        "response.svg",
        "output and error over the input",
        "steps of three rates or more",
        RUN,
        |scene| plot::response::picture(scene.run?),
    ),
    drawn(
        "scale-factor.svg",
        "residuals of full scale and of reading",
        "a channel has the curve `scale_factor`",
        RUN,
        |scene| plot::scale_factor::picture(scene.run?),
    ),
    drawn(
        "spectrum.svg",
        "power spectral density of the rate",
        "a channel has the curve `psd`",
        RUN_AND_LOG,
        |scene| plot::spectrum::picture(&scene.measured),
    ),
    drawn(
        "thermal.svg",
        "temperature and rate over time",
        "the temperature changes",
        RUN,
        |scene| plot::thermal::picture(scene.run?, scene.signals),
    ),
    drawn(
        "noise-delay.svg",
        "noise gain over delay of every filter with its bound",
        "a filter's noise was measured at rest or in a swing",
        RUN,
        |scene| plot::noise_delay::picture(scene.run?),
    ),
    drawn(
        "rate-gain.svg",
        "gain of every filter over the rate",
        "trial.rate_gain = true",
        RUN,
        |scene| plot::rate_gain::picture(scene.run?),
    ),
    drawn(
        "filter-response.svg",
        "gain and phase delay of every filter over the frequency",
        "there are filters",
        RUN,
        |scene| plot::filter_response::picture(scene.run?),
    ),
    Artefact {
        name: "calibration.svg",
        holds: "errors of the calibration parameters with their intervals",
        when: "a campaign of calibration",
        places: RUN,
        made: Made::SheetDrawn(plot::calibration_svg),
    },
    Artefact {
        name: "budget.svg",
        holds: "angle random walk over depth of modulation and optical power, by source",
        when: ALWAYS,
        places: &[Place::Budget],
        made: Made::Budget(plot::budget_svg),
    },
    Artefact {
        name: "budget.csv",
        holds: "the same in numbers",
        when: ALWAYS,
        places: &[Place::Budget],
        made: Made::Budget(|_, sheet| Some(budget_csv(sheet))),
    },
    SAMPLES,
    SAMPLES_CSV,
    TRUTH_SAMPLES,
    ENCODER_SAMPLES,
    TIME_SAMPLES,
];

/// A picture of one gyro; of an assembly its name stands behind the axis, as in `x-rate.svg`.
const fn drawn(
    name: &'static str,
    holds: &'static str,
    when: &'static str,
    places: &'static [Place],
    picture: fn(&Scene) -> Option<Picture>,
) -> Artefact {
    Artefact {
        name,
        holds,
        when,
        places,
        made: Made::Drawn(picture),
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

/// Texts of the folder of a run: name and text.
#[must_use]
pub fn run_files(report: &RunReport) -> Vec<(String, String)> {
    let provenance = CalibrationProvenance {
        tool_version: report.tool_version,
        file: report.file,
        digest: report.digest,
    };
    let text = |artefact: Artefact| {
        let text = match artefact.made {
            Made::Run(text) => text(report)?,
            Made::Curve(key) => curve_csv(key, report.channels)?,
            Made::Sheet(text) => text(report.calibration?, &provenance),
            _ => return None,
        };
        Some((artefact.name.to_owned(), text))
    };
    of(Place::Run).filter_map(text).collect()
}

/// Texts and pictures of a log's folder but for its samples: name and text. A picture that would be
/// too large is left out with a note in `summary.json`.
#[must_use]
pub fn log_files(report: &LogReport, signals: &RunSignals) -> Vec<(String, String)> {
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
    let text = |artefact: Artefact| {
        let text = match artefact.made {
            Made::Log(text) => text(report)?,
            Made::Curve(key) => curve_csv(key, report.channels)?,
            _ => return None,
        };
        Some((artefact.name.to_owned(), text))
    };
    let texts = of(Place::Log).filter_map(text);
    texts.chain(pictures.drawn).collect()
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
            all.add(format!("{axis}{}", artefact.name), &picture);
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
        assert_eq!(SAMPLES.named("raw"), "samples/raw.npy");
        assert_eq!(TRUTH_SAMPLES.named("x_"), "samples/x_truth.npy");
        assert_eq!(TIME_SAMPLES.named(""), "samples/time_s.npy");
    }
}
