//! The motions that a table can be told to make, a file for each: its table of keys and its command.

pub(in crate::turntable::motion) mod campaign;
pub(in crate::turntable::motion) mod chirp;
pub(in crate::turntable::motion) mod multi_sine;
pub(in crate::turntable::motion) mod rest;
pub(in crate::turntable::motion) mod rotation;
pub(in crate::turntable::motion) mod scale_factor_test;
pub(in crate::turntable::motion) mod script;
pub(in crate::turntable::motion) mod steps;
pub(in crate::turntable::motion) mod swing;
pub(in crate::turntable::motion) mod test_signal;
pub(in crate::turntable::motion) mod trapezoid;
