//! Declaration of a metric: key, unit, heading, definition, and where and how it is measured.
//!
//! A metric is one [`MetricKey`], declared beside its computation and listed in
//! [`catalogue`](crate::metrics::catalogue). Tables, gates, pooling over repeats, the reasons for what is
//! missing and the documentation read that row.

/// Records that a metric belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
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
    /// Every record of a filter that is a hardware pipeline of fixed-point words.
    FixedPoint,
    /// The estimates of a calibration campaign, which are no records.
    Calibration,
    /// The words of a recorded log.
    Log,
    /// A filter that runs again on twins of its record.
    Twins,
}

impl Applies {
    /// Lines of the suite's table for the one motion whose records alone have the metric.
    fn headlines(self) -> &'static [Headline] {
        match self {
            Self::Steady => &[Headline::Rest],
            Self::Swing => &[Headline::Swing],
            Self::MultiSine => &[Headline::MultiSine],
            Self::Steps => &[Headline::Steps, Headline::ScaleFactor],
            _ => &[],
        }
    }

    /// The records in words, which follow "defined for".
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Always => "any motion",
            Self::Pipeline => "a filter that is a hardware pipeline",
            Self::FixedPoint => "a filter that is a hardware pipeline of fixed-point words",
            Self::Steady => "a table at rest or at constant rate",
            Self::Swing => "a swing",
            Self::Tones => "a swing or several sines",
            Self::MultiSine => "several sines",
            Self::Steps => "steps",
            Self::Onset => "steps, a swing from rest or a script",
            Self::SteadyOrSwing => "a swing or a table at rest or at constant rate",
            Self::Moving => "a moving table",
            Self::Calibration => "the estimates of a calibration campaign",
            Self::Log => "a recorded log",
            Self::Twins => "a filter whose scenario asks for it by trial.black_box",
            Self::Separable => {
                "rest, constant rate, sines or steps, where noise can be told from motion,"
            }
        }
    }
}

/// What a record must offer beyond its motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Needs {
    /// Nothing: the metric does not rest on the samples of the record.
    Nothing,
    /// A few samples, of whatever motion.
    Samples,
    /// A few samples, and whole cycles where the motion has some.
    Record,
    /// Samples enough for the white noise of the Allan fit.
    AllanFit,
    /// A record long enough for the slow noise of the Allan fit.
    SlowNoiseFit,
    /// Blocks of this averaging time, s.
    Blocks(f64),
    /// Blocks of the scenario's averaging time.
    ScenarioBlocks,
    /// Two sines.
    TwoSines,
    /// Samples after the last step.
    Step,
    /// Samples in the last quarter after the last step, where there is one.
    SettledStep,
    /// Settled dwells at several rates.
    Dwells,
    /// Settled dwells at several rates of each sense.
    DwellsOfBothSenses,
}

/// What the metric compares the channel with, beside raw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Against {
    /// Nothing else.
    Nothing,
    /// The true rate.
    Truth,
    /// The true rate for raw itself; a filter is compared with raw.
    TruthForRaw,
    /// The angle of the table's encoder.
    Encoder,
}

impl Against {
    /// The same in words.
    fn words(self) -> &'static str {
        match self {
            Self::Nothing => "",
            Self::Truth => "the true rate",
            Self::TruthForRaw => "raw; raw with the true rate",
            Self::Encoder => "the table's encoder",
        }
    }
}

/// How independent repeats are pooled.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Pool {
    /// Mean; standard deviations with degrees of freedom as root of the mean variance.
    Mean,
    /// Root of the mean square.
    RootMeanSquare,
    /// Fit to the pooled Allan variance.
    AllanFit,
    /// Standard deviation of another metric over the repeats.
    ScatterOf(&'static MetricKey),
    /// Standard deviation of another metric, an error in ppm, over the mean of one plus that error.
    RelativeScatterOf(&'static MetricKey),
}

impl Pool {
    /// The same in words.
    fn words(self) -> String {
        match self {
            Self::Mean => "mean; what has degrees of freedom as root of the mean square".to_owned(),
            Self::RootMeanSquare => "root of the mean square".to_owned(),
            Self::AllanFit => "fit to the pooled Allan variance".to_owned(),
            Self::ScatterOf(of) => format!("standard deviation of {} over the repeats", of.name),
            Self::RelativeScatterOf(of) => format!(
                "standard deviation over the repeats of one plus {}, over their mean",
                of.name
            ),
        }
    }
}

/// Which of two values is the better one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Better {
    /// The lower one.
    Lower,
    /// The higher one.
    Higher,
    /// Neither: a change is a change.
    Neither,
}

impl Better {
    /// The word in files: `lower`, `higher` or `none`.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Lower => "lower",
            Self::Higher => "higher",
            Self::Neither => "none",
        }
    }

    /// The one that a word of a file stands for.
    #[must_use]
    pub fn of_word(word: &str) -> Option<Self> {
        let all = [Self::Lower, Self::Higher, Self::Neither];
        all.into_iter().find(|better| better.as_str() == word)
    }
}

