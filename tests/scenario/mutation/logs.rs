//! Text logs: read as one gyro's or as an assembly's, measured, at times filtered and written.

use std::path::Path;
use std::sync::OnceLock;

use fogbench::experiment::{LogFilters, LogSettings, load_log_filters, try_log};
use fogbench::recording::{
    AssemblyColumns, Log, LogFormat, LogMotion, LogUnit, RateUnit, TimeUnit, read_assembly_log,
    read_log, read_stimulus,
};
use fogbench::report::{log_json, log_text};
use fogbench::scenario::{AllanConfig, AllanEstimatorConfig};
use fogbench::vocabulary::AveragingTimes;

use super::values::{Spelling, mutate_bytes, mutate_table, record};
use super::{Outcome, assert_complaint, assert_document, campaign, result_folder};
use crate::support::seeded::Draws;

/// Filters without a corner, so that they stand behind a log of any rate.
const FILTERS: &str = "schema = 1
[[filter]]
name = \"rls\"
[filter.rls]
pipeline = \"textbook\"
[[filter]]
name = \"nlms\"
[filter.lms]
pipeline = \"textbook\"
[[filter]]
name = \"hardware\"
[filter.rls]
pipeline = \"fpga\"
clock_mhz = 100.0
[[filter]]
name = \"mean\"
[filter.moving_average]
taps = 3
";

fn filters() -> &'static LogFilters {
    static FOUND: OnceLock<LogFilters> = OnceLock::new();
    FOUND.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a scratch folder");
        let path = crate::support::write(folder.path(), "filters.toml", FILTERS);
        load_log_filters(&path, &[], 100.0).expect("sound filters")
    })
}

/// What is said of a log.
pub(super) fn format(draws: &mut Draws) -> LogFormat {
    let units = [
        "deg/h",
        "deg/s",
        "mdps",
        "arcsec/s",
        "rad/s",
        "rad/h",
        "deg/sample",
        "urad/sample",
    ];
    let unit = if draws.chance(0.5) {
        units[0]
    } else {
        *draws.pick(&units)
    };
    LogFormat {
        rate_hz: Some(if draws.chance(0.5) {
            100.0
        } else {
            draws.log_uniform(1e-2, 1e6)
        }),
        unit: Some(unit.parse::<LogUnit>().expect("a unit")),
        scale: (!draws.chance(0.8)).then(|| draws.log_uniform(1e-6, 1e6) - 2e-6),
        time_unit: Some(vec![*draws.pick(&[
            TimeUnit::Seconds,
            TimeUnit::Milliseconds,
            TimeUnit::Microseconds,
        ])]),
        ..LogFormat::default()
    }
}

fn settings(draws: &mut Draws, log: &Log) -> LogSettings {
    let duration_s = log.rate_deg_per_h.len() as f64 / log.sample_rate_hz;
    let a_time = |draws: &mut Draws| draws.log_uniform(0.3, 300.0) / log.sample_rate_hz;
    let estimators = [
        AllanEstimatorConfig::Overlapping,
        AllanEstimatorConfig::Plain,
        AllanEstimatorConfig::Modified,
        AllanEstimatorConfig::Hadamard,
    ];
    let times = [
        AveragingTimes::Octave,
        AveragingTimes::Decade,
        AveragingTimes::All,
    ];
    LogSettings {
        motion: if draws.chance(0.75) {
            LogMotion::Static
        } else {
            let frequency_hz = log.sample_rate_hz * draws.log_uniform(1e-3, 0.3);
            LogMotion::Swing { frequency_hz }
        },
        warm_up_s: if draws.chance(0.7) {
            0.0
        } else {
            duration_s * draws.unit() * 1.1
        },
        bias_averaging_time_s: if draws.chance(0.5) {
            100.0
        } else {
            a_time(draws)
        },
        fit_tau_min_s: draws.chance(0.3).then(|| a_time(draws)),
        allan: AllanConfig {
            estimator: *draws.pick(&estimators),
            averaging_times: *draws.pick(&times),
            ..AllanConfig::reference()
        },
        temperature_reference_c: None,
        settle_s: 0.5,
    }
}

