//! Delay line of an engine: the regressor words of the taps, and the ring in which RAMA keeps them.

/// Regressor words, newest first.
#[derive(Clone, Debug)]
pub(super) struct DelayLine<W> {
    words: Vec<W>,
    /// Ring slot HEAD of the newest word.
    head: usize,
}

impl<W: Copy> DelayLine<W> {
    /// Zero in every tap, HEAD p-1 so that sample 0 goes to slot 0.
    pub(super) fn new(tap_count: usize, zero: W) -> Self {
        Self {
            words: vec![zero; tap_count],
            head: tap_count - 1,
        }
    }

    /// Takes the newest word; the oldest leaves.
    #[inline]
    pub(super) fn shift(&mut self, word: W) {
        self.head = (self.head + 1) % self.words.len();
        self.words.rotate_right(1);
        self.words[0] = word;
    }

    /// The words, newest first.
    #[inline]
    pub(super) fn words(&self) -> &[W] {
        &self.words
    }

    /// The ring of L as RAMA holds it.
    pub(super) fn ring(&self) -> Vec<W> {
        ring(&self.words, self.head)
    }
}

/// The ring of L as RAMA holds it.
///
/// * `line`: regressors, newest first. * `head`: slot of the newest.
pub(super) fn ring<W: Copy>(line: &[W], head: usize) -> Vec<W> {
    let count = line.len();
    let mut words = line.to_vec();
    for (j, word) in line.iter().enumerate() {
        words[(head + count - j) % count] = *word;
    }
    words
}
