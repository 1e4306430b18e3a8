//! Which columns are the time: those that are named, else those whose heading or whose cells say so.

use super::cells::is_number;
use super::columns::{Chooser, Chosen, NO_TIME, TIME};
use super::{Asked, LayoutError};
use crate::recording::text::lines::{listed, shown};
use crate::recording::time::stamp::{Stamp, is_date};
use crate::recording::time::unit::TimeUnit;
use crate::recording::unit::spelling::{Spelled, name_of_heading};

/// Words in the heading of a column of time.
pub(super) const TIMES: [&str; 16] = [
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
pub(super) const SHORT_TIMES: [&str; 5] = ["t", "ts", "secs", "sec", "x_value"];
/// Units of the part of a second that stands beside whole ones.
const PARTS: [TimeUnit; 3] = [
    TimeUnit::Milliseconds,
    TimeUnit::Microseconds,
    TimeUnit::Nanoseconds,
];
/// Words in the heading of a counter of samples.
pub(super) const COUNTERS: [&str; 15] = [
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

impl Chooser<'_> {
    /// Enters the columns of the time: those that are named, else those whose heading says so.
    pub(super) fn put_time(&self, data: &[usize], chosen: &mut Chosen) -> Result<(), LayoutError> {
        let found: Vec<usize> = match self.format.time.as_deref() {
            Some([none]) if none == NO_TIME => return Ok(()),
            Some(names) => names
                .iter()
                .map(|name| self.one(Asked::by(name, TIME)))
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
        if chosen.time.is_empty() {
            chosen.unread_time = self.unread_time(data);
        }
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
        if let Some(unit) = given.or(in_heading).or_else(|| self.part_of_second(index)) {
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
        if let Some(both) = self.seconds_and_part(&all) {
            return Ok(both.into());
        }
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

    /// What is said of a column that is the time by its heading and not by its first cell.
    fn unread_time(&self, data: &[usize]) -> Option<String> {
        let mut free = (0..self.layout.width()).filter(|index| !data.contains(index));
        let index =
            free.find(|it| self.is_named(*it, &TIMES) || self.is_named(*it, &SHORT_TIMES))?;
        let cell = self.cells(index).next()?;
        let is_stamp = is_date(cell) || is_number(cell, self.layout.decimal);
        (!is_stamp).then(|| {
            format!(
                "; `{}` of column {} is neither a number nor a date or time of day as \
                 2024-03-01T12:00:00.005Z",
                shown(cell),
                shown(&self.layout.name(index).unwrap_or_default())
            )
        })
    }

    /// Columns of whole seconds, or of dates with them, and of the part of a second that is added.
    fn seconds_and_part(&self, all: &[usize]) -> Option<[usize; 2]> {
        let mut pairs = all
            .iter()
            .flat_map(|part| all.iter().map(move |whole| [*whole, *part]));
        pairs.find(|[whole, part]| {
            whole != part
                && self.part_of_second(*part).is_some()
                && self.is_beside(*whole, *part)
                && self.are_whole_seconds(*whole)
        })
    }

    /// Whether the headings of whole seconds and of a part of them say that they belong together; without
    /// headings, whether the part follows a date.
    fn is_beside(&self, whole: usize, part: usize) -> bool {
        if self.layout.names.is_empty() {
            return part == whole + 1 && self.holds_dates(whole);
        }
        let (wholes, parts) = (self.words(whole), self.words(part));
        let is_time = |word: &String| {
            TIMES.contains(&word.as_str()) || TimeUnit::spelled(word) == Some(TimeUnit::Seconds)
        };
        let is_part = |word: &String| TimeUnit::spelled(word).is_some_and(|it| PARTS.contains(&it));
        let mut others = parts.iter().filter(|word| !is_part(word));
        (wholes.iter().any(is_time) || self.holds_dates(whole))
            && others.all(|word| wholes.contains(word) || is_time(word))
    }

    /// Words of a heading.
    fn words(&self, index: usize) -> Vec<String> {
        let name = self.layout.names.get(index).map(|name| name.to_lowercase());
        let name = name.unwrap_or_default();
        let words = name.split(|letter: char| !letter.is_alphanumeric());
        words
            .filter(|word| !word.is_empty())
            .map(str::to_owned)
            .collect()
    }

    /// Unit of a column that holds parts of a second, by its heading, without one by the number of its digits.
    fn part_of_second(&self, index: usize) -> Option<TimeUnit> {
        let words = self.words(index);
        let is_named = |unit| {
            words
                .iter()
                .any(|word| TimeUnit::spelled(word) == Some(unit))
        };
        let per_second = |unit: TimeUnit| {
            let nanoseconds = [TimeUnit::Seconds, unit].map(TimeUnit::nanoseconds);
            let [second, part] = nanoseconds.map(Option::unwrap_or_default);
            second.checked_div(part).unwrap_or_default()
        };
        let digits = self.cells(index).next().unwrap_or_default().len();
        let is_like = |unit| {
            self.layout.names.is_empty()
                && per_second(unit).to_string().len() == digits + 1
                && self.cells(index).all(|cell| cell.len() == digits)
        };
        let unit = PARTS
            .into_iter()
            .find(|unit| is_named(*unit) || is_like(*unit))?;
        let is_part = |cell: &str| {
            let number = cell.parse::<i128>();
            number.is_ok_and(|number| (0..per_second(unit)).contains(&number))
        };
        self.cells(index).all(is_part).then_some(unit)
    }

    /// Whether the cells are whole seconds, or dates with whole seconds, that do not fall.
    fn are_whole_seconds(&self, index: usize) -> bool {
        let is_whole = |cell: &str| !cell.contains(['.', ',', 'e', 'E']);
        self.cells(index).all(is_whole)
            && self
                .stamps(index)
                .is_some_and(|stamps| stamps.len() > 1 && stamps.is_sorted())
    }

    /// The stamps that the cells are as dates or as seconds, ticks.
    fn stamps(&self, index: usize) -> Option<Vec<i128>> {
        let unit = match self.holds_dates(index) {
            true => TimeUnit::Iso,
            false => TimeUnit::Seconds,
        };
        let stamps = self.cells(index).map(|cell| {
            let stamp = Stamp::read(cell, unit, self.layout.decimal);
            stamp.ok().map(|stamp| stamp.ticks)
        });
        stamps.collect()
    }

    /// Whether a heading has one of some words.
    pub(super) fn is_named(&self, index: usize, words: &[&str]) -> bool {
        let Some(heading) = self.layout.names.get(index) else {
            return false;
        };
        let name = name_of_heading(heading);
        let mut parts = name.split(|letter: char| !letter.is_alphanumeric());
        parts.any(|part| words.contains(&part))
    }

    /// Whether a column whose heading has one of some words rises as a time does.
    pub(super) fn is_time(&self, index: usize, words: &[&str]) -> bool {
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

    pub(super) fn cells(&self, index: usize) -> impl Iterator<Item = &str> {
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
        let Some(stamps) = self.stamps(index) else {
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
