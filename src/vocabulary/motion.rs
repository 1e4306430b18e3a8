//! Words of motions and mountings.

use super::word::words;

words! {
    /// Phases of several sines, which decide how high their sum peaks.
    pub enum PhaseRule {
        /// Cosines, by the power in the tones below (Schroeder).
        Schroeder = "schroeder",
        /// Cosines of phase `pi (k - 1)^2 / K` (Newman).
        Newman = "newman",
        /// All zero: every sine rises through zero at the start.
        Zero = "zero",
    }

    /// An axis of the case of a three-axis assembly; x, y, z are right-handed.
    pub enum CaseAxis {
        /// The x axis.
        X = "x",
        /// The y axis.
        Y = "y",
        /// The z axis.
        Z = "z",
    }
}
