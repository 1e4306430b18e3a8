//! Which columns are what: by name, part of a name or number; [`times`](super::times) says which are the time.

use super::cells::is_number;
use super::times::{COUNTERS, SHORT_TIMES, TIMES};
use super::{Asked, Layout, LayoutError};
use crate::recording::log::format::LogFormat;
use crate::recording::text::lines::{listed, shown};
use crate::recording::time::unit::TimeUnit;
use crate::recording::unit::spelling::Spelled;
use crate::wording::option_of;

/// Word that says that a file has no column of the time.
pub(super) const NO_TIME: &str = "none";

/// Key of the column of the data.
const COLUMN: &str = "column";
/// Key of the column of the time.
pub(super) const TIME: &str = "time";

/// What is read of a text.
#[derive(Clone, Debug)]
pub(in crate::recording) enum Selection<'a> {
    /// Those that a pattern names, in order; none: the only one beside the time.
    Named(&'a [String]),
    /// One of each.
    Each(Vec<Asked<'a>>),
}

/// The columns that are read.
#[derive(Clone, Debug, Default)]
pub(in crate::recording) struct Chosen {
    /// Those of the data, in the order in which they were asked for; those of reference and temperature behind them.
    pub(in crate::recording) data: Vec<usize>,
    /// Those whose sum is the time.
    pub(in crate::recording) time: Vec<(usize, TimeUnit)>,
    /// Whether the time was found rather than named.
    pub(in crate::recording) is_time_found: bool,
    /// What is worth saying of the unit of the time.
    pub(in crate::recording) time_note: Option<String>,
    /// What is said of a column that is the time by its heading and not by its cells, if no other was found.
    pub(in crate::recording) unread_time: Option<String>,
}

/// A layout with rows to look at.
pub(super) struct Chooser<'a> {
    pub(super) layout: &'a Layout,
    pub(super) format: &'a LogFormat,
    pub(super) rows: &'a [Vec<String>],
}

/// Chooses the columns to read.
///
/// * `rows`: some rows, as many as there are at hand.
/// * `needs_time`: whether the time is looked for at all.
///
/// # Errors
/// Unknown or ambiguous names, one column for two quantities, several that may be the time.
pub(in crate::recording) fn choose(
    layout: &Layout,
    format: &LogFormat,
    rows: &[Vec<String>],
    selection: &Selection<'_>,
    needs_time: bool,
) -> Result<Chosen, LayoutError> {
    let chooser = Chooser {
        layout,
        format,
        rows,
    };
    let mut named = chooser.named(selection)?;
    let mut chosen = Chosen::default();
    if needs_time {
        let data: Vec<usize> = named.iter().map(|(index, _)| *index).collect();
        chooser.put_time(&data, &mut chosen)?;
    }
    let beside: Vec<Asked<'_>> = match selection {
        Selection::Named(_) if needs_time => format.beside().collect(),
        _ => Vec::new(),
    };
    let beside = chooser.each(&beside)?;
    if named.is_empty() {
        named.push((chooser.only(&chosen, &beside)?, Some(COLUMN)));
    }
    named.extend(beside);
    let times = chosen.time.iter().map(|(index, _)| (*index, Some(TIME)));
    let times: Vec<ByKey> = times.collect();
    for (position, (index, key)) in named.iter().enumerate() {
        let mut others = times.iter().chain(&named[..position]);
        if let Some((_, other)) = others.find(|(other, _)| other == index) {
            return Err(LayoutError::NamedTwice {
                name: shown(&layout.name(*index).unwrap_or_default()),
                keys: [*other, *key],
            });
        }
    }
    chosen.data = named.into_iter().map(|(index, _)| index).collect();
    Ok(chosen)
}

