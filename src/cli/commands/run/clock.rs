//! Wall times of a suite: talk, and never part of a result.

use std::collections::BTreeSet;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant, SystemTime};

use crate::report::SuiteTimes;

/// Time between two lines that say how far a suite has come.
const BEAT: Duration = Duration::from_secs(10);
/// Most runs that such a line names with their times, the longest of them.
const NAMED_MAX: usize = 6;

/// When each run of a suite began and ended.
pub(super) struct SuiteClock {
    began: Instant,
    /// Folders of the runs.
    names: Vec<String>,
    simulated_s: f64,
    runs: Mutex<Runs>,
}

struct Runs {
    clocks: Vec<RunClock>,
    /// Gyro time that has been simulated, s.
    simulated_s: f64,
    last_beat: Instant,
    /// Runs that have ended and have not been named with their times.
    unnamed: BTreeSet<usize>,
}

/// When a run began, and when it had ended.
#[derive(Clone, Copy, Default)]
struct RunClock {
    began: Option<(SystemTime, Instant)>,
    ended: Option<Instant>,
}

impl RunClock {
    fn duration(&self) -> Option<Duration> {
        Some(self.ended?.duration_since(self.began?.1))
    }
}

impl SuiteClock {
    /// A clock that starts now, for runs of these names and so much gyro time.
    pub(super) fn start(names: Vec<String>, simulated_s: f64) -> Self {
        let began = Instant::now();
        let runs = Runs {
            clocks: vec![RunClock::default(); names.len()],
            simulated_s: 0.0,
            last_beat: began,
            unnamed: BTreeSet::new(),
        };
        Self {
            began,
            names,
            simulated_s,
            runs: Mutex::new(runs),
        }
    }

    /// Notes that a run begins.
    #[expect(
        clippy::disallowed_methods,
        reason = "a time stamp for the report of a build server, which is no result"
    )]
    pub(super) fn started(&self, index: usize) {
        if let Some(run) = self.runs().clocks.get_mut(index) {
            run.began = Some((SystemTime::now(), Instant::now()));
        }
    }

    /// Notes that a run has ended.
    pub(super) fn ended(&self, index: usize) {
        let mut runs = self.runs();
        if let Some(run) = runs.clocks.get_mut(index) {
            run.ended = Some(Instant::now());
            runs.unnamed.insert(index);
        }
    }

    /// Notes gyro time that has been simulated.
    pub(super) fn advanced(&self, simulated_s: f64) {
        self.runs().simulated_s += simulated_s;
    }

    /// How long some runs took, from the beginning of the first to the end of the last; none if no clock
    /// ran for them.
    pub(super) fn duration(
        &self,
        indices: impl Iterator<Item = usize> + Clone,
    ) -> Option<Duration> {
        let runs = self.runs();
        let clock = |index: usize| runs.clocks.get(index);
        let began = indices
            .clone()
            .filter_map(|index| Some(clock(index)?.began?.1))
            .min()?;
        let ended = indices.filter_map(|index| clock(index)?.ended).max()?;
        Some(ended.duration_since(began))
    }

    /// How far the suite has come, if that has not been said for a while.
    pub(super) fn beat(&self) -> Option<String> {
        let mut runs = self.runs();
        if runs.last_beat.elapsed() < BEAT {
            return None;
        }
        runs.last_beat = Instant::now();
        let ended = runs.clocks.iter().filter(|run| run.ended.is_some()).count();
        let percent = 100.0 * (runs.simulated_s / self.simulated_s).min(1.0);
        let named = self.named(&mut runs);
        Some(format!(
            "{:.0} s: {ended} of {} runs, {percent:.0} % of the gyro time{named}",
            self.began.elapsed().as_secs_f64(),
            self.names.len(),
        ))
    }

    /// How long the whole took, and the runs that no line has named with their times.
    pub(super) fn total(&self) -> String {
        let mut runs = self.runs();
        let named = self.named(&mut runs);
        format!("{:.1} s{named}", self.began.elapsed().as_secs_f64())
    }

    /// The longest of the runs that have not been named, with their times.
    fn named(&self, runs: &mut Runs) -> String {
        let unnamed = std::mem::take(&mut runs.unnamed).into_iter();
        let clocks = &runs.clocks;
        let mut ended: Vec<(Duration, &str)> = unnamed
            .filter_map(|index| Some((clocks[index].duration()?, self.names[index].as_str())))
            .collect();
        ended.sort_by(|one, other| other.cmp(one));
        let left = ended.len().saturating_sub(NAMED_MAX);
        let mut text = String::new();
        for (index, (duration, name)) in ended.iter().take(NAMED_MAX).enumerate() {
            let gap = if index == 0 { "; " } else { ", " };
            text.push_str(&format!("{gap}{name} {:.1} s", duration.as_secs_f64()));
        }
        if left > 0 {
            text.push_str(&format!(", {left} shorter"));
        }
        text
    }

    /// The times for the report of a build server.
    pub(super) fn times(&self) -> SuiteTimes {
        let of_run = |run: &RunClock| Some((run.began?.0, run.duration()?));
        SuiteTimes {
            duration: self.began.elapsed(),
            runs: self.runs().clocks.iter().map(of_run).collect(),
        }
    }

    fn runs(&self) -> MutexGuard<'_, Runs> {
        self.runs.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
