//! Ranges of a matrix: the values that `{ from = 100, to = 2000, count = 9, spacing = "log" }` stands
//! for.
//!
//! Both ends are values as they are written. What lies between is rounded to digits that can be read,
//! and never so far that two values meet.

use crate::declare::{Content, Presence};
use crate::scenario::config::{RangeConfig, Spacing};
use crate::scenario::document::address;
use crate::scenario::document::deserialize::from_table;
use crate::scenario::document::source::Mark;
use crate::scenario::document::tree::{Node, Table, Value};
use crate::scenario::keys::schema::{Key, Kind};
use crate::scenario::message::excerpt::excerpt;
use crate::vocabulary::Word;
use crate::wording::{exact, to_digits};

/// A range as messages show one.
pub(super) const EXAMPLE: &str = "{ from = 100, to = 2000, count = 9, spacing = \"log\" }";

/// Digits of a step that are kept, at least.
const DIGITS: i32 = 6;

/// Decimal places of the smallest binary64 and its digits.
const PLACES_MAX: i32 = 340;

/// Whole numbers that binary64 tells apart.
const WHOLE_MAX: i64 = 1 << 53;

/// What is wrong with a range, and where in it.
#[derive(Debug, thiserror::Error)]
#[error("{message}")]
pub(super) struct RangeError {
    message: String,
    /// The place inside the range; none for the range as a whole.
    pub(super) mark: Option<Mark>,
}

impl RangeError {
    fn of(written: &str, node: Option<&Node>, message: &str) -> Self {
        Self {
            message: format!("{written}: {message}"),
            mark: node.and_then(|node| node.mark),
        }
    }
}

/// Whether a table below a path of the matrix is a range: that of a key, or of what was meant as one.
pub(super) fn is_meant(root: &Table, path: &str, table: &Table) -> bool {
    let is_part = |(name, node): (&String, &Node)| {
        let is_scalar = !matches!(node.value, Value::Table(_) | Value::Array(_));
        is_scalar && RangeConfig::TABLE.rows.iter().any(|row| row.name == name)
    };
    table.iter().any(is_part) || matches!(address::resolve(root, path), Ok((_, Some(_))))
}

/// The values of a range of a key.
///
/// # Errors
/// What is wrong with it, pointing at the part that is.
pub(super) fn values(written: &str, key: &Key, table: &Table) -> Result<Vec<Node>, RangeError> {
    let config = read(written, key, table)?;
    let is_whole = matches!(key.kind, Kind::Integer(_));
    let refuse = |message: &str| RangeError::of(written, table.get("count"), message);
    let mut values = Vec::new();
    for index in 0..config.count {
        let value = value(&config, index);
        if !is_whole {
            values.push(value);
            continue;
        }
        if config.spacing == Spacing::Linear && value.fract() != 0.0 {
            return Err(refuse(&format!(
                "count = {} makes steps of {} from {} to {}: expected whole numbers, as {written} is \
                 one; choose a count whose steps are whole{}",
                config.count,
                exact(to_digits(
                    (config.to - config.from) / f64::from(config.count - 1),
                    6
                )),
                exact(config.from),
                exact(config.to),
                log_instead(&config),
            )));
        }
        values.push(value.round());
    }
    let rises = config.to > config.from;
    let meets = |pair: &[f64]| {
        if rises {
            pair[1] <= pair[0]
        } else {
            pair[1] >= pair[0]
        }
    };
    if let Some(pair) = values.windows(2).find(|pair| meets(pair)) {
        return Err(refuse(&format!(
            "count = {} is more than there are values from {} to {}: {} would stand twice",
            config.count,
            exact(config.from),
            exact(config.to),
            exact(pair[1]),
        )));
    }
    let node = |value: f64| Node {
        value: if is_whole {
            Value::Integer(whole(value))
        } else {
            Value::Float(value)
        },
        mark: None,
    };
    Ok(values.into_iter().map(node).collect())
}

