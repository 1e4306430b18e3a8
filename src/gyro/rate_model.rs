//! Gyro model at the output rate, for long runs.

use crate::gyro::coil::Coil;
use crate::gyro::controller::Controller;
use crate::gyro::error::GyroError;
use crate::gyro::noise_budget::NoiseBudget;
use crate::gyro::parts::Parts;
use crate::gyro::rate_matrices::RateMatrices;
use crate::gyro::rate_optics::RateOptics;
use crate::gyro::rate_word::RateWord;
use crate::gyro::slow_noise::SlowNoise;
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
/// about 0.1 rad), single resets, and the ramp converter's rounding, which is bounded in angle.
#[derive(Clone, Debug)]
pub struct RateModel {
    coil: Coil,
    controller: Controller,
    matrices: RateMatrices,
    state_rad: [f64; 4],
    noise_rad: f64,
    sample_period_s: f64,
    stream: Stream,
    slow_noise: SlowNoise,
    rate_word: RateWord,
    optics: RateOptics,
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
        let Parts {
            half_periods,
            half_period_s,
            timing,
            optics,
            coil,
            modulator,
            detector,
            controller,
        } = Parts::new(config)?;
        let random_walk = deg_per_sqrt_h_to_rad_per_sqrt_s(
            NoiseBudget::new(&detector, &coil).total_deg_per_sqrt_h(),
        );
        let sample_period_s = f64::from(half_periods) * half_period_s;
        let error_noise_rad = random_walk * coil.scale_factor_s / controller.loop_period_s.sqrt();
        // Averaged spikes weaken signal and gain; discarded periods weaken the gain, and the
        // error's noise counts in the others alone.
        let (signal_share, update_share) = (1.0 - optics.gap_share, optics.update_share());
        let effective = Controller {
            gain: controller.gain * signal_share * update_share,
            ..controller
        };
        let fringe = (detector.visibility, modulator.depth_rad);
        Ok(Self {
            coil,
            controller,
            matrices: RateMatrices::new(&effective, half_periods / timing.half_periods),
            state_rad: [0.0; 4],
            noise_rad: error_noise_rad / (signal_share * update_share.sqrt()),
            sample_period_s,
            stream: streams.stream("combined"),
            slow_noise: SlowNoise::new(
                &config.slow_noise,
                sample_period_s,
                simulated_time_s,
                streams,
            ),
            rate_word: RateWord::new(&config.output, &coil),
            optics: RateOptics::new(optics, fringe, half_periods, streams),
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
        let scale = self.coil.scale_factor_s;
        let mut phase_rad = segment
            .rate_rad_per_s
            .map(|coefficient| scale * coefficient);
        phase_rad[0] += scale * self.slow_noise.next_rate_rad_per_s();
        self.optics.distort(&mut phase_rad);
        let mean_rad =
            self.matrices
                .advance(&mut self.state_rad, &phase_rad, self.noise_rad, || {
                    self.stream.normal()
                });
        self.optics.follow(mean_rad);
        self.rate_word.deg_per_h(mean_rad)
    }
}
