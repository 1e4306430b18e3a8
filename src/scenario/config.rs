//! The configuration of one run, as the stages receive it.
//!
//! Field names are the keys of the scenario file, units included; ranges and defaults stand in
//! `scenarios/reference.toml`. Values of these types come out of the reader only, which has
//! checked them; nothing here has a `Default`.

use serde::Deserialize;

/// One resolved run.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// Version of the file format, 1.
    pub schema: u32,
    /// Name: `[a-z0-9][a-z0-9_-]{0,63}`; the folder under `output/`.
    pub name: String,
    /// What the experiment shows, one sentence.
    pub description: Option<String>,
    /// Seed of every noise stream.
    pub seed: u64,
    /// Number of independent noise records.
    pub repeats: u32,
    /// Time measured, s.
    pub duration_s: f64,
    /// Time simulated and filtered before it, left out of every metric, s.
    pub warm_up_s: f64,
    /// Gyro model.
    pub fidelity: Fidelity,
    /// Averaging time of the plain `bias_stability_deg_per_h`, s.
    pub bias_averaging_time_s: f64,
    /// Table motion, servo and site.
    pub turntable: TurntableConfig,
    /// The gyro.
    pub gyro: GyroConfig,
    /// Filters, in the order of the file.
    #[serde(default, rename = "filter")]
    pub filters: Vec<FilterConfig>,
    /// Gates, in the order of the file.
    #[serde(default, rename = "gate")]
    pub gates: Vec<GateConfig>,
    /// Published figures to print beside the simulated ones.
    #[serde(default)]
    pub published: Vec<PublishedConfig>,
    /// What to write.
    pub output: OutputConfig,
}

/// Which gyro model runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fidelity {
    /// Every half modulation period.
    Loop,
    /// Output-rate equivalent.
    Rate,
}

/// Rate table: exactly one motion.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct TurntableConfig {
    /// What the table is told to do (`[turntable.static]`, `.swing`, `.steps` or `.rotation`).
    #[serde(flatten)]
    pub motion: MotionConfig,
    /// How the table follows (`[turntable.servo.ideal]` or `.second_order`).
    pub servo: ServoConfig,
    /// Where the table stands and where its axis points.
    pub site: SiteConfig,
}

/// Commanded motion.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MotionConfig {
    /// At rest.
    Static(StaticConfig),
    /// Sine rate.
    Swing(SwingConfig),
    /// A staircase of rates.
    Steps(StepsConfig),
    /// Constant rate.
    Rotation(RotationConfig),
}

/// At rest: nothing to set.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StaticConfig {}

/// Swing about the table axis; exactly one amplitude is given.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SwingConfig {
    /// Rate amplitude, deg/s.
    pub rate_amplitude_deg_per_s: Option<f64>,
    /// Angle amplitude, deg; the rate amplitude is `2 pi f` times this.
    pub angle_amplitude_deg: Option<f64>,
    /// Swing frequency, Hz.
    pub frequency_hz: f64,
    /// Raised-cosine soft start, s, inside the warm-up.
    pub soft_start_s: f64,
}

/// Staircase: each rate is held for the dwell time; the last one is held for ever.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StepsConfig {
    /// Rates, deg/s, in order.
    pub rates_deg_per_s: Vec<f64>,
    /// Time at each rate, s; the first dwell begins at the end of the warm-up, before which the
    /// first rate is held. Steps fall on output-sample boundaries.
    pub dwell_s: f64,
}

/// Constant rotation.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RotationConfig {
    /// Rate, deg/s.
    pub rate_deg_per_s: f64,
    /// Raised-cosine soft start, s, inside the warm-up.
    pub soft_start_s: f64,
}

/// How the table follows its command.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ServoConfig {
    /// The axis is the command.
    Ideal(StaticConfig),
    /// Second-order low pass.
    SecondOrder(SecondOrderServoConfig),
}

/// `H(s) = wn^2 / (s^2 + 2 zeta wn s + wn^2)` from commanded to actual rate.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SecondOrderServoConfig {
    /// Natural frequency `wn / 2 pi`, Hz.
    pub natural_frequency_hz: f64,
    /// Damping ratio zeta.
    pub damping_ratio: f64,
}

/// Site and pointing of the table axis, which is the gyro's input axis.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SiteConfig {
    /// Geodetic latitude, deg, north positive.
    pub latitude_deg: f64,
    /// Elevation of the input axis above the horizon, deg (90 = up).
    pub axis_elevation_deg: f64,
    /// Azimuth of the input axis from north towards east, deg.
    pub axis_azimuth_deg: f64,
}

