//! Units in which logs carry rates, and how they become deg/h.

use std::fmt;
use std::str::FromStr;

use crate::units::{
    MICRO, arcsec_per_s_to_deg_per_h, arcsec_to_rad, deg_per_s_to_deg_per_h, deg_to_rad,
    mdeg_per_s_to_deg_per_h, rad_per_h_to_deg_per_h, rad_per_s_to_deg_per_h,
};

/// Unit of the numbers of a log: a rate, or the angle turned in one sample period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RateUnit {
    /// deg/h.
    DegPerH,
    /// deg/s.
    DegPerS,
    /// mdeg/s, as data sheets of small gyros have it.
    MilliDegPerS,
    /// arcsec/s.
    ArcsecPerS,
    /// rad/s.
    RadPerS,
    /// rad/h.
    RadPerH,
    /// deg turned in a sample.
    DegPerSample,
    /// arcsec turned in a sample.
    ArcsecPerSample,
    /// rad turned in a sample.
    RadPerSample,
    /// urad turned in a sample.
    MicroRadPerSample,
}

/// Names in the order they are listed.
const NAMES: [(&str, RateUnit); 11] = [
    ("deg/h", RateUnit::DegPerH),
    ("deg/s", RateUnit::DegPerS),
    ("mdeg/s", RateUnit::MilliDegPerS),
    ("mdps", RateUnit::MilliDegPerS),
    ("arcsec/s", RateUnit::ArcsecPerS),
    ("rad/s", RateUnit::RadPerS),
    ("rad/h", RateUnit::RadPerH),
    ("deg/sample", RateUnit::DegPerSample),
    ("arcsec/sample", RateUnit::ArcsecPerSample),
    ("rad/sample", RateUnit::RadPerSample),
    ("urad/sample", RateUnit::MicroRadPerSample),
];

/// Units of rates as the ends of column names.
pub(crate) const SUFFIXES: [(&str, RateUnit); 6] = [
    ("deg_per_h", RateUnit::DegPerH),
    ("deg_per_s", RateUnit::DegPerS),
    ("mdeg_per_s", RateUnit::MilliDegPerS),
    ("arcsec_per_s", RateUnit::ArcsecPerS),
    ("rad_per_s", RateUnit::RadPerS),
    ("rad_per_h", RateUnit::RadPerH),
];

impl RateUnit {
    /// The units that are rates, without those of angles per sample.
    pub fn rates() -> impl Iterator<Item = Self> {
        SUFFIXES.iter().map(|(_, unit)| *unit)
    }

    /// The rate in deg/h that `value` in this unit stands for.
    ///
    /// An angle per sample is the mean rate over that sample: the angle times `sample_rate_hz`.
    #[must_use]
    pub fn to_deg_per_h(self, value: f64, sample_rate_hz: f64) -> f64 {
        let turned = |angle_rad: f64| rad_per_s_to_deg_per_h(angle_rad * sample_rate_hz);
        match self {
            Self::DegPerH => value,
            Self::DegPerS => deg_per_s_to_deg_per_h(value),
            Self::MilliDegPerS => mdeg_per_s_to_deg_per_h(value),
            Self::ArcsecPerS => arcsec_per_s_to_deg_per_h(value),
            Self::RadPerS => rad_per_s_to_deg_per_h(value),
            Self::RadPerH => rad_per_h_to_deg_per_h(value),
            Self::DegPerSample => turned(deg_to_rad(value)),
            Self::ArcsecPerSample => turned(arcsec_to_rad(value)),
            Self::RadPerSample => turned(value),
            Self::MicroRadPerSample => turned(value * MICRO),
        }
    }
}

/// A unit of rates that nobody knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected one of {}", NAMES.map(|(name, _)| name).join(", "))]
pub struct UnknownRateUnit;

impl FromStr for RateUnit {
    type Err = UnknownRateUnit;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let known = NAMES.iter().find(|(name, _)| *name == text);
        known.map(|(_, unit)| *unit).ok_or(UnknownRateUnit)
    }
}

impl fmt::Display for RateUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = NAMES.iter().find(|(_, unit)| unit == self);
        f.write_str(name.map_or("", |(name, _)| name))
    }
}

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
            ("deg/s", 15.041_067 / 3600.0),
            ("mdeg/s", 15.041_067 / 3.6),
            ("mdps", 15.041_067 / 3.6),
            ("arcsec/s", 15.041_067),
            ("rad/s", rad_per_s),
            ("rad/h", rad_per_s * 3600.0),
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
    fn an_unknown_unit_is_answered_with_the_known_ones() {
        let answer = "dps".parse::<RateUnit>().unwrap_err();
        assert_eq!(
            answer.to_string(),
            "expected one of deg/h, deg/s, mdeg/s, mdps, arcsec/s, rad/s, rad/h, deg/sample, \
             arcsec/sample, rad/sample, urad/sample"
        );
    }
}
