//! What the catalogue says of a metric.

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

/// Why other channels lack the metrics of pipelines.
pub(crate) const PIPELINE_ONLY: &str = "only a filter with pipeline = \"fpga\" has it";

/// One entry of the catalogue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KnownMetric {
    /// Key.
    pub name: &'static str,
    /// Unit as printed.
    pub unit: &'static str,
    /// Definition in one line.
    pub definition: &'static str,
    /// Motions it is defined for.
    pub applies: Applies,
    /// Whether only filters have it.
    pub filters_only: bool,
}
