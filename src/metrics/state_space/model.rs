//! The system of a channel's fitted noise.

use nalgebra::{DMatrix, DVector};

use super::agreement::Shown;
use super::blocks::{Block, State, drift, exponential, quantisation, sine, white};
use super::flicker::FlickerBank;
use super::taps::Taps;
use crate::metrics::allan::covariance::{CORRELATED, FLICKER, INVERSE_SQUARE, RAMP, WALK, WHITE};
use crate::metrics::allan::curves::{ALLAN_FIT, COUNT, DEVIATION, FREEDOM, TAU};
use crate::metrics::allan::extra_terms::{found_sine, without_sine};
use crate::metrics::allan::least_squares::{Mix, column};
use crate::metrics::allan::noise_fit::{ANGLE_RANDOM_WALK, ChosenFit, FitRange, Sine};
use crate::metrics::allan::overlapping::AllanPoint;
use crate::metrics::estimate::interval;
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::noise::autocovariance::{AUTOCOVARIANCE, PRODUCT};

/// Samples of the shortest averaging time, and part of the record that is the longest, between which a
/// system has the Allan variance of the terms.
const TAU_MIN_SAMPLES: f64 = 2.0;
const TAU_MAX_PER_RECORD: f64 = 0.1;

/// Allan variance at large tau of exponentially correlated noise of unit density behind its white part:
/// `N^2/tau - 1.5 N^2 Tc/tau^2`.
const LAG_INVERSE_SQUARE: f64 = 1.5;

/// `x[k+1] = F x[k] + w[k]`, `y[k] = H x[k] + v[k]` with `E[w w'] = Q`, `E[v v] = R`, `E[w v] = S`.
///
/// y is the noise of sample k, the mean rate over it, deg/h; x is what the processes are at its start.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct StateSpace {
    /// Sample period, s.
    pub sample_period_s: f64,
    /// The n states, in the order of the rows.
    pub states: Vec<State>,
    /// F, `[n, n]`.
    pub transition: DMatrix<f64>,
    /// Q, `[n, n]`.
    pub process_noise: DMatrix<f64>,
    /// H, `[n]`.
    pub observation: DVector<f64>,
    /// R, (deg/h)^2.
    pub measurement_noise: f64,
    /// S, `[n]`.
    pub cross_covariance: DVector<f64>,
    /// P0, `[n, n]`: correlated states are stationary, the bias starts at zero.
    pub initial: DMatrix<f64>,
    /// The bank that stands for flicker, where there is some.
    pub flicker: Option<FlickerBank>,
    /// Shortest and longest averaging time, s, between which the system has the Allan variance of the
    /// words.
    pub tau_range_s: [f64; 2],
    /// The terms it stands for.
    terms: Mix,
    sine: Option<Sine>,
    /// What stands for the white noise of words that are smoothed otherwise than by one pole.
    taps: Option<Taps>,
}

impl StateSpace {
    /// Allan deviation of the noise terms that the system stands for, deg/h.
    #[must_use]
    pub fn allan_deviation_deg_per_h(&self, tau_s: f64) -> f64 {
        let mix = &self.terms;
        let own: f64 = (0..mix.squares.len())
            .filter(|&term| term != INVERSE_SQUARE && term != WHITE)
            .map(|term| mix.squares[term] * column(term, tau_s, mix.correlation_time))
            .sum();
        let fast = match (&self.taps, Lag::of(mix)) {
            (Some(taps), _) => {
                taps.allan_variance(interval::round_to_count(tau_s / self.sample_period_s))
            }
            (None, Some(lag)) => {
                let variance = lag.variance();
                variance * column(CORRELATED, tau_s, Some(lag.time_s))
            }
            (None, None) => [WHITE, INVERSE_SQUARE]
                .map(|term| mix.squares[term] * column(term, tau_s, None))
                .iter()
                .sum(),
        };
        let sine = self.sine.map_or(0.0, |sine| sine.allan_variance(tau_s));
        (own + fast + sine).sqrt()
    }

