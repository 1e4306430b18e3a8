//! Closed-loop fibre-optic gyros on a rate table, and the filters behind them on trial.
//!
//! The crate simulates a gyro from the optics up on a turntable, feeds its rate words to filters, and
//! measures what they did to them: noise, bias stability, scale factor, bandwidth, delay and DC gain,
//! each with an interval. A filter can also be a model of FPGA hardware, exact to the bit and the clock.
//!
//! ```text
//!  scenario ──> turntable ──truth──> gyro ──rate words──> filters ──> metrics ──> gate ──> report
//!  recording ──your own log──────────┘
//! ```
//!
//! # A scenario in memory
//!
//! A [`Scenario`] is read from TOML, changed key by key and run; a [`Run`] holds channels by name,
//! metrics by typed key, samples as slices and the verdicts of gates. No file is written before
//! [`Run::write`]. Every key has a default, which stands in [`scenario::reference_toml`].
//!
//! ```
//! use fogbench::Scenario;
//! use fogbench::metrics::catalogue::{DC_GAIN, NOISE_STD};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let run = Scenario::from_toml(
//!     r#"
//!     schema = 1
//!     name = "at-rest"
//!     duration_s = 5.0
//!     filter = [{ name = "rls", rls = {} }]
//!     "#,
//! )?
//! .set("filter[0].rls.taps", 8)?
//! .run()?;
//!
//! let (raw, filtered) = (run["raw"].metric(&NOISE_STD)?, run["rls"].metric(&NOISE_STD)?);
//! println!("noise {raw} deg/h, behind the filter {filtered} deg/h");
//! // What looks like a quieter gyro is a filter that shrinks the rate itself.
//! assert!(filtered.value < raw.value);
//! assert!(run["rls"].metric(&DC_GAIN)?.value < 0.9);
//!
//! let words = run.samples("rls")?;
//! assert_eq!(words.unit, "deg/h");
//! assert!((words.measured().len() as f64 * words.period_s - 5.0).abs() < 0.01);
//! # Ok(())
//! # }
//! ```
//!
//! # Stages alone
//!
//! * a filter on your own words: [`filters`], such as [`filters::Rls`];
//! * estimators on a slice: [`metrics::overlapping_allan`], [`metrics::fit_noise`],
//!   [`metrics::measure`];
//! * a gyro, word by word: [`gyro::Gyro`];
//! * a hardware pipeline, clock by clock: [`fpga::rls::RlsPipeline`];
//! * logs from files: [`recording::read_log`]; calibration of three axes: [`calibration`].
//!
//! The folder `examples` has a program for each.
//!
//! # Features
//!
//! All are on by default. With none there are the stages alone, on configurations made in Rust.
//!
//! | feature | what it adds |
//! |---|---|
//! | `scenario` | scenario files, gates, [`Scenario`] and [`Run`] |
//! | `report` | JSON, JUnit, CSV, NPY and SVG files: [`Run::write`] |
//! | `hdl` | vectors, waveforms and Verilog of hardware pipelines |
//! | `cli` | the program |
//!
//! Modules that this page does not list are internals: public for the program and the tests, free to
//! change.

// What one feature alone leaves without a user is none the less the same code.
#![cfg_attr(not(feature = "cli"), allow(dead_code, unused_imports))]

pub mod declare;
mod linear_algebra;
#[cfg(feature = "scenario")]
mod program;
pub mod random;
#[cfg(feature = "scenario")]
mod seal;
pub mod signal;
mod simd;
pub mod units;
pub mod vocabulary;
mod wording;

// In the order of the data flow.
#[cfg(feature = "scenario")]
pub mod scenario;

pub mod turntable;

pub mod gyro;

pub mod fpga;

pub mod filters;

pub mod metrics;

pub mod calibration;

pub mod recording;

#[cfg(feature = "scenario")]
#[doc(hidden)]
pub mod inference;

#[cfg(feature = "scenario")]
pub mod gate;

#[cfg(feature = "scenario")]
#[doc(hidden)]
pub mod comparison;

#[cfg(feature = "report")]
#[doc(hidden)]
pub mod baseline;

#[cfg(feature = "report")]
#[doc(hidden)]
pub mod report;

#[cfg(feature = "report")]
#[doc(hidden)]
pub mod store;

#[cfg(feature = "scenario")]
#[doc(hidden)]
pub mod experiment;

#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod cli;

#[cfg(feature = "scenario")]
pub use experiment::{Plan, Progress, Run, RunError, Samples, Scenario, UnknownName, plan_suite};
#[cfg(feature = "report")]
pub use experiment::{SuiteError, SuiteOptions, SuiteOutcome, write_runs};
