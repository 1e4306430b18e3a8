//! Noise about the signal, whatever the motion: level, colour, spectrum, bias stability.

pub(super) mod autocovariance;
pub(super) mod bias_stability;
pub(super) mod by_weights;
pub(super) mod level;
pub(super) mod line;
pub(super) mod memory;
pub(super) mod other_noise;
pub(super) mod pulse_fit;
pub(super) mod spectrum;
pub(super) mod truth_response;
pub(super) mod two_runs;
