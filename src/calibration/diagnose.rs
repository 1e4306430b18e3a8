//! What is wrong with data that do not fit the stated motion.
//!
//! A gyro of any use sees the rate about its axis to a few percent and cross rates to a few mrad. The
//! group means of a turning table therefore tell mistakes of bookkeeping from errors of the gyro
//! before anything is estimated. With the stated rate `W_s` about axis s and the largest output
//! `Wm_g` of gyro g:
//!
//! | what is found | what it means |
//! |---|---|
//! | g is not s | the columns or the mountings are swapped |
//! | `Wm_g / W_s` near -1 | the sense is reversed; least squares would put K_G near -2 |
//! | `Wm_g / W_s` near a ratio of units | outputs or rates are in another unit than stated |
//! | no `W_s` for one s | a mounting is missing |
//!
//! Least squares over such data does not fail, it gives wrong numbers: one reversed group of nine at
//! 10 deg/s leaves a scale-factor error of a few percent, which a poor gyro might have. That is why
//! this comes first.

use std::f64::consts::PI;
use std::fmt;

use super::error::AXES;
use super::observations::GroupObservation;

/// Largest scale-factor error that is taken for one; beyond it the data are refused.
pub const SCALE_ERROR_MAX: f64 = 0.1;

/// Groups slower than this part of the fastest say too little to judge: their biases, horizontal
/// Earth rate and the cross rates of a tilted table are no longer small against the rate.
const RATE_SHARE_MIN: f64 = 0.01;

/// Ratios of output to reference that a mistaken unit makes, and how to say so.
const UNITS: [(f64, &str); 9] = [
    (
        3600.0,
        "the outputs look like deg/h or arcsec/s where deg/s is expected",
    ),
    (
        1.0 / 3600.0,
        "the reference rates look like deg/h where deg/s is expected",
    ),
    (
        PI / 180.0,
        "the outputs look like rad/s where deg/s is expected",
    ),
    (
        180.0 / PI,
        "the reference rates look like rad/s where deg/s is expected",
    ),
    (
        PI * 20.0,
        "the outputs look like rad/h where deg/s is expected",
    ),
    (
        1000.0,
        "the outputs look like mdeg/s where deg/s is expected",
    ),
    (
        0.001,
        "the reference rates look like mdeg/s where deg/s is expected",
    ),
    (
        6.0,
        "the reference rates look like turns per minute where deg/s is expected",
    ),
    (
        1.0 / 6.0,
        "the outputs look like turns per minute where deg/s is expected",
    ),
];

/// Which groups a finding belongs to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Scope {
    /// All groups that turn fast enough to judge.
    All,
    /// All groups of the mounting that turns about this case axis, 0 to 2.
    Mounting(usize),
    /// Single groups, counted from 1.
    Groups(Vec<usize>),
}

impl fmt::Display for Scope {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::All => write!(out, "in all groups"),
            Self::Mounting(axis) => write!(out, "in the mounting that turns about {}", AXES[*axis]),
            Self::Groups(groups) => {
                let numbers: Vec<String> = groups.iter().map(ToString::to_string).collect();
                write!(out, "in group {}", numbers.join(", "))
            }
        }
    }
}

/// Something wrong with the groups; [`fmt::Display`] says it in words.
#[derive(Clone, Debug, PartialEq)]
pub enum Finding {
    /// No group turns about this case axis, 0 to 2.
    MountingMissing(usize),
    /// Outputs have the other sign than the reference.
    ReversedSense(Scope),
    /// The gyro that turns is not the one that should.
    SwappedAxes {
        /// Case axis of the reference.
        stated: usize,
        /// Gyro that sees the rate.
        seen: usize,
        /// Where.
        scope: Scope,
    },
    /// Output over reference is a known ratio of units.
    WrongUnit {
        /// The known ratio.
        ratio: f64,
        /// Where.
        scope: Scope,
    },
    /// Output over reference is far from 1 and of no known ratio.
    UnknownRatio {
        /// Mean ratio.
        ratio: f64,
        /// Where.
        scope: Scope,
    },
}

impl fmt::Display for Finding {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::MountingMissing(axis) => {
                write!(
                    out,
                    "no group turns about {}: a mounting is missing",
                    AXES[*axis]
                )
            }
            Self::ReversedSense(scope) => {
                write!(
                    out,
                    "the sense of rotation is reversed {scope} (scale error near -2)"
                )
            }
            Self::SwappedAxes {
                stated,
                seen,
                scope,
            } => write!(
                out,
                "gyro {} sees the rate stated about {} {scope}: axes or mountings are swapped",
                AXES[*seen], AXES[*stated]
            ),
            Self::WrongUnit { ratio, scope } => {
                let known = UNITS
                    .iter()
                    .find(|(known, _)| (known / ratio - 1.0).abs() < 1e-9);
                let words = known.map_or("the units differ", |(_, words)| words);
                write!(out, "{words} {scope} (ratio {ratio:.4e})")
            }
            Self::UnknownRatio { ratio, scope } => {
                write!(
                    out,
                    "outputs are {ratio:.4e} times the stated rates {scope}"
                )
            }
        }
    }
}

