//! Which motions a metric is defined for.

/// Which records a metric belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Applies {
    /// Every record.
    Always,
    /// Steady motion: at rest or turning at a constant rate.
    Steady,
    /// Swing.
    Swing,
    /// Swing or several sines at once.
    Tones,
    /// Several sines at once.
    MultiSine,
    /// Steps.
    Steps,
    /// A motion that begins within the record: steps, a swing from rest, a script.
    Onset,
    /// Steady motion or swing.
    SteadyOrSwing,
    /// Every motion but rest and constant rate.
    Moving,
    /// Steady motion, swing or steps: a signal that can be told from noise.
    Separable,
    /// Every record of a filter that is a hardware pipeline.
    Pipeline,
    /// The estimates of a calibration campaign, which are no records.
    Calibration,
}
