//! Digital controller: the loop's transfer function, gain and delay.

use std::f64::consts::{PI, TAU};

use crate::declare::table;
use crate::gyro::error::GyroError;

table! {
    /// Digital controller.
    pub struct ControllerConfig {
        /// Closed-loop -3 dB bandwidth; sets the integrator gain. Source of the default: assumed, half of the
        /// output rate.
        loop_bandwidth_hz: f64 = 2000.0, in 1e-3..=100000.0, "Hz", told in Account;
        /// Pipeline latency in modulation periods. Source of the default: assumed, one period to compute.
        loop_latency_periods: u32 = 1, in 0..=3;
        /// Whether the loop gain is held against changes of the detected power; if not, bandwidth and delay
        /// change with it. Source of the default: assumed, a plain integrator.
        automatic_gain_control: bool = false;
        /// Gain of the second loop, which sets the modulator's gain between half and twice the nominal one;
        /// 0 is off. Source of the default: none.
        second_loop_gain: f64 = 0.0, in 0.0..=1.0;
        /// Bits of the ramp's step over 2 pi, the rest cut off; 0 is ideal. Source of the default: none.
        step_bits: u32 = 0, in 0..=48;
        /// Largest magnitude of the ramp's step; 0 is not limited. Source of the default: none.
        step_limit_deg: f64 = 0.0, in 0.0..=3600.0, "deg";
    }
}

/// Largest latency the models hold, loop periods.
pub(super) const LATENCY_PERIODS_MAX: u32 = 3;

/// The integrating loop in its linear range.
///
/// `r[m+1] = r[m] + g e[m-d]` with `e = phi_s - r`: the transfer function from Sagnac phase to
/// register is `H(z) = g z^-(1+d) / (1 - z^-1 + g z^-(1+d))`, unity at DC for any gain (type 1).
///
/// # Source
/// Derived from the recursion above. Checked by known answers K5, K6 and K7 against the loop model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controller {
    /// Integrator gain g.
    pub gain: f64,
    /// Pipeline latency d, loop periods.
    pub latency_periods: u32,
    /// Loop period: `T_L = 2 tau`, or `4 tau` with four states of tau; s.
    pub loop_period_s: f64,
    /// States of the bias wave in a loop period, each of which samples the input.
    pub states_per_period: u32,
}

impl Controller {
    /// The controller whose closed loop has the given -3 dB bandwidth, Hz.
    ///
    /// `|H|^2 = 1/2` at `theta = 2 pi f T_L` is the quadratic `g^2 - 2 g R - |1 - z^-1|^2 = 0` with
    /// `R = cos((1 + d) theta) - cos(d theta)`; its only positive root is the gain. For d up to 3 it
    /// grows with frequency as long as the loop is stable, so that no lower frequency has the same
    /// gain: the crossing at the asked bandwidth is the first one.
    ///
    /// # Errors
    /// [`GyroError::LatencyOutOfRange`], [`GyroError::BandwidthAboveNyquist`], and
    /// [`GyroError::UnstableLoop`] if the gain is not below the stability limit.
    pub fn new(
        bandwidth_hz: f64,
        latency_periods: u32,
        loop_period_s: f64,
    ) -> Result<Self, GyroError> {
        if latency_periods > LATENCY_PERIODS_MAX {
            return Err(GyroError::LatencyOutOfRange { latency_periods });
        }
        let half_loop_rate_hz = 0.5 / loop_period_s;
        if bandwidth_hz >= half_loop_rate_hz {
            return Err(GyroError::BandwidthAboveNyquist {
                bandwidth_hz,
                half_loop_rate_hz,
            });
        }
        let angle = TAU * bandwidth_hz * loop_period_s;
        let gain = half_power_gain(angle, latency_periods);
        let gain_limit = gain_limit(latency_periods);
        if gain >= gain_limit {
            return Err(GyroError::UnstableLoop {
                bandwidth_hz,
                gain,
                gain_limit,
                latency_periods,
            });
        }
        Ok(Self {
            gain,
            latency_periods,
            loop_period_s,
            states_per_period: 2,
        })
    }

