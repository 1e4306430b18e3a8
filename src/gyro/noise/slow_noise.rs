//! Slow noise of the rate: bias, flicker, exponentially correlated noise, rate random walk and ramp.

use std::f64::consts::PI;

use super::gauss_markov::GaussMarkov;
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
        bias_instability_deg_per_h: f64 = 0.045, in 0.0..=1e6, "deg/h", told in Account;
        /// Exponentially correlated (Gauss-Markov) rate, 1 sigma; 0 is none. Source of the default: none.
        gauss_markov_deg_per_h: f64 = 0.0, in 0.0..=1e6, "deg/h";
        /// Correlation time Tc of the Gauss-Markov rate; its Allan deviation is greatest at 1.89 Tc. Of no
        /// effect while the rate above is 0. Source of the default: assumed.
        gauss_markov_correlation_time_s: f64 = 100.0, in 1e-6..=1e7, "s";
        /// Rate random walk coefficient K. Source of the default: assumed.
        rate_random_walk_deg_per_h_per_sqrt_h: f64 = 0.005, in 0.0..=1e6, "deg/h/sqrt(h)", told in Account;
        /// Rate ramp R. Source of the default: none.
        rate_ramp_deg_per_h_per_h: f64 = 0.0, in -1e6..=1e6, "deg/h/h";
    }
}

/// Ratio of neighbouring correlation times of the flicker.
const RATIO: f64 = 4.0;
/// Shortest correlation time of the flicker in update intervals: from two intervals on the Allan
/// deviation is flat to 0.2 %, at one it is 1.3 % low.
const SHORTEST_CORRELATION_INTERVALS: f64 = 0.1425;
/// Variance of the shortest process over that of the others. Over an interval the still shorter ones
/// are white as it is, and its density stands for theirs: `1 + 1/4 + 1/16 + ... = 4/3`.
const SHORTEST_VARIANCE_RATIO: f64 = 4.0 / 3.0;
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

/// Generator of the slow noise, its mean over each rate word, in constant memory.
///
/// * Flicker of coefficient B (two-sided density `B^2 / (2 pi f)`, Allan deviation
///   `B sqrt(2 ln 2 / pi) = 0.664 B`): a sum of Gauss-Markov processes with correlation times in
///   the ratio `a = 4` and equal variances `B^2 ln(a) / pi`. Summing their densities
///   `2 s^2 T / (1 + (2 pi f T)^2)` over all T gives `B^2 / (2 pi f)` with a ripple of
///   `2 sech(pi^2 / ln a)` = 0.3 %. Each process starts from its stationary distribution. The fast
///   ones are drawn as their means over every update, slow ones every eighth of their correlation
///   time or more often, so that an update takes 4.4 normals however long the record.
/// * Rate random walk of coefficient K, from 0: a sum of independent normals of variance `K^2 D` per
///   update interval D; its mean over an interval lies half-way, give or take a normal of variance
///   `K^2 D / 12`.
/// * Gauss-Markov: standard deviation s and correlation time Tc, from its stationary distribution, as
///   its mean over every word, exact for any Tc. Two-sided density
///   `2 s^2 Tc / (1 + (2 pi f Tc)^2)`, Allan variance
///   `(2 s^2 Tc / tau) (1 - (Tc / 2 tau) (3 - 4 exp(-tau / Tc) + exp(-2 tau / Tc)))`.
/// * Ramp: `R t`, taken at the middle of a word. Bias: a constant, and a normal
///   deviate drawn once at the start.
///
/// Flicker and walk are held between updates: four words, fewer where these are longer than a
/// millisecond. The Allan deviation of the flicker is flat from an update on.
///
/// # Source
/// Terms as in IEEE Std 952, annex C. Superposition: derived; van der Ziel, Physica 16 (1950).
#[derive(Clone, Debug)]
pub struct SlowNoise {
    bias_rad_per_s: f64,
    ramp_rad_per_s_per_sample: f64,
    flicker: Vec<Held>,
    flicker_stream: Stream,
    /// The process of the flicker that stands for all still shorter ones.
    shortest: GaussMarkov,
    shortest_stream: Stream,
    walk_step_rad_per_s: f64,
    walk_stream: Stream,
    walk_mean_stream: Stream,
    correlated: GaussMarkov,
    correlated_stream: Stream,
    samples_per_update: u32,
    samples_to_update: u32,
    updates_done: u32,
    samples_done: u64,
    flicker_rad_per_s: f64,
    /// At the end of the present interval.
    walk_rad_per_s: f64,
    walk_mean_rad_per_s: f64,
}

