//! Recursive least squares in fixed point.
//!
//! ```text
//!              +-------------------------------+
//!  in_valid -->|  RAMA 2p       x  +  /        |--> out_valid
//!  x, d ------>|  RAMB 2p+p^2   one of each    |--> y
//!  in_ready <--|  15-state control machine     |
//!              +-------------------------------+
//! ```
//!
//! Not the schedule of [`crate::fpga::rls`]: `(t_i*t_j)*r` would need words of more than twenty
//! integer bits. The gain comes first, `k = t/den`, and only the elements of R on and above the
//! diagonal are corrected; those below are copies, so that R stays symmetric to the bit.
//!
//! ```text
//! t[i]    = Q_t(L0*R[i][0] + L1*R[i][1] + ...)             sums exact, rounded once
//! den     = Q_den(alpha + L0*t0 + L1*t1 + ...)
//! k[i]    = Q_k(t[i] / den)                                p divisions
//! R[i][j] = Q_R(Q_R(R[i][j] - k[i]*t[j]) * ialpha)         i <= j; alpha = 1: Q_R(R[i][j] - k[i]*t[j])
//! R[i][i] not below a floor, if there is one
//! y       = Q_y(L0*W0 + L1*W1 + ...)                       weights before the update
//! e       = Q_y(d - y)
//! W[i]    = Q_W(W[i] + k[i]*e)
//! ```
//!
//! Memories are single-port: RAMA `0..p` ring of L, `p..2p` k; RAMB `0..p` W, `p..2p` t, `2p+ip+j`
//! `R[i][j]`. Reset as of the floating-point pipelines: registers 0, then `p^2 + 2p` clocks of
//! clearing.
//!
//! | state | clocks | RAMA | RAMB | registers at the clock's end |
//! |---|---|---|---|---|
//! | RiL_loading | 1 | write ring | | HEAD, D |
//! | RiL_reading, _writing | p*p, p | L_j | R_ij; write t_i | P, ACC |
//! | LRL_reading, _writing | p, 1 | L_j | t_j | P, ACC (starts at alpha); DEN |
//! | GAIN_dividing | p | write k_i | t_i | |
//! | RFR_reading | p^2 + p | k_i | t_j, R_ij | P, RR |
//! | RFR_writing, _mirroring | p(p+1)/2, p(p-1)/2 | | write R_ij, R_ji | |
//! | Out_reading, _writing | p, 1 | L_j | W_j | P, ACC; Y |
//! | RFW_reading, _writing | 1+p, p | k_i | W_i; write W_i | E; P, RR |
//!
//! With units of several clocks each of these is a step, which lasts as long as the slowest unit in use; the
//! correction of R then takes three of them if alpha < 1: difference and product go to P, its rounding to RAMB.
//!
//! Interval: [`fixed_rls_clocks_per_sample`], latency: [`fixed_rls_latency_clocks`];
//! with slow units [`fixed_rls_stalled_clocks`].
//!
//! Source: derived; the order of operations follows trials that run on 22 to 36 bits.
//!
//! Checked by `fixed_point`.

mod clocks;
mod config;
mod declaration;
mod engine;
mod machine;

pub use clocks::{
    fixed_rls_clocks_per_sample, fixed_rls_latency_clocks, fixed_rls_stalled_clocks,
    fixed_rls_stalled_latency,
};
pub use config::{FixedRlsConfig, FixedRlsSettings, RlsFormats};
pub use declaration::RLS_FIXED;
pub use engine::FixedRlsEngine;
pub use machine::{FixedRlsMachine, FixedRlsPipeline, FixedRlsState};
