//! Noise of a gyro as a linear system for a Kalman filter: F, Q, H, R, S and P0 from the fitted terms.

mod agreement;
mod blocks;
mod flicker;
mod model;
mod taps;

pub use blocks::State;
pub use flicker::FlickerBank;
pub use model::{StateSpace, noise_state_space};
