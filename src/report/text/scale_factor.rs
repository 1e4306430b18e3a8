//! The table of a scale factor test: what every rate became in every channel.

use crate::gate::plain;
use crate::metrics::catalogue::{
    SCALE_FACTOR, SCALE_FACTOR_NONLINEARITY, SCALE_FACTOR_NONLINEARITY_OF_READING,
    SCALE_FACTOR_OFFSET,
};
use crate::metrics::columns::staircase::{
    INPUT, MEASURED, RESIDUAL, RESIDUAL_HIGH, RESIDUAL_LOW, RESIDUAL_OF_READING,
    RESIDUAL_OF_READING_HIGH, RESIDUAL_OF_READING_LOW, TURNS, WHOLE_TURNS,
};
use crate::metrics::{ChannelMetrics, Column, Curve, MetricKey};
use crate::report::RunReport;
use crate::report::layout::text::{Grid, Tone, toned, wrapped};
use crate::scenario::FilterState;
use crate::units::deg_per_h_to_deg_per_s;

const INDENT: &str = "  ";

/// Residual of full scale with the ends of its interval.
pub(crate) const OF_FULL_SCALE: [&Column; 3] = [&RESIDUAL, &RESIDUAL_LOW, &RESIDUAL_HIGH];
/// Residual of reading with the ends of its interval.
pub(crate) const OF_READING: [&Column; 3] = [
    &RESIDUAL_OF_READING,
    &RESIDUAL_OF_READING_LOW,
    &RESIDUAL_OF_READING_HIGH,
];

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
    let state = filter_state_word(report.scenario.trial.filter_state);
    let settled = plain(stairs.settle_s);
    let title = toned("scale factor test:", Tone::Heading, colour);
    let line = format!(
        "{title} filter state: {state}; {settled} s of settling left out of each dwell; static zero \
         before and after subtracted; residuals in ppm of full scale (FS) and of reading with the \
         half width of their 95 % intervals"
    );
    table(&line, report.channels, width, colour)
}

/// The same of a log whose dwells were found; empty for others.
pub(crate) fn found_dwells_text(
    channels: &[(String, ChannelMetrics)],
    width: usize,
    colour: bool,
) -> String {
    let metrics = channels.iter().map(|(_, metrics)| metrics);
    let Some(offset) = metrics.filter_map(|it| it.get(&SCALE_FACTOR_OFFSET)).next() else {
        return String::new();
    };
    let field = |name: &str| offset.fields.get(name).copied().unwrap_or_default();
    let title = toned("scale factor test:", Tone::Heading, colour);
    let line = format!(
        "{title} {} dwells found in the reference, at least {} s of settling left out of each; residuals in ppm of \
         full scale (FS) and of reading with the half width of their 95 % intervals",
        field("count"),
        plain(field("settle_s"))
    );
    table(&line, channels, width, colour)
}

/// One row a rate behind a line; empty where no channel has a scale factor.
fn table(line: &str, channels: &[(String, ChannelMetrics)], width: usize, colour: bool) -> String {
    let curves: Vec<(&str, &Curve)> = channels
        .iter()
        .filter_map(|(name, metrics)| Some((name.as_str(), metrics.curve(&SCALE_FACTOR)?)))
        .collect();
    let Some((_, first)) = curves.first() else {
        return String::new();
    };
    let mut text = format!("\n{}", wrapped(line, INDENT, width));
    text.push_str(&noise_floors(channels, width));
    text.push_str(&rows(first, &curves, colour).lines(INDENT));
    if WHOLE_TURNS.of(first).contains(&0.0) {
        let note = "* not a whole number of turns: an error that goes with the table's angle does \
                    not average out";
        text.push_str(&wrapped(note, INDENT, width));
    }
    text
}

/// What noise alone would make of the nonlinearity.
fn noise_floors(channels: &[(String, ChannelMetrics)], width: usize) -> String {
    let floors = channels.iter().filter_map(|(name, metrics)| {
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
    for row in 0..INPUT.of(first).len() {
        let at = |column: &Column| column.of(first).get(row).copied().unwrap_or(0.0);
        let mark = if at(&WHOLE_TURNS) > 0.0 { "" } else { "*" };
        let own = [
            format!("{:+.4}", deg_per_h_to_deg_per_s(at(&INPUT))),
            format!("{:.2}", at(&MEASURED)),
            format!("{:+.3}{mark}", at(&TURNS)),
        ];
        let residuals = curves
            .iter()
            .flat_map(|(_, curve)| [OF_FULL_SCALE, OF_READING].map(|of| residual(curve, of, row)));
        grid.row(own.into_iter().chain(residuals));
    }
    grid
}

/// A residual with the half width of its interval.
fn residual(curve: &Curve, of: [&Column; 3], row: usize) -> String {
    let [value, low, high] = of.map(|column| column.of(curve).get(row).copied().unwrap_or(0.0));
    format!("{} +- {}", rounded(value), rounded(0.5 * (high - low)))
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
