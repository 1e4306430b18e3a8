//! The one integration-test binary.

#![expect(
    clippy::needless_update,
    reason = "settings are those of the reference but for what is given, so that a new key breaks no test"
)]

mod allan_coverage;
mod allan_curves;
mod architecture;
mod assembly;
mod average_output;
mod bit_exact;
mod bounds;
mod calibrate;
mod calibrate_files;
mod calibration_campaign;
mod campaign;
mod circles;
mod cli;
mod cli_analyze;
mod cli_budget;
mod cli_fpga;
mod closed_loop;
mod comparison;
mod comparison_change;
mod comparison_filters;
mod compensation;
mod cycle_exact;
mod determinism;
mod documents;
mod encoder;
mod extremes;
mod filters;
mod fpga_health;
mod frequency_response;
mod generated;
mod growth;
mod gyro_effects;
mod injection;
mod interruption;
mod known_answers_allan;
mod known_answers_allan_variants;
mod known_answers_gyro;
mod known_answers_gyro_limits;
mod known_answers_gyro_loop;
mod known_answers_gyro_noise;
mod known_answers_metrics;
mod known_answers_output;
mod known_answers_scale_factor;
mod known_answers_slow_noise;
mod known_answers_swing;
mod known_answers_thermal;
mod known_answers_turntable;
mod library;
mod metrics_intervals;
mod metrics_records;
mod metrology;
mod mutation;
mod noise_fit_coverage;
mod output_folder;
mod packages;
mod patent_calibration;
mod patent_filter;
mod patent_known_answers;
mod pipeline;
#[path = "../benches/plain_loop.rs"]
mod plain_loop;
mod readers;
mod recording;
mod report;
mod resume;
mod rtl;
mod scale_factor_test;
mod scenario_errors;
mod sign_lms_hardware;
mod small_inputs_and_steps;
mod suite;
mod support;
mod timing;
mod trial;
mod turntable_geometry;
mod turntable_profiles;
mod turntable_script;
mod turntable_servo;
mod vibration;
mod waveform;
mod waveform_model;
