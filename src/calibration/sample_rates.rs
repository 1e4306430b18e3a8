//! Calibration at the sensor's rate: least squares on every sample with the rate that an encoder shows.
//!
//! Group means leave the table's changes of rate out and want whole turns. With the true rate of every sample
//! neither is needed: the row of a sample is `[Wx Wy Wz 1 (T - T0) -dW/dt]`, the last one of the gyro's own
//! axis, whose coefficient is how long the word comes after the reading of the encoder. Everything else is the
//! model of the group means of this room.
//!
//! The covariance is that of least squares under white noise whose density is the one that means of the
//! residuals over 20 s have, so that a drift within these is not taken for many independent samples. A sandwich of
//! clustered rows, which asks for no law of the noise, rests on the few stretches in which a parameter shows:
//! it came out too small (a normalised error squared of 16.2 in the mean over 60 campaigns in place of 12; now 13.5,
//! as that of group means whose noise is known).

use nalgebra::{SMatrix, SVector};

use super::error::{AXES, CalibrationError};
use super::error_model::ErrorParameters;
use super::observations::GroupObservation;
use super::result::{AxisCoefficients, Calibration, SampleFindings, TemperatureCoefficients};
use crate::linear_algebra::singular_value_decomposition;

/// Unknowns of a gyro: three sensitivities, bias, its coefficient of temperature, delay.
const UNKNOWNS: usize = 6;
/// Of them the twelve parameters' share.
const PARAMETERS: usize = 4;
/// Place of the coefficient of temperature.
const TEMPERATURE: usize = 4;
/// Place of the delay.
const DELAY: usize = 5;
/// Time whose residuals may be correlated, s.
const STRETCH_S: f64 = 20.0;
/// Stretches whose scatter a covariance takes, at least: a few more than the unknowns.
const STRETCHES_MIN: usize = 12;
/// Factor from the median absolute deviation of a normal distribution to its standard deviation.
const MAD_TO_STD: f64 = 1.4826;

type Row = SVector<f64, UNKNOWNS>;
type Square = SMatrix<f64, UNKNOWNS, UNKNOWNS>;

/// One sample of an assembly on a table with an encoder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateSample {
    /// True mean rates about the case axes over the sample, deg/s.
    pub rate_deg_per_s: [f64; 3],
    /// Their change, deg/s^2.
    pub acceleration_deg_per_s2: [f64; 3],
    /// Temperature of the gyros, deg C.
    pub temperature_c: f64,
    /// Outputs of the gyros x, y, z, deg/s.
    pub output_deg_per_s: [f64; 3],
}

/// How samples are calibrated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleSettings {
    /// Sample period, s.
    pub sample_period_s: f64,
    /// Temperature that the biases are told at, deg C.
    pub reference_temperature_c: f64,
    /// Whether the biases have coefficients of temperature; else they are those of the record.
    pub fits_temperature: bool,
    /// Residuals beyond this many robust standard deviations are left out; none keeps all.
    pub outlier_threshold: Option<f64>,
}

impl SampleSettings {
    /// Kelvins above the reference; 0 where the biases have no coefficient.
    fn warmer_k(&self, temperature_c: f64) -> f64 {
        if self.fits_temperature {
            temperature_c - self.reference_temperature_c
        } else {
            0.0
        }
    }
}

/// Solution of one gyro.
struct AxisFit {
    solution: Row,
    covariance: Square,
    condition_number: f64,
    rejected: usize,
}

/// Calibrates an assembly from samples.
///
/// * `samples`: in the order of time; those around a new mounting left out.
/// * `groups`: means that the residuals are reported for; they take no part in the fit.
///
/// # Errors
/// [`CalibrationError::SamplesUndetermined`] where the motion does not determine a gyro's parameters, or the
/// record is shorter than four minutes.
pub fn estimate_samples(
    samples: &[RateSample],
    groups: &[GroupObservation],
    settings: &SampleSettings,
) -> Result<Calibration, CalibrationError> {
    let fits = [0, 1, 2].map(|axis| fit_axis(samples, axis, settings));
    let [x, y, z] = fits;
    let fits = [x?, y?, z?];
    let mut vector = [0.0; 12];
    let mut covariance = [[0.0; 12]; 12];
    for (axis, fit) in fits.iter().enumerate() {
        for one in 0..PARAMETERS {
            vector[PARAMETERS * axis + one] = fit.solution[one];
            for other in 0..PARAMETERS {
                covariance[PARAMETERS * axis + one][PARAMETERS * axis + other] =
                    fit.covariance[(one, other)];
            }
        }
    }
    let coefficient = |at: usize| AxisCoefficients {
        value: fits.each_ref().map(|fit| fit.solution[at]),
        standard_error: fits.each_ref().map(|fit| fit.covariance[(at, at)].sqrt()),
    };
    let residuals = groups.iter().map(|group| {
        std::array::from_fn(|axis| {
            let [x, y, z] = group.design.reference_rate_deg_per_s;
            let warmer_k = settings.warmer_k(group.design.temperature_c[axis]);
            let row = Row::from([x, y, z, 1.0, warmer_k, 0.0]);
            group.output_deg_per_s[axis] - row.dot(&fits[axis].solution)
        })
    });
    Ok(Calibration {
        parameters: ErrorParameters::from_vector(&vector),
        covariance,
        temperature: TemperatureCoefficients {
            bias: settings.fits_temperature.then(|| coefficient(TEMPERATURE)),
            ..TemperatureCoefficients::default()
        },
        reference_temperature_c: [settings.reference_temperature_c; 3],
        forgetting_factors: vec![[1.0; 3]; groups.len()],
        weights: vec![[1.0; 3]; groups.len()],
        residual_deg_per_s: residuals.collect(),
        reduced_chi_square: [None; 3],
        condition_number: fits.each_ref().map(|fit| fit.condition_number),
        rounding_loss: None,
        of_samples: Some(SampleFindings {
            delay_s: coefficient(DELAY),
            rejected: fits.each_ref().map(|fit| fit.rejected),
        }),
    })
}

