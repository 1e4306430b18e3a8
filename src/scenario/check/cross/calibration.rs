//! Checks across the values of a calibration campaign.

use crate::scenario::check::cross::{Checks, SAMPLES_PER_CYCLE_MIN, TIME_SLACK};
use crate::turntable::CampaignConfig;
use crate::wording::number;

/// Fewest output samples of a group: twenty blocks of two.
const GROUP_SAMPLES_MIN: f64 = 40.0;

const RATES: &str = "turntable.calibration.rates_deg_per_s";

impl Checks<'_> {
    /// Refuses groups without an assembly, of unequal counts, that outlast the record or hold no turn.
    pub(in crate::scenario) fn campaign(&mut self, campaign: &CampaignConfig) {
        let scenario = &self.resolved.scenario;
        if scenario.gyro.assembly.is_none() {
            let message =
                "turntable.calibration turns a case with three gyros: give [gyro.assembly]";
            self.complain("turntable.calibration", message.to_owned());
        }
        let (axes, rates) = (campaign.axes.len(), campaign.rates_deg_per_s.len());
        if axes != rates {
            let message = format!(
                "{RATES} has {rates} values, but turntable.calibration.axes has {axes}: give one of \
                 each for every group"
            );
            self.complain(RATES, message);
            return;
        }
        self.campaign_length(campaign);
        self.campaign_pauses(campaign);
        if campaign.whole_turns {
            self.campaign_turns(campaign);
        }
    }

    fn campaign_length(&mut self, campaign: &CampaignConfig) {
        let duration_s = self.resolved.scenario.duration_s;
        let needed_s = campaign.length_s();
        if needed_s > duration_s * (1.0 + TIME_SLACK) {
            let message = format!(
                "duration_s = {duration_s:?} s is too short: the {} groups of turntable.calibration \
                 with their pauses take {} s",
                campaign.axes.len(),
                number(needed_s)
            );
            self.complain("duration_s", message);
        }
        let shortest_s = GROUP_SAMPLES_MIN * self.sample_period_s();
        if campaign.record_s < shortest_s {
            let key = "turntable.calibration.record_s";
            let message = format!(
                "{key} = {:?} s is too short: a mean and its standard error take 40 output samples, \
                 {shortest_s:.6} s",
                campaign.record_s
            );
            self.complain(key, message);
        }
    }

    /// Ramps take half of a change and a quarter of a re-mounting.
    fn campaign_pauses(&mut self, campaign: &CampaignConfig) {
        let groups = campaign.groups();
        let is_remounted = groups.iter().any(|group| group.is_remounted);
        let is_changed = groups.iter().skip(1).any(|group| !group.is_remounted);
        for (key, pause_s, share, is_used) in [
            ("change_s", campaign.change_s, 0.5, is_changed),
            ("remount_s", campaign.remount_s, 0.25, is_remounted),
        ] {
            let shortest_s = SAMPLES_PER_CYCLE_MIN * self.sample_period_s() / share;
            if is_used && pause_s < shortest_s {
                let key = format!("turntable.calibration.{key}");
                let message = format!(
                    "{key} = {pause_s:?} s is too short: a ramp takes {share} of it and must span 8 \
                     output samples, {shortest_s:.6} s"
                );
                self.complain(&key, message);
            }
        }
    }

    fn campaign_turns(&mut self, campaign: &CampaignConfig) {
        for (index, rate) in campaign.rates_deg_per_s.iter().enumerate() {
            let turn_s = 360.0 / rate.abs();
            if turn_s.is_finite() && turn_s > campaign.record_s * (1.0 + TIME_SLACK) {
                let key = format!("{RATES}[{index}]");
                let message = format!(
                    "{key} = {rate:?} deg/s makes no whole turn in record_s = {:?} s: one takes \
                     {turn_s:.6} s; record longer or set whole_turns = false",
                    campaign.record_s
                );
                self.complain(&key, message);
            }
        }
    }
}
