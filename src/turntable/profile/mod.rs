//! What the table is told to do: commanded rate as a function of the sample count.

mod campaign;
mod chirp;
mod command;
mod extremes;
mod script;
mod shape;
mod soft_start;
mod steps;
mod tones;
mod trapezoid;

pub use campaign::campaign_angles_rad;
pub(in crate::turntable) use campaign::remountings;
pub(in crate::turntable) use command::Profile;
pub use extremes::{
    CommandExtremes, campaign_command_extremes, command_extremes, command_rate_max_rad_per_s,
    multi_sine_acceleration_max_rad_per_s2, swing_rate_amplitude_rad_per_s,
};
pub use steps::{first_measured_index, step_indices};
