//! Arithmetic units that take more than one clock.

use crate::fpga::error::FpgaError;

/// Timing of one arithmetic unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct UnitTiming {
    /// Clocks from operands to the result register, 1 to 1000.
    pub latency_clocks: u64,
    /// Clocks between two operations, 1 (fully pipelined) to `latency_clocks` (iterative).
    pub interval_clocks: u64,
}

impl UnitTiming {
    /// A unit that takes an operation every clock.
    #[must_use]
    pub const fn pipelined(latency_clocks: u64) -> Self {
        Self {
            latency_clocks,
            interval_clocks: 1,
        }
    }

    /// A unit that is busy until its result is out.
    #[must_use]
    pub const fn iterative(latency_clocks: u64) -> Self {
        Self {
            latency_clocks,
            interval_clocks: latency_clocks,
        }
    }

    fn check(self, name: &'static str) -> Result<(), FpgaError> {
        if !(1..=1000).contains(&self.latency_clocks) {
            return Err(FpgaError::CountOutOfRange {
                name,
                value: self.latency_clocks,
                range: "1 to 1000 clocks",
            });
        }
        if !(1..=self.latency_clocks).contains(&self.interval_clocks) {
            return Err(FpgaError::CountOutOfRange {
                name,
                value: self.interval_clocks,
                range: "an initiation interval of 1 clock to the latency",
            });
        }
        Ok(())
    }
}

/// The three units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Units {
    /// Adder and subtractor.
    pub adder: UnitTiming,
    /// Multiplier.
    pub multiplier: UnitTiming,
    /// Divider.
    pub divider: UnitTiming,
}

impl Units {
    /// The paper's assumption: every operation in one clock.
    pub const ONE_CLOCK: Self = Self {
        adder: UnitTiming::pipelined(1),
        multiplier: UnitTiming::pipelined(1),
        divider: UnitTiming::pipelined(1),
    };

    /// Checks latencies and intervals.
    ///
    /// # Errors
    /// [`FpgaError::CountOutOfRange`] naming the unit.
    pub fn check(self) -> Result<(), FpgaError> {
        self.adder.check("adder latency")?;
        self.multiplier.check("multiplier latency")?;
        self.divider.check("divider latency")
    }

    /// Latency of the slowest.
    #[must_use]
    pub(in crate::fpga) fn longest_clocks(self) -> u64 {
        let Self {
            adder,
            multiplier,
            divider,
        } = self;
        let both = adder.latency_clocks.max(multiplier.latency_clocks);
        both.max(divider.latency_clocks)
    }

    /// Whether any takes more than a clock.
    pub(in crate::fpga) fn wait(self) -> bool {
        self.longest_clocks() > 1
    }

    /// Clocks of a dot product over `taps` words when the control waits for every result: a product,
    /// products beside sums, the last sum.
    pub(in crate::fpga) fn dot_clocks(self, taps: u64) -> u64 {
        let (la, lm) = (self.adder.latency_clocks, self.multiplier.latency_clocks);
        lm + (taps - 1) * la.max(lm) + la
    }

    /// Whether subtraction and product with `1/alpha` fit one clock, as in the RTL.
    #[must_use]
    pub fn chain(self) -> bool {
        self.adder.latency_clocks == 1 && self.multiplier.latency_clocks == 1
    }

    /// Clocks by which the product with `1/alpha` lengthens an element's update: none if it is
    /// wired away (alpha = 1) or chained behind the subtraction within one clock.
    pub(in crate::fpga) fn forgetting_clocks(self, forgets: bool) -> u64 {
        if forgets && !self.chain() {
            self.multiplier.latency_clocks
        } else {
            0
        }
    }
}

/// Typical units: starting points for one's own numbers, not promises.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preset {
    /// Name for the command line.
    pub name: &'static str,
    /// Clock at which these latencies are usual.
    pub clock_mhz: f64,
    /// Latencies and intervals.
    pub units: Units,
}

const fn preset(
    name: &'static str,
    clock_mhz: f64,
    adder: u64,
    multiplier: u64,
    divider: UnitTiming,
) -> Preset {
    Preset {
        name,
        clock_mhz,
        units: Units {
            adder: UnitTiming::pipelined(adder),
            multiplier: UnitTiming::pipelined(multiplier),
            divider,
        },
    }
}

/// Presets. Latencies of vendor units depend on their options; type your own where you know them.
pub const PRESETS: [Preset; 8] = [
    preset("paper", 40.0, 1, 1, UnitTiming::pipelined(1)),
    preset("divider-10", 40.0, 1, 1, UnitTiming::pipelined(10)),
    preset("hardfloat", 35.0, 1, 1, UnitTiming::iterative(56)),
    preset("amd-hls", 100.0, 4, 5, UnitTiming::pipelined(30)),
    preset("amd-fpo-deep", 300.0, 14, 16, UnitTiming::pipelined(57)),
    preset("altfp-short", 100.0, 7, 5, UnitTiming::pipelined(10)),
    preset("altfp-deep", 250.0, 14, 11, UnitTiming::pipelined(61)),
    Preset {
        name: "opencores-double-fpu",
        clock_mhz: 230.0,
        units: Units {
            adder: UnitTiming::iterative(21),
            multiplier: UnitTiming::iterative(24),
            divider: UnitTiming::iterative(71),
        },
    },
];
