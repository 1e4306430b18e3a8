//! Settings of the rate table as a whole.

use super::encoder::EncoderConfig;
use super::motion::MotionConfig;
use super::servo::ServoConfig;
use super::site::{AxisConfig, MountingConfig, SiteConfig};
use crate::declare::table;

table! {
    /// Rate table: one motion, one servo, one site, the errors of axis and mounting.
    pub struct TurntableConfig {
        #[serde(flatten)]
        motion: MotionConfig;
        servo: ServoConfig;
        encoder: EncoderConfig;
        site: SiteConfig;
        axis: AxisConfig;
        mounting: MountingConfig;
    }
}
