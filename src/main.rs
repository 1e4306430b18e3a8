//! Arguments to the command line, and its exit code to the shell.

use std::process::ExitCode;
use std::thread;

/// Stack of the program, bytes: that of the first thread is whatever the shell allows, down to a few pages.
const STACK_BYTES: usize = 8 << 20;

fn main() -> ExitCode {
    let own = thread::Builder::new().stack_size(STACK_BYTES);
    match own.spawn(fogbench::cli::main) {
        // The command line turns a panic into its exit code by itself.
        Ok(program) => program.join().unwrap_or(ExitCode::from(70)),
        // No thread is to be had: the stack that there is may be enough.
        Err(_) => fogbench::cli::main(),
    }
}
