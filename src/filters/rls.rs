//! Recursive least squares in its textbook gain form.

use super::common::lanes::{self, LANES, Lanes, Turns};
use super::common::{
    Complaints, Core, CoreFilter, DivergenceKind, Fault, Filter, FrontEndConfig, Output,
    least_squares_rule,
};
use super::hardware::{self, PipelineSettings};
use super::kind::{Condition, ExpectedWords, FilterSettings};
use super::rls_words::RlsWords;
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
                Condition {
                    key: "fixed",
                    needs: "pipeline = \"fpga\" and number_format = \"fixed\"",
                    acts: |settings| settings.fixed_words().is_some(),
                },
            ]
        }
    }

    fn check(&self, complaints: &mut Complaints) {
        let Some(words) = self.fixed_words() else {
            return;
        };
        words.check(complaints);
        if self.update_sign == UpdateSign::AsPrinted {
            complaints.key(
                "update_sign",
                "= \"as-printed\" has no hardware in fixed point: use \"corrected\", or another number_format",
            );
        }
    }

    fn notes(&self, words: &ExpectedWords) -> Vec<String> {
        if let Some(fixed) = self.fixed_words() {
            return fixed.notes(words.peak_deg_per_h);
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
        (self.pipeline == Pipeline::Fpga).then(|| hardware::rls(self))
    }
}

