//! What a gyro makes of rates and sines, noise left out.

use crate::experiment::infer::geometry::Staircase;
use crate::gyro;
use crate::metrics::KnownSine;
use crate::scenario::{MotionClass, MotionConfig, Scenario};
use crate::turntable::earth_rate_rad_per_s;
use crate::units::rad_per_s_to_deg_per_h;

/// Frequencies at which a bandwidth is looked for, and the range over that of the lowest sine.
const BANDWIDTH_POINTS: u32 = 96;

/// Error of the scale factor and largest distance from the line over the full scale, noise left out.
pub(super) fn line(scenario: &Scenario, staircase: &Staircase) -> (f64, f64) {
    let earth = earth_rate_rad_per_s(&scenario.turntable.site);
    let rates = &staircase.rates_rad_per_s;
    let outputs: Vec<f64> = rates
        .iter()
        .map(|rate| gyro::expected_mean_rate_rad_per_s(&scenario.gyro, earth + rate))
        .collect();
    let count = rates.len() as f64;
    let (mean_in, mean_out) = (
        rates.iter().sum::<f64>() / count,
        outputs.iter().sum::<f64>() / count,
    );
    let (mut square, mut product) = (0.0, 0.0);
    for (rate, output) in rates.iter().zip(&outputs) {
        square += (rate - mean_in).powi(2);
        product += (rate - mean_in) * (output - mean_out);
    }
    let slope = product / square;
    let full = outputs
        .iter()
        .fold(0.0_f64, |most, output| most.max(output.abs()));
    let largest = rates
        .iter()
        .zip(&outputs)
        .map(|(rate, output)| (output - mean_out - slope * (rate - mean_in)).abs())
        .fold(0.0, f64::max);
    (slope - 1.0, largest / full)
}

/// Where the gain of the words first falls through 1/sqrt(2) of that of the lowest sine.
pub(super) fn bandwidth_hz(scenario: &Scenario) -> Option<f64> {
    let motion = scenario.measured_motion();
    let MotionClass::MultiSine { frequencies_hz } = motion.class() else {
        return None;
    };
    let (low, high) = (*frequencies_hz.first()?, *frequencies_hz.last()?);
    let ratio = (high / low).ln() / f64::from(BANDWIDTH_POINTS - 1);
    let grid: Vec<f64> = (0..BANDWIDTH_POINTS)
        .map(|point| low * (ratio * f64::from(point)).exp())
        .collect();
    let response = gyro::word_response(&scenario.gyro, &grid).ok()?;
    let limit = response.first()?.0 / std::f64::consts::SQRT_2;
    let beyond = response.iter().position(|(gain, _)| *gain < limit)?.max(1);
    let [(above, _), (below, _)] = [response[beyond - 1], response[beyond]];
    let part = (above - limit) / (above - below);
    Some(grid[beyond - 1] + part * (grid[beyond] - grid[beyond - 1]))
}

/// The sine that a swing puts into the words.
pub(super) fn sine(scenario: &Scenario) -> Option<KnownSine> {
    let MotionConfig::Swing(swing) = &scenario.turntable.motion else {
        return None;
    };
    let frequency_hz = swing.frequency_hz;
    let response = gyro::word_response(&scenario.gyro, &[frequency_hz]).ok()?;
    Some(KnownSine {
        amplitude_deg_per_h: rad_per_s_to_deg_per_h(swing.rate_amplitude_rad_per_s())
            * response.first()?.0,
        frequency_hz,
    })
}
