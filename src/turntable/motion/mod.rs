//! What the table is told to do: commanded rate as a function of the sample count.

mod campaign;
mod chirp;
mod command;
mod course;
mod kind;
mod multi_sine;
mod samples;
mod script;
mod soft_start;
mod trapezoid;

pub use campaign::campaign_angles_rad;
pub(in crate::turntable) use campaign::remountings;
pub(in crate::turntable) use command::Profile;
pub use kind::{
    CommandExtremes, campaign_command_extremes, command_extremes, command_rate_max_rad_per_s,
    multi_sine_acceleration_max_rad_per_s2, swing_rate_amplitude_rad_per_s,
};
pub use samples::{dwell_ends, first_measured_index, step_indices};
