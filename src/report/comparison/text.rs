//! The end of a suite in text: tables over several scenarios, causes, assumptions and figures.

use crate::comparison::{Assumed, Cause, ComparedTable, Comparison};
use crate::gate::{estimate_text, plain};
use crate::metrics::MetricKey;
use crate::metrics::catalogue::{ANGLE_RANDOM_WALK_OVER_DC_GAIN, MEAN_RATIO, NOISE_GAIN};
use crate::metrics::{AgainstOne, Estimate, Finding, Metric};
use crate::report::comparison::files::comparison_file_names;
use crate::report::layout::text::{Grid, Tone, toned, with_unit, wrapped};
use crate::report::record::columns::{heading_of, unit_text};
use crate::wording::counted;

const INDENT: &str = "  ";
const DEEP: &str = "    ";
const DIGITS: i32 = 2;
const NOTHING: &str = "-";
/// Defining field of a nonlinearity: what an ideal loop of the same noise would show.
const NOISE_FLOOR: &str = "noise_floor_ppm";

/// Every table with its causes and gaps, the figures that were drawn again, and the assumptions.
#[must_use]
pub fn comparison_text(across: &Comparison, width: usize, colour: bool) -> String {
    let mut text = String::new();
    for table in &across.tables {
        let heading = toned(&table.name, Tone::Heading, colour);
        text.push_str(&format!("\n{heading}  {}\n", table.title));
        if table
            .columns
            .iter()
            .enumerate()
            .any(|(at, _)| table.is_published(at))
        {
            blocks(&mut text, table, colour);
        } else {
            text.push_str(&plain_grid(table, colour));
        }
        text.push_str(&change_lines(table));
        for line in cause_lines(table) {
            text.push_str(&wrapped(&line, INDENT, width));
        }
        if !table.lacking.is_empty() {
            let line = format!("left out: {}", table.lacking.join("; "));
            text.push_str(&wrapped(&line, INDENT, width));
        }
    }
    if !across.figures.is_empty() {
        let heading = toned("Figures", Tone::Heading, colour);
        text.push_str(&format!("\n{heading}  files in the output folder\n"));
        let mut grid = Grid::default();
        for figure in &across.figures {
            grid.row([&figure.name, &figure.file, &figure.shows].map(Clone::clone));
        }
        text.push_str(&grid.lines(INDENT));
    }
    if !across.assumptions.is_empty() {
        let heading = toned("Assumptions", Tone::Heading, colour);
        text.push_str(&format!("\n{heading}  what the publication leaves open\n"));
        for assumed in &across.assumptions {
            text.push_str(&assumption(assumed, width));
        }
    }
    text
}

/// A line for each table, with its file, and one for what the publication leaves open; empty without
/// tables.
#[must_use]
pub fn comparison_lines(across: &Comparison, colour: bool) -> String {
    if across.tables.is_empty() {
        return String::new();
    }
    let mut grid = Grid::default();
    for table in &across.tables {
        let [file, _] = comparison_file_names(table.kind, &table.slug);
        grid.row([table.name.clone(), table.title.clone(), file]);
    }
    let heading = toned("Tables", Tone::Heading, colour);
    let mut text = format!("\n{heading}  -v prints them\n{}", grid.lines(INDENT));
    if !across.assumptions.is_empty() {
        text.push_str(&format!(
            "{INDENT}{} where the publication leaves a reading open: -v prints them\n",
            counted(across.assumptions.len(), "assumption")
        ));
    }
    text
}

