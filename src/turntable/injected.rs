//! The signal that is added inside the loop while the table is at rest.

use super::motion::{Command, Motion};
use crate::signal::MotionSegment;
use crate::turntable::MultiSineConfig;

/// Generator of an injected signal, in the place of a rate table.
///
/// Delivers the rate that the signal equals. Added to the step of the ramp it enters the phase
/// difference of the interferometer at the instants at which a Sagnac phase would, so that the loop
/// answers with the same transfer function; errors of the modulator act on the loop's own step alone.
#[derive(Clone, Debug)]
pub struct InjectedSignal {
    command: Command,
}

impl InjectedSignal {
    /// A signal at the start of the warm-up.
    ///
    /// * `warm_up_s`: s, >= 0; the soft start lies inside it and is shortened to it.
    /// * `sample_period_s`: s, > 0; one segment is delivered per sample.
    ///
    /// # Panics
    /// If there is neither one amplitude nor one for each sine; the scenario reader refuses that.
    #[must_use]
    pub fn new(sines: &MultiSineConfig, warm_up_s: f64, sample_period_s: f64) -> Self {
        Self {
            command: Command::new(sines.course(warm_up_s, sample_period_s)),
        }
    }

    /// Equivalent rate over the next output sample, rad/s: a cubic, exact at its ends (see
    /// [`Turntable::next_segment`](crate::turntable::Turntable::next_segment)).
    pub fn next_segment(&mut self) -> MotionSegment {
        self.command.next_segment()
    }
}
