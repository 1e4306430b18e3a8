//! Intervals of magnitudes: of the mean over records of a figure that noise alone makes positive.
//!
//! The root of a sum of squares, the largest of many distances and an excess that counts only beyond what
//! noise reaches have laws that are far from normal where there is little signal: their mean is that of
//! the noise, they scatter to one side of it, and many of their values may be the same. A linearised error
//! is then none. What is known is the law of the figure for a signal of any size, by the noise of its
//! components. The interval is that of the mean for those signals whose law the figure does not
//! contradict: with `F(x; d)` the law of the observed magnitude x under the signal d, all d with
//!
//! ```text
//! F(x; d) >= low(d)    and    1 - F(x; d) >= 0.05 - low(d)
//! ```
//!
//! Five parts in a hundred lie outside for every d, whatever `low` is. No signal is less than none, so that
//! without one only large values can contradict: the share of the lower end is that of a two-sided
//! interval, 0.025, times the probability that the signal stands out from noise, beyond 0.95 of its law.
//!
//! Source: Neyman, Philosophical Transactions A 236 (1937), for the construction; Feldman and Cousins,
//! Physical Review D 57 (1998), for its sides near a bound; the sides here are derived.

use statrs::distribution::{ContinuousCDF, Normal, StudentsT};
use statrs::function::erf::{erf, erfc};

use super::value::Estimate;

/// Probability that an interval leaves out, both ends together.
const OUTSIDE: f64 = 0.05;

/// Range of a law in standard deviations: beyond it nothing of 1e5 components is left.
pub(crate) const REACH: f64 = 8.0;

/// Intervals of the sum that makes a mean of a law.
const INTERVALS: u32 = 400;

/// Halvings in the search for an end: of a range of a million deviations 1e-12 is left.
const HALVINGS: u32 = 60;

/// Law of an observed magnitude by the size of the signal in it, both in deviations of the signal.
pub(crate) trait MagnitudeLaw {
    /// Probability of a magnitude of at most `x`.
    fn below(&self, signal: f64, x: f64) -> f64;

    /// Magnitudes between which there are all.
    fn range(&self, signal: f64) -> [f64; 2];

    /// Figure that is made of a magnitude; it never falls with it.
    fn figure(&self, x: f64) -> f64;
}

/// The figure of a magnitude with the interval of its mean over records.
pub(crate) fn ensemble_mean(law: &impl MagnitudeLaw, x: f64) -> Estimate {
    about(law, x, law.figure(x))
}

/// The same where rounding makes the figure another value.
fn about(law: &impl MagnitudeLaw, x: f64, value: f64) -> Estimate {
    let [_, told_from_noise] = boundary(law.range(0.0), |x| law.below(0.0, x) < 1.0 - OUTSIDE);
    let share_below = |signal: f64| 0.5 * OUTSIDE * (1.0 - law.below(signal, told_from_noise));
    // The first signal of which the condition no longer holds.
    let end = |holds: &dyn Fn(f64) -> bool| {
        if !holds(0.0) {
            return 0.0;
        }
        let [low, high] = boundary([0.0, x + REACH], holds);
        0.5 * (low + high)
    };
    let least = end(&|signal| 1.0 - law.below(signal, x) < OUTSIDE - share_below(signal));
    let most = end(&|signal| law.below(signal, x) > share_below(signal));
    let of_least = if least > 0.0 {
        mean_figure(law, least)
    } else {
        // The mean is that of noise or greater, and the figure above it by no more than noise makes it.
        let of_noise = mean_figure(law, 0.0);
        let below = value - (law.figure(told_from_noise) - of_noise);
        below.clamp(0.0, of_noise)
    };
    Estimate::with_interval(
        value,
        of_least.min(value),
        mean_figure(law, most).max(value),
    )
}

/// Neighbours between which a condition ends that holds at the lower end of a range.
fn boundary([mut low, mut high]: [f64; 2], holds: impl Fn(f64) -> bool) -> [f64; 2] {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    [low, high]
}

