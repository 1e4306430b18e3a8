//! Metrics of whole records: known answers, intervals, reasons for what is missing.

mod coverage;
mod frequency_response;
mod known_answers_metrics;
mod known_answers_scale_factor;
mod known_answers_swing;
mod metrics_intervals;
mod metrics_records;
mod rows;
mod scale_factor_test;
mod small_inputs_and_steps;
