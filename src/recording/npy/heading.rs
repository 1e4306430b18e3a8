//! The heading of an NPY file, versions 1 to 3: a Python dictionary of three known keys.
//!
//! Records of an array may have named fields of numbers; nothing deeper is read.
//!
//! # Source
//! NumPy Enhancement Proposal 1 and `numpy.lib.format`.

use std::fmt;
use std::io::{self, Read};
use std::ops::Range;

use crate::recording::layout::words::WordType;

/// First bytes of every NPY file.
pub(in crate::recording) const MAGIC: &[u8] = b"\x93NUMPY";
/// Longest heading, bytes; that of a plain array has 118.
const HEADING_BYTES_MAX: u32 = 1 << 16;
/// Most fields of a record.
const FIELDS_MAX: usize = 1 << 12;
/// Longest record, bytes.
const RECORD_BYTES_MAX: usize = 1 << 20;
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

/// The heading of an array, of which each word may be a record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::recording) struct ArrayHeading {
    /// That of the array; where it has fields, its words are records.
    pub(in crate::recording) plain: NpyHeading,
    /// Fields of a record; none where words are numbers.
    pub(in crate::recording) fields: Vec<Field>,
}

/// A number of each record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::recording) struct Field {
    pub(in crate::recording) name: String,
    /// What is said of its unit; empty if nothing is.
    pub(in crate::recording) unit: String,
    /// Its type; none if it is no number.
    pub(in crate::recording) kind: Option<NpyHeading>,
    /// Its bytes in the record.
    pub(in crate::recording) bytes: Range<usize>,
}

impl From<NpyHeading> for ArrayHeading {
    fn from(plain: NpyHeading) -> Self {
        Self {
            plain,
            fields: Vec::new(),
        }
    }
}

impl ArrayHeading {
    /// Whether it is a row of numbers, which have no names.
    pub(in crate::recording) fn is_plain_row(&self) -> bool {
        self.plain.columns == 1 && self.fields.is_empty()
    }

