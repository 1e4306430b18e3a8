//! What every repeat of a run measured: the tables behind the channels.

use crate::gate::plain;
use crate::metrics::catalogue::{BIAS_STABILITY, MAXIMUM, MEAN, MINIMUM, NOISE_STD};
use crate::metrics::{ChannelMetrics, MetricKey, RepeatStatistics};
use crate::report::RunReport;
use crate::report::layout::text::{Grid, Tone, toned, wrapped};

const INDENT: &str = "  ";
/// Most repeats whose values are printed one by one; all of them stand in `runs.csv`.
const ROWS_MAX: usize = 20;

/// Statistics of the samples of a record, in the order of the first table.
static SAMPLE_STATISTICS: [(&MetricKey, &str); 5] = [
    (&MEAN, "mean"),
    (&NOISE_STD, "std"),
    (&MINIMUM, "min"),
    (&MAXIMUM, "max"),
    (&BIAS_STABILITY, "bias stability"),
];
/// What is shown of each repeat, the first that there is of each pair.
static BY_REPEAT: [(&MetricKey, &str); 2] = [(&MEAN, "mean"), (&BIAS_STABILITY, "bias stability")];
/// A way to take one number from a metric over the repeats.
type Pick = fn(&RepeatStatistics) -> f64;

/// Statistics over the repeats, the last rows of a table of repeats.
const OVER_REPEATS: [(&str, Pick); 4] = [
    ("mean", |of| of.mean),
    ("std", |of| of.standard_deviation),
    ("min", |of| of.minimum),
    ("max", |of| of.maximum),
];

/// The tables of a run with repeats, one pair for each gyro; nothing for a single record.
pub(crate) fn repeats_text(report: &RunReport, width: usize, colour: bool) -> String {
    let mut text = String::new();
    for prefix in report.scenario.axis_prefixes() {
        let channels: Vec<(&str, &ChannelMetrics)> = report
            .channels
            .iter()
            .filter(|(name, metrics)| name.starts_with(prefix) && !metrics.repeats.is_empty())
            .map(|(name, metrics)| (name.as_str(), metrics))
            .collect();
        text.push_str(&samples_text(&channels, width, colour));
        text.push_str(&values_text(&channels, width, colour));
    }
    text
}

/// Statistics of the samples of a record, each the mean over the repeats.
fn samples_text(channels: &[(&str, &ChannelMetrics)], width: usize, colour: bool) -> String {
    let has = |key: &MetricKey| {
        let mut channels = channels.iter();
        channels.any(|(_, metrics)| metrics.repeats.contains_key(key.name))
    };
    let columns: Vec<_> = SAMPLE_STATISTICS
        .iter()
        .filter(|(key, _)| has(key))
        .collect();
    let Some((_, first)) = channels.first().filter(|_| has(&MEAN)) else {
        // A record of many rates, as of a campaign, has no mean worth printing.
        return String::new();
    };
    let count = repeats_of(first);
    let title = format!("statistics of the record, means over {count} runs, deg/h");
    let mut text = format!(
        "\n{}",
        wrapped(&toned(&title, Tone::Heading, colour), INDENT, width)
    );
    let mut grid = Grid::default();
    let heads = columns.iter().map(|(_, head)| (*head).to_owned());
    grid.row(std::iter::once("channel".to_owned()).chain(heads));
    for (name, metrics) in channels {
        let cells = columns.iter().map(|(key, _)| {
            let statistics = metrics.repeats.get(key.name);
            statistics.map_or_else(
                || "-".to_owned(),
                |of| digits(of.mean, of.standard_deviation),
            )
        });
        grid.row(std::iter::once((*name).to_owned()).chain(cells));
    }
    text.push_str(&grid.lines(INDENT));
    text
}

/// Mean and bias stability of every repeat, a column for each channel.
fn values_text(channels: &[(&str, &ChannelMetrics)], width: usize, colour: bool) -> String {
    let mut text = String::new();
    for (key, title) in BY_REPEAT {
        let columns: Vec<(&str, &RepeatStatistics)> = channels
            .iter()
            .filter_map(|(name, metrics)| Some((*name, metrics.repeats.get(key.name)?)))
            .collect();
        let Some((_, first)) = columns.first() else {
            continue;
        };
        let averaging = first.averaging_time_s;
        let over = averaging.map_or_else(String::new, |time_s| format!(", {} s", plain(time_s)));
        let title = format!("{title} of each run, {}{over}", first.unit);
        text.push_str(&format!(
            "{INDENT}{}\n",
            toned(&title, Tone::Heading, colour)
        ));
        for block in blocks(&columns, width) {
            text.push_str(&values_block(block).lines(INDENT));
        }
    }
    text
}

/// Columns that stand beside one another within the width.
fn blocks<'a, 'b>(
    columns: &'a [(&'b str, &'b RepeatStatistics)],
    width: usize,
) -> Vec<&'a [(&'b str, &'b RepeatStatistics)]> {
    const ROW_HEAD: usize = 8;
    const CELL: usize = 12;
    let mut blocks = Vec::new();
    let mut start = 0;
    let mut used = ROW_HEAD;
    for (index, (name, _)) in columns.iter().enumerate() {
        let more = name.len().max(CELL) + 2;
        if index > start && used + more > width {
            blocks.push(&columns[start..index]);
            (start, used) = (index, ROW_HEAD);
        }
        used += more;
    }
    blocks.push(&columns[start..]);
    blocks
}

fn values_block(columns: &[(&str, &RepeatStatistics)]) -> Grid {
    let mut grid = Grid::default();
    let heads = columns.iter().map(|(name, _)| (*name).to_owned());
    grid.row(std::iter::once("run".to_owned()).chain(heads));
    let count = columns.iter().map(|(_, of)| of.repeats()).max();
    for run in 0..count.filter(|count| *count <= ROWS_MAX).unwrap_or(0) {
        let cells = columns.iter().map(|(_, of)| {
            of.value_of(run)
                .map_or_else(String::new, |value| digits(value, of.standard_deviation))
        });
        grid.row(std::iter::once((run + 1).to_string()).chain(cells));
    }
    for (head, pick) in OVER_REPEATS {
        let cells = columns
            .iter()
            .map(|(_, of)| digits(pick(of), of.standard_deviation));
        grid.row(std::iter::once(head.to_owned()).chain(cells));
    }
    grid
}

/// A value to three digits of the scatter between the repeats.
fn digits(value: f64, scatter: f64) -> String {
    const DECIMALS_MAX: i32 = 6;
    let size = if scatter > 0.0 { scatter } else { value.abs() };
    if size <= 0.0 || !size.is_finite() {
        return plain(value);
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the decimal exponent of a finite number, held between 0 and six"
    )]
    let decimals = (2 - size.log10().floor() as i32).clamp(0, DECIMALS_MAX) as usize;
    format!("{value:.decimals$}")
}

pub(in crate::report) fn repeats_of(metrics: &ChannelMetrics) -> usize {
    let mut all = metrics.repeats.values();
    all.next().map_or(0, RepeatStatistics::repeats)
}
