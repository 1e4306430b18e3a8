//! Chamber temperature as a function of time.

use std::f64::consts::TAU;

use crate::gyro::{TemperatureConfig, ThermalConfig};
use crate::units::k_per_min_to_k_per_s;

/// Temperature of the chamber: straight lines between points, with a sine of control ripple.
///
/// `T(t) = line(t) + A sin(2 pi t / P)`, t from the start of the simulation (the warm-up
/// included); constant before the first point and after the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Chamber {
    /// Time, s, and temperature, deg C; times increase.
    points: Vec<(f64, f64)>,
    ripple_c: f64,
    ripple_rad_per_s: f64,
}

impl Chamber {
    /// The chamber of a configuration.
    #[must_use]
    pub fn new(temperature: &TemperatureConfig, thermal: &ThermalConfig) -> Self {
        let points = match temperature {
            TemperatureConfig::Soak(soak) => vec![(0.0, soak.temperature_c)],
            TemperatureConfig::Ramp(ramp) => {
                let slope_c_per_s = k_per_min_to_k_per_s(ramp.rate_c_per_min);
                let end_s = ramp.start_s + (ramp.end_c - ramp.start_c) / slope_c_per_s;
                vec![(ramp.start_s, ramp.start_c), (end_s, ramp.end_c)]
            }
            TemperatureConfig::Profile(profile) => {
                let temperatures = profile.temperatures_c.iter().copied();
                profile.times_s.iter().copied().zip(temperatures).collect()
            }
        };
        Self {
            points,
            ripple_c: thermal.ripple_amplitude_c,
            ripple_rad_per_s: TAU / thermal.ripple_period_s,
        }
    }

    /// Temperature at a time, deg C.
    #[must_use]
    pub fn temperature_c(&self, time_s: f64) -> f64 {
        let line = match self.segment(time_s) {
            Segment::Held(temperature_c) => temperature_c,
            Segment::Line((start_s, start_c), slope) => start_c + slope * (time_s - start_s),
        };
        line + self.ripple_c * (self.ripple_rad_per_s * time_s).sin()
    }

    /// Derivative of the temperature at a time, K/s; at a corner that of the line to its right.
    #[must_use]
    pub fn slope_c_per_s(&self, time_s: f64) -> f64 {
        let line = match self.segment(time_s) {
            Segment::Held(_) => 0.0,
            Segment::Line(_, slope) => slope,
        };
        line + self.ripple_c * self.ripple_rad_per_s * (self.ripple_rad_per_s * time_s).cos()
    }

    /// Whether the temperature never changes.
    #[must_use]
    pub fn is_constant(&self) -> bool {
        let (low, high) = self.range_c();
        high <= low
    }

    /// Bounds of the temperature over all times, deg C.
    #[must_use]
    pub fn range_c(&self) -> (f64, f64) {
        let temperatures = self.points.iter().map(|(_, temperature_c)| *temperature_c);
        let low = temperatures.clone().fold(f64::INFINITY, f64::min);
        let high = temperatures.fold(f64::NEG_INFINITY, f64::max);
        (low - self.ripple_c, high + self.ripple_c)
    }

    fn segment(&self, time_s: f64) -> Segment {
        let after = self.points.partition_point(|(at_s, _)| *at_s <= time_s);
        match (after.checked_sub(1), self.points.get(after)) {
            (Some(before), Some(&(end_s, end_c))) => {
                let (start_s, start_c) = self.points[before];
                let slope = (end_c - start_c) / (end_s - start_s);
                Segment::Line((start_s, start_c), slope)
            }
            (Some(last), None) => Segment::Held(self.points[last].1),
            (None, first) => Segment::Held(first.map_or(f64::NAN, |(_, first_c)| *first_c)),
        }
    }
}

/// The part of the course a time falls into.
enum Segment {
    Held(f64),
    /// Start of the line (s, deg C) and its slope, K/s.
    Line((f64, f64), f64),
}
