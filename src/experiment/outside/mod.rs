//! Channels whose words no filter of the bench makes: they are put beside the others once the record
//! that they are made from stands.

mod failure;
mod replay;

use rayon::prelude::*;

use super::channel_filter::FinishedFilter;
use super::run::{Progress, RecordLength, Simulation, Unfinished, unless_stopped};
use crate::filters::Outside;
use crate::scenario::Resolved;

pub(super) use failure::is_from_outside;
pub(super) use replay::read as read_replay;

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
        let Some(outside) = config.kind.settings().outside() else {
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
            let finished = filter.run(outside, record.filter_input_deg_per_h(), length);
            Ok((gyro, finished))
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
    filter.shape.hidden_reason()?;
    Some(format!(
        "filter `{}`: its weights are not known: its intervals are those of a filter that forgets \
         within a tenth of the record, and too narrow for one that remembers more",
        filter.name
    ))
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

    /// What comes of the words of the gyro, deg/h, warm-up included.
    pub(super) fn run(
        &self,
        outside: Outside<'_>,
        input_deg_per_h: &[f64],
        length: RecordLength,
    ) -> FinishedFilter {
        match outside {
            Outside::Replay(config) => self.replay(config, input_deg_per_h, length),
        }
    }

    /// The file that a key of the filter names.
    fn file(&self, key: &str) -> Option<&'a crate::scenario::NamedFile> {
        let kind = self.resolved.scenario.filters[self.index].kind.name();
        let key = format!("filter[{}].{kind}.{key}", self.index);
        self.resolved.named_file(&key)
    }
}
