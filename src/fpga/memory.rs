//! Single-port memory: one access per clock, read asynchronous, write at the clock's end.
//!
//! ```text
//!            +---------+
//!  addr ---->|         |
//!  we ------>|   RAM   |----> rdata    (the word before the edge)
//!  wdata --->|         |
//!            +---------+
//! ```
//!
//! This is the distributed (LUT) RAM of an FPGA in single-port mode. The paper's clock counts
//! only fit single-port memories, so a second access within a clock is a fault of the schedule
//! and stops the model.

use super::float_unit::Fp;

/// A memory with one address port.
#[derive(Clone, Debug)]
pub struct SinglePortRam<F> {
    name: &'static str,
    words: Vec<F>,
    accessed: bool,
}

impl<F: Fp> SinglePortRam<F> {
    /// A memory of `depth` words, all `+0`.
    #[must_use]
    pub fn new(name: &'static str, depth: usize) -> Self {
        Self {
            name,
            words: vec![F::ZERO; depth],
            accessed: false,
        }
    }
}

impl<F: Copy> SinglePortRam<F> {
    /// A memory of `depth` words, all `word`.
    #[must_use]
    pub(crate) fn filled(name: &'static str, depth: usize, word: F) -> Self {
        Self {
            name,
            words: vec![word; depth],
            accessed: false,
        }
    }

    /// The word at `address`; takes the port for this clock.
    ///
    /// # Panics
    /// If the port has been used in this clock, or `address` is outside the memory.
    #[inline]
    pub fn read(&mut self, address: usize) -> F {
        self.take_port(address);
        self.words[address]
    }

    /// Writes `word` to `address`; takes the port for this clock.
    ///
    /// # Panics
    /// If the port has been used in this clock, or `address` is outside the memory.
    #[inline]
    pub fn write(&mut self, address: usize, word: F) {
        self.take_port(address);
        self.words[address] = word;
    }

    /// The clock edge: the port is free again.
    #[inline]
    pub fn edge(&mut self) {
        self.accessed = false;
    }

    /// All words, outside the clock (a debugger's view, not a port access).
    #[must_use]
    pub fn words(&self) -> &[F] {
        &self.words
    }

    /// Sets the initial contents, as the configuration bitstream would.
    pub(crate) fn preload(&mut self, address: usize, word: F) {
        self.words[address] = word;
    }

    #[inline]
    fn take_port(&mut self, address: usize) {
        assert!(
            !self.accessed,
            "{}: second access (address {address}) in one clock of a single-port memory",
            self.name
        );
        self.accessed = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_access_per_clock_is_allowed() {
        let mut ram = SinglePortRam::<f64>::new("RAMA", 4);
        ram.write(3, 2.5);
        ram.edge();
        assert_eq!(Fp::to_bits(ram.read(3)), Fp::to_bits(2.5_f64));
    }

    #[test]
    #[should_panic(expected = "second access (address 1) in one clock")]
    fn a_second_access_in_a_clock_stops_the_model() {
        let mut ram = SinglePortRam::<f64>::new("RAMA", 4);
        let _ = ram.read(0);
        ram.write(1, 1.0);
    }
}