/// The gyro.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GyroConfig {
    /// Fibre coil.
    pub coil: CoilConfig,
    /// Light source.
    pub source: SourceConfig,
    /// Phase modulator and its converter.
    pub modulator: ModulatorConfig,
    /// Photodetector and amplifier.
    pub detector: DetectorConfig,
    /// Analogue-to-digital converter.
    pub adc: AdcConfig,
    /// Feedback loop.
    pub controller: ControllerConfig,
    /// Fast noise sources and how they are drawn.
    pub noise: NoiseConfig,
    /// Slow noise of the rate.
    pub slow_noise: SlowNoiseConfig,
    /// Temperature.
    pub temperature: TemperatureConfig,
    /// Rate word.
    pub output: RateOutputConfig,
}

/// Fibre coil.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CoilConfig {
    /// Fibre length, m.
    pub length_m: f64,
    /// Mean coil diameter, mm.
    pub diameter_mm: f64,
    /// Group index of the fibre; sets the transit time, not the scale factor.
    pub group_index: f64,
}

/// Light source and interferometer.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SourceConfig {
    /// Mean vacuum wavelength, nm.
    pub wavelength_nm: f64,
    /// Mean detected power P0 over a fringe, uW (half of the fringe maximum).
    pub power_uw: f64,
    /// Full width at half maximum of the Gaussian spectrum, nm.
    pub linewidth_nm: f64,
    /// Degree of polarisation at the detector, 0..1.
    pub polarisation_degree: f64,
    /// Fringe visibility V, 0..1.
    pub visibility: f64,
}

/// Phase modulator.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModulatorConfig {
    /// Two-state square-wave modulation depth `phi_m`, deg.
    pub depth_deg: f64,
    /// Bits of the ramp converter over 2 pi; 0 = ideal.
    pub dac_bits: u32,
}

/// Photodetector, transimpedance amplifier and gate.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DetectorConfig {
    /// Responsivity, A/W.
    pub responsivity_a_per_w: f64,
    /// Dark current, nA.
    pub dark_current_na: f64,
    /// Transimpedance, kOhm.
    pub transimpedance_kohm: f64,
    /// Voltage gain after the transimpedance stage.
    pub post_gain: f64,
    /// Amplifier voltage noise, nV/sqrt(Hz).
    pub voltage_noise_nv_per_sqrt_hz: f64,
    /// Amplifier current noise, pA/sqrt(Hz).
    pub current_noise_pa_per_sqrt_hz: f64,
    /// Fraction of each half period that is gated into the demodulator.
    pub gate_duty: f64,
}

/// Analogue-to-digital converter.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AdcConfig {
    /// Bits; 0 = ideal (no quantisation, no saturation).
    pub bits: u32,
    /// Range, V: codes cover 0 .. range.
    pub range_v: f64,
    /// Samples averaged per half period.
    pub samples_per_half_period: u32,
}

/// Digital controller.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ControllerConfig {
    /// Closed-loop -3 dB bandwidth, Hz; sets the integrator gain.
    pub loop_bandwidth_hz: f64,
    /// Pipeline latency in modulation periods, 0..=3.
    pub loop_latency_periods: u32,
}

/// Fast noise sources.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NoiseConfig {
    /// Shot noise of the photocurrent.
    pub shot: bool,
    /// Thermal (Johnson) noise of the transimpedance.
    pub thermal: bool,
    /// Amplifier voltage and current noise.
    pub amplifier: bool,
    /// Relative intensity noise of the source.
    pub rin: bool,
    /// How the noise is drawn.
    pub draw: NoiseDraw,
}

/// How fast noise is drawn in the loop model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NoiseDraw {
    /// One normal per half period with the variance of all sources.
    Combined,
    /// Every source and every ADC sample drawn on its own.
    Exact,
}

/// Slow noise of the rate.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SlowNoiseConfig {
    /// Constant bias, deg/h.
    pub bias_deg_per_h: f64,
    /// Flicker (bias instability) coefficient B, deg/h.
    pub bias_instability_deg_per_h: f64,
    /// Rate random walk coefficient K, deg/h/sqrt(h).
    pub rate_random_walk_deg_per_h_per_sqrt_h: f64,
    /// Rate ramp R, deg/h/h.
    pub rate_ramp_deg_per_h_per_h: f64,
}

