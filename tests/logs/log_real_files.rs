//! Logs as loggers and spreadsheets write them, of one record: each is read as what it holds.

use std::fmt::Write as _;
use std::path::Path;

use serde_json::Value;

use crate::support::records::white;
use crate::support::{assert_close, code, fogbench, scratch, stderr, stdout, write};

/// Rows of the record, 10 Hz.
const ROWS: usize = 300;

fn words() -> Vec<f64> {
    white(11, ROWS, 1.0).iter().map(|word| word + 8.0).collect()
}

/// A file of rows made of their number and word.
fn rows(head: &str, row: impl Fn(usize, f64) -> String) -> String {
    let mut text = head.to_owned();
    for (k, word) in words().into_iter().enumerate() {
        writeln!(text, "{}", row(k, word)).expect("a string takes it");
    }
    text
}

/// Samples, sample rate and mean that `analyze` finds, and what it says.
#[track_caller]
fn measured(folder: &Path, text: &str, options: &str) -> (usize, f64, f64) {
    write(folder, "log.txt", text);
    let mut arguments = vec!["analyze", "log.txt", "--unit", "deg/h", "--format", "json"];
    arguments.extend(options.split(' ').filter(|word| !word.is_empty()));
    let output = fogbench(folder, &arguments);
    assert_eq!(code(&output), 0, "{options}: {}", stderr(&output));
    let json: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    let log = &json["log"];
    let samples = log["samples"].as_u64().unwrap_or_else(|| panic!("{log}"));
    let rate_hz = log["rate_hz"].as_f64().unwrap_or_else(|| panic!("{log}"));
    let mean = json["channels"]["raw"]["mean_deg_per_h"]["value"].as_f64();
    (
        usize::try_from(samples).expect("few"),
        rate_hz,
        // Of a few samples there is none.
        mean.unwrap_or(f64::NAN),
    )
}

#[track_caller]
fn hold(text: &str, options: &str) {
    let folder = scratch();
    let (samples, rate_hz, mean) = measured(folder.path(), text, options);
    assert_eq!(samples, ROWS, "{options}");
    assert_close(rate_hz, 10.0, 1e-9, 0.0);
    let truth = words().iter().sum::<f64>() / 300.0;
    assert_close(mean, truth, 0.0, 1e-3);
}

fn seconds(k: usize) -> String {
    format!("{}.{}", k / 10, k % 10)
}

#[test]
fn a_last_column_may_be_empty_in_most_rows() {
    for filled in [0, 1, 7, ROWS] {
        let flag = |k: usize| if k % 50 < filled { "x" } else { "" };
        hold(
            &rows("t,rate,flag\n", |k, word| {
                format!("{},{word:.4},{}", seconds(k), flag(k))
            }),
            "--column rate",
        );
    }
    let labview = "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\n***End_of_Header***\t\n\n\
                   X_Value\tGyro\tComment\n";
    hold(
        &rows(labview, |k, word| format!("{}\t{word:.4}", seconds(k))),
        "--column Gyro",
    );
    hold(
        &rows(";t;rate\n", |k, word| format!(";{};{word:.4}", seconds(k))),
        "--column rate",
    );
}

#[test]
fn names_of_rows_need_no_heading() {
    hold(
        &rows("\"t\" \"gz\"\n", |k, word| {
            format!("\"{}\" {} {word:.4}", k + 1, seconds(k))
        }),
        "--column gz",
    );
    hold(
        &rows("t,gz\n", |k, word| format!("{k},{},{word:.4}", seconds(k))),
        "--column gz",
    );
}

#[test]
fn parts_of_a_second_in_a_column_of_their_own_are_added() {
    let part = |k: usize, most: usize| (k % 10) * most / 10;
    for (head, most) in [
        ("secs,nsecs,gz\n", 1_000_000_000),
        ("header.stamp.sec,header.stamp.nanosec,gz\n", 1_000_000_000),
        ("timestamp_s,timestamp_us,gz\n", 1_000_000),
        ("Time,Millisecond,gz\n", 1_000),
    ] {
        hold(
            &rows(head, |k, word| {
                format!("{},{},{word:.4}", 1_709_632_798 + k / 10, part(k, most))
            }),
            "--column gz",
        );
    }
    let clock = |k: usize| format!("2024-03-05 09:59:{:02}", k / 10);
    hold(
        &rows("Time,ms,gz\n", |k, word| {
            format!("{},{},{word:.4}", clock(k), part(k, 1000))
        }),
        "--column gz",
    );
    // Decimals behind a comma that separates as well.
    hold(
        &rows("", |k, word| {
            format!("{},{:03},{word:.4}", clock(k), part(k, 1000))
        }),
        "--column 3",
    );
    // What is no part of a second stays what it is.
    let folder = scratch();
    let text = rows("time_s,latency_ms,gz\n", |k, word| {
        format!("{k},{},{word:.4}", part(k, 1000))
    });
    let (_, rate_hz, _) = measured(folder.path(), &text, "--column gz");
    assert_close(rate_hz, 1.0, 1e-12, 0.0);
}

#[test]
fn the_rate_of_stamps_that_are_rounded_to_many_samples_is_that_of_all_of_them() {
    let folder = scratch();
    for (digit, rate_hz) in [(1.0, 10.0), (0.01, 400.0), (1.0, 7.3)] {
        let stamp = |k: usize| (k as f64 / rate_hz / digit).floor() * digit;
        let text = rows("t,rate\n", |k, word| format!("{:.2},{word:.4}", stamp(k)));
        let (_, found_hz, _) = measured(folder.path(), &text, "--column rate");
        assert_close(found_hz, rate_hz, 2e-3, 0.0);
    }
}

#[test]
fn stretches_share_no_sample_and_lie_within_the_part_that_is_asked_for() {
    let folder = scratch();
    let text = rows("t,rate\n", |k, word| format!("{},{word:.4}", seconds(k)));
    write(folder.path(), "s.csv", "from_s,to_s\n1,2\n2,3\n4,5\n");
    let samples = |options: &str| measured(folder.path(), &text, options).0;
    assert_eq!(samples("--segments s.csv"), 21 + 11);
    assert_eq!(samples("--segments s.csv --to-s 3"), 21);
    assert_eq!(samples("--segments s.csv --from-s 2.5"), 6 + 11);
    assert_eq!(samples("--rows :100"), 100);
    // What stands behind the last row that is asked for is not looked at.
    let text = text + "Mean,8.0,end\n";
    let (samples, ..) = measured(folder.path(), &text, "--rows :300");
    assert_eq!(samples, ROWS);
}

#[test]
fn words_for_missing_numbers_are_gaps_where_that_is_said() {
    for word in [
        "---",
        "-",
        "?",
        "OVR",
        "#WERT!",
        "-1.#IND",
        "-nan(ind)",
        "#NV",
    ] {
        let folder = scratch();
        let text = rows("t,rate\n", |k, value| match k % 100 {
            50 => format!("{},{word}", seconds(k)),
            _ => format!("{},{value:.4}", seconds(k)),
        });
        let (samples, ..) = measured(folder.path(), &text, "--missing gap");
        assert_eq!(samples, ROWS - 3, "{word}");
    }
}
