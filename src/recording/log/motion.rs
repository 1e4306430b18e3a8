//! What the gyro did while a log was taken, in a word.

use std::fmt;
use std::str::FromStr;

use crate::declare::spelled;

/// Swing frequencies that a log can hold, Hz: one cycle in eleven days to a quarter of the fastest rate.
const SWING_HZ: (f64, f64) = (1e-6, 2.5e8);

/// What the gyro did while the log was taken.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum LogMotion {
    /// It rested, or turned at a constant rate.
    #[default]
    Static,
    /// It swung.
    Swing {
        /// Swing frequency, Hz.
        frequency_hz: f64,
    },
    /// It was turned at rates held one after the other, which the reference shows.
    Dwells,
}

/// A motion of a log that nobody knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "expected `static`, `dwells`, or `swing:F` with a frequency F from {:e} to {:e} Hz",
    SWING_HZ.0,
    SWING_HZ.1
)]
pub struct UnknownLogMotion;

impl FromStr for LogMotion {
    type Err = UnknownLogMotion;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let (least, most) = SWING_HZ;
        match text {
            "static" => return Ok(Self::Static),
            "dwells" => return Ok(Self::Dwells),
            _ => {}
        }
        let frequency = text.strip_prefix("swing:").map(str::parse::<f64>);
        match frequency {
            Some(Ok(frequency_hz)) if (least..=most).contains(&frequency_hz) => {
                Ok(Self::Swing { frequency_hz })
            }
            _ => Err(UnknownLogMotion),
        }
    }
}

impl fmt::Display for LogMotion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Static => f.write_str("static"),
            Self::Dwells => f.write_str("dwells"),
            Self::Swing { frequency_hz } => write!(f, "swing:{frequency_hz}"),
        }
    }
}

spelled!(LogMotion);
