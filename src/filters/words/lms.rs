//! Fixed-point words of least mean squares.

use super::rls::{DesiredWord, OutputWord, RegressorWord, WeightWord};
use super::signals::{signal_tables, signals};
use crate::declare::table;
use crate::vocabulary::{Overflow, Rounding};

table! {
    /// Fixed-point words of least mean squares; each signal has a table of its own. Source of the defaults:
    /// derived from a full scale of 64 taps and from the noise of the paper's gyro at rest.
    pub struct LmsWords {
        /// Rate that the value 1 of x, d and y stands for. Source of the default: twice the swing of the
        /// paper.
        full_scale_deg_per_h: f64 = 7200.0, in 1e-3..=1e9, "deg/h";
        /// Bits of a word, of every signal that does not say otherwise.
        word_bits: u32 = 32, in 2..=48;
        /// How values between two words are rounded, in every signal that does not say otherwise.
        rounding: Rounding = "half-up";
        /// What becomes of values beyond the ends, in every signal that does not say otherwise.
        overflow: Overflow = "saturate";
        x: RegressorWord;
        d: DesiredWord;
        t: StepWord;
        den: EnergyWord;
        k: StepGainWord;
        w: WeightWord;
        y: OutputWord;
    }
}

signals!(LmsWords: x d t den k w y);

signal_tables! {
    /// Step of the taps t = k e.
    StepWord, 8;
    /// Denominator: regularisation + L'L, of the normalised form.
    EnergyWord, 8;
    /// Gain k: the step size, over the denominator in the normalised form; in the inverse square of the full
    /// scale.
    StepGainWord, 17;
}
