//! Scale factor test: rest, the rates of one sense from small to large, those of the other, rest.

use std::sync::Arc;

use crate::declare::table;
use crate::turntable::motion::checks::MotionChecks;
use crate::turntable::motion::course::Course;
use crate::turntable::motion::kind::{CommandExtremes, Motion, MotionClass, Surroundings};
use crate::turntable::motion::staircase::{Held, extremes};
use crate::turntable::motion::stairs::Stairs;
use crate::units::deg_per_s_to_rad_per_s;
use crate::vocabulary::words;

/// Degrees of a turn.
const TURN_DEG: f64 = 360.0;

/// Relative slack in comparisons of rates and times, far below any step of a series.
const SLACK: f64 = 1e-9;

/// Fewest rates of each sense in a scale factor test, the largest included.
///
/// Source: IEEE Std 952 and GJB 2426A, scale factor test.
pub const TEST_RATES_MIN: usize = 11;

table! {
    /// Scale factor test: rest, the rates of one sense from small to large, those of the other, rest.
    pub struct ScaleFactorTestConfig {
        /// Preferred numbers that the rates are taken from: five or ten a decade. Source of the default:
        /// GB 321 as the Chinese method takes it.
        preferred_series: PreferredSeries = "R5";
        /// Smallest rate; the rates of each sense are the members of the series from here on, at least 11.
        from_deg_per_s: f64, example 1.0, in 1e-4..=2000.0, "deg/s";
        /// Largest rate, a member of the series or not.
        to_deg_per_s: f64, example 100.0, in 1e-4..=2000.0, "deg/s";
        /// Time measured at each rate; all of them, with static_s and settle_s, must fit into the duration.
        dwell_s: f64, example 0.1, in 1e-6..=1e6, "s";
        /// Longest time to which a dwell is stretched so that the table turns whole turns.
        dwell_max_s: Option<f64>, example 4.0, in 1e-6..=1e6, "s";
        /// Time measured at rest before and after the rates, the zero that is subtracted.
        static_s: f64, example 0.5, in 1e-6..=1e6, "s";
        /// Time left out before each measurement. Source of the default: as of turntable.steps.
        settle_s: f64 = 0.1, in 0.0..=1e6, "s";
    }
}

words! {
    /// Series of preferred numbers.
    pub enum PreferredSeries {
        /// Five a decade.
        R5 = "R5",
        /// Ten a decade.
        R10 = "R10",
    }
}

impl Motion for ScaleFactorTestConfig {
    fn class(&self) -> MotionClass<'_> {
        MotionClass::Steps(self.into())
    }

    fn rate_max_rad_per_s(&self) -> f64 {
        deg_per_s_to_rad_per_s(self.to_deg_per_s)
    }

    fn extremes(&self, surroundings: Surroundings) -> CommandExtremes {
        extremes(&self.into(), self.rate_max_rad_per_s(), surroundings)
    }

    /// Refuses a test of too few rates and one that the record cuts off.
    fn check(&self, checks: &mut MotionChecks) {
        let key = |name: &str| format!("turntable.scale_factor_test.{name}");
        let count = self.rates_deg_per_s().len();
        if count < TEST_RATES_MIN {
            let message = format!(
                "{} = {:?} deg/s leaves {count} rates of each sense up to {:?} deg/s: a scale \
                 factor test needs {TEST_RATES_MIN}; begin lower, take another series, or use \
                 [turntable.steps]",
                key("from_deg_per_s"),
                self.from_deg_per_s,
                self.to_deg_per_s
            );
            checks.complain(&key("from_deg_per_s"), message);
        }
        if let Some(longest_s) = self.dwell_max_s
            && longest_s < self.dwell_s
        {
            let message = format!(
                "{} = {longest_s:?} s is too short: allowed from dwell_s = {:?} s",
                key("dwell_max_s"),
                self.dwell_s
            );
            checks.complain(&key("dwell_max_s"), message);
        }
        let needed_s = Stairs::from(self).length_s();
        if checks.is_too_long(needed_s) {
            let message = format!(
                "{} = {:?} s is too long: the test of {count} rates of each sense takes \
                 {needed_s:.6} s, but duration_s = {:?} s",
                key("dwell_s"),
                self.dwell_s,
                checks.duration_s
            );
            checks.complain(&key("dwell_s"), message);
        }
    }

    fn course(&self, warm_up_s: f64, sample_period_s: f64) -> Arc<dyn Course> {
        Arc::new(Held::new(&Stairs::from(self), warm_up_s, sample_period_s))
    }
}

impl From<&ScaleFactorTestConfig> for Stairs {
    /// Rest, the rates of one sense upwards, those of the other, rest; settling before each.
    fn from(test: &ScaleFactorTestConfig) -> Self {
        let sense = test.rates_deg_per_s();
        let rest = [(0.0, test.static_s)];
        let held = |sign: f64| sense.iter().map(move |rate| (sign * rate, *rate));
        let moved = held(1.0)
            .chain(held(-1.0))
            .map(|(rate, size)| (rate, test.measured_s(size)));
        let dwells: Vec<(f64, f64)> = rest.into_iter().chain(moved).chain(rest).collect();
        let ends_s = dwells.iter().scan(0.0, |end_s, (_, measured_s)| {
            *end_s += test.settle_s + measured_s;
            Some(*end_s)
        });
        Self {
            ends_s: ends_s.collect(),
            rates_deg_per_s: dwells.iter().map(|(rate, _)| *rate).collect(),
            settle_s: test.settle_s,
            has_static_zeros: true,
        }
    }
}

impl ScaleFactorTestConfig {
    /// Rates of one sense, deg/s, ascending: the members of the series from the smallest rate on,
    /// and the largest rate whether it is a member or not.
    #[must_use]
    pub fn rates_deg_per_s(&self) -> Vec<f64> {
        let members = members(self.preferred_series);
        let (from, to) = (self.from_deg_per_s, self.to_deg_per_s);
        members
            .filter(|rate| *rate >= from * (1.0 - SLACK) && *rate < to * (1.0 - SLACK))
            .chain([to])
            .collect()
    }

    /// Time measured at a rate, s: the least whole turns that last `dwell_s` or longer if
    /// `dwell_max_s` allows them, otherwise `dwell_s`.
    #[must_use]
    pub fn measured_s(&self, rate_deg_per_s: f64) -> f64 {
        let turn_s = TURN_DEG / rate_deg_per_s.abs();
        let whole_s = (self.dwell_s / turn_s * (1.0 - SLACK)).ceil().max(1.0) * turn_s;
        match self.dwell_max_s {
            Some(longest_s) if whole_s <= longest_s * (1.0 + SLACK) => whole_s,
            _ => self.dwell_s,
        }
    }
}

/// The members of a series between 1e-4 and 1e4, ascending.
///
/// Source: GB/T 321 (ISO 3): rounded to the values that are in use.
fn members(series: PreferredSeries) -> impl Iterator<Item = f64> {
    let decade: &[f64] = match series {
        PreferredSeries::R5 => &[1.0, 1.6, 2.5, 4.0, 6.3],
        PreferredSeries::R10 => &[1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0],
    };
    // Division by a whole power of ten gives the number nearest to the decimal fraction.
    (-4..4).flat_map(move |exponent: i32| {
        let power = 10_f64.powi(exponent.abs());
        decade.iter().map(move |value| {
            if exponent < 0 {
                value / power
            } else {
                value * power
            }
        })
    })
}
