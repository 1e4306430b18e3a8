//! What the table is told to do: commanded rate as a function of the sample count.

mod chirp;
mod command;
mod extremes;
mod script;
mod shape;
mod soft_start;
mod steps;
mod trapezoid;

pub(in crate::turntable) use command::Profile;
pub use extremes::{
    CommandExtremes, command_extremes, command_rate_max_rad_per_s, swing_rate_amplitude_rad_per_s,
};
pub use steps::{first_measured_index, step_indices};
