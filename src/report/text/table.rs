//! What `run` prints for one scenario.

use crate::metrics::catalogue::{ANGLE_RANDOM_WALK, DELAY_VS_TRUTH};
use std::collections::BTreeMap;

use crate::gate::{
    ClaimKind, Verdict, VerdictKind, estimate_text, judge_claim, plain, simulated, three_digits,
};
use crate::metrics::{ChannelMetrics, Metric, MetricKey, find, known_metrics};
use crate::report::RunReport;
use crate::report::budget::replacement;
use crate::report::calibration::text::calibration_text;
use crate::report::layout::text::{Grid, Tone, toned, visible_width, wrapped};
use crate::report::record::columns::{Column, DIGITS, columns, matters, unit_text, value_text};
use crate::report::record::measured::Measured;
use crate::report::record::sweep::assignments_text;
use crate::report::text::compensation::compensation_text;
use crate::report::text::quality::quality_text;
use crate::report::text::repeats::repeats_text;
use crate::report::text::scale_factor::{found_dwells_text, scale_factor_text};
use crate::report::text::temperature::temperature_text;
use crate::report::text::verdict::verdict_text;
use crate::scenario::LogFacts;
use crate::scenario::{AssumedValue, Fidelity, PublishedConfig};
use crate::wording::{counted, printable};

/// What stands where there is no number.
const NOTHING: &str = "-";
const INDENT: &str = "  ";
/// What the intervals of the table are.
const INTERVALS: &str = "±: 95 % confidence for the mean over seeds of records like this one; a figure \
     without is exact or, as summary.json then says, has none";

/// The table of one run: budget, channels by metrics, published figures beside the simulated
/// ones, gates, failures and notes. Lines are kept within `width` where words allow it.
#[must_use]
pub fn table_text(report: &RunReport, width: usize, colour: bool) -> String {
    let mut text = heading(report, width, colour);
    text.push_str(&gyro_text(report, width));
    if let Some(sheet) = report.compensation {
        text.push_str(&compensation_text(sheet, width));
    }
    text.push_str(&channels_text(&report.measured(), width, colour));
    text.push_str(&wrapped(INTERVALS, INDENT, width));
    text.push_str(&scale_factor_text(report, width, colour));
    text.push_str(&repeats_text(report, width, colour));
    let verdicts = report.verdicts;
    text.push_str(&failures_text(&report.measured(), verdicts, width, colour));
    if report.log.is_some() {
        text.push_str(&found_dwells_text(report.channels, width, colour));
        text.push_str(&quality_text(report.channels, width));
        text.push_str(&temperature_text(report.channels, width));
    }
    text.push_str(&filter_verdicts(&report.measured(), width, colour));
    text.push_str(&sine_fits(report.channels, width));
    if let Some(sheet) = report.calibration {
        text.push_str(&calibration_text(sheet, width, colour));
    }
    text.push_str(&published(report, colour));
    text.push_str(&gates_text(report.verdicts, width, colour, |verdict| {
        report.assumption_behind(verdict.metric_name())
    }));
    for note in report.notes {
        let note = format!("{} {note}", toned("note:", Tone::Doubt, colour));
        text.push_str(&wrapped(&note, INDENT, width));
    }
    text
}

fn heading(report: &RunReport, width: usize, colour: bool) -> String {
    let scenario = report.scenario;
    let model = match scenario.fidelity {
        Fidelity::Loop => "loop model",
        Fidelity::Rate => "rate model",
    };
    let origin = match report.log {
        Some(log) => (format!("log {}", log.file), String::new()),
        None => (model.to_owned(), format!(", seed {}", scenario.seed)),
    };
    let mut text = format!(
        "{}  {}, {} s after {} s of warm-up{}, {}\n",
        toned(&scenario.name, Tone::Heading, colour),
        origin.0,
        plain(scenario.duration_s),
        plain(scenario.warm_up_s),
        origin.1,
        report.file,
    );
    if let Some(description) = &scenario.description {
        text.push_str(&wrapped(&printable(description), INDENT, width));
    }
    if let Some((index, point)) = &report.sweep {
        let line = format!("point {index:04}: {}", assignments_text(point));
        text.push_str(&wrapped(&line, INDENT, width));
    }
    text
}

