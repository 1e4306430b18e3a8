//! Logs on standard input: words without a heading, arrays that end early, and what is said of logs that
//! stream.

use std::path::Path;
use std::process::Output;

use fogbench::metrics::NOT_STREAMED;
use fogbench::store::write_npy;
use serde_json::Value;

use crate::support::records::white;
use crate::support::transcript::Transcript;
use crate::support::{code, fogbench, piped, scratch, stderr, stdout};

/// Counts of a gyro at rest.
fn counts(count: usize) -> Vec<i16> {
    let noise = white(3, count, 40.0);
    #[expect(
        clippy::cast_possible_truncation,
        reason = "noise of some dozen counts"
    )]
    let count = |noise: &f64| 100 + noise.round() as i16;
    noise.iter().map(count).collect()
}

const ON_PIPE: [&str; 8] = [
    "analyze",
    "-",
    "--rate-hz",
    "100",
    "--unit",
    "deg/h",
    "--scale",
    "0.25",
];

#[cfg(target_os = "linux")]
#[test]
fn words_without_a_heading_on_a_pipe_measure_what_they_do_in_an_array() {
    let folder = scratch();
    let counts = counts(9000);
    let rates: Vec<f64> = counts.iter().map(|it| 0.25 * f64::from(*it)).collect();
    write_npy(&folder.path().join("rates.npy"), &rates).expect("a file");
    let metrics = |output: &Output| {
        assert_eq!(code(output), 0, "{}", stderr(output));
        let document: Value = serde_json::from_str(&stdout(output)).expect("JSON");
        document["channels"]["raw"]["metrics"].clone()
    };
    let file = fogbench(
        folder.path(),
        &[
            "analyze",
            "rates.npy",
            "--rate-hz",
            "100",
            "--unit",
            "deg/h",
            "--format",
            "json",
        ],
    );
    let wanted = metrics(&file);
    let low: Vec<u8> = counts.iter().flat_map(|it| it.to_le_bytes()).collect();
    let high: Vec<u8> = counts.iter().flat_map(|it| it.to_be_bytes()).collect();
    for (dtype, bytes) in [("i2", low), ("i2-be", high)] {
        let more = ["--dtype", dtype, "--format", "json"];
        let output = piped(folder.path(), &bytes, &[&ON_PIPE[..], &more].concat());
        assert_eq!(metrics(&output), wanted, "{dtype}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn the_end_of_a_pipe_ends_the_record_and_is_told() {
    let folder = scratch();
    let bytes: Vec<u8> = counts(900).iter().flat_map(|it| it.to_le_bytes()).collect();
    let mut transcript = Transcript::of("log-stream", "Words and arrays on a pipe");
    let dtype = ["--dtype", "i2"];
    let output = piped(
        folder.path(),
        &bytes[..1799],
        &[&ON_PIPE[..], &dtype].concat(),
    );
    assert_eq!(code(&output), 2);
    transcript.case("a pipe that ends within a word", stderr(&output));
    let dtype = ["--dtype", "i3"];
    let output = piped(folder.path(), &bytes, &[&ON_PIPE[..], &dtype].concat());
    assert_eq!(code(&output), 2);
    transcript.case("words of three bytes", stderr(&output));
    transcript.check();
}

#[test]
fn the_page_names_every_metric_that_does_not_stream_with_its_reason() {
    let page = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/logs.md"));
    let page = page.expect("the page of the logs");
    for (key, reason) in NOT_STREAMED {
        let reason = reason
            .strip_prefix("does not stream: ")
            .expect("it says so");
        let row = format!("| `{}` | {reason} |", key.name);
        assert!(page.contains(&row), "{row}");
    }
}
