//! Noise of the gyro: the sources at the detector, their budget, and the slow noise of the rate.

pub(in crate::gyro) mod budget;
pub(in crate::gyro) mod budget_sheet;
pub(in crate::gyro) mod rin;
pub(in crate::gyro) mod slow_noise;
