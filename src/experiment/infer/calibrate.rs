//! Settings drawn from the priors, their figures inferred: how often answers hold the truth.

use rayon::prelude::*;

use super::bench::Bench;
use super::simulated::{Settings, SimulationError, simulate};
use super::{Inference, question, search};
use crate::inference::{Calibration, Levels, Outcome, SHIFT, Shifted, Truth};
use crate::random::{Stream, Streams};

/// Draws of settings after which a reading has no gyro.
const TRIES: usize = 1000;

/// Where the figures of known settings come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Figures {
    /// Drawn from their forecasts.
    Drawn,
    /// Simulated records.
    Simulated,
}

/// How answers are calibrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CalibrateInference {
    /// Number of draws.
    pub draws: u32,
    /// Where the figures come from.
    pub figures: Figures,
}

impl Inference {
    /// Draws settings from the priors, makes their figures, prints and infers them.
    ///
    /// * `done`: hears of every draw that is done.
    ///
    /// # Errors
    /// Why a record cannot be simulated.
    pub fn calibrate(
        &self,
        how: CalibrateInference,
        done: &(dyn Fn() + Sync),
    ) -> Result<Calibration, SimulationError> {
        let outcomes: Result<Vec<Outcome>, SimulationError> = (0..how.draws)
            .into_par_iter()
            .map(|draw| {
                let outcome = self.draw(draw, how.figures)?;
                done();
                Ok(outcome)
            })
            .collect();
        Ok(Calibration::of(outcomes?, self.bench.readings.len()))
    }

    /// One draw and what its answer is worth.
    fn draw(&self, draw: u32, figures: Figures) -> Result<Outcome, SimulationError> {
        let bench = &self.bench;
        // The search of the printed figures has the seed itself.
        let seed = self.problem.config.seed.wrapping_add(1 + u64::from(draw));
        let mut stream = Streams::new(seed, 0).stream("calibration");
        let mut truth = settings(bench, &mut stream).ok_or(SimulationError::NoGyro(TRIES))?;
        let drawn = match figures {
            Figures::Drawn => truth.forecasts.drawn(&mut stream),
            Figures::Simulated => {
                let settings = Settings {
                    reading: truth.reading,
                    values: bench.values(&truth.parts),
                };
                let measured = simulate(&self.problem, bench, &settings, seed)?;
                let told = truth.forecasts.figures.iter().zip(measured);
                told.map(|(forecast, value)| forecast.and(value)).collect()
            }
        };
        for (printed, figure) in truth.printed.iter_mut().zip(&drawn) {
            if let Some(figure) = figure {
                *printed = printed.with(*figure, &mut stream);
            }
        }
        let found = search(&self.problem, bench, &truth.printed, seed);
        let question = question(&self.problem, bench, &truth.printed, Levels::default());
        let answer = question.answer(&found);
        let shifted = self.shifted(&truth, draw, seed);
        let bound = truth.bound(&mut bench.forecaster(truth.reading));
        let doubt = self.problem.config.doubt;
        Ok(truth.outcome((&answer, &found), doubt, bound, shifted))
    }

    /// What is said of one figure of the truth once it is shifted: a figure after the other by draw, up
    /// and down in turn.
    fn shifted(&self, truth: &Truth, draw: u32, seed: u64) -> Shifted {
        let told: Vec<usize> = (0..truth.printed.len())
            .filter(|figure| truth.forecasts.figures[*figure].is_some())
            .collect();
        if told.is_empty() {
            return Shifted::Open;
        }
        let turn = draw as usize;
        let figure = told[turn % told.len()];
        let sign = if (turn / told.len()).is_multiple_of(2) {
            1.0
        } else {
            -1.0
        };
        let deviation = truth.deviation(figure).unwrap_or_default();
        let mut printed = truth.printed.clone();
        printed[figure].value += sign * SHIFT * deviation;
        let found = search(&self.problem, &self.bench, &printed, seed);
        let question = question(&self.problem, &self.bench, &printed, Levels::default());
        Truth::shifted(&question.explain(figure, &found))
    }
}

/// Settings from the priors, with what their figures are expected to be.
fn settings(bench: &Bench, stream: &mut Stream) -> Option<Truth> {
    for _ in 0..TRIES {
        let mut left = stream.uniform();
        let mut reading = 0;
        for (index, own) in bench.readings.iter().enumerate() {
            reading = index;
            left -= own.weight;
            if left < 0.0 {
                break;
            }
        }
        let parts: Vec<f64> = bench.parameters.iter().map(|_| stream.uniform()).collect();
        if let Some(forecasts) = bench.forecaster(reading)(&parts) {
            return Some(Truth {
                reading,
                parts,
                forecasts,
                printed: bench.printed.clone(),
            });
        }
    }
    None
}
