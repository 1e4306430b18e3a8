//! Names taken apart: the words of a quantity, and the unit that closes them.
//!
//! `rate_random_walk_deg_per_h_per_sqrt_h` is *rate random walk* in `deg/h/sqrt(h)`. Two names stand
//! for one quantity if their words agree, in any order, and their units measure the same.

use super::text::plain;

/// Words that stand for others, in any name.
const ABBREVIATIONS: &[(&str, &[&str])] = &[
    ("arw", &["angle", "random", "walk"]),
    ("rrw", &["rate", "random", "walk"]),
    ("bi", &["bias", "instability"]),
    ("sf", &["scale", "factor"]),
    ("acc", &["acceleration"]),
    ("accel", &["acceleration"]),
    ("amp", &["amplitude"]),
    ("ampl", &["amplitude"]),
    ("avg", &["average"]),
    ("bw", &["bandwidth"]),
    ("corr", &["correlation"]),
    ("dia", &["diameter"]),
    ("diam", &["diameter"]),
    ("dur", &["duration"]),
    ("freq", &["frequency"]),
    ("frequencies", &["frequency"]),
    ("len", &["length"]),
    ("maximum", &["max"]),
    ("minimum", &["min"]),
    ("num", &[]),
    ("pol", &["polarisation"]),
    ("polarization", &["polarisation"]),
    ("quantization", &["quantisation"]),
    ("regularization", &["regularisation"]),
    ("normalized", &["normalised"]),
    ("pwr", &["power"]),
    ("sigma", &["std"]),
    ("temp", &["temperature"]),
    ("warmup", &["warm", "up"]),
    ("wl", &["wavelength"]),
];

/// Words of units that are spelled otherwise.
const UNIT_SPELLINGS: &[(&str, &[&str])] = &[
    ("degree", &["deg"]),
    ("degrees", &["deg"]),
    ("dph", &["deg", "per", "h"]),
    ("dps", &["deg", "per", "s"]),
    ("hr", &["h"]),
    ("hrs", &["h"]),
    ("hour", &["h"]),
    ("hours", &["h"]),
    ("hertz", &["hz"]),
    ("meter", &["m"]),
    ("metre", &["m"]),
    ("metres", &["m"]),
    ("meters", &["m"]),
    ("minute", &["min"]),
    ("minutes", &["min"]),
    ("pct", &["percent"]),
    ("root", &["sqrt"]),
    ("rt", &["sqrt"]),
    ("rthz", &["sqrt", "hz"]),
    ("sec", &["s"]),
    ("secs", &["s"]),
    ("second", &["s"]),
    ("seconds", &["s"]),
    ("sqrth", &["sqrt", "h"]),
    ("sqrthr", &["sqrt", "h"]),
    ("sqrthz", &["sqrt", "hz"]),
];

/// Base quantities that units are made of.
const BASES: usize = 11;
/// Twice the powers of the base quantities, so that a square root is a whole number.
pub(super) type Dimension = [i8; BASES];

/// Base quantity of a unit's word, and the power in which the word stands for it.
fn base(word: &str) -> Option<(usize, i8)> {
    Some(match word {
        "deg" | "rad" | "urad" | "mrad" | "arcsec" | "arcmin" => (0, 1),
        "s" | "ms" | "us" | "ns" | "h" | "min" => (1, 1),
        "hz" | "khz" | "mhz" | "ghz" => (1, -1),
        "m" | "mm" | "um" | "nm" | "km" | "cm" => (2, 1),
        "c" | "k" => (3, 1),
        "w" | "mw" | "uw" | "nw" => (4, 1),
        "v" | "mv" | "uv" | "nv" => (5, 1),
        "a" | "ma" | "ua" | "na" | "pa" => (6, 1),
        "ohm" | "kohm" | "mohm" => (7, 1),
        "kg" => (8, 1),
        "ppm" | "percent" => (9, 1),
        "g" | "mg" | "n" => (10, 1),
        _ => return None,
    })
}

