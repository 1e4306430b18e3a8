//! One-dimensional NPY files of binary64, binary32 or signed integers of 32 or 64 bits.

use std::path::Path;

use npyz::{DType, Deserialize, NpyFile, TypeChar};

use super::column::{Column, Columns};
use super::error::{LogError, Place};

/// First bytes of every NPY file.
pub(super) const MAGIC: &[u8] = b"\x93NUMPY";

/// Largest integer that binary64 holds with all below it.
const INTEGER_MAX: i64 = 1 << 53;

/// Reads the array of a file.
///
/// # Errors
/// Another shape or number type, a file cut short, an integer beyond binary64.
pub(super) fn read(path: &Path, bytes: &[u8]) -> Result<Columns, LogError> {
    let broken = |error: &dyn std::fmt::Display| {
        LogError::of_file(path, format!("not a whole NPY file: {error}"))
    };
    let file = NpyFile::new(bytes).map_err(|error| broken(&error))?;
    let shape = file.shape().to_vec();
    let [count] = shape[..] else {
        let message = format!(
            "holds an array of shape {shape:?}: expected one dimension, one number a sample"
        );
        return Err(LogError::of_file(path, message));
    };
    let dtype = file.dtype();
    let found = dtype.descr();
    let unknown = || {
        let message = format!(
            "holds numbers of type {found}: expected binary64 (f8), binary32 (f4), or integers i4 \
             or i8, little- or big-endian"
        );
        LogError::of_file(path, message)
    };
    let DType::Plain(word) = &dtype else {
        return Err(unknown());
    };
    let size = word.size_field();
    // Before anything is set aside for a count that the file only claims.
    if count.saturating_mul(size) > bytes.len() as u64 {
        return Err(broken(&format!(
            "its heading names {count} numbers of {size} bytes, the file has {} bytes",
            bytes.len()
        )));
    }
    let values = match (word.type_char(), size) {
        (TypeChar::Float, 8) => numbers::<f64>(file).map_err(|error| broken(&error))?,
        (TypeChar::Float, 4) => {
            let words = numbers::<f32>(file).map_err(|error| broken(&error))?;
            words.into_iter().map(f64::from).collect()
        }
        (TypeChar::Int, 4) => {
            let words = numbers::<i32>(file).map_err(|error| broken(&error))?;
            words.into_iter().map(f64::from).collect()
        }
        (TypeChar::Int, 8) => {
            let words = numbers::<i64>(file).map_err(|error| broken(&error))?;
            integers(path, &words)?
        }
        _ => return Err(unknown()),
    };
    Ok(Columns {
        data: Column { name: None, values },
        ..Columns::default()
    })
}

fn numbers<T: Deserialize>(file: NpyFile<&[u8]>) -> std::io::Result<Vec<T>> {
    file.into_vec()
}

fn integers(path: &Path, words: &[i64]) -> Result<Vec<f64>, LogError> {
    let in_range = |word: &i64| (-INTEGER_MAX..=INTEGER_MAX).contains(word);
    if let Some(index) = words.iter().position(|word| !in_range(word)) {
        let message = format!(
            "{} lies beyond 2^53, the largest count that is kept exactly",
            words[index]
        );
        return Err(LogError::at(path, Place::Index(index), message));
    }
    #[expect(clippy::cast_precision_loss, reason = "checked to lie within 2^53")]
    let values = words.iter().map(|&word| word as f64).collect();
    Ok(values)
}
