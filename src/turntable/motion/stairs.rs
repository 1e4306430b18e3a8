//! Rates held one after the other: a staircase, or the rates of a scale factor test.

/// Rates and when each of them ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Stairs {
    /// Rates in order, deg/s.
    pub rates_deg_per_s: Vec<f64>,
    /// End of each rate from the start of the record, s; the last rate is held beyond it.
    pub ends_s: Vec<f64>,
    /// Time at the start of each dwell that is left out, s.
    pub settle_s: f64,
    /// Whether the first and the last rate are rest, to be subtracted from what is between.
    pub has_static_zeros: bool,
}

impl Stairs {
    /// Time from the start of the record to the end of the last dwell, s.
    #[must_use]
    pub fn length_s(&self) -> f64 {
        self.ends_s.last().copied().unwrap_or(0.0)
    }
}
