//! A recorded stimulus: one column of numbers, NPY or text.

use std::fs;
use std::path::Path;

/// Reads at most `samples` numbers.
///
/// Text: one number a line; empty lines, lines that begin with `#` and a first line that is no
/// number (a heading) are passed over.
///
/// # Errors
/// What is wrong, with file and line (text) or index (NPY).
pub(super) fn read(path: &Path, samples: usize) -> Result<Vec<f64>, String> {
    let shown = path.display();
    let bytes = fs::read(path).map_err(|error| format!("cannot read {shown}: {error}"))?;
    let numbers = if bytes.starts_with(b"\x93NUMPY") {
        from_npy(&bytes, samples).map_err(|error| format!("{shown}: {error}"))?
    } else {
        let text = std::str::from_utf8(&bytes)
            .map_err(|_| format!("{shown}: neither NPY nor UTF-8 text"))?;
        from_text(text, samples).map_err(|(line, error)| format!("{shown}:{line}: {error}"))?
    };
    if numbers.is_empty() {
        return Err(format!("{shown}: holds no sample"));
    }
    Ok(numbers)
}

fn from_npy(bytes: &[u8], samples: usize) -> Result<Vec<f64>, String> {
    let file = npyz::NpyFile::new(bytes).map_err(|error| error.to_string())?;
    if file.shape().len() != 1 {
        return Err(format!(
            "holds an array of shape {:?}: expected one dimension",
            file.shape()
        ));
    }
    let numbers: Vec<f64> = file
        .into_vec()
        .map_err(|error| format!("expected binary64 numbers (dtype <f8): {error}"))?;
    let taken: Vec<f64> = numbers.into_iter().take(samples).collect();
    match taken.iter().position(|number| !number.is_finite()) {
        Some(index) => Err(format!(
            "index {index}: {} is not a finite number",
            taken[index]
        )),
        None => Ok(taken),
    }
}

fn from_text(text: &str, samples: usize) -> Result<Vec<f64>, (usize, String)> {
    let mut numbers = Vec::new();
    let mut is_first = true;
    for (index, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        if numbers.len() == samples {
            break;
        }
        match line.parse::<f64>() {
            Ok(number) if number.is_finite() => numbers.push(number),
            Ok(number) => return Err((index + 1, format!("{number} is not a finite number"))),
            Err(_) if is_first => {}
            Err(_) => {
                return Err((
                    index + 1,
                    format!("`{line}` is not a number: expected one column"),
                ));
            }
        }
        is_first = false;
    }
    Ok(numbers)
}
