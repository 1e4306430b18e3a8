//! The table of a scale factor test: what every rate became in every channel.

use super::csv::{Curve, curve_csv};
use super::text::{Grid, Tone, toned, wrapped};
use crate::gate::plain;
use crate::metrics::MetricKey;
use crate::metrics::catalogue::{SCALE_FACTOR_NONLINEARITY, SCALE_FACTOR_NONLINEARITY_OF_READING};
use crate::report::RunReport;
use crate::scenario::FilterState;
use crate::units::deg_per_h_to_deg_per_s;

const INDENT: &str = "  ";

/// Rates of a staircase.
const CURVE: &str = "scale_factor";

/// Rates of the staircase of every channel, or nothing if no channel has a scale factor.
#[must_use]
pub fn scale_factor_csv(report: &RunReport) -> Option<String> {
    curve_csv(report.channels, CURVE, |metrics| metrics.curves.get(CURVE))
}

/// The word of a setting in tables and files.
pub(crate) fn filter_state_word(state: FilterState) -> &'static str {
    match state {
        FilterState::Carried => "carried",
        FilterState::Reset => "reset",
    }
}

/// How the test was made, then one row a rate; empty for other motions.
pub(crate) fn scale_factor_text(report: &RunReport, width: usize, colour: bool) -> String {
    let stairs = report.scenario.turntable.motion.stairs();
    let Some(stairs) = stairs.filter(|stairs| stairs.has_static_zeros) else {
        return String::new();
    };
    let curves: Vec<(&str, &Curve)> = report
        .channels
        .iter()
        .filter_map(|(name, metrics)| Some((name.as_str(), metrics.curves.get("scale_factor")?)))
        .collect();
    let Some((_, first)) = curves.first() else {
        return String::new();
    };
    let state = filter_state_word(report.scenario.trial.filter_state);
    let settled = plain(stairs.settle_s);
    let title = toned("scale factor test:", Tone::Heading, colour);
    let line = format!(
        "{title} filter state: {state}; {settled} s of settling left out of each dwell; static zero \
         before and after subtracted; residuals in ppm of full scale (FS) and of reading with the \
         half width of their 95 % intervals"
    );
    let mut text = format!("\n{}", wrapped(&line, INDENT, width));
    text.push_str(&noise_floors(report, width));
    text.push_str(&rows(first, &curves, colour).lines(INDENT));
    if column(first, "whole_turns").contains(&0.0) {
        let note = "* not a whole number of turns: an error that goes with the table's angle does \
                    not average out";
        text.push_str(&wrapped(note, INDENT, width));
    }
    text
}

/// What noise alone would make of the nonlinearity.
fn noise_floors(report: &RunReport, width: usize) -> String {
    let floors = report.channels.iter().filter_map(|(name, metrics)| {
        let of = |key: &MetricKey| {
            let metric = metrics.get(key)?;
            metric.fields.get("noise_floor_ppm").copied()
        };
        let full_scale = of(&SCALE_FACTOR_NONLINEARITY)?;
        let reading = of(&SCALE_FACTOR_NONLINEARITY_OF_READING)?;
        Some(format!(
            "{name} {} ppm of FS, {} ppm of reading",
            rounded(full_scale),
            rounded(reading)
        ))
    });
    let line = format!(
        "noise floor, the largest residual to expect of an ideal gyro with this noise: {}",
        floors.collect::<Vec<_>>().join("; ")
    );
    wrapped(&line, INDENT, width)
}

fn rows(first: &Curve, curves: &[(&str, &Curve)], colour: bool) -> Grid {
    let mut grid = Grid::default();
    let heads = ["rate [deg/s]", "time [s]", "turns"].map(str::to_owned);
    let channels = curves
        .iter()
        .flat_map(|(name, _)| [format!("{name} [ppm FS]"), format!("{name} [ppm]")]);
    let heads = heads.into_iter().chain(channels);
    grid.row(heads.map(|head| toned(&head, Tone::Heading, colour)));
    for row in 0..column(first, "input_deg_per_h").len() {
        let at = |name: &str| column(first, name).get(row).copied().unwrap_or(0.0);
        let mark = if at("whole_turns") > 0.0 { "" } else { "*" };
        let own = [
            format!("{:+.4}", deg_per_h_to_deg_per_s(at("input_deg_per_h"))),
            format!("{:.2}", at("measured_s")),
            format!("{:+.3}{mark}", at("turns")),
        ];
        let residuals = curves
            .iter()
            .flat_map(|(_, curve)| ["full_scale", "reading"].map(|of| residual(curve, of, row)));
        grid.row(own.into_iter().chain(residuals));
    }
    grid
}

/// A residual with the half width of its interval.
fn residual(curve: &Curve, of: &str, row: usize) -> String {
    let end = |end: &str| {
        let values = column(curve, &format!("residual{end}_ppm_of_{of}"));
        values.get(row).copied().unwrap_or(0.0)
    };
    let half_width = 0.5 * (end("_high") - end("_low"));
    format!("{} +- {}", rounded(end("")), rounded(half_width))
}

/// Two decimals below ten, one below a hundred, none from there on.
fn rounded(value: f64) -> String {
    let decimals = match value.abs() {
        size if size < 9.995 => 2,
        size if size < 99.95 => 1,
        _ => 0,
    };
    format!("{value:.decimals$}")
}

fn column<'a>(curve: &'a Curve, name: &str) -> &'a [f64] {
    curve.get(name).map_or(&[], Vec::as_slice)
}