    fn of(blocks: &[Block], sample_period_s: f64, terms: Terms) -> Self {
        let states: Vec<State> = blocks
            .iter()
            .flat_map(|block| block.states.clone())
            .collect();
        let count = states.len();
        let mut system = Self {
            sample_period_s,
            states,
            transition: DMatrix::zeros(count, count),
            process_noise: DMatrix::zeros(count, count),
            observation: DVector::zeros(count),
            measurement_noise: blocks.iter().map(|block| block.measurement_noise).sum(),
            cross_covariance: DVector::zeros(count),
            initial: DMatrix::zeros(count, count),
            flicker: terms.flicker,
            tau_range_s: terms.tau_range_s,
            terms: terms.mix,
            sine: terms.sine,
            taps: terms.taps,
        };
        let mut first = 0;
        for block in blocks {
            let size = block.states.len();
            for (whole, part) in [
                (&mut system.transition, &block.transition),
                (&mut system.process_noise, &block.process_noise),
                (&mut system.initial, &block.initial),
            ] {
                whole.view_mut((first, first), (size, size)).copy_from(part);
            }
            for (whole, part) in [
                (&mut system.observation, &block.observation),
                (&mut system.cross_covariance, &block.cross_covariance),
            ] {
                whole.rows_mut(first, size).copy_from(part);
            }
            first += size;
        }
        system
    }
}

/// What a system stands for.
struct Terms {
    mix: Mix,
    sine: Option<Sine>,
    flicker: Option<FlickerBank>,
    tau_range_s: [f64; 2],
    taps: Option<Taps>,
}

/// White noise behind a bandwidth that the shortest averaging times of a fit still see.
struct Lag {
    density: f64,
    time_s: f64,
}

impl Lag {
    /// Of terms whose `1/tau^2` part is negative.
    fn of(mix: &Mix) -> Option<Self> {
        let [density, inverse_square] = [WHITE, INVERSE_SQUARE].map(|term| mix.squares[term]);
        (inverse_square < 0.0 && density > 0.0).then(|| Self {
            density,
            time_s: -inverse_square / (LAG_INVERSE_SQUARE * density),
        })
    }

    /// A process of variance s^2 has the density `2 s^2 Tc`.
    fn variance(&self) -> f64 {
        self.density / (2.0 * self.time_s)
    }
}

/// The system of the noise that was fitted to a channel: terms whose square came out negative left out and
/// the others fitted again.
///
/// Exponentially correlated states are stationary, the bias starts at zero, the ramp has the variance
/// `R^2`. Words that a loop or a filter has made smooth (negative `1/tau^2` part) have their white noise
/// behind one pole, those of a counter a state for the angle's rounding. Where the words show another Allan
/// variance than that at the averaging times below the fit, as behind a mean, their white noise is weighed
/// over some words; what such a system does not reach either is left out of its range.
///
/// # Errors
/// The reason, where the words count pulses, or the channel has no noise fit or one that does not describe its curve.
pub fn noise_state_space(channel: &ChannelMetrics) -> Result<StateSpace, Unavailable> {
    let lack = || {
        let of_fit = channel.unavailable.get(ANGLE_RANDOM_WALK.name);
        of_fit
            .cloned()
            .unwrap_or("the channel has no fit of noise terms".into())
    };
    if !channel.pulse_words.is_empty() {
        return Err(
            "the words count pulses, whose quantisation depends on the rate: it is no linear system"
                .into(),
        );
    }
    let sheet = channel.noise_fit.as_ref().filter(|it| it.is_adequate);
    let sheet = sheet.ok_or_else(lack)?;
    let points = curve(channel).ok_or("the channel has no Allan curve")?;
    let sine = found_sine(channel);
    let range = FitRange {
        tau_min_s: sheet.number("tau_min_s").unwrap_or(0.0),
        tau_max_s: sheet.number("tau_max_s").unwrap_or(f64::INFINITY),
    };
    let mix = ChosenFit::new(&without_sine(&points, sine), range, 1.0)?.non_negative();
    let sample_period_s = points[0].tau_s / points[0].averaged_samples as f64;
    // Differences that outliers touch are missing, fewest at the shortest times.
    let lengths = points
        .iter()
        .map(|it| it.count + 2 * it.averaged_samples - 1);
    let samples = lengths.max().unwrap_or(0) as f64;
    let tau_range_s = [
        TAU_MIN_SAMPLES * sample_period_s,
        TAU_MAX_PER_RECORD * samples * sample_period_s,
    ];
    let built = |taps| system(mix, sine, taps, sample_period_s, tau_range_s);
    let shown = Shown {
        autocovariance: fast_autocovariance(channel, &mix, sine, sample_period_s),
        points,
        fit_from_s: range.tau_min_s,
    };
    let white_variance = mix.squares[WHITE] / sample_period_s;
    let mut best = shown.best(built(None), |taps| built(Some(taps)), white_variance);
    best.tau_range_s[0] = best.tau_range_s[0].max(shown.holds_from_s(&best));
    Ok(best)
}

