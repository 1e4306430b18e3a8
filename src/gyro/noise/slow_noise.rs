//! Slow noise of the rate: bias, flicker, exponentially correlated noise, rate random walk and ramp.

use std::f64::consts::PI;

use crate::declare::table;
use crate::random::{Stream, Streams};
use crate::signal::SlowDrift;
use crate::units::{
    deg_per_h_per_h_to_deg_per_h_per_s, deg_per_h_per_sqrt_h_to_deg_per_h_per_sqrt_s,
    deg_per_h_to_rad_per_s,
};

table! {
    /// Slow noise of the rate.
    pub struct SlowNoiseConfig {
        /// Constant bias.
        bias_deg_per_h: f64 = 0.0, in -1e6..=1e6, "deg/h";
        /// Standard deviation of a bias drawn at each start, which is each repeat; 0 is none. Source of the
        /// default: none.
        turn_on_bias_deg_per_h: f64 = 0.0, in 0.0..=1e6, "deg/h";
        /// Flicker coefficient B (bias instability). Source of the default: derived: with K and 0.0060 deg/sqrt(h),
        /// 100 s means scatter by 0.0606 deg/h, against 0.0603 deg/h in the paper (25 C, after LMS).
        bias_instability_deg_per_h: f64 = 0.045, in 0.0..=1e6, "deg/h";
        /// Exponentially correlated (Gauss-Markov) rate, 1 sigma; 0 is none. Source of the default: none.
        gauss_markov_deg_per_h: f64 = 0.0, in 0.0..=1e6, "deg/h";
        /// Correlation time Tc of the Gauss-Markov rate; its Allan deviation is greatest at 1.89 Tc. Of no
        /// effect while the rate above is 0. Source of the default: assumed.
        gauss_markov_correlation_time_s: f64 = 100.0, in 1e-6..=1e7, "s";
        /// Rate random walk coefficient K. Source of the default: assumed.
        rate_random_walk_deg_per_h_per_sqrt_h: f64 = 0.005, in 0.0..=1e6, "deg/h/sqrt(h)";
        /// Rate ramp R. Source of the default: none.
        rate_ramp_deg_per_h_per_h: f64 = 0.0, in -1e6..=1e6, "deg/h/h";
    }
}

/// Ratio of neighbouring correlation times of the flicker.
const RATIO: f64 = 4.0;
/// Shortest correlation time of the flicker in update intervals.
///
/// Sampling folds the spectrum above half the update rate down: a process of correlation time T
/// sampled every D has the density `s^2 D coth(D / 2T)` at DC instead of `2 s^2 T`. With this
/// value the folded excess of all processes equals what the left-out, shorter ones would have
/// added, so that no white residue is left beside the flicker.
const SHORTEST_CORRELATION_INTERVALS: f64 = 0.57;
/// Longest correlation time of the flicker over the simulated time, at least.
const LONGEST_CORRELATION_RECORDS: f64 = 10.0;
/// Longest time between updates, s; one output sample if that is longer.
const UPDATE_INTERVAL_S: f64 = 0.004;
/// Most output samples between updates: flicker is flat from four updates on, so from 16 samples.
const UPDATE_SAMPLES_MAX: f64 = 4.0;
/// A process is redrawn at least this often in its correlation time (or at every update).
///
/// Held over an interval h, its covariance is the exact one at multiples of h and linear between:
/// with `h = T / 8` it errs by at most `(h / T)^2 / 8` = 0.2 % of the variance.
const HOLDS_PER_CORRELATION: f64 = 8.0;
/// Most updates over which a process is held, so that no slow one makes visible steps.
const HOLD_UPDATES_MAX: u32 = 256;

