//! Stamps of a column of time, without loss: numbers of any length, dates, times of day.
//!
//! A stamp is held as a whole number of [`TICKS`] to the second (or to the sample, of a counter), so that
//! 19 digits of nanoseconds and twelve decimals of a second are kept alike. Libraries of dates end at
//! nanoseconds and know no decimals of a count, which is why dates are read here as well.

use super::unit::TimeUnit;
use crate::recording::layout::{finite_in, is_number, plain_spelling, words::DecimalSign};
use crate::recording::text::decimal::Decimal;
use crate::recording::text::lines::{NumberError, shown};

/// Ticks of a second, or of a sample.
pub(in crate::recording) const TICKS: i128 = 1_000_000_000_000;
/// Ticks of a nanosecond.
const TICKS_PER_NS: i128 = 1_000;
/// Digits of [`TICKS`] behind the one.
const DECIMALS: usize = 12;
/// Ticks in a day.
const DAY: i128 = 86_400 * TICKS;

/// A stamp, and what its spelling resolves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::recording) struct Stamp {
    pub(in crate::recording) ticks: i128,
    /// One in its last digit, ticks.
    pub(in crate::recording) resolution: i128,
}

/// Why a cell is no stamp.
#[derive(Debug, thiserror::Error)]
pub(in crate::recording) enum StampError {
    #[error("{0}")]
    Number(#[from] crate::recording::text::lines::NumberError),
    #[error("`{0}` is no date or time of day: expected one as 2024-03-01T12:00:00.005Z")]
    Date(String),
    #[error(
        "`{0}` is neither a number nor a date or time of day: expected one as 2024-03-01T12:00:00.005Z"
    )]
    Neither(String),
    #[error("{0} is beyond the times that a clock shows")]
    Beyond(String),
}

impl Stamp {
    /// What the parts of a stamp are added to.
    pub(in crate::recording) const NOTHING: Self = Self {
        ticks: 0,
        resolution: i128::MAX,
    };

    /// The stamp that a cell is.
    ///
    /// # Errors
    /// No number, or no date where dates are expected.
    pub(in crate::recording) fn read(
        cell: &str,
        unit: TimeUnit,
        decimal: DecimalSign,
    ) -> Result<Self, StampError> {
        if unit == TimeUnit::Iso {
            return date(cell).ok_or_else(|| StampError::Date(shown(cell)));
        }
        let spelled = plain_spelling(cell, decimal);
        let digits = Decimal::of(spelled.as_bytes());
        if let Some(stamp) = digits.and_then(|digits| Self::of_decimal(digits, unit)) {
            return Ok(stamp);
        }
        if is_date(cell) && !is_number(cell, decimal) {
            return Err(StampError::Date(format!(
                "{}` is a date, not a number of {unit}; `--time-unit iso",
                shown(cell)
            )));
        }
        let number = finite_in(cell, decimal).map_err(|error| match error {
            NumberError::Word(cell) if is_like_date(&cell) => StampError::Neither(cell),
            error => error.into(),
        })?;
        Self::of_number(number, unit).ok_or_else(|| StampError::Beyond(shown(cell)))
    }

    /// The stamp that a number is; nothing beyond the times that a clock shows.
    pub(in crate::recording) fn of_number(number: f64, unit: TimeUnit) -> Option<Self> {
        let ticks = number * as_float(ticks_of(unit));
        if ticks.is_nan() || ticks.abs() > 1e36 {
            return None;
        }
        #[expect(clippy::cast_possible_truncation, reason = "bounded just above")]
        let ticks = ticks.round() as i128;
        Some(Self {
            ticks,
            resolution: 1,
        })
    }

    /// The stamp that a whole number is.
    pub(in crate::recording) fn of_whole(number: i128, unit: TimeUnit) -> Option<Self> {
        let resolution = ticks_of(unit);
        let ticks = number.checked_mul(resolution)?;
        Some(Self { ticks, resolution })
    }