/// Measures a log as `analyze` and `filter` do, and asserts that what is said of it is whole.
pub(super) fn measure(draws: &mut Draws, log: Log, folder: &Path) -> Outcome {
    let file = log.file.clone();
    assert!(log.rate_deg_per_h.iter().all(|rate| rate.is_finite()));
    assert!(
        log.sample_rate_hz.is_finite() && log.sample_rate_hz > 0.0,
        "{}",
        log.sample_rate_hz
    );
    let settings = settings(draws, &log);
    let filters = draws.chance(0.12).then(filters);
    let is_written = draws.chance(0.002);
    match try_log(log, filters, &settings, &()) {
        Ok(trial) => {
            assert_document(&trial.with_report(log_json));
            let text = trial.with_report(|report| log_text(report, 100, false));
            assert!(text.contains(&file));
            if is_written {
                trial.write(&result_folder(folder), true).expect("a folder");
            }
            Outcome::Measured
        }
        Err(error) => {
            assert_complaint(&error.to_string(), &file);
            Outcome::Read
        }
    }
}

/// A table of a time and some rates, with or without a heading; `first` is the first row.
fn table(draws: &mut Draws) -> (Vec<Vec<String>>, usize) {
    let count = if draws.chance(0.05) {
        draws.below(3)
    } else {
        8 + draws.below(120)
    };
    let rates = 1 + draws.below(4);
    let step_s = draws.log_uniform(1e-4, 10.0);
    let jitter = if draws.chance(0.5) {
        0.0
    } else {
        draws.unit() * 0.7
    };
    let columns: Vec<Vec<f64>> = (0..rates).map(|_| record(draws, count)).collect();
    let is_alone = rates == 1 && draws.chance(0.7);
    let mut lines: Vec<Vec<String>> = Vec::new();
    if draws.chance(0.6) {
        let mut names = vec!["t".to_owned()];
        names.extend(
            ["gx", "gy", "gz", "c"]
                .iter()
                .take(rates)
                .map(|it| (*it).to_owned()),
        );
        lines.push(names);
    }
    let first = lines.len();
    for k in 0..count {
        let stamp_s = step_s * (k as f64 + jitter * (draws.unit() - 0.5));
        let mut cells = vec![format!("{stamp_s:?}")];
        let is_warmth = |index: usize| index == 3;
        cells.extend(columns.iter().enumerate().map(|(index, column)| {
            if is_warmth(index) {
                format!("{:?}", 25.0 + (column[k] % 40.0))
            } else {
                format!("{:?}", column[k])
            }
        }));
        lines.push(cells);
    }
    if is_alone {
        for cells in &mut lines {
            cells.remove(0);
        }
    }
    (lines, first)
}

fn case(draws: &mut Draws, folder: &Path) -> Outcome {
    let (mut lines, first) = table(draws);
    let width = lines.first().map_or(1, Vec::len);
    mutate_table(draws, &mut lines, first);
    let mut bytes = Spelling::draw(draws).text(&lines).into_bytes();
    if draws.chance(0.3) {
        mutate_bytes(draws, &mut bytes);
    }
    let path = folder.join("log.csv");
    std::fs::write(&path, &bytes).expect("writable");
    let mut format = format(draws);
    let has_time = width > 1 && draws.chance(0.5);
    if has_time {
        format.time = Some(vec!["1".to_owned()]);
        format.rate_hz = format.rate_hz.filter(|_| draws.chance(0.1));
    }
    if width > 2 || (width > 1 && !has_time) {
        format.column = Some(vec![width.to_string()]);
    }
    if draws.chance(0.03) {
        format.column = Some(vec![
            (*draws.pick(&["gx", "9", "0", "", "t", "-1"])).to_owned(),
        ]);
    }
    if width >= 4 && draws.chance(0.5) {
        let temperature = (width >= 5).then_some("5");
        let columns = AssemblyColumns {
            gyros: ["2", "3", "4"],
            temperature,
        };
        match read_assembly_log(&path, &format, &columns) {
            Ok(assembly) => {
                let [x, y, z] = assembly.gyros;
                assert_eq!(x.rate_deg_per_h.len(), z.rate_deg_per_h.len());
                return measure(draws, y, folder);
            }
            Err(error) => {
                assert_complaint(&error.to_string(), "log.csv");
                return Outcome::Refused;
            }
        }
    }
    match read_log(&path, &format) {
        Ok(log) => {
            let words = read_stimulus(
                &path,
                format.column.as_deref().map(|names| names[0].as_str()),
                usize::MAX,
            );
            if !has_time
                && format.unit == Some(RateUnit::DEG_PER_H.into())
                && format.scale.is_none()
            {
                assert_eq!(words.expect("a log is a stimulus"), log.rate_deg_per_h);
            }
            measure(draws, log, folder)
        }
        Err(error) => {
            assert_complaint(&error.to_string(), "log.csv");
            Outcome::Refused
        }
    }
}

#[test]
fn a_mutated_log_is_measured_or_refused() {
    campaign("logs", 200, case);
}
