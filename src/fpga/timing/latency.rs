//! The paper's control machine with units that take more than one clock.

use crate::fpga::error::FpgaError;
use crate::fpga::rls::{Division, check_tap_count};

/// Timing of one arithmetic unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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

    /// Whether subtraction and product with `1/alpha` fit one clock, as in the RTL.
    fn chain(self) -> bool {
        self.adder.latency_clocks == 1 && self.multiplier.latency_clocks == 1
    }

    /// Clocks by which the product with `1/alpha` lengthens an element's update: none if it is
    /// wired away (alpha = 1) or chained behind the subtraction within one clock.
    pub(super) fn forgetting_clocks(self, forgets: bool) -> u64 {
        if forgets && !self.chain() {
            self.multiplier.latency_clocks
        } else {
            0
        }
    }
}

/// What has to be computed per sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RlsLoad {
    /// Number of weights p, 1 to 64.
    pub tap_count: usize,
    /// Division mode.
    pub division: Division,
    /// Whether alpha differs from 1.
    pub forgets: bool,
}

/// What limits the sample rate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bound {
    /// The port of RAMA is the busiest resource.
    RamaPort,
    /// The port of RAMB is the busiest resource.
    RambPort,
    /// The multiplier is the busiest resource.
    Multiplier,
    /// The adder is the busiest resource.
    Adder,
    /// The divider is the busiest resource.
    Divider,
    /// No resource is busy: the chain of dependent operations decides.
    DependencyChain,
}

impl Bound {
    /// Name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::RamaPort => "RAMA port",
            Self::RambPort => "RAMB port",
            Self::Multiplier => "multiplier",
            Self::Adder => "adder",
            Self::Divider => "divider",
            Self::DependencyChain => "dependency chain",
        }
    }
}

/// Clocks per RLS sample when the control machine waits for every result.
///
/// ```text
/// mac = Lm + p*La
/// RFR = p^2(2Lm+La+s) + max(0, Ld-Lm)      element division: p^2(Lm+Ld+La+s)
/// T   = 1 + p*mac + mac + RFR + p*mac + mac + La + p(Lm+La)
/// ```
/// with `s` the clocks of the product with `1/alpha`: none at alpha = 1, and none if adder and
/// multiplier take one clock each, however slow the divider is, because the RTL then chains
/// subtraction and product. One clock each gives `4+6p+5p^2`.
///
/// # Errors
/// [`FpgaError::TapCount`], [`FpgaError::CountOutOfRange`].
///
/// # Source
/// Derived; agrees with RTL whose divider takes 10, 56 and 58 clocks (117, 163, 165 at p = 4).
pub fn stalled_clocks(load: RlsLoad, units: Units) -> Result<u64, FpgaError> {
    check_tap_count(load.tap_count)?;
    units.check()?;
    let p = load.tap_count as u64;
    let la = units.adder.latency_clocks;
    let lm = units.multiplier.latency_clocks;
    let ld = units.divider.latency_clocks;
    let s = units.forgetting_clocks(load.forgets);
    let mac = lm + p * la;
    let correction = match load.division {
        Division::Reciprocal => p * p * (2 * lm + la + s) + ld.saturating_sub(lm),
        Division::Element => p * p * (lm + ld + la + s),
    };
    Ok(1 + 2 * (p + 1) * mac + correction + la + p * (lm + la))
}

/// Clocks per LMS or NLMS sample when the control machine waits for every result.
///
/// ```text
/// LMS  = 1 + (Lm+N*La) + La + Lm + N(Lm+La)
/// NLMS = 1 + 2(Lm+N*La) + max(La,Ld) + Lm + N(Lm+La)
/// ```
///
/// # Errors
/// [`FpgaError::TapCount`], [`FpgaError::CountOutOfRange`].
pub fn lms_stalled_clocks(
    tap_count: usize,
    normalised: bool,
    units: Units,
) -> Result<u64, FpgaError> {
    check_tap_count(tap_count)?;
    units.check()?;
    let n = tap_count as u64;
    let la = units.adder.latency_clocks;
    let lm = units.multiplier.latency_clocks;
    let mac = lm + n * la;
    let head = if normalised {
        2 * mac + la.max(units.divider.latency_clocks)
    } else {
        mac + la
    };
    Ok(1 + head + lm + n * (lm + la))
}

/// Clocks per sample of the line enhancer when the control machine waits for every result.
///
/// ```text
/// T = Lm + La + max(La,Lm) + La + (max(La,Lm) + M*La) + max(La,Ld) + (Lm or 1) + M(Lm+La)
/// ```
/// GAIN takes Lm clocks in the normalised form, one in the sign form. One clock each: `3M + 7`.
///
/// # Errors
/// [`FpgaError::TapCount`], [`FpgaError::CountOutOfRange`].
pub fn sign_lms_stalled_clocks(
    tap_count: usize,
    normalised: bool,
    units: Units,
) -> Result<u64, FpgaError> {
    check_tap_count(tap_count)?;
    units.check()?;
    let m = tap_count as u64;
    let la = units.adder.latency_clocks;
    let lm = units.multiplier.latency_clocks;
    let ld = units.divider.latency_clocks;
    let norm = lm + la + la.max(lm) + la;
    let output = la.max(lm) + m * la;
    let gain = if normalised { lm } else { 1 };
    Ok(norm + output + la.max(ld) + gain + m * (lm + la))
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