/// Autocovariance of the words without what their correlated noise and their sine have of it.
fn fast_autocovariance(
    channel: &ChannelMetrics,
    mix: &Mix,
    line: Option<Sine>,
    sample_period_s: f64,
) -> Vec<f64> {
    let products = channel
        .curve(&AUTOCOVARIANCE)
        .and_then(|it| PRODUCT.get(it));
    let other = |lag: usize| {
        let time_s = lag as f64 * sample_period_s;
        let correlated = mix.correlation_time.map_or(0.0, |correlation_s| {
            mix.squares[CORRELATED] * (-time_s / correlation_s).exp()
        });
        let sine = line.map_or(0.0, |line| {
            let turn = std::f64::consts::TAU * time_s / line.period_s.value;
            0.5 * line.amplitude_deg_per_h.value.powi(2) * turn.cos()
        });
        correlated + sine
    };
    let products = products.map(|it| it.to_vec()).unwrap_or_default();
    let rest = products.iter().enumerate();
    rest.map(|(lag, product)| product - other(lag)).collect()
}

/// The curve that the terms were fitted to.
fn curve(channel: &ChannelMetrics) -> Option<Vec<AllanPoint>> {
    let curve = channel.curve(&ALLAN_FIT)?;
    let [tau, deviation, freedom, count] =
        [&TAU, &DEVIATION, &FREEDOM, &COUNT].map(|it| it.get(curve));
    let (tau, deviation, freedom, count) = (tau?, deviation?, freedom?, count?);
    // The shortest averaging time is one sample.
    let sample_period_s = *tau.first()?;
    let points = (0..tau.len()).map(|row| AllanPoint {
        tau_s: tau[row],
        averaged_samples: interval::round_to_count(tau[row] / sample_period_s),
        deviation_deg_per_h: interval::deviation(deviation[row], freedom[row]),
        degrees_of_freedom: freedom[row],
        count: interval::round_to_count(count[row]),
    });
    Some(points.collect())
}

