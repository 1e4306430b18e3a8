//! Textbook filters: the oracle for the hardware pipelines, never called by them, and what a user
//! would compare them with.
//!
//! ```text
//!            ┌ regressors L = x[k-lag] .. x[k-lag-p+1] ──> W'L = y ──> output register ──> out
//!  x[k] ──> delay line                                       │
//!            └ desired d = x[k]  or  (x[k] + x[k-1]) / 2 ──> e = d - y ──> update of W
//! ```
//!
//! [`Rls`] is the gain form of recursive least squares as the books print it, [`Lms`] the least
//! mean squares filter, normalised or not, [`SignLms`] the line enhancer of patent CN101221046 with
//! its normalised and unity-gain forms. All share the front end, the output register and the
//! watch for divergence. Beside them stand [`FixedFilter`] (moving average, Savitzky-Golay),
//! [`RecursiveFilter`] (one pole, Butterworth), [`Kalman`] for a constant rate, and
//! [`ConstrainedRls`], least squares among the filters that leave a constant rate alone. A filter
//! that diverges says so in every step from then on and never returns another number.
//!
//! Beside these, words may come from outside: computed elsewhere ([`ReplayFilterConfig`]),
//! or made by a program of the user's ([`ProcessFilterConfig`]).
//!
//! A kind of filter is one file: the keys of its table, their checks, the filter they stand for and
//! its equations. [`FilterKind`] lists the kinds; [`hardware`] puts the pipelines of
//! [`fpga`](crate::fpga) on the bench and is the only part that knows them.
//!
//! Words are rates in deg/h, but the equations only ask that the constants fit the words: the
//! initial inverse correlation is in the inverse square of the words' unit, the regularisation of
//! the normalised step in its square.
//!
//! Invariant: a filter sees rate words and its own configuration, nothing else.

mod butterworth;
mod common;
mod constrained_rls;
pub mod hardware;
mod kalman;
mod kind;
mod lms;
mod moving_average;
mod one_pole;
mod process;
mod replay;
mod rls;
mod savitzky_golay;
mod sign_lms;
mod words;

pub use butterworth::{ButterworthFilterConfig, butterworth};
pub use common::{
    Complaint, Complaints, Core, CoreFilter, Divergence, DivergenceKind, Fault, Filter, FixedCore,
    FixedFilter, FrontEndConfig, Output, RecursiveFilter, Register, SectionsCore, Watch,
    adaptive_rule, least_squares_rule,
};
pub use constrained_rls::{ConstrainedRls, ConstrainedRlsCore, ConstrainedRlsFilterConfig};
pub use kalman::{
    Kalman, KalmanConfig, KalmanCore, KalmanFilterConfig, RateRandomWalk, kalman_gain,
};
use kind::kinds;
pub use kind::{
    Condition, ConditionalKey, ExpectedRun, ExpectedWords, FilterConfig, FilterSettings,
};
pub use lms::{
    Lms, LmsConfig, LmsCore, LmsFilterConfig, Normalisation, constant_eigenvalue_max,
    lms_step_bound, sine_eigenvalue_max,
};
pub use moving_average::{MovingAverageFilterConfig, moving_average};
pub use one_pole::{OnePoleFilterConfig, one_pole};
pub use process::{Parameter, Parameters, ProcessFilterConfig, ProcessMode, is_file_argument};
pub use replay::ReplayFilterConfig;
pub use rls::{Rls, RlsConfig, RlsCore, RlsFilterConfig, covariance_digits_warning};
pub use savitzky_golay::{SavitzkyGolayFilterConfig, savitzky_golay};
pub use sign_lms::{
    SignLms, SignLmsConfig, SignLmsCore, SignLmsFilterConfig, sign_lms_slew_per_sample,
    sign_lms_slew_samples,
};
pub use words::{FixedWords, HardwareWords, LmsWords, RlsWords, SignLmsWords, SignalWord};

// The kinds of filters, in the order in which the reference shows them.
kinds! {
    Rls(RlsFilterConfig) = "rls",
    Lms(LmsFilterConfig) = "lms",
    SignLms(SignLmsFilterConfig) = "sign_lms",
    ConstrainedRls(ConstrainedRlsFilterConfig) = "constrained_rls",
    MovingAverage(MovingAverageFilterConfig) = "moving_average",
    SavitzkyGolay(SavitzkyGolayFilterConfig) = "savitzky_golay",
    OnePole(OnePoleFilterConfig) = "one_pole",
    Butterworth(ButterworthFilterConfig) = "butterworth",
    Kalman(KalmanFilterConfig) = "kalman",
    Replay(ReplayFilterConfig) = "replay",
    Process(ProcessFilterConfig) = "process",
}
