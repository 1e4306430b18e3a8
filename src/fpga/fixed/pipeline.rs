//! Declaration of a fixed-point pipeline: all that exports, timing and the bench must know of it, said once.
//!
//! A pipeline is a folder. Its `declaration` implements [`FixedPipeline`] for its constants; one line in
//! [`super::kinds`] enters it.

use super::CodePair;
use super::format::Format;
use super::sequencer::FixedClocked;
use super::signal::{Overflows, Signal};
use super::taps::TapFormats;
use crate::fpga::timing::Units;

/// What is the same for all fixed-point pipelines of a kind.
#[derive(Debug, PartialEq)]
pub struct FixedKind {
    /// Name in parameter files. In capitals, `VEC_` before it, the macro by which the run script tells
    /// kinds apart; `tb_`, `_core` and `_top` make its Verilog files.
    pub name: &'static str,
    /// Parameter of its Verilog core that is the tap count.
    pub tap_parameter: &'static str,
    /// Names of the control states, in the order of their codes.
    pub states: &'static [&'static str],
    /// Verilog files of its own and their text.
    pub sources: &'static [(&'static str, &'static str)],
    /// Instance that holds the control registers: in the testbench, the core being `dut`.
    pub control: &'static str,
    /// Words of both memories, for people.
    pub memories: &'static str,
    /// Whether K and T are registers, not words of a memory.
    pub has_gain_registers: bool,
    /// Whether the filter keeps an inverse correlation matrix, whose health is watched.
    pub has_matrix: bool,
}

/// What a pipeline has of its own in the parameter files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FixedParameters {
    /// Parameters of the Verilog core beside taps and formats: name and value.
    pub core: Vec<(&'static str, String)>,
    /// Constants for people: name and JSON value.
    pub constants: Vec<(&'static str, String)>,
}

/// Constants of a fixed-point pipeline.
pub trait FixedPipeline {
    /// What all pipelines of the kind share.
    fn kind(&self) -> &'static FixedKind;

    /// Number of weights.
    fn tap_count(&self) -> usize;

    /// Its signals, in the order of their names.
    fn signals(&self) -> Vec<Signal>;

    /// Formats of x, d, W and y.
    fn tap_formats(&self) -> TapFormats;

    /// Bits of a word of RAMA and of RAMB.
    fn memory_bits(&self) -> [u32; 2];

    /// Clocks from one accepted sample to the next, back to back.
    fn clocks_per_sample(&self) -> usize;

    /// Clocks from accepting a sample until its result can be read.
    fn latency_clocks(&self) -> usize;

    /// Divisions of a sample, all before its result.
    fn divisions(&self) -> usize;

    /// Constants for the parameter files.
    fn parameters(&self) -> FixedParameters;

    /// The clocked pipeline just out of reset.
    fn clocked(&self) -> Box<dyn FixedClocked>;

    /// The clock-less engine in the same state.
    fn engine(&self) -> Box<dyn FixedEngine + Send>;

    /// Latencies of the units.
    fn units(&self) -> Units {
        Units::ONE_CLOCK
    }

    /// Whether the subtraction from R, its product with 1/alpha and the rounding of that have a step each.
    fn splits(&self) -> bool {
        false
    }

    /// Clocks from one accepted sample to the next with units of these latencies; of a pipeline with units
    /// of a clock only, with such a divider.
    fn stalled_clocks(&self, units: Units) -> u64 {
        let longer = units.divider.latency_clocks - 1;
        self.clocks_per_sample() as u64 + self.divisions() as u64 * longer
    }
}

/// Clock-less engine of a fixed-point pipeline, bit for bit its words.
pub trait FixedEngine {
    /// Filters one pair and returns the code of `y`.
    fn process(&mut self, pair: CodePair) -> i64;

    /// Codes of the weights, tap 0 (newest regressor word) first.
    fn weights(&self) -> &[i64];

    /// Words beyond the ends, and what became of the signals that must stay above zero.
    fn health(&self) -> FixedHealth;

    /// Inverse correlation matrix R; none for a filter without one.
    fn inverse_correlation(&self) -> Option<CodeMatrix<'_>> {
        None
    }
}

/// What went beyond the ends of its words, and when the filter stopped being that of the books.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct FixedHealth {
    /// Words of the core's signals beyond the ends; of y the errors e among them.
    pub overflows: Overflows,
    /// Diagonal elements of R that the floor held up.
    pub floored: u64,
    /// First sample with a denominator or a diagonal element of R at or below zero.
    pub indefinite_at: Option<u64>,
    /// Samples seen.
    samples: u64,
}

impl FixedHealth {
    /// Closes a sample.
    ///
    /// * `is_definite`: whether denominator and diagonal are above zero.
    pub(super) fn close(&mut self, is_definite: bool) {
        if !is_definite && self.indefinite_at.is_none() {
            self.indefinite_at = Some(self.samples);
        }
        self.samples += 1;
    }
}

/// Inverse correlation matrix of an engine and the constants that it is judged by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CodeMatrix<'a> {
    /// Codes, `[p * p]`, row by row.
    pub codes: &'a [i64],
    /// Their format.
    pub format: Format,
    /// Initial diagonal, in the inverse square of the input's full scale.
    pub delta: f64,
    /// Forgetting factor alpha.
    pub alpha: f64,
}