/// A block for each metric: rows down, channels across, published before simulated.
fn blocks(text: &mut String, table: &ComparedTable, colour: bool) {
    for (metric, columns) in table.metrics() {
        let unit = columns
            .iter()
            .filter(|column| table.columns[**column].relative_to.is_none())
            .chain(&columns)
            .find_map(|column| table.sample(*column))
            .map_or_else(String::new, unit_text);
        let heading = with_unit(&heading_of(metric), &unit);
        text.push_str(&format!("{INDENT}{heading}\n"));
        let mut grid = Grid::default();
        let mut heads = vec![String::new()];
        for column in &columns {
            let channels = table.columns[*column].channels();
            if table.is_published(*column) {
                heads.push(format!("{channels}: published"));
                heads.push("simulated".to_owned());
            } else {
                heads.push(format!("{channels}: simulated"));
            }
        }
        grid.row(
            heads
                .into_iter()
                .map(|head| toned(&head, Tone::Heading, colour)),
        );
        for row in &table.rows {
            if columns.iter().all(|column| row.cells[*column].is_none()) {
                continue;
            }
            let mut cells = vec![row.label.clone()];
            for column in &columns {
                let cell = row.cells[*column].as_ref();
                if table.is_published(*column) {
                    let published = cell.and_then(|cell| cell.published.as_ref());
                    cells.push(published.map_or(NOTHING.to_owned(), |(value, _)| rounded(*value)));
                }
                cells.push(cell.map_or(NOTHING.to_owned(), |cell| number(&cell.simulated)));
            }
            grid.row(cells);
        }
        text.push_str(&grid.lines(DEEP));
    }
}

/// One grid of simulated numbers, the row that the other scenarios take marked.
fn plain_grid(table: &ComparedTable, colour: bool) -> String {
    let filled = (0..table.columns.len()).filter(|column| table.is_filled(*column));
    let columns: Vec<usize> = filled.collect();
    let mut grid = Grid::default();
    let heads = columns.iter().map(|column| {
        let definition = &table.columns[*column];
        let heading = heading_of(&definition.metric);
        let unit = table.sample(*column).map_or_else(String::new, unit_text);
        with_unit(&format!("{} {heading}", definition.channels()), &unit)
    });
    let heads = std::iter::once(String::new()).chain(heads);
    grid.row(heads.map(|head| toned(&head, Tone::Heading, colour)));
    for row in &table.rows {
        let mark = if row.is_base { " (as read)" } else { "" };
        let cells = columns.iter().map(|column| {
            let cell = row.cells[*column].as_ref();
            cell.map_or(NOTHING.to_owned(), |cell| number(&cell.simulated))
        });
        grid.row(std::iter::once(format!("{}{mark}", row.label)).chain(cells));
    }
    grid.lines(INDENT)
}

/// The largest change of each column per unit of the key in which the rows differ.
fn change_lines(table: &ComparedTable) -> String {
    let Some(heading) = table.change_heading() else {
        return String::new();
    };
    let mut grid = Grid::default();
    for (column, change) in table.changes() {
        grid.row([
            format!("{} {}", column.channels(), heading_of(&column.metric)),
            format!("{} {}", short(&change.estimate), change.unit),
            format!("to row \"{}\"", change.at),
        ]);
    }
    format!("{INDENT}{heading}\n{}", grid.lines(DEEP))
}

/// A number with its interval, and the noise floor where it has one.
fn number(metric: &Metric) -> String {
    let value = short(&metric.estimate);
    match metric.fields.get(NOISE_FLOOR) {
        Some(floor) => format!("{value} (noise floor {})", rounded(*floor)),
        None => value,
    }
}

/// A published figure; of a ratio of such no more digits than they have.
fn rounded(value: f64) -> String {
    let digits = format!("{value:.2e}");
    digits.parse().map_or(digits, plain)
}

/// An estimate; one whose interval is far below what anybody would print to five digits.
fn short(estimate: &Estimate) -> String {
    const NEGLIGIBLE: f64 = 1e-5;
    let Estimate {
        value, low, high, ..
    } = *estimate;
    if value != 0.0 && high - low < NEGLIGIBLE * value.abs() {
        let digits = format!("{value:.4e}");
        return digits.parse().map_or(digits, plain);
    }
    estimate_text(estimate, DIGITS)
}

fn companion<'a>(cause: &'a Cause, key: &MetricKey) -> Option<&'a Metric> {
    let (_, metric) = cause.companions.iter().find(|(name, _)| name == key.name)?;
    Some(metric)
}