/// A process of the flicker.
#[derive(Clone, Copy, Debug)]
struct Held {
    process: GaussMarkov,
    /// Updates over which the value is held, a power of two.
    hold_updates: u32,
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
        let mut start_stream = streams.stream("slow_noise_start");
        let instability = deg_per_h_to_rad_per_s(config.bias_instability_deg_per_h);
        let mut shortest_stream = streams.stream("flicker_shortest");
        let (shortest, flicker) = if instability > 0.0 {
            let deviation = instability * (RATIO.ln() / PI).sqrt();
            let shortest = GaussMarkov::mean_over(
                deviation * SHORTEST_VARIANCE_RATIO.sqrt(),
                1.0 / SHORTEST_CORRELATION_INTERVALS,
                &mut shortest_stream,
                &mut start_stream,
            );
            let longest_s = LONGEST_CORRELATION_RECORDS * simulated_time_s.max(interval_s);
            let longest = longest_s / interval_s;
            let others =
                gauss_markov_ladder(deviation, longest, &mut flicker_stream, &mut start_stream);
            (shortest, others)
        } else {
            (GaussMarkov::default(), Vec::new())
        };
        let mut correlated_stream = streams.stream("gauss_markov");
        let deviation = deg_per_h_to_rad_per_s(config.gauss_markov_deg_per_h);
        let correlated = if deviation > 0.0 {
            let exponent = sample_period_s / config.gauss_markov_correlation_time_s;
            GaussMarkov::mean_over(
                deviation,
                exponent,
                &mut correlated_stream,
                &mut start_stream,
            )
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
        let mut noise = Self {
            bias_rad_per_s: deg_per_h_to_rad_per_s(config.bias_deg_per_h) + turn_on_bias,
            ramp_rad_per_s_per_sample: ramp_rad_per_s_per_s * sample_period_s,
            flicker_rad_per_s: shortest.value()
                + flicker.iter().map(|held| held.process.value()).sum::<f64>(),
            flicker,
            flicker_stream,
            shortest,
            shortest_stream,
            walk_step_rad_per_s: walk_coefficient * interval_s.sqrt(),
            walk_stream: streams.stream("rate_random_walk"),
            walk_mean_stream: streams.stream("rate_random_walk_mean"),
            correlated,
            correlated_stream,
            samples_per_update,
            samples_to_update: samples_per_update,
            updates_done: 0,
            samples_done: 0,
            walk_rad_per_s: 0.0,
            walk_mean_rad_per_s: 0.0,
        };
        noise.walk();
        noise
    }

    /// Mean of the slow noise over the next rate word, an equivalent input rate, rad/s.
    pub fn next_rate_rad_per_s(&mut self) -> f64 {
        if self.samples_to_update == 0 {
            self.update();
            self.samples_to_update = self.samples_per_update;
        }
        self.samples_to_update -= 1;
        let middle = self.samples_done as f64 + 0.5;
        if self.samples_done > 0 && self.correlated.is_on() {
            self.correlated.redraw(&mut self.correlated_stream);
        }
        self.samples_done += 1;
        self.bias_rad_per_s
            + self.ramp_rad_per_s_per_sample * middle
            + self.flicker_rad_per_s
            + self.walk_mean_rad_per_s
            + self.correlated.value()
    }

    fn update(&mut self) {
        // All holds divide the longest, a power of two: the count may wrap.
        self.updates_done = self.updates_done.wrapping_add(1);
        if self.shortest.is_on() {
            self.shortest.redraw(&mut self.shortest_stream);
        }
        let mut sum = self.shortest.value();
        for Held {
            process,
            hold_updates,
        } in &mut self.flicker
        {
            if self.updates_done.is_multiple_of(*hold_updates) {
                process.redraw(&mut self.flicker_stream);
            }
            sum += process.value();
        }
        self.flicker_rad_per_s = sum;
        self.walk();
    }

    /// Lets the random walk go on over an interval.
    fn walk(&mut self) {
        let step = self.walk_step_rad_per_s;
        if step > 0.0 {
            let start = self.walk_rad_per_s;
            self.walk_rad_per_s += step * self.walk_stream.normal();
            let about = (step / 12.0_f64.sqrt()) * self.walk_mean_stream.normal();
            self.walk_mean_rad_per_s = 0.5 * (start + self.walk_rad_per_s) + about;
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
    let longest = LONGEST_CORRELATION_RECORDS * simulated_time_s.max(interval_s) / interval_s;
    let instability = config.bias_instability_deg_per_h;
    let of_flicker = instability * instability * RATIO.ln() / PI;
    let shortest = (
        SHORTEST_VARIANCE_RATIO * of_flicker,
        SHORTEST_CORRELATION_INTERVALS * interval_s,
    );
    let others =
        flicker_correlations(longest).map(|correlation| (of_flicker, correlation * interval_s));
    let correlated = (
        config.gauss_markov_deg_per_h.powi(2),
        config.gauss_markov_correlation_time_s,
    );
    let turn_on = (config.turn_on_bias_deg_per_h.powi(2), f64::INFINITY);
    let walk =
        deg_per_h_per_sqrt_h_to_deg_per_h_per_sqrt_s(config.rate_random_walk_deg_per_h_per_sqrt_h);
    SlowDrift {
        processes: std::iter::once(shortest)
            .chain(others)
            .chain([correlated, turn_on])
            .filter(|(variance, _)| *variance > 0.0)
            .collect(),
        walk_deg2_per_h2_per_s: walk * walk,
    }
}

/// Correlation times, in updates, of the processes of the flicker but the shortest, until one is no less
/// than `longest`.
fn flicker_correlations(longest: f64) -> impl Iterator<Item = f64> {
    let next = move |correlation: &f64| (*correlation < longest).then_some(correlation * RATIO);
    std::iter::successors(Some(SHORTEST_CORRELATION_INTERVALS), next).skip(1)
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

/// The other processes, of one variance, with correlation times (in updates) up to `longest`.
fn gauss_markov_ladder(
    deviation: f64,
    longest: f64,
    stream: &mut Stream,
    start: &mut Stream,
) -> Vec<Held> {
    flicker_correlations(longest)
        .map(|correlation| {
            let hold_updates = hold_updates(correlation);
            let exponent = f64::from(hold_updates) / correlation;
            let process = match hold_updates {
                1 => GaussMarkov::mean_over(deviation, exponent, stream, start),
                _ => GaussMarkov::at_instants(deviation, exponent, stream),
            };
            Held {
                process,
                hold_updates,
            }
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
