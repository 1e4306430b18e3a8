//! Gyro model at the output rate, for long runs.

use crate::gyro::coil::Coil;
use crate::gyro::controller::Controller;
use crate::gyro::error::GyroError;
use crate::gyro::noise_budget::NoiseBudget;
use crate::gyro::parts::Parts;
use crate::gyro::rate_matrices::RateMatrices;
use crate::gyro::rate_word::RateWord;
use crate::gyro::slow_noise::SlowNoise;
use crate::gyro::vibration::{VibrationResponse, tones};
use crate::random::{Stream, Streams};
use crate::scenario::GyroConfig;
use crate::signal::MotionSegment;
use crate::units::deg_per_sqrt_h_to_rad_per_sqrt_s;

/// The linearised loop, one output sample at a time.
///
/// The same recursion as the loop model with `e = phi_s - r + n` in place of the fringe, advanced
/// over all loop periods of an output sample at once: same mean, bandwidth, delay, noise colour and
/// Allan deviation, at a cost that does not depend on the number of half periods per sample. The
/// noise n has the variance of the whole budget, converter rounding included:
/// `sigma_e^2 T_L = (N Ks)^2`. Left out: the sine of the fringe (matters for phase errors beyond
/// about 0.1 rad), resets, and the ramp converter's rounding, which is bounded in angle. Vibration is the settled
/// loop's answer to its tones and the mean that they rectify to.
#[derive(Clone, Debug)]
pub struct RateModel {
    coil: Coil,
    controller: Controller,
    matrices: RateMatrices,
    state_rad: [f64; 4],
    noise_rad: f64,
    sample_period_s: f64,
    stream: Stream,
    vibration: Option<VibrationResponse>,
    slow_noise: SlowNoise,
    rate_word: RateWord,
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
        let Parts {
            half_periods,
            coil,
            detector,
            controller,
            ..
        } = parts;
        let random_walk = deg_per_sqrt_h_to_rad_per_sqrt_s(
            NoiseBudget::new(&detector, &coil).total_deg_per_sqrt_h(),
        );
        let sample_period_s = f64::from(half_periods) * coil.transit_time_s;
        Ok(Self {
            coil,
            controller,
            matrices: RateMatrices::new(&controller, half_periods / 2),
            state_rad: [0.0; 4],
            noise_rad: random_walk * coil.scale_factor_s / coil.loop_period_s().sqrt(),
            sample_period_s,
            stream: streams.stream("combined"),
            vibration,
            slow_noise: SlowNoise::new(
                &config.slow_noise,
                sample_period_s,
                simulated_time_s,
                streams,
            ),
            rate_word: RateWord::new(&config.output, &coil),
        })
    }

    /// The loop's linear model.
    #[must_use]
    pub fn controller(&self) -> &Controller {
        &self.controller
    }

    /// Time between rate words, s.
    #[must_use]
    pub fn sample_period_s(&self) -> f64 {
        self.sample_period_s
    }

    /// Rate word of the output sample over which the gyro moves as `segment`, deg/h.
    pub fn next_word(&mut self, segment: &MotionSegment) -> f64 {
        let scale = self.coil.scale_factor_s;
        let mut phase_rad = segment
            .rate_rad_per_s
            .map(|coefficient| scale * coefficient);
        phase_rad[0] += scale * self.slow_noise.next_rate_rad_per_s();
        let mut mean_rad =
            self.matrices
                .advance(&mut self.state_rad, &phase_rad, self.noise_rad, || {
                    self.stream.normal()
                });
        if let Some(vibration) = &mut self.vibration {
            mean_rad += vibration.next_rad();
        }
        self.rate_word.deg_per_h(mean_rad)
    }
}
