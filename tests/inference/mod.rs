//! Settings of a gyro from its figures.

mod cli_infer;
mod infer_logs;
mod infer_truth;
