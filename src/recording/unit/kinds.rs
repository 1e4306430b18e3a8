//! Units in which logs carry rates, and how they become deg/h.

use std::fmt;
use std::str::FromStr;

use super::spelling::{Spelled, spelled};
use crate::declare::spelled;
use crate::units::{
    MICRO, MILLI, NANO, SECONDS_PER_HOUR, arcsec_to_rad, deg_to_rad, rad_per_s_to_deg_per_h,
    rad_to_deg,
};

/// Angle that a unit counts in, with the fraction of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AngleUnit {
    /// The angle.
    pub base: AngleBase,
    /// The fraction of it.
    pub prefix: Prefix,
}

/// Angles that units are fractions of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AngleBase {
    /// Degree.
    Degree,
    /// Arcminute.
    Arcmin,
    /// Arcsecond.
    Arcsec,
    /// Radian.
    Radian,
    /// Whole turn.
    Turn,
}

/// Fractions of a unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Prefix {
    /// All of it.
    One,
    /// 1e-3.
    Milli,
    /// 1e-6.
    Micro,
    /// 1e-9.
    Nano,
}

/// Time in which the angle of a unit is turned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Per {
    /// A second.
    Second,
    /// A minute.
    Minute,
    /// An hour.
    Hour,
    /// A sample period: words are increments of the angle.
    Sample,
}

/// Unit of the numbers of a log: a rate, or the angle turned in one sample period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RateUnit {
    /// What is turned.
    pub angle: AngleUnit,
    /// In which time.
    pub per: Per,
}

/// Unit as an option or a file names it: of a rate, or of an angle whose time another key tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LogUnit {
    /// A rate or an increment a sample.
    Rate(RateUnit),
    /// An angle.
    Angle(AngleUnit),
}

/// Units of rates as the ends of column names of groups.
pub(crate) const SUFFIXES: [(&str, RateUnit); 6] = [
    ("deg_per_h", RateUnit::DEG_PER_H),
    ("deg_per_s", RateUnit::DEG_PER_S),
    ("mdeg_per_s", RateUnit::MDEG_PER_S),
    ("arcsec_per_s", RateUnit::ARCSEC_PER_S),
    ("rad_per_s", RateUnit::RAD_PER_S),
    ("rad_per_h", RateUnit::RAD_PER_H),
];

impl Prefix {
    fn factor(self) -> f64 {
        match self {
            Self::One => 1.0,
            Self::Milli => MILLI,
            Self::Micro => MICRO,
            Self::Nano => NANO,
        }
    }
}

impl AngleUnit {
    /// The whole of an angle.
    pub(crate) const fn whole(base: AngleBase) -> Self {
        let prefix = Prefix::One;
        Self { base, prefix }
    }

    /// This angle turned in a time.
    #[must_use]
    pub const fn per(self, per: Per) -> RateUnit {
        RateUnit { angle: self, per }
    }

    /// An angle in rad.
    fn to_rad(self, angle: f64) -> f64 {
        let angle = angle * self.prefix.factor();
        match self.base {
            AngleBase::Degree => deg_to_rad(angle),
            AngleBase::Arcmin => arcsec_to_rad(angle * 60.0),
            AngleBase::Arcsec => arcsec_to_rad(angle),
            AngleBase::Radian => angle,
            AngleBase::Turn => deg_to_rad(angle * 360.0),
        }
    }

    /// Angles of a whole turn.
    #[must_use]
    pub fn turn(self) -> f64 {
        std::f64::consts::TAU / self.to_rad(1.0)
    }
}

impl RateUnit {
    /// deg/h.
    pub const DEG_PER_H: Self = AngleUnit::whole(AngleBase::Degree).per(Per::Hour);
    /// deg/s.
    pub const DEG_PER_S: Self = AngleUnit::whole(AngleBase::Degree).per(Per::Second);
    /// mdeg/s, as data sheets of small gyros have it.
    pub const MDEG_PER_S: Self = Self {
        angle: AngleUnit {
            base: AngleBase::Degree,
            prefix: Prefix::Milli,
        },
        per: Per::Second,
    };
    /// arcsec/s.
    pub const ARCSEC_PER_S: Self = AngleUnit::whole(AngleBase::Arcsec).per(Per::Second);
    /// rad/s.
    pub const RAD_PER_S: Self = AngleUnit::whole(AngleBase::Radian).per(Per::Second);
    /// rad/h.
    pub const RAD_PER_H: Self = AngleUnit::whole(AngleBase::Radian).per(Per::Hour);

    /// The units of rates that columns of groups have.
    pub fn rates() -> impl Iterator<Item = Self> {
        SUFFIXES.iter().map(|(_, unit)| *unit)
    }