/// The gyro in closed form: rates, loop, range and the budget of its angle random walk.
fn gyro_text(report: &RunReport, width: usize) -> String {
    let Some(gyro) = report.gyro else {
        let of_log = report.log.map(|log| wrapped(&log_line(log), INDENT, width));
        return of_log.unwrap_or_default() + &wrapped(&assumed_text(report), INDENT, width);
    };
    let mark = |key: &str| {
        if report.assumed.names(key) {
            " (assumed)"
        } else {
            ""
        }
    };
    let bandwidth = mark("gyro.controller.loop_bandwidth_hz");
    let line = format!(
        "gyro: output rate {} Hz, proper frequency {} kHz, loop gain {}, loop bandwidth {} Hz{bandwidth}, \
         single-fringe range ±{} deg/s",
        plain(gyro.output_rate_hz),
        three_digits(gyro.proper_frequency_khz),
        three_digits(gyro.loop_gain),
        plain(gyro.loop_bandwidth_hz),
        three_digits(gyro.single_fringe_range_deg_per_s),
    );
    let terms: Vec<String> = gyro
        .angle_random_walk_budget_deg_per_sqrt_h
        .iter()
        .map(|(source, value)| format!("{source} {}", three_digits(*value)))
        .collect();
    let of_power = if report.assumed.names("gyro.source.power_uw") {
        ", at a power that is assumed"
    } else {
        ""
    };
    let mut budget = format!(
        "ARW budget (theory{of_power}), deg/sqrt(h): {}",
        terms.join(", ")
    );
    for (name, metrics) in report.channels {
        if !report.scenario.is_raw(name) {
            continue;
        }
        if let Some(metric) = metrics.get(&ANGLE_RANDOM_WALK) {
            let value = estimate_text(&metric.estimate, DIGITS);
            budget.push_str(&format!("; simulated {name} {value}"));
        }
    }
    let mut text = wrapped(&line, INDENT, width) + &wrapped(&budget, INDENT, width);
    if let Some(said) = replacement(&gyro.replaced_noise_sources) {
        text.push_str(&wrapped(&said, INDENT, width));
    }
    text + &wrapped(&assumed_text(report), INDENT, width)
}

/// What a recorded log is.
fn log_line(log: &LogFacts) -> String {
    let column = log.column.as_ref();
    let column = column.map_or_else(String::new, |column| {
        format!(", column {}", printable(column))
    });
    format!(
        "log: {}{column}, {}, {} at {} Hz",
        printable(&log.file),
        log.unit,
        counted(log.samples, "sample"),
        plain(log.sample_rate_hz),
    )
}

/// What nobody set: the figures above and below rest on it, and some only say it again.
fn assumed_text(report: &RunReport) -> String {
    let assumed = &report.assumed;
    if assumed.count == 0 {
        return String::new();
    }
    let named: Vec<String> = assumed.named.iter().map(AssumedValue::shown).collect();
    let named = match named[..] {
        [] => String::new(),
        _ => format!("{}; ", named.join(", ")),
    };
    let is_shown = |metric: &MetricKey| {
        let mut raw = report
            .channels
            .iter()
            .filter(|(name, _)| report.scenario.is_raw(name));
        raw.any(|(_, metrics)| metrics.get(metric).is_some())
    };
    let echoes = known_metrics().iter();
    let echoes = echoes.filter(|metric| report.assumption_behind(metric.name).is_some());
    let echoes = echoes.filter(|metric| is_shown(metric));
    let echoes: Vec<String> = echoes.map(|metric| metric.title()).collect();
    let echoed = match echoes[..] {
        [] => String::new(),
        _ => format!("the measured {} say it again; ", echoes.join(" and ")),
    };
    format!(
        "assumed, as nobody set it: {named}{echoed}{} in all, which report.html and `fogbench expand --origins` list",
        counted(assumed.count, "value")
    )
}

