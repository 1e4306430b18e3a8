//! Closed-loop fibre-optic-gyro and rate-turntable testbench.

pub mod random;
pub mod signal;
pub mod units;

pub mod cli;
pub mod experiment;
pub mod filters;
pub mod fpga;
pub mod gate;
pub mod gyro;
pub mod metrics;
pub mod report;
pub mod scenario;
pub mod turntable;
