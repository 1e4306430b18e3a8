//! A campaign calibrated at the sensor's rate: the samples of a simulation with the rate its encoder shows.

use super::groups::at_rest;
use crate::calibration::{
    Calibration, CalibrationError, GroupObservation, RateSample, SampleSettings, estimate_samples,
};
use crate::experiment::run::{Simulation, axis_index};
use crate::gyro::{self, coil_temperatures_c};
use crate::scenario::{CampaignConfig, CampaignGroup, Scenario};
use crate::units::{deg_per_h_to_deg_per_s, rad_per_s_to_deg_per_s};

/// Part of a pause for a new mounting that is left out, about its middle: the table rests there, and the axis
/// along it changes.
const REMOUNTING: f64 = 0.25;

/// Change of the temperature from which the biases have coefficients of it, K.
const TEMPERATURE_CHANGE_MIN_K: f64 = 1.0;

/// A stretch of samples in one mounting, and the Earth's rate in it.
struct Mounted {
    /// First sample, and the one behind the last.
    samples: std::ops::Range<usize>,
    /// Case axis along the table.
    axis: usize,
    earth: EarthOfAngle,
}

/// Earth rate about the case axes of a table at rest by its angle, deg/s: `mean + cosine cos + sine sin`.
struct EarthOfAngle {
    mean: [f64; 3],
    cosine: [f64; 3],
    sine: [f64; 3],
}

impl EarthOfAngle {
    fn of(scenario: &Scenario, group: &CampaignGroup) -> Self {
        let at = |quarters: f64| {
            let angle_rad = quarters * std::f64::consts::FRAC_PI_2;
            at_rest(&scenario.turntable, group, angle_rad)
        };
        let (start, quarter, half) = (at(0.0), at(1.0), at(2.0));
        let mean: [f64; 3] = std::array::from_fn(|axis| 0.5 * (start[axis] + half[axis]));
        Self {
            mean,
            cosine: std::array::from_fn(|axis| start[axis] - mean[axis]),
            sine: std::array::from_fn(|axis| quarter[axis] - mean[axis]),
        }
    }

    fn at(&self, angle_rad: f64) -> [f64; 3] {
        let (sine, cosine) = angle_rad.sin_cos();
        std::array::from_fn(|axis| {
            self.mean[axis] + self.cosine[axis] * cosine + self.sine[axis] * sine
        })
    }
}

/// Calibrates a simulated campaign by every sample of it.
///
/// The rate of a sample is the difference of the readings at its ends, the Earth's that at the angle between
/// them. Errors of axis and mounting are not known, as for the group means.
///
/// # Errors
/// [`CalibrationError::NoEncoder`] without readings; as [`estimate_samples`].
pub(super) fn calibrate_samples(
    scenario: &Scenario,
    campaign: &CampaignConfig,
    simulation: &Simulation,
    (first, groups): (usize, &[GroupObservation]),
) -> Result<Calibration, CalibrationError> {
    let encoder_rad = simulation.encoder_rad.as_deref();
    let encoder_rad = encoder_rad.ok_or(CalibrationError::NoEncoder)?;
    let sample_period_s = gyro::sample_period_s(&scenario.gyro);
    let threshold = scenario.calibration.outlier_threshold;
    let settings = SampleSettings {
        sample_period_s,
        reference_temperature_c: scenario.gyro.thermal.reference_c,
        fits_temperature: true,
        outlier_threshold: (threshold > 0.0).then_some(threshold),
    };
    let words: Vec<&[f64]> = simulation
        .gyros
        .iter()
        .map(|it| &it.raw_deg_per_h[..])
        .collect();
    let temperature_c = {
        let samples = u32::try_from(encoder_rad.len()).unwrap_or(u32::MAX);
        coil_temperatures_c(&scenario.gyro, sample_period_s, sample_period_s, samples)
    };
    let rate = |index: usize| {
        rad_per_s_to_deg_per_s((encoder_rad[index] - encoder_rad[index - 1]) / sample_period_s)
    };
    let mut samples = Vec::new();
    for mounted in mountings(scenario, campaign, first, encoder_rad.len()) {
        // Differences reach a sample back and one on.
        let inner = mounted.samples.start.max(1)..mounted.samples.end.saturating_sub(1);
        for index in inner {
            let middle_rad = 0.5 * (encoder_rad[index] + encoder_rad[index - 1]);
            let mut rate_deg_per_s = mounted.earth.at(middle_rad);
            rate_deg_per_s[mounted.axis] += rate(index);
            let mut acceleration_deg_per_s2 = [0.0; 3];
            let change = 0.5 * (rate(index + 1) - rate(index.max(2) - 1));
            acceleration_deg_per_s2[mounted.axis] = change / sample_period_s;
            samples.push(RateSample {
                rate_deg_per_s,
                acceleration_deg_per_s2,
                temperature_c: temperature_c[index],
                output_deg_per_s: std::array::from_fn(|gyro| {
                    deg_per_h_to_deg_per_s(words[gyro][index])
                }),
            });
        }
    }
    let warmths = samples.iter().map(|sample| sample.temperature_c);
    let low = warmths.clone().fold(f64::INFINITY, f64::min);
    let high = warmths.fold(f64::NEG_INFINITY, f64::max);
    let settings = SampleSettings {
        fits_temperature: high - low >= TEMPERATURE_CHANGE_MIN_K,
        ..settings
    };
    estimate_samples(&samples, groups, &settings)
}

/// The stretches of one mounting each, with what is between two left out.
fn mountings(
    scenario: &Scenario,
    campaign: &CampaignConfig,
    first: usize,
    samples: usize,
) -> Vec<Mounted> {
    let period_s = gyro::sample_period_s(&scenario.gyro);
    let at = |time_s: f64| first + whole(time_s / period_s);
    let half_s = 0.5 * REMOUNTING * campaign.remount_s;
    let mut stretches: Vec<Mounted> = Vec::new();
    for group in campaign.groups() {
        let is_new = stretches.is_empty() || group.is_remounted;
        if !is_new {
            continue;
        }
        let mut start = first;
        if let Some(before) = stretches.last_mut() {
            let middle_s = group.start_s - 0.5 * campaign.remount_s;
            before.samples.end = at(middle_s - half_s).min(samples);
            start = at(middle_s + half_s) + 1;
        }
        stretches.push(Mounted {
            samples: start..samples,
            axis: axis_index(group.axis),
            earth: EarthOfAngle::of(scenario, &group),
        });
    }
    stretches
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a time within the record over the sample period"
)]
fn whole(count: f64) -> usize {
    count.max(0.0).floor() as usize
}
