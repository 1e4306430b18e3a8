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
//! [`ConstrainedRls`], least squares among the filters that leave a constant rate alone. A filter that diverges says so in every step from then on and never
//! returns another number.
//!
//! Words are rates in deg/h, but the equations only ask that the constants fit the words: the
//! initial inverse correlation is in the inverse square of the words' unit, the regularisation of
//! the normalised step in its square.
//!
//! Invariant: a filter sees rate words and its own configuration, nothing else.

mod constrained;
mod core_filter;
mod divergence;
mod filter;
mod fixed;
mod front_end;
mod lms;
mod recursive;
mod rls;
mod sign_lms;
mod stability;

pub use constrained::{ConstrainedRls, ConstrainedRlsCore};
pub use core_filter::{Core, CoreFilter};
pub use divergence::{Divergence, DivergenceKind, Fault, Watch};
pub use filter::{Filter, Output};
pub use fixed::{FixedCore, FixedFilter, moving_average, savitzky_golay};
pub use front_end::{FrontEndConfig, Register, adaptive_rule};
pub use lms::{Lms, LmsConfig, LmsCore, Normalisation};
pub use recursive::{
    Kalman, KalmanCore, RecursiveFilter, SectionsCore, butterworth, kalman_gain, one_pole,
};
pub use rls::{Rls, RlsConfig, RlsCore};
pub use sign_lms::{
    SignLms, SignLmsConfig, SignLmsCore, sign_lms_slew_per_sample, sign_lms_slew_samples,
};
pub use stability::{
    constant_eigenvalue_max, covariance_digits_warning, lms_step_bound, sine_eigenvalue_max,
};
