//! Recursive least squares as an alternate-storage multiply-accumulate pipeline.
//!
//! ```text
//!              +-----------------------------+
//!  in_valid -->|  RAMA 2p      x  +  /       |--> out_valid
//!  x, d ------>|  RAMB 2p+p^2  one of each   |--> y
//!  in_ready <--|  14-state control machine   |
//!              +-----------------------------+
//! ```
//!
//! Ports as in [`crate::fpga::machine`]; the output strobe is up in the first RFW clock.
//!
//! Latency: [`rls_latency_clocks`] from the accepting clock to the strobe of the result.
//! Interval: [`rls_clocks_per_sample`] back to back; one more when the machine was idle.
//!
//! Memories are single-port: RAMA `0..p` ring of L, `p..2p` t then M; RAMB `0..p` W, `p..2p` t,
//! `2p+ip+j` `R[i][j]`. Storing t in both lets `L_j*t_j` and `t_i*t_j` read two memories in one
//! clock. Reset: words `+0`, `R = delta*I`, DEN 1, HEAD p-1. slot(j) = (HEAD-j) mod p.
//!
//! | state | clocks | RAMA | RAMB | registers at the clock's end |
//! |---|---|---|---|---|
//! | RiL_loading | 1 | write ring | | HEAD, D |
//! | RiL_reading, _writing | p*p, p | L_j; write t_i | R_ij; write t_i | P, ACC |
//! | LRL_reading, _writing | p, 1 | L_j | t_j | P, ACC (starts at alpha); DEN |
//! | RFR_reading, _writing | 2p^2, p^2 | t_i | t_j, R_ij; write R_ij | RCP once, P, RR |
//! | RFM_reading, _writing | p*p, p | L_j; write M_i | R_ij | P, ACC |
//! | Out_reading, _writing | p, 1 | L_j | W_j | P, ACC; Y |
//! | RFW_reading, _writing | 1+p, p | M_i | W_i; write W_i | E; P, RR |
//!
//! Rounding: every operation alone, to nearest even (see [`crate::fpga::float_unit`]); overflow
//! to infinity. A NaN or infinite sample poisons R and W for good, as in hardware.
//!
//! Source: Ma et al., Chinese J. Lasers 49(21) 2106004 (2022), section 3: memory depths and
//! clocks per state. Inferred, being the only reading that fits them with one adder and one
//! multiplier: t in both memories, alpha as the first summand, the error in the first RFW clock,
//! the division once per sample. Signs of eqs. (6) and (9) corrected.
//!
//! Checked by `cycle_exact`, `bit_exact`.

mod clocks;
mod config;
mod declaration;
mod engine;
mod machine;
mod schedule;
mod state;
mod table;

pub use clocks::{
    RlsLoad, rls_clocks_per_sample, rls_latency_clocks, rls_stalled_clocks, rls_stalled_latency,
};
pub use config::{RlsConfig, RlsSettings};
pub use declaration::RlsCore;
pub use engine::RlsEngine;
pub use machine::{RlsMachine, RlsPipeline};
pub use schedule::{Bound, ScheduleReport, ScheduleSettings, schedule_clocks};
pub use state::RlsState;
pub use table::{Basis, Design, TimingRow, table};
