//! What cells are: numbers with either decimal sign, stamps, words.

use super::words::{DecimalSign, Separator};
use crate::recording::text::lines::Delimiter;
use crate::recording::text::lines::{NumberError, begins_like_number, finite, is_missing, shown};
use crate::recording::time::stamp::{is_date, is_like_date};

/// Separators of one character, in the order in which they are looked for.
pub(super) const CHARACTERS: [Separator; 3] =
    [Separator::Tab, Separator::Semicolon, Separator::Comma];

/// Whether a cell is a number with this decimal sign.
pub(in crate::recording) fn is_number(cell: &str, decimal: DecimalSign) -> bool {
    match decimal {
        DecimalSign::Point => cell.parse::<f64>().is_ok(),
        DecimalSign::Comma => {
            !cell.contains('.') && plain_spelling(cell, decimal).parse::<f64>().is_ok()
        }
    }
}

/// A number as it is spelled with a decimal point.
pub(in crate::recording) fn plain_spelling(
    cell: &str,
    decimal: DecimalSign,
) -> std::borrow::Cow<'_, str> {
    match decimal {
        DecimalSign::Comma if cell.contains(',') => cell.replacen(',', ".", 1).into(),
        _ => cell.into(),
    }
}

/// The finite number of a cell with this decimal sign.
///
/// # Errors
/// No number, or none that is finite.
pub(in crate::recording) fn finite_in(
    cell: &str,
    decimal: DecimalSign,
) -> Result<f64, NumberError> {
    match decimal {
        DecimalSign::Point => finite(cell),
        // A point may stand between thousands, or the comma may.
        DecimalSign::Comma
            if cell.contains('.') && cell.contains(|it: char| it.is_ascii_digit()) =>
        {
            Err(NumberError::DecimalPoint(shown(cell)))
        }
        DecimalSign::Comma => finite(&plain_spelling(cell, decimal)),
    }
}

/// Whether a cell is a number or a date.
pub(super) fn is_value(cell: &str, decimal: DecimalSign) -> bool {
    is_number(cell, decimal) || is_date(cell)
}

/// Whether a cell is whole, as cells are that the right separator cuts: a number with either sign, a date,
/// nothing, or a word.
fn is_whole(cell: &str) -> bool {
    let signs = [DecimalSign::Point, DecimalSign::Comma];
    signs.into_iter().any(|sign| is_value(cell, sign))
        || is_missing(cell)
        || !begins_like_number(cell)
        // Numbers that were not cut where they should have been have no other letters.
        || cell.contains(|c: char| c.is_alphabetic() && !matches!(c, 'e' | 'E'))
        || is_like_date(cell)
}

/// The separator of lines: the first of tab, semicolon and comma that most of them hold and that leaves
/// whole cells, else blanks.
///
/// * `decimal`: the sign, if it is given: then a comma separates quoted numbers only.
pub(super) fn separator_of(lines: &[&str], decimal: Option<DecimalSign>) -> Separator {
    let found = CHARACTERS.into_iter().find(|candidate| {
        if *candidate == Separator::Comma
            && decimal == Some(DecimalSign::Comma)
            && !lines.iter().any(|line| line.contains('"'))
        {
            return false;
        }
        cuts(*candidate, lines)
    });
    let found = found.or_else(|| CHARACTERS.into_iter().find(|it| stands_alone(*it, lines)));
    found.unwrap_or(Separator::Blanks)
}

/// Whether a separator stands between blanks in most lines, so that these do not separate.
fn stands_alone(separator: Separator, lines: &[&str]) -> bool {
    let Delimiter::Character(character) = Delimiter::from(separator) else {
        return false;
    };
    let is_alone = |word: &str| word.strip_prefix(character) == Some("");
    let with = lines.iter().filter(|line| line.split(' ').any(is_alone));
    2 * with.count() > lines.len()
}

/// Whether most lines hold a separator that leaves whole cells.
pub(super) fn cuts(separator: Separator, lines: &[&str]) -> bool {
    let delimiter = Delimiter::from(separator);
    let cut = lines.iter().map(|line| delimiter.cells(line));
    let cut: Vec<_> = cut.filter(|cells| cells.len() > 1).collect();
    let is_clean = |cells: &&Vec<&str>| cells.iter().all(|cell| is_whole(cell));
    let clean = cut.iter().filter(is_clean).count();
    2 * cut.len() > lines.len() && 2 * clean >= cut.len()
}

/// What the cells of a text say of its decimal sign.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum DecimalFound {
    Sure(DecimalSign),
    /// Commas that may stand before decimals or between thousands, with one such number.
    Doubt(String),
}

/// The decimal sign of rows: a comma if more cells are numbers with a comma than with a point.
pub(super) fn decimal_of(lines: &[&str], separator: Separator) -> DecimalFound {
    let delimiter = Delimiter::from(separator);
    let cells: Vec<&str> = lines
        .iter()
        .flat_map(|line| delimiter.cells(line))
        .collect();
    let points = cells
        .iter()
        .filter(|cell| cell.contains('.') && is_number(cell, DecimalSign::Point))
        .count();
    let commas: Vec<&str> = cells
        .iter()
        .copied()
        .filter(|cell| cell.contains(',') && is_number(cell, DecimalSign::Comma))
        .collect();
    let are_thousands = commas.iter().all(|cell| may_be_thousands(cell));
    match commas[..] {
        [first, ..] if points == 0 && are_thousands => DecimalFound::Doubt(first.to_owned()),
        // Of a few numbers with a point, each is told when it is read.
        [_, ..] if commas.len() > points && !are_thousands => {
            DecimalFound::Sure(DecimalSign::Comma)
        }
        _ => DecimalFound::Sure(DecimalSign::Point),
    }
}

/// Whether the comma of a number may stand before three digits of a whole one.
fn may_be_thousands(cell: &str) -> bool {
    let cell = cell.trim_start_matches(['+', '-']);
    cell.split_once(',').is_some_and(|(before, behind)| {
        (1..=3).contains(&before.len()) && !before.starts_with('0') && behind.len() == 3
    })
}
