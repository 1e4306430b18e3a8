//! Text as every reader of numbers takes it: its lines, their cells, and what a number looks like.
//!
//! Encoding: UTF-8, with a byte order mark or without. Lines end with LF, CR LF or CR; empty ones and
//! those that begin with `#` are passed over. Cells stand between tabs, `;`, `,` or blanks, whichever
//! of these the first line has, in this order; what stands in quotation marks is not cut. Empty cells
//! behind the last one of the first line are none, so that a separator may end every line.

use std::io::{self, BufRead};

/// Longest line, bytes.
const LINE_BYTES_MAX: usize = 1 << 20;
/// Longest part of a cell that a message repeats, characters.
const SHOWN_CHARACTERS: usize = 40;
/// Most names that a message lists.
const LISTED_MAX: usize = 20;

/// What spreadsheets write where a number is missing.
const SPREADSHEET_ERRORS: [&str; 12] = [
    "#N/A", "#VALUE!", "#DIV/0!", "#REF!", "#NUM!", "#NULL!", "#NV", "#WERT!", "#BEZUG!", "#ZAHL!",
    "#VALEUR!", "#NOMBRE!",
];
/// Words for a missing number, in small letters.
const MISSING: [&str; 18] = [
    "n/a",
    "na",
    "null",
    "none",
    "nil",
    "missing",
    "-",
    "--",
    "---",
    "?",
    "ovr",
    "ovl",
    "nan(ind)",
    "-nan(ind)",
    "1.#ind",
    "-1.#ind",
    "1.#qnan",
    "-1.#qnan",
];

const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
/// First bytes of what is no text in UTF-8, and what to do.
const FOREIGN: [(&[u8], &str); 5] = [
    (b"\xff\xfe", "text in UTF-16: save it as UTF-8"),
    (b"\xfe\xff", "text in UTF-16: save it as UTF-8"),
    (
        b"PK\x03\x04",
        "a ZIP or NPZ archive: unpack it and name the file in it",
    ),
    (b"\x1f\x8b", "compressed by gzip: unpack it"),
    (b"\x89HDF", "an HDF5 file: write its numbers as NPY or text"),
];

/// A line of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line<'a> {
    /// Number from 1.
    pub number: usize,
    /// Byte of the text at which it starts.
    pub start: usize,
    /// What it says, without its end.
    pub text: &'a str,
    /// Number of the first empty line between the one before and it.
    pub empty_before: Option<usize>,
}

/// Why a text was not read on.
#[derive(Debug, thiserror::Error)]
pub enum TextError {
    /// The system refused.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// What a line holds is no text.
    #[error("line {line}: {message}")]
    Content {
        /// The line, from 1.
        line: usize,
        /// Byte of the text at which it starts.
        start: usize,
        /// What is wrong.
        message: String,
    },
}

/// The lines of a text that say something, one after another.
#[derive(Debug)]
pub struct Lines<R> {
    reader: R,
    /// What is expected of the bytes, for messages.
    encoding: &'static str,
    line: String,
    number: usize,
    start: usize,
    /// Byte behind the line and its end.
    end: usize,
    /// Whether a CR ended the line, whose LF is still to come.
    is_after_cr: bool,
}

impl<R: BufRead> Lines<R> {
    /// Begins a text.
    ///
    /// * `encoding`: what is said of bytes that are no UTF-8.
    pub fn new(reader: R, encoding: &'static str) -> Self {
        Self {
            reader,
            encoding,
            line: String::new(),
            number: 0,
            start: 0,
            end: 0,
            is_after_cr: false,
        }
    }