/// Generator of the slow noise, one value per output sample, in constant memory.
///
/// * Flicker of coefficient B (two-sided density `B^2 / (2 pi f)`, Allan deviation
///   `B sqrt(2 ln 2 / pi) = 0.664 B`): a sum of Gauss-Markov processes with correlation times in
///   the ratio `a = 4` and equal variances `B^2 ln(a) / pi`. Summing their densities
///   `2 s^2 T / (1 + (2 pi f T)^2)` over all T gives `B^2 / (2 pi f)` with a ripple of
///   `2 sech(pi^2 / ln a)` = 0.3 %. Each process starts from its stationary distribution and
///   advances exactly over the updates it is held: all at every update for the fast ones, an
///   eighth of the correlation time or less for the slow ones, so that an update takes 3.4 normals
///   however long the record.
/// * Rate random walk of coefficient K: a sum of independent normals of variance `K^2 D` per
///   update interval D, from 0.
/// * Gauss-Markov: standard deviation s and correlation time Tc, from its stationary distribution,
///   drawn anew for every output sample: `b <- exp(-T / Tc) b + s sqrt(1 - exp(-2 T / Tc)) n`, exact
///   for any Tc (white beneath an output sample). Two-sided density
///   `2 s^2 Tc / (1 + (2 pi f Tc)^2)`, Allan variance
///   `(2 s^2 Tc / tau) (1 - (Tc / 2 tau) (3 - 4 exp(-tau / Tc) + exp(-2 tau / Tc)))`.
/// * Ramp: `R t`, taken at the middle of an output sample. Bias: a constant, and a normal
///   deviate drawn once at the start.
///
/// Flicker and walk are held between updates: four output samples, fewer where these are longer
/// than a millisecond. The Allan deviation of the flicker is flat from 16 samples on.
///
/// # Source
/// Terms as in IEEE Std 952, annex C. Superposition: derived; van der Ziel, Physica 16 (1950).
#[derive(Clone, Debug)]
pub struct SlowNoise {
    bias_rad_per_s: f64,
    ramp_rad_per_s_per_sample: f64,
    flicker: Vec<GaussMarkov>,
    flicker_stream: Stream,
    walk_step_rad_per_s: f64,
    walk_stream: Stream,
    correlated: GaussMarkov,
    correlated_stream: Stream,
    samples_per_update: u32,
    samples_to_update: u32,
    updates_done: u32,
    samples_done: u64,
    flicker_rad_per_s: f64,
    walk_rad_per_s: f64,
}

/// One Gauss-Markov process, exact at the instants at which it is redrawn.
#[derive(Clone, Copy, Debug, Default)]
struct GaussMarkov {
    value: f64,
    decay: f64,
    innovation: f64,
    /// Updates over which the value is held, a power of two.
    hold_updates: u32,
}

impl GaussMarkov {
    /// A process in its stationary distribution; `exponent` is the time between two draws over the
    /// correlation time.
    fn stationary(deviation: f64, exponent: f64, hold_updates: u32, stream: &mut Stream) -> Self {
        Self {
            value: deviation * stream.normal(),
            decay: (-exponent).exp(),
            innovation: deviation * (-(-2.0 * exponent).exp_m1()).sqrt(),
            hold_updates,
        }
    }

    fn redraw(&mut self, stream: &mut Stream) {
        self.value = self.decay * self.value + self.innovation * stream.normal();
    }
}

impl SlowNoise {
    /// The generator for output samples of `sample_period_s` over `simulated_time_s`.
    #[must_use]
    pub fn new(
        config: &SlowNoiseConfig,
        sample_period_s: f64,
        simulated_time_s: f64,
        streams: &Streams,
    ) -> Self {
        let samples_per_update = samples_per_update(sample_period_s);
        let interval_s = f64::from(samples_per_update) * sample_period_s;
        let mut flicker_stream = streams.stream("flicker");
        let instability = deg_per_h_to_rad_per_s(config.bias_instability_deg_per_h);
        let flicker = if instability > 0.0 {
            let longest_s = LONGEST_CORRELATION_RECORDS * simulated_time_s.max(interval_s);
            gauss_markov_ladder(instability, interval_s, longest_s, &mut flicker_stream)
        } else {
            Vec::new()
        };
        let mut correlated_stream = streams.stream("gauss_markov");
        let deviation = deg_per_h_to_rad_per_s(config.gauss_markov_deg_per_h);
        let correlated = if deviation > 0.0 {
            let exponent = sample_period_s / config.gauss_markov_correlation_time_s;
            GaussMarkov::stationary(deviation, exponent, 1, &mut correlated_stream)
        } else {
            GaussMarkov::default()
        };
        let walk_coefficient =
            deg_per_h_to_rad_per_s(deg_per_h_per_sqrt_h_to_deg_per_h_per_sqrt_s(
                config.rate_random_walk_deg_per_h_per_sqrt_h,
            ));
        let turn_on_deviation = deg_per_h_to_rad_per_s(config.turn_on_bias_deg_per_h);
        let turn_on_bias = turn_on_deviation * streams.stream("turn_on_bias").normal();
        let ramp_rad_per_s_per_s = deg_per_h_to_rad_per_s(deg_per_h_per_h_to_deg_per_h_per_s(
            config.rate_ramp_deg_per_h_per_h,
        ));
        Self {
            bias_rad_per_s: deg_per_h_to_rad_per_s(config.bias_deg_per_h) + turn_on_bias,
            ramp_rad_per_s_per_sample: ramp_rad_per_s_per_s * sample_period_s,
            flicker_rad_per_s: flicker.iter().map(|process| process.value).sum(),
            flicker,
            flicker_stream,
            walk_step_rad_per_s: walk_coefficient * interval_s.sqrt(),
            walk_stream: streams.stream("rate_random_walk"),
            correlated,
            correlated_stream,
            samples_per_update,
            samples_to_update: samples_per_update,
            updates_done: 0,
            samples_done: 0,
            walk_rad_per_s: 0.0,
        }
    }

