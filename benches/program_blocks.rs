//! What the protocol of `[filter.process]` costs beyond the filter.
//!
//! `cargo bench --bench program_blocks` builds a C program that answers every word as it is, hands it 1000 blocks
//! of 4096 words once it is warm, and prints the median and the slowest of twenty times of a block. Wanted: a median
//! below 50 us. Needs `cc`.

use std::path::Path;
use std::process::{Command, ExitCode};

use fogbench::experiment::{SUPERVISE, exchange_times};

/// The program, to be put beside the header of the examples.
const ECHO: &str = "#include \"fogbench_filter.h\"\n\
    static double step(void *state, double word) { (void)state; return word; }\n\
    int main(void) { return fogbench_serve(\"echo\", \"1\", 0, step, 0); }\n";

const BLOCKS: usize = 1000;
const WORDS: u32 = 4096;

fn main() -> ExitCode {
    let first = std::env::args().nth(1);
    if first.as_deref() == Some(SUPERVISE) {
        return fogbench::cli::main();
    }
    let folder = std::env::temp_dir().join(format!("fogbench-blocks-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("the scratch folder is writable");
    let printed = measure(&folder);
    drop(std::fs::remove_dir_all(&folder));
    match printed {
        Ok(line) => {
            println!("{line}");
            ExitCode::SUCCESS
        }
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn measure(folder: &Path) -> Result<String, String> {
    let header = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/process");
    let (source, program) = (folder.join("echo.c"), folder.join("echo"));
    std::fs::write(&source, ECHO).map_err(|error| error.to_string())?;
    let built = Command::new("cc")
        .arg("-O2")
        .arg("-I")
        .arg(&header)
        .arg("-o")
        .args([&program, &source])
        .status();
    if !built.is_ok_and(|status| status.success()) {
        return Err("cc does not build the program".to_owned());
    }
    let mut times = exchange_times(&program, BLOCKS, WORDS).map_err(|error| error.to_string())?;
    times.sort_unstable();
    let us = |index: usize| times[index].as_secs_f64() * 1e6;
    Ok(format!(
        "{BLOCKS} blocks of {WORDS} words: median {:.1} us a block, {:.1} us for the slowest twentieth",
        us(BLOCKS / 2),
        us(BLOCKS - BLOCKS / 20),
    ))
}