    /// The next line that is neither empty nor a comment; none at the end.
    ///
    /// # Errors
    /// [`TextError`]: bytes that are no UTF-8, NUL, a line beyond 1 MiB.
    pub fn next_line(&mut self) -> Result<Option<Line<'_>>, TextError> {
        self.next_unless(|text| is_comment(text, &["#"]))
    }

    /// The next line that is neither empty nor passed over; none at the end.
    ///
    /// # Errors
    /// As [`Self::next_line`].
    pub(in crate::recording) fn next_unless(
        &mut self,
        is_passed: impl Fn(&str) -> bool,
    ) -> Result<Option<Line<'_>>, TextError> {
        let mut empty_before = None;
        loop {
            if !self.advance()? {
                return Ok(None);
            }
            let text = self.line.trim();
            if text.is_empty() {
                empty_before.get_or_insert(self.number);
            } else if !is_passed(text) {
                break;
            }
        }
        Ok(Some(Line {
            number: self.number,
            start: self.start,
            text: &self.line,
            empty_before,
        }))
    }

    /// Passes lines that are in the buffer already, as far as they are taken.
    ///
    /// * `take`: given the bytes from the start of a line to the end of the buffer, and the number of the line,
    ///   how many lines are taken and their bytes with their ends. The line behind them is the next one of
    ///   [`Self::next_unless`].
    ///
    /// # Errors
    /// The system's, and those of `take`.
    pub(super) fn pass(
        &mut self,
        take: impl FnOnce(&[u8], usize) -> io::Result<(usize, usize)>,
    ) -> io::Result<()> {
        if self.number == 0 {
            return Ok(());
        }
        let available = match self.reader.fill_buf() {
            Ok(available) => available,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => return Ok(()),
            Err(error) => return Err(error),
        };
        // The LF that still belongs to the line before.
        let end = match available.first() {
            Some(first) => usize::from(std::mem::take(&mut self.is_after_cr) && *first == b'\n'),
            None => 0,
        };
        let (lines, length) = take(&available[end..], self.number + 1)?;
        self.number += lines;
        let passed = end + length;
        self.end += passed;
        self.reader.consume(passed);
        Ok(())
    }

    /// Reads a line; whether there was one.
    fn advance(&mut self) -> Result<bool, TextError> {
        let mut bytes = std::mem::take(&mut self.line).into_bytes();
        bytes.clear();
        self.number += 1;
        self.start = self.end;
        let is_line = self.take_line(&mut bytes)?;
        if self.number == 1 {
            if let Some((_, what)) = FOREIGN.iter().find(|(first, _)| bytes.starts_with(first)) {
                return Err(self.complaint((*what).to_owned()));
            }
            if bytes.starts_with(BYTE_ORDER_MARK) {
                bytes.drain(..BYTE_ORDER_MARK.len());
                self.start += BYTE_ORDER_MARK.len();
            }
        }
        if bytes.contains(&0) {
            let message = "a NUL byte: expected text in UTF-8, this is UTF-16 or no text";
            return Err(self.complaint(message.to_owned()));
        }
        self.line =
            String::from_utf8(bytes).map_err(|_| self.complaint(self.encoding.to_owned()))?;
        Ok(is_line)
    }

    /// Takes the bytes of a line; whether there was one, be it empty.
    fn take_line(&mut self, bytes: &mut Vec<u8>) -> Result<bool, TextError> {
        loop {
            let available = match self.reader.fill_buf() {
                Ok(available) => available,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(error) => return Err(error.into()),
            };
            let Some(first) = available.first() else {
                return Ok(!bytes.is_empty());
            };
            if std::mem::take(&mut self.is_after_cr) && *first == b'\n' {
                self.reader.consume(1);
                self.start += 1;
                self.end += 1;
                continue;
            }
            let found = memchr::memchr2(b'\n', b'\r', available);
            let count = found.unwrap_or(available.len());
            if bytes.len() + count > LINE_BYTES_MAX {
                return Err(self.complaint(format!(
                    "the line has more than {LINE_BYTES_MAX} bytes: expected one sample a line"
                )));
            }
            bytes.extend_from_slice(&available[..count]);
            let Some(at) = found else {
                self.reader.consume(count);
                self.end += count;
                continue;
            };
            self.is_after_cr = available[at] == b'\r';
            self.reader.consume(count + 1);
            self.end += count + 1;
            return Ok(true);
        }
    }

    fn complaint(&self, message: String) -> TextError {
        TextError::Content {
            line: self.number,
            start: self.start,
            message,
        }
    }
}

