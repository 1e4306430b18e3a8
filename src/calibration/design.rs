//! What a group of samples says about the unknowns: the rows of the regression.

use nalgebra::DMatrix;

/// The known side of one group of samples (one mounting, one constant rate).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GroupDesign {
    /// Mean inertial rate about the case axes x, y, z, deg/s.
    pub reference_rate_deg_per_s: [f64; 3],
    /// Mean temperature of the gyros x, y, z, deg C (one thermometer: three times the same).
    pub temperature_c: [f64; 3],
    /// Mean rate of these temperatures, K/min; used by [`TemperatureColumns::bias_rate`] alone.
    pub temperature_rate_k_per_min: [f64; 3],
}

impl GroupDesign {
    /// A group at the given rates; temperatures 0, for plans that ignore them.
    #[must_use]
    pub fn at_rate(reference_rate_deg_per_s: [f64; 3]) -> Self {
        Self {
            reference_rate_deg_per_s,
            ..Self::default()
        }
    }
}

/// What the model lets depend on temperature, each an unknown more per gyro.
///
/// The model of gyro i with all three is
///
/// ```text
/// Wm_i = XA_i W + B_i + b_i (T_i - T_ref) + d_i dT_i/dt + k_i (T_i - T_ref) W_i
/// ```
///
/// In a warm-up of one exponential `dT/dt` is proportional to `T_end - T`, and the Shupe term d is
/// then already in the bias column: both together leave a plan without full rank. A temperature
/// coefficient k of the scale factor, 10 ppm/K say, is 36 deg/h over 11 K at 90 deg/s; only its own
/// column removes it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TemperatureColumns {
    /// Bias linear in the temperature.
    pub bias: bool,
    /// Bias linear in the rate of the temperature (Shupe effect).
    pub bias_rate: bool,
    /// Scale factor linear in the temperature: `T W` of the gyro's own axis.
    pub scale: bool,
}

impl TemperatureColumns {
    /// The patent's twelve parameters and no more.
    pub const NONE: Self = Self {
        bias: false,
        bias_rate: false,
        scale: false,
    };
    /// Bias linear in the temperature.
    pub const BIAS: Self = Self {
        bias: true,
        ..Self::NONE
    };
}

/// One column of the regression of one gyro.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Column {
    /// Rate about a case axis, 0 to 2; its coefficients are one column of `XA`.
    Rate(usize),
    /// The constant 1; its coefficient is the bias at the reference temperature.
    One,
    /// Temperature minus the reference temperature.
    Temperature,
    /// Rate of the temperature.
    TemperatureRate,
    /// Temperature minus its reference, times the rate about the gyro's own axis.
    TemperatureTimesRate,
}

/// Columns of the model in order; the first four are the patent's.
pub(super) fn columns(temperature: TemperatureColumns) -> Vec<Column> {
    let mut columns = vec![
        Column::Rate(0),
        Column::Rate(1),
        Column::Rate(2),
        Column::One,
    ];
    if temperature.bias {
        columns.push(Column::Temperature);
    }
    if temperature.bias_rate {
        columns.push(Column::TemperatureRate);
    }
    if temperature.scale {
        columns.push(Column::TemperatureTimesRate);
    }
    columns
}

/// Rows `a_i` of gyro `axis` for all groups, `[groups, columns]` (equation 12 and its extension).
pub(super) fn design_matrix(
    groups: &[GroupDesign],
    columns: &[Column],
    axis: usize,
    reference_temperature_c: f64,
) -> DMatrix<f64> {
    DMatrix::from_fn(groups.len(), columns.len(), |row, column| {
        let group = &groups[row];
        let warmer_k = group.temperature_c[axis] - reference_temperature_c;
        match columns[column] {
            Column::Rate(about) => group.reference_rate_deg_per_s[about],
            Column::One => 1.0,
            Column::Temperature => warmer_k,
            Column::TemperatureRate => group.temperature_rate_k_per_min[axis],
            Column::TemperatureTimesRate => warmer_k * group.reference_rate_deg_per_s[axis],
        }
    })
}

/// Factors that bring the columns to a common size before their rank is judged.
///
/// Singular values compare columns of different units (deg/s, 1, K): without a common size a bias
/// column of ones beside rates of 90 deg/s would look nearly absent, and a change of unit would
/// change the verdict.
///
/// Rates share the largest rate of all, so that an axis that sees nothing but Earth rate counts as
/// not moved; each other column has its own largest value. A column of zeros keeps factor 1.
pub(super) fn column_scales(design: &DMatrix<f64>, columns: &[Column]) -> Vec<f64> {
    let largest = |index: usize| design.column(index).amax();
    let rate = largest(0).max(largest(1)).max(largest(2));
    let scales = columns.iter().enumerate().map(|(index, column)| {
        let size = match column {
            Column::Rate(_) => rate,
            _ => largest(index),
        };
        if size > 0.0 { size } else { 1.0 }
    });
    scales.collect()
}
