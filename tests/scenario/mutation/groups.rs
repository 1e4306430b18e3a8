//! Groups files: columns in every combination, numbers near those of a real assembly and far from it.

use std::path::Path;
use std::sync::LazyLock;

use fogbench::experiment::{GroupsSettings, calibrate_groups};
use fogbench::recording::read_groups;
use fogbench::report::{calibrate_json, calibrate_text};
use fogbench::scenario::CalibrationConfig;
use fogbench::units::{deg_per_h_to_deg_per_s, deg_per_s_to_deg_per_h};
use fogbench::vocabulary::EstimatorKind;

use super::values::{Spelling, mutate_bytes, mutate_table};
use super::{Outcome, assert_complaint, assert_document, campaign, result_folder};
use crate::support::patent_cases::{rates, truth};
use crate::support::seeded::Draws;

/// Units of rates at the end of column names, and what one deg/h is in them.
const UNITS: [(&str, f64); 6] = [
    ("deg_per_h", 1.0),
    ("deg_per_s", 1.0 / 3600.0),
    ("mdeg_per_s", 1.0 / 3.6),
    ("arcsec_per_s", 1.0),
    ("rad_per_s", std::f64::consts::PI / 648_000.0),
    ("rad_per_h", std::f64::consts::PI / 180.0),
];