    /// The sum of two parts of a stamp.
    pub(in crate::recording) fn plus(self, other: Self) -> Self {
        Self {
            ticks: self.ticks.saturating_add(other.ticks),
            resolution: self.resolution.min(other.resolution),
        }
    }
}

/// Ticks of a unit.
pub(in crate::recording) fn ticks_of(unit: TimeUnit) -> i128 {
    unit.nanoseconds().map_or(TICKS, |ns| ns * TICKS_PER_NS)
}

/// A count of ticks as binary64, rounded once.
#[inline]
#[expect(
    clippy::cast_precision_loss,
    reason = "differences of stamps are small, and rounded once here"
)]
pub(in crate::recording) fn as_float(ticks: i128) -> f64 {
    // What fits into 64 bits, as most differences do, is converted by one instruction.
    match i64::try_from(ticks) {
        Ok(ticks) => ticks as f64,
        Err(_) => of_many_ticks(ticks),
    }
}

/// A count of ticks beyond 64 bits as binary64: a call of its own, so that a processor does not convert every
/// count both ways and choose.
#[cold]
#[inline(never)]
#[expect(
    clippy::cast_precision_loss,
    reason = "differences of stamps are small, and rounded once here"
)]
fn of_many_ticks(ticks: i128) -> f64 {
    ticks as f64
}

impl Stamp {
    /// The stamp that a number of digits is; nothing of too many decimals.
    #[inline]
    pub(in crate::recording) fn of_decimal(number: Decimal, unit: TimeUnit) -> Option<Self> {
        let (magnitude, resolution) = match last_place(unit, number.decimals) {
            Some(ticks) => (i128::from(number.digits) * i128::from(ticks), ticks),
            None => {
                let power = 10_u64.checked_pow(u32::try_from(number.decimals).ok()?)?;
                let unit_ticks = ticks_of(unit);
                let digits = i128::from(number.digits);
                let magnitude = rounded(digits * unit_ticks, i128::from(power));
                let resolution = u64::try_from(unit_ticks).ok()? / power;
                (magnitude, resolution.max(1))
            }
        };
        Some(Self {
            ticks: if number.is_negative {
                -magnitude
            } else {
                magnitude
            },
            resolution: i128::from(resolution),
        })
    }
}

/// Ticks of one in the last of so many decimals, where these are a whole number and the unit is a power of ten.
#[inline]
fn last_place(unit: TimeUnit, decimals: usize) -> Option<u64> {
    const POWERS: [u64; DECIMALS + 1] = [
        1,
        10,
        100,
        1_000,
        10_000,
        100_000,
        1_000_000,
        10_000_000,
        100_000_000,
        1_000_000_000,
        10_000_000_000,
        100_000_000_000,
        1_000_000_000_000,
    ];
    let places = match unit {
        TimeUnit::Seconds | TimeUnit::Iso | TimeUnit::Samples => DECIMALS,
        TimeUnit::Milliseconds => DECIMALS - 3,
        TimeUnit::Microseconds => DECIMALS - 6,
        TimeUnit::Nanoseconds => DECIMALS - 9,
        TimeUnit::Minutes | TimeUnit::Hours | TimeUnit::Days | TimeUnit::Weeks => return None,
    };
    POWERS.get(places.checked_sub(decimals)?).copied()
}

/// A quotient, rounded to the nearest.
fn rounded(number: i128, over: i128) -> i128 {
    let (whole, rest) = (number.div_euclid(over), number.rem_euclid(over));
    whole + i128::from(rest >= over - rest && rest > 0)
}

/// Whether a cell that is no number has the signs that dates and times of day have, in each of its words.
pub(in crate::recording) fn is_like_date(cell: &str) -> bool {
    let is_part = |word: &str| {
        word.contains(':')
            || word.matches(['/', '-', '.']).count() > 1
            || word.chars().all(char::is_alphabetic)
    };
    cell.starts_with(|it: char| it.is_ascii_digit()) && cell.split_whitespace().all(is_part)
}