/// Whether a line begins with one of these marks; what a spreadsheet writes for a missing number does not.
pub(in crate::recording) fn is_comment(text: &str, marks: &[&str]) -> bool {
    let is_missing = |text: &str| SPREADSHEET_ERRORS.iter().any(|it| text.starts_with(it));
    marks.iter().any(|mark| text.starts_with(mark)) && !is_missing(text)
}

/// Whether a cell is a word for a missing number, or empty.
pub(in crate::recording) fn is_missing(cell: &str) -> bool {
    cell.is_empty()
        || SPREADSHEET_ERRORS.contains(&cell)
        || MISSING.iter().any(|word| cell.eq_ignore_ascii_case(word))
        || cell
            .trim_start_matches(['+', '-'])
            .eq_ignore_ascii_case("nan")
}

/// What stands between the cells of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Delimiter {
    /// A character, each of which ends a cell.
    Character(char),
    /// Any number of blanks.
    Blanks,
}

impl Delimiter {
    /// The delimiter of the first line that says something.
    #[must_use]
    pub fn of(line: &str) -> Self {
        let is_there = |wanted: &char| {
            let mut outside = outside_quotes(line);
            outside.any(|(_, character)| character == *wanted)
        };
        let found = ['\t', ';', ','].into_iter().find(is_there);
        found.map_or(Self::Blanks, Self::Character)
    }

    /// The cells of a line, without the blanks and quotation marks around them.
    #[must_use]
    pub fn cells(self, line: &str) -> Vec<&str> {
        let is_quoted = line.contains('"');
        match self {
            Self::Character(character) if !is_quoted => {
                line.split(character).map(str::trim).collect()
            }
            Self::Blanks if !is_quoted => line.split_whitespace().collect(),
            Self::Character(character) => {
                let cells = cut(line, |other| other == character).into_iter();
                cells.map(unquoted).collect()
            }
            Self::Blanks => {
                let cells = cut(line, char::is_whitespace).into_iter();
                let cells = cells.filter(|cell| !cell.is_empty());
                cells.map(unquoted).collect()
            }
        }
    }

    /// The cells of the first line: empty ones at its end are none.
    #[must_use]
    pub fn first_cells(self, line: &str) -> Vec<&str> {
        self.cells_up_to(line, 0)
    }

    /// The cells of another line: empty ones beyond the `width` of the first are none.
    #[must_use]
    pub fn cells_up_to(self, line: &str, width: usize) -> Vec<&str> {
        let mut cells = self.cells(line);
        while cells.len() > width && cells.last().is_some_and(|cell| cell.is_empty()) {
            cells.pop();
        }
        cells
    }
}

/// The characters outside quotation marks, with their bytes; all of them where the marks do not pair.
fn outside_quotes(line: &str) -> impl Iterator<Item = (usize, char)> {
    let is_paired = line.matches('"').count().is_multiple_of(2);
    let mut is_inside = false;
    line.char_indices().filter(move |(_, character)| {
        if *character == '"' && is_paired {
            is_inside = !is_inside;
        }
        !is_inside
    })
}

fn cut(line: &str, is_end: impl Fn(char) -> bool) -> Vec<&str> {
    let mut cells = Vec::new();
    let mut begin = 0;
    for (at, character) in outside_quotes(line) {
        if is_end(character) {
            cells.push(&line[begin..at]);
            begin = at + character.len_utf8();
        }
    }
    cells.push(&line[begin..]);
    cells
}

/// A cell without the blanks and quotation marks around it.
fn unquoted(cell: &str) -> &str {
    let cell = cell.trim();
    cell.strip_prefix('"')
        .and_then(|cell| cell.strip_suffix('"'))
        .map_or(cell, str::trim)
}

/// Why a first line is neither a heading nor numbers.
#[derive(Debug, thiserror::Error)]
pub(in crate::recording) enum FirstLineError {
    #[error("holds separators alone: expected a heading or numbers")]
    Separators,
    #[error(
        "`{0}` begins like a number and is none: expected a number with a decimal point, or a \
         heading that begins with a letter"
    )]
    BeginsLikeNumber(String),
    #[error("`{0}` stands for a missing number: expected a number in every sample, or a heading")]
    Missing(String),
    #[error("`{0}` is neither a number nor a heading")]
    Neither(String),
}

