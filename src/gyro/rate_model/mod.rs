//! Gyro model at the output rate, for long runs.

mod matrices;
mod second_order;

use crate::gyro::GyroConfig;
use crate::gyro::controller::Controller;
use crate::gyro::error::GyroError;
use crate::gyro::noise::budget::NoiseBudget;
use crate::gyro::noise::slow_noise::SlowNoise;
use crate::gyro::optics::coil::Coil;
use crate::gyro::parts::Parts;
use crate::gyro::rate_model::matrices::RateMatrices;
use crate::gyro::rate_model::second_order::RateOptics;
use crate::gyro::rate_word::RateWord;
use crate::gyro::thermal::condition::{Condition, Schedule};
use crate::gyro::vibration::{VibrationResponse, tones};
use crate::random::{Stream, Streams};
use crate::signal::MotionSegment;
use crate::units::{deg_per_sqrt_h_to_rad_per_sqrt_s, rad_per_s_to_deg_per_h};

/// The linearised loop, one output sample at a time.
///
/// The same recursion as the loop model with `e = phi_s - r + n` in place of the fringe, advanced
/// over all loop periods of an output sample at once: same mean, bandwidth, delay, noise colour and
/// Allan deviation, at a cost that does not depend on the number of half periods per sample. The
/// noise n has the variance of the whole budget, converter rounding included:
/// `sigma_e^2 T_L = (N Ks)^2`. Left out: the sine of the fringe (matters for phase errors beyond
/// about 0.1 rad), single resets, the noise of the second loop's estimates, and the ramp converter's
/// rounding, which is bounded in angle. Vibration is the settled loop's answer to its tones and the
/// mean that they rectify to.
#[derive(Clone, Debug)]
pub struct RateModel {
    coil: Coil,
    controller: Controller,
    matrices: RateMatrices,
    /// Sagnac phases of the cubics of a word, rad.
    phases_rad: Vec<[f64; 4]>,
    state_rad: [f64; 4],
    noise_rad: f64,
    sample_period_s: f64,
    stream: Stream,
    vibration: Option<VibrationResponse>,
    slow_noise: SlowNoise,
    rate_word: RateWord,
    optics: RateOptics,
    condition: Condition,
    /// Absent where the temperature never changes.
    varying: Option<Box<Varying>>,
}

/// What it takes to follow the temperature.
#[derive(Clone, Debug)]
struct Varying {
    schedule: Schedule,
    config: GyroConfig,
}

impl RateModel {
    /// The model of a configuration; `simulated_time_s` bounds the flicker's correlation times.
    ///
    /// # Errors
    /// Any [`GyroError`].
    pub fn new(
        config: &GyroConfig,
        simulated_time_s: f64,
        streams: &Streams,
    ) -> Result<Self, GyroError> {
        let parts = Parts::new(config)?;
        let vibration = VibrationResponse::new(tones(&config.vibration, streams), &parts);
        let half_periods = parts.half_periods;
        let sample_period_s = f64::from(half_periods) * parts.half_period_s;
        let fringe = (parts.detector.visibility, parts.modulator.depth_rad);
        let mut optics = RateOptics::new(parts.optics, fringe, half_periods, streams);
        optics.set_drift(parts.condition.modulator_gain_error);
        Ok(Self {
            coil: parts.coil,
            controller: parts.controller,
            matrices: matrices(&parts, 1),
            phases_rad: vec![[0.0; 4]],
            state_rad: [0.0; 4],
            noise_rad: noise_rad(&parts),
            sample_period_s,
            stream: streams.stream("combined"),
            vibration,
            slow_noise: SlowNoise::new(
                &config.slow_noise,
                sample_period_s,
                simulated_time_s,
                streams,
            ),
            rate_word: RateWord::new(&config.output, &parts.coil, sample_period_s),
            optics,
            condition: parts.condition,
            varying: Schedule::new(config, sample_period_s).map(|schedule| {
                Box::new(Varying {
                    schedule,
                    config: config.clone(),
                })
            }),
        })
    }

    /// The loop's linear model.
    #[must_use]
    pub fn controller(&self) -> &Controller {
        &self.controller
    }

    /// Lets the modulator's gain drift: applied phase = (1 + configured error) (1 + drift)
    /// commanded, as a temperature does by way of the voltage of pi.
    pub fn set_modulator_gain_error(&mut self, drift: f64) {
        self.optics.set_drift(drift);
    }

    /// Applied over commanded phase, less one, with what the second loop has corrected.
    #[must_use]
    pub fn modulator_gain_error(&self) -> f64 {
        self.optics.gain_error()
    }

