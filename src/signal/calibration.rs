//! A calibration of a three-axis assembly as tables: what was measured, estimated and left over.
//!
//! Customary units: deg/s for table rates, deg/h for outputs and biases, ppm for scale factors,
//! arcsec for misalignments. Arrays of three belong to the gyros, or case axes, x, y, z.

/// The twelve parameters of an assembly, or their standard errors, or errors of them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AssemblyParameters {
    /// Biases, deg/h.
    pub bias_deg_per_h: [f64; 3],
    /// Scale-factor errors, ppm.
    pub scale_factor_error_ppm: [f64; 3],
    /// Rotations of the input axes, arcsec: x about y, x about z, y about x, y about z, z about x,
    /// z about y.
    pub theta_arcsec: [f64; 6],
}

/// A coefficient of the gyros x, y, z with its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct AxisCoefficient {
    /// Values.
    pub value: [f64; 3],
    /// Standard errors from the measurement noise.
    pub standard_error: [f64; 3],
}

/// One group of a campaign: one mounting at one rate, reduced to means.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CalibrationGroup {
    /// Case axis along the table axis, 0 to 2 for x to z.
    pub mounting: usize,
    /// Rate of the table, deg/s.
    pub rate_deg_per_s: f64,
    /// Rates about the case axes that the gyros ought to see, Earth rate included, deg/s.
    pub reference_rate_deg_per_s: [f64; 3],
    /// Mean temperatures, deg C.
    pub temperature_c: [f64; 3],
    /// Mean rates of the temperatures, K/min.
    pub temperature_rate_k_per_min: [f64; 3],
    /// Mean outputs, deg/h.
    pub output_deg_per_h: [f64; 3],
    /// Standard errors of these means, deg/h; 0 where they are not known.
    pub standard_error_deg_per_h: [f64; 3],
    /// Start of the averaging, s from the start of the record; none where it is not known.
    pub start_s: Option<f64>,
    /// Time averaged over, s.
    pub averaging_time_s: f64,
    /// Whole turns averaged over; none for a fixed time.
    pub turns: Option<f64>,
    /// Samples averaged over, rejected ones included; 0 where it is not known.
    pub samples: usize,
    /// Samples rejected as outliers.
    pub rejected: [usize; 3],
}

/// What a plan of mountings and rates can determine.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CalibrationPlan {
    /// Groups.
    pub groups: usize,
    /// Rank of the rows, equal to the unknowns of each gyro.
    pub rank: usize,
    /// Condition numbers of the rows, deg/s and 1 (and K).
    pub condition_number: [f64; 3],
    /// Singular values of the rows of gyro x, descending.
    pub singular_values: Vec<f64>,
    /// Standard deviation of the scale-factor error per standard error of a group mean, ppm per deg/h.
    pub scale_factor_ppm_per_deg_per_h: [f64; 3],
    /// Standard deviation of the bias per standard error of a group mean.
    pub bias_per_standard_error: [f64; 3],
    /// Correlation of the two.
    pub scale_factor_bias_correlation: [f64; 3],
}

/// The truth of a simulated assembly.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct CalibrationTruth {
    /// Parameters at the reference temperature.
    pub parameters: AssemblyParameters,
    /// Temperature coefficients of the biases at the reference temperature, deg/h/K.
    pub bias_deg_per_h_per_k: [f64; 3],
    /// Reference temperature, deg C.
    pub reference_temperature_c: f64,
}

/// How far an estimate is from the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct EstimateError {
    /// Estimate minus truth.
    pub parameters: AssemblyParameters,
    /// Root mean square over the three biases, deg/h.
    pub bias_rms_deg_per_h: f64,
    /// Root mean square over the three scale factors, ppm.
    pub scale_factor_rms_ppm: f64,
    /// Root mean square over the six misalignments, arcsec.
    pub misalignment_rms_arcsec: f64,
    /// `e^T C^-1 e` of the twelve errors, 12 on average if the covariance tells all; none for data
    /// without noise.
    pub normalised_error_squared: Option<f64>,
    /// Largest error of a rate compensated with the estimate, over the plan's rates, deg/h.
    pub compensated_rate_max_deg_per_h: f64,
}

