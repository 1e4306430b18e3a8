//! Tables for people, of a run and of a suite.

pub(super) mod compensation;
pub(super) mod quality;
pub(super) mod repeats;
pub(super) mod scale_factor;
pub(super) mod suite;
pub(super) mod table;
pub(super) mod temperature;
pub(super) mod verdict;
