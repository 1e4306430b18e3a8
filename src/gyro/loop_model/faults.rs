//! What went wrong in a loop, beyond the counts that every gyro has.

/// Where a gyro did not work as meant, beyond the counts that every gyro has.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct LoopFaults {
    /// Loop periods in which the ramp's step was held at its limit.
    pub saturated_steps: u64,
    /// Rate words more than half a fringe from the motion.
    pub wrong_fringe_words: u64,
    /// Rate of the last such word less that of the motion, deg/s: a multiple of the fringe.
    pub fringe_error_deg_per_s: f64,
}

impl LoopFaults {
    /// Sum over repeats; the fringe is that of the last repeat that lost it.
    #[must_use]
    pub fn plus(self, later: Self) -> Self {
        Self {
            saturated_steps: self.saturated_steps + later.saturated_steps,
            wrong_fringe_words: self.wrong_fringe_words + later.wrong_fringe_words,
            fringe_error_deg_per_s: if later.wrong_fringe_words > 0 {
                later.fringe_error_deg_per_s
            } else {
                self.fringe_error_deg_per_s
            },
        }
    }

    /// What the reader of a report must know.
    #[must_use]
    pub fn notes(self) -> Vec<String> {
        let mut notes = Vec::new();
        if self.saturated_steps > 0 {
            notes.push(format!(
                "the ramp's step was held at gyro.controller.step_limit_deg in {} loop periods",
                self.saturated_steps
            ));
        }
        if self.wrong_fringe_words > 0 {
            notes.push(format!(
                "the loop was on a wrong fringe in {} rate words, the last of them off by {:+.3} deg/s",
                self.wrong_fringe_words, self.fringe_error_deg_per_s
            ));
        }
        notes
    }
}
