//! What may be done about samples that are missing in a log.

use super::format::LogFormat;
use super::motion::LogMotion;

/// What may be done about samples that are missing in a log: no message names a way out that what reads it would
/// refuse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::recording) enum Gaps {
    /// The log is cut there, or differences span them.
    Pooled,
    /// Every word is needed, of a part of the log at least.
    Refused,
    /// Words go on as they come, and none is put off.
    Passed,
    /// It is no log, of which options could say so.
    Unsaid,
}

impl Gaps {
    /// What may be done in a log by what is said of it.
    ///
    /// * `needs_all`: whether every word is needed, whatever is said.
    pub(in crate::recording) fn of(format: &LogFormat, needs_all: bool) -> Self {
        let is_compared = format.reference_column.is_some();
        let moves = matches!(
            format.motion,
            Some(LogMotion::Swing { .. } | LogMotion::Dwells)
        );
        match needs_all || is_compared || moves {
            true => Self::Refused,
            false => Self::Pooled,
        }
    }

    /// What goes on where the stamps show a gap.
    pub(in crate::recording) fn at_stamps(self) -> &'static str {
        match self {
            Self::Pooled => {
                ": --split-gaps cuts the log there and pools what lies between, --gap-aware lets differences \
                 span it, --rows or --to-s takes a part of it"
            }
            Self::Refused => ": --rows or --to-s takes a part of it without gaps",
            Self::Passed => ": words are passed on up to it",
            Self::Unsaid => "",
        }
    }

    /// What goes on where a number is missing.
    pub(in crate::recording) fn at_number(self) -> &'static str {
        match self {
            Self::Pooled => "; --missing gap takes the sample to be missing",
            Self::Refused => "; --missing gap with --rows takes a part in which none is missing",
            Self::Passed | Self::Unsaid => "",
        }
    }
}
