//! Whether the intervals of Allan deviations hold the truth as often as they say.

use fogbench::metrics::{AllanEstimator, AllanOptions, allan_variant};
use fogbench::random::{Stream, Streams};
use fogbench::vocabulary::AveragingTimes;

/// Rates in a record: 512 has averaging times from 500 degrees of freedom down to two.
const COUNT: usize = 512;

/// Correlation times of the Gauss-Markov processes that make flicker, samples: ratio 4, from half a
/// sample to eighteen records.
const CORRELATION_TIMES: [f64; 8] = [0.57, 2.28, 9.12, 36.48, 145.92, 583.68, 2334.72, 9338.88];

/// First seed: the rules for noise identification were tried on seeds from 0 on, which prove nothing
/// about them.
const SEED_BASE: u64 = 7_000_000;

#[derive(Clone, Copy, Debug)]
enum Noise {
    White,
    Flicker,
    RandomWalk,
}

impl Noise {
    fn record(self, stream: &mut Stream) -> Vec<f64> {
        let mut values = vec![0.0; COUNT];
        stream.fill_normal(&mut values);
        match self {
            Self::White => {}
            Self::Flicker => {
                values.fill(0.0);
                let mut innovations = vec![0.0; COUNT];
                for time in CORRELATION_TIMES {
                    let decay = (-1.0 / time).exp();
                    let innovation = (1.0 - decay * decay).sqrt();
                    let mut state = stream.normal();
                    stream.fill_normal(&mut innovations);
                    for (value, normal) in values.iter_mut().zip(&innovations) {
                        *value += state;
                        state = decay * state + innovation * normal;
                    }
                }
            }
            Self::RandomWalk => {
                // Means of a Brownian path over its steps: the bridge between adds 1/12.
                let mut bridges = vec![0.0; COUNT];
                stream.fill_normal(&mut bridges);
                let mut walk = 0.0;
                for (value, bridge) in values.iter_mut().zip(bridges) {
                    let step = *value;
                    *value = walk + step / 2.0 + bridge / 12.0_f64.sqrt();
                    walk += step;
                }
            }
        }
        values
    }

    /// Variance that the estimator estimates, from the covariance of the process.
    ///
    /// A difference is a weighted sum of rates with weights that add up to nothing, so that a walk
    /// may stand for its generalised covariance, the mean of `-|s - t|/2` over two samples.
    fn truth(self, m: usize, estimator: AllanEstimator) -> f64 {
        let covariance = |lag: usize| match self {
            Self::White => f64::from(u8::from(lag == 0)),
            Self::Flicker => {
                let times = CORRELATION_TIMES.into_iter();
                times.map(|time| (-(lag as f64) / time).exp()).sum()
            }
            Self::RandomWalk if lag == 0 => -1.0 / 6.0,
            Self::RandomWalk => -(lag as f64) / 2.0,
        };
        let (blocks, divisor): (&[f64], f64) = match estimator {
            AllanEstimator::Hadamard => (&[1.0, -2.0, 1.0], 6.0),
            _ => (&[-1.0, 1.0], 2.0),
        };
        let averaged = if estimator == AllanEstimator::Modified {
            m
        } else {
            1
        };
        let mut weights = vec![0.0; blocks.len() * m + averaged - 1];
        for shift in 0..averaged {
            for (block, height) in blocks.iter().enumerate() {
                for k in 0..m {
                    weights[shift + block * m + k] += height / (m * averaged) as f64;
                }
            }
        }
        let lagged = |lag: usize| -> f64 {
            let later = &weights[lag..];
            weights.iter().zip(later).map(|(a, b)| a * b).sum()
        };
        let sum: f64 = (1..weights.len())
            .map(|lag| 2.0 * lagged(lag) * covariance(lag))
            .sum();
        (lagged(0) * covariance(0) + sum) / divisor
    }
}

/// What many records say about the intervals at one averaging time.
struct Trial {
    averaged_samples: usize,
    truth: f64,
    /// Share of the intervals that hold the truth.
    held: f64,
    /// Mean degrees of freedom.
    freedom: f64,
    /// Mean variance over the truth.
    ratio: f64,
}

fn try_intervals(noise: Noise, estimator: AllanEstimator, runs: u64) -> Vec<Trial> {
    let options = AllanOptions {
        estimator,
        taus: AveragingTimes::Octave,
        confidence: 0.9,
    };
    let mut trials: Vec<Trial> = Vec::new();
    for seed in 0..runs {
        let mut stream = Streams::new(SEED_BASE + seed, 0).stream("coverage");
        let points = allan_variant(&noise.record(&mut stream), 1.0, &options);
        if trials.is_empty() {
            trials.extend(points.iter().map(|point| Trial {
                averaged_samples: point.point.averaged_samples,
                truth: noise.truth(point.point.averaged_samples, estimator),
                held: 0.0,
                freedom: 0.0,
                ratio: 0.0,
            }));
        }
        for (trial, point) in trials.iter_mut().zip(&points) {
            let interval = point.point.deviation_deg_per_h;
            let deviation = trial.truth.sqrt();
            let holds = interval.low <= deviation && deviation <= interval.high;
            trial.held += f64::from(u8::from(holds)) / runs as f64;
            trial.freedom += point.point.degrees_of_freedom / runs as f64;
            trial.ratio += point.point.variance() / trial.truth / runs as f64;
        }
    }
    trials
}

#[test]
fn ninety_per_cent_intervals_hold_the_truth_nine_times_in_ten() {
    // CI repeats with four times the runs.
    let runs = if std::env::var("CI").is_ok() {
        16_000
    } else {
        4000
    };
    let mut complaints = Vec::new();
    let mut seen = [0, 0];
    for (noise, estimator) in [
        (Noise::White, AllanEstimator::Overlapping),
        (Noise::Flicker, AllanEstimator::Overlapping),
        (Noise::RandomWalk, AllanEstimator::Overlapping),
        (Noise::White, AllanEstimator::Plain),
        (Noise::Flicker, AllanEstimator::Plain),
        (Noise::RandomWalk, AllanEstimator::Plain),
        (Noise::White, AllanEstimator::Modified),
        (Noise::RandomWalk, AllanEstimator::Hadamard),
    ] {
        for trial in try_intervals(noise, estimator, runs) {
            let many = trial.freedom >= 15.0;
            seen[usize::from(many)] += 1;
            let (least, most) = if many { (0.88, 0.92) } else { (0.88, 0.96) };
            // One standard error of 4000 runs; the 16 000 of CI do without.
            let chance = if runs < 16_000 { 0.005 } else { 0.0 };
            let (least, most) = (least - chance, most + chance);
            // The variance itself is unbiased: five times sqrt(2 / (edf runs)).
            let slack = 5.0 * (2.0 / (trial.freedom * runs as f64)).sqrt();
            if trial.held < least || trial.held > most || (trial.ratio - 1.0).abs() > slack {
                complaints.push(format!(
                    "{noise:?} {estimator:?} m {}: {:.4} held, edf {:.1}, ratio {:.4}",
                    trial.averaged_samples, trial.held, trial.freedom, trial.ratio
                ));
            }
        }
    }
    assert!(seen[0] >= 8 && seen[1] >= 20, "{seen:?}");
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}
