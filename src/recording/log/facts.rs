//! What a log is, and the part of it that is measured.

use super::record::{Log, Stretch};

/// What a recorded log is, as the report prints it.
#[derive(Clone, Debug, PartialEq)]
pub struct LogFacts {
    /// Name of the file, without its folder.
    pub file: String,
    /// Column of the rate, where the file has several.
    pub column: Option<String>,
    /// Unit it was recorded in.
    pub unit: String,
    /// Samples per second, Hz.
    pub sample_rate_hz: f64,
    /// Samples of the whole log.
    pub samples: usize,
    /// Parts between which samples are missing.
    pub parts: usize,
    /// Whether a sample is missing.
    pub has_gaps: bool,
    /// Whether a column of the log shows the true rate.
    pub has_truth: bool,
    /// Digest of its words and those of the true rate, by which a log is known again; empty until it is
    /// entered.
    pub digest: String,
}

impl Log {
    /// What it is, without its words.
    #[must_use]
    pub fn facts(&self) -> LogFacts {
        LogFacts {
            file: self.file.clone(),
            column: self.column.clone(),
            unit: self.unit.clone(),
            sample_rate_hz: self.sample_rate_hz,
            samples: self.rate_deg_per_h.len(),
            parts: self.stretches.len(),
            has_gaps: self.has_gaps(),
            has_truth: !self.reference_deg_per_h.is_empty(),
            digest: String::new(),
        }
    }

    /// The log with other words in the place of its own.
    #[must_use]
    pub fn with_words(&self, rate_deg_per_h: Vec<f64>) -> Self {
        let stretches = self.stretches.iter();
        let stretches = stretches.map(|it| Stretch::of(&rate_deg_per_h, it.words.clone()));
        Self {
            stretches: stretches.collect(),
            rate_deg_per_h,
            ..self.clone()
        }
    }

    /// Leaves out what stands behind the first `count` words.
    pub fn keep_first(&mut self, count: usize) {
        if count >= self.rate_deg_per_h.len() {
            return;
        }
        self.rate_deg_per_h.truncate(count);
        self.reference_deg_per_h.truncate(count);
        self.bridges.retain(|bridge| bridge.words.end < count);
        self.temperature_c.truncate(count);
        self.stretches.retain(|stretch| stretch.words.start < count);
        for stretch in &mut self.stretches {
            if stretch.words.end > count {
                *stretch = Stretch::of(&self.rate_deg_per_h, stretch.words.start..count);
            }
        }
    }
}
