//! States and registers of the RLS pipeline.

use crate::fpga::float_unit::Fp;
use crate::fpga::probe::RegisterView;

/// States of the control machine; the discriminants are the state codes of the RTL.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum RlsState {
    /// Waiting for a strobe.
    Idle = 0,
    /// The new regressor word enters the ring, the desired word its register.
    RiLLoading = 1,
    /// `t = R L`: one product per clock.
    RiLReading = 2,
    /// The last sum of a row goes to both memories.
    RiLWriting = 3,
    /// `den = alpha + L't`: one product per clock.
    LrlReading = 4,
    /// The last sum goes to the register DEN.
    LrlWriting = 5,
    /// Correction of an element of R: product, then division or reciprocal product.
    RfrReading = 6,
    /// The corrected element is written back.
    RfrWriting = 7,
    /// `M = R L` with the updated R.
    RfmReading = 8,
    /// The last sum of a row goes to RAMA.
    RfmWriting = 9,
    /// `y = W'L`.
    OutReading = 10,
    /// The last sum goes to the output register.
    OutWriting = 11,
    /// Error in the first clock, then product and weight of each tap.
    RfwReading = 12,
    /// The new weight is written back.
    RfwWriting = 13,
}

impl RlsState {
    /// All states in code order.
    pub const ALL: [Self; 14] = [
        Self::Idle,
        Self::RiLLoading,
        Self::RiLReading,
        Self::RiLWriting,
        Self::LrlReading,
        Self::LrlWriting,
        Self::RfrReading,
        Self::RfrWriting,
        Self::RfmReading,
        Self::RfmWriting,
        Self::OutReading,
        Self::OutWriting,
        Self::RfwReading,
        Self::RfwWriting,
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
            Self::RiLLoading => "RiL_loading",
            Self::RiLReading => "RiL_reading",
            Self::RiLWriting => "RiL_writing",
            Self::LrlReading => "LRL_reading",
            Self::LrlWriting => "LRL_writing",
            Self::RfrReading => "RFR_reading",
            Self::RfrWriting => "RFR_writing",
            Self::RfmReading => "RFM_reading",
            Self::RfmWriting => "RFM_writing",
            Self::OutReading => "Out_reading",
            Self::OutWriting => "Out_writing",
            Self::RfwReading => "RFW_reading",
            Self::RfwWriting => "RFW_writing",
        }
    }
}

/// All registers of the pipeline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RlsRegisters<F> {
    /// Control state.
    pub state: RlsState,
    /// Row counter.
    pub i: usize,
    /// Column counter.
    pub j: usize,
    /// Phase: RFR 0, 1 reading, 2 writing; RFW 0 error, 1 reading, 2 writing.
    pub phase: u8,
    /// Ring slot of the newest regressor word.
    pub head: usize,
    /// Product P.
    pub product: F,
    /// Accumulator ACC.
    pub accumulator: F,
    /// Read latch RR.
    pub read_latch: F,
    /// Denominator DEN.
    pub denominator: F,
    /// Reciprocal RCP.
    pub reciprocal: F,
    /// Desired word D.
    pub desired: F,
    /// Error E.
    pub error: F,
    /// Output Y.
    pub output: F,
}

impl<F: Fp> RlsRegisters<F> {
    /// Values after reset: words `+0`, DEN 1, HEAD p-1 so that sample 0 goes to slot 0.
    #[must_use]
    pub fn reset(tap_count: usize) -> Self {
        Self {
            state: RlsState::Idle,
            i: 0,
            j: 0,
            phase: 0,
            head: tap_count - 1,
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
            i: self.i,
            j: self.j,
            phase: self.phase,
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
