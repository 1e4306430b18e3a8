//! What goes onto a board: the front end, the core and the output register, clocked together.
//!
//! ```text
//!            +-----------------------+  x, d  +------+   y   +-----------------+
//!  sample -->| code or word -> word, |------->| core |------>| output register |--> result
//!            | hold chain, mean      |        +------+       +-----------------+
//!            +-----------------------+
//! ```
//!
//! | clock of the front end | what happens at its end |
//! |---|---|
//! | Waiting | the sample is taken |
//! | Scaling, Converting (codes only) | `word <- code * LSB`, then `word <- word * factor` |
//! | Adding, Halving (mean of two only) | `sum <- word + XP`, then `sum <- sum * 0.5` |
//! | Offering, until the core takes the pair | the hold chain moves; a waiting sample is taken |
//!
//! Where a sum or a product takes several clocks, so does its row of the table.
//!
//! The front end has a converter and a multiplier of its own and works while the core does: it adds
//! latency, and no clock to the core's period, which is longer than its own for every filter.
//!
//! Codes are scaled in binary64 in two products, each rounded, as the gyro's words are; only the
//! result is rounded to the word format. One product with `LSB * factor` has other bits.
//!
//! Checked by `board`, `rtl`.

use super::float_unit::Fp;
use super::front_end::{FrontEnd, Pair};
use super::machine::{Machine, Sequencer};
use crate::vocabulary::{DesiredSignal, OutputRegister};

/// From integer codes to words: `(code * lsb) * factor`.
#[derive(Clone, Debug, PartialEq)]
pub struct CodeScale {
    /// Value of one code step, in `unit`.
    pub lsb: f64,
    /// Unit of the step, such as `deg/s`.
    pub unit: String,
    /// Words per `unit`.
    pub factor: f64,
    /// Unit of the words, such as `deg/h`.
    pub word_unit: String,
}

impl CodeScale {
    /// Codes that are their own words.
    #[must_use]
    pub fn unity() -> Self {
        Self {
            lsb: 1.0,
            unit: String::new(),
            factor: 1.0,
            word_unit: String::new(),
        }
    }

    /// The word of a code, before it is rounded to a word format.
    #[must_use]
    pub fn word(&self, code: i32) -> f64 {
        let scaled = f64::from(code) * self.lsb;
        scaled * self.factor
    }
}

/// What stands around a core on a board.
#[derive(Clone, Debug, PartialEq)]
pub struct Surroundings {
    /// What the filter is asked to reproduce.
    pub desired: DesiredSignal,
    /// Samples by which the regressors lag the newest sample.
    pub input_lag_samples: usize,
    /// When the result appears.
    pub output_register: OutputRegister,
    /// How samples come as integer codes; none: they come as words.
    pub scale: Option<CodeScale>,
}

impl Surroundings {
    /// Bits of a sample at the board's port, for words of `F`.
    #[must_use]
    pub fn sample_bits<F: Fp>(&self) -> u32 {
        match self.scale {
            Some(_) => i32::BITS,
            None => F::WIDTH,
        }
    }
}

/// A sample at the board's port.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sample<F> {
    /// The gyro's integer code.
    Code(i32),
    /// A word.
    Word(F),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    Waiting,
    Scaling,
    Converting,
    Adding,
    Halving,
    Offering,
}

/// What happens at the board's ports in a clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoardTick<F> {
    /// The offered sample was taken.
    pub accepted: bool,
    /// The core took a pair.
    pub handed_over: bool,
    /// The result, in the one clock in which its strobe is up.
    pub result: Option<F>,
}

/// Clocks of a board, counted on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct BoardUsage {
    /// Clocks from taking a sample until its pair is offered to the core.
    pub front_end_clocks: u64,
    /// Clocks from one sample to the next, back to back.
    pub clocks_per_sample: u64,
    /// Clocks from taking a sample, the core idle, until the core's result can be read.
    pub latency_clocks: u64,
}

/// Front end, core and output register.
#[derive(Clone, Debug)]
pub struct Board<M: Machine> {
    core: Sequencer<M>,
    surroundings: Surroundings,
    phase: Phase,
    /// Clocks that the phase has lasted.
    waited: u64,
    code: i32,
    scaled: f64,
    word: M::Word,
    /// Pairs; its hold chain moves when the core takes one.
    front_end: FrontEnd<M::Word>,
    pair: Pair<M::Word>,
    held: M::Word,
    result: Option<M::Word>,
}

