//! From printed figures back to the settings that could have made them all.
//!
//! Invariant: plain numbers. What a figure is and how it is worked out stands elsewhere; this room knows
//! parameters with priors, readings to choose from, forecasts of figures and how the printed ones were
//! rounded.

mod answer;
mod forecast;
mod problem;
mod search;
mod space;

pub use answer::{Answer, Explained, Judged, Question, Range, Ridge, Told};
pub use forecast::{Forecast, Forecasts, Likelihood, Print, Printed, Scatter, likelihood};
pub use problem::{
    ChoiceConfig, ExperimentConfig, ParameterConfig, PrintedConfig, ProblemConfig, RecordConfig,
};
pub use search::{Found, Point, Search};
pub use space::{Parameter, Reading};
