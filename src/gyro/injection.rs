//! Settings of the test signal that is added inside the loop.

use crate::declare::table;
use crate::vocabulary::PhaseRule;

table! {
    /// Optional table: electronic injection. A signal is added to each step of the loop's own ramp, which
    /// to the loop is the Sagnac phase of a rate: the amplitudes are those of that equivalent rate. It
    /// reaches frequencies that no table does. The table must be at rest, and there is one gyro. Truth, in
    /// the metrics and in samples/, is then the Earth's rate plus the equivalent rate, and the record is
    /// measured as one of several sines. Absent is the gyro at work.
    pub struct InjectionConfig {
        /// Frequencies, ascending, at most 64; a cycle must span at least 4 output samples, and the record
        /// three cycles of the lowest and one of each difference. A smaller
        /// gyro.output.half_periods_per_sample reaches further.
        frequencies_hz: Vec<f64>, example [5.0, 20.0, 80.0, 320.0], in 1e-6..=100_000.0, "Hz";
        /// Amplitudes as equivalent rates: one for all frequencies, or one for each.
        rate_amplitudes_deg_per_s: Vec<f64>, example [1.0], in 1e-9..=2000.0, "deg/s";
        /// Phases, as those of turntable.multi_sine. Source of the default: as there.
        phases: PhaseRule = "schroeder";
        /// Raised-cosine start of the signal, inside the warm-up. Source of the default: assumed.
        soft_start_s: f64 = 1.0, in 0.0..=1.0, "s";
    }
}
