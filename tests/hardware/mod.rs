//! Hardware pipelines and their exports: words, clocks, ports, word lengths.

mod axi_stream;
mod bit_exact;
mod board;
mod cli_fpga;
mod cycle_exact;
mod en_cl_fix;
mod fixed_lms;
mod fixed_point;
mod fpga_health;
mod pipeline;
mod resets;
mod rtl;
mod rtl_mutants;
mod rtl_units;
mod sign_lms_hardware;
mod timing;
mod waveform;
mod word_length;
