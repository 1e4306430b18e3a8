//! States and registers of the line enhancer.

use crate::fpga::float_unit::Fp;
use crate::fpga::probe::RegisterView;

/// States of the control machine; the discriminants are the state codes of the RTL.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum SignLmsState {
    /// Waiting for a strobe.
    Idle = 0,
    /// The word that leaves the taps is read; square of the one that enters.
    LReading = 1,
    /// The new word enters the ring; the fresh sum of the norm takes its square.
    LWriting = 2,
    /// The norm takes the square of the new word; square of the old one.
    NrmAdding = 3,
    /// The norm gives the square of the old word away, or is replaced.
    NrmWriting = 4,
    /// `y = W'L`, one product per clock; the denominator in the first.
    OutReading = 5,
    /// The last sum goes to Y.
    OutWriting = 6,
    /// Error; step over energy.
    Err = 7,
    /// Step over energy with the sign of the error, or times the error.
    Gain = 8,
    /// Product of a tap.
    LmwReading = 9,
    /// The new weight is written back.
    LmwWriting = 10,
}

impl SignLmsState {
    /// All states in code order.
    pub const ALL: [Self; 11] = [
        Self::Idle,
        Self::LReading,
        Self::LWriting,
        Self::NrmAdding,
        Self::NrmWriting,
        Self::OutReading,
        Self::OutWriting,
        Self::Err,
        Self::Gain,
        Self::LmwReading,
        Self::LmwWriting,
    ];

    /// Code on the state bus.
    #[must_use]
    pub fn code(self) -> u8 {
        self as u8
    }

    /// Name in traces and waveforms.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Idle => "Idle",
            Self::LReading => "L_reading",
            Self::LWriting => "L_writing",
            Self::NrmAdding => "NRM_adding",
            Self::NrmWriting => "NRM_writing",
            Self::OutReading => "Out_reading",
            Self::OutWriting => "Out_writing",
            Self::Err => "ERR",
            Self::Gain => "GAIN",
            Self::LmwReading => "LMW_reading",
            Self::LmwWriting => "LMW_writing",
        }
    }
}

/// All registers of the pipeline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignLmsRegisters<F> {
    /// Control state.
    pub state: SignLmsState,
    /// Tap counter.
    pub j: usize,
    /// Ring slot of the newest word.
    pub head: usize,
    /// Samples since the norm was replaced.
    pub age: u32,
    /// Samples on end that the guard has held the weights.
    pub held_samples: usize,
    /// Input X.
    pub input: F,
    /// Norm S.
    pub norm: F,
    /// Fresh sum T of the norm.
    pub fresh: F,
    /// Product P.
    pub product: F,
    /// Accumulator ACC.
    pub accumulator: F,
    /// Read latch RR: the word that leaves the taps, then a weight.
    pub read_latch: F,
    /// Regularised norm DEN.
    pub denominator: F,
    /// Step over energy RCP.
    pub reciprocal: F,
    /// Desired word D.
    pub desired: F,
    /// Error E, the factor of the taps after GAIN.
    pub error: F,
    /// Output Y.
    pub output: F,
}

impl<F: Fp> SignLmsRegisters<F> {
    /// Values after reset: words `+0`, DEN 1, HEAD M-1 so that sample 0 goes to slot 0.
    #[must_use]
    pub fn reset(tap_count: usize) -> Self {
        Self {
            state: SignLmsState::Idle,
            j: 0,
            head: tap_count - 1,
            age: 0,
            held_samples: 0,
            input: F::ZERO,
            norm: F::ZERO,
            fresh: F::ZERO,
            product: F::ZERO,
            accumulator: F::ZERO,
            read_latch: F::ZERO,
            denominator: F::ONE,
            reciprocal: F::ZERO,
            desired: F::ZERO,
            error: F::ZERO,
            output: F::ZERO,
        }
    }

    /// The registers in the form all pipelines show them.
    pub(crate) fn view(&self) -> RegisterView<F> {
        RegisterView {
            state: self.state.code(),
            state_name: self.state.name(),
            i: 0,
            j: self.j,
            phase: 0,
            head: self.head,
            product: self.product,
            accumulator: self.accumulator,
            read_latch: self.read_latch,
            denominator: self.denominator,
            reciprocal: self.reciprocal,
            desired: self.desired,
            error: self.error,
            output: self.output,
        }
    }
}
