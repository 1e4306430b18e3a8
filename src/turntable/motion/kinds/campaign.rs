//! A calibration campaign: constant rates, smooth changes between them, stops to mount anew.

use std::sync::Arc;

use crate::declare::table;
use crate::turntable::motion::checks::{MotionChecks, SAMPLES_PER_RAMP_MIN, TIME_SLACK};
use crate::turntable::motion::course::{Course, Instant};
use crate::turntable::motion::kind::{CommandExtremes, Motion, MotionClass, Surroundings};
use crate::turntable::motion::samples::first_measured_index;
use crate::turntable::motion::soft_start::SoftStart;
use crate::units::deg_per_s_to_rad_per_s;
use crate::vocabulary::CaseAxis;
use crate::wording::number;

table! {
    /// A calibration campaign of a three-axis assembly after patent CN101221046: groups of constant rate
    /// in changing mountings. The table runs at the first rate when the warm-up ends (it runs up inside
    /// the warm-up, without one it jumps), and the first group begins with the record. Between groups of
    /// one mounting the rate changes in the middle half of the pause. To mount the case anew the table
    /// stops and runs up in a quarter of the pause each and rests for a quarter between them, in the middle
    /// of which the axis along the table changes. The Earth's rotation is on the axes all the time. turntable.mounting gives
    /// the misalignment of every mounting. What the groups give stands in `[calibration]`.
    pub struct CampaignConfig,
    beside "[gyro.assembly]"
    {
        /// Case axis along the table axis, one for each group.
        axes: Vec<CaseAxis>, example ["x", "x", "y", "z"];
        /// Rate of the table in each group; 0 is a static position.
        rates_deg_per_s: Vec<f64>, example [10.0, 90.0, 90.0, 90.0], in -2000.0..=2000.0, "deg/s";
        /// Time at each rate; all groups and pauses must fit into the duration. Source of the default: the
        /// patent.
        record_s: f64 = 600.0, in 1e-3..=1e6, "s";
        /// Pause between two rates in one mounting. Source of the default: assumed.
        change_s: f64 = 60.0, in 1e-3..=1e6, "s";
        /// Pause in which the case is mounted anew. Source of the default: assumed.
        remount_s: f64 = 360.0, in 1e-3..=1e6, "s";
        /// Means are taken over the longest whole turns within record_s, over which the horizontal part of
        /// the Earth's rotation averages out; of a static position over all of it. Source of the default:
        /// derived, 600 s at 10 deg/s leave up to 0.21 deg/h.
        whole_turns: bool = true;
    }
}

/// One group of a campaign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CampaignGroup {
    /// Case axis along the table axis.
    pub axis: CaseAxis,
    /// Rate of the table, deg/s.
    pub rate_deg_per_s: f64,
    /// Start of its record, s from the start of the measured time.
    pub start_s: f64,
    /// Length of its record, s.
    pub record_s: f64,
    /// Whether the case is mounted anew in the pause before it.
    pub is_remounted: bool,
}

impl CampaignConfig {
    /// The groups with their times.
    #[must_use]
    pub fn groups(&self) -> Vec<CampaignGroup> {
        let mut start_s = 0.0;
        let mut before: Option<CaseAxis> = None;
        let pairs = self.axes.iter().zip(&self.rates_deg_per_s);
        pairs
            .map(|(&axis, &rate_deg_per_s)| {
                let is_remounted = before.is_some_and(|old| old != axis);
                if before.is_some() {
                    start_s += self.record_s + self.pause_s(is_remounted);
                }
                before = Some(axis);
                CampaignGroup {
                    axis,
                    rate_deg_per_s,
                    start_s,
                    record_s: self.record_s,
                    is_remounted,
                }
            })
            .collect()
    }

    /// Length of the pause before a group, s.
    #[must_use]
    pub fn pause_s(&self, is_remounted: bool) -> f64 {
        if is_remounted {
            self.remount_s
        } else {
            self.change_s
        }
    }

    /// Time from the start of the first group to the end of the last, s.
    #[must_use]
    pub fn length_s(&self) -> f64 {
        let last = self.groups().last().copied();
        last.map_or(0.0, |group| group.start_s + group.record_s)
    }
}

/// Fewest output samples of a group: twenty blocks of two.
const GROUP_SAMPLES_MIN: f64 = 40.0;

const RATES: &str = "turntable.calibration.rates_deg_per_s";