    /// What is put behind the name of the array for each of its columns, and what is said of their units.
    pub(super) fn columns(&self) -> Vec<(String, String)> {
        if self.is_plain_row() {
            return vec![(String::new(), String::new())];
        }
        if self.fields.is_empty() {
            let columns =
                (0..self.plain.columns).map(|column| (format!("[{column}]"), String::new()));
            return columns.collect();
        }
        let fields = self.fields.iter();
        fields
            .map(|field| (format!(".{}", field.name), field.unit.clone()))
            .collect()
    }
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
        "its NPY heading is not the dictionary of an array of plain numbers or records of them: expected descr, \
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
pub(in crate::recording) fn read(reader: &mut impl Read) -> Result<ArrayHeading, HeadingError> {
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
    let is_record = matches!(found.descr, Descr::Record(_));
    let (rows, columns, is_turned) = match found.shape[..] {
        [count] => (count, 1, false),
        _ if is_record => return Err(HeadingError::Shape(shape_text(&found.shape))),
        [rows, columns] if columns > 0 && rows >= columns => (rows, columns, false),
        [columns, rows] if columns > 0 && columns <= COLUMNS_OF_TURNED_MAX => (rows, columns, true),
        _ => return Err(HeadingError::Shape(shape_text(&found.shape))),
    };
    if columns > 1 && rows.checked_mul(columns).is_none() {
        return Err(HeadingError::Shape(shape_text(&found.shape)));
    }
    let plain = |(word, word_bytes, is_big_endian)| NpyHeading {
        word,
        word_bytes,
        is_big_endian,
        rows,
        columns,
        is_by_column: columns > 1 && found.is_fortran != is_turned,
        bytes: before + u64::from(length),
    };
    match &found.descr {
        Descr::Number(descr) => Ok(plain(word_of(descr)?).into()),
        Descr::Record(parts) => {
            let (fields, bytes) = fields_of(parts)?;
            Ok(ArrayHeading {
                plain: plain((Word::U1, bytes, false)),
                fields,
            })
        }
    }
}

/// The fields of a record and its bytes. What a field holds more than once are fields with an index; padding,
/// which has no name, is none.
fn fields_of(parts: &[Part]) -> Result<(Vec<Field>, usize), HeadingError> {
    let (mut fields, mut end) = (Vec::new(), 0_usize);
    for Part { name, descr, shape } in parts {
        let unknown = || HeadingError::Word(crate::recording::text::lines::shown(descr));
        let (bytes, unit) = size_of(descr).ok_or_else(unknown)?;
        let count = shape
            .iter()
            .try_fold(1, |count: u64, more| count.checked_mul(*more));
        let count = count.and_then(|count| usize::try_from(count).ok());
        let count = count
            .filter(|count| fields.len() + count <= FIELDS_MAX)
            .ok_or_else(unknown)?;
        let kind = word_of(descr).or_else(|error| match unit {
            // Times are whole numbers of a unit.
            Some(_) => word_of(&format!("{}i8", &descr[..1])),
            None => Err(error),
        });
        let kind = kind
            .ok()
            .map(|(word, word_bytes, is_big_endian)| NpyHeading {
                word,
                word_bytes,
                is_big_endian,
                rows: 0,
                columns: 1,
                is_by_column: false,
                bytes: 0,
            });
        for index in 0..count {
            let field = Field {
                name: match shape.is_empty() {
                    true => name.clone(),
                    false => format!("{name}[{index}]"),
                },
                unit: unit.unwrap_or_default().to_owned(),
                kind,
                bytes: end..end + bytes,
            };
            end = end
                .checked_add(bytes)
                .filter(|end| *end <= RECORD_BYTES_MAX)
                .ok_or_else(unknown)?;
            if !name.is_empty() {
                fields.push(field);
            }
        }
    }
    match end {
        0 => Err(HeadingError::NotADictionary),
        _ => Ok((fields, end)),
    }
}

/// Bytes of a type such as `<f8`, `|S10`, `<U3`, `|V4`, and the unit of one such as `<M8[ns]`; nothing of one that
/// says no size.
fn size_of(descr: &str) -> Option<(usize, Option<&str>)> {
    let kind = descr.get(1..2)?;
    let (digits, unit) = match descr.get(2..)?.split_once('[') {
        Some((digits, unit)) => (digits, Some(unit.strip_suffix(']')?)),
        None => (descr.get(2..)?, None),
    };
    let count: usize = digits.parse().ok()?;
    let letter_bytes = if kind == "U" { 4 } else { 1 };
    let is_known = matches!(
        kind,
        "f" | "i" | "u" | "c" | "b" | "S" | "U" | "V" | "M" | "m"
    );
    let bytes = count.checked_mul(letter_bytes)?;
    is_known.then_some((bytes, unit.filter(|_| matches!(kind, "M" | "m"))))
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

/// What the words of an array are.
enum Descr {
    Number(String),
    Record(Vec<Part>),
}

/// A part of a record as the heading names it.
struct Part {
    name: String,
    descr: String,
    /// Empty of one that holds one number.
    shape: Vec<u64>,
}

/// The three entries.
struct Dictionary {
    descr: Descr,
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
                "descr" => descr.replace(reader.descr()?).is_none(),
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

    /// A type, or the parts of a record: `[('t', '<i8'), ('gyro', '<f4', (3,))]`.
    fn descr(&mut self) -> Option<Descr> {
        if self.take('[').is_none() {
            return Some(Descr::Number(self.string()?.to_owned()));
        }
        let mut parts = Vec::new();
        while self.take(']').is_none() {
            self.take('(')?;
            let name = self.string()?.to_owned();
            self.take(',')?;
            let descr = self.string()?.to_owned();
            let mut shape = Vec::new();
            if self.take(',').is_some() {
                shape = self.tuple()?;
            }
            self.take(')')?;
            parts.push(Part { name, descr, shape });
            if self.take(',').is_none() {
                self.take(']')?;
                break;
            }
        }
        Some(Descr::Record(parts))
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
