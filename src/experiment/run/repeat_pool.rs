//! Pooling of the repeats of a run, one after the other.

use super::measure::Channels;
use super::simulate::Faults;
use crate::metrics::Pooling;

/// What one repeat of a run comes to, to be pooled with the others later.
pub(crate) struct Repeat {
    pub(crate) faults: Faults,
    pub(crate) channels: Channels,
}

/// The repeats of a run, pooled in their order as they come.
#[derive(Default)]
pub(crate) struct RepeatPool {
    /// The first, until there is another: one repeat alone stands as it is.
    first: Option<Repeat>,
    /// Of all, from the second on.
    faults: Faults,
    channels: Vec<(String, Pooling)>,
}

impl RepeatPool {
    /// Takes in the next repeat.
    pub(crate) fn add(&mut self, repeat: Repeat) {
        if self.channels.is_empty() {
            let Some(first) = self.first.take() else {
                self.first = Some(repeat);
                return;
            };
            self.faults = first.faults;
            let pooling = |(name, table): &_| {
                let mut own = Pooling::default();
                own.add(table);
                (String::clone(name), own)
            };
            self.channels = first.channels.iter().map(pooling).collect();
        }
        self.faults = self.faults.plus(repeat.faults);
        for ((_, pooling), (_, table)) in self.channels.iter_mut().zip(&repeat.channels) {
            pooling.add(table);
        }
    }

    /// The sum of the faults, and one table for each channel: one that failed once has failed. None where no
    /// repeat was taken in.
    pub(crate) fn pooled(self) -> Option<(Faults, Channels)> {
        if let Some(first) = self.first {
            return Some((first.faults, first.channels));
        }
        if self.channels.is_empty() {
            return None;
        }
        let channels = self.channels.into_iter();
        let mut channels = channels.map(|(name, own)| (name, own.pooled())).collect();
        keep_finite(&mut channels);
        Some((self.faults, channels))
    }
}

/// Leaves only finite numbers in the tables; see [`ChannelMetrics::keep_finite`].
pub(super) fn keep_finite(channels: &mut Channels) {
    for (_, metrics) in channels {
        metrics.keep_finite();
    }
}