/// A column, and the key or option that names it.
type ByKey = (usize, Option<&'static str>);

impl Chooser<'_> {
    /// The columns that are named, in order.
    fn named(&self, selection: &Selection<'_>) -> Result<Vec<ByKey>, LayoutError> {
        let mut named = Vec::new();
        match selection {
            Selection::Named(patterns) => {
                for pattern in *patterns {
                    let indices = self.matching(pattern)?.into_iter();
                    named.extend(indices.map(|index| (index, Some(COLUMN))));
                }
            }
            Selection::Each(all) => named = self.each(all)?,
        }
        Ok(named)
    }

    /// One column of each that is asked for.
    fn each(&self, all: &[Asked<'_>]) -> Result<Vec<ByKey>, LayoutError> {
        let found = all.iter().map(|asked| Ok((self.one(*asked)?, asked.key)));
        found.collect()
    }

    /// The columns that a name, a part of one, a number or a pattern with `*` names.
    fn matching(&self, pattern: &str) -> Result<Vec<usize>, LayoutError> {
        let asked = Asked::by(pattern, COLUMN);
        if !pattern.contains('*') || self.layout.names.iter().any(|name| name == pattern) {
            return Ok(vec![self.one(asked)?]);
        }
        let beside_time =
            |index: &usize| !self.layout.names.is_empty() || !self.is_time(*index, &TIMES);
        let width = 0..self.layout.width();
        let names = width.filter(|index| {
            let name = self.layout.name(*index).unwrap_or_default();
            fits(pattern, &name) && beside_time(index) && self.may_be_data(*index)
        });
        let names: Vec<usize> = names.collect();
        if names.is_empty() {
            return Err(self.unknown(asked));
        }
        Ok(names)
    }

    /// Whether a pattern for all letters means a column: not the time, not a column of words.
    fn may_be_data(&self, index: usize) -> bool {
        let is_named = |words: &[&str]| self.is_named(index, words);
        let is_clock = is_named(&TIMES) || is_named(&SHORT_TIMES) || is_named(&COUNTERS);
        let mut cells = self.cells(index);
        !is_clock && cells.all(|cell| is_number(cell, self.layout.decimal))
    }

    /// Index of the one column that a name, a part of one or a number from 1 names.
    pub(super) fn one(&self, asked: Asked<'_>) -> Result<usize, LayoutError> {
        let (wanted, names) = (asked.name, &self.layout.names);
        let found = |is: &dyn Fn(&str) -> bool| -> Vec<usize> {
            (0..names.len())
                .filter(|index| is(&names[*index]))
                .collect()
        };
        let same = found(&|name| name == wanted);
        match same[..] {
            [index] => return Ok(index),
            [_, _, ..] => {
                return Err(LayoutError::Ambiguous {
                    wanted: asked.into(),
                    count: same.len(),
                });
            }
            [] => {}
        }
        if let Ok(number) = wanted.parse::<usize>() {
            let known = (1..=self.layout.width()).contains(&number);
            return known.then(|| number - 1).ok_or_else(|| self.unknown(asked));
        }
        let small = wanted.trim().to_lowercase();
        let alike = found(&|name| name.trim().to_lowercase() == small);
        let alike = match alike[..] {
            [] => found(&|name| !small.is_empty() && name.to_lowercase().contains(&small)),
            _ => alike,
        };
        match alike[..] {
            [index] => Ok(index),
            [] => Err(self.unknown(asked)),
            _ => {
                let named: Vec<String> = alike.iter().map(|at| names[*at].clone()).collect();
                Err(LayoutError::AmbiguousPart {
                    wanted: asked.into(),
                    count: alike.len(),
                    listed: listed(&named),
                })
            }
        }
    }

    fn unknown(&self, asked: Asked<'_>) -> LayoutError {
        LayoutError::NoColumn {
            wanted: asked.into(),
            listed: self.listed(),
        }
    }

    fn listed(&self) -> String {
        let width = self.layout.width();
        if self.layout.names.is_empty() {
            return format!("expected a number from 1 to {width}, as there is no heading");
        }
        let names = listed(&self.layout.names);
        format!("expected one of {names}, or a number from 1 to {width}")
    }

    /// The column of the data where none was named: the only one beside the time, or the only one of these
    /// whose heading names a unit of a gyro.
    fn only(&self, chosen: &Chosen, beside: &[ByKey]) -> Result<usize, LayoutError> {
        let times = chosen.time.iter().map(|(index, _)| *index);
        let taken: Vec<usize> = times
            .chain(beside.iter().map(|(index, _)| *index))
            .collect();
        let others = (0..self.layout.width()).filter(|index| !taken.contains(index));
        let others: Vec<usize> = others.collect();
        if let [index] = others[..] {
            return Ok(index);
        }
        if others.is_empty() {
            let time = (!chosen.time.is_empty()).then(|| "the time".to_owned());
            let keys = beside.iter().filter_map(|(_, key)| *key);
            let beside = keys.map(|key| format!("that of {}", option_of(key)));
            let taken: Vec<String> = time.into_iter().chain(beside).collect();
            return Err(LayoutError::NoOther(taken.join(" and ")));
        }
        let turns = |index: &&usize| {
            let unit = self.layout.unit(**index);
            matches!(unit, Some(Spelled::Rate(_)))
        };
        if let [index] = others.iter().filter(turns).collect::<Vec<_>>()[..] {
            return Ok(*index);
        }
        let comma = self
            .layout
            .decimal_comma
            .as_deref()
            .map(|row| format!("; if `{}` is one number, say --decimal comma", shown(row)));
        let wrapped = match self.layout.names.is_empty() {
            true => "; if all of them are one quantity, --wrapped-columns 1 reads it row by row",
            false => "",
        };
        Err(LayoutError::SeveralColumns(
            self.listed() + &comma.unwrap_or_default() + wrapped,
        ))
    }
}

/// Whether a name fits a pattern in which `*` stands for any letters, in capitals or not.
fn fits(pattern: &str, name: &str) -> bool {
    let (pattern, name) = (pattern.to_lowercase(), name.to_lowercase());
    let parts: Vec<&str> = pattern.split('*').collect();
    let (Some((first, rest)), Some(last)) = (parts.split_first(), parts.last()) else {
        return false;
    };
    let Some(mut left) = name.strip_prefix(first) else {
        return false;
    };
    let Some((_, middle)) = rest.split_last() else {
        return left.is_empty();
    };
    for part in middle {
        match left.find(part) {
            Some(at) => left = &left[at + part.len()..],
            None => return false,
        }
    }
    left.ends_with(last)
}

#[cfg(test)]
mod tests {
    use super::fits;

    #[test]
    fn a_star_stands_for_any_letters() {
        for (pattern, name) in [
            ("*", "gx"),
            ("w_*", "w_x [rad/s]"),
            ("*y*", "gyro_y_raw"),
            ("g*z", "GYRO_Z"),
        ] {
            assert!(fits(pattern, name), "{pattern} {name}");
        }
        for (pattern, name) in [("w_*", "a_x"), ("g*z", "gyro_x"), ("a*a", "a")] {
            assert!(!fits(pattern, name), "{pattern} {name}");
        }
    }
}
