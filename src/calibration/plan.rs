//! Whether a plan of mountings and rates determines the parameters, and which it leaves open.

use std::fmt;

use nalgebra::DMatrix;

use super::design::{
    Column, GroupDesign, TemperatureColumns, column_scales, columns, design_matrix,
};
use super::error::{AXES, CalibrationError};
use super::inseparable::{Inseparable, inseparable};
use crate::linear_algebra::singular_value_decomposition;

/// Singular values below this part of the largest, columns brought to a common size, count as none.
///
/// Earth rate beside 90 deg/s is 2.5e-5: an axis that sees nothing else has not been moved.
pub const RANK_TOLERANCE: f64 = 1e-4;

/// What a plan can determine for one gyro.
///
/// With equal errors sigma of the means, batch least squares has the covariance
/// `sigma^2 (A^T A)^-1`: its diagonal gives the standard deviations per sigma without a single sample.
/// The patent's nine groups at 10, 50 and 90 deg/s have condition number 63; the same with rates of
/// both senses, -90, 10 and 90 deg/s, 43, and a bias half as uncertain, as the mean rate of a mounting
/// is then near zero and its bias no longer an extrapolation.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct AxisPlan {
    /// Singular values of the rows `a_i`, descending, in the module's units (deg/s, 1, K).
    pub singular_values: Vec<f64>,
    /// Largest over smallest singular value.
    pub condition_number: f64,
    /// Standard deviation of the gyro's own scale factor per standard error of a group mean in
    /// deg/s, s/deg.
    pub scale_std_per_sigma: f64,
    /// Standard deviation of the bias per standard error of a group mean.
    pub bias_std_per_sigma: f64,
    /// Correlation of the two.
    pub scale_bias_correlation: f64,
}

/// A plan that determines every parameter.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PlanReport {
    /// Groups of the plan.
    pub groups: usize,
    /// Rank of the rows, equal to the unknowns of a gyro.
    pub rank: usize,
    /// Gyros x, y, z; they differ where thermometers do and in which rate is their own.
    pub axes: [AxisPlan; 3],
}

/// A plan that leaves parameters open.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanDefect {
    /// Groups of the plan.
    pub groups: usize,
    /// Unknowns of each gyro.
    pub unknowns: usize,
    /// Rank of the rows.
    pub rank: usize,
    /// Singular values of the rows of the first gyro that is short of rank.
    pub singular_values: Vec<f64>,
    /// What cannot be told apart, and why; one entry per missing rank.
    pub inseparable: Vec<Inseparable>,
}

impl fmt::Display for PlanDefect {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            out,
            "{} groups have rank {} for {} unknowns per gyro",
            self.groups, self.rank, self.unknowns
        )?;
        for open in &self.inseparable {
            write!(out, "; {}: missing {}", open.reason, open.missing)?;
        }
        Ok(())
    }
}

/// Rank, condition and predicted spread of a plan.
///
/// * `groups`: rates and temperatures of the plan, measured or intended.
/// * `reference_temperature_c`: temperature at which bias and scale factor are to be given, of the
///   gyros x, y, z; without temperature columns it has no effect.
///
/// # Errors
/// [`CalibrationError::Unobservable`] with what cannot be told apart and the missing motion in words.
///
/// # Source
/// Rows of the patent's equation (12). Known answers: `patent_plan_…`.
pub fn check_plan(
    groups: &[GroupDesign],
    temperature: TemperatureColumns,
    reference_temperature_c: [f64; 3],
) -> Result<PlanReport, CalibrationError> {
    let model = columns(temperature);
    let [x, y, z] = [0, 1, 2].map(|axis: usize| {
        let design = design_matrix(groups, &model, axis, reference_temperature_c[axis]);
        check_axis(&design, &model, axis)
    });
    Ok(PlanReport {
        groups: groups.len(),
        rank: model.len(),
        axes: [x?, y?, z?],
    })
}

/// Rank, condition and spread for one gyro.
///
/// Rank is judged on columns of a common size; singular values and condition number are those of the
/// rows as they stand, in deg/s, as tables print them.
fn check_axis(
    design: &DMatrix<f64>,
    model: &[Column],
    axis: usize,
) -> Result<AxisPlan, CalibrationError> {
    let unresolved = CalibrationError::Unresolved { axis: AXES[axis] };
    let singular_values = descending(design).ok_or(unresolved.clone())?;
    let mut scaled = design.clone();
    for (mut column, scale) in scaled.column_iter_mut().zip(column_scales(design, model)) {
        column /= scale;
    }
    let open = inseparable(&scaled, model, RANK_TOLERANCE).ok_or(unresolved.clone())?;
    if !open.is_empty() {
        return Err(CalibrationError::Unobservable(PlanDefect {
            groups: design.nrows(),
            unknowns: model.len(),
            rank: model.len() - open.len(),
            singular_values,
            inseparable: open,
        }));
    }
    let inverse = inverse_normal(design).ok_or(unresolved)?;
    let (scale, bias) = (inverse[(axis, axis)].sqrt(), inverse[(3, 3)].sqrt());
    Ok(AxisPlan {
        condition_number: singular_values[0] / singular_values[singular_values.len() - 1],
        singular_values,
        scale_std_per_sigma: scale,
        bias_std_per_sigma: bias,
        scale_bias_correlation: inverse[(axis, 3)] / (scale * bias),
    })
}

/// `(A^T A)^-1` through the triangular factor; nothing for designs short of rank.
fn inverse_normal(design: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let size = design.ncols();
    let inverse = design
        .clone()
        .qr()
        .r()
        .solve_upper_triangular(&DMatrix::identity(size, size))?;
    Some(&inverse * inverse.transpose())
}

/// Singular values, descending; as many as the shorter side. Nothing if they cannot be found.
pub(super) fn descending(matrix: &DMatrix<f64>) -> Option<Vec<f64>> {
    if matrix.is_empty() {
        return Some(Vec::new());
    }
    let decomposition = singular_value_decomposition(matrix.clone(), false, false)?;
    Some(decomposition.singular_values.iter().copied().collect())
}
