//! Runs that are killed: at any moment, and at every call that changes the disk.

use std::collections::BTreeMap;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use super::case::Fault;
use super::setting;
use super::tally::Tally;
use super::yard::{Start, Version, Yard};
use crate::support::seeded::{Draws, case_seed};

/// Kills and signals of the small form.
const SMALL: u64 = 8;

/// Calls at which `strace` kills, by what they do.
const CALLS: [&str; 6] = [
    "?rename,?renameat,?renameat2",
    "?fsync,?fdatasync",
    "?write,?pwrite64,?writev",
    "?openat,?open,?creat",
    "?mkdir,?mkdirat,?unlink,?unlinkat,?rmdir",
    "?link,?linkat,?ftruncate,?flock",
];

/// Signals that ask the program to end, and their exit codes.
const SIGNALS: [(&str, i32); 3] = [("INT", 130), ("TERM", 143), ("HUP", 129)];

/// Exit code after a kill.
const KILLED: i32 = 128 + 9;

#[test]
fn a_kill_at_any_moment_loses_nothing() {
    let wanted = setting("FOGBENCH_KILLS", SMALL);
    let campaign_seed = setting("FOGBENCH_SEED", 11);
    let yard = Yard::new();
    let mut tally = Tally::default();
    let mut tracer = Tracer::new();
    for index in 0..wanted {
        let seed = case_seed(campaign_seed, index);
        let mut draws = Draws::new(seed);
        let start = *draws.pick(&[Start::Empty, Start::Old, Start::Old, Start::New]);
        let kind = match (index % 4, tracer.is_there) {
            (0 | 1, true) => Interruption::Call,
            (2, _) => Interruption::Signal,
            _ => Interruption::Moment,
        };
        let result = interrupt(&yard, kind, start, &mut draws, &mut tracer, &mut tally);
        if let Err(fault) = result {
            let story = format!("{kind:?} {start:?} {}", tracer.last);
            tally.fault("kill", seed, &fault, &story);
        }
    }
    println!("{}", tally.report());
    assert!(tally.is_clean(), "faults:\n{}", tally.report());
}

/// How a run is cut short.
#[derive(Clone, Copy, Debug)]
enum Interruption {
    /// Killed at a call to the system.
    Call,
    /// Killed at a moment.
    Moment,
    /// Asked to end at a moment.
    Signal,
}

/// Goes through the calls of the program, one kill at each.
struct Tracer {
    is_there: bool,
    next: BTreeMap<(usize, String), usize>,
    turn: usize,
    last: String,
}

impl Tracer {
    fn new() -> Self {
        let tried = Command::new("strace")
            .args(["-f", "-o", "/dev/null", "true"])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status();
        Self {
            is_there: tried.is_ok_and(|status| status.success()),
            next: BTreeMap::new(),
            turn: 0,
            last: String::new(),
        }
    }

    /// The next call to kill at.
    fn place(&mut self, start: Start) -> (usize, usize) {
        // Every second kill is at a rename, where folders change places.
        let kind = if self.turn.is_multiple_of(2) {
            0
        } else {
            1 + (self.turn / 2) % (CALLS.len() - 1)
        };
        self.turn += 1;
        let next = self.next.entry((kind, format!("{start:?}"))).or_insert(0);
        *next += 1;
        self.last = format!("{} call {next}", CALLS[kind]);
        (kind, *next)
    }

    /// Begins again: the program has made fewer calls than that.
    fn rewind(&mut self, kind: usize, start: Start) {
        self.next.insert((kind, format!("{start:?}")), 0);
    }
}

fn interrupt(
    yard: &Yard,
    kind: Interruption,
    start: Start,
    draws: &mut Draws,
    tracer: &mut Tracer,
    tally: &mut Tally,
) -> Result<(), Fault> {
    yard.prepare("out", start)?;
    let before = yard.check_whole("out")?;
    let jobs = *draws.pick(&["1", "2"]);
    let arguments = yard.arguments("out", Version::New, &["-j", jobs]);
    let moment = yard.length.mul_f64(draws.unit() * 1.2);
    let code = match kind {
        Interruption::Call => {
            let (calls, count) = tracer.place(start);
            let code = yard
                .start_traced(CALLS[calls], count, &arguments)
                .end()
                .code;
            if code != KILLED {
                tracer.rewind(calls, start);
            }
            code
        }
        Interruption::Moment => {
            let mut running = yard.start(&arguments);
            thread::sleep(moment);
            running.kill();
            running.end().code
        }
        Interruption::Signal => return signalled(yard, &arguments, moment, draws, tally),
    };
    if code == KILLED {
        tally.count(format!("killed, {kind:?}, {start:?}"));
    } else if code == yard.exit {
        tally.count("ended before the kill");
    } else {
        return Err(Fault::new("wrong exit code", format!("{code}")));
    }
    let there = yard.check_whole("out")?;
    recover(yard, &[before, there].concat(), draws, tally)
}

/// Goes on after an interruption; nothing that was finished may be missing.
fn recover(
    yard: &Yard,
    finished: &[&str],
    draws: &mut Draws,
    tally: &mut Tally,
) -> Result<(), Fault> {
    if draws.chance(0.5) {
        let ended = yard.run_other("out");
        if ended.code != 0 {
            return Err(Fault::new("no run after a kill", ended.talk));
        }
        let there = yard.check_whole("out")?;
        if let Some(lost) = finished.iter().find(|run| !there.contains(run)) {
            return Err(Fault::new("a finished folder is lost", (*lost).to_owned()));
        }
        tally.count("another scenario first");
    }
    let more: &[&str] = if draws.chance(0.5) {
        &["--resume=any-build"]
    } else {
        &[]
    };
    let ended = yard.run("out", Version::New, more);
    if ended.code != yard.exit {
        let message = format!("{} {}", ended.code, ended.talk);
        return Err(Fault::new("no whole suite after a kill", message));
    }
    tally.count(format!("run again {}", more.concat()));
    yard.check_final("out", Version::New)
}

/// Asks the program to end; it ends in time, says how far it came, and can go on.
fn signalled(
    yard: &Yard,
    arguments: &[String],
    moment: Duration,
    draws: &mut Draws,
    tally: &mut Tally,
) -> Result<(), Fault> {
    let (signal, expected) = *draws.pick(&SIGNALS);
    let running = yard.start(arguments);
    thread::sleep(moment);
    running.signal(signal);
    let asked = Instant::now();
    let ended = running.end();
    let took = asked.elapsed();
    if took > Duration::from_secs(2) {
        return Err(Fault::new("slow to end", format!("{signal}: {took:?}")));
    }
    let there = yard.check_whole("out")?;
    if ended.code == expected {
        // Before its handler stands, a signal ends the program as it ends any other.
        tally.count(format!("{signal} answered"));
    } else if ended.code == yard.exit {
        tally.count(format!("{signal} came too late"));
    } else {
        let message = format!("{signal}: {} {}", ended.code, ended.talk);
        return Err(Fault::new("wrong exit code of a signal", message));
    }
    recover(yard, &there, draws, tally)
}
