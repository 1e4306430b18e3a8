//! Rates held one after the other: a staircase, or the rates of a scale factor test.

use crate::turntable::{PreferredSeries, ScaleFactorTestConfig, StepsConfig};

/// Degrees of a turn.
const TURN_DEG: f64 = 360.0;

/// Relative slack in comparisons of rates and times, far below any step of a series.
const SLACK: f64 = 1e-9;

/// Fewest rates of each sense in a scale factor test, the largest included.
///
/// Source: IEEE Std 952 and GJB 2426A, scale factor test.
pub const TEST_RATES_MIN: usize = 11;

/// Rates and when each of them ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Stairs {
    /// Rates in order, deg/s.
    pub rates_deg_per_s: Vec<f64>,
    /// End of each rate from the start of the record, s; the last rate is held beyond it.
    pub ends_s: Vec<f64>,
    /// Time at the start of each dwell that is left out, s.
    pub settle_s: f64,
    /// Whether the first and the last rate are rest, to be subtracted from what is between.
    pub has_static_zeros: bool,
}

impl Stairs {
    /// Time from the start of the record to the end of the last dwell, s.
    #[must_use]
    pub fn length_s(&self) -> f64 {
        self.ends_s.last().copied().unwrap_or(0.0)
    }
}

impl From<&StepsConfig> for Stairs {
    fn from(steps: &StepsConfig) -> Self {
        let counts = 1_u32..;
        let rates = steps.rates_deg_per_s.clone();
        Self {
            ends_s: counts
                .take(rates.len())
                .map(|count| f64::from(count) * steps.dwell_s)
                .collect(),
            rates_deg_per_s: rates,
            settle_s: steps.settle_s,
            has_static_zeros: false,
        }
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
