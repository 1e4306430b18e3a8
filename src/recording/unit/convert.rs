//! From the numbers of a column to rates: what the options and its heading say of their unit.

use super::kinds::{AngleUnit, LogUnit, Per, RateUnit};
use super::spelling::Spelled;
use crate::recording::column::Column;
use crate::recording::layout::words::{HeadingUnits, WordKind};
use crate::recording::log::format::LogFormat;
use crate::recording::text::lines::shown;

/// Sizes of the units that one count stands for.
const SCALE: (f64, f64) = (1e-30, 1e30);

/// How numbers become rates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::recording) struct Conversion {
    /// Unit of a rate, or of the angle turned in a sample.
    pub(in crate::recording) unit: RateUnit,
    /// The unit of a running angle whose differences are those angles.
    pub(in crate::recording) running: Option<AngleUnit>,
    pub(in crate::recording) scale: f64,
    pub(in crate::recording) offset: f64,
}

/// Why the unit of a column is not known, or in doubt.
#[derive(Debug, thiserror::Error)]
pub(in crate::recording) enum UnitError {
    #[error("the unit of the numbers is not known: give --unit, such as deg/s")]
    Unknown,
    #[error(
        "column {column} is in {heading} by its heading, --unit says {given}: leave --unit out, or say \
         --heading-units ignore"
    )]
    Contradiction {
        column: String,
        heading: String,
        given: LogUnit,
    },
    #[error(
        "column {0} holds counts by its heading: --scale says how many units one stands for (1, if it is in \
         that unit)"
    )]
    Counts(String),
    #[error(
        "{0} is an angle: --kind angle if it runs on, --kind increment if each number is what was turned in \
         a sample"
    )]
    AngleOfWhat(AngleUnit),
    #[error("--kind {kind} needs a unit of angle such as deg, arcsec, rad: {unit} is a rate")]
    RateAsAngle { kind: WordKind, unit: RateUnit },
    #[error("--kind rate needs a unit of rate such as deg/s: {0} is none")]
    AngleAsRate(LogUnit),
    #[error(
        "--scale {0:?} is out of range: expected a number from {least:e} to {most:e}, or the negative of such a \
         number",
        least = SCALE.0,
        most = SCALE.1
    )]
    Scale(f64),
}

impl UnitError {
    /// Key of `[log]`, or option, that says what cannot be, if one does.
    pub(in crate::recording) fn key(&self) -> Option<&'static str> {
        match self {
            Self::Contradiction { .. } | Self::AngleOfWhat(_) => Some("unit"),
            Self::RateAsAngle { .. } | Self::AngleAsRate(_) => Some("kind"),
            Self::Scale(_) => Some("scale"),
            _ => None,
        }
    }
}

impl Conversion {
    /// What the options say, held against the heading of a column.
    ///
    /// # Errors
    /// No unit, or two that contradict each other; a kind of number that the unit is not of.
    pub(in crate::recording) fn of(format: &LogFormat, column: &Column) -> Result<Self, UnitError> {
        let scale = format.scale.unwrap_or(1.0);
        if !(SCALE.0..=SCALE.1).contains(&scale.abs()) {
            return Err(UnitError::Scale(scale));
        }
        let heading = match format.heading_units {
            Some(HeadingUnits::Ignore) => None,
            _ => column.unit,
        };
        let name = || shown(column.name.as_deref().unwrap_or_default());
        let in_heading = match heading {
            Some(Spelled::Rate(unit)) => Some(LogUnit::Rate(unit)),
            Some(Spelled::Angle(unit)) => Some(LogUnit::Angle(unit)),
            Some(Spelled::Counts) if format.scale.is_none() => {
                return Err(UnitError::Counts(name()));
            }
            _ => None,
        };
        let unit = match (format.unit, in_heading) {
            (None, None) => return Err(UnitError::Unknown),
            (None, Some(unit)) | (Some(unit), None) => unit,
            (Some(given), Some(heading)) if agree(given, heading) => given,
            (Some(given), Some(heading)) => {
                return Err(UnitError::Contradiction {
                    column: name(),
                    heading: heading.to_string(),
                    given,
                });
            }
        };
        let (unit, running) = kind(unit, format.kind)?;
        Ok(Self {
            unit,
            running,
            scale,
            offset: format.offset.unwrap_or(0.0),
        })
    }

    /// The unit as it is given.
    pub(in crate::recording) fn given(&self) -> LogUnit {
        match self.running {
            Some(angle) => LogUnit::Angle(angle),
            None => LogUnit::Rate(self.unit),
        }
    }

    /// What a number is.
    pub(in crate::recording) fn kind(&self) -> WordKind {
        match (self.running, self.unit.per) {
            (Some(_), _) => WordKind::Angle,
            (None, Per::Sample) => WordKind::Increment,
            (None, _) => WordKind::Rate,
        }
    }

    /// The unit as it is shown.
    pub(in crate::recording) fn shown(&self) -> String {
        match self.running {
            Some(angle) => format!("{angle} of a running angle"),
            None => self.unit.to_string(),
        }
    }

    /// Rate that a number, or a difference of numbers, stands for, deg/h.
    pub(in crate::recording) fn rate_deg_per_h(&self, number: f64, sample_rate_hz: f64) -> f64 {
        // An offset of nothing leaves a rate its sign and bits.
        let offset = if self.running.is_some() {
            0.0
        } else {
            self.offset
        };
        let scaled = number * self.scale;
        let in_unit = if offset.abs() > 0.0 {
            scaled + offset
        } else {
            scaled
        };
        self.unit.to_deg_per_h(in_unit, sample_rate_hz)
    }
}

/// Whether two units are one: increments a sample of an angle are told from the angle by the kind alone.
fn agree(given: LogUnit, heading: LogUnit) -> bool {
    let angle = |unit: LogUnit| match unit {
        LogUnit::Angle(angle) => Some(angle),
        LogUnit::Rate(RateUnit {
            angle,
            per: Per::Sample,
        }) => Some(angle),
        LogUnit::Rate(_) => None,
    };
    given == heading || (angle(given).is_some() && angle(given) == angle(heading))
}

/// The unit of a rate or an increment, and that of a running angle.
fn kind(unit: LogUnit, kind: Option<WordKind>) -> Result<(RateUnit, Option<AngleUnit>), UnitError> {
    match (unit, kind) {
        (LogUnit::Angle(angle), None) => Err(UnitError::AngleOfWhat(angle)),
        (LogUnit::Angle(angle), Some(WordKind::Increment)) => Ok((angle.per(Per::Sample), None)),
        (LogUnit::Angle(angle), Some(WordKind::Angle)) => Ok((angle.per(Per::Sample), Some(angle))),
        (LogUnit::Rate(unit), Some(WordKind::Increment)) if unit.per == Per::Sample => {
            Ok((unit, None))
        }
        (LogUnit::Rate(unit), Some(WordKind::Rate)) if unit.per == Per::Sample => {
            Err(UnitError::AngleAsRate(LogUnit::Rate(unit)))
        }
        (LogUnit::Rate(unit), None | Some(WordKind::Rate)) => Ok((unit, None)),
        (LogUnit::Rate(unit), Some(kind)) => Err(UnitError::RateAsAngle { kind, unit }),
        (LogUnit::Angle(angle), Some(WordKind::Rate)) => {
            Err(UnitError::AngleAsRate(LogUnit::Angle(angle)))
        }
    }
}
