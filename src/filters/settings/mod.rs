//! Settings of the filters: the tables of keys below `filter`, one file a kind.
//!
//! Invariant: declarations only; nothing here computes.

mod butterworth;
mod constrained_rls;
mod kalman;
mod lms;
mod moving_average;
mod one_pole;
mod rls;
mod savitzky_golay;
mod sign_lms;

pub use butterworth::ButterworthFilterConfig;
pub use constrained_rls::ConstrainedRlsFilterConfig;
pub use kalman::KalmanFilterConfig;
pub use lms::LmsFilterConfig;
pub use moving_average::MovingAverageFilterConfig;
pub use one_pole::OnePoleFilterConfig;
pub use rls::RlsFilterConfig;
pub use savitzky_golay::SavitzkyGolayFilterConfig;
pub use sign_lms::SignLmsFilterConfig;

use crate::declare::{alternatives, table};

table! {
    /// Filters: one `[[filter]]` per channel, with one kind. None by default.
    pub struct FilterConfig {
        /// Channel name; raw, truth, time_s and encoder_arcsec are reserved.
        name: String, example "rls", kind Name;
        #[serde(flatten)]
        kind: FilterKind;
    }
}

alternatives! {
    /// Kind of a filter and its settings.
    pub enum FilterKind, one "filter kind" {
        Rls(RlsFilterConfig) = "rls",
        Lms(LmsFilterConfig) = "lms",
        SignLms(SignLmsFilterConfig) = "sign_lms",
        ConstrainedRls(ConstrainedRlsFilterConfig) = "constrained_rls",
        MovingAverage(MovingAverageFilterConfig) = "moving_average",
        SavitzkyGolay(SavitzkyGolayFilterConfig) = "savitzky_golay",
        OnePole(OnePoleFilterConfig) = "one_pole",
        Butterworth(ButterworthFilterConfig) = "butterworth",
        Kalman(KalmanFilterConfig) = "kalman",
    }
}
