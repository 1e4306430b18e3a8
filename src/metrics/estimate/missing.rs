//! Looking up a metric by its key, with the reason where it is missing.

use super::reason::Unavailable;
use super::table::ChannelMetrics;
use super::value::Estimate;
use crate::metrics::key::metric::MetricKey;

/// A metric that a channel does not have, and why.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{metric} is missing: {reason}")]
#[non_exhaustive]
pub struct MissingMetric {
    /// Key of the metric.
    pub metric: &'static str,
    /// Why it is missing.
    pub reason: Unavailable,
}

impl ChannelMetrics {
    /// Value and interval of a metric, in the unit of its key.
    ///
    /// # Errors
    /// [`MissingMetric`] with the reason: what the record lacks, how the channel failed, or that the
    /// metric belongs to another motion.
    ///
    /// ```
    /// use fogbench::metrics::ChannelMetrics;
    /// use fogbench::metrics::catalogue::DC_GAIN;
    ///
    /// let nothing = ChannelMetrics::default();
    /// let missing = nothing.metric(&DC_GAIN).unwrap_err();
    /// assert_eq!(missing.to_string(), "dc_gain is missing: it was not measured in this record");
    /// ```
    pub fn metric(&self, key: &MetricKey) -> Result<Estimate, MissingMetric> {
        if let Some(metric) = self.get(key) {
            return Ok(metric.estimate);
        }
        let told = self.unavailable.get(key.name).cloned();
        let failure = self.error.as_ref();
        let reason = told.or_else(|| failure.map(|failure| failure.message.clone().into()));
        Err(MissingMetric {
            metric: key.name,
            reason: reason.unwrap_or_else(|| "it was not measured in this record".into()),
        })
    }
}
