//! States of the LMS pipeline.

use crate::fpga::registers::control_states;

control_states! {
    /// States of the control machine.
    pub enum LmsState {
        /// Waiting for a strobe.
        Idle = "Idle",
        /// The new word enters the ring; the desired word is latched or begun.
        LLoading = "L_loading",
        /// NLMS: energy `eps + L'L`, one product per clock.
        LlReading = "LL_reading",
        /// NLMS: the last sum goes to DEN.
        LlWriting = "LL_writing",
        /// `y = W'L`, one product per clock.
        OutReading = "Out_reading",
        /// The last sum goes to Y; D is halved if it is a mean.
        OutWriting = "Out_writing",
        /// Error; NLMS: step over energy.
        Err = "ERR",
        /// The error times the step.
        Gain = "GAIN",
        /// Product of a tap.
        LmwReading = "LMW_reading",
        /// The new weight is written back.
        LmwWriting = "LMW_writing",
        /// After a reset: the words of both memories are written anew.
        Clearing = "Clearing",
    }
}
