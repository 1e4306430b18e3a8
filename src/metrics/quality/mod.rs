//! What is the matter with the words of a recorded log: outliers, and noise that was smoothed away.

pub(crate) mod coarse;
pub(crate) mod density;
pub(crate) mod examine;
pub(crate) mod outliers;
pub(crate) mod sides;
pub(crate) mod smoothing;

/// White words of unit variance that tests look into.
#[cfg(test)]
fn white(seed: u64, count: usize) -> Vec<f64> {
    let mut words = vec![0.0; count];
    crate::random::Streams::new(seed, 0)
        .stream("words")
        .fill_normal(&mut words);
    words
}