/// The channels, their columns broken into as many blocks as the width asks for.
pub(crate) fn channels_text(report: &Measured, width: usize, colour: bool) -> String {
    let columns = columns(&report.motion, report.channels);
    if columns.is_empty() && report.motion.campaign().is_some() {
        return String::new();
    }
    let names = column_of_names(report.channels, colour);
    let mut text = String::new();
    let mut block = vec![names.clone()];
    let mut used = INDENT.len() + widest(&names);
    for column in &columns {
        let cells = column_cells(column, report.channels);
        let more = widest(&cells) + 2;
        if block.len() > 1 && used + more > width {
            text.push_str(&block_lines(&block));
            block = vec![names.clone()];
            used = INDENT.len() + widest(&names);
        }
        used += more;
        block.push(cells);
    }
    text.push_str(&block_lines(&block));
    text
}

fn column_of_names(channels: &[(String, ChannelMetrics)], colour: bool) -> Vec<String> {
    let names = channels.iter().map(|(name, metrics)| {
        if metrics.error.is_some() {
            toned(name, Tone::Bad, colour)
        } else {
            name.clone()
        }
    });
    [toned("channel", Tone::Heading, colour), String::new()]
        .into_iter()
        .chain(names)
        .collect()
}

/// Title, unit, then one cell per channel.
fn column_cells(column: &Column, channels: &[(String, ChannelMetrics)]) -> Vec<String> {
    let of = |metrics: &'_ ChannelMetrics| metrics.get(column.key).cloned();
    let unit = channels
        .iter()
        .find_map(|(_, metrics)| of(metrics))
        .map(|metric| unit_text(&metric))
        .unwrap_or_default();
    let cells = channels.iter().map(|(_, metrics)| match of(metrics) {
        Some(metric) => value_text(&metric),
        None => NOTHING.to_owned(),
    });
    [column.title.clone(), unit]
        .into_iter()
        .chain(cells)
        .collect()
}

fn widest(cells: &[String]) -> usize {
    cells
        .iter()
        .map(|cell| visible_width(cell))
        .max()
        .unwrap_or(0)
}

fn block_lines(columns: &[Vec<String>]) -> String {
    let mut grid = Grid::default();
    let rows = columns.first().map_or(0, Vec::len);
    for row in 0..rows {
        grid.row(columns.iter().map(|cells| cells[row].clone()));
    }
    format!("\n{}", grid.lines(INDENT))
}

/// Channels that failed, metrics of the table that a record could not support, then how the noise below
/// counted pulses was found.
pub(crate) fn failures_text(
    report: &Measured,
    verdicts: &[Verdict],
    width: usize,
    colour: bool,
) -> String {
    let mut text = String::new();
    for (name, metrics) in report.channels {
        if let Some(failure) = &metrics.error {
            let line = format!(
                "{} channel {name} at sample {} ({}): {}",
                failure_word(verdicts, name, colour),
                failure.sample,
                failure.kind,
                failure.message
            );
            text.push_str(&wrapped(&line, INDENT, width));
        }
    }
    for ((key, reason), names) in missing(report) {
        let line = format!("no {key} for {}: {reason}", names.join(", "));
        text.push_str(&wrapped(&line, INDENT, width));
    }
    for ((key, words), names) in pulse_words(report) {
        let line = format!("{key} for {}: {words}", names.join(", "));
        text.push_str(&wrapped(&line, INDENT, width));
    }
    if text.is_empty() {
        text
    } else {
        format!("\n{text}")
    }
}

/// How the noise of words that count pulses was found, with the channels concerned.
fn pulse_words<'a>(report: &Measured<'a>) -> BTreeMap<(&'a str, &'a str), Vec<&'a str>> {
    let mut told: BTreeMap<(&str, &str), Vec<&str>> = BTreeMap::new();
    for (name, metrics) in report.channels {
        for (key, words) in &metrics.pulse_words {
            let is_there = metrics.metrics.contains_key(key);
            if is_there {
                told.entry((key, words)).or_default().push(name);
            }
        }
    }
    told
}

