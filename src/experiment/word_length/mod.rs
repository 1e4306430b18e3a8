//! Word lengths of a fixed-point filter on trial: what each costs, and the shortest that do.
//!
//! Every trial filters the same words of the scenario's gyro from reset and is compared with the same
//! filter in binary64. First one length for all signals, bit by bit; then, from the shortest that does,
//! signal by signal.
//!
//! Checked by `word_length`.

mod bench;
mod search;

pub use bench::{WordLengthError, WordLengthLimits, WordLengthTrial};
pub use search::{WordLengths, word_lengths};
