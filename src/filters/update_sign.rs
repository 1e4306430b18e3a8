//! The sign of the weight update, which the paper prints the wrong way round.

/// Sign before the error term of the weight update.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UpdateSign {
    /// Plus: the form that converges, with the error `e = d - y`.
    Corrected,
    /// Minus, as the paper's equations (6) and (9) print it: diverges.
    AsPrinted,
}

impl UpdateSign {
    /// +1 or -1.
    pub(super) fn factor(self) -> f64 {
        match self {
            Self::Corrected => 1.0,
            Self::AsPrinted => -1.0,
        }
    }
}
