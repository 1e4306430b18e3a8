//! Plain records handed from stage to stage. No behaviour beyond reading them.
//!
//! Invariant: no stage knowledge; a stage passes these to the right and never imports another.

mod bridge;
mod calibration;
mod rates;
mod slow_drift;
mod temperature_model;

pub use bridge::Bridge;
pub use calibration::{
    AssemblyParameters, AxisCoefficient, CalibrationEstimate, CalibrationGroup, CalibrationPlan,
    CalibrationRank, CalibrationSheet, CalibrationTruth, CompensationCheck, EstimateError,
    ParameterRounding,
};
pub use rates::{RateRecord, Rates};
pub use slow_drift::SlowDrift;
pub use temperature_model::TemperatureModel;

/// Motion of the gyro's input axis over one output sample interval.
///
/// A cubic in normalised time `u`, 0 at the start of the interval and 1 at its end:
/// `rate(u) = c0 + c1 u + c2 u^2 + c3 u^3`, inertial rate about the input axis (table motion plus
/// the projection of Earth rate), rad/s. For a sine of angular frequency w the cubic through the
/// end rates and slopes errs by at most `(w T)^4 / 384` of the amplitude, and has `(w T)^4 / 720` less of
/// it: 2e-10 at 10 Hz, 4 kHz. Faster motion comes as several cubics of equal length a word, see
/// [`cubics_per_word`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionSegment {
    /// Polynomial coefficients `c0..c3`, rad/s.
    pub rate_rad_per_s: [f64; 4],
}

/// Part of the amplitude of a sine that cubics may lose.
const CUBIC_LOSS_MAX: f64 = 5e-6;

/// Cubics into which a rate word is to be split, so that the fastest sine of the motion keeps its
/// amplitude to 5 ppm: one up to a 25th of the word rate, seven at a quarter of it.
///
/// Source: derived; the cubic through both ends of a part of length h has the mean gain
/// `1 - (w h)^4 / 720`, and its images about the rate of the parts are of the same order.
#[must_use]
pub fn cubics_per_word(frequency_hz: f64, word_period_s: f64) -> usize {
    let angle = std::f64::consts::TAU * frequency_hz * word_period_s;
    let most = (720.0 * CUBIC_LOSS_MAX).sqrt().sqrt();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a small whole number; the cast saturates"
    )]
    let cubics = (angle / most).ceil().max(1.0) as usize;
    cubics
}

impl MotionSegment {
    /// A segment of constant rate.
    #[must_use]
    pub fn constant(rate_rad_per_s: f64) -> Self {
        Self {
            rate_rad_per_s: [rate_rad_per_s, 0.0, 0.0, 0.0],
        }
    }

    /// The cubic with given rates (rad/s) and slopes (rad/s per interval) at both ends.
    #[must_use]
    pub fn hermite(start: f64, start_slope: f64, end: f64, end_slope: f64) -> Self {
        let rise = end - start;
        Self {
            rate_rad_per_s: [
                start,
                start_slope,
                3.0 * rise - 2.0 * start_slope - end_slope,
                start_slope + end_slope - 2.0 * rise,
            ],
        }
    }

    /// The sum of two rates.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        let mut sum = *self;
        for (own, more) in sum.rate_rad_per_s.iter_mut().zip(other.rate_rad_per_s) {
            *own += more;
        }
        sum
    }

    /// Rate at normalised time `u` in `[0, 1]`, rad/s.
    #[inline]
    #[must_use]
    pub fn rate_at(&self, u: f64) -> f64 {
        let [c0, c1, c2, c3] = self.rate_rad_per_s;
        ((c3 * u + c2) * u + c1) * u + c0
    }

    /// Slope of the rate at normalised time `u` in `[0, 1]`, rad/s per interval.
    #[must_use]
    pub fn slope_at(&self, u: f64) -> f64 {
        let [_, c1, c2, c3] = self.rate_rad_per_s;
        (3.0 * c3 * u + 2.0 * c2) * u + c1
    }

    /// Angle turned from the start of an interval of `period_s` to normalised time `u` in
    /// `[0, 1]`, rad: the integral of the cubic.
    #[must_use]
    pub fn angle_at(&self, u: f64, period_s: f64) -> f64 {
        let [c0, c1, c2, c3] = self.rate_rad_per_s;
        (((c3 / 4.0 * u + c2 / 3.0) * u + c1 / 2.0) * u + c0) * u * period_s
    }
}

/// A filter as its outputs are judged: which input samples it weighs and how its weights come about.
///
/// Ages count whole samples before the instant a value is stamped; the output register is
/// included, so that the newest sample a next-sample filter can use has age 1.
#[derive(Clone, Debug, PartialEq)]
pub struct FilterShape {
    /// Number of weights, p; `None` for an infinite impulse response.
    pub taps: Option<usize>,
    /// Age in samples of the newest weighed input when the output is stamped, l.
    pub newest_age_samples: usize,
    /// Samples the output register adds, 0 or 1; already part of `newest_age_samples`.
    pub register_samples: usize,
    /// How the weights come about.
    pub rule: WeightRule,
}

