//! One run in memory: motion to gyro to filters to metrics, repeat by repeat.

mod allan_settings;
pub(crate) mod assembly_motion;
mod in_memory;
mod measure;
mod motion;
mod other_noise;
mod output_average;
mod progress;
#[cfg(feature = "report")]
mod ranges;
mod rate_twins;
mod records;
mod repeat_pool;
mod results;
mod simulate;
mod theory;

pub(crate) use allan_settings::allan_options;
pub(crate) use assembly_motion::axis_index;
pub use in_memory::{Run, RunError, Samples, UnknownName};
pub(crate) use measure::Cut;
pub(crate) use motion::{motion, motion_extremes, rate_deg_per_h_max};
pub use progress::Progress;
pub(crate) use progress::{Unfinished, unless_stopped};
#[cfg(feature = "report")]
pub(crate) use ranges::run_range;
pub(crate) use rate_twins::{RATES_DEG_PER_S, RateTwins, rate_gain};
pub(crate) use records::{RecordLength, count, sample_period_s, stamp_s};
#[cfg(feature = "report")]
pub(crate) use repeat_pool::{Repeat, RepeatPool};
pub(crate) use results::{Results, run_plan};
#[cfg(feature = "report")]
pub(crate) use results::{notes, verdicts};
pub(crate) use simulate::{Faults, GyroRecord, Simulation, first_words, simulate};
#[cfg(feature = "report")]
pub(crate) use theory::theory;
