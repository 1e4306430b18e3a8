//! The signals of a waveform and their values in a clock.

use crate::fpga::float_unit::Fp;
use crate::fpga::trace::{ClockRecord, MemoryUse, UnitUse};

/// Kind of a signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Bits(u32),
    Real,
    Text,
}

/// Value of a signal in a clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Value {
    Bits(u64),
    /// Bits of a binary64, so that equal NaNs compare equal.
    Real(u64),
    Text(&'static str),
}

/// A signal: the path of its scopes below `rls` or `lms`, its name and kind.
pub(super) struct Signal {
    pub(super) scope: &'static str,
    pub(super) name: &'static str,
    pub(super) kind: Kind,
}

/// Collects signals and their values in one pass, so that the two lists cannot differ.
pub(super) struct Sheet {
    pub(super) signals: Vec<Signal>,
    pub(super) values: Vec<Value>,
}

impl Sheet {
    fn put(&mut self, scope: &'static str, name: &'static str, kind: Kind, value: Value) {
        self.signals.push(Signal { scope, name, kind });
        self.values.push(value);
    }

    fn bit(&mut self, scope: &'static str, name: &'static str, value: bool) {
        self.put(scope, name, Kind::Bits(1), Value::Bits(u64::from(value)));
    }

    fn count(&mut self, scope: &'static str, name: &'static str, bits: u32, value: usize) {
        self.put(scope, name, Kind::Bits(bits), Value::Bits(value as u64));
    }

    /// A word as a vector and as a readable twin.
    fn word<F: Fp>(&mut self, scope: &'static str, [name, twin]: [&'static str; 2], word: F) {
        self.put(
            scope,
            name,
            Kind::Bits(F::WIDTH),
            Value::Bits(word.to_bits()),
        );
        self.put(
            scope,
            twin,
            Kind::Real,
            Value::Real(word.to_f64().to_bits()),
        );
    }

    fn memory<F: Fp>(&mut self, scope: &'static str, memory: &MemoryUse<F>) {
        self.count(scope, "addr", 13, memory.address);
        self.bit(scope, "we", memory.write.is_some());
        self.word(
            scope,
            ["wdata", "wdata_real"],
            memory.write.unwrap_or(F::ZERO),
        );
        self.word(
            scope,
            ["rdata", "rdata_real"],
            memory.read.unwrap_or(F::ZERO),
        );
    }

    fn unit<F: Fp>(&mut self, scope: &'static str, unit: Option<UnitUse<F>>) {
        let zero = UnitUse {
            a: F::ZERO,
            b: F::ZERO,
            q: F::ZERO,
            subtracts: false,
        };
        let shown = unit.unwrap_or(zero);
        self.word(scope, ["a", "a_real"], shown.a);
        self.word(scope, ["b", "b_real"], shown.b);
        self.word(scope, ["q", "q_real"], shown.q);
        if scope == "add" {
            self.bit(scope, "sub", shown.subtracts);
        }
        if scope == "div" {
            // One clock: done with the request.
            self.bit(scope, "req", unit.is_some());
            self.bit(scope, "done", unit.is_some());
        }
    }

    /// All signals of a clock but the clock itself.
    pub(super) fn of<F: Fp>(record: &ClockRecord<F>) -> Self {
        let mut sheet = Self {
            signals: Vec::new(),
            values: Vec::new(),
        };
        let (r, ports) = (&record.registers, &record.ports);
        sheet.bit("", "rst", false);
        sheet.bit("", "in_valid", ports.input_valid);
        sheet.bit("", "in_ready", ports.input_ready);
        sheet.word("", ["x", "x_real"], ports.input);
        sheet.word("", ["d", "d_real"], ports.desired);
        sheet.bit("", "out_valid", ports.output_valid);
        sheet.word("", ["y", "y_real"], r.output);
        sheet.word("", ["p", "p_real"], r.product);
        sheet.word("", ["acc", "acc_real"], r.accumulator);
        sheet.word("", ["rr", "rr_real"], r.read_latch);
        sheet.word("", ["den", "den_real"], r.denominator);
        sheet.word("", ["rcp", "rcp_real"], r.reciprocal);
        sheet.word("", ["dd", "dd_real"], r.desired);
        sheet.word("", ["ee", "ee_real"], r.error);
        sheet.word("", ["yy", "yy_real"], r.output);
        sheet.count("ctrl", "state", 4, usize::from(r.state));
        sheet.put("ctrl", "state_name", Kind::Text, Value::Text(r.state_name));
        sheet.count("ctrl", "i", 6, r.i);
        sheet.count("ctrl", "j", 6, r.j);
        sheet.count("ctrl", "ph", 2, usize::from(r.phase));
        sheet.count("ctrl", "head", 6, r.head);
        sheet.memory("rama", &record.rama);
        sheet.memory("ramb", &record.ramb);
        sheet.unit("mul", record.multiplier);
        sheet.unit("add", record.adder);
        sheet.unit("div", record.divider);
        sheet
    }
}
