//! What the temperature does to a record: bias and scale factor against it and its rate.

pub(crate) mod coefficients;
mod correlated_fit;
pub(crate) mod keys;
pub(crate) mod means;
pub(crate) mod without;
