//! Calibration and compensation of an assembly of three gyros.

mod assembly;
mod calibrate;
mod calibrate_files;
mod calibration_campaign;
mod compensation;
mod encoder_rate;
mod patent_calibration;
mod patent_known_answers;
