//! Memories and units of a fixed-point pipeline during one clock.
//!
//! A machine reaches its two memory ports and its units only through here, so that every use of them is
//! seen. Products and sums are exact, in 128 bits.

use crate::fpga::memory::SinglePortRam;
use crate::fpga::timing::{UnitTiming, Units};

/// Use of a memory port in a clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PortAccess {
    /// Whether the port is used.
    pub is_used: bool,
    /// Address, 0 if unused.
    pub address: usize,
    /// Word written, if any.
    pub write: Option<i64>,
}

/// Use of the units in a clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct UnitUse {
    /// Products, those with a constant among them.
    pub products: u8,
    /// Sums and differences.
    pub sums: u8,
    /// Quotients.
    pub quotients: u8,
}

impl UnitUse {
    /// Clocks of the slowest unit in use, one if none is.
    pub(super) fn clocks(self, units: Units) -> u64 {
        let of = |uses: u8, unit: UnitTiming| if uses > 0 { unit.latency_clocks } else { 1 };
        let both = of(self.products, units.multiplier).max(of(self.sums, units.adder));
        both.max(of(self.quotients, units.divider))
    }
}

/// RAMA, RAMB and what was used of them and of the units.
#[derive(Debug)]
pub struct FixedDatapath<'a> {
    rama: &'a mut SinglePortRam<i64>,
    ramb: &'a mut SinglePortRam<i64>,
    ports: [PortAccess; 2],
    /// Words that stood where the memories are written.
    replaced: [i64; 2],
    units: UnitUse,
}

impl<'a> FixedDatapath<'a> {
    pub(super) fn new([rama, ramb]: &'a mut [SinglePortRam<i64>; 2]) -> Self {
        Self {
            rama,
            ramb,
            ports: [PortAccess::default(); 2],
            replaced: [0; 2],
            units: UnitUse::default(),
        }
    }

    /// Ports, RAMA first, and units in use so far.
    pub(super) fn used(&self) -> ([PortAccess; 2], UnitUse) {
        (self.ports, self.units)
    }

    /// Frees the ports and puts back what stood where the memories were written; the units in use.
    pub(super) fn undo(self) -> UnitUse {
        let memories = [self.rama, self.ramb];
        for ((memory, port), word) in memories.into_iter().zip(self.ports).zip(self.replaced) {
            memory.edge();
            if port.write.is_some() {
                memory.preload(port.address, word);
            }
        }
        self.units
    }

    /// The word at `address` of RAMA.
    pub fn read_a(&mut self, address: usize) -> i64 {
        self.ports[0] = read_of(address);
        self.rama.read(address)
    }

    /// The word at `address` of RAMB.
    pub fn read_b(&mut self, address: usize) -> i64 {
        self.ports[1] = read_of(address);
        self.ramb.read(address)
    }

    /// Writes `word` to `address` of RAMA.
    pub fn write_a(&mut self, address: usize, word: i64) {
        self.ports[0] = write_of(address, word);
        self.replaced[0] = self.rama.words()[address];
        self.rama.write(address, word);
    }

    /// Writes `word` to `address` of RAMB.
    pub fn write_b(&mut self, address: usize, word: i64) {
        self.ports[1] = write_of(address, word);
        self.replaced[1] = self.ramb.words()[address];
        self.ramb.write(address, word);
    }

    /// `a * b`, exact.
    pub fn multiply(&mut self, a: i64, b: i64) -> i128 {
        self.units.products += 1;
        i128::from(a) * i128::from(b)
    }

    /// `a + b`, exact.
    pub fn add(&mut self, a: i128, b: i128) -> i128 {
        self.count_sum();
        a + b
    }

    /// Notes a sum that is formed where it is rounded.
    pub fn count_sum(&mut self) {
        self.units.sums += 1;
    }

    /// Notes a product that is formed where it is rounded.
    pub fn count_product(&mut self) {
        self.units.products += 1;
    }

    /// Notes a quotient, which is formed where it is rounded.
    pub fn count_quotient(&mut self) {
        self.units.quotients += 1;
    }
}

fn read_of(address: usize) -> PortAccess {
    PortAccess {
        is_used: true,
        address,
        write: None,
    }
}

fn write_of(address: usize, word: i64) -> PortAccess {
    PortAccess {
        write: Some(word),
        ..read_of(address)
    }
}
