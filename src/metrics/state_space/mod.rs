//! Noise of a gyro as a linear system for a Kalman filter: F, Q, H, R, S and P0 from the fitted terms.

mod blocks;
mod flicker;
mod model;

pub use flicker::FlickerBank;
pub use model::{State, StateSpace, noise_state_space};
