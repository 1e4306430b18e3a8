//! Rows of plain numbers: without quotes.

use std::io;

use super::decimal::Decimal;
use crate::recording::column::Column;
use crate::recording::input::reserve;
use crate::recording::layout::words::DecimalSign;
use crate::recording::time::column::{Ascent, Origin, TimeColumn};
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
    /// A part of the time, in its unit.
    Time(TimeUnit),
}

/// Rows of plain numbers between separators of one byte, with blanks around them or without.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlainRows<'a> {
    /// What each cell is for.
    pub(super) roles: &'a [Role],
    /// Where times begin; none without a time.
    pub(super) origin: Option<Origin>,
    /// A blank stands for any number of them.
    pub(super) separator: u8,
}

/// Places for the rows of a part of a text.
#[derive(Debug, Default)]
struct Places<'a> {
    rows: usize,
    /// Of each column of the data.
    values: Vec<&'a mut [f64]>,
    /// None without a time.
    stamps: &'a mut [f64],
}

/// The rows of a part of a text, up to the first line that is none and the first stamp that descends.
#[derive(Clone, Copy, Debug, Default)]
struct Taken {
    count: usize,
    /// Bytes of the rows with their ends.
    length: usize,
    ascent: Option<Ascent>,
}

impl PlainRows<'_> {
    /// Appends the rows at the beginning of some bytes to the columns, so many at most: how many, and their bytes.
    ///
    /// A line that is no such row ends them: the general reader says what it is.
    ///
    /// # Errors
    /// Memory is used up.
    pub(super) fn append(
        &self,
        bytes: &[u8],
        most: usize,
        columns: &mut [Column],
        mut time: Option<&mut TimeColumn>,
    ) -> io::Result<(usize, usize)> {
        let threads = rayon::current_num_threads().min(bytes.len() / PART_BYTES);
        // A row has two bytes at least: where the bound may be met, rows are counted one by one.
        let is_bounded = most < bytes.len() / 2;
        let pieces = in_lines(bytes, if is_bounded { 1 } else { threads.max(1) });
        let lines = |piece: &&[u8]| memchr::memchr_iter(b'\n', piece).count().min(most);
        let counts: Vec<usize> = pieces.iter().map(lines).collect();
        let mut places: Vec<Places> = counts.iter().map(|count| Places::of(*count)).collect();
        let rows = columns.first().map_or(0, |column| column.values.len());
        for column in &mut *columns {
            let mut behind = with_zeros(&mut column.values, &counts)?;
            for places in &mut places {
                places.values.push(cut_off(&mut behind, places.rows));
            }
        }
        let stamps = time.as_ref().map_or(0, |time| time.stamps.len());
        if let Some(time) = &mut time {
            let mut behind = with_zeros(&mut time.stamps, &counts)?;
            for places in &mut places {
                places.stamps = cut_off(&mut behind, places.rows);
            }
        }
        let taken = self.take_all(&pieces, places);
        let (mut count, mut length) = (0, 0);
        for ((taken, piece), lines) in taken.iter().zip(&pieces).zip(&counts) {
            if let (Some(time), Some(ascent)) = (&mut time, taken.ascent)
                && !time.goes_on_over(ascent)
            {
                break;
            }
            count += taken.count;
            length += taken.length;
            // What stands behind a line that is no row is read again behind it.
            if taken.length < piece.len() || taken.count < *lines {
                break;
            }
        }
        for column in columns {
            column.values.truncate(rows + count);
        }
        if let Some(time) = time {
            time.stamps.truncate(stamps + count);
        }
        Ok((count, length))
    }

    /// The rows of each piece, on a thread of its own.
    fn take_all(&self, pieces: &[&[u8]], places: Vec<Places>) -> Vec<Taken> {
        let mut all = vec![Taken::default(); pieces.len()];
        let mut places = places.into_iter();
        // This thread takes one itself: to wake another costs as much as some rows.
        if let (Some((own, others)), Some(own_places)) = (all.split_first_mut(), places.next()) {
            rayon::in_place_scope(|scope| {
                for ((taken, piece), places) in others.iter_mut().zip(&pieces[1..]).zip(places) {
                    scope.spawn(|_| *taken = self.take(piece, places));
                }
                *own = self.take(pieces[0], own_places);
            });
        }
        all
    }

    fn take(&self, bytes: &[u8], mut places: Places) -> Taken {
        let mut taken = Taken::default();
        while taken.count < places.rows
            && let Some((stamp, length)) =
                self.row(&bytes[taken.length..], taken.count, &mut places.values)
        {
            if let Some(origin) = self.origin {
                let Some(ascent) = Ascent::with(taken.ascent, stamp) else {
                    break;
                };
                taken.ascent = Some(ascent);
                places.stamps[taken.count] = origin.to(stamp);
            }
            taken.count += 1;
            taken.length += length;
        }
        taken
    }

    /// Stamp and length, with its end, of the row at the beginning of some bytes; its numbers go to their places.
    #[inline]
    fn row(&self, bytes: &[u8], at: usize, values: &mut [&mut [f64]]) -> Option<(Stamp, usize)> {
        let separator = self.separator;
        let mut rest = &bytes[blanks_at_start(bytes, separator)..];
        // Comments do not begin as numbers do.
        if !matches!(rest.first(), Some(b'0'..=b'9' | b'-' | b'+' | b'.')) {
            return None;
        }
        let mut stamp = Stamp::NOTHING;
        let last = self.roles.len() - 1;
        for (index, role) in self.roles.iter().enumerate() {
            let length = match *role {
                Role::Nothing => plain_length(rest, separator),
                Role::Data(position) => {
                    let (value, length) = plain_number(rest, separator)?;
                    values[position][at] = value;
                    length
                }
                Role::Time(unit) => {
                    let (part, length) = plain_stamp(rest, separator, unit)?;
                    stamp = stamp.plus(part);
                    length
                }
            };
            // Between blanks no cell is empty.
            if length == 0 && separator == b' ' {
                return None;
            }
            rest = match index == last {
                true => behind_row(&rest[length..], separator)?,
                false => behind_cell(&rest[length..], separator)?,
            };
        }
        Some((stamp, bytes.len() - rest.len()))
    }
}

