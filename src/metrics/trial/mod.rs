//! The trial of a denoiser: gain, delay, noise-delay bound, readaptation, verdict.

pub(super) mod frozen_response;
pub(super) mod noise_delay;
pub(super) mod readaptation;
pub(super) mod verdict;
pub(super) mod weight_noise;
