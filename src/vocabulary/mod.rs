//! Words that several stages share: closed lists of choices, each under one name and with one
//! spelling for scenario files, the command line and parameter files.
//!
//! Invariant: data only; imports nothing, and every stage may import it.

mod allan;
mod calibration;
mod filter;
mod hardware;
mod inference;
mod motion;
mod word;

pub use allan::AveragingTimes;
pub use calibration::{CompensationForm, EstimatorKind, ForgettingForm};
pub use filter::{
    ConstantUnit, DesiredSignal, InitialWeights, OutputRegister, Pipeline, SignLmsForm, UpdateSign,
};
pub use hardware::{
    Device, Division, ExportForm, NumberFormat, Overflow, Rounding, UnitSource, UpdateOrder,
    WordFormat,
};
pub use inference::{InferredQuantity, Prior};
pub use motion::{CaseAxis, PhaseRule};
pub(crate) use word::words;
pub use word::{UnknownWord, Word};