/// What else could be meant by steps that are not whole.
fn log_instead(config: &RangeConfig) -> &'static str {
    if config.from > 0.0 && config.to > 0.0 {
        ", or spacing = \"log\", which rounds"
    } else {
        ""
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "ends are at most 2^53 in size, and nothing lies outside them"
)]
fn whole(value: f64) -> i64 {
    value as i64
}

/// Value number `index`, from 0.
fn value(config: &RangeConfig, index: u32) -> f64 {
    let RangeConfig {
        from,
        to,
        count,
        spacing,
    } = *config;
    let last = count - 1;
    if index == 0 || index == last {
        return if index == 0 { from } else { to };
    }
    let part = f64::from(index) / f64::from(last);
    match spacing {
        Spacing::Linear => {
            let step = (to - from) / f64::from(last);
            // The digit of the step that is the last kept; far above 1 all digits before the point are.
            let places = (DIGITS - 1).saturating_sub(exponent(step));
            let places = usize::try_from(places.min(PLACES_MAX)).unwrap_or(0);
            let text = format!("{:.places$}", from + (to - from) * part);
            // No value is -0.
            text.parse().unwrap_or(from) + 0.0
        }
        Spacing::Log => {
            let ratio = (to.ln() - from.ln()) / f64::from(last);
            // Ratios close to 1 need as many digits more as their distance from 1 is small.
            let more = (-1_i32).saturating_sub(exponent(ratio)).clamp(0, 17);
            let digits = usize::try_from((DIGITS + more).min(17)).unwrap_or(17);
            to_digits((from.ln() + (to.ln() - from.ln()) * part).exp(), digits)
        }
    }
}

/// Power of ten of the first digit.
#[expect(
    clippy::cast_possible_truncation,
    reason = "exponents of binary64 are small"
)]
fn exponent(value: f64) -> i32 {
    value.abs().log10().floor() as i32
}

/// The parts of a range, checked.
fn read(written: &str, key: &Key, table: &Table) -> Result<RangeConfig, RangeError> {
    let refuse = |name: &str, message: &str| RangeError::of(written, table.get(name), message);
    if !matches!(key.kind, Kind::Float(_) | Kind::Integer(_)) {
        let allowed = key.allowed();
        let message =
            format!("only numbers have ranges: expected an array of values, each {allowed}");
        return Err(refuse("", &message));
    }
    let parts = complete(written, table)?;
    for name in ["from", "to"] {
        if !is_end(key, &parts[name].value) {
            let got = parts[name].value.to_toml();
            let message = format!("{name} = {}: expected {}", excerpt(&got), key.expected());
            return Err(refuse(name, &message));
        }
    }
    let count = RangeConfig::TABLE
        .rows
        .iter()
        .find(|row| row.name == "count");
    if let Some(Content::Value(Kind::Integer(range))) = count.map(|row| row.content)
        && !matches!(parts["count"].value, Value::Integer(count) if range.contains(count))
    {
        let got = parts["count"].value.to_toml();
        let message = format!(
            "count = {}: expected a whole number, {range}",
            excerpt(&got)
        );
        return Err(refuse("count", &message));
    }
    let spacing = &parts["spacing"];
    if !spacing
        .as_text()
        .is_some_and(|word| Spacing::WORDS.contains(&word))
    {
        let got = spacing.value.to_toml();
        let words = Spacing::WORDS.join("\", \"");
        let message = format!("spacing = {}: expected one of \"{words}\"", excerpt(&got));
        return Err(refuse("spacing", &message));
    }
    let config: RangeConfig = from_table(&parts).map_err(|error| refuse("", &error.to_string()))?;
    for (name, end) in [("from", config.from), ("to", config.to)] {
        if config.spacing == Spacing::Log && end <= 0.0 {
            let message = format!(
                "{name} = {}: expected a value above 0, as spacing = \"log\" makes equal ratios",
                exact(end)
            );
            return Err(refuse(name, &message));
        }
    }
    if config.to - config.from == 0.0 {
        let message = format!(
            "to = {} is what from is: expected another value, or an array of one",
            exact(config.to)
        );
        return Err(refuse("to", &message));
    }
    Ok(config)
}