/// What double precision cost a recursion: largest differences from the square-root form.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ParameterRounding {
    /// Of a bias, deg/h.
    pub bias_deg_per_h: f64,
    /// Of a scale factor or misalignment, ppm (1 ppm is 1 urad).
    pub sensitivity_ppm: f64,
}

/// What one estimator made of the groups.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CalibrationEstimate {
    /// Name of the estimator as in `calibration.estimators`.
    pub name: String,
    /// Parameters at the reference temperatures.
    pub parameters: AssemblyParameters,
    /// Standard errors from the measurement noise; drift that the model lacks is not in them.
    pub standard_error: AssemblyParameters,
    /// Covariance of the patent's x1..x12, rows of `[I + K_G + theta_G | B_G]`; the biases x4, x8
    /// and x12 in deg/s, the others ratios.
    pub covariance: [[f64; 12]; 12],
    /// Temperatures that bias and scale factor belong to, deg C.
    pub reference_temperature_c: [f64; 3],
    /// Temperature coefficients of the biases, deg/h/K, where fitted.
    pub bias_deg_per_h_per_k: Option<AxisCoefficient>,
    /// Output minus model by group, deg/h.
    pub residual_deg_per_h: Vec<[f64; 3]>,
    /// Root mean squares of these, deg/h.
    pub residual_rms_deg_per_h: [f64; 3],
    /// Squared residuals over their expectation for measurement noise alone, where there is one.
    pub reduced_chi_square: [Option<f64>; 3],
    /// Weights that the groups are left with.
    pub weights: Vec<[f64; 3]>,
    /// Condition numbers of the weighted rows.
    pub condition_number: [f64; 3],
    /// For the covariance recursion: what rounding cost.
    pub rounding: Option<ParameterRounding>,
    /// For an estimate from samples: delays behind the encoder, ms.
    pub delay_ms: Option<AxisCoefficient>,
    /// For an estimate from samples: samples left out as outliers, by gyro.
    pub rejected_samples: Option<[usize; 3]>,
    /// Against the truth, where it is known.
    pub error: Option<EstimateError>,
}

/// What a form of compensation leaves at the plan's rates.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CompensationCheck {
    /// `exact` or `first-order`.
    pub form: &'static str,
    /// Left by the form itself, its parameters being perfect: by group and case axis, deg/h.
    pub residual_deg_per_h: Vec<[f64; 3]>,
    /// The largest of these in magnitude.
    pub residual_max_deg_per_h: f64,
    /// Largest error of a rate compensated with the applied estimate where the truth is known, deg/h.
    pub error_max_deg_per_h: Option<f64>,
}

/// One row of the ranking of estimators over repeated campaigns.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CalibrationRank {
    /// Name of the estimator.
    pub name: String,
    /// Campaigns.
    pub campaigns: usize,
    /// Root mean square over campaigns and gyros of the bias error, deg/h.
    pub bias_rms_deg_per_h: f64,
    /// The same of the scale factor, ppm.
    pub scale_factor_rms_ppm: f64,
    /// The same over the six misalignments, arcsec.
    pub misalignment_rms_arcsec: f64,
    /// Mean normalised error squared; 12 if the covariances tell all.
    pub normalised_error_squared: Option<f64>,
}

/// Everything that a report shows of a calibration.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CalibrationSheet {
    /// The plan for the twelve parameters.
    pub plan: CalibrationPlan,
    /// The plan with a temperature coefficient of each bias, where an estimator fits one.
    pub plan_with_temperature: Option<CalibrationPlan>,
    /// Groups in the order they were taken.
    pub groups: Vec<CalibrationGroup>,
    /// Estimates side by side, in the order asked for.
    pub estimates: Vec<CalibrationEstimate>,
    /// Name of the one that is applied.
    pub applied: String,
    /// Both forms of compensation with the applied estimate.
    pub compensation: Vec<CompensationCheck>,
    /// The truth, where it is known.
    pub truth: Option<CalibrationTruth>,
    /// Estimators over repeated campaigns, best bias first; empty with one campaign.
    pub ranking: Vec<CalibrationRank>,
    /// What is worth saying of plan, data and estimates.
    pub warnings: Vec<String>,
}

impl CalibrationSheet {
    /// The applied estimate.
    #[must_use]
    pub fn applied_estimate(&self) -> Option<&CalibrationEstimate> {
        let mut all = self.estimates.iter();
        all.find(|estimate| estimate.name == self.applied)
    }
}
