//! Noise of a log as a linear system, for whoever builds a Kalman filter with it.

use nalgebra::DMatrix;
use serde_json::{Value, json};

use crate::metrics::{FlickerBank, StateSpace};
use crate::report::layout::json::{array, number, pretty, tool};

/// What the document is, by which a file of it is told from another.
const KIND: &str = "noise-state-space";

/// How the matrices are meant.
const CONVENTION: &str = "x[k+1] = F x[k] + w[k], y[k] = H x[k] + v[k]; E[w w'] = Q_d, E[v v] = R, \
                          E[w v] = S, E[x[0] x[0]'] = P0; y is the noise of sample k, the mean rate \
                          over it, deg/h";

/// The system of a channel's noise.
#[derive(Clone, Copy, Debug)]
pub struct KalmanReport<'a> {
    /// Version of the tool.
    pub tool_version: &'a str,
    /// Name of the log, without its folder.
    pub file: &'a str,
    /// System of its noise.
    pub system: &'a StateSpace,
}

/// The system as JSON: matrices by rows, the states of the rows named.
#[must_use]
pub fn kalman_json(report: &KalmanReport) -> String {
    let system = report.system;
    let states: Vec<Value> = system
        .states
        .iter()
        .map(|state| json!({"name": state.name, "unit": state.unit, "holds": state.holds}))
        .collect();
    let mut document = json!({
        "schema": 1,
        "kind": KIND,
        "tool": tool(report.tool_version),
        "log": report.file,
        "convention": CONVENTION,
        "sample_period_s": system.sample_period_s,
        "tau_min_s": system.tau_range_s[0],
        "tau_max_s": system.tau_range_s[1],
        "states": states,
        "F": rows(&system.transition),
        "Q_d": rows(&system.process_noise),
        "H": array(&system.observation),
        "R": number(system.measurement_noise),
        "S": array(&system.cross_covariance),
        "P0": rows(&system.initial),
        "allan_deviation": curve(system),
    });
    if let Some(bank) = &system.flicker {
        document["flicker"] = flicker(bank);
    }
    pretty(&document)
}

/// Whether a text is such a document.
#[must_use]
pub fn is_kalman_json(text: &str) -> bool {
    let document: Option<Value> = serde_json::from_str(text).ok();
    document.is_some_and(|it| it["kind"] == KIND && it["tool"]["name"] == "fogbench")
}

fn rows(matrix: &DMatrix<f64>) -> Value {
    let rows = matrix.row_iter();
    rows.filter_map(|row| array(row.iter())).collect()
}

fn flicker(bank: &FlickerBank) -> Value {
    json!({
        "correlation_times_s": array(&bank.correlation_times_s),
        "poles_per_decade": bank.poles_per_decade,
        "within": FlickerBank::STATED,
        "tau_min_s": bank.tau_range_s[0],
        "tau_max_s": bank.tau_range_s[1],
    })
}

/// Allan deviation of the system at octaves of the averaging time.
fn curve(system: &StateSpace) -> Value {
    let [shortest, longest] = system.tau_range_s;
    let tau = std::iter::successors(Some(shortest), |tau_s| Some(2.0 * tau_s));
    tau.take_while(|tau_s| *tau_s <= longest)
        .map(|tau_s| {
            json!({
                "tau_s": tau_s,
                "deviation_deg_per_h": system.allan_deviation_deg_per_h(tau_s),
            })
        })
        .collect()
}