/// What the sine fits use of the run, and what they leave out.
fn sine_fits(channels: &[(String, ChannelMetrics)], width: usize) -> String {
    let mut fits = channels.iter().filter_map(|(_, metrics)| {
        let fields = &metrics.get(&DELAY_VS_TRUTH)?.fields;
        let field = |name: &str| fields.get(name).copied();
        Some((
            field("cycles")?,
            field("frequency_hz")?,
            field("excluded_s")?,
        ))
    });
    fits.next()
        .map_or_else(String::new, |(cycles, frequency_hz, excluded_s)| {
            let line = format!(
                "sine fits: {} whole cycles of {} Hz after the first {:.4} s, which are left out",
                plain(cycles),
                plain(frequency_hz),
                excluded_s,
            );
            format!("\n{}", wrapped(&line, INDENT, width))
        })
}

/// What each filter does, in words.
pub(crate) fn filter_verdicts(measured: &Measured, width: usize, colour: bool) -> String {
    let mut text = String::new();
    for (name, metrics) in measured.channels {
        if let Some(verdict) = verdict_text(metrics) {
            let line = format!(
                "{} {verdict}",
                toned(&format!("{name}:"), Tone::Heading, colour)
            );
            text.push_str(&wrapped(&line, INDENT, width));
        }
    }
    if text.is_empty() {
        text
    } else {
        format!("\n{text}")
    }
}

/// A gate on the failure of a channel makes it an expected one.
fn failure_word(verdicts: &[Verdict], channel: &str, colour: bool) -> String {
    let metric = format!("{channel}.diverged_at_s");
    let mut verdicts = verdicts.iter();
    if verdicts.any(|verdict| verdict.metric == metric) {
        toned("failed as expected:", Tone::Good, colour)
    } else {
        toned("FAILED", Tone::Bad, colour)
    }
}

/// Metrics that this table would show and the record could not support, with the reason and the
/// channels concerned; what is not defined for a motion or a channel is left to the JSON.
fn missing<'a>(report: &Measured<'a>) -> BTreeMap<(&'a str, &'a str), Vec<&'a str>> {
    let mut missing: BTreeMap<(&str, &str), Vec<&str>> = BTreeMap::new();
    for (name, metrics) in report.channels {
        for (key, reason) in &metrics.unavailable {
            let is_missed = find(key).is_some_and(|known| {
                matters(&report.motion, known) && !known.filters_only && !known.is_by_choice
            });
            if is_missed {
                missing
                    .entry((key, reason.as_str()))
                    .or_default()
                    .push(name);
            }
        }
    }
    missing
}

fn published(report: &RunReport, colour: bool) -> String {
    if report.scenario.published.is_empty() {
        return String::new();
    }
    let mut grid = Grid::default();
    let heads = [
        "published",
        "unit",
        "paper",
        "simulated",
        "interval",
        "difference",
        "source",
    ];
    grid.row(heads.map(|head| toned(head, Tone::Heading, colour)));
    for figure in &report.scenario.published {
        grid.row(published_row(figure, report.channels));
    }
    format!("\n{}{}", grid.lines(INDENT), claims(report, colour))
}

/// What becomes of the published figures that are claims, a line for each.
fn claims(report: &RunReport, colour: bool) -> String {
    let judged = report.scenario.published.iter();
    let lines = judged.filter_map(|figure| {
        let verdict = judge_claim(figure, report.channels)?;
        let tone = match verdict.kind {
            ClaimKind::Consistent | ClaimKind::Exceeded => Tone::Good,
            ClaimKind::NotReached => Tone::Bad,
            ClaimKind::NotTestable => Tone::Doubt,
        };
        let word = toned(verdict.kind.as_str(), tone, colour);
        Some(format!(
            "{INDENT}{word} {}: {}\n",
            shown(figure),
            verdict.reason
        ))
    });
    lines.collect()
}

/// A figure as it is called: the metric, over that of another channel if it is relative to it.
fn shown(figure: &PublishedConfig) -> String {
    match &figure.relative_to {
        Some(reference) => format!("{} / {reference}", figure.metric),
        None => figure.metric.clone(),
    }
}

fn published_row(figure: &PublishedConfig, channels: &[(String, ChannelMetrics)]) -> [String; 7] {
    let (value, interval, difference) = match simulated(figure, channels) {
        Some(metric) => beside(figure, &metric),
        None => (
            "not measured".to_owned(),
            NOTHING.to_owned(),
            NOTHING.to_owned(),
        ),
    };
    [
        shown(figure),
        figure.unit.clone(),
        written(figure.value),
        value,
        interval,
        difference,
        figure.source.clone(),
    ]
}