/// Whether a cell is a date, a time of day or both.
pub(in crate::recording) fn is_date(cell: &str) -> bool {
    date(cell).is_some()
}

/// A date, a time of day, or a date and the time behind `T` or a blank, with its zone or without.
fn date(cell: &str) -> Option<Stamp> {
    let bytes = cell.as_bytes();
    if !bytes.first()?.is_ascii_digit() {
        return None;
    }
    if bytes.iter().take(3).any(|byte| *byte == b':') {
        return time_of_day(bytes);
    }
    let (days, behind) = day(bytes)?;
    let midnight = i128::from(days) * DAY;
    match behind {
        [] => Some(Stamp {
            ticks: midnight,
            resolution: DAY,
        }),
        [b'T' | b't' | b' ' | b'_', time @ ..] => {
            let time = time_of_day(time.trim_ascii_start())?;
            Some(Stamp {
                ticks: midnight + time.ticks,
                ..time
            })
        }
        _ => None,
    }
}

/// Days since 1970 of a year, month and day of digits, and what stands behind: `2024-03-01`, `2024/03/01`, or with
/// points between them the day first, `01.03.2024`.
fn day(bytes: &[u8]) -> Option<(i64, &[u8])> {
    let (year, month, day, behind) = match bytes {
        [
            y0,
            y1,
            y2,
            y3,
            cut @ (b'-' | b'/'),
            m0,
            m1,
            same,
            d0,
            d1,
            behind @ ..,
        ] if cut == same => ([*y0, *y1, *y2, *y3], [*m0, *m1], [*d0, *d1], behind),
        [d0, d1, b'.', m0, m1, b'.', y0, y1, y2, y3, behind @ ..] => {
            ([*y0, *y1, *y2, *y3], [*m0, *m1], [*d0, *d1], behind)
        }
        [d0, d1, b'-', a, b, c, b'-', y0, y1, y2, y3, behind @ ..] => {
            let month = month_of([*a, *b, *c])?;
            ([*y0, *y1, *y2, *y3], month, [*d0, *d1], behind)
        }
        _ => return None,
    };
    let (year, month, day) = (number(&year)?, number(&month)?, number(&day)?);
    if !(1..=12).contains(&month) || !(1..=days_of_month(year, month)).contains(&day) {
        return None;
    }
    // Years begin in March, so that the day that leaps is the last.
    let (year, month) = if month > 2 {
        (year, month - 3)
    } else {
        (year - 1, month + 9)
    };
    let of_year = (153 * month + 2) / 5 + day - 1;
    let leaps = year.div_euclid(4) - year.div_euclid(100) + year.div_euclid(400);
    Some((365 * year + leaps + of_year - 719_468, behind))
}

/// Digits of a month by the first letters of its English name.
fn month_of(letters: [u8; 3]) -> Option<[u8; 2]> {
    const MONTHS: &[u8; 36] = b"janfebmaraprmayjunjulaugsepoctnovdec";
    let wanted = letters.map(|letter| letter.to_ascii_lowercase());
    let at = MONTHS.chunks_exact(3).position(|month| month == wanted)?;
    let number = u8::try_from(at + 1).ok()?;
    Some([b'0' + number / 10, b'0' + number % 10])
}

