//! The noise budget of a gyro as text, JSON and CSV.

use std::fmt::Write as _;

use serde_json::{Map, Value};

use crate::gate::{plain, three_digits};
use crate::report::layout::json::{number, numbers, object, pretty, put};
use crate::report::layout::text::{Grid, wrapped};
use crate::scenario::AssumedValue;
use crate::signal::{BudgetPoint, BudgetSheet};

/// Name of the sum of all sources.
pub(crate) const TOTAL: &str = "total";
/// Every how many points of its curve the text has a row.
const DEPTHS_PER_ROW: usize = 15;
const POWERS_PER_ROW: usize = 5;

/// What stands in the place of which sources, if the walk of a data sheet does.
pub(in crate::report) fn replacement(replaced: &[&str]) -> Option<String> {
    let (last, others) = replaced.split_last()?;
    Some(format!(
        "equivalent: one white source of the data sheet's walk (gyro.noise.angle_random_walk_deg_per_sqrt_h) \
         in the place of {} and {last}",
        others.join(", ")
    ))
}

/// The budget for people.
#[must_use]
pub fn budget_text(file: &str, sheet: &BudgetSheet) -> String {
    let configured = &sheet.configured;
    let mut text = format!(
        "{file}  {} uW at {} deg of modulation: angle random walk in closed form, deg/sqrt(h)\n\n",
        plain(configured.power_uw),
        plain(configured.modulation_depth_deg),
    );
    text.push_str(&entries(sheet));
    if let Some(said) = replacement(&sheet.replaced_sources) {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  {said}");
    }
    text.push('\n');
    text.push_str(&optimum(sheet));
    let depth = |point: &BudgetPoint| point.modulation_depth_deg;
    text.push_str("\nagainst modulation depth at the configured power\n");
    let gap = gap(sheet);
    text.push_str(&curve(&sheet.by_depth, ("deg", gap), depth, DEPTHS_PER_ROW));
    text.push_str(&largest(&sheet.by_depth, "deg", depth));
    let power = |point: &BudgetPoint| point.power_uw;
    text.push_str("\nagainst power at the configured depth\n");
    text.push_str(&curve(&sheet.by_power, ("uW", gap), power, POWERS_PER_ROW));
    text.push_str(&largest(&sheet.by_power, "uW", power));
    for caution in &sheet.cautions {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "\nnote: {caution}");
    }
    text
}

/// What nobody set, on which a budget rests; nothing if all was set.
#[must_use]
pub fn budget_assumed_text(assumed: &[AssumedValue], width: usize) -> String {
    if assumed.is_empty() {
        return String::new();
    }
    let shown: Vec<String> = assumed.iter().map(AssumedValue::shown).collect();
    let text = format!("assumed, as nobody set it: {}", shown.join(", "));
    format!("\n{}", wrapped(&text, "", width))
}

/// A table by source at the configured point.
fn entries(sheet: &BudgetSheet) -> String {
    let mut grid = Grid::default();
    grid.row(
        [
            "source",
            "deg/sqrt(h)",
            "share %",
            "as phase noise, urad/sqrt(Hz)",
        ]
        .map(str::to_owned),
    );
    for entry in &sheet.entries {
        grid.row([
            entry.source.to_owned(),
            walk_text(Some(entry.angle_random_walk_deg_per_sqrt_h)),
            format!("{:.1}", 100.0 * entry.power_share),
            format!("{:.3}", entry.phase_noise_urad_per_sqrt_hz),
        ]);
    }
    grid.lines("  ")
}

fn optimum(sheet: &BudgetSheet) -> String {
    if !sheet.replaced_sources.is_empty() {
        return "the walk is that of the data sheet at every modulation depth and power\n"
            .to_owned();
    }
    let Some(closed_form) = sheet.closed_form_optimum_depth_deg else {
        return "no source depends on the modulation depth\n".to_owned();
    };
    let Some(point) = &sheet.optimum else {
        return "no modulation depth keeps the bias point within the converter's range\n"
            .to_owned();
    };
    let is_cut_off = (point.modulation_depth_deg - closed_form).abs() > 0.01;
    let remark = if is_cut_off {
        ", where the converter's range ends"
    } else {
        ""
    };
    format!(
        "least at {:.2} deg{remark} (closed form {closed_form:.2} deg): {} deg/sqrt(h) at this power\n",
        point.modulation_depth_deg,
        walk_text(point.walk(TOTAL)),
    )
}

