//! How a channel fails whose words come from outside.

use crate::metrics::ChannelFailure;

/// What went wrong outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FailureKind {
    /// The words were computed from other samples.
    OtherInput,
    /// The file of the words is none, or of another length.
    Unreadable,
}

impl FailureKind {
    const ALL: [Self; 2] = [Self::OtherInput, Self::Unreadable];

    /// Its name in results.
    const fn word(self) -> &'static str {
        match self {
            Self::OtherInput => "other input",
            Self::Unreadable => "unreadable",
        }
    }

    /// The failure of a channel.
    pub(super) fn failure(self, sample: u64, message: String) -> ChannelFailure {
        ChannelFailure {
            kind: self.word().to_owned(),
            sample,
            message,
        }
    }
}

/// Whether a channel failed outside: no equation of a filter diverged.
pub(in crate::experiment) fn is_from_outside(failure: &ChannelFailure) -> bool {
    let mut kinds = FailureKind::ALL.iter();
    kinds.any(|kind| kind.word() == failure.kind)
}
