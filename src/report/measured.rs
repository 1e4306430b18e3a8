//! What tables and pictures need to know, of a run and of a recorded log alike.

use std::borrow::Cow;

use crate::metrics::ChannelMetrics;
use crate::report::RunReport;
use crate::scenario::MotionConfig;

/// Channels that were measured together.
#[derive(Clone, Debug)]
pub(crate) struct Measured<'a> {
    /// Name in headings.
    pub(crate) name: &'a str,
    /// Motion during the record.
    pub(crate) motion: Cow<'a, MotionConfig>,
    /// Channels, raw first.
    pub(crate) channels: &'a [(String, ChannelMetrics)],
}

impl<'a> RunReport<'a> {
    /// The measured channels of the run.
    pub(crate) fn measured(&self) -> Measured<'a> {
        // The estimates of a campaign stand last; they have a table of their own.
        let estimates = self.calibration.map_or(0, |sheet| sheet.estimates.len());
        Measured {
            name: &self.scenario.name,
            motion: self.scenario.measured_motion(),
            channels: &self.channels[..self.channels.len() - estimates],
        }
    }
}
