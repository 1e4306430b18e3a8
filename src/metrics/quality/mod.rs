//! What is the matter with the words of a recorded log: outliers, and noise that was smoothed away.

pub(crate) mod coarse;
pub(crate) mod density;
pub(crate) mod examine;
pub(crate) mod outliers;
pub(crate) mod sides;
pub(crate) mod smoothing;
