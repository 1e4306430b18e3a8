//! Recursive least squares in its textbook gain form.

use super::common::{
    Complaints, Core, CoreFilter, DivergenceKind, Fault, Filter, FrontEndConfig, Output, dot,
    least_squares_rule,
};
use super::hardware::{self, PipelineSettings};
use super::kind::{Condition, ExpectedWords, FilterSettings};
use super::words::{FixedWords, HardwareWords, RlsWords, refuse_as_printed};
use crate::declare::table;
use crate::signal::WeightRule;
use crate::vocabulary::{
    DesiredSignal, Division, OutputRegister, Pipeline, UpdateOrder, UpdateSign, WordFormat,
};

table! {
    /// Recursive least squares.
    pub struct RlsFilterConfig {
        /// Number of weights p. Source of the default: the paper.
        taps: u32 = 4, in 1..=64;
        /// Forgetting factor alpha; 1 forgets nothing. Source of the default: the paper, section 4.1.
        forgetting_factor: f64 = 1.0, in 1e-3..=1.0;
        /// Initial inverse correlation. Source of the default: 1e4 (deg/s)^-2, assumed.
        initial_inverse_correlation: f64 = 7.716e-4, in 1e-18..=1e12, "(deg/h)^-2";
        /// What the filter aims at. Source of the default: one-step prediction; the paper does not say.
        desired: DesiredSignal = "current";
        /// Samples by which the regressors lag the newest sample of the desired signal.
        input_lag_samples: u32 = 1, in 0..=64;
        /// When the result appears: at the next sample tick, or as soon as it is computed. Source of the
        /// default: the sample-and-hold of the paper.
        output_register: OutputRegister = "next-sample";
        /// Sign before the error term of the weight update: the one that converges, or the minus that the
        /// paper's equations (6) and (9) print, which diverges.
        update_sign: UpdateSign = "corrected";
        /// Arithmetic: the recursion of the books, or the pipeline of the hardware with its bits and clocks.
        pipeline: Pipeline = "textbook";
        /// Words of the hardware; -ftz flushes subnormal numbers to zero, "fixed" has a table of its own. This
        /// key and those below only matter with pipeline = "fpga". Source of the default: the paper's double
        /// precision.
        number_format: WordFormat = "binary64";
        /// Clock of the hardware. Source of the default: the paper.
        clock_mhz: f64 = 40.0, in 1e-3..=10000.0, "MHz";
        /// One division per sample, or one for each element of the matrix. Source of the default: derived,
        /// the paper counts one divider even where everything is done at once.
        division: Division = "reciprocal";
        /// Order of the products in the update of the matrix: (t_i t_j) r, which keeps it symmetric to the
        /// bit, or (t_i r) t_j, which fails below a forgetting factor of 1. Source of the default: derived
        /// from the clocks of the paper's states.
        update_order: UpdateOrder = "schedule";
        fixed: Option<RlsWords>;
    }
}

impl FilterSettings for RlsFilterConfig {
    fn conditions() -> &'static [Condition<Self>] {
        const {
            &[
                Condition::hardware("number_format"),
                Condition::hardware("clock_mhz"),
                Condition::float("division"),
                Condition::float("update_order"),
                Condition::fixed(),
            ]
        }
    }

    fn check(&self, complaints: &mut Complaints) {
        if let Some(PipelineSettings::Fixed(_)) = self.hardware() {
            self.words().check(complaints);
            refuse_as_printed(self.update_sign, complaints);
        }
    }

    fn notes(&self, words: &ExpectedWords) -> Vec<String> {
        if let Some(PipelineSettings::Fixed(_)) = self.hardware() {
            return self.words().notes(words.peak_deg_per_h);
        }
        // The hardware warns by itself.
        if self.pipeline == Pipeline::Fpga {
            return Vec::new();
        }
        let delta = self.initial_inverse_correlation;
        covariance_digits_warning(delta, self.taps as usize, words.peak_deg_per_h)
            .into_iter()
            .collect()
    }

    fn build(&self, _sample_period_s: f64) -> Option<Box<dyn Filter>> {
        Some(Box::new(Rls::new(&RlsConfig {
            taps: self.taps as usize,
            forgetting_factor: self.forgetting_factor,
            initial_inverse_correlation: self.initial_inverse_correlation,
            update_sign: self.update_sign,
            front_end: FrontEndConfig {
                desired: self.desired,
                input_lag_samples: self.input_lag_samples as usize,
                output_register: self.output_register,
            },
        })))
    }

    fn hardware(&self) -> Option<PipelineSettings> {
        let words = HardwareWords::of(self.number_format, || self.words());
        (self.pipeline == Pipeline::Fpga).then(|| hardware::rls(self, &words))
    }

    fn fixed_words(&self) -> Option<FixedWords> {
        Some(self.words())
    }

    fn hardware_on(&self, words: &HardwareWords) -> Option<PipelineSettings> {
        Some(hardware::rls(self, words))
    }
}

