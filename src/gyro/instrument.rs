//! The gyro as the rest of the bench sees it.

use std::f64::consts::{PI, TAU};

use crate::gyro::error::GyroError;
use crate::gyro::loop_model::LoopModel;
use crate::gyro::loop_model::faults::LoopFaults;
use crate::gyro::noise::NoiseConfig;
use crate::gyro::noise::budget::NoiseBudget;
use crate::gyro::noise::budget_sheet::with_rate_word;
use crate::gyro::noise::slow_noise::SlowNoiseConfig;
use crate::gyro::parts::{Parts, half_period_s};
use crate::gyro::rate_model::{RateModel, word_autocovariance};
use crate::gyro::rate_word::OutputQuantisation;
use crate::gyro::{Fidelity, GyroConfig};
use crate::random::Streams;
use crate::signal::{GyroFacts, MotionSegment};
use crate::units::{
    deg_per_sqrt_h_to_deg_per_h_sqrt_s, hz_to_khz, rad_per_s_to_deg_per_s, s_to_ms, s_to_us,
};

/// A gyro: motion segments in, rate words out.
///
/// ```
/// use fogbench::gyro::{self, CoilConfig, Fidelity, Gyro, GyroConfig};
/// use fogbench::random::Streams;
/// use fogbench::signal::MotionSegment;
/// use fogbench::units::deg_per_h_to_rad_per_s;
///
/// # fn main() -> Result<(), fogbench::gyro::GyroError> {
/// let reference = GyroConfig::reference();
/// let coil = CoilConfig { length_m: 1000.0, ..reference.coil };
/// let config = GyroConfig { coil, ..reference };
///
/// // What it ought to be, in closed form, and what it says at 3600 deg/h.
/// let facts = gyro::facts(&config)?;
/// let mut gyro = Gyro::new(&config, Fidelity::Rate, 1.0, &Streams::new(1, 0))?;
/// let turning = MotionSegment::constant(deg_per_h_to_rad_per_s(3600.0));
/// let words: Vec<f64> = (0..500).map(|_| gyro.next_word(&turning)).collect();
/// let settled = &words[100..];
/// let mean = settled.iter().sum::<f64>() / settled.len() as f64;
/// assert!((mean - 3600.0).abs() < 5.0);
/// assert!((facts.output_rate_hz * gyro.sample_period_s() - 1.0).abs() < 1e-12);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Gyro {
    model: Model,
}

#[derive(Clone, Debug)]
enum Model {
    Loop(Box<LoopModel>),
    Rate(Box<RateModel>),
}

impl Gyro {
    /// A gyro at rest in its first fringe, with the noise of `streams`.
    ///
    /// `simulated_time_s` is the length of the run, warm-up included; flicker is generated with
    /// correlation times up to ten times as long.
    ///
    /// # Errors
    /// Any [`GyroError`]: a bandwidth that the latency does not allow, no slope at the bias
    /// point, a bias point beyond the converter's range, an odd output sample.
    pub fn new(
        config: &GyroConfig,
        fidelity: Fidelity,
        simulated_time_s: f64,
        streams: &Streams,
    ) -> Result<Self, GyroError> {
        let model = match fidelity {
            Fidelity::Loop => {
                Model::Loop(Box::new(LoopModel::new(config, simulated_time_s, streams)?))
            }
            Fidelity::Rate => {
                Model::Rate(Box::new(RateModel::new(config, simulated_time_s, streams)?))
            }
        };
        Ok(Self { model })
    }

    /// What the linear model of a gyro makes of motion alone: no noise, no rounding, no vibration.
    ///
    /// # Errors
    /// Any [`GyroError`], as [`Gyro::new`].
    pub fn without_noise(config: &GyroConfig) -> Result<Self, GyroError> {
        let mut quiet = config.clone();
        let reference = GyroConfig::reference();
        quiet.noise = NoiseConfig {
            shot: false,
            thermal: false,
            amplifier: false,
            rin: false,
            technical_phase_urad_per_sqrt_hz: 0.0,
            ..quiet.noise
        };
        quiet.adc.bits = 0;
        quiet.modulator.dac_bits = 0;
        quiet.slow_noise = SlowNoiseConfig {
            bias_instability_deg_per_h: 0.0,
            rate_random_walk_deg_per_h_per_sqrt_h: 0.0,
            ..reference.slow_noise
        };
        quiet.output.quantisation = OutputQuantisation::RateWord;
        quiet.output.rate_lsb_deg_per_s = 0.0;
        quiet.vibration = reference.vibration;
        Self::new(&quiet, Fidelity::Rate, 1.0, &Streams::new(0, 0))
    }

