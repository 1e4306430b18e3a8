//! Values of a key: the ends of its range and their neighbours, and everything between.

use super::schema::{Kind, Leaf, Range};
use crate::support::seeded::Draws;

/// What values are drawn for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Setting {
    /// Length of the record, s: most times are drawn to fit into it.
    pub(crate) duration_s: f64,
    /// Probability of a value at or near an end of the range.
    pub(crate) extreme: f64,
    /// Length of the arrays of one table.
    pub(crate) count: usize,
}

/// Share of the values between the ends that are drawn as an experimenter would choose them.
const USUAL: f64 = 0.7;

/// A value as TOML; `None` if the schema alone does not say what may stand there.
pub(crate) fn value(draws: &mut Draws, leaf: &Leaf, setting: Setting) -> Option<String> {
    Some(match &leaf.kind {
        Kind::Number(range) => toml(number(draws, leaf, *range, setting)),
        Kind::Integer { min, max, step } => {
            integer(draws, leaf.default, (*min, *max, *step), setting).to_string()
        }
        Kind::Boolean => draws.chance(0.5).to_string(),
        Kind::Words(words) => quoted(draws.pick::<String>(words)),
        Kind::Numbers(range, count) => {
            let count = count.unwrap_or(setting.count);
            numbers(draws, leaf, *range, count, setting)
        }
        Kind::WordArray(words) if !words.is_empty() => word_array(draws, words, setting.count),
        Kind::EmptyTable => "{}".to_owned(),
        Kind::Text | Kind::WordArray(_) | Kind::Other => return None,
    })
}

/// Length of an array: one number, a few, now and then many.
pub(crate) fn length(draws: &mut Draws) -> usize {
    match draws.below(20) {
        0..4 => 1,
        19 => 1 + draws.below(64),
        _ => 2 + draws.below(8),
    }
}

/// An array of words.
pub(crate) fn word_array(draws: &mut Draws, words: &[String], count: usize) -> String {
    let chosen: Vec<String> = (0..count)
        .map(|_| quoted(draws.pick::<String>(words)))
        .collect();
    format!("[{}]", chosen.join(", "))
}

/// An array of numbers: ascending times from 0 to the end, ascending frequencies, anything else.
pub(crate) fn numbers(
    draws: &mut Draws,
    leaf: &Leaf,
    range: Range,
    count: usize,
    setting: Setting,
) -> String {
    let unit = leaf.unit.as_deref();
    let spread = unit == Some("s") && draws.chance(0.8);
    let values = (0..count).map(|_| {
        if spread {
            within(draws.unit() * setting.duration_s, range)
        } else {
            number(draws, leaf, range, setting)
        }
    });
    let mut values: Vec<f64> = values.collect();
    if matches!(unit, Some("s" | "Hz")) && draws.chance(0.9) {
        values.sort_by(f64::total_cmp);
    }
    if unit == Some("s") && draws.chance(0.9) {
        values[0] = range.low.max(0.0);
        values[count - 1] = values[count - 1].max(setting.duration_s);
    }
    let values: Vec<String> = values.into_iter().map(toml).collect();
    format!("[{}]", values.join(", "))
}

fn number(draws: &mut Draws, leaf: &Leaf, range: Range, setting: Setting) -> f64 {
    let value = if draws.chance(setting.extreme) {
        extreme(draws, range)
    } else if setting.extreme <= 0.0 || draws.chance(USUAL) {
        usual(draws, leaf, range, setting)
    } else {
        between(draws, range)
    };
    within(value, range)
}

/// An end of the range, a neighbour of one, nothing, or the least there is.
fn extreme(draws: &mut Draws, range: Range) -> f64 {
    let least = if range.low > 0.0 {
        range.low
    } else {
        f64::from_bits(1)
    };
    match draws.below(8) {
        0 | 1 => range.low,
        2 => range.low.next_up(),
        3 | 4 => range.high,
        5 => range.high.next_down(),
        6 => least,
        _ => 0.0,
    }
}

/// A value near the default, or one that suits a record of this length.
fn usual(draws: &mut Draws, leaf: &Leaf, range: Range, setting: Setting) -> f64 {
    match (leaf.unit.as_deref(), leaf.default) {
        (Some("s"), _) if range.low == 0.0 && !range.is_low_open && draws.chance(0.2) => 0.0,
        (Some("s"), _) => draws.log_uniform(setting.duration_s * 3e-3, setting.duration_s),
        (Some("Hz"), None) => {
            // A record holds three cycles of the lowest of several sines.
            let lowest = (3.5 / setting.duration_s).min(400.0);
            draws.log_uniform(lowest, 450.0)
        }
        (_, Some(default)) if default != 0.0 => default * draws.log_uniform(0.1, 10.0),
        _ => {
            let size = range.high.abs().min(1e9);
            let value = draws.log_uniform(size * 1e-4, size);
            if range.low < 0.0 && draws.chance(0.5) {
                -value
            } else {
                value
            }
        }
    }
}

/// Anything between the ends, by order of magnitude.
fn between(draws: &mut Draws, range: Range) -> f64 {
    let high = range.high.max(range.low.abs());
    let low = if range.low > 0.0 {
        range.low
    } else {
        // Every order of magnitude is worth a try; below these nothing moves any more.
        (high * 1e-18).max(1e-300)
    };
    let value = draws.log_uniform(low, high);
    if range.low < 0.0 && draws.chance(0.5) {
        -value
    } else {
        value
    }
}

fn within(value: f64, range: Range) -> f64 {
    let low = if range.is_low_open {
        range.low.next_up()
    } else {
        range.low
    };
    value.clamp(low, range.high)
}

fn integer(
    draws: &mut Draws,
    default: Option<f64>,
    (min, max, step): (i64, i64, i64),
    setting: Setting,
) -> i64 {
    let value = if draws.chance(setting.extreme) {
        *draws.pick(&[min, min, min.saturating_add(step), max, max, max - step])
    } else {
        let near = default.unwrap_or(1.0).max(1.0) * draws.log_uniform(0.2, 8.0);
        let low = (min.max(1)) as f64;
        let anywhere = draws.log_uniform(low, (max.max(1)) as f64);
        truncated(if draws.chance(0.8) { near } else { anywhere })
    };
    let steps = value.clamp(min, max) / step;
    (steps * step).clamp(min, max)
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "it saturates at the ends, where the range of the key cuts it anyway"
)]
fn truncated(value: f64) -> i64 {
    value as i64
}

/// A number as TOML writes it.
pub(crate) fn toml(value: f64) -> String {
    format!("{value:?}")
}

/// A text as TOML writes it on one line; the escapes of JSON are among those of TOML.
pub(crate) fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}
