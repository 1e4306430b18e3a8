//! Steps of rate: settling, overshoot, scale factor and its errors, threshold and dead band.

pub(super) mod dwells;
pub(super) mod nonlinearity;
pub(super) mod points;
pub(super) mod scale_factor;
pub(super) mod settling;
pub(super) mod shape;
pub(super) mod small_input;
pub(super) mod staircase;
