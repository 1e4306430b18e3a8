//! Numbers of digits with a decimal point or none, as most cells of a log are.

/// Most digits that 64 bits hold, whatever they are.
const DIGITS_MAX: usize = 19;
/// Largest whole number that binary64 holds with all below it.
const WHOLE_MAX: u64 = 1 << 53;
/// Powers of ten that binary64 holds exactly.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// A number as it is spelled: its digits as a whole number, and how many of them stand behind the point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::recording) struct Decimal {
    pub(in crate::recording) is_negative: bool,
    pub(in crate::recording) digits: u64,
    pub(in crate::recording) decimals: usize,
}

impl Decimal {
    /// The number at the beginning of some bytes, and how many it takes; nothing where there is none, or
    /// one of more than 19 digits.
    #[inline]
    pub(in crate::recording) fn at_start(bytes: &[u8]) -> Option<(Self, usize)> {
        let is_negative = bytes.first() == Some(&b'-');
        let first = usize::from(is_negative || bytes.first() == Some(&b'+'));
        let (mut digits, mut at, mut point) = (0_u64, first, None);
        while let Some(byte) = bytes.get(at) {
            match byte {
                // What overflows has too many digits, and is refused below.
                b'0'..=b'9' => {
                    digits = digits.wrapping_mul(10).wrapping_add(u64::from(byte - b'0'));
                }
                b'.' if point.is_none() => point = Some(at),
                _ => break,
            }
            at += 1;
        }
        let count = at - first - usize::from(point.is_some());
        if count == 0 || count > DIGITS_MAX {
            return None;
        }
        let number = Self {
            is_negative,
            digits,
            decimals: point.map_or(0, |point| at - point - 1),
        };
        Some((number, at))
    }

    /// The number that all of some bytes are.
    pub(in crate::recording) fn of(bytes: &[u8]) -> Option<Self> {
        let (number, length) = Self::at_start(bytes)?;
        (length == bytes.len()).then_some(number)
    }

    /// The nearest binary64, where digits and power of ten are exact in it, so that one division rounds
    /// once.
    ///
    /// Source: Clinger, How to read floating point numbers accurately, PLDI 1990.
    #[inline]
    pub(in crate::recording) fn value(self) -> Option<f64> {
        let power = POWERS.get(self.decimals)?;
        if self.digits > WHOLE_MAX {
            return None;
        }
        #[expect(clippy::cast_precision_loss, reason = "checked to lie within 2^53")]
        let magnitude = self.digits as f64 / power;
        Some(if self.is_negative {
            -magnitude
        } else {
            magnitude
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_value_is_that_of_the_standard_library_to_the_bit() {
        let mut state = 1_u64;
        let mut next = |below: u64| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % below
        };
        let mut compared = 0;
        for _ in 0..100_000 {
            let bits = next(31);
            let whole = next(1 << bits);
            let decimals = usize::try_from(next(12)).unwrap();
            let sign = ["", "-", "+"][usize::try_from(next(3)).unwrap()];
            let text = format!(
                "{sign}{whole}.{:0decimals$}",
                next(1_000_000_000),
                decimals = decimals
            );
            let wanted: f64 = text.parse().unwrap();
            if let Some(value) = Decimal::of(text.as_bytes()).and_then(Decimal::value) {
                assert_eq!(value.to_bits(), wanted.to_bits(), "{text}");
                compared += 1;
            }
        }
        assert!(compared > 50_000, "{compared}");
        for text in [
            "-0",
            "-0.0",
            "5.",
            ".5",
            "9007199254740992",
            "0.000000000000000001",
        ] {
            let value = Decimal::of(text.as_bytes()).unwrap().value().unwrap();
            assert_eq!(
                value.to_bits(),
                text.parse::<f64>().unwrap().to_bits(),
                "{text}"
            );
        }
    }

    #[test]
    fn what_is_no_plain_number_is_left_to_others() {
        for text in [
            "",
            "-",
            ".",
            "+.",
            "1e5",
            "1.2.3",
            "1,5",
            " 1",
            "nan",
            "12345678901234567890",
        ] {
            assert_eq!(Decimal::of(text.as_bytes()), None, "{text}");
        }
        assert_eq!(Decimal::of(b"9007199254740993").unwrap().value(), None);
        let (number, length) = Decimal::at_start(b"-12.50,7").unwrap();
        assert_eq!((number.digits, number.decimals, length), (1250, 2, 6));
    }
}
