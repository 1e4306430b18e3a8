//! A recorded log through filters while it comes in: words out as words come in, nothing is measured.
//!
//! One thread reads and another filters, so that a word that is there never waits for one that is not.

use std::io;
use std::sync::mpsc::{self, Receiver, SyncSender};
use std::thread;

use super::filters::LogFilters;
use crate::experiment::channel_filter::Arithmetic;
use crate::experiment::outside::Outside;
use crate::experiment::run::RecordLength;
use crate::filters::{Divergence, Output};
use crate::recording::{LogError, LogStream};

/// Most words that are filtered before their outputs are passed on.
const BLOCK: usize = 1 << 12;
/// Most words that wait between the two threads.
const WAITING: usize = 1 << 14;

/// Why words were not passed on to the end.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PassError {
    /// A filter whose words the bench does not make.
    #[error(
        "filter {0}: words of a program or of a file are not passed on as they come: expected filters of the \
         bench"
    )]
    Outside(String),
    /// The input.
    #[error(transparent)]
    Read(#[from] LogError),
    /// A filter that failed.
    #[error("filter {filter}: {divergence}")]
    Failed {
        /// Its name.
        filter: String,
        /// How.
        divergence: Divergence,
    },
    /// Whoever takes the words.
    #[error("{0}")]
    Write(#[from] io::Error),
}

/// Filters of a scenario while words go through them.
struct Passing {
    filters: Vec<(String, Arithmetic)>,
    /// Outputs of each filter.
    outputs: Vec<Vec<Output>>,
    /// The same word by word, deg/h.
    rows: Vec<f64>,
}

/// Puts a log through filters as it comes in, and gives the outputs to `take` row by row: of each word
/// those of all filters in the order of the file, deg/h. They are the words that
/// [`try_log`](super::try_log) has, to the bit. What is worth saying of the log comes back.
///
/// # Errors
/// [`PassError`]; what came before the fault has been passed on.
pub fn pass_log(
    mut stream: LogStream,
    filters: &LogFilters,
    mut take: impl FnMut(&[f64]) -> io::Result<()>,
) -> Result<Vec<String>, PassError> {
    let mut passing = Passing::of(filters, stream.log().sample_period_s())?;
    for words in stream.take_first_words().chunks(BLOCK) {
        passing.pass(words, &mut take)?;
    }
    let (words, waiting) = mpsc::sync_channel(WAITING);
    let reader = thread::spawn(move || read(stream, &words));
    let mut block = Vec::with_capacity(BLOCK);
    loop {
        let fault = next_block(&waiting, &mut block).err();
        if block.is_empty() && fault.is_none() {
            break;
        }
        passing.pass(&block, &mut take)?;
        if let Some(error) = fault {
            return Err(error.into());
        }
    }
    Ok(reader.join().unwrap_or_default())
}

/// Reads words for as long as they are wanted; what is worth saying of the log.
fn read(mut stream: LogStream, words: &SyncSender<Result<f64, LogError>>) -> Vec<String> {
    let mut block = Vec::new();
    loop {
        if let Err(fault) = stream.read(&mut block) {
            // Where nobody waits for words any more, nobody is told.
            let _ = words.send(Err(fault));
            return Vec::new();
        }
        if block.is_empty() {
            return stream.into_log().notes();
        }
        if block.drain(..).any(|word| words.send(Ok(word)).is_err()) {
            return Vec::new();
        }
    }
}

/// Waits for a word, and takes those that are there behind it; none at the end.
fn next_block(
    waiting: &Receiver<Result<f64, LogError>>,
    block: &mut Vec<f64>,
) -> Result<(), LogError> {
    block.clear();
    let mut next = waiting.recv().ok();
    while let Some(word) = next {
        block.push(word?);
        next = match block.len() < BLOCK {
            true => waiting.try_recv().ok(),
            false => None,
        };
    }
    Ok(())
}

impl Passing {
    fn of(filters: &LogFilters, sample_period_s: f64) -> Result<Self, PassError> {
        // Nothing is left out of the health of a matrix.
        let length = RecordLength {
            warm_up: 0,
            measured: 0,
        };
        let of_bench = filters.configs().iter().map(|config| {
            let name = config.name.clone();
            if Outside::of(&config.kind).is_some() {
                return Err(PassError::Outside(name));
            }
            Ok((name, Arithmetic::new(&config.kind, length, sample_period_s)))
        });
        let filters = of_bench.collect::<Result<Vec<_>, _>>()?;
        Ok(Self {
            outputs: vec![Vec::new(); filters.len()],
            filters,
            rows: Vec::new(),
        })
    }

    /// Filters words and passes their outputs on; of a filter that fails those before.
    fn pass(
        &mut self,
        words_deg_per_h: &[f64],
        take: &mut impl FnMut(&[f64]) -> io::Result<()>,
    ) -> Result<(), PassError> {
        let mut failed = None;
        for ((name, filter), outputs) in self.filters.iter_mut().zip(&mut self.outputs) {
            outputs.clear();
            if let Err(divergence) = filter.step_all(words_deg_per_h, outputs) {
                failed.get_or_insert(PassError::Failed {
                    filter: name.clone(),
                    divergence,
                });
            }
        }
        let rows = self.outputs.iter().map(Vec::len).min().unwrap_or(0);
        self.rows.clear();
        for row in 0..rows {
            let outputs = self.outputs.iter();
            self.rows
                .extend(outputs.map(|outputs| outputs[row].value_deg_per_h));
        }
        if rows > 0 {
            take(&self.rows)?;
        }
        failed.map_or(Ok(()), Err)
    }
}
