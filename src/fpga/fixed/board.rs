//! What stands around a fixed-point core on a board: from samples to pairs, and their clocks.
//!
//! ```text
//!             +-----------------------+  x, d  +------+   y
//!  sample --->| Q_x of the sample LAG |------->| core |------> result, or with the next sample's pair
//!  (word of d)| ago; d or a mean      |        +------+
//!             +-----------------------+
//! ```
//!
//! A sample is a word of d. It is taken in one clock and offered as a pair in the next; the next one
//! is taken in the clock in which the core takes the pair, so that the core keeps its period.
//!
//! Checked by `fixed_point`.

use super::CodePair;
use super::pipeline::FixedPipeline;
use super::sequencer::FixedClocked;
use super::taps::TapFormats;
use crate::fpga::board::BoardUsage;
use crate::vocabulary::DesiredSignal;

/// The hold registers in front of the core.
#[derive(Clone, Debug)]
pub struct FixedFrontEnd {
    formats: TapFormats,
    signal: DesiredSignal,
    lag: usize,
    /// Newest first.
    held: Vec<i64>,
    overflows: [u64; 2],
}

impl FixedFrontEnd {
    /// A front end just out of reset.
    ///
    /// * `formats`: those of the core. * `lag`: samples by which x is older than the newest.
    #[must_use]
    pub fn new(formats: TapFormats, signal: DesiredSignal, lag: usize) -> Self {
        Self {
            formats,
            signal,
            lag,
            held: vec![0; lag.max(1)],
            overflows: [0; 2],
        }
    }

    /// Words of x and of d beyond the ends, in this order.
    #[must_use]
    pub fn overflows(&self) -> [u64; 2] {
        self.overflows
    }

    /// The pair of the next sample, a code of d.
    pub fn pair(&mut self, sample: i64) -> CodePair {
        let TapFormats {
            input,
            desired: format,
            ..
        } = self.formats;
        let old = match self.lag {
            0 => sample,
            lag => self.held[lag - 1],
        };
        let desired = match self.signal {
            DesiredSignal::Current => sample,
            DesiredSignal::TwoSampleMean => {
                let sum = i128::from(sample) + i128::from(self.held[0]);
                let stored = format.store(sum, format.fraction_bits + 1);
                self.overflows[1] += u64::from(stored.overflowed);
                stored.code
            }
        };
        self.held.rotate_right(1);
        self.held[0] = sample;
        let stored = input.store(i128::from(old), format.fraction_bits);
        self.overflows[0] += u64::from(stored.overflowed);
        CodePair {
            input: stored.code,
            desired,
        }
    }
}

/// Counts the clocks of a board just out of reset: an idle sample, then samples back to back.
#[must_use]
pub fn fixed_board_usage(pipeline: &dyn FixedPipeline) -> BoardUsage {
    let mut board = FixedBoard {
        core: pipeline.clocked(),
        offered: None,
    };
    board.tick(true);
    let front_end_clocks = 1;
    let mut latency_clocks = front_end_clocks;
    while !board.tick(false).1 {
        latency_clocks += 1;
    }
    while !board.core.is_idle() {
        board.tick(false);
    }
    let (mut clock, mut accepted) = (0, Vec::new());
    while accepted.len() < 4 {
        if board.tick(true).0 {
            accepted.push(clock);
        }
        clock += 1;
    }
    BoardUsage {
        front_end_clocks,
        clocks_per_sample: accepted[3] - accepted[2],
        latency_clocks,
    }
}

/// Core and pair register; the words do not matter to the clocks.
struct FixedBoard {
    core: Box<dyn FixedClocked>,
    offered: Option<CodePair>,
}

impl FixedBoard {
    /// Whether a sample was taken and whether a result was strobed.
    fn tick(&mut self, has_sample: bool) -> (bool, bool) {
        let clock = self.core.tick(self.offered);
        let is_ready = self.offered.is_none() || clock.accepted;
        if is_ready {
            self.offered = has_sample.then_some(CodePair {
                input: 1,
                desired: 1,
            });
        }
        (is_ready && has_sample, clock.output.is_some())
    }
}