/// Relative differences from which on the published figure is as good as zero, %.
const PERCENT_MAX: f64 = 1e6;

/// A published figure as its source prints it, a tiny or huge one with its power of ten.
fn written(value: f64) -> String {
    if value == 0.0 || (1e-9..1e15).contains(&value.abs()) {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

/// Simulated value, its interval, and simulated minus published, absolute and relative.
fn beside(figure: &PublishedConfig, metric: &Metric) -> (String, String, String) {
    let estimate = metric.estimate;
    let value = plain(estimate.value);
    let interval = if estimate.low < estimate.high {
        format!("[{}, {}]", plain(estimate.low), plain(estimate.high))
    } else {
        NOTHING.to_owned()
    };
    if metric.unit != figure.unit && !(metric.unit == "1" && figure.unit.is_empty()) {
        let units = format!("none: simulated in {}", metric.unit);
        return (value, interval, units);
    }
    let difference = estimate.value - figure.value;
    let sign = if difference < 0.0 { "" } else { "+" };
    let mut text = format!("{sign}{}", plain(difference));
    let percent = 100.0 * difference / figure.value.abs();
    if percent.abs() < PERCENT_MAX {
        text.push_str(&format!(" ({percent:+.1} %)"));
    }
    (value, interval, text)
}

/// One line per gate: `PASS  rls.delay_vs_raw_ms: 0.340 ms ... lies inside [0.33, 0.35] ms`.
///
/// * `assumption_behind`: the key that nobody set and that the metric of a gate says again.
pub(crate) fn gates_text(
    verdicts: &[Verdict],
    width: usize,
    colour: bool,
    assumption_behind: impl Fn(&Verdict) -> Option<&'static str>,
) -> String {
    if verdicts.is_empty() {
        return String::new();
    }
    let mut text = String::from("\n");
    for verdict in verdicts {
        let mut line = gate_line(verdict, colour);
        if let Some(key) = assumption_behind(verdict) {
            line.push_str(&format!(
                "; this says an assumption again: nobody set {key}"
            ));
        }
        text.push_str(&wrapped(&line, INDENT, width));
    }
    text
}

/// A gate in words, its place behind it unless it was accepted.
pub(crate) fn gate_line(verdict: &Verdict, colour: bool) -> String {
    let word = match (verdict.kind, verdict.accepted) {
        (VerdictKind::Pass, _) => toned("PASS", Tone::Good, colour),
        (VerdictKind::Fail, _) => toned("FAIL", Tone::Bad, colour),
        (VerdictKind::Inconclusive, true) => toned("INCONCLUSIVE (allowed)", Tone::Doubt, colour),
        (VerdictKind::Inconclusive, false) => toned("INCONCLUSIVE", Tone::Bad, colour),
    };
    let place = match &verdict.location {
        Some(location) if !verdict.accepted => format!(" ({location})"),
        _ => String::new(),
    };
    format!("{word} {}: {}{place}", verdict.metric, verdict.reason)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::Estimate;

    fn published(value: f64) -> PublishedConfig {
        PublishedConfig {
            metric: "raw.mean_deg_per_h".to_owned(),
            value,
            unit: "deg/h".to_owned(),
            source: "a paper".to_owned(),
            relative_to: None,
            rounding: None,
        }
    }

    fn difference_from(value: f64) -> String {
        let metric = Metric::new(Estimate::exact(9.0), "deg/h");
        beside(&published(value), &metric).2
    }

    #[test]
    fn a_difference_is_relative_to_a_figure_that_is_not_as_good_as_zero() {
        assert_eq!(difference_from(8.0), "+1 (+12.5 %)");
        assert_eq!(difference_from(0.0), "+9");
        assert_eq!(difference_from(5e-324), "+9");
    }

    #[test]
    fn a_figure_is_shown_as_its_source_prints_it() {
        assert_eq!(written(0.0603), "0.0603");
        assert_eq!(written(0.0), "0");
        assert_eq!(written(370_370.4), "370370.4");
        assert_eq!(written(5e-324), "5e-324");
        assert_eq!(written(-2.5e300), "-2.5e300");
    }
}
