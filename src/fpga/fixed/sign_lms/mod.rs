//! The line enhancer in fixed point.
//!
//! States, clocks and control are those of [`crate::fpga::sign_lms`], whose `sign_lms_ctrl.v` drives this data
//! path too.
//!
//! ```text
//! S    = S + x*x - o*o                                o the word that leaves the taps; exact
//! den  = Q_den(alpha + S)
//! k    = Q_k(mu / den)
//! y    = Q_y(L0*W0 + L1*W1 + ...)                     weights before the update
//! e    = Q_y(d - y)
//! t    = Q_t(sgn(e)*k)                                normalised: Q_t(e*k); held by the guard: 0
//! W[j] = Q_W(W[j] + L[j]*t)
//! ```
//!
//! The recursive norm is exact: it never keeps a rounding and cannot fall below zero, so that there is no fresh
//! sum to replace it by.
//!
//! RAMA: ring of L, words of x. RAMB: W, initially the weight of reset. Further registers: X (input), S
//! (norm). Reset: registers 0, then M clocks of clearing.
//!
//! Source: derived; the same order as in floating point, so that every difference is one of words.
//!
//! Checked by `fixed_lms`.

mod config;
mod declaration;
mod engine;
mod machine;

pub use config::{FixedSignLmsConfig, FixedSignLmsSettings};
pub use declaration::SIGN_LMS_FIXED;
pub use engine::FixedSignLmsEngine;
pub use machine::{FixedSignLmsMachine, FixedSignLmsPipeline};
