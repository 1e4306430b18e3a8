//! Recorded logs in place of table and gyro.

mod compensation;
mod filters;
mod gates;
mod own_temperature;
mod pass;
mod run;
mod stream;
mod temperature;
mod trial;
#[cfg(feature = "report")]
mod written;

pub use compensation::{CompensatedLog, LogCompensation, compensate_log, load_log_compensation};
pub use filters::{LogFilters, load_log_filters};
pub use gates::{LogGates, load_log_gates};
pub use own_temperature::{LogTemperature, compensate_temperature, load_own_temperature};
pub use pass::{PassError, pass_log};
pub(crate) use run::run_log;
pub use stream::try_log_stream;
pub use trial::{LogInput, LogSettings, LogTrial, LogTrialError, SETTLE_S, try_log};
