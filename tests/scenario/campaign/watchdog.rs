//! Ends the test binary if a case hangs: a thread that does not return cannot be stopped.

use std::process;
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread;
use std::time::Duration;

/// Longest time of one case.
const PATIENCE: Duration = Duration::from_secs(60);

/// Watches cases until it is dropped.
pub(crate) struct Watchdog {
    fed: Sender<String>,
}

impl Watchdog {
    /// Starts to watch.
    pub(crate) fn start() -> Self {
        let (fed, bowl) = mpsc::channel::<String>();
        thread::spawn(move || {
            let mut case = String::new();
            loop {
                match bowl.recv_timeout(PATIENCE) {
                    Ok(next) => case = next,
                    Err(RecvTimeoutError::Disconnected) => return,
                    Err(RecvTimeoutError::Timeout) => {
                        eprintln!("HANG: {case} takes more than {} s", PATIENCE.as_secs());
                        process::abort();
                    }
                }
            }
        });
        Self { fed }
    }

    /// Says which case begins.
    pub(crate) fn feed(&self, case: String) {
        // The watching thread ends with this value or with the process.
        let _ = self.fed.send(case);
    }
}