/// Why noise is lower in one channel than in another, from the intervals: one line for each row.
fn cause_lines(table: &ComparedTable) -> Vec<String> {
    let mut lines = Vec::new();
    let mut rows: Vec<(&str, &str)> = Vec::new();
    for cause in &table.causes {
        let row = (cause.label.as_str(), cause.channel.as_str());
        if rows.contains(&row) {
            continue;
        }
        rows.push(row);
        let own = |other: &&Cause| (other.label.as_str(), other.channel.as_str()) == row;
        let own: Vec<&Cause> = table.causes.iter().filter(own).collect();
        let clauses: Vec<String> = own.iter().filter_map(|cause| explained(cause)).collect();
        let clauses = if clauses.is_empty() {
            under_motion(cause).into_iter().collect()
        } else {
            let mut clauses = clauses;
            clauses.extend(level(cause));
            clauses
        };
        if !clauses.is_empty() {
            let (label, channel) = row;
            lines.push(format!("{label}, {channel}: {}", clauses.join("; ")));
        }
    }
    lines
}

/// The ratio of one slow noise beside the ratio of DC gains.
fn explained(cause: &Cause) -> Option<String> {
    let (left, gain) = (cause.remainder?, cause.dc_gain?);
    let Finding {
        estimate,
        against_one,
    } = left;
    let verdict = match against_one {
        AgainstOne::Equal => "is the ratio of DC gains",
        AgainstOne::Below => "is below the ratio of DC gains",
        AgainstOne::Above => "is above the ratio of DC gains",
        AgainstOne::Undecided => "is not told apart from the ratio of DC gains",
    };
    Some(format!(
        "its {} is {} of that of {}, which {verdict}, {} (the one over the other: {})",
        heading_of(&cause.metric),
        short(&cause.ratio),
        cause.relative_to,
        short(&gain),
        short(&estimate),
    ))
}

/// What became of the rate itself, and of the noise once the scale factor is restored.
fn level(cause: &Cause) -> Option<String> {
    let ratio = companion(cause, &MEAN_RATIO)?;
    let restored = companion(cause, &ANGLE_RANDOM_WALK_OVER_DC_GAIN);
    let restored = restored.map_or_else(String::new, |metric| {
        format!(
            ", and at restored scale its ARW is {} {}",
            short(&metric.estimate),
            metric.unit
        )
    });
    let mean = short(&ratio.estimate);
    Some(format!("its mean is {mean} of raw's{restored}"))
}

/// What a channel does to noise while the table moves.
fn under_motion(cause: &Cause) -> Option<String> {
    let noise = companion(cause, &NOISE_GAIN)?;
    let verdict = match Finding::of_noise(noise.estimate).against_one {
        AgainstOne::Below => "lowers noise",
        AgainstOne::Equal => "leaves noise as it is",
        AgainstOne::Above => "raises noise",
        AgainstOne::Undecided => "does to noise what cannot be told",
    };
    let gain = cause.dc_gain.map_or_else(String::new, |gain| {
        format!(", {}", gains_beside(&gain, &cause.relative_to))
    });
    let power = short(&noise.estimate);
    Some(format!(
        "under this motion it {verdict}: {power} of raw's power{gain}"
    ))
}

/// How the DC gain compares with that of another channel, in words.
fn gains_beside(gain: &Estimate, other: &str) -> String {
    const ALIKE: f64 = 0.01;
    let is_alike = (gain.low - 1.0).abs() < ALIKE && (gain.high - 1.0).abs() < ALIKE;
    let ratio = short(gain);
    if is_alike {
        format!("with a DC gain like that of {other} (ratio {ratio})")
    } else {
        format!("with a DC gain {ratio} times that of {other}")
    }
}

fn assumption(assumed: &Assumed, width: usize) -> String {
    let values = match assumed.values[..] {
        [] => String::new(),
        _ => format!(" = {}", assumed.values.join(" or ")),
    };
    let mut text = format!("{INDENT}{}{values}\n", assumed.key);
    let table = assumed.table.as_ref();
    let table = table.map_or_else(String::new, |name| format!(" See table \"{name}\"."));
    let otherwise = match assumed.otherwise[..] {
        [] => String::new(),
        _ => format!(" Not so at {}.", assumed.otherwise.join(", ")),
    };
    let line = format!(
        "{}.{otherwise} Open because {}. Other readings: {}.{table}",
        assumed.statement, assumed.silence, assumed.alternatives
    );
    text.push_str(&wrapped(&line, DEEP, width));
    text
}
