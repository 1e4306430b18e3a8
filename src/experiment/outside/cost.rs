//! What it costs to hand words to a program and take its answers.

use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

use crate::program::{self, Greeting, Interrupted, Launch, Listener, Programs, Session};

/// First argument of the program where it is to be a supervisor.
pub const SUPERVISE: &str = program::SUPERVISE;

/// Blocks before those that are timed.
const WARM_UP_BLOCKS: usize = 100;

/// Nobody waits, and nobody hears.
struct Nobody;

impl Listener for Nobody {
    fn said(&self, _line: &str) {}

    fn should_stop(&self) -> bool {
        false
    }
}

/// Times of blocks of so many words that a warm program without arguments answers. The program that asks must
/// begin with [`cli::main`](crate::cli::main) where its first argument is [`SUPERVISE`]: it is started again as the supervisor.
///
/// # Errors
/// The program cannot be started, or answers otherwise than it should.
pub fn exchange_times(program: &Path, blocks: usize, words: u32) -> io::Result<Vec<Duration>> {
    let said = |interrupted: Interrupted| match interrupted {
        Interrupted::Stopped => io::Error::other("it was stopped"),
        Interrupted::Failed(error) => io::Error::other(error.to_string()),
    };
    let programs = Programs::of_this_program()?;
    let launch = Launch {
        command: vec![program.into()],
        inputs: Vec::new(),
        start_timeout_s: 10.0,
        timeout_s: 10.0,
        memory_mb: None,
    };
    let greeting = Greeting::new(4000.0, "raw".to_owned(), words, ());
    let mut session = Session::start(&programs, &launch, &greeting, &Nobody).map_err(said)?;
    let block: Vec<f64> = (0..words).map(f64::from).collect();
    let mut times = Vec::with_capacity(blocks);
    for index in 0..WARM_UP_BLOCKS + blocks {
        let start = Instant::now();
        let answer = session.exchange(&block).map_err(said)?;
        if index >= WARM_UP_BLOCKS {
            times.push(start.elapsed());
        }
        if answer.len() != block.len() {
            let message = format!("{} words came back", answer.len());
            return Err(io::Error::other(message));
        }
    }
    session.finish().map_err(said)?;
    Ok(times)
}
