//! Reproducible noise: one stream per (scenario seed, source name, repeat index).
//!
//! Invariant: a draw depends on those three values and its position in the stream, never on the
//! thread, the shard or what other sources drew. Points of a sweep share the seed, so that they
//! share their noise (common random numbers) and comparisons across a sweep are paired.

use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;

/// The streams of one run: a scenario seed and a repeat index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Streams {
    seed: u64,
    repeat: u64,
    scope: Option<&'static str>,
}

impl Streams {
    /// Streams of repeat `repeat` (from 0) of a scenario with seed `seed`.
    #[must_use]
    pub fn new(seed: u64, repeat: u64) -> Self {
        Self {
            seed,
            repeat,
            scope: None,
        }
    }

    /// The same streams for one of several like instruments: `combined` becomes `x.combined`.
    #[must_use]
    pub fn scoped(&self, scope: &'static str) -> Self {
        Self {
            scope: Some(scope),
            ..*self
        }
    }

    /// The stream of the source called `source` (within the scope, if any), from its beginning.
    ///
    /// The 256-bit state is the BLAKE3 digest of seed, repeat and name, so that neighbouring
    /// seeds and similar names give unrelated streams.
    #[must_use]
    pub fn stream(&self, source: &str) -> Stream {
        let mut hasher = blake3::Hasher::new();
        hasher.update(b"fogbench stream 1");
        hasher.update(&self.seed.to_le_bytes());
        hasher.update(&self.repeat.to_le_bytes());
        if let Some(scope) = self.scope {
            hasher.update(scope.as_bytes());
            hasher.update(b".");
        }
        hasher.update(source.as_bytes());
        Stream {
            generator: Xoshiro256PlusPlus::from_seed(*hasher.finalize().as_bytes()),
        }
    }
}

/// One stream of pseudo-random numbers: xoshiro256++ (a named, portable generator).
#[derive(Clone, Debug)]
pub struct Stream {
    generator: Xoshiro256PlusPlus,
}

impl Stream {
    /// The next draw from the normal distribution of mean 0 and variance 1 (ziggurat).
    #[inline]
    pub fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.generator)
    }

    /// The next draw from the uniform distribution between 0 and 1, by a normal one.
    pub fn uniform(&mut self) -> f64 {
        0.5 * statrs::function::erf::erfc(-self.normal() / std::f64::consts::SQRT_2)
    }

    /// Fills `values` with independent draws from the standard normal distribution.
    #[inline]
    pub fn fill_normal(&mut self, values: &mut [f64]) {
        for value in values {
            *value = self.normal();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn first(seed: u64, source: &str, repeat: u64) -> f64 {
        Streams::new(seed, repeat).stream(source).normal()
    }

    #[test]
    fn a_stream_is_named_by_seed_source_and_repeat() {
        let base = first(1, "detector", 0).to_bits();
        assert_eq!(base, first(1, "detector", 0).to_bits());
        assert_ne!(base, first(2, "detector", 0).to_bits());
        assert_ne!(base, first(1, "flicker", 0).to_bits());
        assert_ne!(base, first(1, "detector", 1).to_bits());
        let scoped = |scope| Streams::new(1, 0).scoped(scope).stream("detector");
        let x = scoped("x").normal().to_bits();
        assert_eq!(x, first(1, "x.detector", 0).to_bits());
        assert!(x != base && x != scoped("y").normal().to_bits());
    }

    #[test]
    fn normals_have_unit_variance_and_normal_kurtosis() {
        const COUNT: usize = 1_000_000;
        let mut stream = Streams::new(7, 0).stream("test");
        let mut draws = vec![0.0; COUNT];
        stream.fill_normal(&mut draws);
        #[expect(clippy::cast_precision_loss, reason = "a count of 1e6 is exact in f64")]
        let count = COUNT as f64;
        let moment = |power: i32| draws.iter().map(|draw| draw.powi(power)).sum::<f64>() / count;
        // Standard errors: 1/sqrt(n), sqrt(2/n), sqrt(96/n); five of each.
        assert!(moment(1).abs() < 5.0 / count.sqrt());
        assert!((moment(2) - 1.0).abs() < 5.0 * (2.0 / count).sqrt());
        assert!((moment(4) - 3.0).abs() < 5.0 * (96.0 / count).sqrt());
    }
}