/// Which optional columns there are.
struct Columns {
    rate_unit: (&'static str, f64),
    output_unit: (&'static str, f64),
    names: bool,
    each_temperature: bool,
    warming: bool,
    errors: bool,
    references: bool,
    times: bool,
    counts: bool,
}

impl Columns {
    fn draw(draws: &mut Draws) -> Self {
        let mut unit = |usual: usize| {
            if draws.chance(0.6) {
                UNITS[usual]
            } else {
                *draws.pick(&UNITS)
            }
        };
        Self {
            rate_unit: unit(1),
            output_unit: unit(0),
            names: draws.chance(0.5),
            each_temperature: draws.chance(0.3),
            warming: draws.chance(0.2),
            errors: draws.chance(0.5),
            references: draws.chance(0.2),
            times: draws.chance(0.4),
            counts: draws.chance(0.2),
        }
    }

    fn heading(&self) -> Vec<String> {
        let mut names = vec!["mounting".to_owned(), format!("rate_{}", self.rate_unit.0)];
        let mut each = |stem: &str, end: &str| {
            names.extend(["x", "y", "z"].map(|axis| format!("{stem}_{axis}{end}")));
        };
        each("output", &format!("_{}", self.output_unit.0));
        if self.each_temperature {
            each("temperature", "_c");
        }
        if self.warming {
            each("temperature_rate", "_k_per_min");
        }
        if self.errors {
            each("standard_error", "_deg_per_h");
        }
        if self.references {
            each("reference", "_deg_per_s");
        }
        if self.counts {
            each("rejected", "");
            names.push("samples".to_owned());
        }
        if !self.each_temperature {
            names.push("temperature_c".to_owned());
        }
        if self.times {
            names.extend(["averaging_time_s", "start_s", "turns"].map(str::to_owned));
        }
        if self.names {
            names.push("group".to_owned());
        }
        names
    }
}

/// What the groups of a campaign have in common.
struct Campaign {
    columns: Columns,
    noise_deg_per_h: f64,
    drift_deg_per_h_per_k: f64,
    step_c: f64,
    error_deg_per_h: f64,
}

/// Zero at times, else a number of any size between two.
fn zero_or(draws: &mut Draws, zeros: f64, low: f64, high: f64) -> f64 {
    if draws.chance(zeros) {
        0.0
    } else {
        draws.log_uniform(low, high)
    }
}

impl Campaign {
    fn draw(draws: &mut Draws) -> Self {
        Self {
            columns: Columns::draw(draws),
            noise_deg_per_h: zero_or(draws, 0.2, 1e-6, 10.0),
            drift_deg_per_h_per_k: zero_or(draws, 0.3, 1e-3, 1.0),
            step_c: zero_or(draws, 0.3, 1e-6, 10.0),
            error_deg_per_h: zero_or(draws, 0.2, 1e-9, 100.0),
        }
    }

    /// The cells of a group: the three mountings in turn, a few known rates and others.
    fn cells(&self, draws: &mut Draws, index: usize) -> Vec<String> {
        let columns = &self.columns;
        let known = [10.0, 50.0, 90.0, -10.0, -90.0, 0.0, 100.0, 0.01, 1e-9];
        let axis = index % 3;
        let usual = known[(index / 3) % 3 + 3 * draws.below(2)];
        let rate = if draws.chance(0.9) {
            usual
        } else {
            *draws.pick(&known)
        };
        let is_up = draws.chance(0.95);
        let mut seen = rates((axis, rate));
        seen[axis] *= if is_up { 1.0 } else { -1.0 };
        let warmth = 20.0 + self.step_c * index as f64;
        let mut cells = vec![
            format!("{}{}", if is_up { "" } else { "-" }, ["x", "y", "z"][axis]),
            format!("{:?}", deg_per_s_to_deg_per_h(rate) * columns.rate_unit.1),
        ];
        for output in truth().predict(seen).map(deg_per_s_to_deg_per_h) {
            let noise = self.noise_deg_per_h * (draws.unit() + draws.unit() - 1.0);
            let output = output + noise + self.drift_deg_per_h_per_k * (warmth - 25.0);
            cells.push(format!("{:?}", output * columns.output_unit.1));
        }
        let mut each = |is_there: bool, values: [f64; 3]| {
            if is_there {
                cells.extend(values.map(|value| format!("{value:?}")));
            }
        };
        let error = self.error_deg_per_h;
        each(
            columns.each_temperature,
            [warmth, warmth + 0.5, warmth - 0.5],
        );
        each(columns.warming, [self.step_c / 3.0; 3]);
        each(columns.errors, [error, error * 2.0, error]);
        each(columns.references, seen);
        if columns.counts {
            cells.extend(["0", "1", "0", "1000"].map(str::to_owned));
        }
        if !columns.each_temperature {
            cells.push(format!("{warmth:?}"));
        }
        if columns.times {
            cells.extend([36 * (1 + index), 400 * index, 10].map(|number| number.to_string()));
        }
        if columns.names {
            cells.push((index + 1).to_string());
        }
        cells
    }
}

/// A campaign: some rates in each mounting, noise and a drift of the biases with temperature.
fn lines(draws: &mut Draws) -> Vec<Vec<String>> {
    let campaign = Campaign::draw(draws);
    let count = if draws.chance(0.05) {
        draws.below(4)
    } else {
        3 * (2 + draws.below(4))
    };
    let mut lines = vec![campaign.columns.heading()];
    for index in 0..count {
        lines.push(campaign.cells(draws, index));
    }
    lines
}

fn case(draws: &mut Draws, folder: &Path) -> Outcome {
    let mut lines = lines(draws);
    mutate_table(draws, &mut lines, 1);
    if draws.chance(0.02) {
        mutate_table(draws, &mut lines, 0);
    }
    let mut bytes = Spelling::draw(draws).text(&lines).into_bytes();
    if draws.chance(0.1) {
        mutate_bytes(draws, &mut bytes);
    }
    let path = folder.join("groups.csv");
    std::fs::write(&path, &bytes).expect("writable");
    let recorded = match read_groups(&path) {
        Ok(recorded) => recorded,
        Err(error) => {
            assert_complaint(&error.to_string(), "groups.csv");
            return Outcome::Refused;
        }
    };
    let has_references = recorded
        .groups
        .iter()
        .all(|it| it.reference_rate_deg_per_s.is_some());
    static REFERENCE: LazyLock<CalibrationConfig> = LazyLock::new(CalibrationConfig::reference);
    let mut calibration = REFERENCE.clone();
    let kinds = [
        EstimatorKind::Batch,
        EstimatorKind::BatchTemperature,
        EstimatorKind::Arls,
        EstimatorKind::ArlsCovariance,
        EstimatorKind::ArlsTemperature,
    ];
    let is_estimator_asked_for = draws.chance(0.5);
    if is_estimator_asked_for {
        calibration.apply = *draws.pick(&kinds);
    }
    let settings = GroupsSettings {
        latitude_deg: (has_references == draws.chance(0.02)).then_some(32.03),
        calibration,
        is_estimator_asked_for,
    };
    match calibrate_groups(&path, &settings) {
        Ok(trial) => {
            let report = trial.report();
            assert_document(&calibrate_json(&report));
            let text = calibrate_text(&report, 100, false);
            let words = text.split(|c: char| !c.is_alphanumeric());
            let odd = words.filter(|word| ["inf", "NaN"].contains(word)).count();
            assert_eq!(odd, 0, "{text}");
            if draws.chance(0.01) {
                trial.write(&result_folder(folder)).expect("a folder");
            }
            Outcome::Measured
        }
        Err(errors) => {
            assert!(!errors.is_empty());
            for error in errors {
                assert_complaint(&error.to_string(), "groups.csv");
            }
            Outcome::Read
        }
    }
}

#[test]
fn mutated_groups_are_calibrated_or_refused() {
    let one = deg_per_h_to_deg_per_s(3600.0);
    assert!((one - 1.0).abs() < 1e-12, "the units of the table above");
    campaign("groups", 100, case);
}
