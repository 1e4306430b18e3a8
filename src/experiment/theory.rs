//! Closed forms of the gyro that the pictures draw beside the measured points.

use crate::gyro::{self, GyroError};
use crate::scenario::{MotionConfig, Scenario};
use crate::signal::{TheoryCurve, TheoryQuantity};
use crate::units::{gain_to_db, rad_to_deg};

/// Points of a line, equally spaced by the logarithm of the frequency.
const POINTS: u32 = 200;

/// The lines of theory for the motion of a scenario; none where there is no closed form.
pub(super) fn theory(scenario: &Scenario) -> Result<Vec<TheoryCurve>, GyroError> {
    match &scenario.turntable.motion {
        MotionConfig::MultiSine(multi_sine) => {
            let tones = &multi_sine.frequencies_hz;
            let (Some(&low), Some(&high)) = (tones.first(), tones.last()) else {
                return Ok(Vec::new());
            };
            let part = |point: u32| f64::from(point) / f64::from(POINTS - 1);
            let frequencies_hz: Vec<f64> = (0..POINTS)
                .map(|point| low * (high / low).powf(part(point)))
                .collect();
            let response = gyro::word_response(&scenario.gyro, &frequencies_hz)?;
            let line = |quantity, y: Vec<f64>| TheoryCurve {
                name: "raw, theory",
                quantity,
                x: frequencies_hz.clone(),
                y,
            };
            let gain = response.iter().map(|(gain, _)| gain_to_db(*gain)).collect();
            let phase = response
                .iter()
                .map(|(_, phase)| rad_to_deg(*phase))
                .collect();
            Ok(vec![
                line(TheoryQuantity::GainDb, gain),
                line(TheoryQuantity::PhaseDeg, phase),
            ])
        }
        _ => Ok(Vec::new()),
    }
}
