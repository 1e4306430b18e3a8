//! Settings of a calibration campaign, and when its groups stand.

use crate::declare::table;
use crate::vocabulary::CaseAxis;

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