    /// Time between rate words, s.
    #[must_use]
    pub fn sample_period_s(&self) -> f64 {
        match &self.model {
            Model::Loop(model) => model.sample_period_s(),
            Model::Rate(model) => model.sample_period_s(),
        }
    }

    /// Rate word of the output sample over which the gyro moves as `segment`, deg/h.
    ///
    /// The word is stamped at the end of the segment.
    pub fn next_word(&mut self, segment: &MotionSegment) -> f64 {
        self.next_word_over(std::slice::from_ref(segment))
    }

    /// Rate word of the output sample over which the gyro moves as `segments`, which share it equally,
    /// deg/h: fast motion takes several, see [`cubics_per_word`](crate::signal::cubics_per_word).
    pub fn next_word_over(&mut self, segments: &[MotionSegment]) -> f64 {
        match &mut self.model {
            Model::Loop(model) => model.next_word_over(segments),
            Model::Rate(model) => model.next_word_over(segments),
        }
    }

    /// Half periods in which the converter was beyond its range; 0 for the rate model, which has none.
    #[must_use]
    pub fn saturated_half_periods(&self) -> u64 {
        match &self.model {
            Model::Loop(model) => model.saturated_half_periods(),
            Model::Rate(_) => 0,
        }
    }

    /// Half periods with a phase error beyond a quarter turn; 0 for the rate model, which is linear.
    #[must_use]
    pub fn unlocked_half_periods(&self) -> u64 {
        match &self.model {
            Model::Loop(model) => model.unlocked_half_periods(),
            Model::Rate(_) => 0,
        }
    }

    /// Limits reached and fringes lost; none for the rate model.
    #[must_use]
    pub fn loop_faults(&self) -> LoopFaults {
        match &self.model {
            Model::Loop(model) => model.loop_faults(),
            Model::Rate(_) => LoopFaults::default(),
        }
    }
}

/// Time between rate words of a configuration, s: what a [`Gyro`] makes one word of.
#[must_use]
pub fn word_period_s(config: &GyroConfig) -> f64 {
    f64::from(config.output.half_periods_per_sample) * half_period_s(config)
}

/// Time between output samples of a configuration, s: so many words are averaged into one.
#[must_use]
pub fn sample_period_s(config: &GyroConfig) -> f64 {
    f64::from(config.output.average_samples) * word_period_s(config)
}

/// Loop periods averaged into one output sample; the mean of words is the mean over all of theirs.
fn periods_per_sample(config: &GyroConfig, parts: &Parts) -> f64 {
    let per_word = parts.half_periods / parts.timing.half_periods;
    f64::from(config.output.average_samples) * f64::from(per_word)
}

/// Gain and phase (rad) of the output samples against the motion at ascending frequencies, Hz.
///
/// The phase is continued from one frequency to the next at the delay of the one before, from the
/// delay at low frequency on.
///
/// # Errors
/// Any [`GyroError`], as [`Gyro::new`].
///
/// # Source
/// [`Controller::word_response`](crate::gyro::Controller::word_response).
pub fn word_response(
    config: &GyroConfig,
    frequencies_hz: &[f64],
) -> Result<Vec<(f64, f64)>, GyroError> {
    let parts = Parts::new(config)?;
    let periods = periods_per_sample(config, &parts);
    let controller = parts.controller;
    let mut delay_s = controller.word_delay_s(periods);
    let response = frequencies_hz.iter().map(|&frequency_hz| {
        let angular = TAU * frequency_hz;
        let (gain, phase) = controller.word_response(frequency_hz, periods);
        let turns = (phase + angular * delay_s) / TAU;
        let phase = phase - TAU * turns.round();
        delay_s = -phase / angular;
        (gain, phase)
    });
    Ok(response.collect())
}