impl RlsFilterConfig {
    /// The words of its table, or those of the reference.
    fn words(&self) -> FixedWords {
        let table = self.fixed.as_ref();
        table.map_or_else(|| RlsWords::reference().resolved(), RlsWords::resolved)
    }
}

/// Settings of a recursive-least-squares filter.
#[derive(Clone, Debug, PartialEq)]
pub struct RlsConfig {
    /// Number of weights p, >= 1.
    pub taps: usize,
    /// Forgetting factor lambda, (0, 1]; samples count for about `1 / (1 - lambda)` samples.
    pub forgetting_factor: f64,
    /// Initial inverse correlation delta, > 0, (deg/h)^-2: `P = delta I` at the start.
    pub initial_inverse_correlation: f64,
    /// Sign before the error term.
    pub update_sign: UpdateSign,
    /// Front end and output register.
    pub front_end: FrontEndConfig,
}

/// Recursive least squares behind the common front end.
pub type Rls = CoreFilter<RlsCore>;

impl Rls {
    /// A filter of zero weights.
    ///
    /// # Panics
    /// As [`RlsCore::new`].
    #[must_use]
    pub fn new(config: &RlsConfig) -> Self {
        Self::with_core(RlsCore::new(config), &config.front_end)
    }
}

/// Weights W and inverse correlation matrix P.
///
/// With regressors L and desired value d, in this order:
///
/// ```text
/// y = W'L                          prediction with the weights before the update
/// k = P L / (lambda + L'P L)       gain
/// W = W + k (d - y)
/// P = (P - k L'P) / lambda         upper triangle, mirrored: symmetric to the bit
/// ```
///
/// After n updates W minimises `lambda^n |W|^2 / delta + sum lambda^(n-i) (d_i - W'L_i)^2`.
/// Mirroring matters: an asymmetry of P grows by `1 / lambda` per sample and at lambda = 0.99 ruins
/// binary64 in some thousand samples.
///
/// # Source
/// Haykin, Adaptive Filter Theory, the exponentially weighted recursive-least-squares algorithm;
/// the paper's equations (6) to (8) are the same recursion with the updated P in the gain. Checked by
/// `recursive_least_squares_equals_regularised_batch_least_squares`.
#[derive(Clone, Debug)]
pub struct RlsCore {
    weights: Vec<f64>,
    /// P, row major.
    inverse_correlation: Vec<f64>,
    /// `P L` of the newest update.
    projection: Vec<f64>,
    forgetting_factor: f64,
    inverse_forgetting_factor: f64,
    sign: f64,
}

impl RlsCore {
    /// Zero weights and `P = delta I`.
    ///
    /// # Panics
    /// If there are no taps, the forgetting factor is outside (0, 1] or delta is not a positive
    /// number; the scenario reader refuses all three.
    #[must_use]
    pub fn new(config: &RlsConfig) -> Self {
        let RlsConfig {
            taps,
            forgetting_factor,
            initial_inverse_correlation: delta,
            ..
        } = *config;
        assert!(taps > 0, "a filter has at least one tap");
        assert!(
            forgetting_factor > 0.0 && forgetting_factor <= 1.0,
            "the forgetting factor {forgetting_factor} lies in (0, 1]"
        );
        assert!(
            delta > 0.0 && delta.is_finite(),
            "the initial inverse correlation {delta} is positive"
        );
        let mut inverse_correlation = vec![0.0; taps * taps];
        for diagonal in inverse_correlation.iter_mut().step_by(taps + 1) {
            *diagonal = delta;
        }
        Self {
            weights: vec![0.0; taps],
            inverse_correlation,
            projection: vec![0.0; taps],
            forgetting_factor,
            inverse_forgetting_factor: 1.0 / forgetting_factor,
            sign: config.update_sign.factor(),
        }
    }

    /// Forgetting factor.
    pub(super) fn forgetting_factor(&self) -> f64 {
        self.forgetting_factor
    }

    /// Inverse correlation matrix P, `[p * p]`, row major, (deg/h)^-2.
    #[must_use]
    pub fn inverse_correlation(&self) -> &[f64] {
        &self.inverse_correlation
    }

