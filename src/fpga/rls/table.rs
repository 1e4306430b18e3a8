//! Table 1 of the paper: three ways to build the filter.

use super::clocks::RlsLoad;
use super::config::{RlsConfig, RlsSettings};
use super::machine::RlsPipeline;
use super::schedule::count_operations;
use crate::fpga::check::{check_clock, check_tap_count};
use crate::fpga::error::FpgaError;
use crate::fpga::timing::{measure, sample_period_us, sample_rate_max_khz};
use crate::vocabulary::{Division, UpdateSign};

/// Way of building the filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Design {
    /// Everything at once, one clock per sample.
    Parallel,
    /// One operation at a time: read, operate, write.
    Serial,
    /// The alternate-storage multiply-accumulate pipeline.
    Pipeline,
}

impl Design {
    /// Name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Parallel => "parallel",
            Self::Serial => "serial",
            Self::Pipeline => "pipeline",
        }
    }
}

/// Where the numbers of a row come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    /// The paper's formulas.
    Paper,
    /// Operations counted on the schedule one by one, clocks on the running model.
    Counted,
}

impl Basis {
    /// Name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Counted => "counted",
        }
    }
}

/// One row of Table 1.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct TimingRow {
    /// Way of building the filter.
    pub design: Design,
    /// Origin of the numbers.
    pub basis: Basis,
    /// Clocks per sample.
    pub clocks: u64,
    /// Multipliers.
    pub multipliers: u64,
    /// Dividers.
    pub dividers: u64,
    /// Adders.
    pub adders: u64,
    /// Time per sample in us at the given clock.
    pub sample_period_us: f64,
    /// Largest sample rate in kHz at the given clock. The parallel row takes its one clock at
    /// its word; a chain of multiplies, adds and a divide does not settle in 25 ns.
    pub sample_rate_max_khz: f64,
}

/// Table 1 for any tap count: the paper's formulas, then the honest count.
///
/// Paper: parallel 1 clock, `1+2p+3p^2` multipliers, `2-p+2p^2` adders, 1 divider; serial
/// `9+3p+15p^2` clocks; pipeline `4+6p+5p^2` clocks; one unit of each kind in the last two. Its
/// serial count is three clocks per multiply or add of its parallel count, without the division.
///
/// Counted: the operations of the pipeline's schedule one by one, without the `+0 +` at which an
/// accumulator begins and without the product with `1/alpha` at alpha = 1; a unit for each in the
/// parallel design, three clocks for each, the division included, in the serial one. The pipeline's
/// clocks are those of the running model.
///
/// * `forgets`: whether alpha differs from 1; `clock_mhz`: 0.001 to 10000.
///
/// # Errors
/// [`FpgaError::TapCount`], [`FpgaError::OutOfRange`] for the clock.
pub fn table(
    tap_count: usize,
    division: Division,
    forgets: bool,
    clock_mhz: f64,
) -> Result<[TimingRow; 6], FpgaError> {
    check_tap_count(tap_count)?;
    check_clock(clock_mhz)?;
    let p = tap_count as u64;
    let squared = p * p;
    let load = RlsLoad {
        tap_count,
        division,
        forgets,
    };
    let counted = count_operations(load);
    let paper_multiplies = 1 + 2 * p + 3 * squared;
    let paper_additions = 2 + 2 * squared - p;
    let pipeline = 4 + 6 * p + 5 * squared;
    let row = |design, basis, clocks, [multipliers, dividers, adders]: [u64; 3]| TimingRow {
        design,
        basis,
        clocks,
        multipliers,
        dividers,
        adders,
        sample_period_us: sample_period_us(clocks, clock_mhz),
        sample_rate_max_khz: sample_rate_max_khz(clocks, clock_mhz),
    };
    let paper_serial = 3 * (paper_multiplies + paper_additions);
    let one_each = [1, 1, 1];
    Ok([
        row(
            Design::Parallel,
            Basis::Paper,
            1,
            [paper_multiplies, 1, paper_additions],
        ),
        row(Design::Serial, Basis::Paper, paper_serial, one_each),
        row(Design::Pipeline, Basis::Paper, pipeline, one_each),
        row(
            Design::Parallel,
            Basis::Counted,
            1,
            [counted.multiplies, counted.divisions, counted.additions],
        ),
        row(
            Design::Serial,
            Basis::Counted,
            counted.serial_clocks,
            one_each,
        ),
        row(
            Design::Pipeline,
            Basis::Counted,
            counted_clocks(load)?,
            one_each,
        ),
    ])
}

/// Clocks per sample of the running model.
fn counted_clocks(load: RlsLoad) -> Result<u64, FpgaError> {
    let config = RlsConfig::<f64>::new(RlsSettings {
        tap_count: load.tap_count,
        forgetting_factor: if load.forgets { 0.5 } else { 1.0 },
        initial_inverse_correlation: 1.0,
        division: load.division,
        update_sign: UpdateSign::Corrected,
    })?;
    Ok(measure(RlsPipeline::new(config)).clocks_per_sample)
}