/// Where a budget has no point.
fn gap(sheet: &BudgetSheet) -> &'static str {
    if sheet.replaced_sources.is_empty() {
        "the bias point lies beyond the converter's range"
    } else {
        "rounding takes most of the walk, or the bias point lies beyond the converter's range"
    }
}

/// Every so many points of a curve as a table.
fn curve(
    points: &[BudgetPoint],
    (unit, gap): (&str, &str),
    abscissa: impl Fn(&BudgetPoint) -> f64,
    step: usize,
) -> String {
    let names = sources(points);
    let mut grid = Grid::default();
    let titles = names.iter().map(|name| (*name).to_owned());
    grid.row(std::iter::once(unit.to_owned()).chain(titles));
    for point in points.iter().step_by(step) {
        let walks = names.iter().map(|name| walk_text(point.walk(name)));
        grid.row(std::iter::once(three_digits(abscissa(point))).chain(walks));
    }
    let mut text = grid.lines("  ");
    let beyond = |point: &BudgetPoint| point.angle_random_walk_deg_per_sqrt_h.is_none();
    if points.iter().any(beyond) {
        text.push_str(&format!("  -: {gap}\n"));
    }
    text
}

/// Which source is the largest where along a curve.
fn largest(points: &[BudgetPoint], unit: &str, abscissa: impl Fn(&BudgetPoint) -> f64) -> String {
    let parts: Vec<String> = points
        .chunk_by(|a, b| dominant(a) == dominant(b))
        .filter_map(|run| {
            let source = dominant(&run[0])?;
            let (first, last) = (abscissa(&run[0]), abscissa(&run[run.len() - 1]));
            Some(format!(
                "{source} from {} to {} {unit}",
                three_digits(first),
                three_digits(last)
            ))
        })
        .collect();
    if parts.is_empty() {
        return String::new();
    }
    format!("  largest: {}\n", parts.join(", "))
}

/// The largest source of a point, if there is noise at all.
fn dominant(point: &BudgetPoint) -> Option<&'static str> {
    let walks = point.angle_random_walk_deg_per_sqrt_h.as_ref()?;
    walks
        .iter()
        .filter(|(name, walk)| *name != TOTAL && *walk > 0.0)
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(name, _)| *name)
}

/// Names along a curve, `total` last.
pub(crate) fn sources(points: &[BudgetPoint]) -> Vec<&'static str> {
    points
        .iter()
        .find_map(|point| point.angle_random_walk_deg_per_sqrt_h.as_ref())
        .map(|walks| walks.iter().map(|(name, _)| *name).collect())
        .unwrap_or_default()
}

/// A walk to three significant digits, trailing zeros kept, so that columns compare; a source that
/// is off has none, a point out of range `-`.
fn walk_text(walk: Option<f64>) -> String {
    let Some(walk) = walk else {
        return "-".to_owned();
    };
    if walk <= 0.0 {
        return "0".to_owned();
    }
    let scientific = format!("{walk:.2e}");
    let exponent = scientific.split_once('e').map(|(_, exponent)| exponent);
    match exponent.and_then(|exponent| exponent.parse::<i32>().ok()) {
        Some(exponent) if (-5..3).contains(&exponent) => {
            let decimals = usize::try_from(2 - exponent).unwrap_or(0);
            format!("{walk:.decimals$}")
        }
        _ => scientific,
    }
}

