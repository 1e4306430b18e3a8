//! States of the RLS pipeline.

use crate::fpga::registers::control_states;

control_states! {
    /// States of the control machine.
    pub enum RlsState {
        /// Waiting for a strobe.
        Idle = "Idle",
        /// The new regressor word enters the ring, the desired word its register.
        RiLLoading = "RiL_loading",
        /// `t = R L`: one product per clock.
        RiLReading = "RiL_reading",
        /// The last sum of a row goes to both memories.
        RiLWriting = "RiL_writing",
        /// `den = alpha + L't`: one product per clock.
        LrlReading = "LRL_reading",
        /// The last sum goes to the register DEN.
        LrlWriting = "LRL_writing",
        /// Correction of an element of R: product, then division or reciprocal product.
        RfrReading = "RFR_reading",
        /// The corrected element is written back.
        RfrWriting = "RFR_writing",
        /// `M = R L` with the updated R.
        RfmReading = "RFM_reading",
        /// The last sum of a row goes to RAMA.
        RfmWriting = "RFM_writing",
        /// `y = W'L`.
        OutReading = "Out_reading",
        /// The last sum goes to the output register.
        OutWriting = "Out_writing",
        /// Error in the first clock, then product and weight of each tap.
        RfwReading = "RFW_reading",
        /// The new weight is written back.
        RfwWriting = "RFW_writing",
        /// After a reset: the words of both memories are written anew.
        Clearing = "Clearing",
    }
}
