//! Fixed-point words of least mean squares.

use super::rls::{DesiredWord, OutputWord, RegressorWord, WeightWord};
use super::signals::{fixed_words, signal_tables};
use crate::vocabulary::{Overflow, Rounding};

fixed_words! {
    /// Fixed-point words of least mean squares; each signal has a table of its own. Source of the defaults:
    /// derived from a full scale of 64 taps and from the noise of the paper's gyro at rest.
    pub struct LmsWords {
        x: RegressorWord;
        d: DesiredWord;
        t: StepWord;
        den: EnergyWord;
        k: StepGainWord;
        w: WeightWord;
        y: OutputWord;
    }
}

signal_tables! {
    /// Step of the taps t = k e.
    StepWord, 8;
    /// Denominator: regularisation + L'L, of the normalised form.
    EnergyWord, 8;
    /// Gain k: the step size, over the denominator in the normalised form; in the inverse square of the full
    /// scale.
    StepGainWord, 17;
}
