//! LMS and NLMS in fixed point.
//!
//! States, clocks and control are those of [`crate::fpga::lms`], whose `lms_ctrl.v` drives this data path too;
//! the core takes d from its port, and the front end forms a mean.
//!
//! ```text
//! den  = Q_den(eps + L0*L0 + L1*L1 + ...)            NLMS only; sums exact, rounded once
//! k    = Q_k(mu)                                     NLMS: Q_k(mu / den)
//! y    = Q_y(L0*W0 + L1*W1 + ...)                    weights before the update
//! e    = Q_y(d - y)
//! t    = Q_t(e*k)
//! W[j] = Q_W(W[j] + L[j]*t)
//! ```
//!
//! RAMA: ring of L, words of x. RAMB: W, tap 0 first. Reset: registers 0, then N clocks of clearing. T has a
//! register of its own beside E, whose words it would not fit.
//!
//! Source: derived; the same order as in floating point, so that every difference is one of words.
//!
//! Checked by `fixed_lms`.

mod config;
mod declaration;
mod engine;
mod machine;

pub use config::{FixedLmsConfig, FixedLmsSettings};
pub use declaration::LMS_FIXED;
pub use engine::FixedLmsEngine;
pub use machine::{FixedLmsMachine, FixedLmsPipeline};