fn system(
    mix: Mix,
    line: Option<Sine>,
    taps: Option<Taps>,
    sample_period_s: f64,
    tau_range_s: [f64; 2],
) -> StateSpace {
    let period = sample_period_s;
    let mut blocks = Vec::new();
    let [density, inverse_square] = [WHITE, INVERSE_SQUARE].map(|term| mix.squares[term]);
    match (&taps, Lag::of(&mix)) {
        (Some(taps), _) => blocks.push(taps.block()),
        (None, Some(lag)) => {
            let holds = "white noise behind the bandwidth of the words";
            let state = State::new("angle_random_walk", "deg/h", holds);
            blocks.push(exponential(state, lag.variance(), lag.time_s, period));
        }
        (None, None) => blocks.push(white(density, period)),
    }
    if inverse_square > 0.0 && taps.is_none() {
        blocks.push(quantisation(inverse_square / 3.0, period));
    }
    let [shortest, longest] = tau_range_s;
    let square = mix.squares[FLICKER];
    let flicker = (square > 0.0).then(|| FlickerBank::new(square, shortest, longest));
    if let Some(bank) = &flicker {
        blocks.push(white(bank.white_density, period));
        for (index, &time_s) in bank.correlation_times_s.iter().enumerate() {
            let name = format!("flicker_{}", index + 1);
            let state = State::new(name, "deg/h", "one of the noises that make flicker");
            blocks.push(exponential(state, bank.variance, time_s, period));
        }
    }
    if let Some(time_s) = mix.correlation_time
        && mix.squares[CORRELATED] > 0.0
    {
        let state = State::new("correlated", "deg/h", "exponentially correlated noise");
        blocks.push(exponential(state, mix.squares[CORRELATED], time_s, period));
    }
    if mix.squares[WALK] > 0.0 || mix.squares[RAMP] > 0.0 {
        blocks.push(drift(mix.squares[WALK], mix.squares[RAMP], period));
    }
    if let Some(line) = &line {
        blocks.push(sine(
            line.amplitude_deg_per_h.value,
            line.period_s.value,
            period,
        ));
    }
    let terms = Terms {
        mix,
        sine: line,
        flicker,
        tau_range_s,
        taps,
    };
    StateSpace::of(&blocks, period, terms)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::allan::covariance::{FLICKER_ALLAN_VARIANCE, TERMS};
    use crate::metrics::allan::overlapping::overlapping_allan_at;
    use crate::metrics::estimate::value::Estimate;
    use crate::random::Streams;

    const PERIOD_S: f64 = 0.01;

    fn mix(squares: &[(usize, f64)], correlation_time: Option<f64>) -> Mix {
        let mut all = [0.0; TERMS];
        for &(term, square) in squares {
            all[term] = square;
        }
        Mix {
            squares: all,
            correlation_time,
        }
    }

    fn line() -> Sine {
        Sine {
            amplitude_deg_per_h: Estimate::symmetric(0.5, 0.01),
            period_s: Estimate::symmetric(3.0, 0.01),
            frequencies_tried: 1,
        }
    }

    /// Allan variance of m words each by the second moments of the system: that of the difference of two
    /// neighbouring means.
    fn allan_variance(system: &StateSpace, m: usize) -> f64 {
        let n = system.states.len();
        // The state beside the difference of the sums so far.
        let mut moments = DMatrix::zeros(n + 1, n + 1);
        moments.view_mut((0, 0), (n, n)).copy_from(&system.initial);
        for k in 0..2 * m {
            let sign = if k < m { -1.0 } else { 1.0 };
            let mut step = DMatrix::zeros(n + 1, n + 1);
            step.view_mut((0, 0), (n, n)).copy_from(&system.transition);
            step.view_mut((n, 0), (1, n))
                .copy_from(&(sign * system.observation.transpose()));
            step[(n, n)] = 1.0;
            let mut noise = DMatrix::zeros(n + 1, n + 1);
            noise
                .view_mut((0, 0), (n, n))
                .copy_from(&system.process_noise);
            let cross = sign * &system.cross_covariance;
            noise.view_mut((0, n), (n, 1)).copy_from(&cross);
            noise.view_mut((n, 0), (1, n)).copy_from(&cross.transpose());
            noise[(n, n)] = system.measurement_noise;
            moments = &step * moments * step.transpose() + noise;
        }
        moments[(n, n)] / (2.0 * (m * m) as f64)
    }

    #[test]
    fn every_process_has_the_allan_variance_of_its_term() {
        let cases = [
            (mix(&[(WHITE, 0.04)], None), None),
            (mix(&[(WHITE, 0.04), (INVERSE_SQUARE, 3e-4)], None), None),
            (mix(&[(WHITE, 0.04), (INVERSE_SQUARE, -3e-3)], None), None),
            (mix(&[(WALK, 1e-3)], None), None),
            (mix(&[(RAMP, 1e-4), (WHITE, 1e-6)], None), None),
            (mix(&[(CORRELATED, 0.5)], Some(0.7)), None),
            (mix(&[(WHITE, 1e-9)], None), Some(line())),
        ];
        for (mix, line) in cases {
            let system = system(mix, line, None, PERIOD_S, [2.0 * PERIOD_S, 30.0]);
            for m in [1, 2, 5, 30, 200, 1000] {
                let wanted = system
                    .allan_deviation_deg_per_h(m as f64 * PERIOD_S)
                    .powi(2);
                let got = allan_variance(&system, m);
                // The bias starts at zero, the walk over the first pair is that of any other.
                // A sine in samples has the closed form of one in time but for (pi T/P)^2/3.
                let rtol = if line.is_some() { 1e-3 } else { 1e-6 };
                assert!(
                    (got / wanted - 1.0).abs() < rtol,
                    "{mix:?} {m}: {got} {wanted}"
                );
            }
        }
    }

    #[test]
    fn flicker_is_within_three_percent_from_two_words_to_a_tenth_of_the_record() {
        let system = system(
            mix(&[(FLICKER, 0.09)], None),
            None,
            None,
            PERIOD_S,
            [2.0 * PERIOD_S, 36.0],
        );
        for m in [2, 3, 10, 100, 1000, 3600] {
            let got = allan_variance(&system, m).sqrt();
            let wanted = 0.3 * FLICKER_ALLAN_VARIANCE.sqrt();
            assert!((got / wanted - 1.0).abs() < 0.03, "{m}: {got} {wanted}");
        }
        let bank = system.flicker.expect("a bank");
        assert!(bank.tau_range_s[0] <= 0.02 && bank.tau_range_s[1] >= 36.0);
    }

    #[test]
    fn noise_of_state_and_measurement_can_be_drawn_together() {
        let all = mix(
            &[
                (WHITE, 0.04),
                (INVERSE_SQUARE, 3e-4),
                (FLICKER, 0.01),
                (WALK, 1e-4),
                (RAMP, 1e-7),
            ],
            None,
        );
        let system = system(all, None, None, PERIOD_S, [2.0 * PERIOD_S, 60.0]);
        let n = system.states.len();
        let mut joint = DMatrix::zeros(n + 1, n + 1);
        joint
            .view_mut((0, 0), (n, n))
            .copy_from(&system.process_noise);
        joint
            .view_mut((0, n), (n, 1))
            .copy_from(&system.cross_covariance);
        joint
            .view_mut((n, 0), (1, n))
            .copy_from(&system.cross_covariance.transpose());
        joint[(n, n)] = system.measurement_noise;
        let roots = joint.symmetric_eigen();
        assert!(
            roots.eigenvalues.iter().all(|&root| root > -1e-12),
            "{}",
            roots.eigenvalues
        );
        let root = &roots.eigenvectors
            * DMatrix::from_diagonal(&roots.eigenvalues.map(|value| value.max(0.0).sqrt()));
        let mut stream = Streams::new(952, 0).stream("state space");
        let mut normals = vec![0.0; n + 1];
        stream.fill_normal(&mut normals);
        let mut state = system.initial.map(f64::sqrt) * DVector::from_column_slice(&normals[..n]);
        let words: Vec<f64> = (0..150_000)
            .map(|_| {
                stream.fill_normal(&mut normals);
                let noise = &root * DVector::from_column_slice(&normals);
                let word = system.observation.dot(&state) + noise[n];
                state = &system.transition * &state + noise.rows(0, n);
                word
            })
            .collect();
        for point in overlapping_allan_at(&words, PERIOD_S, &[2, 4, 10, 30, 60]) {
            let wanted = system.allan_deviation_deg_per_h(point.tau_s);
            let got = point.deviation_deg_per_h.value;
            assert!(
                (got / wanted - 1.0).abs() < 0.03,
                "{}: {got} {wanted}",
                point.tau_s
            );
        }
    }
}
