//! Measures: what a record of rate words says, and how sure it is.
//!
//! Invariant: metrics see samples, a sample period and plain parameters; never a scenario, a gyro
//! or a filter. Everything is in deg/h and s; the angle of an encoder is in rad.
//!
//! [`measure`] turns one channel's [`Record`] into a [`ChannelMetrics`]; [`aggregate`] pools
//! independent repeats. The estimators stand alone as well: [`overlapping_allan`], [`fit_noise`],
//! [`block_means`], [`welch`], [`fit_swing`], [`noise_delay_bound`], [`predict`],
//! [`settling`](fn@settling), [`fit_scale_factor`], [`fit_tones`].
//!
//! The rooms, each of which uses those before it alone:
//!
//! | room | subject |
//! |---|---|
//! | `key` | what a metric and a curve declare of themselves |
//! | `estimate` | numbers with intervals, reasons, the table of one channel |
//! | `theory` | what a filter will do to a record, the least noise at a delay, what reads like less noise |
//! | `allan` | Allan variances and the noise terms fitted to them: random walk, bias instability, ramp |
//! | `record` | what a measurement is given |
//! | `steps` | settling, overshoot, scale factor, threshold, dead band |
//! | `sine` | fits of sines: one frequency, a free one, many |
//! | `noise` | noise about the signal: level, colour, spectrum, bias stability |
//! | `expected` | what the figures of a record are expected to be, and how far records scatter |
//! | `trial` | what a filter does: DC gain, delay, noise-delay bound, readaptation |
//! | `motion` | the metrics of each kind of motion: steady, swing, several sines, steps, any other |
//! | `temperature` | bias and scale factor of a log against a temperature and its rate |
//! | `verdict` | what the metrics say a filter did |
//! | `equal_delay` | noise beside that of a mean of the same delay, and what a word costs |
//! | `catalogue` | the list of metrics, their names, and which records support them |
//! | `pool` | independent repeats, and conditions compared |
//! | `measure` | all of it for one channel |
//! | `quality` | what is the matter with the words of a log: outliers, smoothing |
//! | `stream` | records too long to be kept, measured while their words come in |

mod allan;
mod calibration;
pub mod catalogue;
mod equal_delay;
mod estimate;
mod expected;
mod key;
mod measure;
mod motion;
mod noise;
mod pipeline;
mod pool;
mod quality;
mod record;
mod sine;
mod state_space;
mod steps;
mod stream;
mod temperature;
mod theory;
mod trial;
mod verdict;

