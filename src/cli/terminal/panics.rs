//! Broken invariants: one line for the user, and a note for the exit code.

use std::panic::{self, PanicHookInfo};
use std::sync::atomic::{AtomicBool, Ordering};

use crate::cli::terminal::output;

/// Whether an invariant was broken, on whatever thread and whoever caught the panic.
static HAPPENED: AtomicBool = AtomicBool::new(false);

/// Makes every panic print one line with its place; with `RUST_BACKTRACE` the way there as well.
pub(in crate::cli) fn install() {
    let with_backtrace = panic::take_hook();
    let asks = std::env::var_os("RUST_BACKTRACE").is_some_and(|value| value != "0");
    panic::set_hook(Box::new(move |info| {
        HAPPENED.store(true, Ordering::SeqCst);
        if asks {
            with_backtrace(info);
        }
        output::talk(&line(info));
    }));
}

/// Whether an invariant was broken since the start of the program.
pub(in crate::cli) fn happened() -> bool {
    HAPPENED.load(Ordering::SeqCst)
}

fn line(info: &PanicHookInfo) -> String {
    let payload = info.payload();
    let message = payload
        .downcast_ref::<String>()
        .map(String::as_str)
        .or_else(|| payload.downcast_ref::<&str>().copied())
        .unwrap_or("no message");
    let words: Vec<&str> = message.split_whitespace().collect();
    let place = info.location().map(|place| format!(" at {place}"));
    format!(
        "error: internal error{}, please report it: {}",
        place.unwrap_or_default(),
        words.join(" ")
    )
}
