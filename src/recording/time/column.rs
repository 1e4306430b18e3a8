//! A column of time while it is read: stamps from the first one on, counters that begin again put
//! straight.

use std::io;

use super::stamp::{Stamp, TICKS, as_float, ticks_of};
use super::unit::TimeUnit;
use crate::recording::input::push;

/// Fewest and most bits of a counter that is taken to begin again at 0.
const COUNTER_BITS: std::ops::RangeInclusive<u32> = 8..=64;
/// Seconds after which clocks begin again: a day, a week.
const CLOCKS_S: [i128; 2] = [86_400, 604_800];

/// The stamps of a record.
#[derive(Clone, Debug)]
pub(in crate::recording) struct TimeColumn {
    /// Its name, of several columns with a plus between them.
    pub(in crate::recording) name: String,
    /// Units of the columns.
    pub(in crate::recording) units: Vec<TimeUnit>,
    /// Whether it was found rather than named.
    pub(in crate::recording) is_found: bool,
    /// What is worth saying of its unit.
    pub(in crate::recording) note: Option<String>,
    /// Stamps from the first one on, s; of a counter samples.
    pub(in crate::recording) stamps: Vec<f64>,
    /// How often the counter began again, and after which span, s.
    pub(in crate::recording) roll_overs: Option<(usize, f64)>,
    clock: Clock,
}

/// What puts stamps straight.
#[derive(Clone, Copy, Debug, Default)]
struct Clock {
    /// Span after which it begins again, ticks, if it is known.
    width: Option<i128>,
    /// First stamp, ticks.
    first: i128,
    /// The last one, with what has begun again before it.
    last: i128,
    /// Step before the last one.
    step: i128,
    begun_again: i128,
    resolution: i128,
}

impl TimeColumn {
    pub(in crate::recording) fn new(name: String, units: Vec<TimeUnit>, is_found: bool) -> Self {
        Self {
            name,
            units,
            is_found,
            note: None,
            stamps: Vec::new(),
            roll_overs: None,
            clock: Clock::default(),
        }
    }

    /// The same column behind its last stamp.
    pub(in crate::recording) fn going_on(&mut self) -> Self {
        let stamps = std::mem::take(&mut self.stamps);
        let rest = Self {
            stamps: stamps.last().copied().into_iter().collect(),
            ..self.clone()
        };
        self.stamps = stamps;
        rest
    }

    /// Lets the clock begin again after a span, in the unit of the last column.
    pub(in crate::recording) fn rolls_over_after(&mut self, span: Option<f64>) {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "the declaration of the key bounds it"
        )]
        let ticks = |span: f64| (span * as_float(self.unit_ticks())).round() as i128;
        self.clock.width = span.map(ticks);
    }

    /// Ticks of one in the last column.
    fn unit_ticks(&self) -> i128 {
        self.units.last().map_or(TICKS, |unit| ticks_of(*unit))
    }

    /// One in the last digit of a stamp, s; of a counter samples.
    pub(in crate::recording) fn last_digit(&self) -> f64 {
        as_float(self.clock.resolution) / as_float(TICKS)
    }

    /// Whether it counts samples.
    pub(in crate::recording) fn is_counter(&self) -> bool {
        self.units == [TimeUnit::Samples]
    }

    /// Where the times of stamps that ascend begin.
    pub(in crate::recording) fn origin(&self) -> Origin {
        Origin {
            first: self.clock.first,
            begun_again: self.clock.begun_again,
        }
    }

    /// Goes on over stamps whose times stand in [`Self::stamps`]; whether they follow the last one.
    pub(in crate::recording) fn goes_on_over(&mut self, ascent: Ascent) -> bool {
        let clock = &mut self.clock;
        let on_clock = |ticks: i128| ticks.saturating_add(clock.begun_again);
        if on_clock(ascent.first) < clock.last {
            return false;
        }
        let last = on_clock(ascent.last);
        let before = ascent.before_last.map_or(clock.last, on_clock);
        clock.step = last.saturating_sub(before);
        clock.last = last;
        clock.resolution = clock.resolution.min(ascent.resolution);
        true
    }

    /// Takes the stamp of the next row; an error says that memory is used up.
    pub(in crate::recording) fn take(&mut self, stamp: Stamp) -> io::Result<()> {
        let unit_ticks = || self.units.last().map_or(TICKS, |unit| ticks_of(*unit));
        let clock = &mut self.clock;
        if self.stamps.is_empty() {
            clock.first = stamp.ticks;
            clock.last = stamp.ticks;
            clock.resolution = stamp.resolution;
            return push(&mut self.stamps, 0.0);
        }
        clock.resolution = clock.resolution.min(stamp.resolution);
        let mut ticks = stamp.ticks.saturating_add(clock.begun_again);
        if ticks < clock.last
            && let Some(width) = clock.begins_again(ticks, unit_ticks())
        {
            clock.begun_again += width;
            ticks += width;
            let (count, _) = self.roll_overs.unwrap_or_default();
            self.roll_overs = Some((count + 1, as_float(width) / as_float(TICKS)));
        }
        clock.step = ticks.saturating_sub(clock.last);
        clock.last = ticks;
        let time = self.origin().to(stamp);
        push(&mut self.stamps, time)
    }
}

