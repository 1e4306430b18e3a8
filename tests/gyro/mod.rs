//! The gyro: optics, loop, noise, temperature and output, against closed forms.

mod average_output;
mod closed_loop;
mod data_sheet_noise;
mod fast_motion;
mod gyro_effects;
mod injection;
mod known_answers_gyro;
mod known_answers_gyro_limits;
mod known_answers_gyro_loop;
mod known_answers_gyro_noise;
mod known_answers_output;
mod known_answers_slow_noise;
mod known_answers_thermal;
mod vibration;
mod waveform_model;
