//! The trial of a denoiser: gain, delay, noise-delay bound, readaptation, weight noise.

pub(super) mod black_box;
pub(super) mod dc_gain;
pub(super) mod frozen_response;
pub(super) mod noise_delay;
pub(super) mod predicted;
pub(super) mod rate_gain;
pub(super) mod readaptation;
pub(super) mod weight_noise;