/// The parts of a range with defaults for those that are not given.
fn complete(written: &str, table: &Table) -> Result<Table, RangeError> {
    let rows = || RangeConfig::TABLE.rows.iter();
    for (name, node) in table {
        if !rows().any(|row| row.name == name) {
            let names: Vec<&str> = rows().map(|row| row.name).collect();
            let (unknown, names) = (excerpt(name), names.join(", "));
            let message = format!("unknown key {unknown} of a range: expected {names}");
            return Err(RangeError::of(written, Some(node), &message));
        }
    }
    let mut parts = table.clone();
    for row in rows().filter(|row| !table.contains_key(row.name)) {
        if row.presence == Presence::Required {
            let message = format!("the range lacks {}: expected one as {EXAMPLE}", row.name);
            return Err(RangeError::of(written, None, &message));
        }
        let value = Value::Text(row.literal.trim_matches('"').to_owned());
        parts.insert(row.name.to_owned(), Node { value, mark: None });
    }
    Ok(parts)
}

/// Whether a value may be an end of a range of a key.
fn is_end(key: &Key, value: &Value) -> bool {
    match (key.kind, value) {
        (Kind::Float(range), Value::Float(value)) => range.contains(*value),
        #[expect(
            clippy::cast_precision_loss,
            reason = "as a whole number is for the key itself"
        )]
        (Kind::Float(range), Value::Integer(value)) => range.contains(*value as f64),
        (Kind::Integer(range), Value::Integer(value)) => {
            range.contains(*value) && value.abs() <= WHOLE_MAX
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(from: f64, to: f64, count: u32, spacing: Spacing) -> Vec<f64> {
        let config = RangeConfig {
            from,
            to,
            count,
            spacing,
        };
        (0..count).map(|index| value(&config, index)).collect()
    }

    #[test]
    fn values_between_the_ends_have_digits_that_can_be_read() {
        use Spacing::{Linear, Log};
        assert_eq!(range(0.0, 1.0, 4, Linear), [0.0, 0.333333, 0.666667, 1.0]);
        assert_eq!(range(1.0, -1.0, 3, Linear), [1.0, 0.0, -1.0]);
        assert!(range(1.0, -1.0, 3, Linear)[1].is_sign_positive());
        assert_eq!(range(0.1, 0.7, 3, Linear), [0.1, 0.4, 0.7]);
        assert_eq!(range(1.0, 1000.0, 4, Log), [1.0, 10.0, 100.0, 1000.0]);
        assert_eq!(range(100.0, 2000.0, 3, Log), [100.0, 447.214, 2000.0]);
        assert_eq!(range(1e-9, 4e-9, 3, Linear), [1e-9, 2.5e-9, 4e-9]);
        assert_eq!(range(0.0, 1e6, 4, Linear), [0.0, 333_333.0, 666_667.0, 1e6]);
    }

    #[test]
    fn values_differ_however_close_they_are() {
        // Steps below the smallest number are no steps, and no panic.
        for spacing in [Spacing::Linear, Spacing::Log] {
            assert_eq!(range(5e-324, 1e-323, 3, spacing).len(), 3);
        }
        for (from, to) in [(1.0, 1.001), (2000.0, 1999.5), (1e-12, 1e12)] {
            for spacing in [Spacing::Linear, Spacing::Log] {
                let values = range(from, to, 10_000, spacing);
                let is_sorted = values
                    .windows(2)
                    .all(|two| (two[1] > two[0]) == (to > from));
                assert!(
                    is_sorted && (values[0], values[9999]) == (from, to),
                    "{from} {to}"
                );
            }
        }
    }
}