fn days_of_month(year: i64, month: i64) -> i64 {
    let is_leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    match month {
        2 => 28 + i64::from(is_leap),
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}

fn number(digits: &[u8]) -> Option<i64> {
    digits.iter().try_fold(0, |number, digit| {
        let digit = digit.is_ascii_digit().then(|| i64::from(digit - b'0'))?;
        Some(number * 10 + digit)
    })
}

/// Hours, minutes, seconds with decimals, and the zone.
fn time_of_day(bytes: &[u8]) -> Option<Stamp> {
    let (([tens, ones, b':', m0, m1, behind @ ..], _) | ([ones, b':', m0, m1, behind @ ..], tens)) =
        (bytes, &b'0')
    else {
        return None;
    };
    let (hours, minutes) = (number(&[*tens, *ones])?, number(&[*m0, *m1])?);
    if hours > 24 || minutes > 59 {
        return None;
    }
    let whole = i128::from(hours * 3600 + minutes * 60) * TICKS;
    let (seconds, resolution, behind) = match behind {
        [b':', s0, s1, behind @ ..] => {
            // 60 is the second that is put in.
            let seconds = number(&[*s0, *s1]).filter(|seconds| *seconds <= 60)?;
            let (decimals, count, behind) = match behind {
                [b'.' | b',', digits @ ..] => decimals(digits)?,
                // As LabVIEW writes milliseconds.
                [b':', digits @ ..] if digits.len() >= 3 => decimals(digits)?,
                behind => (0, 0, behind),
            };
            let seconds = i128::from(seconds) * TICKS + decimals;
            let resolution = TICKS / 10_i128.pow(count);
            (seconds, resolution, behind)
        }
        behind => (0, 60 * TICKS, behind),
    };
    let (noon, behind) = half_of_day(hours, behind)?;
    Some(Stamp {
        ticks: whole + noon + seconds - zone(behind)?,
        resolution,
    })
}

/// Decimals of a second in ticks, how many, and what stands behind; those beyond a tick are dropped.
fn decimals(bytes: &[u8]) -> Option<(i128, u32, &[u8])> {
    let count = bytes
        .iter()
        .take_while(|byte| byte.is_ascii_digit())
        .count();
    let (digits, behind) = bytes.split_at(count);
    let mut ticks = 0;
    for place in 0..DECIMALS {
        ticks = ticks * 10
            + digits
                .get(place)
                .map_or(0, |digit| i128::from(digit - b'0'));
    }
    let count = u32::try_from(count.min(DECIMALS)).ok()?;
    (count > 0).then_some((ticks, count, behind))
}

/// Ticks to add to hours from 1 to 12 for the half of the day that is named behind them, and what stands behind.
fn half_of_day(hours: i64, behind: &[u8]) -> Option<(i128, &[u8])> {
    let half = match behind.trim_ascii_start() {
        [half @ (b'a' | b'A' | b'p' | b'P'), b'm' | b'M', ..] => half.to_ascii_lowercase(),
        _ => return Some((0, behind)),
    };
    let noon = match (half, hours) {
        (b'a', 12) => -DAY / 2,
        (b'a', 1..=11) | (b'p', 12) => 0,
        (b'p', 1..=11) => DAY / 2,
        _ => return None,
    };
    Some((noon, &behind.trim_ascii_start()[2..]))
}

/// Ticks by which a zone, behind blanks or none, is ahead.
fn zone(bytes: &[u8]) -> Option<i128> {
    let trimmed = bytes.trim_ascii_start();
    let (sign, digits) = match trimmed {
        [] | [b'Z' | b'z'] | b"UTC" | b"GMT" => return Some(0),
        [b'+', digits @ ..] => (1, digits),
        [b'-', digits @ ..] => (-1, digits),
        _ => return None,
    };
    let (hours, minutes) = match digits {
        // Behind a blank so few digits are another number.
        [h0, h1] if trimmed.len() == bytes.len() => (number(&[*h0, *h1])?, 0),
        [h0, h1, b':', m0, m1] | [h0, h1, m0, m1] => (number(&[*h0, *h1])?, number(&[*m0, *m1])?),
        _ => return None,
    };
    Some(sign * i128::from(hours * 3600 + minutes * 60) * TICKS)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ticks(cell: &str, unit: TimeUnit) -> i128 {
        Stamp::read(cell, unit, DecimalSign::Point).unwrap().ticks
    }

    #[test]
    fn nineteen_digits_of_nanoseconds_are_kept() {
        let [a, b] = ["1403636579758555392", "1403636579763555393"]
            .map(|cell| ticks(cell, TimeUnit::Nanoseconds));
        assert_eq!(b - a, 5_000_001 * TICKS_PER_NS);
        assert_eq!(ticks("-0.005", TimeUnit::Seconds), -TICKS / 200);
        assert_eq!(ticks("1.5", TimeUnit::Milliseconds), TICKS / 1000 * 3 / 2);
        assert_eq!(ticks("5e-3", TimeUnit::Seconds), TICKS / 200);
        assert_eq!(ticks("7", TimeUnit::Samples), 7 * TICKS);
        assert_eq!(ticks("2304", TimeUnit::Weeks), 2304 * 7 * DAY);
        let coarse = Stamp::read("0.5", TimeUnit::Seconds, DecimalSign::Point).unwrap();
        assert_eq!(coarse.resolution, TICKS / 10);
        let comma = Stamp::read("0,25", TimeUnit::Seconds, DecimalSign::Comma).unwrap();
        assert_eq!(comma.ticks, TICKS / 4);
    }

    #[test]
    fn dates_count_from_1970_whatever_their_zone() {
        let at = |cell| ticks(cell, TimeUnit::Iso);
        assert_eq!(at("1970-01-01T00:00:00Z"), 0);
        // By date(1): 1709294400 s.
        assert_eq!(at("2024-03-01T12:00:00Z"), 1_709_294_400 * TICKS);
        assert_eq!(
            at("2024-03-01 14:30:00.005+02:30"),
            at("2024-03-01T12:00:00.005Z")
        );
        assert_eq!(at("2024/03/01 12:00:00,005"), at("2024-03-01T12:00:00.005"));
        for cell in [
            "2024-03-01  13:00:00.005 +01:00",
            "2024-03-01 08:30:00.005 -0330",
            "2024-03-01T12:00:00.005 Z",
            "2024-03-01 12:00:00.005  UTC",
            "2024-03-01 12:00:00.005GMT",
        ] {
            assert_eq!(at(cell), at("2024-03-01T12:00:00.005"), "{cell}");
        }
        assert_eq!(at("2024-02-29"), at("2024-03-01") - DAY);
        assert_eq!(at("29.02.2024"), at("2024-02-29"));
        assert_eq!(at("01.03.2024 12:00:00,5"), at("2024-03-01T12:00:00.5"));
        assert_eq!(
            at("2024-03-01") + at("12:00:00.25"),
            at("2024-03-01T12:00:00.25")
        );
        assert_eq!(at("9:05:00.25"), at("09:05:00.25"));
        for cell in [
            "2024-03-01 12:00:00.25 PM",
            "01-Mar-2024 12:00:00.25",
            "01-MAR-2024 12:00:00:250",
            "2024-03-01 12:00:00.25pm Z",
        ] {
            assert_eq!(at(cell), at("2024-03-01T12:00:00.25"), "{cell}");
        }
        assert_eq!(at("12:30:00 AM"), at("00:30:00"));
        assert_eq!(at("1:30:00 PM"), at("13:30:00"));
        assert_eq!(at("1900-03-01") - at("1900-02-28"), DAY);
        assert_eq!(at("2016-12-31T23:59:60Z"), at("2017-01-01T00:00:00Z"));
        for cell in [
            "2024-13-01",
            "2024-02-30",
            "2024-03-01T",
            "2024-03-01Tx",
            "12",
            "12:00:00.",
            "1.5",
            "2024-03/01",
            "29.02.2023",
            "2024-03-01 12:00:00 -15",
            "9:5:00",
            "123:00:00",
            "13:00:00 PM",
            "00:30:00 am",
            "01-Mrz-2024",
            "12:00:00:25",
            ":12:00",
            "03.2024",
            "2024-03-01T25:00",
            "",
            "nan",
        ] {
            assert!(!is_date(cell), "{cell}");
        }
    }
}
