//! Least mean squares, plain and normalised, on the structure of the RLS pipeline.
//!
//! ```text
//!              +-----------------------------+
//!  in_valid -->|  RAMA N       x  +  /       |--> out_valid
//!  x, d ------>|  RAMB N       one of each   |--> y
//!  in_ready <--|  10-state control machine   |
//!              +-----------------------------+
//! ```
//!
//! Ports as in [`crate::fpga::machine`]; the output strobe is up in the clock ERR.
//!
//! Latency: [`lms_latency_clocks`]. Interval: [`lms_clocks_per_sample`]; one more after idling.
//!
//! RAMA: ring of L. RAMB: W. Reset: words `+0`, DEN 1, HEAD N-1. Further register XP: previous
//! input. The divider is only present in the normalised form.
//!
//! | state | clocks | RAMA | RAMB | registers at the clock's end |
//! |---|---|---|---|---|
//! | L_loading | 1 | write ring | | HEAD, XP, D (x + XP or the port) |
//! | LL_reading, _writing (NLMS) | N, 1 | L_j | | P, ACC (starts at eps); DEN |
//! | Out_reading, _writing | N, 1 | L_j | W_j | P, ACC; Y, D (halved) |
//! | ERR | 1 | | | E; NLMS: RCP = mu / DEN |
//! | GAIN | 1 | | | E times mu or RCP |
//! | LMW_reading, _writing | N, N | L_j | W_j; write W_j | P, RR |
//!
//! Source: derived. The paper compares with an LMS filter of order 10 and step 0.8 and gives no
//! schedule for it; this one uses the memories and units of its RLS pipeline. Read literally, the
//! step 0.8 is stable only for small inputs (`mu < 2 / lambda_max`); as an NLMS step it is safe.
//!
//! Checked by `cycle_exact`, `bit_exact`.

mod clocks;
mod config;
mod declaration;
mod engine;
mod machine;
mod state;

pub use clocks::{lms_clocks_per_sample, lms_latency_clocks, lms_stalled_clocks};
pub use config::{DesiredSource, LmsConfig, LmsSettings};
pub use engine::LmsEngine;
pub use machine::{LmsMachine, LmsPipeline};
pub use state::LmsState;
