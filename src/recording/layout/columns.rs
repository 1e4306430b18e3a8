//! Which column is what: by name, part of a name or number, and the time by what its heading says.

use super::cells::is_number;
use super::{Asked, Layout, LayoutError};
use crate::recording::log::format::LogFormat;
use crate::recording::text::lines::{listed, shown};
use crate::recording::time::stamp::{Stamp, is_date};
use crate::recording::time::unit::TimeUnit;
use crate::recording::unit::spelling::{Spelled, name_of_heading};

/// Word that says that a file has no column of the time.
pub(super) const NO_TIME: &str = "none";

/// Key of the column of the data.
const COLUMN: &str = "column";
/// Key of the column of the time.
const TIME: &str = "time";

/// Words in the heading of a column of time.
const TIMES: [&str; 16] = [
    "time",
    "timestamp",
    "timestamps",
    "stamp",
    "stamps",
    "utc",
    "gps",
    "tow",
    "sow",
    "epoch",
    "datetime",
    "date",
    "unixtime",
    "gpstime",
    "clock",
    "elapsed",
];
/// Whole headings of such a column.
const SHORT_TIMES: [&str; 4] = ["t", "ts", "secs", "sec"];
/// Words in the heading of a counter of samples.
const COUNTERS: [&str; 15] = [
    "counter",
    "packetcounter",
    "count",
    "cnt",
    "packet",
    "index",
    "idx",
    "sample",
    "samples",
    "seq",
    "sequence",
    "frame",
    "no",
    "nr",
    "number",
];
/// Words in the heading of the week that stands beside the seconds of it.
const WEEKS: [&str; 3] = ["week", "weeks", "wn"];

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
}

