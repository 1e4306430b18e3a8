//! Delay line of an engine: the regressor words of the taps, and the ring in which RAMA keeps them.

/// Regressor words, newest first.
#[derive(Clone, Debug)]
pub(super) struct DelayLine {
    words: Vec<i64>,
    /// Ring slot HEAD of the newest word.
    head: usize,
}

impl DelayLine {
    /// Zero in every tap, HEAD p-1 so that sample 0 goes to slot 0.
    pub(super) fn new(tap_count: usize) -> Self {
        Self {
            words: vec![0; tap_count],
            head: tap_count - 1,
        }
    }

    /// Takes the newest word; the oldest leaves.
    pub(super) fn shift(&mut self, word: i64) {
        self.head = (self.head + 1) % self.words.len();
        self.words.rotate_right(1);
        self.words[0] = word;
    }

    /// The words, newest first.
    pub(super) fn words(&self) -> &[i64] {
        &self.words
    }

    /// The ring of L as RAMA holds it.
    pub(super) fn ring(&self) -> Vec<i64> {
        let count = self.words.len();
        let mut ring = vec![0; count];
        for (j, word) in self.words.iter().enumerate() {
            ring[(self.head + count - j) % count] = *word;
        }
        ring
    }
}
