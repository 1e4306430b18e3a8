//! Gates of a problem.

use crate::inference::answer::Answer;
use crate::inference::confirmation::Confirmation;
use crate::inference::problem::ProblemGateConfig;
use crate::vocabulary::InferredQuantity;

/// A gate that was judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JudgedGate {
    /// What it judges.
    pub of: InferredQuantity,
    /// Its value; none where nothing was found of it.
    pub value: Option<f64>,
    /// Least value that is accepted.
    pub min: Option<f64>,
    /// Greatest value that is accepted.
    pub max: Option<f64>,
}

impl JudgedGate {
    /// A gate beside what was found.
    #[must_use]
    pub fn of(
        gate: &ProblemGateConfig,
        answer: &Answer,
        confirmation: Option<&Confirmation>,
    ) -> Self {
        Self {
            of: gate.of,
            value: value(gate.of, answer, confirmation),
            min: gate.min,
            max: gate.max,
        }
    }

    /// Whether there is a value, within the limits.
    #[must_use]
    pub fn is_accepted(&self) -> bool {
        let (low, high) = (
            self.min.unwrap_or(f64::NEG_INFINITY),
            self.max.unwrap_or(f64::INFINITY),
        );
        self.value
            .is_some_and(|value| (low..=high).contains(&value))
    }
}

fn value(
    of: InferredQuantity,
    answer: &Answer,
    confirmation: Option<&Confirmation>,
) -> Option<f64> {
    let (explained, told) = answer.explained();
    let pulls = answer.figures.iter().filter_map(|figure| figure.pull);
    match of {
        InferredQuantity::UnexplainedFigures => Some((told - explained) as f64),
        InferredQuantity::LargestPull => pulls.map(f64::abs).reduce(f64::max),
        InferredQuantity::AcceptedReadings => Some(answer.accepted().count() as f64),
        InferredQuantity::WeightOfBest => answer.readings.first().map(|judged| judged.weight),
        InferredQuantity::DisagreeingForecasts => confirmation.map(|confirmation| {
            let (agreeing, all) = confirmation.agreeing();
            (all - agreeing) as f64
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gate_without_a_value_fails_and_its_limits_are_accepted() {
        let gate = |value, min, max| JudgedGate {
            of: InferredQuantity::LargestPull,
            value,
            min,
            max,
        };
        assert!(gate(Some(3.0), None, Some(3.0)).is_accepted());
        assert!(!gate(Some(3.1), None, Some(3.0)).is_accepted());
        assert!(!gate(Some(0.4), Some(0.5), None).is_accepted());
        assert!(!gate(None, None, Some(3.0)).is_accepted());
    }
}
