//! The configuration of the rate table: names are the keys of the scenario file, units included.

use serde::Deserialize;

use super::calibration_config::CampaignConfig;
use super::servo_config::{DirectDriveServoConfig, EncoderConfig};

/// Rate table: exactly one motion.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct TurntableConfig {
    /// What the table is told to do (`[turntable.static]`, `.swing`, `.steps`, ...).
    #[serde(flatten)]
    pub motion: MotionConfig,
    /// How the table follows (`[turntable.servo.ideal]`, `.second_order` or `.direct_drive`).
    pub servo: ServoConfig,
    /// What a laboratory sees of the axis; a direct drive is steered by it.
    pub encoder: EncoderConfig,
    /// Where the table stands and where its axis points.
    pub site: SiteConfig,
    /// How the axis departs from its pointing.
    pub axis: AxisConfig,
    /// How the gyro sits on the platform.
    pub mounting: MountingConfig,
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
    /// Trapezoids of rate.
    Trapezoid(TrapezoidConfig),
    /// A swing whose frequency sweeps.
    Chirp(ChirpConfig),
    /// A table of rates or angles.
    Script(ScriptConfig),
    /// Groups of constant rate in changing mountings.
    Calibration(CampaignConfig),
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

/// Trapezoids of rate: accelerate, hold, decelerate, rest; the first begins with the record.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrapezoidConfig {
    /// Rate at the top, deg/s.
    pub rate_deg_per_s: f64,
    /// Acceleration of both ramps in magnitude, deg/s^2.
    pub acceleration_deg_per_s2: f64,
    /// Time at the top, s.
    pub hold_s: f64,
    /// Time at rest after each, s.
    pub rest_s: f64,
    /// How often it is repeated.
    pub cycles: u32,
    /// Whether each is followed by one the other way.
    pub both_senses: bool,
}

impl TrapezoidConfig {
    /// Number of trapezoids, those of both senses.
    #[must_use]
    pub fn count(&self) -> u32 {
        self.cycles * if self.both_senses { 2 } else { 1 }
    }

    /// Time from the start of the first to the end of the last, s.
    #[must_use]
    pub fn length_s(&self) -> f64 {
        let count = f64::from(self.count());
        let ramp_s = self.rate_deg_per_s.abs() / self.acceleration_deg_per_s2;
        count * (2.0 * ramp_s + self.hold_s) + (count - 1.0) * self.rest_s
    }
}

/// Sine sweep: a swing at the first frequency through the warm-up, the sweep from the start of the
/// record, then the soft stop at the last frequency and rest.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChirpConfig {
    /// Rate amplitude, deg/s.
    pub rate_amplitude_deg_per_s: Option<f64>,
    /// Angle amplitude, deg; the rate amplitude is `2 pi f` times this at every frequency.
    pub angle_amplitude_deg: Option<f64>,
    /// Frequency before the sweep, Hz.
    pub start_frequency_hz: f64,
    /// Frequency after the sweep, Hz.
    pub end_frequency_hz: f64,
    /// Length of the sweep, s.
    pub sweep_s: f64,
    /// How the frequency moves.
    pub progression: Progression,
    /// Raised-cosine soft start, s, inside the warm-up.
    pub soft_start_s: f64,
    /// Raised-cosine soft stop, s, after the sweep.
    pub soft_stop_s: f64,
}

/// How the frequency of a sweep moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Progression {
    /// By as many hertz in every second.
    Linear,
    /// By the same factor in every second.
    Logarithmic,
}

/// A motion given point by point.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScriptConfig {
    /// The points; the reader has put those of a file in their place.
    pub points: ScriptPoints,
}

/// Points of a script; exactly one of rates and angles is given, as many as there are times.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScriptPoints {
    /// Times from the start of the record, s; the first is 0 and each is later than the last.
    pub time_s: Vec<f64>,
    /// Rates, deg/s, joined by straight lines.
    pub rate_deg_per_s: Option<Vec<f64>>,
    /// Angles, deg, joined by monotone cubics.
    pub angle_deg: Option<Vec<f64>>,
}

/// How the table follows its command.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ServoConfig {
    /// The axis is the command.
    Ideal(StaticConfig),
    /// Second-order low pass.
    SecondOrder(SecondOrderServoConfig),
    /// Motor, friction and a sampled controller.
    DirectDrive(DirectDriveServoConfig),
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

/// Site and nominal pointing of the table axis.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SiteConfig {
    /// Geodetic latitude, deg, north positive.
    pub latitude_deg: f64,
    /// Elevation of the table axis above the horizon, deg (90 = up).
    pub axis_elevation_deg: f64,
    /// Azimuth of the table axis from north towards east, deg.
    pub axis_azimuth_deg: f64,
}

/// Errors of the table axis.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AxisConfig {
    /// How far the axis leans towards north, arcsec.
    pub tilt_north_arcsec: f64,
    /// How far the axis leans towards east, arcsec.
    pub tilt_east_arcsec: f64,
    /// Half angle of the cone on which the platform normal goes round the axis, arcsec.
    pub wobble_arcsec: f64,
    /// Rounds of the normal per turn of the table, 1 or 2.
    pub wobble_harmonic: u32,
}

/// How the gyro, or the case of a three-axis assembly, sits on the platform.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MountingConfig {
    /// Angle between the input axis and the platform normal, arcsec.
    pub misalignment_arcsec: f64,
    /// Direction in which the input axis leans, deg about the normal from the platform's mark.
    pub misalignment_azimuth_deg: f64,
    /// Table angle at the start of the warm-up, deg.
    pub start_angle_deg: f64,
    /// Which axis of an assembly's case lies along the platform normal.
    pub axis_along_table: CaseAxis,
}

/// An axis of the case of a three-axis assembly; x, y, z are right-handed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CaseAxis {
    /// The x axis.
    X,
    /// The y axis.
    Y,
    /// The z axis.
    Z,
}