/// Whether the first line is a heading rather than numbers.
///
/// # Errors
/// A line without a number in which a cell begins like one, or that holds no word either.
pub(in crate::recording) fn is_heading(cells: &[&str]) -> Result<bool, FirstLineError> {
    if cells.is_empty() {
        return Err(FirstLineError::Separators);
    }
    if cells.iter().any(|cell| cell.parse::<f64>().is_ok()) {
        return Ok(false);
    }
    if let Some(cell) = cells.iter().find(|cell| begins_like_number(cell)) {
        return Err(FirstLineError::BeginsLikeNumber(shown(cell)));
    }
    let is_missing =
        |cell: &&&str| cell.starts_with('#') || MISSING.contains(&&*cell.to_lowercase());
    if let Some(cell) = cells.iter().find(is_missing) {
        return Err(FirstLineError::Missing(shown(cell)));
    }
    if cells
        .iter()
        .any(|cell| cell.contains(|c: char| c.is_alphabetic() || c == '_'))
    {
        return Ok(true);
    }
    Err(FirstLineError::Neither(shown(cells[0])))
}

/// Whether a digit comes before any letter.
pub(in crate::recording) fn begins_like_number(cell: &str) -> bool {
    let first = cell.chars().find(|c| c.is_alphanumeric() || *c == '_');
    first.is_some_and(char::is_numeric)
}

/// A cell as messages repeat it: the beginning of a long one, nothing that a terminal obeys or hides.
pub(in crate::recording) fn shown(cell: &str) -> String {
    let mut text: String = cell
        .chars()
        .take(SHOWN_CHARACTERS)
        .map(|c| if is_visible(c) { c } else { '\u{fffd}' })
        .collect();
    if cell.chars().nth(SHOWN_CHARACTERS).is_some() {
        text.push_str("...");
    }
    text
}

/// Whether a terminal shows a character and does nothing else with it.
fn is_visible(c: char) -> bool {
    const UNSEEN: [std::ops::RangeInclusive<char>; 5] = [
        '\u{ad}'..='\u{ad}',
        '\u{200b}'..='\u{200f}',
        '\u{2028}'..='\u{202e}',
        '\u{2060}'..='\u{2069}',
        '\u{feff}'..='\u{feff}',
    ];
    !c.is_control() && !UNSEEN.iter().any(|range| range.contains(&c))
}

/// Names as messages list them.
pub(in crate::recording) fn listed(names: &[String]) -> String {
    let first: Vec<String> = names.iter().take(LISTED_MAX).map(|it| shown(it)).collect();
    let more = names.len().saturating_sub(LISTED_MAX);
    let rest = if more > 0 {
        format!(" and {more} more")
    } else {
        String::new()
    };
    first.join(", ") + &rest
}

/// Why a cell is no number of a record.
#[derive(Debug, thiserror::Error)]
pub(in crate::recording) enum NumberError {
    #[error("{0} is beyond the largest number, 1.8e308")]
    TooLarge(String),
    #[error("{0} is not a finite number")]
    NotFinite(f64),
    #[error("`{0}` is not a number: expected a decimal point, or --decimal comma")]
    DecimalComma(String),
    #[error(
        "`{0}` has a point, where the decimal sign of these numbers is a comma: expected digits and one comma"
    )]
    DecimalPoint(String),
    #[error("`{0}` is not a number")]
    Word(String),
}

/// The number of a cell.
///
/// # Errors
/// No number, or none that is finite.
pub(in crate::recording) fn finite(cell: &str) -> Result<f64, NumberError> {
    match cell.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(_) if cell.contains(|c: char| c.is_ascii_digit()) => {
            Err(NumberError::TooLarge(shown(cell)))
        }
        Ok(number) => Err(NumberError::NotFinite(number)),
        Err(_) if cell.contains(',') => Err(NumberError::DecimalComma(shown(cell))),
        Err(_) => Err(NumberError::Word(shown(cell))),
    }
}
