//! What a sample costs in hardware.

use crate::fpga::board::BoardUsage;
use crate::fpga::timing::{Usage, sample_period_us, sample_rate_max_khz};

/// What one sample costs, counted on the running model.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PipelineTiming {
    /// Clocks, states, ports and units of one back-to-back sample.
    pub usage: Usage,
    /// Clocks of the same behind a front end that takes integer codes.
    pub board: BoardUsage,
    /// Time of all clocks of a sample, us.
    pub sample_period_us: f64,
    /// From the accepting clock to the result, us.
    pub latency_us: f64,
    /// `1 / sample_period_us`, kHz.
    pub sample_rate_max_khz: f64,
}

impl PipelineTiming {
    /// The times of counted clocks.
    pub(super) fn of(usage: Usage, board: BoardUsage, clock_mhz: f64) -> Self {
        Self {
            sample_period_us: sample_period_us(usage.clocks_per_sample, clock_mhz),
            latency_us: sample_period_us(usage.latency_clocks, clock_mhz),
            sample_rate_max_khz: sample_rate_max_khz(usage.clocks_per_sample, clock_mhz),
            usage,
            board,
        }
    }
}
