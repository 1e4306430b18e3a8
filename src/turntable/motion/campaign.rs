//! A calibration campaign: constant rates, smooth changes between them, stops to mount anew.

use super::course::Instant;
use super::samples::first_measured_index;
use super::soft_start::SoftStart;
use crate::scenario::{CampaignConfig, CaseAxis};
use crate::units::deg_per_s_to_rad_per_s;

/// The command of a campaign.
///
/// Rates follow one another along raised cosines, so that rate and acceleration are continuous and
/// the loop of the gyro follows. A change of rate takes the middle half of its pause. To mount the
/// case anew the table stops in a quarter of the pause, rests for the quarter in its middle and runs
/// up in another, which leaves an eighth at either end. The first rate is reached inside the warm-up.
#[derive(Clone, Debug)]
pub(super) struct Campaign {
    ramps: Vec<Ramp>,
    sample_period_s: f64,
}

/// A change from one rate to another.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Ramp {
    /// s from the start of the record, negative in the warm-up.
    start_s: f64,
    length_s: f64,
    /// rad/s.
    from: f64,
    to: f64,
}

impl Campaign {
    pub(super) fn new(config: &CampaignConfig, warm_up_s: f64, sample_period_s: f64) -> Self {
        let first = first_measured_index(warm_up_s, sample_period_s) as f64 * sample_period_s;
        let mut ramps = ramps(config, first);
        for ramp in &mut ramps {
            ramp.start_s += first;
        }
        Self {
            ramps,
            sample_period_s,
        }
    }

    /// Command at `instant` samples from the start.
    pub(super) fn at(&self, instant: f64) -> Instant {
        let time_s = instant * self.sample_period_s;
        let begun = self.ramps.partition_point(|ramp| ramp.start_s <= time_s);
        let Some(ramp) = begun.checked_sub(1).map(|last| self.ramps[last]) else {
            return Instant::REST;
        };
        let rise = SoftStart::of(ramp.length_s, self.sample_period_s);
        let (share, slope) = rise.at((time_s - ramp.start_s) / self.sample_period_s);
        Instant {
            rate: ramp.from + share * (ramp.to - ramp.from),
            slope: slope * (ramp.to - ramp.from),
        }
    }
}

/// Every change of rate in order, times from the start of the record; the first is the run-up, of no
/// length without a warm-up.
fn ramps(config: &CampaignConfig, warm_up_s: f64) -> Vec<Ramp> {
    let mut rate = 0.0;
    let mut ramps = Vec::new();
    for (index, group) in config.groups().iter().enumerate() {
        let next = deg_per_s_to_rad_per_s(group.rate_deg_per_s);
        let mut push = |start_s: f64, length_s: f64, to: f64| {
            let from = std::mem::replace(&mut rate, to);
            ramps.push(Ramp {
                start_s,
                length_s,
                from,
                to,
            });
        };
        let pause_s = config.pause_s(group.is_remounted);
        let pause_start_s = group.start_s - pause_s;
        if index == 0 {
            push(-warm_up_s, warm_up_s.min(0.5 * config.change_s), next);
        } else if group.is_remounted {
            push(pause_start_s + 0.125 * pause_s, 0.25 * pause_s, 0.0);
            push(pause_start_s + 0.625 * pause_s, 0.25 * pause_s, next);
        } else {
            push(pause_start_s + 0.25 * pause_s, 0.5 * pause_s, next);
        }
    }
    ramps
}

/// Table angle at the start of each group of a campaign, rad from the start of the warm-up, whole
/// turns included.
///
/// * `warm_up_s`: time before the record, a whole number of samples.
#[must_use]
pub fn campaign_angles_rad(config: &CampaignConfig, warm_up_s: f64) -> Vec<f64> {
    let ramps = ramps(config, warm_up_s);
    let groups = config.groups();
    let angle_at = |time_s: f64| -> f64 {
        let mut angle = 0.0;
        for (index, ramp) in ramps.iter().enumerate() {
            let next_s = ramps
                .get(index + 1)
                .map_or(f64::INFINITY, |next| next.start_s);
            let end_s = ramp.start_s + ramp.length_s;
            let held_until_s = next_s.min(time_s);
            if held_until_s >= end_s {
                angle += 0.5 * (ramp.from + ramp.to) * ramp.length_s;
                angle += ramp.to * (held_until_s - end_s);
            }
        }
        angle
    };
    groups.iter().map(|group| angle_at(group.start_s)).collect()
}

/// Largest jump of the rate at the start, rad/s, and largest acceleration of a campaign, rad/s^2.
pub(super) fn campaign_extremes(config: &CampaignConfig, warm_up_s: f64) -> (f64, f64) {
    let mut extremes = (0.0_f64, 0.0_f64);
    for ramp in ramps(config, warm_up_s) {
        let rise = (ramp.to - ramp.from).abs();
        if ramp.length_s > 0.0 {
            // The slope of a raised cosine is largest in its middle.
            let slope = std::f64::consts::FRAC_PI_2 * rise / ramp.length_s;
            extremes.1 = extremes.1.max(slope);
        } else {
            extremes.0 = extremes.0.max(rise);
        }
    }
    extremes
}

/// The sample before which each new mounting holds: the middle of its pause.
pub(in crate::turntable) fn remountings(
    config: &CampaignConfig,
    warm_up_s: f64,
    sample_period_s: f64,
) -> Vec<(u64, CaseAxis)> {
    let first = first_measured_index(warm_up_s, sample_period_s);
    let groups = config.groups();
    let remounted = groups.iter().filter(|group| group.is_remounted);
    remounted
        .map(|group| {
            let middle_s = group.start_s - 0.5 * config.remount_s;
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a rounded count of samples, after a group and so not negative"
            )]
            let after = (middle_s / sample_period_s).round() as u64;
            (first + after, group.axis)
        })
        .collect()
}