/// Temperature: exactly one profile.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TemperatureConfig {
    /// Constant temperature.
    Soak(SoakConfig),
}

/// Constant temperature.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SoakConfig {
    /// Temperature of everything, deg C.
    pub temperature_c: f64,
}

/// Rate word.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RateOutputConfig {
    /// Half modulation periods averaged into one rate word (even).
    pub half_periods_per_sample: u32,
    /// Least significant bit of the rate word, deg/s, rounded without carry; 0 = not rounded.
    pub rate_lsb_deg_per_s: f64,
}

/// One filter channel.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct FilterConfig {
    /// Channel name.
    pub name: String,
    /// Kind and settings (`[filter.rls]` or `[filter.lms]`).
    #[serde(flatten)]
    pub kind: FilterKind,
}

/// Kind of a filter and its settings.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FilterKind {
    /// Recursive least squares.
    Rls(RlsFilterConfig),
    /// Least mean squares, normalised or not.
    Lms(LmsFilterConfig),
}

/// Recursive least squares.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RlsFilterConfig {
    /// Number of weights p.
    pub taps: u32,
    /// Forgetting factor alpha, (0, 1].
    pub forgetting_factor: f64,
    /// Initial inverse correlation delta, (deg/h)^-2.
    pub initial_inverse_correlation: f64,
    /// Desired signal.
    pub desired: DesiredSignal,
    /// Samples by which the regressors lag the desired signal's newest sample.
    pub input_lag_samples: u32,
    /// When the result appears.
    pub output_register: OutputRegister,
    /// Sign of the weight update.
    pub update_sign: UpdateSign,
    /// Arithmetic.
    pub pipeline: Pipeline,
}

/// Least mean squares.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LmsFilterConfig {
    /// Number of weights N.
    pub taps: u32,
    /// Step size mu.
    pub step_size: f64,
    /// Whether the step is divided by the input's energy (NLMS).
    pub normalised: bool,
    /// Added to the energy (normalised form), (deg/h)^2.
    pub regularisation_deg2_per_h2: f64,
    /// Run an un-normalised step beyond its stability bound.
    pub allow_unstable: bool,
    /// Desired signal.
    pub desired: DesiredSignal,
    /// Samples by which the regressors lag the desired signal's newest sample.
    pub input_lag_samples: u32,
    /// When the result appears.
    pub output_register: OutputRegister,
    /// Sign of the weight update.
    pub update_sign: UpdateSign,
    /// Arithmetic.
    pub pipeline: Pipeline,
}

/// What an adaptive filter aims at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DesiredSignal {
    /// The current sample.
    Current,
    /// The mean of the newest two samples.
    TwoSampleMean,
}

/// When a filter's result appears.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum OutputRegister {
    /// At the next sample tick.
    NextSample,
    /// As soon as it is computed.
    Immediate,
}

/// Sign before the error term of the weight update.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum UpdateSign {
    /// Plus: the form that converges.
    Corrected,
    /// Minus, as the paper's equations (6) and (9) print it: diverges.
    AsPrinted,
}

/// Arithmetic of a filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Pipeline {
    /// The textbook recursion.
    Textbook,
}

/// A limit on a metric.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GateConfig {
    /// `<channel>.<metric>`, split at the last dot.
    pub metric: String,
    /// Lower limit, in the metric's unit.
    pub min: Option<f64>,
    /// Upper limit, in the metric's unit.
    pub max: Option<f64>,
    /// Channel whose same metric divides this one.
    pub relative_to: Option<String>,
    /// What is compared.
    pub decide: GateDecision,
    /// What an undecided interval means.
    pub inconclusive: InconclusivePolicy,
}

/// What a gate compares.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GateDecision {
    /// The whole interval.
    Interval,
    /// The value alone.
    Value,
}

/// What becomes of an inconclusive gate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum InconclusivePolicy {
    /// It fails.
    Fail,
    /// It is reported and allowed.
    Allow,
}

/// A published figure: shown beside the simulated one, never gated.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PublishedConfig {
    /// `<channel>.<metric>`.
    pub metric: String,
    /// The figure.
    pub value: f64,
    /// Its unit.
    pub unit: String,
    /// Where it was published.
    pub source: String,
}

/// What to write besides the report.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OutputConfig {
    /// Rate words of every channel.
    pub samples: SamplesFormat,
}

/// Format of the rate words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SamplesFormat {
    /// Not written.
    None,
    /// One NPY file per channel.
    Npy,
}