/// The row of a sample for one gyro.
fn row(sample: &RateSample, axis: usize, settings: &SampleSettings) -> Row {
    let [x, y, z] = sample.rate_deg_per_s;
    let warmer_k = settings.warmer_k(sample.temperature_c);
    Row::from([
        x,
        y,
        z,
        1.0,
        warmer_k,
        -sample.acceleration_deg_per_s2[axis],
    ])
}

/// Fits one gyro, once more without its outliers.
fn fit_axis(
    samples: &[RateSample],
    axis: usize,
    settings: &SampleSettings,
) -> Result<AxisFit, CalibrationError> {
    let residual = |sample: &RateSample, solution: &Row| {
        sample.output_deg_per_s[axis] - row(sample, axis, settings).dot(solution)
    };
    let (mut normal, mut solution) = solve(samples, axis, settings, &|_| true)?;
    let mut limit = f64::INFINITY;
    if let Some(threshold) = settings.outlier_threshold {
        let mut sizes: Vec<f64> = samples
            .iter()
            .map(|it| residual(it, &solution).abs())
            .collect();
        sizes.sort_by(f64::total_cmp);
        let first = solution;
        limit = threshold * MAD_TO_STD * sizes[sizes.len() / 2];
        let keeps = |sample: &RateSample| residual(sample, &first).abs() <= limit;
        (normal, solution) = solve(samples, axis, settings, &keeps)?;
    }
    let inverse = inverted(&normal).ok_or_else(|| undetermined(axis))?;
    let left = samples.iter().map(|sample| residual(sample, &solution));
    let kept: Vec<f64> = left.filter(|left| left.abs() <= limit).collect();
    let variance = variance_of_means(&kept, STRETCH_S / settings.sample_period_s)?;
    let rates = normal.fixed_view::<PARAMETERS, PARAMETERS>(0, 0);
    let rates =
        nalgebra::DMatrix::from_fn(PARAMETERS, PARAMETERS, |row, column| rates[(row, column)]);
    let values = singular_value_decomposition(rates, false, false)
        .ok_or_else(|| undetermined(axis))?
        .singular_values;
    Ok(AxisFit {
        solution,
        covariance: inverse * variance,
        condition_number: (values[0] / values[PARAMETERS - 1]).sqrt(),
        rejected: samples.len() - kept.len(),
    })
}

/// Variance that residuals would have if they were white and their means over a stretch scattered as they do.
///
/// * `length`: samples of a stretch.
fn variance_of_means(residuals: &[f64], length: f64) -> Result<f64, CalibrationError> {
    let (mut sum, mut count, mut end) = (0.0, 0.0, length.max(1.0));
    let (mut squares, mut stretches) = (0.0, 0);
    for (index, residual) in residuals.iter().enumerate() {
        if index as f64 >= end {
            squares += sum * sum / count;
            stretches += 1;
            (sum, count, end) = (0.0, 0.0, end + length.max(1.0));
        }
        sum += residual;
        count += 1.0;
    }
    if stretches < STRETCHES_MIN {
        return Err(CalibrationError::TooFewStretches {
            stretches,
            needed: STRETCHES_MIN,
        });
    }
    let stretches = f64::from(u32::try_from(stretches).unwrap_or(u32::MAX));
    // Each unknown takes the scatter of about one of them.
    Ok(squares / (stretches - UNKNOWNS as f64))
}

/// Normal matrix of the samples that are kept, and the solution.
fn solve(
    samples: &[RateSample],
    axis: usize,
    settings: &SampleSettings,
    keeps: &dyn Fn(&RateSample) -> bool,
) -> Result<(Square, Row), CalibrationError> {
    let (mut normal, mut right) = (Square::zeros(), Row::zeros());
    for sample in samples.iter().filter(|sample| keeps(sample)) {
        let row = row(sample, axis, settings);
        normal += row * row.transpose();
        right += row * sample.output_deg_per_s[axis];
    }
    // A temperature that is not fitted has no coefficient.
    if !settings.fits_temperature {
        normal[(TEMPERATURE, TEMPERATURE)] = 1.0;
    }
    let inverse = inverted(&normal).ok_or_else(|| undetermined(axis))?;
    Ok((normal, inverse * right))
}

fn undetermined(axis: usize) -> CalibrationError {
    CalibrationError::SamplesUndetermined { axis: AXES[axis] }
}

/// Smallest part of its diagonal that elimination may leave of a scaled normal matrix.
const PIVOT_MIN: f64 = 1e-10;

/// Inverse of a normal matrix, its columns scaled to one size; nothing where columns are nearly the same.
fn inverted(normal: &Square) -> Option<Square> {
    let scale = normal.diagonal().map(|square| square.sqrt().recip());
    if !scale.iter().all(|it| it.is_finite()) {
        return None;
    }
    let scaled = Square::from_fn(|row, column| normal[(row, column)] * scale[row] * scale[column]);
    let decomposed = scaled.cholesky()?;
    let factor = decomposed.l();
    let least = (0..UNKNOWNS)
        .map(|at| factor[(at, at)].powi(2))
        .fold(1.0, f64::min);
    if least < PIVOT_MIN {
        return None;
    }
    let inverse = decomposed.inverse();
    Some(Square::from_fn(|row, column| {
        inverse[(row, column)] * scale[row] * scale[column]
    }))
}
