//! Registers and states of a control machine, in the form every pipeline has them.

use super::float_unit::Fp;
use super::probe::RegisterView;

/// States of a control machine. Their codes are their places in [`Self::NAMES`].
pub trait ControlState: Copy + Eq {
    /// State in which the machine waits for a strobe; its code is 0.
    const IDLE: Self;
    /// Names in traces and waveforms, in the order of the codes.
    const NAMES: &'static [&'static str];
    /// Code on the state bus of the RTL.
    fn code(self) -> u8;
}

/// Declares the states of a control machine in the order of the RTL's codes, each with its name.
macro_rules! control_states {
    (
        $(#[$about:meta])*
        pub enum $states:ident {
            $($(#[$doc:meta])* $state:ident = $name:literal,)+
        }
    ) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        pub enum $states {
            $($(#[$doc])* $state,)+
        }

        impl $crate::fpga::registers::ControlState for $states {
            const IDLE: Self = Self::Idle;
            const NAMES: &'static [&'static str] = &[$($name),+];

            #[inline]
            fn code(self) -> u8 {
                self as u8
            }
        }
    };
}
pub(super) use control_states;

/// Registers that every pipeline has, named as in the RTL. A counter that a pipeline has not
/// built stays at zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Registers<S, F> {
    /// Control state.
    pub state: S,
    /// Row counter.
    pub i: usize,
    /// Column (tap) counter.
    pub j: usize,
    /// Phase within an element or a tap.
    pub phase: u8,
    /// Ring slot HEAD of the newest regressor word.
    pub head: usize,
    /// Product P.
    pub product: F,
    /// Accumulator ACC.
    pub accumulator: F,
    /// Read latch RR.
    pub read_latch: F,
    /// Denominator DEN.
    pub denominator: F,
    /// Reciprocal RCP; of the least-mean-squares filters the step over the energy.
    pub reciprocal: F,
    /// Desired word D.
    pub desired: F,
    /// Error E; of the least-mean-squares filters the factor of the taps after GAIN.
    pub error: F,
    /// Output Y.
    pub output: F,
}

impl<S: ControlState, F: Fp> Registers<S, F> {
    /// Values after reset: words `+0`, DEN 1, HEAD p-1 so that sample 0 goes to slot 0.
    #[must_use]
    pub fn reset(tap_count: usize) -> Self {
        Self {
            state: S::IDLE,
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

    /// Ring slot of tap j: `(HEAD - j) mod p`.
    #[inline]
    pub(super) fn slot(&self, j: usize, tap_count: usize) -> usize {
        if self.head >= j {
            self.head - j
        } else {
            self.head + tap_count - j
        }
    }

    /// Ring slot after HEAD, which holds the oldest word: `(HEAD + 1) mod p`.
    #[inline]
    pub(super) fn next_slot(&self, tap_count: usize) -> usize {
        let next = self.head + 1;
        if next == tap_count { 0 } else { next }
    }

    /// The registers in the form a probe sees them.
    pub(super) fn view(&self) -> RegisterView<F> {
        let code = self.state.code();
        RegisterView {
            state: code,
            state_name: S::NAMES[usize::from(code)],
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
