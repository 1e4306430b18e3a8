//! From printed figures back to the settings that could have made them all.
//!
//! Invariant: plain numbers. What a figure is and how it is worked out stands elsewhere; this room knows
//! parameters with priors, readings to choose from, forecasts of figures and how the printed ones were
//! rounded.

mod answer;
mod calibration;
mod confirmation;
mod drawing;
mod forecast;
mod gate;
mod mixture;
mod problem;
mod search;
mod space;

pub use answer::{Answer, Explained, Judged, Question, Range, Ridge, Told};
pub use calibration::{Calibration, Levels, Outcome, SHIFT, Shifted, Truth};
pub use confirmation::{Candidate, Confirmation, Confirmed, Simulated};
pub use forecast::{Forecast, Forecasts, Likelihood, Print, Printed, Scatter, likelihood};
pub use gate::JudgedGate;
pub use problem::{
    ChoiceConfig, ExperimentConfig, LoggedConfig, ParameterConfig, PrintedConfig, ProblemConfig,
    ProblemGateConfig, RecordConfig,
};
pub(crate) use search::first_points;
pub use search::{Found, Point, Search, Visited};
pub use space::{Parameter, Reading};