    /// Slow noise over the next output sample, an equivalent input rate, rad/s.
    pub fn next_rate_rad_per_s(&mut self) -> f64 {
        if self.samples_to_update == 0 {
            self.update();
            self.samples_to_update = self.samples_per_update;
        }
        self.samples_to_update -= 1;
        let middle = self.samples_done as f64 + 0.5;
        if self.samples_done > 0 && self.correlated.innovation > 0.0 {
            self.correlated.redraw(&mut self.correlated_stream);
        }
        self.samples_done += 1;
        self.bias_rad_per_s
            + self.ramp_rad_per_s_per_sample * middle
            + self.flicker_rad_per_s
            + self.walk_rad_per_s
            + self.correlated.value
    }

    fn update(&mut self) {
        // All holds divide the longest, a power of two: the count may wrap.
        self.updates_done = self.updates_done.wrapping_add(1);
        let mut sum = 0.0;
        for process in &mut self.flicker {
            if self.updates_done.is_multiple_of(process.hold_updates) {
                process.redraw(&mut self.flicker_stream);
            }
            sum += process.value;
        }
        self.flicker_rad_per_s = sum;
        if self.walk_step_rad_per_s > 0.0 {
            self.walk_rad_per_s += self.walk_step_rad_per_s * self.walk_stream.normal();
        }
    }
}

/// How the slow noise scatters over seeds, for output samples of `sample_period_s` over
/// `simulated_time_s`.
#[must_use]
pub fn slow_drift(
    config: &SlowNoiseConfig,
    sample_period_s: f64,
    simulated_time_s: f64,
) -> SlowDrift {
    let interval_s = f64::from(samples_per_update(sample_period_s)) * sample_period_s;
    let longest_s = LONGEST_CORRELATION_RECORDS * simulated_time_s.max(interval_s);
    let instability = config.bias_instability_deg_per_h;
    let of_flicker = instability * instability * RATIO.ln() / PI;
    let flicker =
        flicker_correlation_times_s(interval_s, longest_s).map(|time_s| (of_flicker, time_s));
    let correlated = (
        config.gauss_markov_deg_per_h.powi(2),
        config.gauss_markov_correlation_time_s,
    );
    let turn_on = (config.turn_on_bias_deg_per_h.powi(2), f64::INFINITY);
    let walk =
        deg_per_h_per_sqrt_h_to_deg_per_h_per_sqrt_s(config.rate_random_walk_deg_per_h_per_sqrt_h);
    SlowDrift {
        processes: flicker
            .chain([correlated, turn_on])
            .filter(|(variance, _)| *variance > 0.0)
            .collect(),
        walk_deg2_per_h2_per_s: walk * walk,
    }
}

/// Correlation times of the processes that make the flicker, from below the interval to `longest_s`.
fn flicker_correlation_times_s(interval_s: f64, longest_s: f64) -> impl Iterator<Item = f64> {
    let first = SHORTEST_CORRELATION_INTERVALS * interval_s;
    let next = move |time_s: &f64| (*time_s < longest_s).then_some(time_s * RATIO);
    std::iter::successors(Some(first), next)
}

/// Output samples between updates: as many as fit the update interval, one to four.
fn samples_per_update(sample_period_s: f64) -> u32 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a whole number between one and four"
    )]
    let samples = (UPDATE_INTERVAL_S / sample_period_s)
        .floor()
        .clamp(1.0, UPDATE_SAMPLES_MAX) as u32;
    samples
}

/// Processes of one variance with correlation times from below the interval to `longest_s`.
fn gauss_markov_ladder(
    instability: f64,
    interval_s: f64,
    longest_s: f64,
    stream: &mut Stream,
) -> Vec<GaussMarkov> {
    let deviation = instability * (RATIO.ln() / PI).sqrt();
    flicker_correlation_times_s(interval_s, longest_s)
        .map(|correlation_s| {
            let hold_updates = hold_updates(correlation_s / interval_s);
            let exponent = f64::from(hold_updates) * interval_s / correlation_s;
            GaussMarkov::stationary(deviation, exponent, hold_updates, stream)
        })
        .collect()
}

/// Updates over which a process of a correlation time (in updates) is held.
fn hold_updates(correlation_updates: f64) -> u32 {
    let mut hold = 1;
    while hold < HOLD_UPDATES_MAX
        && f64::from(2 * hold) * HOLDS_PER_CORRELATION <= correlation_updates
    {
        hold *= 2;
    }
    hold
}
