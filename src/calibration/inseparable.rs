//! The null space of a plan in words: what cannot be told apart, and which motion is missing.
//!
//! A plan of rows `a_i` cannot tell x from `x + n` if `a_i n = 0` for every group: n is then a null
//! vector of the design. Its non-zero entries say which columns, hence which parameters, take part:
//!
//! | null vector | plan | in words |
//! |---|---|---|
//! | `Wz` alone | no mounting c | the third column of XA has no effect |
//! | `Wx`, `Wy`, `Wz`, 1 | one rate w only | a bias b is the same as b / w in all three |
//! | `Wx`, 1 | x at one rate, y and z at two | the same for x alone |
//! | `Wx`, `Wy` | tilted case, never turned about one alone | their sum is seen, not their parts |
//! | 1, T | constant temperature | bias and its coefficient are one |
//!
//! Singular vectors of a null space of several dimensions are any mixture of these. Elimination with
//! pivoting (`reduce`) turns them into vectors of few columns that can be put into words.

use nalgebra::DMatrix;

use super::design::Column;
use super::error::AXES;
use crate::linear_algebra::singular_value_decomposition;

/// One direction in which the parameters may move without any output changing.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Inseparable {
    /// Columns that take part.
    pub columns: Vec<Column>,
    /// Parameters that cannot be separated, named as in `PARAMETER_NAMES` or after their column.
    pub parameters: Vec<&'static str>,
    /// Why.
    pub reason: String,
    /// The group that would help.
    pub missing: String,
}

/// Null vectors of a design with columns of a common size, each in words; empty at full rank.
///
/// Columns of nothing are named first, then the null space of the others, reduced so that each
/// vector has as few columns as the others allow. Nothing if the null space cannot be found.
pub(super) fn inseparable(
    scaled: &DMatrix<f64>,
    model: &[Column],
    tolerance: f64,
) -> Option<Vec<Inseparable>> {
    let size = |index: usize| {
        let column = scaled.column(index);
        if column.is_empty() {
            0.0
        } else {
            column.amax()
        }
    };
    let (still, moved): (Vec<usize>, Vec<usize>) =
        (0..model.len()).partition(|index| size(*index) < tolerance);
    let mut open: Vec<Inseparable> = still
        .iter()
        .map(|index| describe(&[model[*index]]))
        .collect();
    let kept = scaled.select_columns(moved.iter());
    for vector in null_vectors(&kept, tolerance)? {
        let parts: Vec<Column> = moved
            .iter()
            .zip(&vector)
            .filter(|(_, weight)| weight.abs() > 10.0 * tolerance)
            .map(|(index, _)| model[*index])
            .collect();
        open.push(describe(&parts));
    }
    Some(open)
}

/// A reduced basis of the null space: singular values below `tolerance` of the largest.
fn null_vectors(matrix: &DMatrix<f64>, tolerance: f64) -> Option<Vec<Vec<f64>>> {
    let width = matrix.ncols();
    if width == 0 {
        return Some(Vec::new());
    }
    // Rows of zeros give every column its right singular vector.
    let square = matrix
        .clone()
        .resize_vertically(matrix.nrows().max(width), 0.0);
    let decomposition = singular_value_decomposition(square, false, true)?;
    let vectors = decomposition.v_t?;
    let largest = decomposition.singular_values.amax();
    let mut basis: Vec<Vec<f64>> = decomposition
        .singular_values
        .iter()
        .zip(vectors.row_iter())
        .filter(|(value, _)| **value <= tolerance * largest)
        .map(|(_, row)| row.iter().copied().collect())
        .collect();
    reduce(&mut basis);
    Some(basis)
}

/// Makes the vectors sparse: each is the only one with an entry at its pivot.
///
/// Gauss-Jordan elimination with the largest remaining entry of each row as its pivot.
fn reduce(basis: &mut [Vec<f64>]) {
    for pivot_row in 0..basis.len() {
        let pivot = (0..basis[pivot_row].len())
            .max_by(|a, b| {
                basis[pivot_row][*a]
                    .abs()
                    .total_cmp(&basis[pivot_row][*b].abs())
            })
            .unwrap_or_default();
        let head = basis[pivot_row][pivot];
        let row: Vec<f64> = basis[pivot_row].iter().map(|value| value / head).collect();
        for (index, other) in basis.iter_mut().enumerate() {
            if index == pivot_row {
                other.clone_from(&row);
            } else {
                let factor = other[pivot];
                for (value, subtract) in other.iter_mut().zip(&row) {
                    *value -= factor * subtract;
                }
            }
        }
    }
}

