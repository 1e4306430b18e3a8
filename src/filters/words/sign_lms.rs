//! Fixed-point words of the line enhancer.

use super::lms::EnergyWord;
use super::rls::{DesiredWord, OutputWord, RegressorWord, WeightWord};
use super::signals::{fixed_words, signal_tables};
use crate::vocabulary::{Overflow, Rounding};

fixed_words! {
    /// Fixed-point words of the line enhancer; each signal has a table of its own. Source of the defaults:
    /// derived for the sign form; the normalised one needs more integer bits in k and t.
    pub struct SignLmsWords {
        x: RegressorWord;
        d: DesiredWord;
        t: SignStepWord;
        den: EnergyWord;
        k: SignGainWord;
        w: WeightWord;
        y: OutputWord;
    }
}

signal_tables! {
    /// Step of the taps t: k with the sign of e, or k e.
    SignStepWord, 4;
    /// Gain k = step / denominator.
    SignGainWord, 4;
}