/// How many of the base unit a unit's word stands for; see [`base`].
fn scale(word: &str) -> f64 {
    match word {
        "rad" => 180.0 / std::f64::consts::PI,
        "mrad" => 0.18 / std::f64::consts::PI,
        "urad" => 0.18e-3 / std::f64::consts::PI,
        "arcmin" => 1.0 / 60.0,
        "arcsec" => 1.0 / 3600.0,
        "min" => 60.0,
        "h" => 3600.0,
        "km" | "khz" | "kohm" => 1e3,
        "mhz" => 1e6,
        "ghz" => 1e9,
        "cm" | "percent" => 1e-2,
        "ms" | "mm" | "mw" | "mv" | "ma" | "mg" | "mohm" => 1e-3,
        "us" | "um" | "uw" | "uv" | "ua" | "ppm" => 1e-6,
        "ns" | "nm" | "nw" | "nv" | "na" => 1e-9,
        "pa" => 1e-12,
        _ => 1.0,
    }
}

/// What one of the unit of a written name is in that of a known one, as in `1 deg/s is 3600 deg/h`; none
/// where they are the same, measure something else or are not there.
pub(crate) fn conversion(written: &str, known: &str) -> Option<String> {
    let (own, other) = (Quantity::of(written).unit?, Quantity::of(known).unit?);
    let factor = own.scale() / other.scale();
    let is_same = (factor - 1.0).abs() < 1e-9;
    (own.dimension == other.dimension && !is_same)
        .then(|| format!("1 {} is {} {}", own.shown(), plain(factor), other.shown()))
}

/// A unit: its words, and what it measures.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Unit {
    words: Vec<String>,
    pub(super) dimension: Dimension,
}

impl Unit {
    /// How many of the base units it stands for.
    fn scale(&self) -> f64 {
        let mut scale_of_all = 1.0;
        let (mut is_divisor, mut is_root) = (false, false);
        for word in &self.words {
            match word.as_str() {
                "per" => is_divisor = true,
                "sqrt" => is_root = true,
                word => {
                    let power = word.chars().last().and_then(|last| last.to_digit(10));
                    let name = word.trim_end_matches(|c: char| c.is_ascii_digit());
                    let power = f64::from(power.unwrap_or(1)) * if is_root { 0.5 } else { 1.0 };
                    let factor = scale(name).powf(power);
                    scale_of_all *= if is_divisor { 1.0 / factor } else { factor };
                    (is_divisor, is_root) = (false, false);
                }
            }
        }
        scale_of_all
    }

    /// The unit as people write it: `deg/h/sqrt(h)`.
    fn shown(&self) -> String {
        let mut text = String::new();
        let mut is_root = false;
        for word in &self.words {
            match word.as_str() {
                "per" => text.push('/'),
                "sqrt" => is_root = true,
                word if is_root => {
                    text.push_str(&format!("sqrt({word})"));
                    is_root = false;
                }
                word => {
                    if !text.is_empty() && !text.ends_with('/') {
                        text.push(' ');
                    }
                    text.push_str(word);
                }
            }
        }
        text
    }
}

/// A name taken apart.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Quantity {
    /// Words of the quantity in the singular, in the order of the alphabet.
    pub(super) words: Vec<String>,
    /// Its unit, if the name closes with one.
    pub(super) unit: Option<Unit>,
}

impl Quantity {
    pub(super) fn of(name: &str) -> Self {
        let tokens = tokens(name);
        let unit_at = (1..tokens.len()).find_map(|at| Some((at, unit(&tokens[at..])?)));
        let (words, unit) = match unit_at {
            Some((at, unit)) => (&tokens[..at], Some(unit)),
            None => (&tokens[..], None),
        };
        let mut words: Vec<String> = words.iter().map(|word| singular(word)).collect();
        words.sort_unstable();
        Self { words, unit }
    }
}

/// The words of a name's quantity, without its unit, in the order of the alphabet.
pub(crate) fn words_of(name: &str) -> Vec<String> {
    Quantity::of(name).words
}

/// The words of a name as they are written.
pub(super) fn written_words(name: &str) -> Vec<String> {
    let lower = name.to_lowercase();
    let words = lower.split(['_', '-', '.', ' ', '[', ']']);
    let words = words.filter(|word| !word.is_empty());
    words.map(str::to_owned).collect()
}

/// The words of a name, abbreviations written out.
fn tokens(name: &str) -> Vec<String> {
    let mut tokens = Vec::new();
    for token in written_words(name) {
        let found = ABBREVIATIONS.iter().find(|(short, _)| *short == token);
        match found {
            Some((_, words)) => tokens.extend(words.iter().map(|&word| word.to_owned())),
            None => tokens.push(token),
        }
    }
    tokens
}

fn singular(word: &str) -> String {
    let is_plural = word.len() > 3 && word.ends_with('s') && !word.ends_with("ss");
    if is_plural {
        word[..word.len() - 1].to_owned()
    } else {
        word.to_owned()
    }
}

