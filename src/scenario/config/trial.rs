//! Settings of the trial of the filters.

use crate::declare::table;
use crate::vocabulary::words;

table! {
    /// The trial of the filters.
    pub struct TrialConfig {
        /// Measure every filter's gain for constant rates from 0.001 to 100 deg/s. Each of eleven twins of
        /// the filter runs on the same words plus one rate and is free to adapt. Source of the default: it
        /// takes twelve times the time of the filter.
        rate_gain: bool = false;
        /// Measure look-ahead, memory, gains, delays, start-up, saturation, linearity and time invariance of every
        /// filter by twins of its own record, from its first word on, 2^20 words at most. Without it nothing is: in full it takes
        /// some seventy times the time of the filter.
        black_box: Option<BlackBoxTrial>, example "whole";
        /// Whether filters go on from one rate of a staircase or scale factor test to the next, or start
        /// afresh at each, half-way through settle_s. Source of the default: a filter in service is not reset when the rate changes.
        filter_state: FilterState = "carried";
    }
}

words! {
    /// What twins of the record are to show of a filter.
    pub enum BlackBoxTrial {
        /// Look-ahead, memory, delay of a word and gains, for a change of one size and sign.
        Brief = "brief",
        /// Everything, for changes of three sizes and both signs.
        Whole = "whole",
    }

    /// What becomes of the filters between the rates of a staircase or a scale factor test.
    pub enum FilterState {
        /// They go on with what they have learnt.
        Carried = "carried",
        /// They start afresh in every dwell, half-way through its settling.
        Reset = "reset",
    }
}