/// Parameters that are coefficients of a column.
fn parameters(column: Column) -> &'static [&'static str] {
    match column {
        Column::Rate(0) => &["K_gx", "th_gyz", "th_gzy"],
        Column::Rate(1) => &["K_gy", "th_gxz", "th_gzx"],
        Column::Rate(_) => &["K_gz", "th_gxy", "th_gyx"],
        Column::One => &["B_gx", "B_gy", "B_gz"],
        Column::Temperature => &["temperature coefficient of bias"],
        Column::TemperatureRate => &["temperature-rate coefficient of bias"],
        Column::TemperatureTimesRate => &["temperature coefficient of the scale factor"],
    }
}

/// A null vector in words, from the columns that take part in it.
fn describe(parts: &[Column]) -> Inseparable {
    let names: Vec<&'static str> = parts
        .iter()
        .flat_map(|column| parameters(*column).iter().copied())
        .collect();
    let about: Vec<&'static str> = parts
        .iter()
        .filter_map(|column| match column {
            Column::Rate(axis) => Some(AXES[*axis]),
            _ => None,
        })
        .collect();
    let has = |column| parts.contains(&column);
    let is_thermal = has(Column::Temperature) || has(Column::TemperatureRate);
    let (reason, missing) = if has(Column::TemperatureTimesRate) || is_thermal {
        thermal_words(parts, &about)
    } else {
        motion_words(&about, has(Column::One), &names)
    };
    Inseparable {
        columns: parts.to_vec(),
        parameters: names,
        reason,
        missing,
    }
}

/// Words for null vectors of rates and the bias.
fn motion_words(about: &[&str], has_bias: bool, names: &[&str]) -> (String, String) {
    match (about, has_bias) {
        ([axis], false) => (
            format!(
                "no motion about {axis}: {} have no effect on any output",
                listed(names)
            ),
            format!("a mounting with {axis} along the table axis, turned at a known rate"),
        ),
        ([axis], true) => (
            format!(
                "bias and scale factor of the {axis} input cannot be separated: the rate about \
                 {axis} is the same in every group"
            ),
            format!("a group with another rate about {axis}: rates along {axis} must differ"),
        ),
        ([], _) => (
            "there is no group, so not even a bias".to_owned(),
            "groups in three mountings, one of them at two rates".to_owned(),
        ),
        (axes, true) => {
            let axes = listed(axes);
            (
                format!(
                    "bias and scale factors of the {axes} inputs cannot be separated: every mounting \
                     was turned at one and the same rate"
                ),
                format!("a second rate in one mounting: rates along {axes} must differ"),
            )
        }
        (axes, false) => {
            let axes = listed(axes);
            (
                format!(
                    "the rates about {axes} keep one ratio in every group, so that {} cannot be \
                     separated",
                    listed(names)
                ),
                format!("groups that turn about only one of {axes}"),
            )
        }
    }
}

/// Words for null vectors in which a temperature column takes part.
fn thermal_words(parts: &[Column], about: &[&str]) -> (String, String) {
    let has = |column| parts.contains(&column);
    let both = has(Column::Temperature) && has(Column::TemperatureRate);
    if both {
        return (
            "temperature and its rate run along with each other, as in a warm-up of one exponential"
                .to_owned(),
            "groups at another course of temperature, or one of the two columns less".to_owned(),
        );
    }
    if has(Column::TemperatureTimesRate) {
        return (
            "the temperature is tied to the rate about the gyro's own axis: the scale factor and its \
             temperature coefficient cannot be separated"
                .to_owned(),
            "a repetition of that axis at another temperature, or no such column".to_owned(),
        );
    }
    if about.is_empty() {
        return (
            "the temperature, or its rate, is the same in every group: bias and its temperature \
             coefficient cannot be separated"
                .to_owned(),
            "groups at different temperatures, or no temperature column".to_owned(),
        );
    }
    let axes = listed(about);
    (
        format!(
            "the temperature follows the rates about {axes}: its effect and theirs cannot be separated"
        ),
        "a mounting and rate repeated at another temperature, or no temperature column".to_owned(),
    )
}

/// `a`, `a and b`, `a, b and c`.
fn listed(words: &[&str]) -> String {
    match words {
        [] => String::new(),
        [only] => (*only).to_owned(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}