/// Mean of the figure over records with this signal.
fn mean_figure(law: &impl MagnitudeLaw, signal: f64) -> f64 {
    let [from, to] = law.range(signal);
    let step = (to - from) / f64::from(INTERVALS);
    let at = |node: u32| from + f64::from(node) * step;
    let mut before = law.below(signal, from);
    let mut sum = before * law.figure(from);
    for node in 0..INTERVALS {
        let next = law.below(signal, at(node + 1));
        sum += (next - before) * law.figure(at(node) + 0.5 * step);
        before = next;
    }
    sum
}

/// Root of the power of normal components beyond that of their noise.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RootOfPower {
    /// Deviation of a component.
    deviation: f64,
    /// Components of this deviation whose noise has the power of them all.
    components: f64,
    freedom: f64,
}

impl RootOfPower {
    /// Root of the sum of the squares beyond that of the variances, with the interval of its mean.
    ///
    /// * `components`: value and variance of each, both from so many parts.
    ///
    /// The sum of squares over the variance is a noncentral chi-square. Components that differ in variance
    /// count as equal ones with the same power of the noise, and the same scatter of the whole.
    pub(crate) fn of(components: &[(f64, f64)], parts: usize) -> Estimate {
        let (mut power, mut noise, mut squares, mut signal) = (0.0, 0.0, 0.0, 0.0);
        let mut by_signal = 0.0;
        for (value, variance) in components {
            power += value * value;
            noise += variance;
            squares += variance * variance;
            let beyond = (value * value - variance).max(0.0);
            signal += beyond;
            by_signal += variance * beyond;
        }
        let root = (power - noise).max(0.0).sqrt();
        let variance = (squares + 2.0 * by_signal) / (noise + 2.0 * signal);
        if !(variance > 0.0 && noise > 0.0) {
            return Estimate::exact(root);
        }
        let components = noise / variance;
        let law = Self {
            deviation: variance.sqrt(),
            components,
            freedom: (parts.max(2) as f64 - 1.0) * components,
        };
        about(&law, power.sqrt() / law.deviation, root)
    }
}

impl MagnitudeLaw for RootOfPower {
    /// By the normal deviate of a noncentral chi-square, and Student's t as its scale is an estimate.
    ///
    /// Source: Sankaran, Biometrika 50 (1963).
    fn below(&self, signal: f64, x: f64) -> f64 {
        let (k, l) = (self.components, signal * signal);
        let power = 1.0 - 2.0 / 3.0 * (k + l) * (k + 3.0 * l) / (k + 2.0 * l).powi(2);
        let p = (k + 2.0 * l) / (k + l).powi(2);
        let m = (power - 1.0) * (1.0 - 3.0 * power);
        let centre = 1.0 + power * p * (power - 1.0 - 0.5 * (2.0 - power) * m * p);
        let scale = power * (2.0 * p).sqrt() * (1.0 + 0.5 * m * p);
        let deviate = ((x * x / (k + l)).powf(power) - centre) / scale;
        student_below(deviate, self.freedom)
    }

    fn range(&self, signal: f64) -> [f64; 2] {
        let largest = (signal * signal + self.components).sqrt();
        [(signal - REACH).max(0.0), largest + REACH]
    }

    fn figure(&self, x: f64) -> f64 {
        self.deviation * (x * x - self.components).max(0.0).sqrt()
    }
}

/// Degrees of freedom from which Student's t counts as normal.
const NORMAL_FREEDOM: f64 = 1000.0;

/// Probability of at most this value under Student's t distribution.
fn student_below(value: f64, freedom: f64) -> f64 {
    if freedom > NORMAL_FREEDOM {
        return Normal::standard().cdf(value);
    }
    StudentsT::new(0.0, 1.0, freedom.max(1.0)).map_or(f64::NAN, |law| law.cdf(value))
}

