//! Fixed-point words of the line enhancer.

use super::lms::EnergyWord;
use super::rls::{DesiredWord, OutputWord, RegressorWord, WeightWord};
use super::signals::{signal_tables, signals};
use crate::declare::table;
use crate::vocabulary::{Overflow, Rounding};

table! {
    /// Fixed-point words of the line enhancer; each signal has a table of its own. Source of the defaults:
    /// derived for the sign form; the normalised one needs more integer bits in k and t.
    pub struct SignLmsWords {
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
        t: SignStepWord;
        den: EnergyWord;
        k: SignGainWord;
        w: WeightWord;
        y: OutputWord;
    }
}

signals!(SignLmsWords: x d t den k w y);

signal_tables! {
    /// Step of the taps t: k with the sign of e, or k e.
    SignStepWord, 4;
    /// Gain k = step / denominator.
    SignGainWord, 4;
}
