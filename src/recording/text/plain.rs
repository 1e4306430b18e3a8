//! Cells of rows that hold plain numbers: without quotes, and without blanks around them.

use super::decimal::Decimal;
use crate::recording::layout::words::DecimalSign;
use crate::recording::time::stamp::Stamp;
use crate::recording::time::unit::TimeUnit;

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
