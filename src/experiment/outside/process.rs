//! A program of the user's in the place of a filter: its words, and what they and a few more runs of it
//! tell of its weights.

use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use rayon::prelude::*;

use super::failure::FailureKind;
use super::probe::{self, Weights};
use super::replay::registered;
use super::{Input, OutsideFilter};
use crate::experiment::black_box::{self, Handing, Subject, TwinInput};
use crate::experiment::channel_filter::{
    ADDED_RATE_DEG_PER_H, FilterWords, FinishedFilter, WEIGHT_BLOCKS, given_gain,
};
use crate::experiment::run::{Progress, RATES_DEG_PER_S, Unfinished, rate_gain};
use crate::filters::{ProcessFilterConfig, ProcessMode};
use crate::metrics::{ChannelFailure, RateGain, correlation_length_samples};
use crate::program::{Greeting, Interrupted, Launch, Listener, Programs, Session};
use crate::signal::{FilterShape, HiddenWeights, WeightRule};
use crate::units::deg_per_s_to_deg_per_h;

/// Why metrics are missing that need the weights.
const NO_WEIGHTS: &str =
    "a program does not show its weights, and its answer to an impulse does not explain its words";

/// Why nothing is measured by twins of a program that answers otherwise each time.
pub(super) const NOT_REPEATED: &str =
    "the program answered the same words otherwise when it was run again";

/// A program and what it is given, ready to be run again and again.
struct Program<'a> {
    programs: &'a Programs,
    launch: Launch,
    config: &'a ProcessFilterConfig,
    input: &'a Input<'a>,
    /// Folder of the run and name of the channel.
    name: (String, &'a str),
    progress: &'a dyn Progress,
    /// Hears nothing of what the program says beside its record.
    deaf: &'a Ear<'a>,
    /// Sessions of a stateless program that wait for another record of as many words: its start may take
    /// longer than its work.
    idle: Mutex<Vec<(u32, Session<'a>)>>,
}

/// Why a program gave no words.
enum Halt {
    Stopped,
    Failed(ChannelFailure),
}

impl Halt {
    /// What a session said of the block that begins with a sample.
    fn of(interrupted: Interrupted, start: usize) -> Self {
        match interrupted {
            Interrupted::Stopped => Self::Stopped,
            Interrupted::Failed(error) => {
                let sample = (start + error.word()) as u64;
                let message = format!("the program failed at sample {sample}: {error}");
                Self::Failed(FailureKind::from(error.kind()).failure(sample, message))
            }
        }
    }
}

/// Passes on what the program says, where somebody is to hear it.
struct Ear<'a> {
    progress: &'a dyn Progress,
    /// Folder of the run and name of the channel under which it is heard.
    heard_as: Option<(&'a str, &'a str)>,
}

impl Listener for Ear<'_> {
    fn said(&self, line: &str) {
        if let Some((run, channel)) = self.heard_as {
            self.progress.program_said(run, channel, line);
        }
    }

    fn should_stop(&self) -> bool {
        self.progress.should_stop()
    }
}

impl<'a> Program<'a> {
    /// Most words that are handed over at once of so many.
    fn block(&self, words: usize) -> u32 {
        match self.config.mode {
            ProcessMode::Stream => self.config.block_samples,
            ProcessMode::Record => u32::try_from(words).unwrap_or(u32::MAX),
        }
    }

    /// The program, started and greeted.
    fn start<'s>(&self, block: u32, ear: &'s Ear<'s>) -> Result<Session<'s>, Halt> {
        let greeting = Greeting::new(
            1.0 / self.input.sample_period_s,
            self.input.channel.to_owned(),
            block,
            self.config.parameters.clone().unwrap_or_default(),
        );
        Session::start(self.programs, &self.launch, &greeting, ear)
            .map_err(|error| Halt::of(error, 0))
    }

    /// What the program makes of the record, heard and timed.
    fn over_record(&self) -> Result<Vec<f64>, Halt> {
        let words = self.input.words_deg_per_h;
        let (run, channel) = &self.name;
        let ear = Ear {
            progress: self.progress,
            heard_as: Some((run, channel)),
        };
        let block = self.block(words.len());
        let mut session = self.start(block, &ear)?;
        let began = Instant::now();
        let answers = in_blocks(&mut session, words, block)?;
        if !words.is_empty() {
            let us_per_word = 1e6 * began.elapsed().as_secs_f64() / words.len() as f64;
            self.progress.program_took(run, channel, us_per_word);
        }
        self.finished(session, answers)
    }

    /// What it makes of other words in blocks of so many, of which nobody hears: in a process of its own, unless
    /// a stateless program has answered another record of as many before.
    fn over_others(&self, words: &[f64], block: u32) -> Result<Vec<f64>, Halt> {
        let mut session = match self.idle_of(block) {
            Some(session) => session,
            None => self.start(block, self.deaf)?,
        };
        let answers = in_blocks(&mut session, words, block)?;
        if self.config.mode == ProcessMode::Stream || !session.is_stateless() {
            return self.finished(session, answers);
        }
        let mut idle = self.idle.lock().unwrap_or_else(PoisonError::into_inner);
        idle.push((block, session));
        Ok(registered(answers, self.config.output_register))
    }

