//! Gaps of a record that differences of its angle may span.

use std::ops::Range;

/// A gap between words whose angle is known, or assumed.
#[derive(Clone, Debug, PartialEq)]
pub struct Bridge {
    /// Missing words of the record, counted from its first one.
    pub words: Range<usize>,
    /// Mean rate over them, deg/h.
    pub mean_deg_per_h: f64,
    /// Whether it is known, as that of an angle which ran on is, rather than that of the words on both sides.
    pub is_known: bool,
}