/// A layout with rows to look at.
struct Chooser<'a> {
    layout: &'a Layout,
    format: &'a LogFormat,
    rows: &'a [Vec<String>],
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
        let asked = Asked {
            name: pattern,
            key: Some(COLUMN),
        };
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
    fn one(&self, asked: Asked<'_>) -> Result<usize, LayoutError> {
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
            let beside = keys.map(|key| format!("that of --{}", key.replace('_', "-")));
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

    /// Enters the columns of the time: those that are named, else those whose heading says so.
    fn put_time(&self, data: &[usize], chosen: &mut Chosen) -> Result<(), LayoutError> {
        let found: Vec<usize> = match self.format.time.as_deref() {
            Some([none]) if none == NO_TIME => return Ok(()),
            Some(names) => names
                .iter()
                .map(|name| {
                    let key = Some(TIME);
                    self.one(Asked { name, key })
                })
                .collect::<Result<_, _>>()?,
            None => {
                chosen.is_time_found = true;
                self.found_times(data)?
            }
        };
        let given = self.format.time_unit.as_deref();
        if let Some(given) = given
            && !found.is_empty()
            && given.len() != found.len()
        {
            return Err(LayoutError::TimeUnits {
                units: given.len(),
                columns: found.len(),
            });
        }
        let mut notes = Vec::new();
        for (position, index) in found.into_iter().enumerate() {
            let given = given.map(|units| units[position]);
            let unit = self.time_unit(index, given, &mut notes);
            chosen.time.push((index, unit));
        }
        chosen.time_note = notes.pop();
        Ok(())
    }

    /// Unit of a column of time: that which was given, that of its heading, that of its first cell.
    fn time_unit(
        &self,
        index: usize,
        given: Option<TimeUnit>,
        notes: &mut Vec<String>,
    ) -> TimeUnit {
        let name = self.layout.name(index).unwrap_or_default();
        let in_heading = match self.layout.unit(index) {
            Some(Spelled::Time(unit)) => Some(unit),
            _ => None,
        };
        if let Some(unit) = given.or(in_heading) {
            return unit;
        }
        let first = self.cells(index).next().unwrap_or_default();
        if is_date(first) && !is_number(first, self.layout.decimal) {
            return TimeUnit::Iso;
        }
        if self.is_named(index, &WEEKS) {
            return TimeUnit::Weeks;
        }
        if self.is_named(index, &COUNTERS) && !self.is_named(index, &TIMES) {
            return TimeUnit::Samples;
        }
        // Whole seconds since 1970 have ten digits, of smaller units three more each.
        if first.contains(['.', ',', 'e', 'E']) {
            return TimeUnit::Seconds;
        }
        let unit = match first.bytes().filter(u8::is_ascii_digit).count() {
            13 => TimeUnit::Milliseconds,
            16 => TimeUnit::Microseconds,
            19 => TimeUnit::Nanoseconds,
            _ => return TimeUnit::Seconds,
        };
        notes.push(format!(
            "the stamps of column {} are taken for {unit} since 1970 by their digits: --time-unit says \
             otherwise",
            shown(&name)
        ));
        unit
    }

    /// Columns that are the time by their heading or their cells, a counter of samples where there is none
    /// and the rate is given.
    fn found_times(&self, data: &[usize]) -> Result<Vec<usize>, LayoutError> {
        let free = |index: &usize| !data.contains(index);
        let all: Vec<usize> = (0..self.layout.width()).filter(free).collect();
        let of = |words: &[&str]| -> Vec<usize> {
            let named = all.iter().copied();
            named.filter(|index| self.is_time(*index, words)).collect()
        };
        let dates: Vec<usize> = all
            .iter()
            .copied()
            .filter(|it| self.holds_dates(*it))
            .collect();
        let mut named = of(&TIMES);
        named.extend(
            dates
                .iter()
                .filter(|index| !named.contains(index))
                .copied()
                .collect::<Vec<_>>(),
        );
        if named.is_empty() {
            named = all
                .iter()
                .copied()
                .filter(|it| self.is_short_time(*it))
                .collect();
        }
        if named.len() == 2 && self.are_date_and_time(named[0], named[1]) {
            return Ok(named);
        }
        if let [seconds] = named[..]
            && let Some(week) = all.iter().find(|it| self.is_named(**it, &WEEKS))
        {
            return Ok(vec![*week, seconds]);
        }
        match named[..] {
            [] if self.format.rate_hz.is_some() => {
                let counters = all.iter().copied().filter(|it| self.counts(*it));
                Ok(counters.take(1).collect())
            }
            [] | [_] => Ok(named),
            // A rate is known: the first of them is looked at, and named in the layout.
            [first, ..] if self.format.rate_hz.is_some() => Ok(vec![first]),
            _ => {
                let names = named.iter().filter_map(|index| self.layout.name(*index));
                Err(LayoutError::SeveralTimes(listed(
                    &names.collect::<Vec<_>>(),
                )))
            }
        }
    }

    /// Whether a heading has one of some words.
    fn is_named(&self, index: usize, words: &[&str]) -> bool {
        let Some(heading) = self.layout.names.get(index) else {
            return false;
        };
        let name = name_of_heading(heading);
        let mut parts = name.split(|letter: char| !letter.is_alphanumeric());
        parts.any(|part| words.contains(&part))
    }

    /// Whether a column whose heading has one of some words rises as a time does.
    fn is_time(&self, index: usize, words: &[&str]) -> bool {
        self.is_named(index, words) && self.rises(index)
    }

    /// Whether a heading is a short name of the time, or a unit of time alone, above stamps that rise.
    fn is_short_time(&self, index: usize) -> bool {
        let Some(heading) = self.layout.names.get(index) else {
            return false;
        };
        let name = name_of_heading(heading);
        let is_short = SHORT_TIMES.contains(&name.as_str())
            || (matches!(self.layout.unit(index), Some(Spelled::Time(_)))
                && !heading.contains('_'))
            || SHORT_TIMES.iter().any(|short| {
                name.strip_prefix(short).is_some_and(|rest| {
                    rest.strip_prefix('_')
                        .is_some_and(|unit| TimeUnit::spelled(unit).is_some())
                })
            });
        is_short && self.rises(index)
    }

    fn cells(&self, index: usize) -> impl Iterator<Item = &str> {
        let rows = self.rows.iter();
        rows.filter_map(move |row| row.get(index).map(String::as_str))
    }

    fn holds_dates(&self, index: usize) -> bool {
        let mut cells = self.cells(index);
        cells.next().is_some_and(is_date) && cells.all(is_date)
    }

    /// Whether one column holds dates and the other times of day.
    fn are_date_and_time(&self, one: usize, other: usize) -> bool {
        let is_day = |index| {
            self.cells(index)
                .all(|cell| is_date(cell) && !cell.contains(':'))
        };
        self.holds_dates(one) && self.holds_dates(other) && is_day(one) != is_day(other)
    }

    /// Whether the cells are stamps that fall back once at most.
    fn rises(&self, index: usize) -> bool {
        let unit = if self.holds_dates(index) {
            TimeUnit::Iso
        } else {
            TimeUnit::Seconds
        };
        let stamps = self.cells(index).map(|cell| {
            let stamp = Stamp::read(cell, unit, self.layout.decimal);
            stamp.ok().map(|stamp| stamp.ticks)
        });
        let Some(stamps) = stamps.collect::<Option<Vec<i128>>>() else {
            return false;
        };
        let falls = stamps.windows(2).filter(|two| two[1] < two[0]).count();
        let rises = stamps.windows(2).any(|two| two[1] > two[0]);
        falls <= 1 && (rises || stamps.len() < 2)
    }

    /// Whether a column counts samples: whole numbers of which most step by the same.
    fn counts(&self, index: usize) -> bool {
        if !self.is_named(index, &COUNTERS) {
            return false;
        }
        let numbers = self.cells(index).map(|cell| cell.parse::<i64>().ok());
        let Some(numbers) = numbers.collect::<Option<Vec<i64>>>() else {
            return false;
        };
        let mut steps: Vec<i64> = numbers
            .windows(2)
            .map(|two| two[1].wrapping_sub(two[0]))
            .collect();
        steps.sort_unstable();
        let Some(middle) = steps.get(steps.len() / 2).copied() else {
            return false;
        };
        let same = steps.iter().filter(|step| **step == middle).count();
        middle > 0 && 4 * same >= 3 * steps.len()
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
