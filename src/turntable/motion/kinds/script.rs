//! A motion that the user tabulates.

use std::sync::Arc;

use crate::declare::table;
use crate::turntable::motion::checks::{MotionChecks, TIME_SLACK};
use crate::turntable::motion::course::{Course, Instant};
use crate::turntable::motion::kind::{CommandExtremes, Motion, MotionClass, Surroundings};
use crate::turntable::motion::samples::first_measured_index;
use crate::units::deg_to_rad;
use crate::wording::number;

table! {
    /// A motion of one's own, from a CSV file with the columns time_s and rate_deg_per_s or angle_deg;
    /// a line that begins with "#" is a comment. Its values enter the manifest, its digest the list of
    /// input files. The file cannot be swept.
    pub struct ScriptConfig,
    one "source of points" of file | points
    {
        /// Path of the file, relative to the file that names it (to the working directory in --set).
        file: Option<String>, example "motion.csv",
            apart "its columns have been put in the place of the points";
        points: ScriptPoints;
    }
}

table! {
    /// Points of a script: as many rates or angles as there are times.
    pub struct ScriptPoints,
    one "kind of values" of rate_deg_per_s | angle_deg
    {
        /// Times from the start of the record: the first is 0, each is at least an output sample after the
        /// one before it, the last is the duration or later.
        time_s: Vec<f64>, example [0.0, 5.0, 20.0], in 0.0..=1e7, "s";
        /// Rates, joined by straight lines; the first is held through the warm-up.
        rate_deg_per_s: Option<Vec<f64>>, example [0.0, 10.0, -10.0], in -2000.0..=2000.0, "deg/s";
        /// Angles, joined by monotone cubics; the table rests before the first and comes to rest at the
        /// last.
        angle_deg: Option<Vec<f64>>, example [0.0, 90.0, 0.0], in -1e6..=1e6, "deg";
    }
}

impl Motion for ScriptConfig {
    fn class(&self) -> MotionClass<'_> {
        MotionClass::General
    }

    fn rate_max_rad_per_s(&self) -> f64 {
        script_extremes(&self.points).rate
    }

    fn extremes(&self, _: Surroundings) -> CommandExtremes {
        let extremes = script_extremes(&self.points);
        CommandExtremes {
            jump_rad_per_s: extremes.first_rate.abs(),
            acceleration_rad_per_s2: extremes.acceleration,
        }
    }

    /// Refuses columns of different lengths, times that do not increase, and a script that is too
    /// short or too fine for the record.
    fn check(&self, checks: &mut MotionChecks) {
        let times = &self.points.time_s;
        let path = |index: usize| format!("turntable.script.points.time_s[{index}]");
        for (name, values) in [
            ("rate_deg_per_s", &self.points.rate_deg_per_s),
            ("angle_deg", &self.points.angle_deg),
        ] {
            if let Some(values) = values
                && values.len() != times.len()
            {
                let key = format!("turntable.script.points.{name}");
                let message = format!(
                    "{key} has {} values, but there are {} times: give one for each",
                    values.len(),
                    times.len()
                );
                checks.complain(&key, message);
            }
        }
        if let Some(first) = times.first()
            && first.abs() > 0.0
        {
            let message = format!(
                "{} = {first:?} s: the first time must be 0.0 s, the start of the record",
                path(0)
            );
            checks.complain(&path(0), message);
        }
        let period_s = checks.sample_period_s;
        let close = times
            .windows(2)
            .position(|pair| pair[1] - pair[0] < period_s);
        if let Some(before) = close {
            let (earlier, later) = (times[before], times[before + 1]);
            let message = format!(
                "{} = {later:?} s is too early: allowed from {} s, one output sample after the \
                 {earlier:?} s before it",
                path(before + 1),
                number(earlier + period_s)
            );
            checks.complain(&path(before + 1), message);
        }
        let duration_s = checks.duration_s;
        if let Some(last) = times.last()
            && *last < duration_s * (1.0 - TIME_SLACK)
        {
            let index = times.len() - 1;
            let message = format!(
                "{} = {last:?} s ends the script too early: expected at least duration_s = \
                 {duration_s:?} s",
                path(index)
            );
            checks.complain(&path(index), message);
        }
    }

    fn course(&self, warm_up_s: f64, sample_period_s: f64) -> Arc<dyn Course> {
        Arc::new(Script::new(&self.points, warm_up_s, sample_period_s))
    }
}

/// Tabulated rates or angles, their time counted from the start of the record.
///
/// Rates are joined by straight lines; the first is held before the record, the last one after the
/// table. Angles are joined by the monotone cubics of Fritsch and Butland, so that the table never
/// swings beyond its points; it rests at the first angle before the record and comes to rest at the
/// last one. The rate is continuous either way, the acceleration jumps at the points: the cubic of
/// the sample that holds such a jump turns by up to `T^2 / 8` of the jump too much or too little,
/// 0.03 arcsec for 1000 deg/s^2 at 4 kHz.
///
/// # Source
/// F. N. Fritsch and J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300, the weighted harmonic
/// mean of the neighbouring slopes.
#[derive(Clone, Debug)]
struct Script {
    /// Times, samples from the start of the warm-up.
    times: Vec<f64>,
    curve: Curve,
    sample_period_s: f64,
}

