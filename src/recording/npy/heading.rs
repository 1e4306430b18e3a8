//! The heading of an NPY file, versions 1 to 3: a Python dictionary of three known keys.
//!
//! Nothing is nested in the heading of an array of plain numbers, so nothing deeper is read.
//!
//! # Source
//! NumPy Enhancement Proposal 1 and `numpy.lib.format`.

use std::fmt;
use std::io::{self, Read};

use crate::recording::layout::words::WordType;

/// First bytes of every NPY file.
pub(in crate::recording) const MAGIC: &[u8] = b"\x93NUMPY";
/// Longest heading, bytes; that of a plain array has 118.
const HEADING_BYTES_MAX: u32 = 1 << 16;
/// Most quantities of an array that has a sample in each column.
const COLUMNS_OF_TURNED_MAX: u64 = 64;

/// Kind and size of the numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::recording) enum Word {
    F2,
    F4,
    F8,
    I1,
    I2,
    I4,
    I8,
    U1,
    U2,
    U4,
    U8,
}

/// Words by the letters that name them.
const WORDS: [(&str, Word, usize); 11] = [
    ("f2", Word::F2, 2),
    ("f4", Word::F4, 4),
    ("f8", Word::F8, 8),
    ("i1", Word::I1, 1),
    ("i2", Word::I2, 2),
    ("i4", Word::I4, 4),
    ("i8", Word::I8, 8),
    ("u1", Word::U1, 1),
    ("u2", Word::U2, 2),
    ("u4", Word::U4, 4),
    ("u8", Word::U8, 8),
];

/// End of the name of a type whose high byte comes first.
const HIGH_BYTE_FIRST: &str = "-be";

/// What stands before the numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::recording) struct NpyHeading {
    pub(in crate::recording) word: Word,
    /// Bytes of a number.
    pub(in crate::recording) word_bytes: usize,
    pub(in crate::recording) is_big_endian: bool,
    /// Samples.
    pub(in crate::recording) rows: u64,
    /// Numbers of a sample.
    pub(in crate::recording) columns: u64,
    /// Whether all numbers of a column stand together.
    pub(in crate::recording) is_by_column: bool,
    /// Bytes of the file before the first number.
    pub(in crate::recording) bytes: u64,
}

/// Why there is no heading.
#[derive(Debug, thiserror::Error)]
pub(in crate::recording) enum HeadingError {
    #[error("{0}")]
    Io(io::Error),
    #[error("not a whole NPY file: its heading is cut short")]
    CutShort,
    #[error("an NPY file of version {0}: expected 1, 2 or 3")]
    Version(u8),
    #[error("its NPY heading has {0} bytes: allowed up to {HEADING_BYTES_MAX}")]
    TooLong(u32),
    #[error("its NPY heading is no text in UTF-8")]
    NotText,
    #[error(
        "its NPY heading is not the dictionary of an array of plain numbers: expected descr, \
         fortran_order and shape"
    )]
    NotADictionary,
    #[error(
        "holds numbers of type '{0}': expected binary64 (f8), binary32 (f4), binary16 (f2), or integers i1 \
         to i8 or u1 to u8, little- or big-endian"
    )]
    Word(String),
    #[error("holds an array of shape {0}: expected one dimension, or two of samples and columns")]
    Shape(String),
}

impl From<io::Error> for HeadingError {
    fn from(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::UnexpectedEof {
            return Self::CutShort;
        }
        Self::Io(error)
    }
}

impl NpyHeading {
    /// Numbers of the array; of one that no machine holds, the largest count there is.
    pub(in crate::recording) fn count(&self) -> u64 {
        self.rows.saturating_mul(self.columns)
    }
}

impl fmt::Display for NpyHeading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let order = if self.is_by_column {
            "column by column"
        } else {
            "row by row"
        };
        write!(f, "an array of {} columns, {order}", self.columns)
    }
}

impl NpyHeading {
    /// That of words that stand alone, so many at most.
    pub(in crate::recording) fn of_words(dtype: WordType, rows: u64) -> Self {
        let name = dtype.word();
        let letters = name.trim_end_matches(HIGH_BYTE_FIRST);
        let found = WORDS.iter().find(|(known, _, _)| *known == letters);
        let (_, word, word_bytes) = *found.unwrap_or(&WORDS[0]);
        Self {
            word,
            word_bytes,
            is_big_endian: name.ends_with(HIGH_BYTE_FIRST),
            rows,
            columns: 1,
            is_by_column: false,
            bytes: 0,
        }
    }
}

