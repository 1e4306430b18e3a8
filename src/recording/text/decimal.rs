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

/// The digits at the beginning of sixteen bytes that hold their end as well, how many stand behind the point, and the
/// bytes that they take: all at once, as the ends of numbers are hard to foresee.
#[inline]
fn in_sixteen(bytes: &[u8; 16]) -> Option<(u64, usize, usize)> {
    const ZEROS: u128 = u128::from_ne_bytes([b'0'; 16]);
    const HIGH_BITS: u128 = u128::from_ne_bytes([0x80; 16]);
    // 10 + 118 reaches the high bit; a byte that has it is no digit either.
    const TO_HIGH_BIT: u128 = u128::from_ne_bytes([118; 16]);
    let values = u128::from_le_bytes(*bytes) ^ ZEROS;
    let others = (((values & !HIGH_BITS) + TO_HIGH_BIT) | values) & HIGH_BITS;
    let whole = (others.trailing_zeros() / 8) as usize;
    let (digits, length, decimals) = match bytes.get(whole)? {
        b'.' => {
            let behind = others & (others - 1);
            if behind == 0 {
                return None;
            }
            let length = (behind.trailing_zeros() / 8) as usize;
            // The point is taken out: what stands behind it moves up.
            let before = (1 << (8 * whole)) - 1;
            let digits = (values & before) | ((values >> 8) & !before);
            (digits, length, length - 1 - whole)
        }
        _ => (values, whole, 0),
    };
    let count = length - usize::from(length > whole);
    if count == 0 {
        return None;
    }
    // What stands behind the digits falls off; what comes in before them are zeros.
    let [first, last] = halves(digits << (128 - 8 * count));
    Some((
        number_of(first) * 100_000_000 + number_of(last),
        decimals,
        length,
    ))
}

/// The lower and the upper eight bytes.
#[inline]
fn halves(bytes: u128) -> [u64; 2] {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the upper half is the other one"
    )]
    let lower = bytes as u64;
    let upper = (bytes >> 64) as u64;
    [lower, upper]
}

/// Appends the digits at the beginning of some bytes to a number; how many they are.
fn take_digits(bytes: &[u8], number: &mut u64) -> usize {
    let mut taken = 0;
    while let Some(byte @ b'0'..=b'9') = bytes.get(taken) {
        *number = number.wrapping_mul(10).wrapping_add(u64::from(byte - b'0'));
        taken += 1;
    }
    taken
}

/// The number that eight digits are, the lowest byte first: pairs, fours and the whole by one multiplication
/// each.
///
/// Source: Lemire, Quickly parsing eight digits, 2018.
#[inline]
fn number_of(digits: u64) -> u64 {
    const EVERY_FOURTH: u64 = 0x0000_00ff_0000_00ff;
    const MILLIONS_AND_HUNDREDS: u64 = 100 + (1_000_000 << 32);
    const TEN_THOUSANDS_AND_ONES: u64 = 1 + (10_000 << 32);
    let pairs = digits.wrapping_mul(10).wrapping_add(digits >> 8);
    let first = (pairs & EVERY_FOURTH).wrapping_mul(MILLIONS_AND_HUNDREDS);
    let second = ((pairs >> 16) & EVERY_FOURTH).wrapping_mul(TEN_THOUSANDS_AND_ONES);
    first.wrapping_add(second) >> 32
}

impl Decimal {
    /// The number at the beginning of some bytes, and how many it takes; nothing where there is none, or
    /// one of more than 19 digits.
    #[inline]
    pub(in crate::recording) fn at_start(bytes: &[u8]) -> Option<(Self, usize)> {
        let is_negative = bytes.first() == Some(&b'-');
        let first = usize::from(is_negative || bytes.first() == Some(&b'+'));
        if let Some((digits, decimals, length)) = bytes[first..].first_chunk().and_then(in_sixteen)
        {
            let number = Self {
                is_negative,
                digits,
                decimals,
            };
            return Some((number, first + length));
        }
        let mut digits = 0;
        let whole = take_digits(&bytes[first..], &mut digits);
        let (mut length, mut decimals) = (first + whole, 0);
        if bytes.get(length) == Some(&b'.') {
            decimals = take_digits(&bytes[length + 1..], &mut digits);
            length += 1 + decimals;
        }
        // Of more digits than it holds the number has overflowed.
        if !(1..=DIGITS_MAX).contains(&(whole + decimals)) {
            return None;
        }
        let number = Self {
            is_negative,
            digits,
            decimals,
        };
        Some((number, length))
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

    #[test]
    fn digits_are_the_same_wherever_the_bytes_end() {
        let digits = "1234567890123456789";
        for whole in 0..=19 {
            for decimals in usize::from(whole == 0)..=19 - whole {
                let text = format!("{}.{}", &digits[..whole], &digits[whole..whole + decimals]);
                let wanted: u64 = digits[..whole + decimals].parse().unwrap();
                for behind in [
                    "",
                    ",",
                    ",12345678.9",
                    "/",
                    ":00000000",
                    "\u{e9}99999999",
                    "e5",
                ] {
                    let text = format!("{text}{behind}");
                    let (number, length) = Decimal::at_start(text.as_bytes()).unwrap();
                    let found = (number.digits, number.decimals, length);
                    assert_eq!(found, (wanted, decimals, whole + decimals + 1), "{text}");
                }
            }
        }
    }
}
