//! Fixed-point words beside those of en_cl_fix, which stores sums, products and resized words independently.
//!
//! `vectors.py` says how the table was made, of which version.

use fogbench::fpga::fixed::Format;

const VECTORS: &str = include_str!("vectors.csv");

/// A line of the table.
struct Vector<'a> {
    operation: &'a str,
    /// Code and fraction bits of either operand.
    a: (i128, u32),
    b: (i128, u32),
    into: Format,
    code: i64,
}

impl<'a> Vector<'a> {
    fn of(line: &'a str) -> Self {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |column: usize| -> i128 { cells[column].parse().expect("a number") };
        let bits = |column: usize| u32::try_from(number(column)).expect("a number of bits");
        Self {
            operation: cells[0],
            a: (number(1), bits(3)),
            b: (number(4), bits(6)),
            into: Format {
                rounding: cells[7].parse().expect("a rounding"),
                overflow: cells[8].parse().expect("an overflow"),
                integer_bits: bits(9),
                fraction_bits: bits(10),
            },
            code: i64::try_from(number(11)).expect("a code"),
        }
    }

    /// The exact result, and its fraction bits.
    fn exact(&self) -> (i128, u32) {
        let ((a, a_bits), (b, b_bits)) = (self.a, self.b);
        match self.operation {
            "resize" => self.a,
            "multiply" => (a * b, a_bits + b_bits),
            "add" => {
                let bits = a_bits.max(b_bits);
                ((a << (bits - a_bits)) + (b << (bits - b_bits)), bits)
            }
            other => panic!("an operation: {other}"),
        }
    }
}

#[test]
fn words_of_every_rounding_and_overflow_are_those_of_en_cl_fix() {
    let (mut overflowed, mut count) = (0, 0);
    for line in VECTORS.lines().skip(1) {
        let vector = Vector::of(line);
        let (exact, fraction_bits) = vector.exact();
        let stored = vector.into.store(exact, fraction_bits);
        assert_eq!(stored.code, vector.code, "{line}");
        overflowed += usize::from(stored.overflowed);
        count += 1;
    }
    assert!(count > 1000, "{count}");
    // Both ends of the words are tried, and what lies between them.
    assert!(
        (count / 10..9 * count / 10).contains(&overflowed),
        "{overflowed}"
    );
}
