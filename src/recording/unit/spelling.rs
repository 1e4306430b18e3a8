//! Units as people spell them: in options, in headings, in a row of units.

use super::kinds::{AngleBase, AngleUnit, Per, Prefix, RateUnit};
use crate::recording::time::unit::TimeUnit;

/// What a text says of the numbers below it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::recording) enum Spelled {
    /// A rate, or an angle turned in a sample.
    Rate(RateUnit),
    /// An angle.
    Angle(AngleUnit),
    /// A time.
    Time(TimeUnit),
    /// Counts of a converter.
    Counts,
    /// A unit of another quantity, such as a temperature.
    Other,
}

/// Angles in small letters, with what they count.
const ANGLES: [(&str, AngleBase); 16] = [
    ("deg", AngleBase::Degree),
    ("degs", AngleBase::Degree),
    ("degree", AngleBase::Degree),
    ("degrees", AngleBase::Degree),
    ("arcmin", AngleBase::Arcmin),
    ("arcsec", AngleBase::Arcsec),
    ("asec", AngleBase::Arcsec),
    ("arcseconds", AngleBase::Arcsec),
    ("rad", AngleBase::Radian),
    ("rads", AngleBase::Radian),
    ("radian", AngleBase::Radian),
    ("radians", AngleBase::Radian),
    ("turn", AngleBase::Turn),
    ("turns", AngleBase::Turn),
    ("rev", AngleBase::Turn),
    ("revs", AngleBase::Turn),
];

/// Times in which an angle is turned.
const TIMES: [(&str, Per); 13] = [
    ("s", Per::Second),
    ("sec", Per::Second),
    ("second", Per::Second),
    ("seconds", Per::Second),
    ("min", Per::Minute),
    ("minute", Per::Minute),
    ("h", Per::Hour),
    ("hr", Per::Hour),
    ("hrs", Per::Hour),
    ("hour", Per::Hour),
    ("sample", Per::Sample),
    ("samples", Per::Sample),
    ("count", Per::Sample),
];

/// Rates of one word, behind a prefix.
const RATES: [(&str, AngleBase, Per); 5] = [
    ("dps", AngleBase::Degree, Per::Second),
    ("dph", AngleBase::Degree, Per::Hour),
    ("rps", AngleBase::Turn, Per::Second),
    ("rpm", AngleBase::Turn, Per::Minute),
    ("rph", AngleBase::Turn, Per::Hour),
];

const PREFIXES: [(&str, Prefix); 7] = [
    ("milli", Prefix::Milli),
    ("micro", Prefix::Micro),
    ("nano", Prefix::Nano),
    ("m", Prefix::Milli),
    ("u", Prefix::Micro),
    ("n", Prefix::Nano),
    ("", Prefix::One),
];

const COUNTS: [&str; 8] = [
    "count", "counts", "lsb", "lsbs", "raw", "adc", "ticks", "digits",
];

/// Units of what stands beside the rates in logs.
const OTHERS: [&str; 30] = [
    "g", "mg", "ug", "m/s^2", "m/s2", "m/s/s", "m/s", "k", "c", "degc", "f", "degf", "t", "ut",
    "mt", "nt", "gauss", "mgauss", "v", "mv", "a", "ma", "hz", "khz", "pa", "hpa", "mbar", "m",
    "-", "1",
];

/// The unit that a text is, and nothing else.
pub(in crate::recording) fn spelled(text: &str) -> Option<Spelled> {
    let text = plain_letters(text);
    let text = text.trim();
    let text = [('[', ']'), ('(', ')'), ('{', '}')]
        .into_iter()
        .find_map(|(open, close)| text.strip_prefix(open)?.strip_suffix(close))
        .unwrap_or(text)
        .trim();
    if COUNTS.contains(&text) {
        return Some(Spelled::Counts);
    }
    if let Some(unit) = rate(text) {
        return Some(Spelled::Rate(unit));
    }
    if let Some(unit) = angle(text) {
        return Some(Spelled::Angle(unit));
    }
    if let Some(unit) = TimeUnit::spelled(text) {
        return Some(Spelled::Time(unit));
    }
    OTHERS.contains(&text).then_some(Spelled::Other)
}

/// Small letters, with those of the Greek and other alphabets replaced.
fn plain_letters(text: &str) -> String {
    let mut plain = String::new();
    for letter in text.chars() {
        match letter {
            'µ' | 'μ' => plain.push('u'),
            '°' | 'º' => plain.push_str("deg"),
            '\'' | '\u{2032}' => plain.push_str("arcmin"),
            '"' | '\u{2033}' => plain.push_str("arcsec"),
            '\u{207b}' => plain.push_str("^-"),
            '\u{b9}' => plain.push('1'),
            '·' | '*' | '.' => plain.push(' '),
            _ => plain.extend(letter.to_lowercase()),
        }
    }
    plain
}

/// A rate: an angle over a time, in any of the ways in which that is written.
fn rate(text: &str) -> Option<RateUnit> {
    for (word, base, per) in RATES {
        if let Some(prefix) = text.strip_suffix(word).and_then(prefix) {
            return Some(AngleUnit { base, prefix }.per(per));
        }
    }
    let over = [" per ", "_per_", "/"];
    let cut = over.into_iter().find_map(|over| text.split_once(over));
    let (turned, time) = match cut {
        Some((turned, time)) => (turned, time.to_owned()),
        // `rad s^-1` and `rad s-1`.
        None => {
            let (turned, time) = text.rsplit_once([' ', '_'])?;
            let time = time
                .strip_suffix("^-1")
                .or_else(|| time.strip_suffix("^(-1)"))
                .or_else(|| time.strip_suffix("-1"))?;
            (turned, time.to_owned())
        }
    };
    let turned = angle(turned.trim())?;
    let (_, per) = TIMES.iter().find(|(word, _)| *word == time.trim())?;
    Some(turned.per(*per))
}

