//! Words that several stages share: closed lists of choices, each under one name and with one
//! spelling for scenario files, the command line and parameter files.
//!
//! Invariant: data only; imports nothing, and every stage may import it.

mod interim;
mod motion;
mod word;

pub use interim::{
    AveragingTimes, CompensationRule, ConstantUnit, DesiredSignal, Division, EstimatorKind,
    ForgettingLaw, InitialWeights, NumberFormat, OutputRegister, Pipeline, SignLmsForm,
    UpdateOrder, UpdateSign,
};
pub use motion::{CaseAxis, PhaseRule};
pub(crate) use word::words;
pub use word::{UnknownWord, Word};
