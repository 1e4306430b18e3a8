//! Fixed-point words of recursive least squares.

use super::signals::{fixed_words, signal_tables};
use crate::vocabulary::{Overflow, Rounding};

fixed_words! {
    /// Fixed-point words of recursive least squares; each signal has a table of its own. Source of the
    /// defaults: trials on the words of the paper's gyro, which run on 22 to 40 bits.
    pub struct RlsWords {
        /// Smallest diagonal element of R, in its last bits, which keeps a filter that forgets nothing alive;
        /// 0 for none.
        r_floor_steps: u32 = 0, in 0..=1000000;
        x: RegressorWord;
        d: DesiredWord;
        t: IntermediateWord;
        den: DenominatorWord;
        k: GainWord;
        r: InverseWord;
        w: WeightWord;
        y: OutputWord;
    }
}

signal_tables! {
    /// Regressors x, words of 1.0 full scale.
    RegressorWord, 1;
    /// Desired signal d, in which samples arrive.
    DesiredWord, 1;
    /// Intermediate t = R L.
    IntermediateWord, 11;
    /// Denominator alpha + L't.
    DenominatorWord, 12;
    /// Gain k = t / den.
    GainWord, 9;
    /// Inverse correlation R, in the inverse square of the full scale.
    InverseWord, 14;
    /// Weights W.
    WeightWord, 3;
    /// Output y and error e.
    OutputWord, 1;
}