/// Noise of the output samples in closed form: what a second-order theory of filters needs.
#[derive(Clone, Debug, PartialEq)]
pub struct WordNoise {
    /// Autocovariance of the fast noise by lag in output samples, (deg/h)^2.
    pub autocovariance_deg2_per_h2: Vec<f64>,
    /// Angle random walk with the rounding of the words, deg/sqrt(h).
    pub angle_random_walk_deg_per_sqrt_h: f64,
    /// Relative standard deviation of that walk over where the level lies between two codes of the converter,
    /// which the closed form leaves open.
    pub walk_scatter_by_level: f64,
    /// Time between output samples, s.
    pub sample_period_s: f64,
}

/// The noise of the output samples of a configuration at the start, `lags` lags of it.
///
/// It is that of [`RateModel`]. Fast noise alone: flicker and random walk of the rate are of no power
/// beside it.
///
/// # Errors
/// Any [`GyroError`], as [`Gyro::new`].
pub fn word_noise(config: &GyroConfig, lags: usize) -> Result<WordNoise, GyroError> {
    let parts = Parts::new(config)?;
    let averaged = config.output.average_samples as usize;
    let budget = with_rate_word(NoiseBudget::new(&parts.detector, &parts.coil), config);
    let total = budget.total_deg_per_sqrt_h();
    let detection = budget.detection_deg_per_sqrt_h();
    let rounding = (total * total - detection * detection).max(0.0).sqrt();
    let mut words = word_autocovariance(&parts, (lags + 1) * averaged);
    if let Some(variance) = words.first_mut() {
        *variance += deg_per_sqrt_h_to_deg_per_h_sqrt_s(rounding).powi(2) / word_period_s(config);
    }
    // Of means over `a` words: those of pairs `l a + i - j` apart.
    let of_means = |lag: usize| {
        let pairs = (0..averaged).flat_map(|i| (0..averaged).map(move |j| (i, j)));
        let sum: f64 = pairs
            .map(|(i, j)| words[(lag * averaged + i).abs_diff(j)])
            .sum();
        sum / (averaged * averaged) as f64
    };
    Ok(WordNoise {
        autocovariance_deg2_per_h2: (0..lags).map(of_means).collect(),
        angle_random_walk_deg_per_sqrt_h: total,
        walk_scatter_by_level: budget.scatter_by_level(&parts.detector, &parts.coil),
        sample_period_s: sample_period_s(config),
    })
}

/// What the gyro of a configuration is, in closed form, at the start of the simulation.
///
/// At constant temperature that is what it is throughout.
///
/// # Errors
/// Any [`GyroError`], as [`Gyro::new`].
pub fn facts(config: &GyroConfig) -> Result<GyroFacts, GyroError> {
    let parts = Parts::new(config)?;
    let periods = periods_per_sample(config, &parts);
    let Parts {
        coil,
        detector,
        controller,
        condition,
        ..
    } = parts;
    let is_gain_nominal =
        config.controller.automatic_gain_control || (condition.power_ratio - 1.0).abs() <= 0.0;
    Ok(GyroFacts {
        scale_factor_s: coil.scale_factor_s,
        single_fringe_range_deg_per_s: rad_per_s_to_deg_per_s(PI / coil.scale_factor_s),
        transit_time_us: s_to_us(coil.transit_time_s),
        proper_frequency_khz: hz_to_khz(coil.proper_frequency_hz()),
        output_rate_hz: sample_period_s(config).recip(),
        loop_gain: controller.gain,
        loop_bandwidth_hz: if is_gain_nominal {
            config.controller.loop_bandwidth_hz
        } else {
            controller.bandwidth_hz()
        },
        delay_ms: s_to_ms(controller.word_delay_s(periods)),
        angle_random_walk_budget_deg_per_sqrt_h: with_rate_word(
            NoiseBudget::new(&detector, &coil),
            config,
        )
        .entries(),
        replaced_noise_sources: detector.densities.replaced(),
    })
}