/// How the weights of a filter come about.
#[derive(Clone, Debug, PartialEq)]
pub enum WeightRule {
    /// They minimise the distance from a desired signal, given as weights on input samples of ages
    /// 0, 1, ... before the register (`[1]` = the current sample, `[0.5, 0.5]` = mean of the newest
    /// two).
    Adaptive {
        /// Weights of the desired signal.
        desired_weights: Vec<f64>,
        /// Whether their sum is held at 1.
        is_dc_gain_one: bool,
        /// Of recursive least squares: what a word counts for once the next has come, 1 if nothing
        /// is forgotten. None where the weights follow a gradient.
        forgetting_factor: Option<f64>,
    },
    /// They are given, newest sample first.
    Fixed(Vec<f64>),
    /// They are the impulse response of a cascade of sections.
    Sections(Vec<Section>),
    /// They are not shown: the words alone are known.
    Hidden(HiddenWeights),
}

/// A filter of which nothing is known but its words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HiddenWeights {
    /// Why its weights are not known, in words: the reason of every metric that needs them.
    pub reason: &'static str,
    /// Samples over which its words are correlated, which stands for its memory.
    pub memory_samples: usize,
}

impl FilterShape {
    /// The outline of a filter whose weights are hidden.
    #[must_use]
    pub fn hidden(weights: HiddenWeights, register_samples: usize) -> Self {
        Self {
            taps: None,
            newest_age_samples: register_samples,
            register_samples,
            rule: WeightRule::Hidden(weights),
        }
    }

    /// Why nothing is known of the weights, if they are hidden.
    #[must_use]
    pub fn hidden_reason(&self) -> Option<&'static str> {
        match &self.rule {
            WeightRule::Hidden(hidden) => Some(hidden.reason),
            _ => None,
        }
    }
}

/// One second-order section of a recursive filter:
/// `H(z) = (b0 + b1 z^-1 + b2 z^-2) / (1 + a1 z^-1 + a2 z^-2)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// `b0, b1, b2`.
    pub numerator: [f64; 3],
    /// `a1, a2`.
    pub denominator: [f64; 2],
}

/// What a gyro is, in closed form, as the report prints it.
#[derive(Clone, Debug, PartialEq)]
pub struct GyroFacts {
    /// Sagnac scale factor `2 pi L D / (lambda c)`, s (rad per rad/s).
    pub scale_factor_s: f64,
    /// Rate at which the Sagnac phase is pi, and beyond which the loop may lock onto another fringe:
    /// `lambda c / 2 L D`, deg/s.
    pub single_fringe_range_deg_per_s: f64,
    /// Coil transit time, us.
    pub transit_time_us: f64,
    /// Proper (eigen) frequency `1 / 2 tau`, kHz.
    pub proper_frequency_khz: f64,
    /// Rate words per second, Hz.
    pub output_rate_hz: f64,
    /// Integrator gain g of the loop.
    pub loop_gain: f64,
    /// Closed-loop -3 dB bandwidth, Hz.
    pub loop_bandwidth_hz: f64,
    /// Delay of the rate word behind the motion at low frequency, ms.
    pub delay_ms: f64,
    /// Angle random walk by source of the detector, in the order of the gyro's list, and `total`;
    /// deg/sqrt(h).
    pub angle_random_walk_budget_deg_per_sqrt_h: Vec<(&'static str, f64)>,
    /// Sources in whose place one of the angle random walk of a data sheet stands; none where none is given.
    pub replaced_noise_sources: Vec<&'static str>,
}

/// A line of theory that a picture draws beside measured points.
#[derive(Clone, Debug, PartialEq)]
pub struct TheoryCurve {
    /// Name in the legend.
    pub name: &'static str,
    /// What `y` is, and over what.
    pub quantity: TheoryQuantity,
    /// Abscissae, ascending.
    pub x: Vec<f64>,
    /// Ordinates, as many.
    pub y: Vec<f64>,
}

/// Quantity of a [`TheoryCurve`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TheoryQuantity {
    /// Gain of the raw channel against the true rate, dB, over the frequency, Hz.
    GainDb,
    /// Its phase, deg, over the frequency, Hz.
    PhaseDeg,
    /// Mean output of the raw channel minus the true rate, deg/h, over the true rate, deg/h.
    RateErrorDegPerH,
}

/// Temperatures of a run and what they are predicted to do, at equally spaced times.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct TemperatureRecord {
    /// Times, s from the start of the warm-up.
    pub time_s: Vec<f64>,
    /// Chamber, deg C.
    pub chamber_c: Vec<f64>,
    /// Case and electronics, deg C.
    pub case_c: Vec<f64>,
    /// Mean of the coil, deg C.
    pub coil_c: Vec<f64>,
    /// Predicted thermal bias, deg/h.
    pub bias_deg_per_h: Vec<f64>,
    /// Predicted scale factor over its nominal value.
    pub scale_ratio: Vec<f64>,
}

