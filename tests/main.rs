//! The one integration-test binary.

mod bit_exact;
mod cycle_exact;
mod fpga_health;
mod rtl;
mod support;
mod timing;
mod waveform;