impl<M: Machine> Board<M> {
    /// A board just out of reset around a core just out of reset.
    #[must_use]
    pub fn new(core: Sequencer<M>, surroundings: Surroundings) -> Self {
        let zero = M::Word::ZERO;
        Self {
            front_end: FrontEnd::new(surroundings.desired, surroundings.input_lag_samples),
            core,
            surroundings,
            phase: Phase::Waiting,
            waited: 0,
            code: 0,
            scaled: 0.0,
            word: zero,
            pair: Pair {
                input: zero,
                desired: zero,
            },
            held: zero,
            result: None,
        }
    }

    /// A clock edge with the reset up; the core clears its memories in those that follow.
    pub fn reset(&mut self) {
        let Surroundings {
            desired,
            input_lag_samples,
            ..
        } = self.surroundings;
        self.core.reset();
        self.front_end = FrontEnd::new(desired, input_lag_samples);
        self.phase = Phase::Waiting;
        self.waited = 0;
        self.held = M::Word::ZERO;
        self.result = None;
    }

    /// Counts clocks on a board just out of reset: an idle sample, then samples back to back.
    #[must_use]
    pub fn usage(mut self) -> BoardUsage {
        let sample = match self.surroundings.scale {
            Some(_) => Sample::Code(1),
            None => Sample::Word(M::Word::ONE),
        };
        self.surroundings.output_register = OutputRegister::Immediate;
        let mut front_end_clocks = 0;
        self.tick(Some(sample));
        while self.phase != Phase::Offering {
            self.tick(None);
            front_end_clocks += 1;
        }
        // The clock in which the pair is first offered.
        front_end_clocks += 1;
        let mut latency_clocks = front_end_clocks;
        while self.tick(None).result.is_none() {
            latency_clocks += 1;
        }
        let (mut clock, mut accepted) = (0, Vec::new());
        while accepted.len() < 4 {
            if self.tick(Some(sample)).accepted {
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

    /// Advances one clock.
    pub fn tick(&mut self, sample: Option<Sample<M::Word>>) -> BoardTick<M::Word> {
        let offered = (self.phase == Phase::Offering).then_some(self.pair);
        let tick = self.core.tick(offered);
        let is_ready = self.phase == Phase::Waiting || tick.accepted;
        let result = match self.surroundings.output_register {
            OutputRegister::Immediate => tick.output,
            OutputRegister::NextSample => self.result.take(),
        };
        if let Some(word) = tick.output {
            self.held = word;
        }
        if tick.accepted {
            // The core takes a pair only when it is done with the one before.
            self.result = Some(self.held);
        }
        self.advance();
        if tick.accepted {
            self.phase = Phase::Waiting;
        }
        let taken = sample.filter(|_| is_ready);
        if let Some(sample) = taken {
            self.take(sample);
        }
        BoardTick {
            accepted: taken.is_some(),
            handed_over: tick.accepted,
            result,
        }
    }

    fn take(&mut self, sample: Sample<M::Word>) {
        match sample {
            Sample::Code(code) => {
                self.code = code;
                self.phase = Phase::Scaling;
            }
            Sample::Word(word) => {
                self.word = word;
                self.phase = self.after_word();
            }
        }
    }

    /// Where a word goes next.
    fn after_word(&mut self) -> Phase {
        // The pair is formed at once here; in the hardware the sum takes the clocks that follow.
        self.pair = self.front_end.pair(self.word);
        match self.surroundings.desired {
            DesiredSignal::Current => Phase::Offering,
            DesiredSignal::TwoSampleMean => Phase::Adding,
        }
    }

    fn advance(&mut self) {
        let units = self.core.units();
        let clocks = match self.phase {
            Phase::Scaling | Phase::Converting | Phase::Halving => units.multiplier.latency_clocks,
            Phase::Adding => units.adder.latency_clocks,
            Phase::Waiting | Phase::Offering => 1,
        };
        self.waited += 1;
        if self.waited < clocks {
            return;
        }
        self.waited = 0;
        let factor = |of: fn(&CodeScale) -> f64| self.surroundings.scale.as_ref().map_or(1.0, of);
        match self.phase {
            Phase::Scaling => {
                self.scaled = f64::from(self.code) * factor(|scale| scale.lsb);
                self.phase = Phase::Converting;
            }
            Phase::Converting => {
                self.word = M::Word::from_f64(self.scaled * factor(|scale| scale.factor));
                self.phase = self.after_word();
            }
            Phase::Adding => self.phase = Phase::Halving,
            Phase::Halving => self.phase = Phase::Offering,
            Phase::Waiting | Phase::Offering => {}
        }
    }
}
