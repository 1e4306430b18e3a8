//! Per-clock records of a pipeline and their text form.
//!
//! All values are those visible during the clock, before its edge. An unused memory port shows
//! address 0, write enable 0 and data 0, so that two traces can be compared as text.

use std::io::{self, Write};

use super::float_unit::Fp;
use super::probe::{PortView, Probe, RegisterView};

/// A memory port in one clock.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MemoryUse<F> {
    /// Address, 0 if unused.
    pub address: usize,
    /// Word written, if any.
    pub write: Option<F>,
    /// Word at the address before the edge; `None` if the port is unused.
    pub read: Option<F>,
}

/// An arithmetic unit in one clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitUse<F> {
    /// First operand.
    pub a: F,
    /// Second operand.
    pub b: F,
    /// Result.
    pub q: F,
    /// Whether the adder subtracts.
    pub subtracts: bool,
}

/// Everything about one clock.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ClockRecord<F> {
    /// Clocks since reset.
    pub clock: u64,
    /// Registers.
    pub registers: RegisterView<F>,
    /// The pipeline's own ports.
    pub ports: PortView<F>,
    /// RAMA.
    pub rama: MemoryUse<F>,
    /// RAMB.
    pub ramb: MemoryUse<F>,
    /// Multiplier, if used.
    pub multiplier: Option<UnitUse<F>>,
    /// Adder, if used.
    pub adder: Option<UnitUse<F>>,
    /// Divider, if used.
    pub divider: Option<UnitUse<F>>,
}

/// Which clocks are recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// First clock after reset.
    pub first_clock: u64,
    /// Number of clocks.
    pub clock_count: u64,
}

impl Window {
    /// Every clock.
    pub const ALL: Self = Self {
        first_clock: 0,
        clock_count: u64::MAX,
    };

    /// Whether a clock lies in the window.
    #[must_use]
    pub fn contains(self, clock: u64) -> bool {
        clock >= self.first_clock && clock - self.first_clock < self.clock_count
    }
}

/// A probe that hands each clock of a window to a sink, one clock late. Clocks in which a unit is
/// waited for count, and are not handed out.
///
/// Call [`Recorder::finish`] after the last tick, or the last clock is lost.
#[derive(Debug)]
pub struct Recorder<F, S> {
    window: Window,
    clock: u64,
    pending: Option<ClockRecord<F>>,
    sink: S,
}

impl<F: Fp, S: FnMut(&ClockRecord<F>)> Recorder<F, S> {
    /// A recorder of the given window; clock 0 is the first one ticked.
    pub fn new(window: Window, sink: S) -> Self {
        Self {
            window,
            clock: 0,
            pending: None,
            sink,
        }
    }

    /// Hands out the last clock.
    pub fn finish(mut self) {
        self.hand_out();
    }

    fn hand_out(&mut self) {
        if let Some(record) = self.pending.take() {
            (self.sink)(&record);
        }
    }
}

impl<F: Fp, S: FnMut(&ClockRecord<F>)> Probe<F> for Recorder<F, S> {
    fn clock(&mut self, registers: &RegisterView<F>, ports: &PortView<F>) {
        self.hand_out();
        let unused = MemoryUse {
            address: 0,
            write: None,
            read: None,
        };
        self.pending = self.window.contains(self.clock).then_some(ClockRecord {
            clock: self.clock,
            registers: *registers,
            ports: *ports,
            rama: unused,
            ramb: unused,
            multiplier: None,
            adder: None,
            divider: None,
        });
        self.clock += 1;
    }

    fn wait(&mut self, _state: u8, _output_valid: bool) {
        self.clock += 1;
    }

    fn rama(&mut self, address: usize, write: Option<F>, read: F) {
        if let Some(record) = &mut self.pending {
            record.rama = MemoryUse {
                address,
                write,
                read: Some(read),
            };
        }
    }

    fn ramb(&mut self, address: usize, write: Option<F>, read: F) {
        if let Some(record) = &mut self.pending {
            record.ramb = MemoryUse {
                address,
                write,
                read: Some(read),
            };
        }
    }

    fn multiply(&mut self, a: F, b: F, q: F) {
        if let Some(record) = &mut self.pending {
            assert!(record.multiplier.is_none(), "second product in one clock");
            record.multiplier = Some(UnitUse {
                a,
                b,
                q,
                subtracts: false,
            });
        }
    }

    fn add(&mut self, a: F, b: F, subtracts: bool, q: F) {
        if let Some(record) = &mut self.pending {
            assert!(record.adder.is_none(), "second sum in one clock");
            record.adder = Some(UnitUse { a, b, q, subtracts });
        }
    }

    fn divide(&mut self, a: F, b: F, q: F) {
        if let Some(record) = &mut self.pending {
            assert!(record.divider.is_none(), "second quotient in one clock");
            record.divider = Some(UnitUse {
                a,
                b,
                q,
                subtracts: false,
            });
        }
    }
}

/// Columns of the trace, in order. Words in hexadecimal, everything else decimal.
pub const CSV_HEADER: &str = "cyc,state,ra_addr,ra_we,ra_wdata,rb_addr,rb_we,rb_wdata,\
                              P,ACC,RR,DEN,Y,E,RCP,D,HEAD,i,j";

/// A word as fixed-width lower-case hexadecimal, the form `$readmemh` reads.
#[must_use]
pub fn hex<F: Fp>(word: F) -> String {
    if F::WIDTH == 64 {
        format!("{:016x}", word.to_bits())
    } else {
        format!("{:08x}", word.to_bits())
    }
}

/// Writes one record as a line of the trace.
///
/// # Errors
/// Whatever the writer reports.
pub fn write_csv_line<F: Fp>(out: &mut impl Write, record: &ClockRecord<F>) -> io::Result<()> {
    let r = &record.registers;
    let port = |memory: &MemoryUse<F>| {
        let word = memory.write.unwrap_or(F::ZERO);
        format!(
            "{},{},{}",
            memory.address,
            u8::from(memory.write.is_some()),
            hex(word)
        )
    };
    let words = [
        r.product,
        r.accumulator,
        r.read_latch,
        r.denominator,
        r.output,
        r.error,
        r.reciprocal,
        r.desired,
    ]
    .map(hex)
    .join(",");
    writeln!(
        out,
        "{},{},{},{},{},{},{},{}",
        record.clock,
        r.state,
        port(&record.rama),
        port(&record.ramb),
        words,
        r.head,
        r.i,
        r.j
    )
}
