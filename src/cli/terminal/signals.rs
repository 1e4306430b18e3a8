//! Signals that end the program: SIGINT (Ctrl-C), SIGTERM and, where there is one, SIGHUP.
//!
//! A signal ends the program at once, with the exit code that shells give it, except while a suite
//! runs: then the first one asks the suite to stop, and the second ends the program at once. What
//! was inherited as ignored (`nohup`) stays ignored.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;

/// Signals that end the program.
#[cfg(unix)]
const ENDING: [i32; 3] = [SIGINT, SIGTERM, signal_hook::consts::SIGHUP];
/// Signals that end the program.
#[cfg(not(unix))]
const ENDING: [i32; 2] = [SIGINT, SIGTERM];

/// Time from the first signal to the end of a program that cannot conclude: its output may have
/// stalled.
const DEADLINE: Duration = Duration::from_millis(1900);

/// Time between two looks at what has been received.
const TICK: Duration = Duration::from_millis(20);

/// What has been received, and what the next signal does.
#[derive(Clone, Debug)]
pub(in crate::cli) struct Interrupt {
    /// The handlers read it: whether a signal ends the program at once.
    ends_at_once: Arc<AtomicBool>,
    /// The signal that asked the suite to stop; 0 = none.
    received: Arc<AtomicUsize>,
    /// Whether it is a shard that is asked, which goes on when it is started again.
    is_shard: Arc<AtomicBool>,
}

impl Interrupt {
    /// Installs the handlers; every signal ends the program at once.
    ///
    /// # Errors
    /// What the system says if it takes no handler.
    pub(in crate::cli) fn install() -> io::Result<Self> {
        let interrupt = Self {
            ends_at_once: Arc::new(AtomicBool::new(true)),
            received: Arc::new(AtomicUsize::new(0)),
            is_shard: Arc::new(AtomicBool::new(false)),
        };
        let ignored = ignored_signals();
        for signal in ENDING.into_iter().filter(|signal| !ignored.holds(*signal)) {
            // In this order: a signal asks whether to end the program before it says that the next
            // one shall.
            let at_once = &interrupt.ends_at_once;
            let code = i32::from(exit(signal).number());
            flag::register_conditional_shutdown(signal, code, Arc::clone(at_once))?;
            let number = usize::try_from(signal).unwrap_or_default();
            flag::register_usize(signal, Arc::clone(&interrupt.received), number)?;
            flag::register(signal, Arc::clone(at_once))?;
        }
        catch_file_size_limit()?;
        Ok(interrupt)
    }

    /// From now on the first signal is only noted; the program ends [`DEADLINE`] after it all the
    /// same.
    pub(in crate::cli) fn defer(&self) {
        self.ends_at_once.store(false, Ordering::SeqCst);
        let watched = self.clone();
        // Where the system has no thread left, the program ends when the suite does.
        let _ = thread::Builder::new().spawn(move || watched.end_in_time());
    }

    /// The same for a shard: what ends it for want of time or room (SIGTERM) leaves something to go on with.
    pub(in crate::cli) fn defer_shard(&self) {
        self.is_shard.store(true, Ordering::SeqCst);
        self.defer();
    }

    /// How a program that has been asked to stop ends; none if it has not.
    pub(in crate::cli) fn exit(&self) -> Option<Exit> {
        let received = self.received.load(Ordering::SeqCst);
        let signal = i32::try_from(received).ok().filter(|signal| *signal > 0);
        signal.map(|signal| {
            if signal == SIGTERM && self.is_shard.load(Ordering::SeqCst) {
                Exit::Continues
            } else {
                exit(signal)
            }
        })
    }

    fn end_in_time(&self) {
        let exit = loop {
            if let Some(exit) = self.exit() {
                break exit;
            }
            thread::sleep(TICK);
        };
        let received = Instant::now();
        while received.elapsed() < DEADLINE {
            thread::sleep(TICK);
        }
        output::talk("interrupted: ended before everything was written");
        std::process::exit(i32::from(exit.number()));
    }
}

/// The exit code that shells give a program which `signal` has ended.
fn exit(signal: i32) -> Exit {
    const SHELL: u8 = 128;
    Exit::Interrupted(SHELL.saturating_add(u8::try_from(signal).unwrap_or_default()))
}

/// Lets a write beyond the limit of a file's size fail like any other, in place of SIGXFSZ's end of
/// the program.
#[cfg(unix)]
fn catch_file_size_limit() -> io::Result<()> {
    // Caught is enough: nobody asks.
    let unread = Arc::new(AtomicBool::new(false));
    flag::register(signal_hook::consts::SIGXFSZ, unread).map(drop)
}

#[cfg(not(unix))]
fn catch_file_size_limit() -> io::Result<()> {
    Ok(())
}

/// Signals as the bits of a number, that of signal 1 the lowest.
struct SignalSet(u64);

impl SignalSet {
    fn holds(&self, signal: i32) -> bool {
        let bit = u32::try_from(signal - 1).ok();
        bit.and_then(|bit| self.0.checked_shr(bit))
            .is_some_and(|rest| rest & 1 == 1)
    }
}

/// Signals inherited as ignored. Linux tells; elsewhere only unsafe code could ask, and none counts
/// as ignored.
fn ignored_signals() -> SignalSet {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    SignalSet(ignored_in(&status))
}

/// The set in the line `SigIgn:` of a process's status; empty without one.
fn ignored_in(status: &str) -> u64 {
    let mut lines = status.lines();
    let set = lines.find_map(|line| line.strip_prefix("SigIgn:"));
    set.and_then(|set| u64::from_str_radix(set.trim(), 16).ok())
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ignored_signals_are_the_bits_of_the_status() {
        let ignored = SignalSet(ignored_in(
            "Name:\tfogbench\nSigBlk:\t0000000000004000\nSigIgn:\t0000000000001001\n",
        ));
        assert!(ignored.holds(1) && ignored.holds(13));
        assert!(!ignored.holds(2) && !ignored.holds(15) && !ignored.holds(0));
        assert_eq!(ignored_in("Name:\tfogbench\n"), 0);
    }

    #[test]
    fn exit_codes_are_those_of_shells() {
        assert_eq!(exit(SIGINT).number(), 130);
        assert_eq!(exit(SIGTERM).number(), 143);
    }
}
