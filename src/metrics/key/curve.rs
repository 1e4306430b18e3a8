//! Declaration of a curve: name, columns with their units, pooling over repeats, files that show it.
//!
//! A curve is one [`CurveKey`], declared with its [`Column`]s beside its computation and listed in
//! [`catalogue`](crate::metrics::catalogue). Pooling, CSV files, pictures and the documentation read
//! that row.

use std::collections::BTreeMap;

/// A curve: columns by name.
pub type Curve = BTreeMap<String, Vec<f64>>;

/// Declaration of a column of a curve.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Column {
    /// Name in results and files.
    pub name: &'static str,
    unit: &'static str,
    definition: &'static str,
    /// The column of the values, for an end of their intervals.
    pub(crate) end_of: Option<&'static Column>,
}

impl PartialEq for Column {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Column {
    /// A column of numbers.
    pub(crate) const fn new(
        name: &'static str,
        unit: &'static str,
        definition: &'static str,
    ) -> Self {
        Self {
            name,
            unit,
            definition,
            end_of: None,
        }
    }

    /// A column of words; a single word holds for all points.
    pub(crate) const fn words(name: &'static str, definition: &'static str) -> Self {
        Self::new(name, "word", definition)
    }

    /// Lower ends of the intervals of another column.
    pub(crate) const fn low(name: &'static str, of: &'static Self) -> Self {
        Self {
            end_of: Some(of),
            ..Self::new(name, "", "lower end of its 95 % interval")
        }
    }

    /// Upper ends of the intervals of another column.
    pub(crate) const fn high(name: &'static str, of: &'static Self) -> Self {
        Self {
            end_of: Some(of),
            ..Self::new(name, "", "upper end of its 95 % interval")
        }
    }

    /// Unit as printed; `1` for a ratio or a count, `word` for words.
    #[must_use]
    pub fn unit(&self) -> &'static str {
        self.end_of.map_or(self.unit, Self::unit)
    }

    /// Definition in one line.
    #[must_use]
    pub fn definition(&self) -> &'static str {
        self.definition
    }

    /// Its values in a curve; none where the curve lacks it.
    #[must_use]
    pub fn get<'a>(&self, curve: &'a Curve) -> Option<&'a [f64]> {
        curve.get(self.name).map(Vec::as_slice)
    }

    /// Its values in a curve, empty where the curve lacks it.
    #[must_use]
    pub fn of<'a>(&self, curve: &'a Curve) -> &'a [f64] {
        self.get(curve).unwrap_or_default()
    }
}

/// How independent repeats of a curve are pooled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CurvePool {
    /// Means of the Allan variances, degrees of freedom added.
    AllanVariance,
    /// Mean of the powers.
    Power,
    /// Means of the columns; intervals shrink with the root of the number of repeats.
    Points,
}

impl CurvePool {
    /// The same in words.
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::AllanVariance => "mean of the Allan variances, degrees of freedom added",
            Self::Power => "mean of the powers",
            Self::Points => {
                "mean of the columns, intervals shrunk by the root of the number of repeats"
            }
        }
    }
}

/// Declaration of a curve.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct CurveKey {
    /// Name in results.
    pub name: &'static str,
    /// Definition in one line.
    pub definition: &'static str,
    /// Columns of numbers, what the others go with first.
    pub columns: &'static [&'static Column],
    /// Columns of words.
    pub words: &'static [&'static Column],
    /// CSV file that holds it, of every channel; none if it stands in `summary.json` alone.
    pub csv: Option<&'static str>,
    /// Picture that shows it.
    pub picture: Option<&'static str>,
    pub(crate) pool: CurvePool,
}

impl PartialEq for CurveKey {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl CurveKey {
    /// A curve of numbers in `summary.json`, pooled point by point.
    pub(crate) const fn new(
        name: &'static str,
        columns: &'static [&'static Column],
        definition: &'static str,
    ) -> Self {
        Self {
            name,
            definition,
            columns,
            words: &[],
            csv: None,
            picture: None,
            pool: CurvePool::Points,
        }
    }

    /// The same with columns of words.
    pub(crate) const fn with_words(self, words: &'static [&'static Column]) -> Self {
        Self { words, ..self }
    }

    /// The same in a CSV file of its own.
    pub(crate) const fn csv(self, file: &'static str) -> Self {
        Self {
            csv: Some(file),
            ..self
        }
    }

    /// The same shown in a picture.
    pub(crate) const fn picture(self, file: &'static str) -> Self {
        Self {
            picture: Some(file),
            ..self
        }
    }

    /// The same pooled otherwise than point by point.
    pub(crate) const fn pooled(self, pool: CurvePool) -> Self {
        Self { pool, ..self }
    }

    /// How repeats are pooled, in words.
    #[must_use]
    pub fn pooling(&self) -> &'static str {
        self.pool.words()
    }

    /// Whether a column of numbers or words is declared for it.
    pub(crate) fn has(&self, column: &Column) -> bool {
        let declared = self.columns.iter().chain(self.words);
        declared.into_iter().any(|own| *own == column)
    }
}
