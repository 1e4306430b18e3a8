//! Words of the hardware pipelines.

use super::word::words;

words! {
    /// Words of a hardware pipeline.
    pub enum NumberFormat {
        /// IEEE 754 binary64.
        Binary64 = "binary64",
        /// IEEE 754 binary32.
        Binary32 = "binary32",
        /// binary64, subnormal numbers flushed to zero.
        Binary64FlushToZero = "binary64-ftz",
        /// binary32, subnormal numbers flushed to zero.
        Binary32FlushToZero = "binary32-ftz",
    }

    /// Where recursive least squares divides in the update of the inverse correlation.
    pub enum Division {
        /// Once per sample.
        ///
        /// `rcp = 1 / den`, then `(t_i t_j) rcp`.
        Reciprocal = "reciprocal",
        /// Once for each element of the matrix.
        ///
        /// `(t_i t_j) / den`: equation (8) of the paper to the letter.
        Elementwise = "elementwise",
    }

    /// Order of the two products in the update of the inverse correlation matrix R.
    pub enum UpdateOrder {
        /// `(t_i t_j) rcp`, the hardware's: both products commute and R stays symmetric to the last bit.
        Schedule = "schedule",
        /// `(t_i rcp) t_j`, the common textbook order, the gain vector first.
        ///
        /// The rounding errors of `R[i][j]` and `R[j][i]` differ, and their difference grows as
        /// `alpha^-k`: it fails below a forgetting factor of 1.
        GainFirst = "gain-first",
    }

    /// Floating-point units of an export of RTL.
    pub enum UnitSource {
        /// Computed by the simulator: fast, for simulation only.
        Behavioural = "behavioural",
        /// Verilog that synthesises.
        Synthesizable = "synthesizable",
    }

    /// Family of devices that an export of RTL is synthesised for.
    pub enum Device {
        /// Lattice iCE40.
        Ice40 = "ice40",
        /// Lattice ECP5.
        Ecp5 = "ecp5",
        /// AMD 7 series.
        Xilinx = "xilinx",
    }

    /// What an export of a pipeline writes.
    pub enum ExportForm {
        /// Stimulus, response, memories, parameters and per-clock trace.
        Vectors = "vectors",
        /// VCD and FST of the first samples.
        Waveform = "waveform",
        /// Verilog with a self-checking testbench, its vectors and a script.
        Rtl = "rtl",
    }
}
