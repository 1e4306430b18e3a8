//! States of the line enhancer.

use crate::fpga::registers::control_states;

control_states! {
    /// States of the control machine.
    pub enum SignLmsState {
        /// Waiting for a strobe.
        Idle = "Idle",
        /// The word that leaves the taps is read; square of the one that enters.
        LReading = "L_reading",
        /// The new word enters the ring; the fresh sum of the norm takes its square.
        LWriting = "L_writing",
        /// The norm takes the square of the new word; square of the old one.
        NrmAdding = "NRM_adding",
        /// The norm gives the square of the old word away, or is replaced.
        NrmWriting = "NRM_writing",
        /// `y = W'L`, one product per clock; the denominator in the first.
        OutReading = "Out_reading",
        /// The last sum goes to Y.
        OutWriting = "Out_writing",
        /// Error; step over energy.
        Err = "ERR",
        /// Step over energy with the sign of the error, or times the error.
        Gain = "GAIN",
        /// Product of a tap.
        LmwReading = "LMW_reading",
        /// The new weight is written back.
        LmwWriting = "LMW_writing",
        /// After a reset: the words of both memories are written anew.
        Clearing = "Clearing",
    }
}
