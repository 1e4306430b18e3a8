//! Allan variance and its relatives, and the noise terms fitted to it (bias instability among them).

pub(super) mod angle;
pub(super) mod bridges;
pub(super) mod coefficients;
pub(super) mod combined_freedom;
pub(super) mod covariance;
pub(super) mod curves;
pub(super) mod entry;
pub(super) mod extra_terms;
pub(super) mod gaps;
pub(super) mod judge;
pub(super) mod least_squares;
mod limits;
pub(super) mod noise_fit;
pub(super) mod noise_identification;
pub(super) mod overlapping;
pub(super) mod pulses;
pub(super) mod sampling;
pub(super) mod stream;
pub(super) mod variants;