    /// A session that waits for a record of so many words.
    fn idle_of(&self, block: u32) -> Option<Session<'a>> {
        let mut idle = self.idle.lock().unwrap_or_else(PoisonError::into_inner);
        let place = idle.iter().position(|(words, _)| *words == block)?;
        Some(idle.swap_remove(place).1)
    }

    /// The outputs of a session that ends as it should.
    fn finished(&self, session: Session, answers: Vec<f64>) -> Result<Vec<f64>, Halt> {
        let end = answers.len();
        session.finish().map_err(|error| Halt::of(error, end))?;
        Ok(registered(answers, self.config.output_register))
    }

    /// What it makes of words beside the record; none where the program fails on them.
    fn beside(&self, words: &[f64]) -> Result<Option<Vec<f64>>, Unfinished> {
        Self::unless_failed(self.over_others(words, self.block(words.len())))
    }

    /// None where the program failed.
    fn unless_failed(answers: Result<Vec<f64>, Halt>) -> Result<Option<Vec<f64>>, Unfinished> {
        match answers {
            Ok(answers) => Ok(Some(answers)),
            Err(Halt::Failed(_)) => Ok(None),
            Err(Halt::Stopped) => Err(Unfinished::Stopped),
        }
    }

    /// The same of the record with a constant rate, deg/h, added from its first word on.
    fn with_rate(&self, rate_deg_per_h: f64) -> Result<Option<Vec<f64>>, Unfinished> {
        let words = self.input.words_deg_per_h.iter();
        let words: Vec<f64> = words.map(|word| word + rate_deg_per_h).collect();
        self.beside(&words)
    }

    /// Whether another run of the program gives the same words, to the bit.
    fn repeats(&self, output_deg_per_h: &[f64]) -> Result<bool, Unfinished> {
        let again = self.beside(self.input.words_deg_per_h)?;
        let is_same = |again: &[f64]| {
            let mut pairs = again.iter().zip(output_deg_per_h);
            pairs.all(|(again, own)| again.to_bits() == own.to_bits())
        };
        Ok(again.is_some_and(|again| is_same(&again)))
    }

    /// Weights that explain every word of the record, if there are such.
    fn weights(&self, output_deg_per_h: &[f64]) -> Result<Option<Weights>, Unfinished> {
        let input = self.input.words_deg_per_h;
        let answer = self.beside(&probe::impulse(input.len()))?;
        let register = self.config.output_register.samples();
        let weights = answer.and_then(|answer| Weights::of(&answer, register));
        Ok(weights.filter(|weights| weights.explain(input, output_deg_per_h)))
    }

    /// The outline of the program and its words, as far as they and a few more runs of it show them.
    fn shown(&self, output: Vec<f64>) -> Result<(FilterShape, FilterWords), Unfinished> {
        let config = self.config;
        let warm_up = self.input.length.warm_up;
        Ok(match self.weights(&output)? {
            Some(weights) => {
                let shape = weights.shape(config.output_register.samples());
                let gain = given_gain(&shape.rule);
                let mean_weights = match &shape.rule {
                    WeightRule::Fixed(weights) => Some(weights.clone()),
                    _ => None,
                };
                let words = FilterWords {
                    dc_gain: gain,
                    dc_gain_adapted: gain,
                    mean_weights,
                    ..FilterWords::alone(output)
                };
                (shape, words)
            }
            None if self.repeats(&output)? => (
                hidden(config, NO_WEIGHTS, &output[warm_up..]),
                adapted(self, output)?,
            ),
            None => (
                hidden(config, NOT_REPEATED, &output[warm_up..]),
                FilterWords::alone(output),
            ),
        })
    }

    /// Gains for constant rates of every size.
    fn rate_gains(&self, output_deg_per_h: &[f64]) -> Result<Vec<RateGain>, Unfinished> {
        let warm_up = self.input.length.warm_up;
        let (input, output) = (
            &self.input.words_deg_per_h[warm_up..],
            &output_deg_per_h[warm_up..],
        );
        let gains: Vec<Option<RateGain>> = RATES_DEG_PER_S
            .par_iter()
            .map(|&rate_deg_per_s| {
                let twin = self.with_rate(deg_per_s_to_deg_per_h(rate_deg_per_s))?;
                let gain =
                    |twin: Vec<f64>| rate_gain(rate_deg_per_s, input, output, &twin[warm_up..]);
                Ok(twin.map(gain))
            })
            .collect::<Result<_, Unfinished>>()?;
        Ok(gains.into_iter().flatten().collect())
    }
}