    /// Time between rate words, s.
    #[must_use]
    pub fn sample_period_s(&self) -> f64 {
        self.sample_period_s
    }

    /// Rate word of the output sample over which the gyro moves as `segment`, deg/h.
    pub fn next_word(&mut self, segment: &MotionSegment) -> f64 {
        self.next_word_over(std::slice::from_ref(segment))
    }

    /// Rate word of the output sample over which the gyro moves as `segments`, which share it equally,
    /// deg/h.
    ///
    /// A change of their number costs as much as a thousand words.
    pub fn next_word_over(&mut self, segments: &[MotionSegment]) -> f64 {
        if segments.len() != self.phases_rad.len() {
            self.split_words(segments.len());
        }
        if let Some(condition) = self.next_condition() {
            self.enter(condition);
        }
        let scale = self.coil.scale_factor_s * self.condition.scale_ratio;
        let slow_rad_per_s = self.slow_noise.next_rate_rad_per_s() + self.condition.bias_rad_per_s;
        for (phase_rad, segment) in self.phases_rad.iter_mut().zip(segments) {
            *phase_rad = segment
                .rate_rad_per_s
                .map(|coefficient| scale * coefficient);
            phase_rad[0] += scale * slow_rad_per_s;
        }
        self.optics.distort(&mut self.phases_rad);
        let mut mean_rad = self.matrices.advance(
            &mut self.state_rad,
            &self.phases_rad,
            self.noise_rad,
            || self.stream.normal(),
        );
        self.optics.follow(mean_rad);
        if let Some(vibration) = &mut self.vibration {
            mean_rad += vibration.next_rad();
        }
        self.rate_word.deg_per_h(mean_rad)
    }

    /// Takes words of so many cubics from here on.
    fn split_words(&mut self, cubics: usize) {
        self.phases_rad.resize(cubics, [0.0; 4]);
        self.matrices = self.matrices.with_cubics(cubics);
    }

    fn next_condition(&mut self) -> Option<Condition> {
        self.varying.as_mut()?.schedule.next_change()
    }

    /// Works in another condition from the next output sample on.
    fn enter(&mut self, condition: Condition) {
        let Some(Varying { config, .. }) = self.varying.as_deref() else {
            return;
        };
        let parts = Parts::under_way(config, &condition);
        // The matrices cost more than all the rest; most conditions leave the gain alone.
        if parts.controller != self.controller {
            self.matrices = matrices(&parts, self.phases_rad.len());
            self.controller = parts.controller;
        }
        self.noise_rad = noise_rad(&parts);
        self.optics.set_drift(condition.modulator_gain_error);
        self.condition = condition;
    }
}

/// Autocovariance of the rate words by lag in words without the rounding of the words, (deg/h)^2.
pub(in crate::gyro) fn word_autocovariance(parts: &Parts, lags: usize) -> Vec<f64> {
    let unit = rad_per_s_to_deg_per_h(noise_rad(parts) / parts.coil.scale_factor_s);
    let mut found = matrices(parts, 1).word_autocovariance(lags);
    for value in &mut found {
        *value *= unit * unit;
    }
    found
}

/// Shares of a loop period's error that are signal, and of the periods that reach the integrator.
///
/// Averaged spikes weaken signal and gain; discarded periods weaken the gain alone.
fn shares(parts: &Parts) -> (f64, f64) {
    (1.0 - parts.optics.gap_share, parts.optics.update_share())
}

/// The linear loop over the periods of an output sample.
fn matrices(parts: &Parts, cubics: usize) -> RateMatrices {
    let (signal_share, update_share) = shares(parts);
    let effective = Controller {
        gain: parts.controller.gain * signal_share * update_share,
        ..parts.controller
    };
    RateMatrices::new(
        &effective,
        parts.half_periods / parts.timing.half_periods,
        cubics,
    )
}

/// Standard deviation of the error's noise per loop period, rad: it counts in the periods that
/// reach the integrator alone.
fn noise_rad(parts: &Parts) -> f64 {
    let (signal_share, update_share) = shares(parts);
    let budget = NoiseBudget::new(&parts.detector, &parts.coil).detection_deg_per_sqrt_h();
    let random_walk = deg_per_sqrt_h_to_rad_per_sqrt_s(budget);
    let error_rad = random_walk * parts.coil.scale_factor_s / parts.controller.loop_period_s.sqrt();
    error_rad / (signal_share * update_share.sqrt())
}
