//! Fixed-point words of recursive least squares.

use super::signals::{signal_tables, signals};
use crate::declare::table;
use crate::vocabulary::{Overflow, Rounding};

table! {
    /// Fixed-point words of recursive least squares; each signal has a table of its own. Source of the
    /// defaults: trials on the words of the paper's gyro, which run on 22 to 40 bits.
    pub struct RlsWords {
        /// Rate that the value 1 of x, d and y stands for. Source of the default: twice the swing of the
        /// paper.
        full_scale_deg_per_h: f64 = 7200.0, in 1e-3..=1e9, "deg/h";
        /// Bits of a word, of every signal that does not say otherwise.
        word_bits: u32 = 32, in 2..=48;
        /// How values between two words are rounded, in every signal that does not say otherwise.
        rounding: Rounding = "half-up";
        /// What becomes of values beyond the ends, in every signal that does not say otherwise.
        overflow: Overflow = "saturate";
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

signals!(RlsWords: x d t den k r w y, r_floor_steps);

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