/// What joins the points.
#[derive(Clone, Debug)]
enum Curve {
    /// Rates at the points, rad/s.
    Rates(Vec<f64>),
    /// Angles at the points, rad, and rates there, rad/s.
    Angles { angles: Vec<f64>, rates: Vec<f64> },
}

/// What a script asks for at most.
#[derive(Clone, Copy, Debug, PartialEq)]
struct ScriptExtremes {
    /// Rate before the record, rad/s.
    first_rate: f64,
    /// Largest rate in magnitude, rad/s.
    rate: f64,
    /// Largest acceleration in magnitude, rad/s^2.
    acceleration: f64,
}

impl Script {
    fn new(points: &ScriptPoints, warm_up_s: f64, sample_period_s: f64) -> Self {
        let first = first_measured_index(warm_up_s, sample_period_s) as f64;
        let times = points.time_s.iter();
        Self {
            times: times
                .map(|time_s| first + time_s / sample_period_s)
                .collect(),
            curve: curve(points),
            sample_period_s,
        }
    }
}

impl Course for Script {
    fn at(&self, instant: f64) -> Instant {
        let after = self.times.partition_point(|time| *time <= instant);
        let last = self.times.len() - 1;
        if after == 0 || after > last {
            let point = if after == 0 { 0 } else { last };
            return Instant {
                rate: self.curve.rate_at_point(point),
                slope: 0.0,
            };
        }
        let (start, end) = (self.times[after - 1], self.times[after]);
        let interval_s = (end - start) * self.sample_period_s;
        let u = (instant - start) / (end - start);
        let (rate, acceleration) = self.curve.at(after - 1, u, interval_s);
        Instant {
            rate,
            slope: acceleration * self.sample_period_s,
        }
    }
}

impl Curve {
    fn rate_at_point(&self, point: usize) -> f64 {
        match self {
            Self::Rates(rates) | Self::Angles { rates, .. } => rates[point],
        }
    }

    /// Rate (rad/s) and acceleration (rad/s^2) at share `u` of the interval after a point.
    fn at(&self, point: usize, u: f64, interval_s: f64) -> (f64, f64) {
        match self {
            Self::Rates(rates) => {
                let rise = rates[point + 1] - rates[point];
                (rates[point] + u * rise, rise / interval_s)
            }
            Self::Angles { angles, rates } => {
                let mean = (angles[point + 1] - angles[point]) / interval_s;
                let (before, after) = (rates[point], rates[point + 1]);
                let rate = 6.0 * u * (1.0 - u) * mean
                    + before * (1.0 - u) * (1.0 - 3.0 * u)
                    + after * u * (3.0 * u - 2.0);
                let acceleration = 6.0 * (1.0 - 2.0 * u) * mean
                    + before * (6.0 * u - 4.0)
                    + after * (6.0 * u - 2.0);
                (rate, acceleration / interval_s)
            }
        }
    }

    /// Where inside an interval the rate is largest or smallest, if it is there.
    fn turning_share(&self, point: usize, interval_s: f64) -> Option<f64> {
        let (_, start) = self.at(point, 0.0, interval_s);
        let (_, end) = self.at(point, 1.0, interval_s);
        let share = start / (start - end);
        (0.0..=1.0).contains(&share).then_some(share)
    }
}

/// The curve through the points.
fn curve(points: &ScriptPoints) -> Curve {
    let radians = |values: &[f64]| values.iter().copied().map(deg_to_rad).collect();
    match (&points.rate_deg_per_s, &points.angle_deg) {
        (Some(rates), None) => Curve::Rates(radians(rates)),
        (None, Some(angles)) => {
            let angles: Vec<f64> = radians(angles);
            let rates = monotone_slopes(&points.time_s, &angles);
            Curve::Angles { angles, rates }
        }
        _ => panic!("a script has either rates or angles"),
    }
}

/// Slopes of the monotone cubics through points, zero at both ends.
fn monotone_slopes(times: &[f64], values: &[f64]) -> Vec<f64> {
    let mut slopes = vec![0.0; values.len()];
    for at in 1..values.len().saturating_sub(1) {
        let (before_s, after_s) = (times[at] - times[at - 1], times[at + 1] - times[at]);
        let before = (values[at] - values[at - 1]) / before_s;
        let after = (values[at + 1] - values[at]) / after_s;
        if before * after > 0.0 {
            let (own, other) = (2.0 * after_s + before_s, after_s + 2.0 * before_s);
            slopes[at] = (own + other) / (own / before + other / after);
        }
    }
    slopes
}

/// The extremes of a script, found from its closed form.
fn script_extremes(points: &ScriptPoints) -> ScriptExtremes {
    let curve = curve(points);
    let mut extremes = ScriptExtremes {
        first_rate: curve.rate_at_point(0),
        rate: curve.rate_at_point(0).abs(),
        acceleration: 0.0,
    };
    for (point, pair) in points.time_s.windows(2).enumerate() {
        let interval_s = pair[1] - pair[0];
        let inner = curve.turning_share(point, interval_s);
        for share in [Some(0.0), inner, Some(1.0)].into_iter().flatten() {
            let (rate, acceleration) = curve.at(point, share, interval_s);
            extremes.rate = extremes.rate.max(rate.abs());
            extremes.acceleration = extremes.acceleration.max(acceleration.abs());
        }
    }
    extremes
}
