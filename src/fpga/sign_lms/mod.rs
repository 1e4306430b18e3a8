//! The line enhancer of patent CN101221046 on the structure of the RLS pipeline.
//!
//! ```text
//!              +-----------------------------+
//!  in_valid -->|  RAMA M       x  +  /       |--> out_valid
//!  x, d ------>|  RAMB M       one of each   |--> y
//!  in_ready <--|  11-state control machine   |
//!              +-----------------------------+
//! ```
//!
//! Ports as in [`crate::fpga::machine`]: d is the newest sample, x the one D samples ago, which the
//! front end's hold chain keeps. The output strobe is up in the clock ERR.
//!
//! Latency: `M + 5` clocks. Interval: `3M + 7`; one more after idling. At M = 20: 25 and 67.
//!
//! RAMA: ring of L. RAMB: W, initially the weight of reset. Further registers: X (input), S (norm),
//! T (fresh sum of it). Reset: words `+0`, DEN 1, HEAD M-1.
//!
//! | clock | state | RAMA | RAMB | registers at the clock's end |
//! |---|---|---|---|---|
//! | 0 | L_reading | rd (HEAD+1) mod M | | X<-x; D<-d; RR<-A (the word that leaves); P<-x*x |
//! | 1 | L_writing | wr the same <- X | | HEAD<-HEAD+1; last M samples of an interval: T<-T+P (first: +0+P) |
//! | 2 | NRM_adding | | | S<-S+P; P<-RR*RR |
//! | 3 | NRM_writing | | | S<-max(S-P, +0); last sample of an interval: S<-T |
//! | 4+j | Out_reading | rd slot(j) | rd j | P<-A*B; j=0: ACC<-+0, DEN<-ALPHA+S; else ACC<-ACC+P |
//! | M+4 | Out_writing | | | Y<-ACC+P |
//! | M+5 | ERR | | | E<-D-Y; RCP<-MU/DEN |
//! | M+6 | GAIN | | | E<-sgn(E)*RCP without arithmetic; normalised: E*RCP; held by the guard: +0 |
//! | M+7+2j | LMW_reading | rd slot(j) | rd j | P<-A*E; RR<-B |
//! | M+8+2j | LMW_writing | | wr j <- RR+P | |
//!
//! The adder is free in the first clock of a dot product, which is where the denominator is formed;
//! `+-x q` needs no product beyond `x q`, because a sign only turns a bit.
//!
//! The recursive norm keeps every rounding: after 1e5 samples at 50 deg/s and as many at rest,
//! an independent simulation in binary64 held 3.044275e-4 for a true 3.04427e-4, in binary32 0.339. A sum over the ring would cost
//! M clocks of the one multiplier. T instead gathers the squares that pass anyway: after M samples
//! it is the sum of the newest M, none of it older, and replaces S in the same clock as ever, so that
//! every sample takes the same clocks.
//!
//! Source: patent CN101221046, equations (25), (26), (34), (35); the patent has no hardware, the
//! schedule is derived.
//!
//! Checked by `sign_lms_hardware`.

mod clocks;
mod config;
mod declaration;
mod engine;
mod machine;
mod state;

pub use clocks::{sign_lms_clocks_per_sample, sign_lms_latency_clocks, sign_lms_stalled_clocks};
pub use config::{SignLmsConfig, SignLmsSettings};
pub use engine::SignLmsEngine;
pub use machine::{SignLmsMachine, SignLmsPipeline};
pub use state::SignLmsState;