/// Largest of normal deviates' magnitudes: one with a signal beside others that are noise.
#[derive(Clone, Debug)]
pub(crate) struct LargestOf {
    /// Deviation of the largest.
    deviation: f64,
    /// Deviations of the others, over it.
    others: Vec<f64>,
}

impl LargestOf {
    /// The largest of magnitudes, with the interval of its mean.
    ///
    /// * `parts`: magnitude and standard deviation of each.
    ///
    /// The signal is that of the largest. Signals of the others make the largest scatter less than this law.
    pub(crate) fn of(parts: &[(f64, f64)]) -> Estimate {
        let ranked = parts.iter().enumerate();
        let largest = ranked.max_by(|one, other| one.1.0.total_cmp(&other.1.0));
        let Some((at, &(value, deviation))) = largest else {
            return Estimate::exact(0.0);
        };
        let others = parts.iter().enumerate().filter(|(other, _)| *other != at);
        let others = others.map(|(_, part)| part.1 / deviation);
        if deviation <= 0.0 {
            return Estimate::exact(value);
        }
        let law = Self {
            deviation,
            others: others.filter(|other| *other > 0.0).collect(),
        };
        about(&law, value / deviation, value)
    }
}

impl MagnitudeLaw for LargestOf {
    fn below(&self, signal: f64, x: f64) -> f64 {
        let within = |to: f64| erf(to * std::f64::consts::FRAC_1_SQRT_2);
        let own = 0.5 * (within(x - signal) + within(x + signal));
        let others = self.others.iter().map(|other| within(x / other));
        own * others.product::<f64>()
    }

    fn range(&self, signal: f64) -> [f64; 2] {
        let widest = self.others.iter().copied().fold(0.0, f64::max);
        let most = (signal + REACH).max(REACH * widest);
        [(signal - REACH).max(0.0), most]
    }

    fn figure(&self, x: f64) -> f64 {
        self.deviation * x
    }
}

/// Largest of many samples with a peak among them, which counts only beyond what noise reaches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Peak {
    /// Samples.
    pub(crate) samples: usize,
    /// Level beyond which a peak counts, in deviations of the noise.
    pub(crate) counts_from: f64,
}

impl MagnitudeLaw for Peak {
    fn below(&self, signal: f64, x: f64) -> f64 {
        let above = |x: f64| 0.5 * erfc(x * std::f64::consts::FRAC_1_SQRT_2);
        let others = (self.samples as f64 * (-above(x)).ln_1p()).exp();
        (1.0 - above(x - signal)) * others
    }

    fn range(&self, signal: f64) -> [f64; 2] {
        [(signal - REACH).max(0.0), signal + REACH]
    }