/// One source in the noise budget of a gyro.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BudgetEntry {
    /// Name as in [`GyroFacts::angle_random_walk_budget_deg_per_sqrt_h`].
    pub source: &'static str,
    /// Angle random walk N, deg/sqrt(h).
    pub angle_random_walk_deg_per_sqrt_h: f64,
    /// Share of the noise power, 0..1; 0 where there is none at all.
    pub power_share: f64,
    /// White one-sided phase noise of the same angle random walk, `sqrt(2) N Ks`, urad/sqrt(Hz).
    pub phase_noise_urad_per_sqrt_hz: f64,
}

/// The noise budget at one power and modulation depth.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct BudgetPoint {
    /// Mean detected power over a fringe, uW.
    pub power_uw: f64,
    /// Modulation depth, deg.
    pub modulation_depth_deg: f64,
    /// Angle random walk by source and `total`, deg/sqrt(h); `None` where the bias point lies beyond
    /// the converter's range.
    pub angle_random_walk_deg_per_sqrt_h: Option<Vec<(&'static str, f64)>>,
}

impl BudgetPoint {
    /// Angle random walk of one source or of the total, deg/sqrt(h).
    #[must_use]
    pub fn walk(&self, source: &str) -> Option<f64> {
        let walks = self.angle_random_walk_deg_per_sqrt_h.as_ref()?;
        let (_, walk) = walks.iter().find(|(name, _)| *name == source)?;
        Some(*walk)
    }
}

/// The noise budget of a gyro in closed form, as the report prints it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct BudgetSheet {
    /// The configured power and depth.
    pub configured: BudgetPoint,
    /// Its sources, `total` last.
    pub entries: Vec<BudgetEntry>,
    /// As [`GyroFacts::replaced_noise_sources`].
    pub replaced_sources: Vec<&'static str>,
    /// Depth of least total at the configured power, searched for; `None` if no source depends on it.
    pub optimum: Option<BudgetPoint>,
    /// The same depth from its closed form, deg, whether the converter reaches it or not.
    pub closed_form_optimum_depth_deg: Option<f64>,
    /// Against modulation depth at the configured power.
    pub by_depth: Vec<BudgetPoint>,
    /// Against power at the configured depth.
    pub by_power: Vec<BudgetPoint>,
    /// Against power, each at its own best depth; empty if no source depends on the depth.
    pub by_power_at_optimum_depth: Vec<BudgetPoint>,
    /// Where the closed forms do not hold.
    pub cautions: Vec<String>,
}

/// The samples of one gyro of a run, borrowed: what the plots draw and the sample files hold.
///
/// All slices have the same length, but for a truth that is not known; index 0 is the first sample
/// of the warm-up and is stamped one sample period after the start.
#[derive(Clone, Debug)]
pub struct RunSignals<'a> {
    /// Sample period, s.
    pub sample_period_s: f64,
    /// Index of the first sample that metrics use.
    pub first_measured: usize,
    /// Prefix of the channels of this gyro: empty, or `x_`, `y_`, `z_` in an assembly.
    pub prefix: &'a str,
    /// Inertial rate of the axis at each stamp, deg/h; empty where nobody knows it.
    pub truth_deg_per_h: Rates<'a>,
    /// Angle that the table's encoder shows at each stamp, rad; none if the table has none.
    pub encoder_rad: Option<&'a [f64]>,
    /// Digest of the words that the filters are given, warm-up included; none where no samples are written
    /// or several gyros give them.
    pub input_digest: Option<String>,
    /// Channels in order, raw first: name and rate words, deg/h.
    pub channels: Vec<(&'a str, &'a [f64])>,
    /// Temperatures over the measured part; `None` where they never change.
    pub temperature: Option<TemperatureRecord>,
}

impl RunSignals<'_> {
    /// Stamps of the samples, s: each at the end of its period.
    pub fn stamps_s(&self) -> impl Iterator<Item = f64> {
        #[expect(
            clippy::cast_precision_loss,
            reason = "sample counts are far below 2^53"
        )]
        let stamp_s = |ordinal: usize| ordinal as f64 * self.sample_period_s;
        let words = self.channels.first().map_or(0, |(_, words)| words.len());
        (1..=words).map(stamp_s)
    }
}

/// What a compensation takes out of the outputs of an assembly, as the report shows it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CompensationSheet {
    /// `exact` or `first-order`.
    pub form: &'static str,
    /// Where the parameters come from.
    pub source: String,
    /// Biases of the gyros x, y, z, deg/h.
    pub bias_deg_per_h: [f64; 3],
    /// Scale-factor errors, ppm.
    pub scale_factor_error_ppm: [f64; 3],
    /// Small rotations by name: `xy` is that of gyro x about case axis y, arcsec.
    pub theta_arcsec: [(&'static str, f64); 6],
    /// Whether the biases follow the temperature of the coil.
    pub follows_temperature: bool,
    /// Mean true rates about the case axes x, y, z over the record, deg/h.
    pub rate_deg_per_h: [f64; 3],
    /// What the exact inverse would leave of these rates if the parameters were perfect, deg/h.
    pub exact_residual_deg_per_h: [f64; 3],
    /// What the first-order form would leave, deg/h.
    pub first_order_residual_deg_per_h: [f64; 3],
}
