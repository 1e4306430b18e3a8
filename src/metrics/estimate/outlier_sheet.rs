//! What results hold of the outliers of a log.

/// A word, or a burst of them in a row, that lies outside.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct OutlierEntry {
    /// Index of its first word in the log, the warm-up included.
    pub index: usize,
    /// Stamp of that word, s.
    pub time_s: f64,
    /// Words in a row.
    pub words: usize,
    /// Distance of its farthest word from the words on both sides, deg/h.
    pub size_deg_per_h: f64,
    /// The same in standard deviations of such a distance.
    pub size_deviations: f64,
}