impl Motion for CampaignConfig {
    fn class(&self) -> MotionClass<'_> {
        MotionClass::Campaign(self)
    }

    fn rate_max_rad_per_s(&self) -> f64 {
        let rates = self.rates_deg_per_s.iter().copied();
        rates.fold(0.0, |max, rate| deg_per_s_to_rad_per_s(rate).abs().max(max))
    }

    fn extremes(&self, surroundings: Surroundings) -> CommandExtremes {
        let mut extremes = CommandExtremes::default();
        for ramp in ramps(self, surroundings.warm_up_s) {
            let rise = (ramp.to - ramp.from).abs();
            if ramp.length_s > 0.0 {
                // The slope of a raised cosine is largest in its middle.
                let slope = std::f64::consts::FRAC_PI_2 * rise / ramp.length_s;
                extremes.acceleration_rad_per_s2 = extremes.acceleration_rad_per_s2.max(slope);
            } else {
                extremes.jump_rad_per_s = extremes.jump_rad_per_s.max(rise);
            }
        }
        extremes
    }

    /// Refuses groups without an assembly, of unequal counts, that outlast the record or hold no turn.
    fn check(&self, checks: &mut MotionChecks) {
        if !checks.has_assembly {
            let message =
                "turntable.calibration turns a case with three gyros: give [gyro.assembly]";
            checks.complain("turntable.calibration", message.to_owned());
        }
        let (axes, rates) = (self.axes.len(), self.rates_deg_per_s.len());
        if axes != rates {
            let message = format!(
                "{RATES} has {rates} values, but turntable.calibration.axes has {axes}: give one of \
                 each for every group"
            );
            checks.complain(RATES, message);
            return;
        }
        self.check_length(checks);
        self.check_pauses(checks);
        if self.whole_turns {
            self.check_turns(checks);
        }
    }

    fn is_idle(&self, key: &str, _: f64) -> bool {
        let has_pause = |is_remounting: bool| {
            let groups = self.groups();
            let mut later = groups.iter().skip(1);
            later.any(|group| group.is_remounted == is_remounting)
        };
        match key {
            "turntable.calibration.change_s" => !has_pause(false),
            "turntable.calibration.remount_s" => !has_pause(true),
            "turntable.calibration.whole_turns" => {
                let mut rates = self.rates_deg_per_s.iter();
                rates.all(|rate| rate.abs() <= 0.0)
            }
            _ => false,
        }
    }

    fn course(&self, warm_up_s: f64, sample_period_s: f64) -> Arc<dyn Course> {
        Arc::new(Campaign::new(self, warm_up_s, sample_period_s))
    }
}

impl CampaignConfig {
    fn check_length(&self, checks: &mut MotionChecks) {
        let duration_s = checks.duration_s;
        let needed_s = self.length_s();
        if checks.is_too_long(needed_s) {
            let message = format!(
                "duration_s = {duration_s:?} s is too short: the {} groups of turntable.calibration \
                 with their pauses take {} s",
                self.axes.len(),
                number(needed_s)
            );
            checks.complain("duration_s", message);
        }
        let shortest_s = GROUP_SAMPLES_MIN * checks.sample_period_s;
        if self.record_s < shortest_s {
            let key = "turntable.calibration.record_s";
            let message = format!(
                "{key} = {:?} s is too short: a mean and its standard error take 40 output samples, \
                 {shortest_s:.6} s",
                self.record_s
            );
            checks.complain(key, message);
        }
    }

    /// Ramps take half of a change and a quarter of a re-mounting.
    fn check_pauses(&self, checks: &mut MotionChecks) {
        let groups = self.groups();
        let is_remounted = groups.iter().any(|group| group.is_remounted);
        let is_changed = groups.iter().skip(1).any(|group| !group.is_remounted);
        for (key, pause_s, share, is_used) in [
            ("change_s", self.change_s, 0.5, is_changed),
            ("remount_s", self.remount_s, 0.25, is_remounted),
        ] {
            let shortest_s = SAMPLES_PER_RAMP_MIN * checks.sample_period_s / share;
            if is_used && pause_s < shortest_s {
                let key = format!("turntable.calibration.{key}");
                let message = format!(
                    "{key} = {pause_s:?} s is too short: a ramp takes {share} of it and must span 8 \
                     output samples, {shortest_s:.6} s"
                );
                checks.complain(&key, message);
            }
        }
    }

    fn check_turns(&self, checks: &mut MotionChecks) {
        for (index, rate) in self.rates_deg_per_s.iter().enumerate() {
            let turn_s = 360.0 / rate.abs();
            if turn_s.is_finite() && turn_s > self.record_s * (1.0 + TIME_SLACK) {
                let key = format!("{RATES}[{index}]");
                let message = format!(
                    "{key} = {rate:?} deg/s makes no whole turn in record_s = {:?} s: one takes \
                     {turn_s:.6} s; record longer or set whole_turns = false",
                    self.record_s
                );
                checks.complain(&key, message);
            }
        }
    }
}

/// The command of a campaign.
///
/// Rates follow one another along raised cosines, so that rate and acceleration are continuous and
/// the loop of the gyro follows. A change of rate takes the middle half of its pause. To mount the
/// case anew the table stops in a quarter of the pause, rests for the quarter in its middle and runs
/// up in another, which leaves an eighth at either end. The first rate is reached inside the warm-up.
#[derive(Clone, Debug)]
struct Campaign {
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
    fn new(config: &CampaignConfig, warm_up_s: f64, sample_period_s: f64) -> Self {
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
}

impl Course for Campaign {
    fn at(&self, instant: f64) -> Instant {
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