    /// The rate in deg/h that `value` in this unit stands for.
    ///
    /// An angle per sample is the mean rate over that sample: the angle times `sample_rate_hz`.
    #[must_use]
    pub fn to_deg_per_h(self, value: f64, sample_rate_hz: f64) -> f64 {
        let times_an_hour = match self.per {
            Per::Second => SECONDS_PER_HOUR,
            Per::Minute => SECONDS_PER_HOUR / 60.0,
            Per::Hour => 1.0,
            Per::Sample => {
                return rad_per_s_to_deg_per_h(self.angle.to_rad(value) * sample_rate_hz);
            }
        };
        let angle = value * self.angle.prefix.factor();
        match self.angle.base {
            AngleBase::Degree => angle * times_an_hour,
            AngleBase::Arcmin => angle * (times_an_hour / 60.0),
            // Of arcseconds a second and degrees an hour the numbers are the same.
            AngleBase::Arcsec => angle * (times_an_hour / SECONDS_PER_HOUR),
            AngleBase::Radian => rad_to_deg(angle) * times_an_hour,
            AngleBase::Turn => angle * 360.0 * times_an_hour,
        }
    }
}

impl fmt::Display for AngleUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let prefix = match self.prefix {
            Prefix::One => "",
            Prefix::Milli => "m",
            Prefix::Micro => "u",
            Prefix::Nano => "n",
        };
        let base = match self.base {
            AngleBase::Degree => "deg",
            AngleBase::Arcmin => "arcmin",
            AngleBase::Arcsec => "arcsec",
            AngleBase::Radian => "rad",
            AngleBase::Turn => "turn",
        };
        write!(f, "{prefix}{base}")
    }
}

impl fmt::Display for RateUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let per = match self.per {
            Per::Second => "s",
            Per::Minute => "min",
            Per::Hour => "h",
            Per::Sample => "sample",
        };
        write!(f, "{}/{per}", self.angle)
    }
}

impl fmt::Display for LogUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rate(unit) => unit.fmt(f),
            Self::Angle(unit) => unit.fmt(f),
        }
    }
}

/// A unit of rates that nobody knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "expected a rate such as deg/h, deg/s or dps, mdeg/s, arcsec/s, rad/s, nrad/s, rpm; an angle turned \
     in a sample such as deg/sample, arcsec/sample, urad/sample; or an angle such as deg, rad"
)]
pub struct UnknownRateUnit;

impl FromStr for LogUnit {
    type Err = UnknownRateUnit;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match spelled(text) {
            Some(Spelled::Rate(unit)) => Ok(Self::Rate(unit)),
            Some(Spelled::Angle(unit)) => Ok(Self::Angle(unit)),
            _ => Err(UnknownRateUnit),
        }
    }
}

impl FromStr for RateUnit {
    type Err = UnknownRateUnit;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text.parse()? {
            LogUnit::Rate(unit) => Ok(unit),
            LogUnit::Angle(_) => Err(UnknownRateUnit),
        }
    }
}

impl From<RateUnit> for LogUnit {
    fn from(unit: RateUnit) -> Self {
        Self::Rate(unit)
    }
}

impl TryFrom<String> for LogUnit {
    type Error = UnknownRateUnit;

    fn try_from(text: String) -> Result<Self, Self::Error> {
        text.parse()
    }
}

spelled!(LogUnit);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unit_gives_the_same_earth_rate() {
        // 15.041067 deg/h, sidereal, in every unit at 400 samples a second.
        let rate_hz = 400.0;
        let rad_per_s = 15.041_067_f64.to_radians() / 3600.0;
        for (name, value) in [
            ("deg/h", 15.041_067),
            ("mdeg/h", 15_041.067),
            ("deg/s", 15.041_067 / 3600.0),
            ("deg/min", 15.041_067 / 60.0),
            ("mdeg/s", 15.041_067 / 3.6),
            ("mdps", 15.041_067 / 3.6),
            ("arcsec/s", 15.041_067),
            ("arcmin/s", 15.041_067 / 60.0),
            ("rad/s", rad_per_s),
            ("nrad/s", rad_per_s * 1e9),
            ("rad/h", rad_per_s * 3600.0),
            ("rpm", 15.041_067 / 360.0 / 60.0),
            ("deg/sample", 15.041_067 / 3600.0 / rate_hz),
            ("arcsec/sample", 15.041_067 / rate_hz),
            ("rad/sample", rad_per_s / rate_hz),
            ("urad/sample", rad_per_s * 1e6 / rate_hz),
        ] {
            let unit: RateUnit = name.parse().unwrap();
            let rate = unit.to_deg_per_h(value, rate_hz);
            assert!((rate / 15.041_067 - 1.0).abs() < 1e-14, "{name}: {rate}");
        }
    }

    #[test]
    fn a_turn_is_a_turn_in_every_angle() {
        for (name, turn) in [
            ("deg", 360.0),
            ("mrad", 6_283.185_307),
            ("arcsec", 1_296_000.0),
        ] {
            let LogUnit::Angle(unit) = name.parse().unwrap() else {
                panic!("{name}")
            };
            assert!((unit.turn() / turn - 1.0).abs() < 1e-9, "{name}");
        }
    }

    #[test]
    fn an_unknown_unit_is_answered_with_known_ones() {
        let answer = "furlong/s".parse::<RateUnit>().unwrap_err();
        assert!(answer.to_string().contains("deg/h, deg/s or dps"));
        assert!("deg".parse::<RateUnit>().is_err());
    }
}
