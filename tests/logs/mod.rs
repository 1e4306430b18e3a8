//! Recorded logs: layouts, time, units, gaps, and what is measured of them.

mod cli_analyze;
mod cli_log_quality;
mod log_calibration;
mod log_cases;
mod log_dwells;
mod log_layouts;
mod log_pass;
mod log_real_files;
mod log_refusals;
mod log_scenarios;
mod log_stream;
mod log_temperature;
mod npz;
mod readers;
mod recording;
