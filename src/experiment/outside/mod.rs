//! Channels whose words no filter of the bench makes: they are put beside the others once the record
//! that they are made from stands.

#[cfg(feature = "cli")]
mod cost;
mod failure;
mod probe;
mod process;
mod programs;
mod replay;

use rayon::prelude::*;

use super::channel_filter::FinishedFilter;
use super::run::{Progress, RecordLength, Simulation, Unfinished, unless_stopped};
use crate::filters::{FilterKind, ProcessFilterConfig, ReplayFilterConfig};
use crate::gyro;
use crate::scenario::{NamedFile, Resolved};

#[cfg(feature = "cli")]
pub use cost::{SUPERVISE, exchange_times};
pub(super) use failure::{is_from_outside, is_of_the_moment};
pub use programs::{ProgramFiles, program_files};
pub(super) use replay::read as read_replay;

/// What makes the words of a channel in the place of a filter of the bench.
#[derive(Clone, Copy, Debug)]
pub(super) enum Outside<'a> {
    /// They were computed elsewhere.
    Replay(&'a ReplayFilterConfig),
    /// A program makes them.
    Process(&'a ProcessFilterConfig),
}

impl<'a> Outside<'a> {
    /// What makes the words of a filter of a kind; none where the bench does.
    pub(super) fn of(kind: &'a FilterKind) -> Option<Self> {
        match kind {
            FilterKind::Replay(config) => Some(Self::Replay(config)),
            FilterKind::Process(config) => Some(Self::Process(config)),
            _ => None,
        }
    }
}

/// A filter of a scenario that is not the bench's, on one gyro.
#[derive(Clone, Debug)]
pub(super) struct OutsideFilter<'a> {
    /// Where the files that it names are found.
    resolved: &'a Resolved,
    /// Index of the filter in the scenario.
    index: usize,
    /// Name of the channel.
    name: String,
}

/// The words that a filter is given.
#[derive(Clone, Copy, Debug)]
pub(super) struct Input<'a> {
    /// The words, deg/h, warm-up included.
    pub(super) words_deg_per_h: &'a [f64],
    /// Name of the channel that they are of.
    pub(super) channel: &'a str,
    /// How many of them are warm-up and record.
    pub(super) length: RecordLength,
    /// Sample period, s.
    pub(super) sample_period_s: f64,
}

/// Channels of one filter from outside, with the gyro of each.
type Channels = Vec<(usize, FinishedFilter)>;

/// Puts the words of every filter from outside among those of the bench, in the order of the file.
pub(super) fn complete(
    simulation: &mut Simulation,
    resolved: &Resolved,
    length: RecordLength,
    progress: &dyn Progress,
) -> Result<(), Unfinished> {
    let scenario = &resolved.scenario;
    let prefixes = scenario.axis_prefixes();
    let gyros = &simulation.gyros;
    let made = |index: usize| -> Result<Option<Channels>, Unfinished> {
        let config = &scenario.filters[index];
        let Some(outside) = Outside::of(&config.kind) else {
            return Ok(None);
        };
        let channels = prefixes.iter().zip(gyros).enumerate();
        let channels = channels.map(|(gyro, (prefix, record))| {
            unless_stopped(progress)?;
            let filter = OutsideFilter {
                resolved,
                index,
                name: format!("{prefix}{}", config.name),
            };
            let channels = scenario.compensated_channels();
            let channels = if channels.is_empty() {
                scenario.raw_channels()
            } else {
                channels
            };
            let input = Input {
                words_deg_per_h: record.filter_input_deg_per_h(),
                channel: &channels[gyro],
                length,
                sample_period_s: gyro::sample_period_s(&scenario.gyro),
            };
            Ok((gyro, filter.run(outside, &input, progress)?))
        });
        channels.collect::<Result<_, _>>().map(Some)
    };
    let made: Vec<Option<Channels>> = (0..scenario.filters.len())
        .into_par_iter()
        .map(made)
        .collect::<Result<_, _>>()?;
    let mut inside = std::mem::take(&mut simulation.filters).into_iter();
    let in_order = made
        .into_iter()
        .flat_map(|made| made.unwrap_or_else(|| inside.by_ref().take(prefixes.len()).collect()));
    simulation.filters = in_order.collect();
    Ok(())
}

/// What the reader of a report must know of a filter whose weights are not known.
pub(super) fn note(filter: &FinishedFilter) -> Option<String> {
    filter.words.as_ref().ok()?;
    let name = &filter.name;
    Some(match filter.shape.hidden_reason()? {
        reason @ process::NOT_REPEATED => {
            format!("filter `{name}`: {reason}: its results do not repeat to the byte")
        }
        _ => format!(
            "filter `{name}`: its weights are not known: its intervals are those of a filter that \
             forgets within a tenth of the record, and too narrow for one that remembers more"
        ),
    })
}

impl<'a> OutsideFilter<'a> {
    /// The filter of a scenario for words that come alone, as those of a log do.
    pub(super) fn of_log(resolved: &'a Resolved, index: usize) -> Self {
        let name = resolved.scenario.filters[index].name.clone();
        Self {
            resolved,
            index,
            name,
        }
    }

    /// What comes of the words of the gyro.
    ///
    /// # Errors
    /// [`Unfinished::Stopped`] once the listener wants the run to stop.
    pub(super) fn run(
        &self,
        outside: Outside<'_>,
        input: &Input,
        progress: &dyn Progress,
    ) -> Result<FinishedFilter, Unfinished> {
        match outside {
            Outside::Replay(config) => Ok(self.replay(config, input)),
            Outside::Process(config) => self.process(config, input, progress),
        }
    }

    /// Path of a key of the filter.
    fn key(&self, key: &str) -> String {
        let kind = self.resolved.scenario.filters[self.index].kind.name();
        format!("filter[{}].{kind}.{key}", self.index)
    }

    /// The file that a key of the filter names.
    fn file(&self, key: &str) -> Option<&'a NamedFile> {
        self.resolved.named_file(&self.key(key))
    }
}