/// What stands behind the separator of a cell and the blanks around it; nothing where there is no separator.
#[inline]
fn behind_cell(rest: &[u8], separator: u8) -> Option<&[u8]> {
    // Most logs have no blanks.
    if let [first, behind @ ..] = rest
        && *first == separator
        && !matches!(behind, [b' ' | b'\t', ..])
    {
        return Some(behind);
    }
    let blanks = blanks_at_start(rest, separator);
    if separator == b' ' {
        return (blanks > 0).then(|| &rest[blanks..]);
    }
    let rest = rest[blanks..].strip_prefix(&[separator])?;
    Some(&rest[blanks_at_start(rest, separator)..])
}

/// What stands behind the end of a row and the blanks before it; nothing where that is not the end.
#[inline]
fn behind_row(rest: &[u8], separator: u8) -> Option<&[u8]> {
    if let [b'\n', behind @ ..] = rest {
        return Some(behind);
    }
    match &rest[blanks_at_start(rest, separator)..] {
        [b'\n', behind @ ..] | [b'\r', b'\n', behind @ ..] => Some(behind),
        _ => None,
    }
}

/// Blanks at the beginning of some bytes: those that separate, or those around a separator.
#[inline]
fn blanks_at_start(bytes: &[u8], separator: u8) -> usize {
    let is_blank = |byte: &u8| *byte == b' ' || (*byte == b'\t' && separator != b'\t');
    bytes.iter().take_while(|byte| is_blank(byte)).count()
}

impl Places<'_> {
    fn of(rows: usize) -> Self {
        Self {
            rows,
            ..Self::default()
        }
    }
}

/// Lengthens a column by zeros for rows of several parts, and gives the places behind what stands in it.
fn with_zeros<'a>(values: &'a mut Vec<f64>, counts: &[usize]) -> io::Result<&'a mut [f64]> {
    let (end, more) = (values.len(), counts.iter().sum());
    reserve(values, more)?;
    values.resize(end + more, 0.0);
    Ok(&mut values[end..])
}

/// The first of some places, which are then the others.
fn cut_off<'a>(places: &mut &'a mut [f64], count: usize) -> &'a mut [f64] {
    let (own, others) = std::mem::take(places).split_at_mut(count);
    *places = others;
    own
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
    byte.is_none_or(|byte| *byte == separator || matches!(byte, b'\n' | b'\r' | b' ' | b'\t'))
}

/// The cell at the beginning of a row, without quotes and without the blanks behind it.
fn plain_cell(rest: &[u8], separator: u8) -> Option<&str> {
    let cell = std::str::from_utf8(&rest[..plain_length(rest, separator)]).ok()?;
    Some(cell.trim_end())
}