impl RlsFilterConfig {
    /// The fixed-point words of the hardware; none of floating point and of the textbook.
    #[must_use]
    pub fn fixed_words(&self) -> Option<RlsWords> {
        let is_fixed = self.pipeline == Pipeline::Fpga && self.number_format == WordFormat::Fixed;
        is_fixed.then(|| self.fixed.clone().unwrap_or_else(RlsWords::reference))
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
/// t = P L, g = lambda + L't        the gain is t / g
/// s = (d - y) / g, W = W + s t
/// P = (P - t t' / g) / lambda      (t_i t_j) / g: symmetric to the bit
/// ```
///
/// After n updates W minimises `lambda^n |W|^2 / delta + sum lambda^(n-i) (d_i - W'L_i)^2`.
/// Symmetry matters: an asymmetry of P grows by `1 / lambda` per sample and at lambda = 0.99 ruins
/// binary64 in some thousand samples.
///
/// Computed looking ahead: with V and Q the weights and the matrix before the newest update, and t, s and
/// g of that update,
///
/// ```text
/// u = Q L, q = t'L
/// y = V'L + s q
/// t = (u - t q / g) / lambda
/// g = lambda + (L'u - q^2 / g) / lambda
/// ```
///
/// are the same numbers. u, q, V'L and L'u wait for nothing of the newest division, so that a sample waits
/// for the one before for a third of the time.
///
/// # Source
/// Haykin, Adaptive Filter Theory, the exponentially weighted recursive-least-squares algorithm;
/// the paper's equations (6) to (8) are the same recursion with the updated P in the gain. Checked by
/// `recursive_least_squares_equals_regularised_batch_least_squares`, and against the equations as they
/// are printed by `looking_ahead_changes_no_word`.
#[derive(Clone, Debug)]
pub struct RlsCore {
    taps: usize,
    /// P row by row, every row filled up to whole blocks, and W behind it.
    states: Turns,
    newest: Update,
    forgetting_factor: f64,
    inverse_forgetting_factor: f64,
    sign: f64,
    /// Room for the update of a filter of many taps.
    room: Vec<Lanes>,
}

/// What the newest update made of the state before it.
#[derive(Clone, Debug)]
struct Update {
    /// t, the projection `P L`.
    projection: Vec<Lanes>,
    /// `1 / g`.
    gain: f64,
    /// s.
    step: f64,
    /// lambda; 1 before there was an update.
    forgetting_factor: f64,
    /// `1 / lambda`; 1 before there was an update.
    inverse_forgetting_factor: f64,
}

/// What a sample needs before it meets the newest update.
struct Prediction {
    /// y.
    output: Output,
    /// q.
    common: f64,
    /// `L'u`.
    energy: f64,
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
        let blocks = lanes::blocks(taps);
        let mut state = vec![Lanes::ZERO; (taps + 1) * blocks];
        for (tap, row) in state.chunks_exact_mut(blocks).take(taps).enumerate() {
            row[tap / LANES].as_mut_array()[tap % LANES] = delta;
        }
        Self {
            taps,
            states: Turns::new(state),
            newest: Update {
                projection: vec![Lanes::ZERO; blocks],
                gain: 0.0,
                step: 0.0,
                forgetting_factor: 1.0,
                inverse_forgetting_factor: 1.0,
            },
            forgetting_factor,
            inverse_forgetting_factor: 1.0 / forgetting_factor,
            sign: config.update_sign.factor(),
            room: vec![Lanes::ZERO; 2 * blocks],
        }
    }

    /// Forgetting factor.
    pub(super) fn forgetting_factor(&self) -> f64 {
        self.forgetting_factor
    }

    /// Inverse correlation matrix P, `[p * p]`, row major, (deg/h)^-2.
    #[must_use]
    pub fn inverse_correlation(&self) -> Vec<f64> {
        let row_length = LANES * lanes::blocks(self.taps);
        let rows = lanes::numbers(self.states.newest()).chunks_exact(row_length);
        let rows = rows.take(self.taps).map(|row| &row[..self.taps]);
        rows.flatten().copied().collect()
    }

    /// An update of a filter of so many blocks of lanes that they stay in registers.
    #[inline(always)]
    fn update_within<const BLOCKS: usize>(
        &mut self,
        taps: usize,
        regressors: &[f64],
        desired: f64,
    ) -> Result<Output, Fault> {
        let mut newest = [Lanes::ZERO; BLOCKS];
        let mut ahead = [Lanes::ZERO; BLOCKS];
        self.update_blocks(taps, &regressors[..taps], desired, &mut newest, &mut ahead)
    }

    /// An update of a filter of any size.
    fn update_any(&mut self, regressors: &[f64], desired: f64) -> Result<Output, Fault> {
        let (taps, mut room) = (self.taps, std::mem::take(&mut self.room));
        let (newest, ahead) = room.split_at_mut(lanes::blocks(taps));
        let result = self.update_blocks(taps, &regressors[..taps], desired, newest, ahead);
        self.room = room;
        result
    }

    /// The update, with room for t and u.
    #[inline(always)]
    fn update_blocks(
        &mut self,
        taps: usize,
        regressors: &[f64],
        desired: f64,
        projection: &mut [Lanes],
        ahead: &mut [Lanes],
    ) -> Result<Output, Fault> {
        let blocks = projection.len();
        projection.copy_from_slice(&self.newest.projection[..blocks]);
        let (newest, older) = self.states.newest_and_older();
        let (newest, older) = (
            &newest[..(taps + 1) * blocks],
            &mut older[..(taps + 1) * blocks],
        );
        let (matrix, weights) = newest.split_at(taps * blocks);
        let (older_matrix, older_weights) = older.split_at_mut(taps * blocks);

        project(older_matrix, regressors, ahead);
        let step = self.newest.step;
        let prediction = predict(
            [weights, older_weights, projection, ahead],
            step,
            regressors,
        );
        let Prediction {
            output,
            common,
            energy,
        } = prediction;
        // g with the factor lambda of the update before: its inverse comes with one division.
        let (before, gain) = (self.newest.forgetting_factor, self.newest.gain);
        let scaled = (before * self.forgetting_factor + energy) - (common * common) * gain;
        if !is_positive(scaled) {
            return Err(self.fault(scaled / before));
        }
        let inverse = Lanes::splat(self.newest.inverse_forgetting_factor);
        let correction = Lanes::splat(common * gain);
        let gain = before / scaled;
        let step = self.sign * (desired - output.value_deg_per_h) * gain;
        for (block, projection) in projection.iter_mut().enumerate() {
            *projection = (ahead[block] - correction * *projection) * inverse;
            older_weights[block] = weights[block] + Lanes::splat(step) * *projection;
        }
        let scale = self.inverse_forgetting_factor;
        let is_definite = reduce(matrix, older_matrix, projection, gain, scale);
        self.states.turn();
        self.newest.projection[..blocks].copy_from_slice(projection);
        self.newest.gain = gain;
        self.newest.step = step;
        self.newest.forgetting_factor = self.forgetting_factor;
        self.newest.inverse_forgetting_factor = scale;
        if is_definite {
            Ok(output)
        } else {
            Err(self.fault(scaled / before))
        }
    }

    /// What is wrong with P once its diagonal or the denominator has given it away.
    #[cold]
    fn fault(&self, denominator: f64) -> Fault {
        let matrix = self.inverse_correlation();
        let diagonal = matrix.iter().step_by(self.taps + 1);
        let smallest = diagonal.fold(f64::INFINITY, |min, value| min.min(*value));
        let has_overflowed = matrix.iter().any(|p| !p.is_finite());
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

/// Whether a number is positive and finite.
#[inline(always)]
fn is_positive(number: f64) -> bool {
    number > 0.0 && number <= f64::MAX
}

/// `u = Q L`, by the columns of the symmetric Q; those of even and odd index are summed side by side.
#[inline(always)]
fn project(matrix: &[Lanes], regressors: &[f64], ahead: &mut [Lanes]) {
    let blocks = ahead.len();
    for (block, ahead) in ahead.iter_mut().enumerate() {
        let (mut even, mut odd) = (Lanes::ZERO, Lanes::ZERO);
        for (index, regressor) in regressors.iter().enumerate() {
            let product = matrix[index * blocks + block] * Lanes::splat(*regressor);
            if index % 2 == 0 {
                even += product;
            } else {
                odd += product;
            }
        }
        *ahead = even + odd;
    }
}

/// Inner products of the regressors with V, t and u, and the sum of W.
#[inline(always)]
fn predict(
    [weights, older_weights, projection, ahead]: [&[Lanes]; 4],
    step: f64,
    regressors: &[f64],
) -> Prediction {
    let [mut value, mut common, mut energy, mut weight_sum] = [Lanes::ZERO; 4];
    for (block, weights) in weights.iter().enumerate() {
        let lanes = lanes::block(regressors, block);
        value += older_weights[block] * lanes;
        common += projection[block] * lanes;
        energy += ahead[block] * lanes;
        weight_sum += *weights;
    }
    let common = lanes::sum(common);
    Prediction {
        output: Output {
            value_deg_per_h: lanes::sum(value) + step * common,
            weight_sum: lanes::sum(weight_sum),
        },
        common,
        energy: lanes::sum(energy),
    }
}

/// `P = (P - t t' / g) / lambda`; says whether the diagonal is still positive and finite.
#[inline(always)]
fn reduce(
    matrix: &[Lanes],
    reduced: &mut [Lanes],
    projection: &[Lanes],
    gain: f64,
    scale: f64,
) -> bool {
    let blocks = projection.len();
    let taps = matrix.len() / blocks;
    let (gain, scale) = (Lanes::splat(gain), Lanes::splat(scale));
    let mut is_definite = true;
    for (block, lanes) in projection.iter().enumerate() {
        let mut diagonal = [1.0; LANES];
        let rows = diagonal.iter_mut().take(taps - block * LANES).enumerate();
        for (lane, diagonal) in rows {
            let row = (block * LANES + lane) * blocks;
            let element = Lanes::splat(lanes.as_array()[lane]);
            for (column, projection) in projection.iter().enumerate() {
                let product = (element * *projection) * gain;
                reduced[row + column] = (matrix[row + column] - product) * scale;
            }
            *diagonal = reduced[row + block].as_array()[lane];
        }
        let diagonal = Lanes::new(diagonal);
        let is_finite = diagonal.simd_le(Lanes::splat(f64::MAX));
        is_definite &= (diagonal.simd_gt(Lanes::ZERO) & is_finite).all();
    }
    is_definite
}

impl Core for RlsCore {
    #[inline(always)]
    fn update(&mut self, regressors: &[f64], desired: f64) -> Result<Output, Fault> {
        // Sizes of the paper and its neighbours without a loop.
        match self.taps {
            1 => self.update_within::<1>(1, regressors, desired),
            2 => self.update_within::<1>(2, regressors, desired),
            3 => self.update_within::<1>(3, regressors, desired),
            4 => self.update_within::<1>(4, regressors, desired),
            taps @ ..=8 => self.update_within::<2>(taps, regressors, desired),
            _ => self.update_any(regressors, desired),
        }
    }

    fn reads_blocks(&self) -> bool {
        true
    }

    fn weights(&self) -> &[f64] {
        let (_, weights) = self
            .states
            .newest()
            .split_at(self.taps * lanes::blocks(self.taps));
        &lanes::numbers(weights)[..self.taps]
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