impl Subject for Program<'_> {
    fn answer(&self, words_deg_per_h: &[f64]) -> Result<Option<Vec<f64>>, Unfinished> {
        self.beside(words_deg_per_h)
    }

    fn answer_word_by_word(&self, words_deg_per_h: &[f64]) -> Result<Option<Vec<f64>>, Unfinished> {
        Self::unless_failed(self.over_others(words_deg_per_h, 1))
    }

    fn handing(&self) -> Handing {
        match self.config.mode {
            ProcessMode::Stream => Handing::Blocks(self.config.block_samples as usize),
            ProcessMode::Record => Handing::Record,
        }
    }

    fn register_samples(&self) -> usize {
        self.config.output_register.samples()
    }
}

impl OutsideFilter<'_> {
    /// The channel of a program.
    pub(super) fn process(
        &self,
        config: &ProcessFilterConfig,
        input: &Input,
        progress: &dyn Progress,
    ) -> Result<FinishedFilter, Unfinished> {
        let Some(programs) = progress.programs() else {
            let message = "programs are started by the command line with --allow-programs alone";
            let failure = FailureKind::NotAllowed.failure(0, message.to_owned());
            return Ok(self.failed(config, failure));
        };
        let deaf = Ear {
            progress,
            heard_as: None,
        };
        let program = Program {
            programs,
            launch: self.launch(config),
            config,
            input,
            name: (self.resolved.folder(), &self.name),
            progress,
            deaf: &deaf,
            idle: Mutex::default(),
        };
        let output = match program.over_record() {
            Ok(output) => output,
            Err(Halt::Stopped) => return Err(Unfinished::Stopped),
            Err(Halt::Failed(failure)) => return Ok(self.failed(config, failure)),
        };
        let rate_gains = if self.resolved.scenario.trial.rate_gain {
            program.rate_gains(&output)?
        } else {
            Vec::new()
        };
        let twins = TwinInput {
            words_deg_per_h: input.words_deg_per_h,
            sample_period_s: input.sample_period_s,
        };
        let trial = self.resolved.scenario.trial.black_box;
        let black_box = black_box::examine(&program, &twins, trial)?;
        let (shape, words) = program.shown(output)?;
        Ok(FinishedFilter {
            name: self.name.clone(),
            kind: None,
            shape,
            restarts: false,
            words: Ok(FilterWords {
                rate_gains,
                black_box,
                ..words
            }),
            pipeline: None,
        })
    }

    fn failed(&self, config: &ProcessFilterConfig, failure: ChannelFailure) -> FinishedFilter {
        FinishedFilter {
            name: self.name.clone(),
            kind: None,
            shape: hidden(config, NO_WEIGHTS, &[]),
            restarts: false,
            words: Err(failure),
            pipeline: None,
        }
    }
}

/// What a session answers to words in blocks of so many.
fn in_blocks(session: &mut Session, words: &[f64], block: u32) -> Result<Vec<f64>, Halt> {
    let mut answers = Vec::with_capacity(words.len());
    for block in words.chunks(block as usize) {
        let start = answers.len();
        let answer = session.exchange(block);
        answers.extend(answer.map_err(|error| Halt::of(error, start))?);
    }
    Ok(answers)
}

/// The outline of a program of which the measured words alone are known, for a reason.
fn hidden(
    config: &ProcessFilterConfig,
    reason: &'static str,
    measured_deg_per_h: &[f64],
) -> FilterShape {
    let hidden = HiddenWeights {
        reason,
        memory_samples: correlation_length_samples(measured_deg_per_h).unwrap_or(1),
    };
    FilterShape::hidden(hidden, config.output_register.samples())
}

/// The words with the gain for a small rate that a twin has learned from the first word on.
fn adapted(program: &Program, output_deg_per_h: Vec<f64>) -> Result<FilterWords, Unfinished> {
    let warm_up = program.input.length.warm_up;
    let twin = program.with_rate(ADDED_RATE_DEG_PER_H)?;
    let Some(twin) = twin else {
        return Ok(FilterWords::alone(output_deg_per_h));
    };
    let pairs = twin[warm_up..].iter().zip(&output_deg_per_h[warm_up..]);
    let gains: Vec<f64> = pairs
        .map(|(twin, own)| (twin - own) / ADDED_RATE_DEG_PER_H)
        .collect();
    let mean = |gains: &[f64]| gains.iter().sum::<f64>() / gains.len() as f64;
    let border = |block: usize| (gains.len() * block).div_ceil(WEIGHT_BLOCKS);
    let blocks = (0..WEIGHT_BLOCKS).map(|block| &gains[border(block)..border(block + 1)]);
    let blocks = blocks.filter(|gains| !gains.is_empty()).map(mean).collect();
    Ok(FilterWords {
        dc_gain_adapted: (!gains.is_empty()).then(|| mean(&gains)),
        block_dc_gains_adapted: blocks,
        ..FilterWords::alone(output_deg_per_h)
    })
}
