//! Checks of a motion against the record: what all kinds share.

/// Fewest output samples per cycle of a swing.
pub(super) const SAMPLES_PER_CYCLE_MIN: f64 = 4.0;

/// Fewest output samples of a ramp between two rates.
pub(super) const SAMPLES_PER_RAMP_MIN: f64 = 8.0;

/// Shortest ramp, s: 0 is a jump, and between the two lie lengths whose reciprocals are no numbers.
const RAMP_MIN_S: f64 = 1e-9;

/// Relative slack when times are compared, so that `3 x 0.1 s` fits into 0.3 s.
pub(super) const TIME_SLACK: f64 = 1e-9;

/// Record that a motion is checked against, and the complaints so far.
pub struct MotionChecks<'a> {
    /// Length of the record, s.
    pub duration_s: f64,
    /// Length of the warm-up, s.
    pub warm_up_s: f64,
    /// Period of the output samples, s.
    pub sample_period_s: f64,
    /// Whether the table carries a three-axis assembly.
    pub has_assembly: bool,
    /// Whether somebody wrote a key.
    pub is_written: &'a dyn Fn(&str) -> bool,
    /// Whether somebody wrote a key where it says something other than the default.
    pub is_asked_for: &'a dyn Fn(&str) -> bool,
    /// Key and text of every complaint.
    pub complaints: Vec<(String, String)>,
}

impl MotionChecks<'_> {
    /// Complains about a key.
    pub(super) fn complain(&mut self, key: &str, message: String) {
        self.complaints.push((key.to_owned(), message));
    }

    /// Complains about a key if somebody wrote it, else about another one that it depends on.
    pub(super) fn complain_or(&mut self, key: &str, other: &str, message: String) {
        let blamed = if (self.is_written)(key) { key } else { other };
        self.complain(blamed, message);
    }

    /// Whether a motion of this length outlasts the record.
    pub(super) fn is_too_long(&self, needed_s: f64) -> bool {
        needed_s > self.duration_s * (1.0 + TIME_SLACK)
    }

    /// Whether the length under a key fits into the record; refuses one that outlasts it.
    pub(super) fn fits(&mut self, key: &str, length_s: f64) -> bool {
        let is_too_long = self.is_too_long(length_s);
        if is_too_long {
            let message = format!(
                "{key} = {length_s:?} s is too long: allowed up to duration_s = {:?} s",
                self.duration_s
            );
            self.complain(key, message);
        }
        !is_too_long
    }

    /// Refuses a soft start that is longer than the warm-up.
    pub(super) fn soft_start(&mut self, key: &str, soft_start_s: f64) {
        let warm_up_s = self.warm_up_s;
        if soft_start_s > warm_up_s {
            let message = format!(
                "{key} = {soft_start_s:?} s is longer than the warm-up: allowed [0, warm_up_s = {warm_up_s:?}] s"
            );
            self.complain_or(key, "warm_up_s", message);
        } else {
            self.ramp(key, soft_start_s);
        }
    }

    /// Refuses a ramp so short that its acceleration is no number.
    pub(super) fn ramp(&mut self, key: &str, length_s: f64) {
        if length_s > 0.0 && length_s < RAMP_MIN_S {
            let message = format!(
                "{key} = {length_s:?} s is out of range: allowed 0 s, a jump, or {RAMP_MIN_S:?} s and more"
            );
            self.complain(key, message);
        }
    }

    /// Refuses a frequency that the output samples cannot show.
    pub(super) fn frequency(&mut self, key: &str, frequency_hz: f64) {
        let output_rate_hz = 1.0 / self.sample_period_s;
        let frequency_hz_max = output_rate_hz / SAMPLES_PER_CYCLE_MIN;
        if frequency_hz > frequency_hz_max {
            let message = format!(
                "{key} = {frequency_hz:?} Hz is too fast: allowed up to \
                 {frequency_hz_max:.6} Hz, {SAMPLES_PER_CYCLE_MIN} samples a cycle at the output rate of {output_rate_hz:.6} Hz"
            );
            self.complain(key, message);
        }
    }
}
