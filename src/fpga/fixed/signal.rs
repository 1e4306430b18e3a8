//! The signals that fixed-point pipelines have, and the count of their words beyond the ends.

use super::format::{Format, Stored};

/// Names of the signals; a pipeline has some of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SignalName {
    /// Regressor words x and the ring of L.
    X,
    /// Desired word d.
    D,
    /// Intermediate t.
    T,
    /// Denominator.
    Den,
    /// Gain k.
    K,
    /// Inverse correlation R.
    R,
    /// Weights W.
    W,
    /// Output y and error e.
    Y,
}

impl SignalName {
    /// All of them, in the order of their codes.
    pub const ALL: [Self; 8] = [
        Self::X,
        Self::D,
        Self::T,
        Self::Den,
        Self::K,
        Self::R,
        Self::W,
        Self::Y,
    ];

    /// Its name in parameter files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::D => "d",
            Self::T => "t",
            Self::Den => "den",
            Self::K => "k",
            Self::R => "R",
            Self::W => "W",
            Self::Y => "y",
        }
    }

    /// Letter that ends the names of its Verilog parameters.
    #[must_use]
    pub const fn letter(self) -> char {
        match self {
            Self::X => 'X',
            Self::D => 'D',
            Self::T => 'T',
            Self::Den => 'N',
            Self::K => 'K',
            Self::R => 'R',
            Self::W => 'W',
            Self::Y => 'Y',
        }
    }

    /// Whether a core rounds into it: x and d come rounded.
    #[must_use]
    pub const fn is_rounded(self) -> bool {
        !matches!(self, Self::X | Self::D)
    }
}

/// A signal of a pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signal {
    /// Name.
    pub name: SignalName,
    /// Format.
    pub format: Format,
}

/// Words of each signal beyond the ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Overflows([u64; SignalName::ALL.len()]);

impl Overflows {
    /// Those of a signal.
    #[must_use]
    pub fn of(&self, name: SignalName) -> u64 {
        self.0[name as usize]
    }

    /// The code, its overflow counted.
    pub(super) fn counted(&mut self, name: SignalName, stored: Stored) -> i64 {
        self.0[name as usize] += u64::from(stored.overflowed);
        stored.code
    }
}