/// How blocks of a record give the metric, where results are compared block by block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OfBlocks {
    /// As the mean of their means.
    Mean,
    /// As the root of the mean of their variances.
    Deviation,
}

impl OfBlocks {
    /// The figure of one block.
    #[must_use]
    pub fn of(self, words: &[f64]) -> f64 {
        let count = words.len() as f64;
        let mean = words.iter().sum::<f64>() / count;
        match self {
            Self::Mean => mean,
            Self::Deviation => {
                let squares: f64 = words.iter().map(|word| (word - mean).powi(2)).sum();
                (squares / (count - 1.0)).sqrt()
            }
        }
    }

    /// The figure of the whole out of those of its blocks.
    #[must_use]
    pub fn whole(self, blocks: &[f64]) -> f64 {
        let count = blocks.len() as f64;
        match self {
            Self::Mean => blocks.iter().sum::<f64>() / count,
            Self::Deviation => {
                (blocks.iter().map(|block| block * block).sum::<f64>() / count).sqrt()
            }
        }
    }
}

/// Tables that have a column for the metric, by the kind of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Table {
    /// At rest or turning at a constant rate.
    Rest,
    /// Swing.
    Swing,
    /// Several sines at once.
    MultiSine,
    /// Steps, and every other motion that is not periodic.
    Steps,
    /// Calibration campaign: a record of many rates.
    Campaign,
}

/// Lines of the suite's table, by the kind of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Headline {
    /// At rest or turning at a constant rate.
    Rest,
    /// Swing.
    Swing,
    /// Several sines at once.
    MultiSine,
    /// Steps.
    Steps,
    /// Scale factor test.
    ScaleFactor,
    /// Every other motion.
    General,
}

/// Declaration of a metric.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct MetricKey {
    /// Key in results and scenario files.
    pub name: &'static str,
    /// Unit as printed; `1` for a ratio.
    pub unit: &'static str,
    /// Definition in one line.
    pub definition: &'static str,
    /// Records it is defined for.
    pub applies: Applies,
    /// Whether only filters have it.
    pub filters_only: bool,
    /// Which of two values is the better one.
    pub better: Better,
    /// Whether it follows from the settings alone: no noise of any seed moves it.
    pub is_of_settings: bool,
    /// How blocks of a record give it; none if they do not.
    pub of_blocks: Option<OfBlocks>,
    /// Names that people give to it, by their words without a unit.
    pub(crate) synonyms: &'static [&'static str],
    pub(crate) heading: Option<&'static str>,
    pub(crate) needs: Needs,
    pub(crate) against: Against,
    pub(crate) pool: Pool,
    /// Place among the columns of `runs.csv`; none if the values of the repeats are not kept.
    pub(crate) run_column: Option<u8>,
    /// Whether only the axis about which the table turns has it, of an assembly of three.
    pub(crate) is_of_turned_axis: bool,
    /// Whether it says nothing of a record that holds many rates.
    pub(crate) is_of_one_motion: bool,
    /// Whether nobody misses it who did not ask for it.
    pub(crate) is_by_choice: bool,
    /// Whether it is slow noise, which the DC gain scales and no short filter of unit gain can lower.
    pub(crate) is_slow_noise: bool,
    /// Key of a scenario that a record of its gyro gives back: assumed there, the metric says the assumption again.
    pub(crate) echoes: Option<&'static str>,
    pub(crate) tables: &'static [Table],
    pub(crate) headlines: &'static [Headline],
    /// Whether it closes the table of every motion, where a channel has it.
    pub(crate) closes_tables: bool,
}

impl PartialEq for MetricKey {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl MetricKey {
    /// A metric of raw and filters alike.
    pub(crate) const fn new(
        name: &'static str,
        unit: &'static str,
        applies: Applies,
        definition: &'static str,
    ) -> Self {
        Self {
            name,
            unit,
            definition,
            applies,
            filters_only: false,
            better: Better::Neither,
            is_of_settings: false,
            of_blocks: None,
            synonyms: &[],
            heading: None,
            needs: Needs::Record,
            against: Against::Nothing,
            pool: Pool::Mean,
            run_column: None,
            is_of_turned_axis: false,
            is_of_one_motion: false,
            is_by_choice: false,
            is_slow_noise: false,
            echoes: None,
            tables: &[],
            headlines: &[],
            closes_tables: false,
        }
    }

    /// A metric that only filters have.
    pub(crate) const fn of_filters(
        name: &'static str,
        unit: &'static str,
        applies: Applies,
        definition: &'static str,
    ) -> Self {
        Self {
            filters_only: true,
            ..Self::new(name, unit, applies, definition)
        }
    }

    /// A figure of a hardware pipeline.
    pub(crate) const fn of_pipelines(
        name: &'static str,
        unit: &'static str,
        definition: &'static str,
    ) -> Self {
        Self::of_filters(name, unit, Applies::Pipeline, definition).needs(Needs::Nothing)
    }

    /// A figure of a hardware pipeline of fixed-point words.
    pub(crate) const fn of_fixed_point(
        name: &'static str,
        unit: &'static str,
        definition: &'static str,
    ) -> Self {
        Self::of_filters(name, unit, Applies::FixedPoint, definition)
            .needs(Needs::Nothing)
            .by_choice()
    }