    /// The same loop with another number of states in its bias wave.
    #[must_use]
    pub fn with_states(self, states_per_period: u32) -> Self {
        Self {
            states_per_period,
            ..self
        }
    }

    /// Complex response `H` at a frequency, as `(real, imaginary)`.
    #[must_use]
    pub fn response(&self, frequency_hz: f64) -> (f64, f64) {
        let angle = TAU * frequency_hz * self.loop_period_s;
        let delayed = angle * f64::from(1 + self.latency_periods);
        let (numerator_re, numerator_im) = (self.gain * delayed.cos(), -self.gain * delayed.sin());
        let (re, im) = (1.0 - angle.cos() + numerator_re, angle.sin() + numerator_im);
        let power = re * re + im * im;
        (
            (numerator_re * re + numerator_im * im) / power,
            (numerator_im * re - numerator_re * im) / power,
        )
    }

    /// Gain and phase (rad) of a rate word that averages `periods` registers and is stamped with the
    /// last, against the motion.
    ///
    /// H times two means of `e^(i w t)`: that of the states that make one error, ahead of the start
    /// of their period, and that of the registers, behind the last. Each of n terms a time D apart
    /// is `sin(n w D / 2) / (n sin(w D / 2))` at their middle. The phase may lie beyond half a turn.
    /// To first order in w it is `-w` times [`word_delay_s`](Self::word_delay_s).
    #[must_use]
    pub fn word_response(&self, frequency_hz: f64, periods: f64) -> (f64, f64) {
        let half_angle = 0.5 * TAU * frequency_hz * self.loop_period_s;
        let (re, im) = self.response(frequency_hz);
        let mean =
            |count: f64, half_angle: f64| (count * half_angle).sin() / (count * half_angle.sin());
        let states = f64::from(self.states_per_period);
        let state = half_angle / states;
        let gain = mean(states, state) * mean(periods, half_angle);
        let phase = im.atan2(re) + (states - 1.0) * state - (periods - 1.0) * half_angle;
        (re.hypot(im) * gain, phase)
    }

    /// Closed-loop -3 dB bandwidth of the gain now in use, Hz: the inverse of [`Controller::new`].
    #[must_use]
    pub fn bandwidth_hz(&self) -> f64 {
        const HALVINGS: u32 = 60;
        let (mut low, mut high) = (0.0, PI);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if half_power_gain(middle, self.latency_periods) < self.gain {
                low = middle;
            } else {
                high = middle;
            }
        }
        low / (TAU * self.loop_period_s)
    }

    /// Delay of the register behind the Sagnac phase at low frequency, s.
    ///
    /// `T_L / g - T_L (n - 1) / 2n`: the first-order expansion of `1 / H`, whatever the latency,
    /// less the mean age of the n instants at which the states that make one error see the input
    /// (a quarter period for two states). The register is stamped when it is updated.
    #[must_use]
    pub fn delay_s(&self) -> f64 {
        let states = f64::from(self.states_per_period);
        self.loop_period_s / self.gain - 0.5 * (states - 1.0) / states * self.loop_period_s
    }

    /// Delay of a rate word that averages `periods` registers and is stamped with the last, s.
    #[must_use]
    pub fn word_delay_s(&self, periods: f64) -> f64 {
        self.delay_s() + 0.5 * (periods - 1.0) * self.loop_period_s
    }
}

/// Gain that puts half power at the loop angle `2 pi f T_L`.
fn half_power_gain(angle: f64, latency_periods: u32) -> f64 {
    let latency = f64::from(latency_periods);
    let cross = ((1.0 + latency) * angle).cos() - (latency * angle).cos();
    // |1 - z^-1|^2 as a sine: 2 - 2 cos would lose its digits at low bandwidth.
    let chord = 2.0 * (0.5 * angle).sin();
    cross + (cross * cross + chord * chord).sqrt()
}

/// Gain at which the loop with this latency starts to oscillate: `2 sin(pi / (2 (2 d + 1)))`.
///
/// # Source
/// Derived: the root of `z^(d+1) - z^d + g` that first reaches the unit circle. Known answer K6.
#[must_use]
pub fn gain_limit(latency_periods: u32) -> f64 {
    2.0 * (PI / (2.0 * f64::from(2 * latency_periods + 1))).sin()
}
