//! Exports: golden vectors, waveforms, and RTL with a self-checking testbench.
//!
//! Every export simulates the clock-by-clock pipeline over the given pairs, back to back from
//! reset. One folder holds everything and runs from anywhere.
//!
//! | file | contents |
//! |---|---|
//! | `params.json` | every constant with its bits, and every choice that changes bits |
//! | `in.hex`, `y.hex` | x then d of each sample; the filtered words. One word a line |
//! | `ram_init.hex`, `ram_final.hex` | RAMA, then RAMB |
//! | `in_codes.hex` | the gyro's integer codes, i32, if given (their LSB in `params.json`) |
//! | `trace.csv` | per clock: state, memory ports, registers ([`crate::fpga::trace`]) |
//! | `wave.vcd`, `wave.fst`, `states.gtkwfilter` | a window of clocks with readable states |
//! | `params.vh` | the same for the testbench, as Verilog macros |
//! | `*_top.v`, `samples.hex` | the filter with its constants and its front end; its samples if not codes |
//! | `*_axis.v`, `axi_stream.v` | the top level with AXI4-Stream ports and flags |
//! | `synth.sh` | synthesis of the top level for a family of devices, if asked for |
//! | `*.v`, `*.vh`, `run.sh`, `test_cocotb.py` | RTL, testbench, script, cocotb test |
//! | `README.txt` | how to run it, every format, how to put in units or a core of one's own |
//!
//! Hexadecimal files end in a newline: some simulators drop the last word otherwise.
//!
//! Checked by `rtl`, `waveform`.

mod axis;
mod fixed;
mod fixed_params;
mod fixed_top;
mod params;
mod rtl;
mod signals;
mod top;
mod vectors;
mod waveform;

pub use super::kinds::PipelineConfig;
pub use fixed::{FixedExport, write_fixed_rtl, write_fixed_rtl_for, write_fixed_vectors};
pub use rtl::{RtlParts, write_rtl, write_rtl_parts};
pub use vectors::{ExportSettings, IntegerCodes, TopLevel, stimulus_pairs, write_vectors};
pub use waveform::write_waveform;
