#![doc = include_str!("../README.md")]

mod linear_algebra;
pub mod random;
pub mod signal;
pub mod units;
pub mod vocabulary;
mod wording;

// In the order of the data flow.
pub mod scenario;

pub mod turntable;

pub mod gyro;

pub mod fpga;

pub mod filters;

pub mod metrics;

pub mod calibration;

pub mod recording;

pub mod gate;

pub mod report;

pub mod store;

pub mod experiment;

pub mod cli;

pub use experiment::{Plan, Run, Scenario};