/// What one group says by itself.
struct Sight {
    number: usize,
    stated: usize,
    seen: usize,
    ratio: f64,
}

/// Looks for a missing mounting, a reversed sense, swapped axes and wrong units.
///
/// Each group that turns about mainly one axis, and fast enough that its biases do not matter, is
/// judged by itself; what holds for a whole mounting, or for all groups, is said once.
#[must_use]
pub fn diagnose(groups: &[GroupObservation]) -> Vec<Finding> {
    let fastest = groups
        .iter()
        .flat_map(|group| group.design.reference_rate_deg_per_s)
        .fold(0.0, |most: f64, rate| most.max(rate.abs()));
    let sights: Vec<Sight> = groups
        .iter()
        .enumerate()
        .filter_map(|(index, group)| sight(index + 1, group, fastest))
        .collect();
    let mut findings: Vec<Finding> = (0..3)
        .filter(|axis| {
            !groups.iter().any(|group| {
                group.design.reference_rate_deg_per_s[*axis].abs() > RATE_SHARE_MIN * fastest
            })
        })
        .map(Finding::MountingMissing)
        .collect();
    for (stated, seen) in (0..9)
        .map(|pair| (pair / 3, pair % 3))
        .filter(|(a, b)| a != b)
    {
        let is_one = |sight: &Sight| sight.stated == stated && sight.seen == seen;
        if let Some(scope) = scope(&sights, is_one) {
            findings.push(Finding::SwappedAxes {
                stated,
                seen,
                scope,
            });
        }
    }
    findings.extend(scope(&sights, |sight| sight.ratio < 0.0).map(Finding::ReversedSense));
    findings.extend(UNITS.iter().filter_map(|(ratio, _)| {
        let is_one = |sight: &Sight| {
            unit_ratio(sight.ratio).is_some_and(|known| known.to_bits() == ratio.to_bits())
        };
        scope(&sights, is_one).map(|scope| Finding::WrongUnit {
            ratio: *ratio,
            scope,
        })
    }));
    let is_odd = |sight: &Sight| !near(sight.ratio, 1.0) && unit_ratio(sight.ratio).is_none();
    if let Some(scope) = scope(&sights, is_odd) {
        let odd = || sights.iter().filter(|sight| is_odd(sight));
        #[expect(
            clippy::cast_precision_loss,
            reason = "a count of groups is exact in f64"
        )]
        let ratio = odd().map(|sight| sight.ratio).sum::<f64>() / odd().count() as f64;
        findings.push(Finding::UnknownRatio { ratio, scope });
    }
    findings
}

/// Whether a ratio is a known one, of either sign, as far as a believable scale error goes.
fn near(ratio: f64, known: f64) -> bool {
    (ratio.abs() / known - 1.0).abs() <= SCALE_ERROR_MAX
}

/// The known ratio that a ratio comes closest to, within what a scale error may make of it.
///
/// Two of them, 180/pi and 20 pi, lie within a tenth of each other: only the closer one is meant.
fn unit_ratio(ratio: f64) -> Option<f64> {
    let distance = |known: &f64| (ratio.abs() / known).ln().abs();
    let known = UNITS.iter().map(|(known, _)| *known);
    let likely = known.filter(|known| near(ratio, *known));
    likely.min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

/// What a group says: nothing if it turns about no one axis, or too slowly.
///
/// * `fastest`: largest rate of all groups, deg/s.
fn sight(number: usize, group: &GroupObservation, fastest: f64) -> Option<Sight> {
    let rates = group.design.reference_rate_deg_per_s;
    let stated = main_axis(rates)?;
    let seen = main_axis(group.output_deg_per_s)?;
    (rates[stated].abs() > RATE_SHARE_MIN * fastest).then(|| Sight {
        number,
        stated,
        seen,
        ratio: group.output_deg_per_s[seen] / rates[stated],
    })
}

/// The axis of the largest value, if the others are below a third of it.
fn main_axis(values: [f64; 3]) -> Option<usize> {
    (0..3).find(|axis| {
        let others = (0..3).filter(|other| other != axis);
        let most = others.map(|other| values[other].abs()).fold(0.0, f64::max);
        values[*axis].abs() > 3.0 * most
    })
}

/// The widest scope that holds exactly the sights in question; none if there are none.
fn scope(sights: &[Sight], is_one: impl Fn(&Sight) -> bool) -> Option<Scope> {
    let found: Vec<&Sight> = sights.iter().filter(|sight| is_one(sight)).collect();
    let first = found.first()?;
    if found.len() == sights.len() {
        return Some(Scope::All);
    }
    let mounting = sights.iter().filter(|sight| sight.stated == first.stated);
    let is_same = found.iter().all(|sight| sight.stated == first.stated);
    if is_same && mounting.count() == found.len() {
        return Some(Scope::Mounting(first.stated));
    }
    Some(Scope::Groups(
        found.iter().map(|sight| sight.number).collect(),
    ))
}
