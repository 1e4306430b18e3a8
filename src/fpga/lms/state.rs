//! States and registers of the LMS pipeline.

use crate::fpga::float_unit::Fp;
use crate::fpga::probe::RegisterView;

/// States of the control machine; the discriminants are the state codes of the RTL.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum LmsState {
    /// Waiting for a strobe.
    Idle = 0,
    /// The new word enters the ring; the desired word is latched or begun.
    LLoading = 1,
    /// NLMS: energy `eps + L'L`, one product per clock.
    LlReading = 2,
    /// NLMS: the last sum goes to DEN.
    LlWriting = 3,
    /// `y = W'L`, one product per clock.
    OutReading = 4,
    /// The last sum goes to Y; D is halved if it is a mean.
    OutWriting = 5,
    /// Error; NLMS: step over energy.
    Err = 6,
    /// The error times the step.
    Gain = 7,
    /// Product of a tap.
    LmwReading = 8,
    /// The new weight is written back.
    LmwWriting = 9,
}

impl LmsState {
    /// All states in code order.
    pub const ALL: [Self; 10] = [
        Self::Idle,
        Self::LLoading,
        Self::LlReading,
        Self::LlWriting,
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
            Self::LLoading => "L_loading",
            Self::LlReading => "LL_reading",
            Self::LlWriting => "LL_writing",
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
pub struct LmsRegisters<F> {
    /// Control state.
    pub state: LmsState,
    /// Tap counter.
    pub j: usize,
    /// Ring slot of the newest word.
    pub head: usize,
    /// Previous input XP.
    pub previous: F,
    /// Product P.
    pub product: F,
    /// Accumulator ACC.
    pub accumulator: F,
    /// Read latch RR.
    pub read_latch: F,
    /// Energy DEN.
    pub denominator: F,
    /// Step over energy RCP.
    pub reciprocal: F,
    /// Desired word D.
    pub desired: F,
    /// Error E, scaled by the step after GAIN.
    pub error: F,
    /// Output Y.
    pub output: F,
}

impl<F: Fp> LmsRegisters<F> {
    /// Values after reset: words `+0`, DEN 1, HEAD N-1 so that sample 0 goes to slot 0.
    #[must_use]
    pub fn reset(tap_count: usize) -> Self {
        Self {
            state: LmsState::Idle,
            j: 0,
            head: tap_count - 1,
            previous: F::ZERO,
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
