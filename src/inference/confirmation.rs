//! Forecasts beside simulated records of the same settings.

use crate::inference::forecast::Forecast;

/// Error of a forecast over the standard deviation of its figure that is allowed.
const MODEL_ERROR: f64 = 0.3;
/// Standard errors of a simulated mean that are allowed beside it: of some hundred figures one in three
/// tables strays as far.
const STANDARD_ERRORS: f64 = 3.0;

/// A figure simulated, with the end of its interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Simulated {
    /// Value; of several repeats pooled.
    pub value: f64,
    /// Low end of the 95 % interval.
    pub low: f64,
    /// High end of the 95 % interval.
    pub high: f64,
}

/// A figure at known settings.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Confirmed {
    /// What the closed form expects; none where there is none.
    pub predicted: Option<Forecast>,
    /// On the rate model, over all repeats; none where the run does not have it.
    pub rate_model: Option<Simulated>,
    /// On the loop model, one record.
    pub loop_model: Option<Simulated>,
    /// Standard deviation of what printing adds.
    pub print_deviation: f64,
}

impl Confirmed {
    /// Standard deviation of the figure from record to record, print included; none without a forecast.
    fn deviation(&self) -> Option<f64> {
        let predicted = self.predicted?;
        Some(predicted.deviation.hypot(self.print_deviation))
    }

    /// Printed less simulated over the standard deviation of the figure.
    #[must_use]
    pub fn pull(&self, published: f64) -> Option<f64> {
        Some((published - self.rate_model?.value) / self.deviation()?)
    }

    /// Whether the forecast is as near to the records as it is said to be.
    ///
    /// * `repeats`: of the rate model.
    #[must_use]
    pub fn agrees(&self, repeats: u32) -> Option<bool> {
        let (predicted, deviation) = (self.predicted?, self.deviation()?);
        let near = |own: Simulated, count: u32| {
            let allowed = MODEL_ERROR * deviation
                + STANDARD_ERRORS * predicted.deviation / f64::from(count).sqrt();
            (own.value - predicted.value).abs() <= allowed
        };
        let rate = near(self.rate_model?, repeats);
        Some(rate && self.loop_model.is_none_or(|own| near(own, 1)))
    }
}

/// Settings that are simulated.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// Name.
    pub name: String,
    /// Place of the reading.
    pub reading: usize,
    /// Parts of the priors.
    pub parts: Vec<f64>,
    /// By figure; empty before they are simulated.
    pub figures: Vec<Confirmed>,
}

/// Forecasts beside simulated records.
#[derive(Clone, Debug, PartialEq)]
pub struct Confirmation {
    /// Repeats on the rate model.
    pub repeats: u32,
    /// Settings.
    pub candidates: Vec<Candidate>,
}

impl Confirmation {
    /// Whether records were simulated on the loop model as well.
    #[must_use]
    pub fn has_loop_model(&self) -> bool {
        let mut figures = self
            .candidates
            .iter()
            .flat_map(|candidate| &candidate.figures);
        figures.any(|figure| figure.loop_model.is_some())
    }

    /// Figures whose forecast is as near to the records as it is said to be, and all that were compared.
    #[must_use]
    pub fn agreeing(&self) -> (usize, usize) {
        let figures = self
            .candidates
            .iter()
            .flat_map(|candidate| &candidate.figures);
        let verdicts = figures.filter_map(|figure| figure.agrees(self.repeats));
        (
            verdicts.clone().filter(|agrees| *agrees).count(),
            verdicts.count(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_forecast_agrees_within_three_tenths_of_a_deviation_and_three_standard_errors() {
        let simulated = |value| {
            Some(Simulated {
                value,
                low: value,
                high: value,
            })
        };
        let figure = |rate, looped| Confirmed {
            predicted: Some(Forecast::normal(10.0, 1.0)),
            rate_model: simulated(rate),
            loop_model: simulated(looped),
            print_deviation: 0.0,
        };
        // 0.3 + 3 / sqrt(9) = 1.3 on the rate model, 3.3 on the loop model.
        assert_eq!(figure(11.29, 13.29).agrees(9), Some(true));
        assert_eq!(figure(11.31, 13.29).agrees(9), Some(false));
        assert_eq!(figure(11.29, 13.31).agrees(9), Some(false));
        let pull = figure(9.0, 10.0).pull(11.0);
        assert_eq!(pull, Some(2.0));
        let confirmation = Confirmation {
            repeats: 9,
            candidates: vec![Candidate {
                name: "best".to_owned(),
                reading: 0,
                parts: Vec::new(),
                figures: vec![
                    figure(11.31, 10.0),
                    figure(10.0, 10.0),
                    Confirmed::default(),
                ],
            }],
        };
        assert_eq!(confirmation.agreeing(), (1, 2));
    }
}
