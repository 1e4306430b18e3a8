//! Closed forms of the gyro that the pictures draw beside the measured points.

use crate::gyro::{self, GyroError};
use crate::scenario::{Scenario, Stairs};
use crate::signal::{TheoryCurve, TheoryQuantity};
use crate::turntable::{MotionClass, earth_rate_rad_per_s};
use crate::units::{deg_per_s_to_rad_per_s, gain_to_db, rad_per_s_to_deg_per_h, rad_to_deg};

/// Points of a line, equally spaced by the logarithm of the frequency.
const POINTS: u32 = 200;
/// Points of a line over the rates of a staircase, equally spaced: the edge of a dead band is steep.
const RATE_POINTS: u32 = 1000;
/// Error over the span of the rates below which a response is a straight line but for rounding.
const ERROR_MIN: f64 = 1e-9;
/// Name in the legend.
const NAME: &str = "raw, theory";

/// The lines of theory for the motion of a scenario; none where there is no closed form.
pub(crate) fn theory(scenario: &Scenario) -> Result<Vec<TheoryCurve>, GyroError> {
    match scenario.measured_motion().class() {
        MotionClass::MultiSine {
            frequencies_hz: tones,
        } => {
            let (Some(&low), Some(&high)) = (tones.first(), tones.last()) else {
                return Ok(Vec::new());
            };
            let part = |point: u32| f64::from(point) / f64::from(POINTS - 1);
            let frequencies_hz: Vec<f64> = (0..POINTS)
                .map(|point| low * (high / low).powf(part(point)))
                .collect();
            let response = gyro::word_response(&scenario.gyro, &frequencies_hz)?;
            let line = |quantity, y: Vec<f64>| TheoryCurve {
                name: NAME,
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
        MotionClass::Steps(stairs) => Ok(rate_error(scenario, &stairs).into_iter().collect()),
        _ => Ok(Vec::new()),
    }
}

/// Mean error of the rate word over the rates of a staircase, in the temperature of the start.
///
/// None for an assembly, whose axes see other rates, nor for a gyro without systematic error.
fn rate_error(scenario: &Scenario, stairs: &Stairs) -> Option<TheoryCurve> {
    if scenario.gyro.assembly.is_some() {
        return None;
    }
    let earth_rate = earth_rate_rad_per_s(&scenario.turntable.site);
    let rates = stairs.rates_deg_per_s.iter();
    let (low, high) = rates
        .map(|&rate| earth_rate + deg_per_s_to_rad_per_s(rate))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), rate| {
            (low.min(rate), high.max(rate))
        });
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for point in 0..RATE_POINTS {
        let rate = low + (high - low) * f64::from(point) / f64::from(RATE_POINTS - 1);
        let mean = gyro::expected_mean_rate_rad_per_s(&scenario.gyro, rate);
        x.push(rad_per_s_to_deg_per_h(rate));
        y.push(rad_per_s_to_deg_per_h(mean - rate));
    }
    let error_min = ERROR_MIN * rad_per_s_to_deg_per_h(high - low);
    y.iter()
        .any(|error| error.abs() > error_min)
        .then_some(TheoryCurve {
            name: NAME,
            quantity: TheoryQuantity::RateErrorDegPerH,
            x,
            y,
        })
}