/// Reads the heading of an array of one dimension, or of two.
///
/// An array of fewer rows than columns has a sample in each column: there are more samples than quantities.
///
/// # Errors
/// A file cut short, another version, a heading too long or of another form, another shape or type.
pub(in crate::recording) fn read(reader: &mut impl Read) -> Result<NpyHeading, HeadingError> {
    let mut start = [0; 8];
    reader.read_exact(&mut start)?;
    let (length, before) = match start[6] {
        1 => {
            let mut length = [0; 2];
            reader.read_exact(&mut length)?;
            (u32::from(u16::from_le_bytes(length)), 10)
        }
        2 | 3 => {
            let mut length = [0; 4];
            reader.read_exact(&mut length)?;
            (u32::from_le_bytes(length), 12)
        }
        version => return Err(HeadingError::Version(version)),
    };
    if length > HEADING_BYTES_MAX {
        return Err(HeadingError::TooLong(length));
    }
    let mut text = vec![0; length as usize];
    reader.read_exact(&mut text)?;
    let text = std::str::from_utf8(&text).map_err(|_| HeadingError::NotText)?;
    let found = Dictionary::of(text).ok_or(HeadingError::NotADictionary)?;
    let (word, word_bytes, is_big_endian) = word_of(&found.descr)?;
    let (rows, columns, is_turned) = match found.shape[..] {
        [count] => (count, 1, false),
        [rows, columns] if columns > 0 && rows >= columns => (rows, columns, false),
        [columns, rows] if columns > 0 && columns <= COLUMNS_OF_TURNED_MAX => (rows, columns, true),
        _ => return Err(HeadingError::Shape(shape_text(&found.shape))),
    };
    if columns > 1 && rows.checked_mul(columns).is_none() {
        return Err(HeadingError::Shape(shape_text(&found.shape)));
    }
    Ok(NpyHeading {
        word,
        word_bytes,
        is_big_endian,
        rows,
        columns,
        is_by_column: columns > 1 && found.is_fortran != is_turned,
        bytes: before + u64::from(length),
    })
}

/// Kind, bytes and byte order of a type such as `<f8`.
fn word_of(descr: &str) -> Result<(Word, usize, bool), HeadingError> {
    let found = descr.get(1..).and_then(|name| {
        let (_, word, bytes) = WORDS.iter().find(|(known, _, _)| *known == name)?;
        let is_big_endian = match &descr[..1] {
            "<" => false,
            ">" => true,
            "|" if *bytes == 1 => false,
            _ => return None,
        };
        Some((*word, *bytes, is_big_endian))
    });
    found.ok_or_else(|| HeadingError::Word(crate::recording::text::lines::shown(descr)))
}

/// A shape as Python writes it; of a long one the beginning.
fn shape_text(shape: &[u64]) -> String {
    const SHOWN: usize = 8;
    let first: Vec<String> = shape.iter().take(SHOWN).map(u64::to_string).collect();
    let rest = if shape.len() > SHOWN { ", ..." } else { "" };
    format!("[{}{rest}]", first.join(", "))
}

/// The three entries.
struct Dictionary {
    descr: String,
    shape: Vec<u64>,
    is_fortran: bool,
}

impl Dictionary {
    fn of(text: &str) -> Option<Self> {
        let mut reader = Reader(text);
        let (mut descr, mut shape, mut order) = (None, None, None);
        reader.take('{')?;
        while reader.take('}').is_none() {
            let key = reader.string()?;
            reader.take(':')?;
            let is_new = match key {
                "descr" => descr.replace(reader.string()?.to_owned()).is_none(),
                "shape" => shape.replace(reader.tuple()?).is_none(),
                "fortran_order" => order.replace(reader.truth()?).is_none(),
                _ => false,
            };
            if !is_new {
                return None;
            }
            if reader.take(',').is_none() {
                reader.take('}')?;
                break;
            }
        }
        reader.is_at_end().then_some(Self {
            descr: descr?,
            shape: shape?,
            is_fortran: order?,
        })
    }
}

/// What is left of a heading.
struct Reader<'a>(&'a str);

impl<'a> Reader<'a> {
    fn take(&mut self, wanted: char) -> Option<()> {
        self.0 = self.0.trim_start().strip_prefix(wanted)?;
        Some(())
    }

    fn is_at_end(&self) -> bool {
        self.0.trim().is_empty()
    }

    fn string(&mut self) -> Option<&'a str> {
        let text = self.0.trim_start();
        let quote = text.chars().next().filter(|c| matches!(c, '\'' | '"'))?;
        let (inside, rest) = text[1..].split_once(quote)?;
        self.0 = rest;
        (!inside.contains('\\')).then_some(inside)
    }

    fn truth(&mut self) -> Option<bool> {
        let text = self.0.trim_start();
        let (truth, rest) = text
            .strip_prefix("True")
            .map(|rest| (true, rest))
            .or_else(|| Some((false, text.strip_prefix("False")?)))?;
        self.0 = rest;
        Some(truth)
    }

    /// Whole numbers in parentheses; Python 2 put an `L` behind long ones.
    fn tuple(&mut self) -> Option<Vec<u64>> {
        let mut numbers = Vec::new();
        self.take('(')?;
        while self.take(')').is_none() {
            let text = self.0.trim_start();
            let digits = text.len() - text.trim_start_matches(|c: char| c.is_ascii_digit()).len();
            numbers.push(text[..digits].parse().ok()?);
            self.0 = text[digits..].trim_start_matches('L');
            if self.take(',').is_none() {
                self.take(')')?;
                break;
            }
        }
        Some(numbers)
    }
}