pub use allan::coefficients::{NoiseCoefficients, mixed_degrees_of_freedom};
pub use allan::covariance::FLICKER_ALLAN_VARIANCE;
pub use allan::judge::goodness::Goodness;
pub use allan::least_squares::correlated_allan_variance;
pub use allan::noise_fit::{
    CorrelatedNoise, FIT_TAU_PER_RECORD_MAX, FitRange, NoiseFit, Sine, Term, fit_noise,
    fit_pooled_noise, sine_allan_variance,
};
pub use allan::noise_identification::PowerLaw;
pub use allan::overlapping::{
    AllanPoint, NoiseType, degrees_of_freedom, overlapping_allan, overlapping_allan_across,
    overlapping_allan_at,
};
pub use allan::pulses::answer::{PulseAnswer, PulseMethod};
pub use allan::stream::AllanStream;
pub use allan::variants::{
    AllanEstimator, AllanOptions, AllanVariantPoint, allan_variant, allan_variant_across,
    allan_variant_at,
};
pub(crate) use catalogue::names::{meant, unknown, unknown_of_channel};
pub use catalogue::support::{encoder_lack, requirement, support, truth_lack};
pub use catalogue::{columns, find, known_curves, known_metrics, repeated_metrics};
pub(crate) use equal_delay::put_beside_others;
pub use estimate::blocks::{block_label_s, block_means, is_sample_or_longer, samples_in};
pub use estimate::fit_sheet::{FitSheet, FitTerm};
pub(crate) use estimate::interval::NORMAL_QUANTILE;
pub use estimate::missing::MissingMetric;
pub use estimate::outlier_sheet::OutlierEntry;
pub use estimate::reason::Unavailable;
pub use estimate::repeat_statistics::RepeatStatistics;
pub use estimate::table::{ChannelFailure, ChannelMetrics};
pub(crate) use estimate::text::{estimate_text, is_exact, plain, three_digits, wants_exponent};
pub use estimate::two_runs::{DifferenceSums, TwoRuns};
pub use estimate::value::{Estimate, IntervalKind, Metric};
pub use expected::allan::{AllanGeometry, ExpectedAllan};
pub use expected::blocks::{BlockGeometry, ExpectedBlocks};
pub use expected::channel::{ChannelTheory, ExpectedFigure, KnownSine, Words, largest_of_normals};
pub use key::curve::{Column, Curve, CurveKey};
pub(crate) use key::metric::{Against, Headline, Table};
pub use key::metric::{Applies, Better, MetricKey, OfBlocks};
pub use measure::measure;
pub(crate) use measure::measure_present;
pub use motion::step_figures::StepFigures;
pub use noise::autocovariance::autocovariance;
pub use noise::bias_stability::{
    effective_degrees_of_freedom, expected_bias_stability, paired_ratio,
};
pub use noise::memory::{correlation_length_samples, record_fit_tau_min_s};
pub use noise::other_noise::{noise_beside_steps, noise_like};
pub use noise::spectrum::{Spectrum, log_binned, segment_samples, welch};
pub use noise::truth_response::known_motion;
pub(crate) use pipeline::{FIXED_POINT_ONLY, OVERFLOWS};
pub use pool::aggregate::aggregate;
pub use pool::pooling::Pooling;
pub use pool::repeatability::repeats_lack;
pub use pool::sensitivity::{ConditionPoint, change_divisor, largest_change_per_unit};
pub use quality::examine::Examination;
pub use quality::outliers::{Outlier, Outliers, find_outliers};
pub use quality::smoothing::{Smoothed, Smoothing, find_smoothing};
pub use record::{Dwell, FilterFacts, Motion, RateGain, Record, Settings, Staircase};
pub use sine::correlation::correlation_delay_s;
pub use sine::fit::{SineFit, SwingClock, SwingFit, fit_sine, fit_swing};
pub use sine::free_frequency::{FreeSineFit, fit_sine_free_frequency};
pub use sine::tones::{ToneClock, ToneFits, ToneResponse, bandwidth_hz, fit_tones};
pub use state_space::{FlickerBank, State, StateSpace, noise_state_space};
pub use steps::dwells::find_dwells;
pub use steps::nonlinearity::{Nonlinearity, Residual, expected_largest};
pub use steps::points::fit_points;
pub use steps::scale_factor::{
    Asymmetry, RATES_MIN, RATES_PER_SENSE_MIN, RatePoint, ScaleFactorFit, StaticZero,
    distinct_rates, distinct_rates_by_sense, fit_scale_factor, scale_factor_repeatability,
    scale_factor_temperature_sensitivity,
};
pub use steps::settling::{Settling, settling};
pub use steps::shape::Step;
pub use steps::small_input::smallest_answered;
pub use stream::words::{NOT_STREAMED, StreamLack, WordStream};
pub use temperature::coefficients::measure_temperature;
pub(crate) use temperature::keys::{
    APPLIED, BEFORE, MEAN_LENGTH, P_VALUE, REFERENCE, TEMPERATURE_METRICS,
};
pub use temperature::means::WarmRecord;
pub use temperature::without::{
    WarmWords, Warmed, temperature_rates_k_per_min, words_at_reference,
};
pub use theory::bound::{
    LeastNoise, NoiseDelayBound, bound_taps, noise_delay_bound, noise_delay_bound_coloured,
    noise_power_gain,
};
pub use theory::claim::{Claim, ClaimedFigure, Lookalikes};
pub use theory::learning::Learning;
pub use theory::memory::memory_samples;
pub use theory::prediction::{Prediction, lags_needed, predict};
pub use trial::black_box::{BlackBox, TwinFigure};
pub(crate) use trial::black_box::{
    REACHES_START, SINE_DELAY_MS, SINE_FREQUENCY, STEP_GAINS, put_black_box,
};
pub use trial::readaptation::{GainUnits, Readaptation};
pub use verdict::{AgainstOne, Deed, FilterVerdict, Finding, filter_verdict};
