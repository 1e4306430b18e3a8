//! The configuration of the rate table: names are the keys of the scenario file, units included.

use serde::Deserialize;

/// Rate table: exactly one motion.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct TurntableConfig {
    /// What the table is told to do (`[turntable.static]`, `.swing`, `.multi_sine`, `.steps` or `.rotation`).
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
    /// Several sines of rate at once.
    MultiSine(MultiSineConfig),
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

/// Several sines of rate at once, for a frequency response from one record.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MultiSineConfig {
    /// Frequencies, Hz, ascending.
    pub frequencies_hz: Vec<f64>,
    /// Rate amplitudes, deg/s: one for all frequencies, or one for each.
    pub rate_amplitudes_deg_per_s: Vec<f64>,
    /// Rule for the phases.
    pub phases: PhaseRule,
    /// Raised-cosine soft start, s, inside the warm-up.
    pub soft_start_s: f64,
}

impl MultiSineConfig {
    /// Rate amplitude of tone `index`, deg/s.
    ///
    /// # Panics
    /// If there is neither one amplitude nor one for each frequency; the reader refuses that.
    #[must_use]
    pub fn rate_amplitude_deg_per_s(&self, index: usize) -> f64 {
        match self.rate_amplitudes_deg_per_s.as_slice() {
            [common] => *common,
            each => each[index],
        }
    }
}

/// Phases of several sines, which decide how high their sum peaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PhaseRule {
    /// Cosines, by the power in the tones below (Schroeder).
    Schroeder,
    /// Cosines of phase `pi (k - 1)^2 / K` (Newman).
    Newman,
    /// All zero: every sine rises through zero at the start.
    Zero,
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
    /// Time at the start of each dwell that the scale factor leaves out, s.
    pub settle_s: f64,
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
