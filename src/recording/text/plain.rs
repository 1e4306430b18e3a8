//! Rows of plain numbers: without quotes, and without blanks around them.

use rayon::prelude::*;

use super::decimal::Decimal;
use crate::recording::layout::words::DecimalSign;
use crate::recording::time::stamp::Stamp;
use crate::recording::time::unit::TimeUnit;

/// Fewest bytes that are worth a thread: some hundred microseconds of work.
const PART_BYTES: usize = 1 << 15;

/// What a cell of a row is for.
#[derive(Clone, Copy, Debug)]
pub(super) enum Role {
    Nothing,
    /// A number of this column of the data.
    Data(usize),
    /// A part of the time.
    Time(usize),
}

/// Rows of plain numbers between separators of one byte.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlainRows<'a> {
    /// What each cell is for.
    pub(super) roles: &'a [Role],
    /// Units of the columns of the time.
    pub(super) units: &'a [TimeUnit],
    /// Columns of the data.
    pub(super) columns: usize,
    pub(super) separator: u8,
}

/// The rows of a part of a text, up to the first line that is none.
#[derive(Debug, Default)]
pub(super) struct PlainPart {
    pub(super) count: usize,
    /// Bytes of the rows with their ends.
    pub(super) length: usize,
    /// By column.
    pub(super) values: Vec<Vec<f64>>,
    /// None without a time.
    pub(super) stamps: Vec<Stamp>,
}

impl PlainRows<'_> {
    /// The rows at the beginning of some bytes, so many at most, in parts.
    ///
    /// A line that is no such row ends them: the general reader says what it is.
    pub(super) fn at_start(&self, bytes: &[u8], most: usize) -> Vec<PlainPart> {
        let threads = rayon::current_num_threads().min(bytes.len() / PART_BYTES);
        // A row has two bytes at least: where the bound may be met, rows are counted one by one.
        if threads < 2 || most < bytes.len() / 2 {
            return vec![self.part(bytes, most)];
        }
        let parts = in_lines(bytes, threads).into_par_iter();
        let mut parts: Vec<(bool, PlainPart)> = parts
            .map(|part| {
                let rows = self.part(part, usize::MAX);
                (rows.length == part.len(), rows)
            })
            .collect();
        // What stands behind a line that is no row is read again behind it.
        if let Some(end) = parts.iter().position(|(is_whole, _)| !is_whole) {
            parts.truncate(end + 1);
        }
        parts.into_iter().map(|(_, rows)| rows).collect()
    }

    fn part(&self, bytes: &[u8], most: usize) -> PlainPart {
        let mut part = PlainPart {
            values: vec![Vec::new(); self.columns],
            ..PlainPart::default()
        };
        let mut row = vec![0.0; self.columns];
        while part.count < most
            && let Some((stamp, length)) = self.row(&bytes[part.length..], &mut row)
        {
            for (values, value) in part.values.iter_mut().zip(&row) {
                values.push(*value);
            }
            if !self.units.is_empty() {
                part.stamps.push(stamp);
            }
            part.count += 1;
            part.length += length;
        }
        part
    }

    /// Stamp, numbers and length of the row at the beginning of some bytes, with its end.
    #[inline]
    fn row(&self, bytes: &[u8], values: &mut [f64]) -> Option<(Stamp, usize)> {
        // Comments do not begin as numbers do.
        if !matches!(bytes.first(), Some(b'0'..=b'9' | b'-' | b'+' | b'.')) {
            return None;
        }
        let (mut rest, mut stamp) = (bytes, Stamp::NOTHING);
        let width = self.roles.len();
        for (index, role) in self.roles.iter().enumerate() {
            let length = match *role {
                Role::Nothing => plain_length(rest, self.separator),
                Role::Data(position) => {
                    let (value, length) = plain_number(rest, self.separator)?;
                    values[position] = value;
                    length
                }
                Role::Time(position) => {
                    let unit = self.units[position];
                    let (part, length) = plain_stamp(rest, self.separator, unit)?;
                    stamp = stamp.plus(part);
                    length
                }
            };
            let end = match &rest[length..] {
                [byte, ..] if index + 1 < width && *byte == self.separator => 1,
                [b'\n', ..] if index + 1 == width => 1,
                [b'\r', b'\n', ..] if index + 1 == width => 2,
                _ => return None,
            };
            rest = &rest[length + end..];
        }
        Some((stamp, bytes.len() - rest.len()))
    }
}

/// Bytes in so many parts of about one length, each of which ends with a line.
fn in_lines(bytes: &[u8], count: usize) -> Vec<&[u8]> {
    let mut parts = Vec::with_capacity(count);
    let mut rest = bytes;
    for left in (1..count).rev() {
        let about = rest.len() / (left + 1);
        let end = memchr::memchr(b'\n', &rest[about..]);
        let (part, behind) = rest.split_at(end.map_or(rest.len(), |end| about + end + 1));
        parts.push(part);
        rest = behind;
    }
    parts.push(rest);
    parts
}

/// The number at the beginning of a row, up to the separator or the end, and its length.
#[inline]
pub(super) fn plain_number(rest: &[u8], separator: u8) -> Option<(f64, usize)> {
    if let Some((number, length)) = Decimal::at_start(rest)
        && is_end(rest, length, separator)
        && let Some(value) = number.value()
    {
        return Some((value, length));
    }
    let cell = plain_cell(rest, separator)?;
    let value = cell.parse::<f64>().ok().filter(|value| value.is_finite())?;
    Some((value, cell.len()))
}

/// The same of a stamp.
#[inline]
pub(super) fn plain_stamp(rest: &[u8], separator: u8, unit: TimeUnit) -> Option<(Stamp, usize)> {
    if unit != TimeUnit::Iso
        && let Some((number, length)) = Decimal::at_start(rest)
        && is_end(rest, length, separator)
        && let Some(stamp) = Stamp::of_decimal(number, unit)
    {
        return Some((stamp, length));
    }
    let cell = plain_cell(rest, separator)?;
    let stamp = Stamp::read(cell, unit, DecimalSign::Point).ok()?;
    Some((stamp, cell.len()))
}

/// Whether a cell has so many bytes.
#[inline]
fn is_end(rest: &[u8], length: usize, separator: u8) -> bool {
    let byte = rest.get(length);
    byte.is_none_or(|byte| *byte == separator || matches!(byte, b'\n' | b'\r'))
}

/// The cell at the beginning of a row without quotes and without blanks around it.
fn plain_cell(rest: &[u8], separator: u8) -> Option<&str> {
    let cell = std::str::from_utf8(&rest[..plain_length(rest, separator)]).ok()?;
    (cell.trim().len() == cell.len()).then_some(cell)
}

/// Bytes of a cell: up to the separator, the end, or what is not plain.
pub(super) fn plain_length(rest: &[u8], separator: u8) -> usize {
    let is_plain = |byte: &u8| matches!(byte, b' '..=b'~') && *byte != b'"';
    let end = rest
        .iter()
        .position(|byte| *byte == separator || !is_plain(byte));
    end.unwrap_or(rest.len())
}