fn angle(text: &str) -> Option<AngleUnit> {
    let mut ending = ANGLES.iter().rev();
    ending.find_map(|(word, base)| {
        let prefix = text.strip_suffix(word).and_then(prefix)?;
        Some(AngleUnit {
            base: *base,
            prefix,
        })
    })
}

fn prefix(text: &str) -> Option<Prefix> {
    let known = PREFIXES.iter().find(|(word, _)| *word == text.trim());
    known.map(|(_, prefix)| *prefix)
}

/// The unit that a heading names behind the quantity: in brackets, behind a comma, as the end of a
/// name, or as the whole of it.
pub(in crate::recording) fn unit_of_heading(heading: &str) -> Option<Spelled> {
    if let Some(unit) = in_brackets(heading).and_then(spelled) {
        return Some(unit);
    }
    if let Some(unit) = spelled(heading) {
        return Some(unit);
    }
    if let Some((_, behind)) = heading.rsplit_once([',', ';', ':'])
        && let Some(unit) = spelled(behind)
    {
        return Some(unit);
    }
    let ends = heading
        .char_indices()
        .filter(|(_, letter)| matches!(letter, '_' | ' ' | '.' | '-'));
    // The longest end is the whole unit: `mdeg_per_s` before `s`.
    let mut ends = ends.map(|(at, _)| &heading[at + 1..]);
    ends.find_map(|end| match end_of_name(end)? {
        // `x_m` or `x_t` name no unit, nor does a lone letter of a time.
        Spelled::Other => None,
        unit => Some(unit),
    })
}

/// The unit that the end of a name is: `rad_s` stands there for rad/s.
fn end_of_name(end: &str) -> Option<Spelled> {
    spelled(end).or_else(|| {
        let (turned, time) = end.split_once('_')?;
        match spelled(&format!("{turned}/{time}"))? {
            Spelled::Rate(unit) => Some(Spelled::Rate(unit)),
            _ => None,
        }
    })
}

/// What stands in the last brackets of a heading.
fn in_brackets(heading: &str) -> Option<&str> {
    let pairs = [('[', ']'), ('(', ')'), ('{', '}')];
    pairs.into_iter().find_map(|(open, close)| {
        let (_, behind) = heading.rsplit_once(open)?;
        let (inside, _) = behind.split_once(close)?;
        Some(inside)
    })
}

/// A heading without the unit in brackets, in small letters: the name of the quantity.
pub(in crate::recording) fn name_of_heading(heading: &str) -> String {
    let open = heading.find(['[', '(', '{']).unwrap_or(heading.len());
    heading[..open].trim().to_lowercase()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_read_however_they_are_spelled() {
        for (text, unit) in [
            ("deg/s", "deg/s"),
            ("°/s", "deg/s"),
            ("[deg/sec]", "deg/s"),
            ("deg/hr", "deg/h"),
            ("º/h", "deg/h"),
            ("rad s^-1", "rad/s"),
            ("rad·s⁻¹", "rad/s"),
            ("RAD/S", "rad/s"),
            ("mdps", "mdeg/s"),
            ("µrad/s", "urad/s"),
            ("microrad/s", "urad/s"),
            ("nrad/s", "nrad/s"),
            ("degrees per second", "deg/s"),
            ("arcsec/sec", "arcsec/s"),
            ("rev/min", "turn/min"),
            ("rpm", "turn/min"),
            ("mdeg/h", "mdeg/h"),
            ("urad/sample", "urad/sample"),
        ] {
            let Some(Spelled::Rate(found)) = spelled(text) else {
                panic!("{text}")
            };
            assert_eq!(found.to_string(), unit, "{text}");
        }
        for text in ["", "s", "deg", "gyro", "m/s", "per s", "deg/", "/s", "Hz"] {
            assert!(!matches!(spelled(text), Some(Spelled::Rate(_))), "{text}");
        }
    }

    #[test]
    fn headings_name_units_in_brackets_and_at_their_ends() {
        for (heading, unit) in [
            ("gyro_x(rad/s)", "rad/s"),
            ("Gyro X [deg/s]", "deg/s"),
            ("w_x [rad s^-1]", "rad/s"),
            ("gx_dps", "deg/s"),
            ("rate_deg_per_h", "deg/h"),
            ("rate_mdeg_per_s", "mdeg/s"),
            ("gyro_rad_s", "rad/s"),
            ("Rate, deg/h", "deg/h"),
            ("deg/s", "deg/s"),
            ("omega z - nrad/s", "nrad/s"),
        ] {
            let Some(Spelled::Rate(found)) = unit_of_heading(heading) else {
                panic!("{heading}: {:?}", unit_of_heading(heading))
            };
            assert_eq!(found.to_string(), unit, "{heading}");
        }
        assert_eq!(
            unit_of_heading("tow(msec)"),
            Some(Spelled::Time(TimeUnit::Milliseconds))
        );
        assert_eq!(
            unit_of_heading("time_s"),
            Some(Spelled::Time(TimeUnit::Seconds))
        );
        assert!(matches!(
            unit_of_heading("angle_deg"),
            Some(Spelled::Angle(_))
        ));
        assert_eq!(unit_of_heading("gyro [LSB]"), Some(Spelled::Counts));
        for heading in ["rate", "gx", "gyro_x", "Gyr_X", "w x", "state"] {
            assert_eq!(unit_of_heading(heading), None, "{heading}");
        }
    }
}
