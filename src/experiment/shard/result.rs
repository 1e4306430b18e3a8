//! What a shard keeps of one thing that it ran.

use super::codec::{Coded, coded};
use crate::experiment::plan::Plan;
use crate::experiment::run::{Repeat, Simulation};
use crate::experiment::suite::{Names, report_of_plan, signals};

/// The result of one thing to run, as bytes behind its index.
pub(super) struct Entry {
    pub(super) head: EntryHead,
    pub(super) result: UnitResult,
}

/// What is known of a result without reading it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct EntryHead {
    /// Index of the unit.
    pub(super) unit: usize,
    /// Whether the run, or a channel of it that no gate expects to, failed.
    pub(super) has_failed: bool,
}

/// The result of one thing to run.
pub(super) enum UnitResult {
    /// It could not be run to its end; why.
    Failed(String),
    /// The files of a run.
    Files(Vec<(String, Vec<u8>)>),
    /// Repeats of a run, each by itself.
    Repeats(Repeats),
}

/// Repeats of a run.
pub(super) struct Repeats {
    pub(super) repeats: Vec<Repeat>,
    /// What the report shows of the first of all, where that is among them.
    pub(super) first: Option<FirstRepeat>,
}

/// What a report shows of the first repeat beside its metrics.
pub(super) struct FirstRepeat {
    pub(super) gyros: Vec<FirstGyro>,
    pub(super) encoder_rad: Option<Vec<f64>>,
    /// What its filters have to say.
    pub(super) notes: Vec<String>,
}

/// Samples of one gyro, deg/h.
pub(super) struct FirstGyro {
    pub(super) truth_deg_per_h: Vec<f64>,
    /// Channels by name, raw first.
    pub(super) channels: Vec<(String, Vec<f64>)>,
}

impl FirstRepeat {
    pub(super) fn of(plan: &Plan, simulation: &Simulation, notes: Vec<String>) -> Self {
        let names = Names::of(&report_of_plan(plan));
        let signals = signals(plan, simulation, &names);
        let gyros = signals.iter().map(|signals| {
            let channels = signals.channels.iter();
            let channels = channels.map(|(name, words)| ((*name).to_owned(), words.to_vec()));
            FirstGyro {
                truth_deg_per_h: signals.truth_deg_per_h.words().into_owned(),
                channels: channels.collect(),
            }
        });
        Self {
            gyros: gyros.collect(),
            encoder_rad: simulation.encoder_rad.clone(),
            notes,
        }
    }
}

coded! {
    Entry { head, result }
    EntryHead { unit, has_failed }
    Repeats { repeats, first }
    FirstRepeat { gyros, encoder_rad, notes }
    FirstGyro { truth_deg_per_h, channels }
}

impl Coded for UnitResult {
    fn put(&self, out: &mut Vec<u8>) {
        match self {
            Self::Failed(reason) => {
                0_u8.put(out);
                reason.put(out);
            }
            Self::Files(files) => {
                1_u8.put(out);
                files.put(out);
            }
            Self::Repeats(repeats) => {
                2_u8.put(out);
                repeats.put(out);
            }
        }
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        match u8::take(from)? {
            0 => Coded::take(from).map(Self::Failed),
            1 => Coded::take(from).map(Self::Files),
            2 => Coded::take(from).map(Self::Repeats),
            _ => None,
        }
    }
}
