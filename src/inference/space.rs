//! Parameters and what is thought of them before any figure is read.

use crate::vocabulary::Prior;

/// A number left open.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name.
    pub name: String,
    /// Unit; empty where it has none.
    pub unit: &'static str,
    /// Least value.
    pub low: f64,
    /// Greatest value.
    pub high: f64,
    /// What is thought of the values.
    pub prior: Prior,
}

impl Parameter {
    /// The value below which the prior has a part of its weight.
    #[must_use]
    pub fn at(&self, part: f64) -> f64 {
        match self.prior {
            Prior::Uniform => self.low + part * (self.high - self.low),
            Prior::LogUniform => self.low * (self.high / self.low).powf(part),
        }
    }
}

/// An answer to every question that is left open in words.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// Question and answer, in the order of the questions.
    pub answers: Vec<(String, String)>,
    /// Probability before any figure is read.
    pub weight: f64,
}