/// Words of a unit with the `per` that is often left out: nothing is given in degree hours or degree
/// seconds, so that `deg_h` stands for deg/h.
fn with_divisions(words: Vec<String>) -> Vec<String> {
    let mut written: Vec<String> = Vec::new();
    for word in words {
        let is_time = matches!(word.as_str(), "h" | "s" | "min" | "sqrt");
        if is_time && written.last().is_some_and(|last| last == "deg") {
            written.push("per".to_owned());
        }
        written.push(word);
    }
    written
}

/// The unit that words spell: factors, each behind `per` a divisor, `sqrt` before or a power behind.
fn unit(tokens: &[String]) -> Option<Unit> {
    let spelled = tokens.iter().flat_map(|token| {
        let known = UNIT_SPELLINGS.iter().find(|(other, _)| other == token);
        match known {
            Some((_, words)) => words.iter().map(|&word| word.to_owned()).collect(),
            None => vec![token.clone()],
        }
    });
    let words = with_divisions(spelled.collect());
    let mut dimension = [0; BASES];
    let (mut is_divisor, mut is_root, mut is_open) = (false, false, true);
    for word in &words {
        match word.as_str() {
            "per" => (is_divisor, is_open) = (true, true),
            "sqrt" => (is_root, is_open) = (true, true),
            word => {
                let power = word.chars().last()?.to_digit(10);
                let name = word.trim_end_matches(|c: char| c.is_ascii_digit());
                let (index, own) = base(name)?;
                let power = i8::try_from(power.unwrap_or(1)).ok()?;
                let halves = if is_root { 1 } else { 2 };
                let sign = if is_divisor { -1 } else { 1 };
                dimension[index] += sign * own * power * halves;
                (is_divisor, is_root, is_open) = (false, false, false);
            }
        }
    }
    (!is_open).then_some(Unit { words, dimension })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_words_and_a_unit() {
        let walk = Quantity::of("rate_random_walk_deg_per_h_per_sqrt_h");
        assert_eq!(walk.words, ["random", "rate", "walk"]);
        let unit = walk.unit.unwrap();
        assert_eq!(&unit.dimension[..2], [2, -3]);
        assert!(Quantity::of("group_index").unit.is_none());
        assert_eq!(Quantity::of("gate_duty").words, ["duty", "gate"]);
        assert_eq!(Quantity::of("index_per_k").words, ["index"]);
        assert_eq!(Quantity::of("max").words, ["max"], "a name is no unit");
    }

    #[test]
    fn one_unit_is_told_in_another() {
        let told = |one, other| conversion(one, other).unwrap_or_default();
        assert_eq!(
            told("mean_deg_per_s", "mean_deg_per_h"),
            "1 deg/s is 3600 deg/h"
        );
        assert_eq!(told("delay_ms", "delay_s"), "1 ms is 0.001 s");
        assert_eq!(told("length_km", "length_m"), "1 km is 1000 m");
        assert_eq!(
            told("walk_deg_per_sqrt_h", "walk_deg_per_h_per_sqrt_hz"),
            "1 deg/sqrt(h) is 60 deg/h/sqrt(hz)"
        );
        assert_eq!(told("clock_khz", "clock_mhz"), "1 khz is 0.001 mhz");
        assert_eq!(conversion("bias_dph", "bias_deg_per_h"), None);
        assert_eq!(conversion("start_s", "start_m"), None);
        assert_eq!(conversion("gain", "gain_percent"), None);
    }

    #[test]
    fn spellings_of_one_unit_are_one() {
        for (one, other) in [
            ("arw_deg_per_rt_hr", "angle_random_walk_deg_per_sqrt_h"),
            ("bias_dph", "bias_deg_per_h"),
            ("bias_deg_h", "bias_deg_per_h"),
            ("warmup_sec", "warm_up_s"),
            (
                "walk_random_angle_deg_per_sqrthr",
                "angle_random_walk_deg_per_sqrt_h",
            ),
        ] {
            assert_eq!(Quantity::of(one), Quantity::of(other));
        }
        let dimension = |name| Quantity::of(name).unit.map(|unit| unit.dimension);
        assert_eq!(dimension("clock_hz"), dimension("clock_mhz"));
        assert_ne!(dimension("start_s"), dimension("start_c"));
        assert_ne!(
            dimension("bias_deg_per_h"),
            dimension("bias_deg_per_h_per_h")
        );
    }
}
