//! Memories and arithmetic units of a pipeline during one clock.
//!
//! A machine reaches its two memory ports and its adder, multiplier and divider only through here,
//! so that a probe sees every use of them.

use super::float_unit::Fp;
use super::memory::SinglePortRam;
use super::probe::Probe;

/// RAMA, RAMB and the units, watched by a probe.
#[derive(Debug)]
pub struct Datapath<'a, F, Q> {
    rama: &'a mut SinglePortRam<F>,
    ramb: &'a mut SinglePortRam<F>,
    probe: &'a mut Q,
}

impl<'a, F: Fp, Q: Probe<F>> Datapath<'a, F, Q> {
    #[inline]
    pub(super) fn new([rama, ramb]: &'a mut [SinglePortRam<F>; 2], probe: &'a mut Q) -> Self {
        Self { rama, ramb, probe }
    }

    /// The word at `address` of RAMA.
    #[inline]
    pub fn read_a(&mut self, address: usize) -> F {
        let word = self.rama.read(address);
        self.probe.rama(address, None, word);
        word
    }

    /// The word at `address` of RAMB.
    #[inline]
    pub fn read_b(&mut self, address: usize) -> F {
        let word = self.ramb.read(address);
        self.probe.ramb(address, None, word);
        word
    }

    /// Writes `word` to `address` of RAMA.
    #[inline]
    pub fn write_a(&mut self, address: usize, word: F) {
        self.probe
            .rama(address, Some(word), self.rama.words()[address]);
        self.rama.write(address, word);
    }

    /// Writes `word` to `address` of RAMB.
    #[inline]
    pub fn write_b(&mut self, address: usize, word: F) {
        self.probe
            .ramb(address, Some(word), self.ramb.words()[address]);
        self.ramb.write(address, word);
    }

    /// `a * b` in the multiplier.
    #[inline]
    pub fn multiply(&mut self, a: F, b: F) -> F {
        let q = a.mul(b);
        self.probe.multiply(a, b, q);
        q
    }

    /// `a + b` in the adder.
    #[inline]
    pub fn add(&mut self, a: F, b: F) -> F {
        let q = a.add(b);
        self.probe.add(a, b, false, q);
        q
    }

    /// `a - b` in the adder.
    #[inline]
    pub fn subtract(&mut self, a: F, b: F) -> F {
        let q = a.sub(b);
        self.probe.add(a, b, true, q);
        q
    }

    /// `a / b` in the divider.
    #[inline]
    pub fn divide(&mut self, a: F, b: F) -> F {
        let q = a.div(b);
        self.probe.divide(a, b, q);
        q
    }
}