/// The budget as JSON, all curves as arrays; a point out of the converter's range is `null`.
#[must_use]
pub fn budget_json(file: &str, sheet: &BudgetSheet) -> String {
    let mut document = object([("schema", 1.into()), ("file", file.into())]);
    put(&mut document, "power_uw", sheet.configured.power_uw);
    let depth_deg = sheet.configured.modulation_depth_deg;
    put(&mut document, "modulation_depth_deg", depth_deg);
    document.insert("sources".to_owned(), entries_json(sheet));
    if !sheet.replaced_sources.is_empty() {
        let replaced = sheet.replaced_sources.clone();
        document.insert("replaced_sources".to_owned(), replaced.into());
    }
    document.extend(object([
        ("optimum", optimum_json(sheet)),
        ("by_depth", curve_json(&sheet.by_depth)),
        ("by_power", curve_json(&sheet.by_power)),
        (
            "by_power_at_optimum_depth",
            curve_json(&sheet.by_power_at_optimum_depth),
        ),
        ("cautions", sheet.cautions.clone().into()),
    ]));
    pretty(&document.into())
}

fn entries_json(sheet: &BudgetSheet) -> Value {
    let row = |entry: &crate::signal::BudgetEntry| {
        let row = numbers([
            (
                "angle_random_walk_deg_per_sqrt_h",
                entry.angle_random_walk_deg_per_sqrt_h,
            ),
            ("power_share", entry.power_share),
            (
                "phase_noise_urad_per_sqrt_hz",
                entry.phase_noise_urad_per_sqrt_hz,
            ),
        ]);
        (entry.source.to_owned(), Value::Object(row))
    };
    Value::Object(sheet.entries.iter().map(row).collect())
}

fn optimum_json(sheet: &BudgetSheet) -> Value {
    let closed_form = sheet.closed_form_optimum_depth_deg;
    let (Some(point), Some(closed_form)) = (&sheet.optimum, closed_form) else {
        return Value::Null;
    };
    let mut record = numbers([
        ("modulation_depth_deg", point.modulation_depth_deg),
        ("closed_form_modulation_depth_deg", closed_form),
    ]);
    let walk = point_json(point.walk(TOTAL));
    record.insert("angle_random_walk_deg_per_sqrt_h".to_owned(), walk);
    record.into()
}

/// A number of a curve whose points keep their places; `null` where there is none.
fn point_json(value: Option<f64>) -> Value {
    value.and_then(number).unwrap_or(Value::Null)
}

fn curve_json(points: &[BudgetPoint]) -> Value {
    let column = |read: &dyn Fn(&BudgetPoint) -> Option<f64>| {
        Value::Array(points.iter().map(|point| point_json(read(point))).collect())
    };
    let walks: Map<String, Value> = sources(points)
        .into_iter()
        .map(|name| (name.to_owned(), column(&|point| point.walk(name))))
        .collect();
    Value::Object(object([
        ("power_uw", column(&|point| Some(point.power_uw))),
        (
            "modulation_depth_deg",
            column(&|point| Some(point.modulation_depth_deg)),
        ),
        ("angle_random_walk_deg_per_sqrt_h", Value::Object(walks)),
    ]))
}

/// The curves as CSV: which one, its point, and the walk of each source, deg/sqrt(h); empty where
/// the bias point lies beyond the converter's range.
#[must_use]
pub(in crate::report) fn budget_csv(sheet: &BudgetSheet) -> String {
    let names = sources(&sheet.by_depth);
    let mut text = String::from("curve,power_uw,modulation_depth_deg");
    for name in &names {
        // Writing to a string cannot fail.
        let _ = write!(text, ",{name}_deg_per_sqrt_h");
    }
    text.push('\n');
    for (curve, points) in [
        ("by_depth", &sheet.by_depth),
        ("by_power", &sheet.by_power),
        (
            "by_power_at_optimum_depth",
            &sheet.by_power_at_optimum_depth,
        ),
    ] {
        for point in points {
            let (power, depth) = (point.power_uw, point.modulation_depth_deg);
            let _ = write!(text, "{curve},{power:?},{depth:?}");
            for name in &names {
                let walk = point.walk(name).map(|walk| format!("{walk:?}"));
                let _ = write!(text, ",{}", walk.unwrap_or_default());
            }
            text.push('\n');
        }
    }
    text
}