    /// `P = (P - k L'P) / lambda`; says whether the diagonal is still positive and finite.
    fn update_inverse_correlation(&mut self, denominator: f64) -> bool {
        let taps = self.weights.len();
        let mut is_definite = true;
        for row in 0..taps {
            let gain = self.projection[row] / denominator;
            for column in row..taps {
                let index = row * taps + column;
                let reduced = self.inverse_correlation[index] - gain * self.projection[column];
                let updated = reduced * self.inverse_forgetting_factor;
                self.inverse_correlation[index] = updated;
                self.inverse_correlation[column * taps + row] = updated;
            }
            let diagonal = self.inverse_correlation[row * (taps + 1)];
            is_definite &= diagonal > 0.0 && diagonal < f64::INFINITY;
        }
        is_definite
    }

    /// What is wrong with P once its diagonal or the denominator has given it away.
    fn fault(&self, denominator: f64) -> Fault {
        let diagonal = self.inverse_correlation.iter();
        let smallest = diagonal
            .step_by(self.weights.len() + 1)
            .fold(f64::INFINITY, |min, value| min.min(*value));
        let has_overflowed = self.inverse_correlation.iter().any(|p| !p.is_finite());
        if has_overflowed || !denominator.is_finite() {
            let message = "the inverse correlation matrix is not finite".to_owned();
            return Fault {
                kind: DivergenceKind::NotFinite,
                message,
            };
        }
        let message = format!(
            "the inverse correlation matrix is no longer positive definite: denominator \
             {denominator:e}, smallest diagonal element {smallest:e}"
        );
        Fault {
            kind: DivergenceKind::LostPositiveDefiniteness,
            message,
        }
    }
}

impl Core for RlsCore {
    fn update(&mut self, regressors: &[f64], desired: f64) -> Result<Output, Fault> {
        let taps = self.weights.len();
        let output = Output {
            value_deg_per_h: dot(&self.weights, regressors),
            weight_sum: self.weights.iter().sum(),
        };
        let rows = self.inverse_correlation.chunks_exact(taps);
        for (projection, row) in self.projection.iter_mut().zip(rows) {
            *projection = dot(row, regressors);
        }
        let denominator = self.forgetting_factor + dot(regressors, &self.projection);
        if !(denominator > 0.0 && denominator < f64::INFINITY) {
            return Err(self.fault(denominator));
        }
        let step = self.sign * (desired - output.value_deg_per_h) / denominator;
        for (weight, projection) in self.weights.iter_mut().zip(&self.projection) {
            *weight += step * projection;
        }
        if !self.update_inverse_correlation(denominator) {
            return Err(self.fault(denominator));
        }
        Ok(output)
    }

    fn weights(&self) -> &[f64] {
        &self.weights
    }

    fn rule(&self, desired: DesiredSignal) -> WeightRule {
        least_squares_rule(desired, self.forgetting_factor)
    }
}

/// Digits of binary64 that may be spent on the initial inverse correlation: beyond
/// `delta p x^2 = 1e10` fewer than six significant digits of P are left after the first updates.
const COVARIANCE_RATIO_MAX: f64 = 1e10;

/// Warns where recursive least squares in binary64 loses its digits to the initial condition.
///
/// The first updates subtract nearly all of `P = delta I`; what is left carries a relative error of
/// about `2e-16 delta p x^2`.
///
/// * `initial_inverse_correlation`: delta, (deg/h)^-2.
/// * `rate_max_deg_per_h`: largest input word to be expected, deg/h.
///
/// Returns a sentence if `delta p x^2` exceeds 1e10.
#[must_use]
pub fn covariance_digits_warning(
    initial_inverse_correlation: f64,
    taps: usize,
    rate_max_deg_per_h: f64,
) -> Option<String> {
    let ratio = initial_inverse_correlation * taps as f64 * rate_max_deg_per_h * rate_max_deg_per_h;
    (ratio > COVARIANCE_RATIO_MAX).then(|| {
        let wanted = initial_inverse_correlation * COVARIANCE_RATIO_MAX / ratio;
        format!(
            "initial_inverse_correlation = {initial_inverse_correlation:e} (deg/h)^-2 with {taps} \
             taps and rates up to {rate_max_deg_per_h} deg/h makes delta p x^2 = {ratio:.1e}, \
             above {COVARIANCE_RATIO_MAX:e}: the covariance form loses its digits in binary64; \
             use {wanted:.1e} or less"
        )
    })
}