/// Bytes of a cell: up to the separator, the end, or what is not plain.
pub(super) fn plain_length(rest: &[u8], separator: u8) -> usize {
    let is_plain = |byte: &u8| matches!(byte, b' '..=b'~') && *byte != b'"';
    let end = rest
        .iter()
        .position(|byte| *byte == separator || !is_plain(byte));
    end.unwrap_or(rest.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two columns and a time, of which `odd` stands in the place of one row.
    fn text(rows: usize, odd_row: usize, odd: &str) -> String {
        let row = |row: usize| match row == odd_row {
            true => odd.to_owned(),
            false => format!("{row}.5,{},-{row}e-3\n", row % 7),
        };
        (0..rows).map(row).collect()
    }

    /// Columns behind a first row, and what so many threads append of some bytes between commas.
    fn appended(
        bytes: &[u8],
        most: usize,
        threads: usize,
    ) -> (Vec<Column>, TimeColumn, (usize, usize)) {
        appended_between(b',', bytes, most, threads)
    }

    fn appended_between(
        separator: u8,
        bytes: &[u8],
        most: usize,
        threads: usize,
    ) -> (Vec<Column>, TimeColumn, (usize, usize)) {
        let mut columns = vec![Column::default(); 2];
        let mut time = TimeColumn::new("t".to_owned(), vec![TimeUnit::Seconds], false);
        time.take(Stamp {
            ticks: 0,
            resolution: 1,
        })
        .expect("memory");
        for column in &mut columns {
            column.values.push(0.0);
        }
        let rows = PlainRows {
            roles: &[Role::Time(TimeUnit::Seconds), Role::Data(1), Role::Data(0)],
            origin: Some(time.origin()),
            separator,
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.expect("threads");
        let found = pool.install(|| rows.append(bytes, most, &mut columns, Some(&mut time)));
        (columns, time, found.expect("memory"))
    }

    #[test]
    fn rows_are_the_same_on_any_number_of_threads() {
        let all = usize::MAX;
        for (odd_row, odd, most) in [
            (0, "x\n", all),
            (3000, "# pause\n", all),
            // A clock that falls back is looked at row by row, wherever a part begins.
            (3001, "7.5,1,2\n", all),
            (9999, "9999.5,2,3", all),
            (20_000, "", all),
            (20_000, "", 5),
        ] {
            let text = text(10_000, odd_row, odd);
            let (alone, time, found) = appended(text.as_bytes(), most, 1);
            assert_eq!(found.0, odd_row.min(10_000).min(most), "{odd}");
            let end = text
                .split_inclusive('\n')
                .take(found.0)
                .map(str::len)
                .sum::<usize>();
            assert_eq!(found.1, end, "{odd}");
            for threads in [2, 3, 4, 5] {
                let (columns, own_time, own) = appended(text.as_bytes(), most, threads);
                assert_eq!(own, found, "{odd} {threads}");
                assert_eq!(own_time.stamps, time.stamps, "{odd} {threads}");
                assert_eq!(
                    format!("{own_time:?}"),
                    format!("{time:?}"),
                    "{odd} {threads}"
                );
                for (column, alone) in columns.iter().zip(&alone) {
                    assert_eq!(column.values, alone.values, "{odd} {threads}");
                }
            }
        }
    }

    #[test]
    fn every_row_may_begin_a_part() {
        // A descent at each place about the border between two parts.
        let lines = text(8000, 9000, "");
        let middle = lines[..lines.len() / 2].matches('\n').count();
        for odd_row in middle - 3..middle + 3 {
            let text = text(8000, odd_row, "1.5,1,1\n");
            let (.., found) = appended(text.as_bytes(), usize::MAX, 2);
            assert_eq!(found.0, odd_row);
        }
    }

    #[test]
    fn blanks_stand_around_cells_or_between_them() {
        for (separator, text, rows) in [
            (b',', " 1.5, -2 ,\t3e0 \r\n2.5 ,4,5\n", 2),
            (b',', "1.5,2,3\n2.5, ,4\n", 1),
            (b',', "1.5 2,3,4\n", 0),
            (b'\t', "1.5 \t 2\t3\n2.5\t\t4\n", 1),
            (b' ', "  1.5   -2\t3e0 \n 2.5 4 5\r\n", 2),
            (b' ', "1.5 2 \n", 0),
            (b' ', "1.5 2 3 4\n", 0),
            (b' ', "1.5 2 3\n# 2.5 4 5\n", 1),
        ] {
            let (columns, time, found) =
                appended_between(separator, text.as_bytes(), usize::MAX, 1);
            assert_eq!(found.0, rows, "{text:?}");
            let row = |at: usize| -> Vec<f64> {
                let words = [&columns[1].values, &columns[0].values].map(|column| column[at].abs());
                [time.stamps[at]].into_iter().chain(words).collect()
            };
            if rows > 0 {
                assert_eq!(row(1), vec![1.5, 2.0, 3.0], "{text:?}");
            }
            if rows > 1 {
                assert_eq!(row(2), vec![2.5, 4.0, 5.0], "{text:?}");
                assert_eq!(found.1, text.len(), "{text:?}");
            }
        }
    }
}