    fn figure(&self, x: f64) -> f64 {
        if x > self.counts_from { x } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::estimate::interval;
    use crate::random::Streams;

    /// Records whose intervals are counted, and records of which the mean is taken.
    const INTERVALS_COUNTED: usize = 400;
    const OF_MEAN: usize = 4000;

    /// Exact binomial 99.9 % limits of the coverage of so many intervals that hold in 95 of 100 cases.
    const HELD: std::ops::RangeInclusive<usize> = 365..=393;

    /// Intervals out of [`INTERVALS_COUNTED`] that hold the mean of the values.
    fn held(of: &mut dyn FnMut() -> Estimate) -> usize {
        let first: Vec<Estimate> = (0..INTERVALS_COUNTED).map(|_| of()).collect();
        let more = (INTERVALS_COUNTED..OF_MEAN).map(|_| of().value);
        let values: Vec<f64> = first.iter().map(|it| it.value).chain(more).collect();
        let mean = interval::mean(&values);
        let holds = |it: &&Estimate| it.low <= mean && mean <= it.high;
        assert!(
            first
                .iter()
                .all(|it| it.low <= it.value && it.value <= it.high)
        );
        first.iter().filter(holds).count()
    }

    #[test]
    fn a_magnitude_has_the_interval_of_its_mean_from_no_signal_to_a_strong_one() {
        let mut stream = Streams::new(1, 0).stream("white");
        for signal in [0.0, 0.5, 1.0, 2.0, 3.0, 5.0, 20.0] {
            let mut of = || LargestOf::of(&[((signal + stream.normal()).abs(), 1.0)]);
            let count = held(&mut of);
            assert!(HELD.contains(&count), "{signal}: {count}");
        }
        // Far above the noise it is the normal one, without any the mean is sqrt(2 / pi).
        let strong = LargestOf::of(&[(20.0, 1.0)]);
        assert!((strong.low - 18.04).abs() < 2e-3 && (strong.high - 21.96).abs() < 2e-3);
        let none = LargestOf::of(&[(1.959_964, 1.0)]);
        assert!((none.low - 0.797_884).abs() < 2e-3, "{none:?}");
    }

    #[test]
    fn the_largest_of_many_has_it_too_with_one_signal_among_them() {
        let mut stream = Streams::new(2, 0).stream("white");
        for signal in [0.0, 2.0, 3.0, 4.0, 8.0] {
            let mut of = || {
                let size = |at: usize| if at == 3 { signal } else { 0.0 };
                let parts: Vec<(f64, f64)> = (0..12)
                    .map(|at| ((size(at) + stream.normal()).abs(), 1.0))
                    .collect();
                LargestOf::of(&parts)
            };
            let count = held(&mut of);
            assert!(HELD.contains(&count), "{signal}: {count}");
        }
    }

    #[test]
    fn a_root_of_power_beyond_noise_has_it_with_noise_that_is_an_estimate() {
        let mut stream = Streams::new(3, 0).stream("white");
        for (signal, components, parts) in [
            (0.0, 8, 20),
            (1.0, 8, 20),
            (2.0, 8, 20),
            (4.0, 8, 20),
            (30.0, 8, 20),
            (0.0, 2, 20),
            (3.0, 2, 20),
            (0.0, 8, 4),
            (3.0, 8, 4),
        ] {
            let mut of = || {
                let with_noise: Vec<(f64, f64)> = (0..components)
                    .map(|at| {
                        let mean = if at == 1 { signal } else { 0.0 };
                        let deviation = f64::from(parts).sqrt();
                        let values: Vec<f64> = (0..parts)
                            .map(|_| mean + deviation * stream.normal())
                            .collect();
                        let variance = interval::sample_variance(&values) / f64::from(parts);
                        (interval::mean(&values), variance)
                    })
                    .collect();
                RootOfPower::of(&with_noise, usize::try_from(parts).unwrap())
            };
            let count = held(&mut of);
            assert!(
                HELD.contains(&count),
                "{signal} {components} {parts}: {count}"
            );
        }
        let exact = RootOfPower::of(&[(3.0, 0.0), (4.0, 0.0)], 20);
        assert_eq!(exact, Estimate::exact(5.0));
    }

    #[test]
    fn a_peak_that_counts_beyond_noise_has_it_as_often_as_it_may_be_none() {
        let mut stream = Streams::new(4, 0).stream("white");
        for signal in [0.0, 2.0, 3.5, 4.5, 6.0, 12.0] {
            let law = Peak {
                samples: 100,
                counts_from: 4.0,
            };
            let mut of = || {
                let others = (0..100).map(|_| stream.normal()).fold(0.0, f64::max);
                let peak = others.max(signal + stream.normal());
                ensemble_mean(&law, peak)
            };
            let count = held(&mut of);
            // Where nearly all values are 0 no interval that has its value can miss a mean near 0.
            let at_least = *HELD.start();
            assert!(count >= at_least, "{signal}: {count}");
            assert!(signal < 4.0 || HELD.contains(&count), "{signal}: {count}");
        }
    }
}
