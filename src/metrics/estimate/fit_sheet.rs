//! What results hold of a fit of noise terms, beside the coefficients themselves.

use std::collections::BTreeMap;

/// One term of a noise fit.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FitTerm {
    /// Square of the coefficient, of either sign: its mean over records is the true one.
    pub square: f64,
    /// Standard error of the square.
    pub standard_error: f64,
    /// Unit of the square.
    pub unit: String,
    /// Whether the curve was fitted with it; else the square is what it would be beside the others.
    pub is_in_model: bool,
}

/// A noise fit as it was judged.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct FitSheet {
    /// Whether the terms describe the curve.
    pub is_adequate: bool,
    /// `chi_squared`, `degrees_of_freedom`, `p_value`, `largest_misfit` and what else the judgement rests
    /// on, by name.
    pub numbers: BTreeMap<String, f64>,
    /// Averaging times at which the curve lies outside the band of the fit, s.
    pub missed_tau_s: Vec<f64>,
    /// Terms by the key of their metric.
    pub terms: BTreeMap<String, FitTerm>,
}

impl FitSheet {
    /// A number of the judgement.
    #[must_use]
    pub fn number(&self, name: &str) -> Option<f64> {
        self.numbers.get(name).copied()
    }
}
