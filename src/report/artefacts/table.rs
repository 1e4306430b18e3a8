//! Rows of the files.

use super::{Artefact, Made, Place, Scene, samples};
use crate::report::budget::budget_csv;
use crate::report::calibration::documents::{calibration_toml, groups_csv};
use crate::report::csv::metrics::metrics_csv;
use crate::report::csv::runs::runs_csv;
use crate::report::json::summary::run_summary_json;
use crate::report::log::log_json;
use crate::report::page::run::run_page;
use crate::report::plot::{self, Picture};
use crate::scenario::MotionClass;

/// What makes the files of a suite.
pub(super) const SUITE: &str = "experiment::suite";
const ALWAYS: &str = "always";
const NPY: &str = "output.samples = \"npy\"";
const RUN: &[Place] = &[Place::Run];
pub(super) const RUN_AND_LOG: &[Place] = &[Place::Run, Place::Log];

/// Summary of a suite.
pub const SUITE_SUMMARY: Artefact = Artefact {
    name: "summary.json",
    holds: "outcome of every run with its gates and metrics, and the tables over several scenarios",
    when: "after every run, so that a stopped suite has one",
    places: &[Place::Suite],
    made: Made::By(SUITE),
};

/// Name of the page of a run.
pub const PAGE: &str = "report.html";

/// Metrics of a suite.
pub const METRICS: Artefact = Artefact {
    name: "metrics.csv",
    holds: "every metric of every run, one a row, with the values of the swept keys",
    when: "after every run, so that a stopped suite has one",
    places: &[Place::Suite],
    made: Made::By(SUITE),
};

/// Page of a suite.
pub const INDEX: Artefact = Artefact {
    name: "index.html",
    holds: "the suite for a browser: outcomes, gates that failed, runs, sweeps with their pictures, tables",
    when: "after every run, so that a stopped suite has one",
    places: &[Place::Suite],
    made: Made::By(SUITE),
};

/// Page of the filters of a suite.
pub const FILTERS: Artefact = Artefact {
    name: "filters.html",
    holds: "filters side by side on every motion that runs of the suite try them on: conditions, noise, cost",
    when: "runs have trial.black_box and two filters or more",
    places: &[Place::Suite],
    made: Made::By(SUITE),
};

/// Verdict of a suite for a build server.
pub const JUNIT: Artefact = Artefact {
    name: "junit.xml",
    holds: "gates and failures as JUnit test cases",
    when: "after every run, so that a stopped suite has one",
    places: &[Place::Suite],
    made: Made::By(SUITE),
};

/// Every file but the CSV files of curves, which [`artefacts`] adds. Pictures stand in the order in
/// which those that are left out are told.
pub(super) const TABLE: &[Artefact] = &[
    SUITE_SUMMARY,
    INDEX,
    FILTERS,
    METRICS,
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
        name: "<metric>.svg",
        holds: "a headline metric of every channel over what is swept, with its intervals",
        when: "every point of the sweep has ended in one suite",
        places: &[Place::Sweep],
        made: Made::By("report::plot"),
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
        places: &[
            Place::Suite,
            Place::Sweep,
            Place::Log,
            Place::Calibration,
            Place::Budget,
        ],
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
        name: "metrics.csv",
        holds: "every metric of every channel, one a row",
        when: ALWAYS,
        places: RUN,
        made: Made::Run(|report| Some(metrics_csv(report))),
    },
    Artefact {
        name: "runs.csv",
        holds: "every metric of every repeat",
        when: "several repeats",
        places: RUN,
        made: Made::Run(runs_csv),
    },
    Artefact {
        name: PAGE,
        holds: "the run for a browser: gates, metrics, pictures, noise budget, what was assumed",
        when: "always; of a sweep of more than 100 points where the run failed, or with \
               output.report = \"all\"",
        places: RUN,
        made: Made::Page(run_page),
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
        "swing, with the true rate",
        RUN_AND_LOG,
        |scene| match scene.measured.motion.class() {
            MotionClass::Swing { frequency_hz, .. }
                if !scene.signals.truth_deg_per_h.is_empty() =>
            {
                plot::swing::picture(&scene.measured, scene.signals, frequency_hz)
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
        RUN_AND_LOG,
        |scene| {
            let state = scene.run.map(|run| run.scenario.trial.filter_state);
            plot::scale_factor::picture(&scene.measured, state)
        },
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
        "temperature.svg",
        "means over the temperature with its coefficients, and what they leave",
        "a log has a column of the temperature that changes",
        RUN_AND_LOG,
        |scene| plot::temperature::picture(&scene.measured),
    ),
    drawn(
        "noise-delay.svg",
        "noise gain over delay of every filter with its bound",
        "a filter's noise was measured at rest or in a swing",
        RUN_AND_LOG,
        |scene| plot::noise_delay::picture(&scene.measured),
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
        RUN_AND_LOG,
        |scene| plot::filter_response::picture(&scene.measured),
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
    Artefact {
        name: samples::CHANNEL,
        holds: "words of a channel, deg/h, warm-up included",
        when: NPY,
        places: RUN,
        made: Made::Samples(samples::channels),
    },
    Artefact {
        name: samples::CHANNEL,
        holds: "words of a filter or of the compensated channel, deg/h, warm-up included",
        when: "there are filters or parameters to compensate with",
        places: &[Place::Log],
        made: Made::Samples(samples::channels_behind_raw),
    },
    Artefact {
        name: "samples/<channel>.csv",
        holds: "time, s, and the same words",
        when: "with --csv",
        places: &[Place::Log],
        made: Made::Samples(samples::channels_behind_raw_as_csv),
    },
    Artefact {
        name: "samples/<axis>truth.npy",
        holds: "true rate at the stamps, deg/h",
        when: NPY,
        places: RUN,
        made: Made::Samples(samples::truths),
    },
    Artefact {
        name: "samples/encoder_arcsec.npy",
        holds: "angle of the table's encoder at the stamps, arcsec",
        when: "output.samples = \"npy\" and the table has an encoder",
        places: RUN,
        made: Made::Samples(samples::encoder),
    },
    Artefact {
        name: samples::INPUT_DIGEST,
        holds: "digest of the samples that the filters are given, for words computed elsewhere",
        when: "output.samples = \"npy\" and there is one gyro",
        places: RUN,
        made: Made::Samples(samples::input_digest),
    },
    Artefact {
        name: samples::INPUT_DIGEST,
        holds: "digest of the samples that the filters are given, for words computed elsewhere",
        when: "there are filters",
        places: &[Place::Log],
        made: Made::Samples(samples::input_digest),
    },
    Artefact {
        name: "samples/time_s.npy",
        holds: "stamps, s",
        when: NPY,
        places: RUN,
        made: Made::Samples(samples::stamps),
    },
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
