//! Declaration of a pipeline: all that exports, timing and the bench must know of it, said once.
//!
//! A pipeline is a folder. Its `declaration` implements [`Core`] for the settings and [`Pipeline`]
//! for the constants they are rounded to; one line in [`crate::fpga::kinds`] enters it.

use super::board::{Board, BoardUsage, Surroundings};
use super::engine::Engine;
use super::error::FpgaError;
use super::float_unit::Fp;
use super::front_end::Pair;
use super::health::Warning;
use super::machine::{Machine, Sequencer};
use super::timing::{Units, Usage, measure};
use super::trace::{ClockRecord, Recorder, Window};
use crate::vocabulary::UpdateSign;

/// What is the same for all pipelines of a kind.
#[derive(Debug, PartialEq)]
pub struct Kind {
    /// Name in scenarios, parameter files and waveforms. In capitals, `VEC_` before it, the macro
    /// by which the testbench tells kinds apart; `tb_`, `_core` and `_ctrl` make its Verilog files.
    pub name: &'static str,
    /// Parameter of its Verilog core that is the tap count, the first of the core's.
    pub tap_parameter: &'static str,
    /// Names of the control states, in the order of their codes.
    pub states: &'static [&'static str],
    /// Verilog files and their text: control, core, testbench.
    pub sources: [(&'static str, &'static str); 3],
    /// Choices that no setting changes, for `params.json`: name and JSON value.
    pub fixed_choices: &'static [(&'static str, &'static str)],
    /// Whether the filter keeps an inverse correlation matrix, whose health is watched.
    pub has_matrix: bool,
}

/// Settings of one kind of pipeline in plain numbers, before any check.
pub trait Core {
    /// Constants in a word format.
    type Config<F: Fp>: Pipeline<F> + Copy;
    /// Clock-less engine.
    type Engine<F: Fp>: Engine<F> + Send + 'static;

    /// What all pipelines of the kind share.
    const KIND: &'static Kind;

    /// Number of weights.
    fn tap_count(&self) -> usize;

    /// What a sample counts for once the next has come; none where the weights follow a gradient.
    fn forgetting_factor(&self) -> Option<f64> {
        None
    }

    /// Rounds the settings to the word format and checks the rounded values.
    ///
    /// # Errors
    /// What the pipeline refuses.
    fn config<F: Fp>(&self) -> Result<Self::Config<F>, FpgaError>;

    /// The same with units of these latencies.
    ///
    /// # Errors
    /// What the pipeline refuses; one whose units take a clock each refuses all others.
    fn config_with<F: Fp>(&self, units: Units) -> Result<Self::Config<F>, FpgaError> {
        units.check()?;
        if units.wait() {
            return Err(FpgaError::CountOutOfRange {
                name: "latency of a unit",
                value: units.longest_clocks(),
                range: "1 clock: only rls is exported with more; run.sh takes DIV_LATENCY for the others",
            });
        }
        self.config()
    }

    /// Clock-less engine in its reset state.
    ///
    /// # Errors
    /// What the pipeline refuses.
    fn engine<F: Fp>(&self) -> Result<Self::Engine<F>, FpgaError>;

    /// Clocks per sample when the control machine waits for every result of these units.
    ///
    /// # Errors
    /// [`FpgaError::TapCount`], [`FpgaError::CountOutOfRange`].
    fn stalled_clocks(&self, units: Units) -> Result<u64, FpgaError>;

    /// Whether there is hardware with the engine's words.
    fn has_hardware(&self) -> bool {
        true
    }

    /// Warns if the first updates cost the words their digits, for inputs up to `input_max`.
    fn digits_warning<F: Fp>(&self, _input_max: f64) -> Option<Warning> {
        None
    }

    /// Samples after which theory expects the filter to fail by its rounding; none if it does not.
    fn failure_samples<F: Fp>(&self) -> Option<f64> {
        None
    }
}

/// Constants of a pipeline in its word format.
pub trait Pipeline<F: Fp> {
    /// What all pipelines of the kind share.
    fn kind(&self) -> &'static Kind;

    /// Number of weights.
    fn tap_count(&self) -> usize;

    /// Clocks from one accepted sample to the next, back to back.
    fn clocks_per_sample(&self) -> usize;

    /// Clocks from accepting a sample until its result can be read.
    fn latency_clocks(&self) -> usize;

    /// Latencies of the units. The clocks above are those of units of one clock.
    fn units(&self) -> Units {
        Units::ONE_CLOCK
    }

    /// Sign of the weight update.
    fn update_sign(&self) -> UpdateSign {
        UpdateSign::Corrected
    }

    /// Whether the core forms the desired word itself and does not use that of the pair.
    fn forms_desired(&self) -> bool {
        false
    }

    /// Constants and choices for the parameter files.
    fn parameters(&self) -> Parameters<F>;

    /// The clocked pipeline just out of reset.
    fn clocked(&self) -> Box<dyn Clocked<F>>;
}

/// A pipeline's own entries in the parameter files, in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameters<F> {
    /// Verilog macros, without `VEC_`.
    pub macros: Vec<(&'static str, Macro<F>)>,
    /// Choices for people, the tap count under its usual letter first.
    pub choices: Vec<(&'static str, usize)>,
    /// Constants for people, written as number and as bits.
    pub constants: Vec<(&'static str, F)>,
}

/// Value of a Verilog macro.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Macro<F> {
    /// Word with its width.
    Word(F),
    /// Zero or one.
    Flag(bool),
    /// Decimal number.
    Count(usize),
}

/// Clocked pipeline of any kind, for those who run or count it as a whole.
pub trait Clocked<F: Fp> {
    /// Words of RAMA, then of RAMB.
    fn memories(&self) -> Vec<F>;

    /// Runs back-to-back samples to completion, handing the clocks of a window to `sink`; returns
    /// one output word per pair.
    fn record(
        &mut self,
        pairs: &[Pair<F>],
        window: Window,
        sink: &mut dyn FnMut(&ClockRecord<F>),
    ) -> Vec<F>;

    /// Counts one back-to-back sample.
    fn usage(self: Box<Self>) -> Usage;

    /// Counts the clocks of a board around the pipeline.
    fn board_usage(self: Box<Self>, surroundings: Surroundings) -> BoardUsage;
}

impl<M: Machine> Clocked<M::Word> for Sequencer<M> {
    fn memories(&self) -> Vec<M::Word> {
        [self.rama(), self.ramb()].concat()
    }

    fn record(
        &mut self,
        pairs: &[Pair<M::Word>],
        window: Window,
        sink: &mut dyn FnMut(&ClockRecord<M::Word>),
    ) -> Vec<M::Word> {
        let mut outputs = Vec::with_capacity(pairs.len());
        let mut recorder = Recorder::new(window, sink);
        self.run_probed(pairs, &mut outputs, &mut recorder);
        recorder.finish();
        outputs
    }

    fn usage(self: Box<Self>) -> Usage {
        measure(*self)
    }

    fn board_usage(self: Box<Self>, surroundings: Surroundings) -> BoardUsage {
        Board::new(*self, surroundings).usage()
    }
}