/// Stamps of some rows that ascend.
#[derive(Clone, Copy, Debug)]
pub(in crate::recording) struct Ascent {
    first: i128,
    /// None of a single stamp.
    before_last: Option<i128>,
    last: i128,
    resolution: i128,
}

impl Ascent {
    /// Takes another stamp, if it is none before the last one.
    #[inline]
    pub(in crate::recording) fn with(so_far: Option<Self>, stamp: Stamp) -> Option<Self> {
        let Stamp { ticks, resolution } = stamp;
        let Some(so_far) = so_far else {
            return Some(Self {
                first: ticks,
                before_last: None,
                last: ticks,
                resolution,
            });
        };
        (ticks >= so_far.last).then(|| Self {
            first: so_far.first,
            before_last: Some(so_far.last),
            last: ticks,
            resolution: resolution.min(so_far.resolution),
        })
    }
}

/// The first stamp, as far as the clock has not begun again since.
#[derive(Clone, Copy, Debug)]
pub(in crate::recording) struct Origin {
    first: i128,
    begun_again: i128,
}

impl Origin {
    /// Time of a stamp, s; of a counter samples.
    #[inline]
    pub(in crate::recording) fn to(self, stamp: Stamp) -> f64 {
        let ticks = stamp.ticks.saturating_add(self.begun_again);
        as_float(ticks.saturating_sub(self.first)) / as_float(TICKS)
    }
}

impl Clock {
    /// The span after which a clock that falls back begins again: that which was given, else a power of two
    /// of its unit, a day or a week, with which the step is about that before.
    fn begins_again(&self, ticks: i128, unit_ticks: i128) -> Option<i128> {
        let of_counters = COUNTER_BITS.map(|bits| unit_ticks.checked_mul(1 << bits));
        let of_clocks = CLOCKS_S.iter().map(|seconds| Some(seconds * TICKS));
        let known = self.width.map(Some).into_iter();
        let found = of_counters
            .chain(of_clocks)
            .filter(|_| self.width.is_none());
        let mut spans = known.chain(found).flatten();
        spans.find(|span| {
            let step = ticks + span - self.last;
            step > 0
                && (self.width.is_some() || (2 * step <= 3 * self.step && 2 * step >= self.step))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::layout::words::DecimalSign;

    fn read(cells: &[&str], unit: TimeUnit, width: Option<f64>) -> TimeColumn {
        let mut time = TimeColumn::new("t".to_owned(), vec![unit], false);
        time.rolls_over_after(width);
        for cell in cells {
            let stamp = Stamp::read(cell, time.units[0], DecimalSign::Point).unwrap();
            time.take(stamp).unwrap();
        }
        time
    }

    #[test]
    fn a_counter_that_begins_again_goes_on() {
        let time = read(&["65534", "65535", "0", "1"], TimeUnit::Samples, None);
        assert_eq!(time.stamps, [0.0, 1.0, 2.0, 3.0]);
        assert_eq!(time.roll_overs, Some((1, 65536.0)));
        let time = read(
            &["4294967290", "4294967295", "4"],
            TimeUnit::Milliseconds,
            None,
        );
        assert_eq!(time.stamps, [0.0, 0.005, 0.010]);
        let time = read(&["86399.99", "86400.00", "0.01"], TimeUnit::Seconds, None);
        assert_eq!(time.roll_overs, Some((1, 86_400.0)));
        let time = read(&["997", "999", "1"], TimeUnit::Milliseconds, Some(1000.0));
        assert_eq!(time.stamps, [0.0, 0.002, 0.004]);
        // A stamp that goes back stays one.
        let time = read(&["0", "1", "0.5"], TimeUnit::Seconds, None);
        assert_eq!(time.stamps, [0.0, 1.0, 0.5]);
    }

    #[test]
    fn the_resolution_is_the_last_digit() {
        let time = read(&["0.000", "0.002", "0.005"], TimeUnit::Seconds, None);
        assert!((time.last_digit() / 1e-3 - 1.0).abs() < 1e-12);
        let time = read(&["0", "4000", "8000"], TimeUnit::Microseconds, None);
        assert!((time.last_digit() / 1e-6 - 1.0).abs() < 1e-12);
    }
}
