//! Test points: what an observer sees of a pipeline in each clock.
//!
//! A pipeline calls its probe wherever a memory port or an arithmetic unit is used. With
//! [`NoProbe`] the calls vanish at compile time, so watching costs nothing when nobody watches.

use super::float_unit::Fp;

/// Registers of a pipeline as visible during a clock, before its edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegisterView<F> {
    /// State code of the control machine.
    pub state: u8,
    /// Readable state name.
    pub state_name: &'static str,
    /// Row counter.
    pub i: usize,
    /// Column (tap) counter.
    pub j: usize,
    /// Phase within an element or a tap.
    pub phase: u8,
    /// Slot of the newest regressor word.
    pub head: usize,
    /// Product register.
    pub product: F,
    /// Accumulator.
    pub accumulator: F,
    /// Read latch of RAMB.
    pub read_latch: F,
    /// Denominator.
    pub denominator: F,
    /// Reciprocal of the denominator (NLMS: step over energy).
    pub reciprocal: F,
    /// Desired word.
    pub desired: F,
    /// Error.
    pub error: F,
    /// Output.
    pub output: F,
}

/// Signals at the pipeline's own ports in a clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PortView<F> {
    /// Input strobe.
    pub input_valid: bool,
    /// Whether the input is taken in this clock.
    pub input_ready: bool,
    /// Regressor word, `+0` without strobe.
    pub input: F,
    /// Desired word, `+0` without strobe.
    pub desired: F,
    /// Output strobe.
    pub output_valid: bool,
}

/// What leaves the pipeline in a clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tick<F> {
    /// The offered pair was taken; the next strobe may carry the next sample.
    pub accepted: bool,
    /// The filtered word, in the one clock in which its strobe is up.
    pub output: Option<F>,
}

/// An observer of the pipeline's wires. Every method defaults to doing nothing.
pub trait Probe<F: Fp> {
    /// Whether the register view is worth building at all.
    const WATCHES: bool = true;
    /// A clock begins; all registers and ports before the edge.
    fn clock(&mut self, _registers: &RegisterView<F>, _ports: &PortView<F>) {}
    /// A clock passes in which a unit is not done yet: registers and memories keep their words.
    ///
    /// * `state`: state code of the control machine.
    /// * `output_valid`: output strobe.
    fn wait(&mut self, _state: u8, _output_valid: bool) {}
    /// RAMA is read (`write` none) or written.
    fn rama(&mut self, _address: usize, _write: Option<F>, _read: F) {}
    /// RAMB is read (`write` none) or written.
    fn ramb(&mut self, _address: usize, _write: Option<F>, _read: F) {}
    /// The multiplier forms `q = a * b`.
    fn multiply(&mut self, _a: F, _b: F, _q: F) {}
    /// The adder forms `q = a + b`, or `a - b` if `subtract`.
    fn add(&mut self, _a: F, _b: F, _subtract: bool, _q: F) {}
    /// The divider forms `q = a / b`.
    fn divide(&mut self, _a: F, _b: F, _q: F) {}
}

/// The probe that is not there.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoProbe;

impl<F: Fp> Probe<F> for NoProbe {
    const WATCHES: bool = false;
}