    /// A figure that twins of its record give of a filter.
    pub(crate) const fn of_twins(
        name: &'static str,
        unit: &'static str,
        definition: &'static str,
    ) -> Self {
        Self::of_filters(name, unit, Applies::Twins, definition)
            .needs(Needs::Nothing)
            .by_choice()
    }

    /// A figure of an estimate of a calibration campaign.
    pub(crate) const fn of_estimates(
        name: &'static str,
        unit: &'static str,
        definition: &'static str,
    ) -> Self {
        Self::new(name, unit, Applies::Calibration, definition)
    }

    /// The same under a heading of its own; without one the key stands for it.
    pub(crate) const fn heading(self, heading: &'static str) -> Self {
        Self {
            heading: Some(heading),
            ..self
        }
    }

    /// The same, the lower the better.
    pub(crate) const fn lower_is_better(self) -> Self {
        Self {
            better: Better::Lower,
            ..self
        }
    }

    /// The same, the higher the better.
    pub(crate) const fn higher_is_better(self) -> Self {
        Self {
            better: Better::Higher,
            ..self
        }
    }

    /// The same, moved by no noise.
    pub(crate) const fn of_settings(self) -> Self {
        Self {
            is_of_settings: true,
            ..self
        }
    }

    /// The same, given by blocks of the record.
    pub(crate) const fn of_blocks(self, of_blocks: OfBlocks) -> Self {
        Self {
            of_blocks: Some(of_blocks),
            ..self
        }
    }

    /// The same, giving back what a key of the scenario says.
    pub(crate) const fn echoing(self, key: &'static str) -> Self {
        Self {
            echoes: Some(key),
            ..self
        }
    }

    /// The same, known by other names too.
    pub(crate) const fn synonyms(self, synonyms: &'static [&'static str]) -> Self {
        Self { synonyms, ..self }
    }

    /// The same with what a record must offer.
    pub(crate) const fn needs(self, needs: Needs) -> Self {
        Self { needs, ..self }
    }

    /// The same compared with more than raw.
    pub(crate) const fn against(self, against: Against) -> Self {
        Self { against, ..self }
    }

    /// The same pooled otherwise than by its mean.
    pub(crate) const fn pooled(self, pool: Pool) -> Self {
        Self { pool, ..self }
    }

    /// The same as column `place` of `runs.csv`, from 1.
    pub(crate) const fn run_column(self, place: u8) -> Self {
        Self {
            run_column: Some(place),
            ..self
        }
    }

    /// The same of the axis alone about which the table turns.
    pub(crate) const fn of_turned_axis(self) -> Self {
        Self {
            is_of_turned_axis: true,
            ..self
        }
    }

    /// The same of records of one motion alone.
    pub(crate) const fn of_one_motion(self) -> Self {
        Self {
            is_of_one_motion: true,
            ..self
        }
    }

    /// The same, missed by nobody who did not ask for it.
    pub(crate) const fn by_choice(self) -> Self {
        Self {
            is_by_choice: true,
            ..self
        }
    }

    /// The same as slow noise.
    pub(crate) const fn slow_noise(self) -> Self {
        Self {
            is_slow_noise: true,
            ..self
        }
    }

    /// The same with a column in the tables of these motions.
    pub(crate) const fn tables(self, tables: &'static [Table]) -> Self {
        Self { tables, ..self }
    }

    /// The same in the suite's lines of these motions.
    pub(crate) const fn headlines(self, headlines: &'static [Headline]) -> Self {
        Self { headlines, ..self }
    }

    /// The same as a last column of every table, where a channel has it.
    pub(crate) const fn closing_tables(self) -> Self {
        Self {
            closes_tables: true,
            ..self
        }
    }

    /// Heading of its column: its own, or the key without underscores.
    #[must_use]
    pub fn title(&self) -> String {
        self.heading
            .map_or_else(|| self.name.replace('_', " "), str::to_owned)
    }

    /// What the channel is compared with beside raw, in words; empty for nothing.
    #[must_use]
    pub fn reference(&self) -> &'static str {
        self.against.words()
    }

    /// How independent repeats are pooled, in words.
    #[must_use]
    pub fn pooling(&self) -> String {
        self.pool.words()
    }

    /// Whether the suite's lines show it for the motion of a record that has these metrics.
    #[must_use]
    pub fn is_headline_of(&self, record: &[&Self]) -> bool {
        let shown: Vec<Headline> = record
            .iter()
            .flat_map(|other| other.applies.headlines().iter().copied())
            .collect();
        let is_shown = |headline: &Headline| shown.is_empty() || shown.contains(headline);
        self.headlines.iter().any(is_shown)
    }

    /// Whether nobody misses it who did not ask for it: a record need not have it.
    #[must_use]
    pub fn is_by_choice(&self) -> bool {
        self.is_by_choice
    }

    /// Whether the scatter of repeats gives it, which a single record cannot.
    pub(crate) fn is_repeatability(&self) -> bool {
        matches!(self.pool, Pool::ScatterOf(_) | Pool::RelativeScatterOf(_))
    }
}
