//! Logs as people have them: what is found of their layout, units, time and gaps, and what is asked for.

use std::fmt::Write as _;
use std::path::Path;

use fogbench::recording::{Log, LogFormat, MissingWords, WordKind, read_log, read_logs};
use proptest::prelude::*;
use serde_json::Value;

use crate::support::records::white;
use crate::support::transcript::Transcript;
use crate::support::{assert_close, code, fogbench, scratch, stderr, stdout, write};

/// The transcript of what is said of layouts.
const LAYOUTS: &str = "layouts";

/// deg/s of a word of 10 ms with an angle random walk of 1.2 deg/sqrt(h).
const WORD_STD: f64 = 0.2;

#[track_caller]
fn read(text: impl AsRef<[u8]>, format: &LogFormat) -> Result<Log, String> {
    let folder = scratch();
    let path = folder.path().join("log.csv");
    std::fs::write(&path, text).expect("writable");
    read_log(&path, format).map_err(|error| {
        error
            .to_string()
            .replace(&*folder.path().to_string_lossy(), "")
    })
}

fn named(column: &str) -> LogFormat {
    LogFormat {
        column: Some(vec![column.to_owned()]),
        ..LogFormat::default()
    }
}

fn at(rate_hz: f64, unit: &str) -> LogFormat {
    LogFormat {
        rate_hz: Some(rate_hz),
        unit: Some(unit.parse().expect("a unit")),
        ..LogFormat::default()
    }
}

/// What `analyze` says of a file, as JSON and on standard error.
#[track_caller]
fn analysed(folder: &Path, arguments: &[&str]) -> (Value, String) {
    let output = fogbench(
        folder,
        &[&["analyze"], arguments, &["--format", "json"]].concat(),
    );
    assert_eq!(code(&output), 0, "{arguments:?}: {}", stderr(&output));
    let json = serde_json::from_str(&stdout(&output)).expect("JSON");
    (json, stderr(&output))
}

#[track_caller]
fn walk(json: &Value) -> f64 {
    let walk = &json["channels"]["raw"]["angle_random_walk_deg_per_sqrt_h"]["value"];
    walk.as_f64().unwrap_or_else(|| panic!("{json}"))
}

#[track_caller]
fn refused(folder: &Path, arguments: &[&str]) -> String {
    let output = fogbench(folder, &[&["analyze"], arguments].concat());
    assert_eq!(code(&output), 2, "{arguments:?}: {}", stdout(&output));
    stderr(&output)
}

/// A table of stamps and white noise in deg/s.
fn table(heading: &str, separator: &str, count: usize, stamp: impl Fn(usize) -> String) -> String {
    let mut text = heading.to_owned();
    for (k, word) in white(5, count, WORD_STD).iter().enumerate() {
        writeln!(text, "{}{separator}{word:.6}", stamp(k)).expect("a string takes it");
    }
    text
}

#[test]
fn a_lost_sample_is_refused_with_the_option_that_goes_on_and_cut_by_it() {
    let folder = scratch();
    let stamp = |k: usize| format!("{:.3}", (k + usize::from(k >= 3000)) as f64 / 100.0);
    write(
        folder.path(),
        "log.csv",
        &table("time_s,rate_dps\n", ",", 6000, stamp),
    );
    let message = refused(folder.path(), &["log.csv"]);
    assert!(
        message.contains("log.csv:3002") && message.contains("--split-gaps"),
        "{message}"
    );
    let (json, _) = analysed(folder.path(), &["log.csv", "--split-gaps"]);
    assert_close(walk(&json), 1.2, 0.1, 0.0);
    assert_eq!(json["log"]["samples"], 6000);
    // The parts alone give the words of either side.
    let (before, _) = analysed(folder.path(), &["log.csv", "--rows", ":3000"]);
    let (behind, _) = analysed(folder.path(), &["log.csv", "--from-s", "30.01"]);
    assert_eq!(before["log"]["samples"], 3000);
    assert_eq!(behind["log"]["samples"], 3000);
}

#[test]
fn two_stretches_an_hour_apart_are_pooled_and_their_means_compared() {
    let folder = scratch();
    let mut text = "utc;rate\n".to_owned();
    for (k, word) in white(9, 1200, 1e-3).iter().enumerate() {
        let (hour, step) = if k < 600 { (12, 0.0) } else { (13, 3e-3) };
        let ms = 5 * (k % 600);
        writeln!(
            text,
            "2024-03-01T{hour}:00:{:02}.{:03}000Z;{:.9}",
            ms / 1000,
            ms % 1000,
            word + step
        )
        .expect("a string takes it");
    }
    write(folder.path(), "log.csv", &text);
    let arguments = [
        "log.csv",
        "--unit",
        "rad/s",
        "--rate-hz",
        "200",
        "--column",
        "rate",
    ];
    let message = refused(folder.path(), &arguments);
    assert!(
        message.contains("--split-gaps") && message.contains("gap of 3597.0"),
        "{message}"
    );
    let (json, _) = analysed(folder.path(), &[&arguments[..], &["--split-gaps"]].concat());
    // 1e-3 rad/s at 200 Hz are 1e-3/sqrt(200) rad/sqrt(s).
    let want = 1e-3 / 200_f64.sqrt() * 180.0 / std::f64::consts::PI * 60.0;
    assert_close(walk(&json), want, 0.25, 0.0);
    let notes = json["notes"].to_string();
    let step = 3e-3_f64.to_degrees() * 3600.0;
    assert!(
        notes.contains("2 parts with gaps between them are pooled"),
        "{notes}"
    );
    let said = notes
        .split("largest step from one to the next is ")
        .nth(1)
        .expect("a step");
    let said: f64 = said
        .split(' ')
        .next()
        .and_then(|it| it.parse().ok())
        .expect("deg/h");
    assert_close(said, step, 0.1, 0.0);
}

#[test]
fn a_preamble_a_counter_that_begins_again_and_a_commented_heading_are_read() {
    let folder = scratch();
    let counter = |k: usize| format!("{}", (65_000 + k) % 65_536);
    let heading = "// Start Time: Unknown\n// Sample rate: 100.0Hz\nPacketCounter\tGyr_X\n";
    write(
        folder.path(),
        "log.txt",
        &table(heading, "\t", 4000, counter),
    );
    let arguments = [
        "log.txt",
        "--unit",
        "deg/s",
        "--column",
        "Gyr_X",
        "--rate-hz",
        "100",
    ];
    let (json, said) = analysed(folder.path(), &arguments);
    assert_close(walk(&json), 1.2, 0.15, 0.0);
    assert!(said.contains("2 comments, heading in line 3"), "{said}");
    assert!(
        json["notes"]
            .to_string()
            .contains("begins again 1 time, each after 65536 counts")
    );
    // A packet that is lost is found by its number.
    let lost = |k: usize| format!("{}", 10 + k + usize::from(k >= 7));
    write(folder.path(), "lost.txt", &table(heading, "\t", 4000, lost));
    let message = refused(folder.path(), &[&["lost.txt"], &arguments[1..]].concat());
    assert!(message.contains("column PacketCounter: gap of 2") && message.contains("(1 missing)"));

    let stamp = |k: usize| (1_403_636_579_758_555_392 + 10_000_000 * k as u64).to_string();
    let text = table("#timestamp [ns],w_x [deg s^-1]\n", ",", 4000, stamp);
    write(folder.path(), "ns.csv", &text);
    let (json, _) = analysed(folder.path(), &["ns.csv"]);
    assert_close(walk(&json), 1.2, 0.15, 0.0);
    assert_eq!(json["log"]["rate_hz"], 100.0);
    let notes = json["notes"].to_string();
    assert!(
        notes.contains("100.000000 Hz, no gap, stamps within 0.000 us"),
        "{notes}"
    );
}

#[test]
fn a_row_of_units_names_them_and_a_heading_that_contradicts_is_told() {
    let folder = scratch();
    let seconds = |k: usize| format!("{:.2}", k as f64 / 100.0);
    write(
        folder.path(),
        "units.csv",
        &table("time,gyro_z\ns,deg/s\n", ",", 4000, seconds),
    );
    let (json, said) = analysed(folder.path(), &["units.csv"]);
    assert_close(walk(&json), 1.2, 0.15, 0.0);
    assert!(
        said.contains("heading in line 1, units in line 2"),
        "{said}"
    );

    let text = table("tow(msec),gyro_x(rad/s)\n", ",", 4000, seconds);
    write(folder.path(), "tow.csv", &text);
    let mut transcript = Transcript::of(LAYOUTS, "Headings and options that contradict each other");
    for arguments in [
        "tow.csv",
        "tow.csv --unit deg/s --time tow(msec) --time-unit ms",
        "tow.csv --time-unit s --unit deg/s",
        "tow.csv --time-unit s --kind angle",
        "tow.csv --time-unit s --scale 0",
        "tow.csv --unit furlong/s",
        "units.csv --rate-hz 250",
    ] {
        let words: Vec<&str> = arguments.split(' ').collect();
        transcript.case(arguments, refused(folder.path(), &words));
    }
    transcript.check();
    let ignored = [
        "tow.csv",
        "--unit",
        "deg/s",
        "--heading-units",
        "ignore",
        "--time-unit",
        "s",
    ];
    let (json, _) = analysed(folder.path(), &ignored);
    assert_close(walk(&json), 1.2, 0.15, 0.0);
}

#[test]
fn counts_constants_missing_words_and_spreadsheets_come_out_right() {
    let folder = scratch();
    // Coarse counts of 0.05 deg/s: noise of 0.4 of a count and its rounding.
    let counts: Vec<f64> = white(3, 6000, 0.4)
        .iter()
        .map(|word| word.round())
        .collect();
    let text: String = counts.iter().map(|count| format!("{count}\n")).collect();
    write(folder.path(), "counts.csv", &format!("counts\n{text}"));
    let arguments = ["counts.csv", "--unit", "deg/s", "--rate-hz", "100"];
    let message = refused(folder.path(), &arguments);
    assert!(
        message.contains("holds counts by its heading: --scale"),
        "{message}"
    );
    let (json, _) = analysed(
        folder.path(),
        &[&arguments[..], &["--scale", "0.05"]].concat(),
    );
    let variance = counts.iter().map(|count| count * count).sum::<f64>() / 6000.0;
    assert_close(walk(&json), 0.05 * variance.sqrt() * 6.0, 0.12, 0.0);

    write(
        folder.path(),
        "constant.csv",
        &format!("rate\n{}", "0.0\n".repeat(2000)),
    );
    let (json, _) = analysed(
        folder.path(),
        &["constant.csv", "--unit", "rad/s", "--rate-hz", "100"],
    );
    let why = json["channels"]["raw"]["unavailable"].to_string();
    assert!(why.contains("does not vary"), "{why}");

    let mut words: Vec<String> = white(7, 4000, WORD_STD)
        .iter()
        .map(f64::to_string)
        .collect();
    words[50] = "NaN".to_owned();
    words[2000] = "N/A".to_owned();
    write(
        folder.path(),
        "nan.csv",
        &format!("rate\n{}\n", words.join("\n")),
    );
    let arguments = ["nan.csv", "--unit", "deg/s", "--rate-hz", "100"];
    let message = refused(folder.path(), &arguments);
    assert!(
        message.contains("nan.csv:52") && message.contains("--missing gap"),
        "{message}"
    );
    let (json, _) = analysed(
        folder.path(),
        &[&arguments[..], &["--missing", "gap"]].concat(),
    );
    assert_close(walk(&json), 1.2, 0.15, 0.0);
    assert_eq!(json["log"]["samples"], 3998);
    assert!(json["notes"].to_string().contains("2 samples missing"));

    let seconds = |k: usize| format!("{:.2}", k as f64 / 100.0);
    let text = table("\u{feff}Time [s], Gyro X [deg/s], \n", ", ", 4000, seconds);
    write(
        folder.path(),
        "sheet.csv",
        &text.replace('\n', ", \r\n").replace(", , ", ", "),
    );
    let (json, _) = analysed(folder.path(), &["sheet.csv"]);
    assert_close(walk(&json), 1.2, 0.15, 0.0);
}

#[test]
fn integers_and_tables_of_arrays_are_read_by_number() {
    let folder = scratch();
    let words = white(4, 4000, WORD_STD / 0.0076336);
    let npy = |name: &str, descr: &str, order: &str, shape: &str, data: &[u8]| {
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        let heading =
            format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': {shape}, }}\n");
        bytes.extend(u16::try_from(heading.len()).expect("short").to_le_bytes());
        bytes.extend(heading.bytes());
        bytes.extend(data);
        std::fs::write(folder.path().join(name), bytes).expect("writable");
    };
    #[expect(
        clippy::cast_possible_truncation,
        reason = "noise of some hundred counts"
    )]
    let counts: Vec<i16> = words.iter().map(|word| word.round() as i16).collect();
    let data: Vec<u8> = counts
        .iter()
        .flat_map(|count| count.to_le_bytes())
        .collect();
    npy("counts.npy", "<i2", "False", "(4000,)", &data);
    let scaled = [
        "--unit",
        "deg/s",
        "--scale",
        "0.0076336",
        "--rate-hz",
        "100",
    ];
    let (json, _) = analysed(folder.path(), &[&["counts.npy"], &scaled[..]].concat());
    assert_close(walk(&json), 1.2, 0.15, 0.0);

    // Nanoseconds beside two gyros, row by row, column by column and turned.
    let stamp =
        |k: usize| 1_403_636_579_758_555_392_i64 + 10_000_000 * i64::try_from(k).expect("few");
    let row = |k: usize| [stamp(k), i64::from(counts[k]), -2 * i64::from(counts[k])];
    let by_row: Vec<u8> = (0..4000).flat_map(row).flat_map(i64::to_be_bytes).collect();
    let by_column: Vec<u8> = (0..3)
        .flat_map(|column| (0..4000).map(move |k| (column, k)))
        .flat_map(|(column, k)| row(k)[column].to_be_bytes())
        .collect();
    npy("rows.npy", ">i8", "False", "(4000, 3)", &by_row);
    npy("columns.npy", ">i8", "True", "(4000, 3)", &by_column);
    npy("turned.npy", ">i8", "False", "(3, 4000)", &by_column);
    let format = LogFormat {
        unit: Some("deg/s".parse().expect("a unit")),
        scale: Some(0.0076336),
        column: Some(vec!["2".to_owned(), "3".to_owned()]),
        time: Some(vec!["1".to_owned()]),
        time_unit: Some(vec!["ns".parse().expect("a unit")]),
        ..LogFormat::default()
    };
    for name in ["rows.npy", "columns.npy", "turned.npy"] {
        let logs = read_logs(&folder.path().join(name), &format).expect(name);
        assert_close(logs[0].sample_rate_hz, 100.0, 1e-15, 0.0);
        for (k, count) in counts.iter().enumerate() {
            let rate = f64::from(*count) * 0.0076336 * 3600.0;
            assert_close(logs[0].rate_deg_per_h[k], rate, 1e-12, 0.0);
            assert_close(logs[1].rate_deg_per_h[k], -2.0 * rate, 1e-12, 0.0);
        }
    }
    // Halves: 1.5, -2, the smallest number, 65504.
    let halves = [0x3e00_u16, 0xc000, 0x0001, 0x7bff];
    let data: Vec<u8> = halves.iter().flat_map(|half| half.to_le_bytes()).collect();
    npy("half.npy", "<f2", "False", "(4,)", &data);
    let log = read_log(&folder.path().join("half.npy"), &at(1.0, "deg/h")).expect("halves");
    assert_eq!(log.rate_deg_per_h, [1.5, -2.0, 2_f64.powi(-24), 65504.0]);
}

#[test]
fn running_angles_and_increments_become_rates() {
    let angles = "angle_deg\n350\n355\n0\n5\n12.5\n";
    let message = read(
        angles,
        &LogFormat {
            unit: None,
            ..at(10.0, "deg")
        },
    )
    .expect_err("of what");
    assert!(message.contains("--kind angle"), "{message}");
    let kind = |kind| LogFormat {
        unit: None,
        kind: Some(kind),
        ..at(10.0, "deg")
    };
    // 5 deg in 0.1 s are 50 deg/s, across the turn as well.
    let log = read(angles, &kind(WordKind::Angle)).expect("a running angle");
    for (rate, want) in log.rate_deg_per_h.iter().zip([50.0, 50.0, 50.0, 75.0]) {
        assert_close(*rate, want * 3600.0, 1e-12, 0.0);
    }
    let log = read("turned_urad\n2\n-1\n", &kind(WordKind::Increment)).expect("increments");
    assert_close(
        log.rate_deg_per_h[0],
        2e-5_f64.to_degrees() * 3600.0,
        1e-12,
        0.0,
    );
    // A rate that is none is told.
    let mut angle = 0.0;
    let text: String = white(8, 3000, 1.0)
        .iter()
        .map(|step| {
            angle += step + 0.1;
            format!("{angle:.6}\n")
        })
        .collect();
    let log = read(&text, &at(10.0, "deg/s")).expect("a rate");
    assert!(
        log.notes().iter().any(|note| note.contains("--kind angle")),
        "{:?}",
        log.notes()
    );
    let rates: String = white(8, 3000, 1.0)
        .iter()
        .map(|rate| format!("{rate:.6}\n"))
        .collect();
    assert_eq!(
        read(&rates, &at(10.0, "deg/s")).expect("a rate").notes(),
        [""; 0]
    );
}

#[test]
fn clocks_of_every_kind_are_read() {
    let rate = |text: &str, format: LogFormat| {
        let log = read(text, &format).unwrap_or_else(|error| panic!("{text}: {error}"));
        log.sample_rate_hz
    };
    let plain = || at(1.0, "deg/h");
    let free = || LogFormat {
        rate_hz: None,
        ..plain()
    };
    for (text, want) in [
        ("week,tow,g\n2304,604799.9,1\n2305,0,2\n2305,0.1,3\n", 10.0),
        (
            "date,time,g\n2024-02-29,23:59:59.5,1\n2024-03-01,00:00:00.0,2\n2024-03-01,00:00:00.5,3\n",
            2.0,
        ),
        ("stamp_us,g\n0,1\n4000,2\n8000,3\n", 250.0),
        (
            "timestamp,g\n1700000000000,1\n1700000000004,2\n1700000000008,3\n",
            250.0,
        ),
        ("t_ms,g\n4294967290,1\n4294967294,2\n2,3\n6,4\n", 250.0),
        ("2024-03-01 12:00:00;1\n2024-03-01 12:00:01;2\n", 1.0),
        ("tod,g\n86399.0,0\n86399.5,1\n0.0,2\n0.5,3\n", 2.0),
    ] {
        let format = match text.starts_with("tod") {
            true => LogFormat {
                time: Some(vec!["tod".to_owned()]),
                ..free()
            },
            false => free(),
        };
        assert_close(rate(text, format), want, 1e-9, 0.0);
    }
    let two = LogFormat {
        time: Some(vec!["secs".to_owned(), "nsecs".to_owned()]),
        ..free()
    };
    let text = "secs,nsecs,g\n9,990000000,1\n10,0,2\n10,10000000,3\n";
    assert_close(
        rate(
            text,
            LogFormat {
                time_unit: Some(vec!["s".parse().expect("s"), "ns".parse().expect("ns")]),
                ..two
            },
        ),
        100.0,
        1e-12,
        0.0,
    );
    // Stamps of whole milliseconds at 400 Hz and at 1 kHz: no gap, no contradiction, and the rate is right.
    for rate_hz in [400.0, 1000.0, 3000.0] {
        let mut text = "time_ms,g\n".to_owned();
        for k in 0..6000 {
            let jitter = [0.0, 0.3, -0.2][k % 3];
            writeln!(
                text,
                "{:.0},{}",
                (k as f64 / rate_hz * 1e3 + jitter).floor(),
                k % 7
            )
            .expect("a string");
        }
        assert_close(rate(&text, free()), rate_hz, 1e-3, 0.0);
    }
}

#[test]
fn what_is_in_doubt_is_an_error_that_names_the_option() {
    let mut transcript = Transcript::of(LAYOUTS, "What is in doubt");
    for (text, format) in [
        ("1,234;5,678\n2,345;6,789\n", at(1.0, "deg/h")),
        ("g,1\n0.5,1.5\n1,2.5\n", at(1.0, "deg/h")),
        (
            "2024 log of monday\ng,h\n0.5,1.5\n1,2.5\n",
            at(1.0, "deg/h"),
        ),
        ("g,h\n0.5,1.5,3\n1,2.5,4\n", at(1.0, "deg/h")),
        (
            "time,utc,g\n0,0,1\n1,1,2\n",
            LogFormat {
                rate_hz: None,
                ..at(1.0, "deg/h")
            },
        ),
        (
            "gyro_x,gyro_y\n1,2\n",
            LogFormat {
                column: Some(vec!["gyro".to_owned()]),
                ..at(1.0, "deg/h")
            },
        ),
        ("1 2 3 4\n5 6 7 8\n", at(1.0, "deg/h")),
        (
            "1 2 3\n4 5\n",
            LogFormat {
                wrapped_columns: Some(2),
                column: Some(vec!["1".to_owned()]),
                ..at(1.0, "deg/h")
            },
        ),
        (
            "g\n1\n2\n",
            LogFormat {
                rows: Some("5:7".parse().expect("rows")),
                ..at(1.0, "deg/h")
            },
        ),
        (
            "g\n1\n2\n",
            LogFormat {
                from_s: Some(9.0),
                ..at(1.0, "deg/h")
            },
        ),
        (
            "g\n1\n2\n",
            LogFormat {
                unit: None,
                ..at(1.0, "deg/h")
            },
        ),
        (
            "g\n1\n2\n",
            LogFormat {
                heading_line: Some(7),
                ..at(1.0, "deg/h")
            },
        ),
    ] {
        let given = fogbench::scenario::log_format_toml(&format).replace('\n', " ");
        let message = read(text, &format).map(|log| log.layout).expect_err(text);
        transcript.case(format!("{given}\n{text}"), message);
    }
    transcript.check();
}

#[test]
fn a_layout_that_was_explained_reads_the_log_again() {
    let folder = scratch();
    let seconds = |k: usize| format!("{:.2}", k as f64 / 100.0).replace('.', ",");
    let heading = "Device; FOG 7\nSerial; 12\n\nt; g_x; g_y\ns; °/s; °/s\n";
    let mut text = heading.to_owned();
    for (k, word) in white(5, 600, WORD_STD).iter().enumerate() {
        let word = format!("{word:.6}").replace('.', ",");
        writeln!(text, "{}; {word}; -{k}", seconds(k)).expect("a string takes it");
    }
    write(folder.path(), "log.csv", &text);
    let output = fogbench(
        folder.path(),
        &["analyze", "log.csv", "--column", "g_x", "--explain"],
    );
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let mut transcript = Transcript::of(LAYOUTS, "A layout that was found");
    let said = format!("  {}", stdout(&output).replace('\n', "\n  "));
    transcript.case(heading, format!("{said}\n{}", stderr(&output)));
    write(folder.path(), "layout.toml", &stdout(&output));
    let (found, _) = analysed(folder.path(), &["log.csv", "--column", "g_x"]);
    let (given, _) = analysed(folder.path(), &["log.csv", "--layout", "layout.toml"]);
    assert_eq!(found, given);
    // Options stand above the file; what is wrong in it is told with its line.
    let (other, _) = analysed(
        folder.path(),
        &["log.csv", "--layout", "layout.toml", "--column", "g_y"],
    );
    assert_eq!(other["log"]["column"], "g_y");
    write(
        folder.path(),
        "bad.toml",
        "[log]\nseperator = \"tab\"\nscale = \"x\"\nunit = \"knots\"\n",
    );
    transcript.case(
        "--layout bad.toml",
        refused(folder.path(), &["log.csv", "--layout", "bad.toml"]),
    );
    transcript.check();
    // All axes in one call.
    let all = fogbench(
        folder.path(),
        &[
            "analyze", "log.csv", "--column", "g_*", "-o", "out", "--format", "jsonl",
        ],
    );
    assert_eq!(code(&all), 0, "{}", stderr(&all));
    assert_eq!(stdout(&all).lines().count(), 2);
    assert!(folder.path().join("out/g-x/summary.json").is_file());
    assert!(folder.path().join("out/g-y/summary.json").is_file());
}

/// How a log is written down.
#[derive(Clone, Debug)]
struct Writing {
    separator: &'static str,
    is_decimal_comma: bool,
    line_end: &'static str,
    preamble: usize,
    mark: &'static str,
    has_heading: bool,
    is_heading_commented: bool,
    has_units_row: bool,
    is_quoted: bool,
    encoding: usize,
    clock: usize,
    columns: usize,
}

fn writing() -> impl Strategy<Value = Writing> {
    let words = (
        prop::sample::select(vec![",", ";", "\t", "  ", " ; "]),
        prop::sample::select(vec!["\n", "\r\n", "\r"]),
        prop::sample::select(vec!["#", "//", "%", ""]),
    );
    let flags = prop::collection::vec(any::<bool>(), 5);
    (words, flags, 0..4_usize, 0..3_usize, 0..4_usize, 1..4_usize).prop_map(
        |((separator, line_end, mark), flags, preamble, encoding, clock, columns)| Writing {
            separator,
            // A comma between numbers with a decimal comma needs quotation marks.
            is_decimal_comma: flags[0],
            line_end,
            preamble,
            mark,
            has_heading: flags[1] || mark.is_empty() && preamble > 0,
            is_heading_commented: flags[2] && !mark.is_empty(),
            has_units_row: flags[3],
            is_quoted: flags[4] || flags[0] && separator == ",",
            encoding,
            clock,
            columns,
        },
    )
}

impl Writing {
    fn line(&self, cells: &[String], is_number: bool) -> String {
        let cells = cells.iter().map(|cell| {
            let cell = match is_number && self.is_decimal_comma {
                true => cell.replace('.', ","),
                false => cell.clone(),
            };
            if self.is_quoted {
                format!("\"{cell}\"")
            } else {
                cell
            }
        });
        cells.collect::<Vec<_>>().join(self.separator) + self.line_end
    }

    fn stamp(&self, row: usize) -> String {
        match self.clock {
            0 => format!("{:.2}", 7.0 + row as f64 / 50.0),
            1 => format!(
                "{}",
                1_700_000_000_123_456_789_u64 + 20_000_000 * row as u64
            ),
            2 => format!("2024-03-01T12:00:{:02}.{:02}Z", row / 50, 2 * (row % 50)),
            _ => format!("{}", (65_530 + row) % 65_536),
        }
    }

    fn text(&self, rows: &[Vec<f64>]) -> String {
        let mut text = String::new();
        for line in 0..self.preamble {
            let free = [
                "Serial number 7",
                "Gyro of monday",
                "Remark, if any",
                "Temperature 25",
            ];
            text.push_str(&format!("{} {}{}", self.mark, free[line], self.line_end));
        }
        let (name, unit) = [
            ("time_s", "s"),
            ("stamp_ns", "ns"),
            ("utc", ""),
            ("packet", ""),
        ][self.clock];
        let mut names = vec![name.to_owned()];
        let mut units = vec![unit.to_owned()];
        for column in 0..self.columns {
            names.push(format!("g{column}"));
            units.push("mdeg/s".to_owned());
        }
        let heading = self.is_heading_commented.then(|| format!("{} ", self.mark));
        if self.has_heading {
            text.push_str(&heading.clone().unwrap_or_default());
            text.push_str(&self.line(&names, false));
            // Blanks leave no cell empty.
            if self.has_units_row
                && (!self.separator.trim().is_empty() || self.separator == "\t" || !unit.is_empty())
            {
                text.push_str(&heading.unwrap_or_default());
                text.push_str(&self.line(&units, false));
            }
        }
        for (row, values) in rows.iter().enumerate() {
            let mut cells = vec![self.stamp(row)];
            cells.extend(values.iter().map(|value| format!("{value:?}")));
            // A date has no decimal comma of its own here.
            text.push_str(&self.line(&cells, self.clock != 2 || !self.is_decimal_comma));
        }
        text
    }

    fn bytes(&self, rows: &[Vec<f64>]) -> Vec<u8> {
        let text = self.text(rows);
        match self.encoding {
            0 => text.into_bytes(),
            1 => format!("\u{feff}{text}")
                .encode_utf16()
                .flat_map(u16::to_le_bytes)
                .collect(),
            _ => format!("\u{feff}{text}")
                .encode_utf16()
                .flat_map(u16::to_be_bytes)
                .collect(),
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 300, failure_persistence: None, ..ProptestConfig::default()
    })]

    #[test]
    fn a_log_in_any_layout_is_read_back_to_the_bit(
        writing in writing(),
        rows in prop::collection::vec(prop::collection::vec(-1e4_f64..1e4, 3), 3..30),
    ) {
        let writing = Writing { is_decimal_comma: writing.is_decimal_comma && writing.clock != 2, ..writing };
        let rows: Vec<Vec<f64>> = rows.iter().map(|row| row[..writing.columns].to_vec()).collect();
        let bytes = writing.bytes(&rows);
        let folder = scratch();
        let path = folder.path().join("log.txt");
        std::fs::write(&path, &bytes).expect("writable");
        let has_units = writing.text(&rows).contains("mdeg/s");
        let format = LogFormat {
            // A counter and a column without a heading tell no rate.
            rate_hz: (writing.clock == 3 || !writing.has_heading).then_some(50.0),
            unit: (!has_units).then(|| "mdeg/s".parse().expect("a unit")),
            time_unit: (!has_units && writing.clock == 1).then(|| vec!["ns".parse().expect("ns")]),
            time: (!writing.has_heading).then(|| vec!["none".to_owned()]),
            column: Some((0..writing.columns).map(|column| (column + 2).to_string()).collect()),
            missing: Some(MissingWords::Refuse),
            ..LogFormat::default()
        };
        let format = LogFormat { time_unit: format.time_unit.filter(|_| format.time.is_none()), ..format };
        let logs = read_logs(&path, &format)
            .unwrap_or_else(|error| panic!("{error}\n{}", writing.text(&rows)));
        for (column, log) in logs.iter().enumerate() {
            prop_assert!((log.sample_rate_hz / 50.0 - 1.0).abs() < 1e-9, "{}", log.sample_rate_hz);
            let unit: fogbench::recording::RateUnit = "mdeg/s".parse().expect("a unit");
            for (row, rate) in rows.iter().zip(&log.rate_deg_per_h) {
                prop_assert_eq!(unit.to_deg_per_h(row[column], 50.0).to_bits(), rate.to_bits());
            }
        }
        // What was found, given, reads the same.
        let again = read_logs(&path, &logs[0].format).expect("the layout that was found");
        prop_assert_eq!(&again[0].rate_deg_per_h, &logs[0].rate_deg_per_h);
    }

    #[test]
    fn values_that_are_wrapped_are_read_row_by_row(
        values in prop::collection::vec(-1e4_f64..1e4, 12), per_line in 1..7_usize, columns in 1..4_usize,
    ) {
        let text: String = values
            .chunks(per_line)
            .map(|line| line.iter().map(|value| format!("{value:?} ")).collect::<String>() + "\n")
            .collect();
        let format = LogFormat {
            wrapped_columns: Some(u32::try_from(columns).expect("few")),
            column: Some(vec![columns.to_string()]),
            ..at(10.0, "deg/h")
        };
        let log = read(&text, &format).expect("records");
        let want: Vec<f64> = values.chunks(columns).map(|record| record[columns - 1]).collect();
        prop_assert_eq!(log.rate_deg_per_h, want);
    }
}

#[test]
fn stretches_of_a_table_are_pooled() {
    let folder = scratch();
    let seconds = |k: usize| format!("{:.2}", k as f64 / 100.0);
    write(
        folder.path(),
        "log.csv",
        &table("time_s,g_dps\n", ",", 4000, seconds),
    );
    write(folder.path(), "parts.csv", "from_s,to_s\n1,9.999\n20,30\n");
    let (json, _) = analysed(folder.path(), &["log.csv", "--segments", "parts.csv"]);
    assert_eq!(json["log"]["samples"], 900 + 1001);
    assert_close(walk(&json), 1.2, 0.2, 0.0);
    write(folder.path(), "parts.csv", "from_s,to_s\n20,30\n1,9.999\n");
    let message = refused(folder.path(), &["log.csv", "--segments", "parts.csv"]);
    assert!(message.contains("overlap or are not in order"), "{message}");
    let named = read_log(&folder.path().join("log.csv"), &named("g_dps")).expect("a log");
    assert_eq!(named.stretches.len(), 1);
}

#[test]
fn a_reference_in_the_log_gives_delay_and_scale_of_a_swing() {
    let folder = scratch();
    let mut text = "time_s,table_deg_per_s,encoder_deg,gyro_deg_per_s\n".to_owned();
    let turn = std::f64::consts::TAU * 2.0;
    for (k, noise) in white(6, 3000, 0.01).iter().enumerate() {
        let t = k as f64 / 100.0;
        // The mean rate over the word that ends at t, as the difference of the encoder's angle is.
        let angle = |t: f64| -10.0 / turn * (turn * t).cos();
        let mean = |t: f64| (angle(t) - angle(t - 0.01)) * 100.0;
        let gyro = 0.9993 * mean(t - 0.004) - 0.5 + noise;
        writeln!(text, "{t:.2},{:.7},{:.9},{gyro:.7}", mean(t), angle(t)).expect("a string");
    }
    write(folder.path(), "log.csv", &text);
    let arguments = [
        "log.csv",
        "--column",
        "gyro_deg_per_s",
        "--motion",
        "swing:2",
    ];
    let message = refused(
        folder.path(),
        &[&arguments[..], &["--reference-column", "gyro_deg_per_s"]].concat(),
    );
    assert!(message.contains("named for two quantities"), "{message}");
    for reference in ["table", "encoder_deg"] {
        let more = ["--reference-column", reference];
        let (json, _) = analysed(folder.path(), &[&arguments[..], &more].concat());
        let metric = |name: &str| json["channels"]["raw"][name]["value"].as_f64().expect(name);
        assert_close(metric("amplitude_ratio"), 0.9993, 3e-4, 0.0);
        assert_close(metric("delay_vs_truth_ms"), 4.0, 0.0, 0.05);
    }
}

#[test]
fn a_heading_that_holds_a_comma_is_named_in_quotes() {
    let folder = scratch();
    let seconds = |k: usize| format!("{:.2}", k as f64 / 100.0);
    let heading = "time_s,\"rate, z [deg/s]\"\n";
    write(
        folder.path(),
        "log.csv",
        &table(heading, ",", 4000, seconds),
    );
    let column = ["--column", "\"rate, z [deg/s]\""];
    let (json, _) = analysed(folder.path(), &[&["log.csv"][..], &column].concat());
    assert_eq!(json["log"]["column"], "rate, z [deg/s]");
    let several = ["--column", "rate, z [deg/s]"];
    let message = refused(folder.path(), &[&["log.csv"][..], &several].concat());
    assert!(message.contains("column"), "{message}");
}

#[test]
fn gates_are_held_against_a_log() {
    let folder = scratch();
    let seconds = |k: usize| format!("{:.2}", k as f64 / 100.0);
    write(
        folder.path(),
        "log.csv",
        &table("time_s,g_dps\n", ",", 4000, seconds),
    );
    let gate = |metric: &str, limit: &str| {
        format!("schema = 1\n[[gate]]\nmetric = \"{metric}\"\n{limit}\n")
    };
    let walk = "raw.angle_random_walk_deg_per_sqrt_h";
    let mut transcript = Transcript::of(LAYOUTS, "Gates on a log");
    for (text, want) in [
        (gate(walk, "max = 2.0"), 0),
        (gate(walk, "max = 1.0"), 1),
        (gate("raw.bias_instability_deg_per_h", "max = 1e9"), 1),
        (gate("raw.angle_random_wlak_deg_per_sqrt_h", "max = 2.0"), 2),
        ("schema = 1\n".to_owned(), 2),
    ] {
        write(folder.path(), "gates.toml", &text);
        let output = fogbench(
            folder.path(),
            &["analyze", "log.csv", "--gates", "gates.toml", "-o", "out"],
        );
        assert_eq!(
            code(&output),
            want,
            "{text}{}{}",
            stdout(&output),
            stderr(&output)
        );
        let json =
            std::fs::read_to_string(folder.path().join("out/summary.json")).unwrap_or_default();
        let said = stdout(&output);
        let said = said.lines().skip_while(|line| {
            !["  PASS", "  FAIL"]
                .iter()
                .any(|word| line.starts_with(word))
        });
        let said: Vec<&str> = said.take(2).collect();
        let errors: Vec<String> = stderr(&output)
            .lines()
            .filter(|line| line.starts_with("error"))
            .map(str::to_owned)
            .collect();
        transcript.case(
            &text,
            format!("exit code {want}\n{}{}", said.join("\n"), errors.join("\n")),
        );
        assert!(want == 2 || json.contains("\"gates\""), "{json}");
    }
    transcript.check();
}

#[test]
fn a_thousand_lines_that_are_passed_over_hide_no_row() {
    let text = "free text, with 1, 2\n".repeat(1500);
    let text = format!("{text}rate [deg/h]\n1\n2\n4\n");
    let heading = LogFormat {
        heading_line: Some(1501),
        ..at(100.0, "deg/h")
    };
    let skip = LogFormat {
        skip_lines: Some(1500),
        ..at(100.0, "deg/h")
    };
    for format in [heading, skip] {
        let log = read(&text, &format).expect("readable");
        assert_eq!(log.rate_deg_per_h, [1.0, 2.0, 4.0]);
    }
}

#[test]
fn a_rate_is_held_against_stamps_as_far_as_their_jitter_lets_them_tell_it() {
    // 40 stamps at 100 Hz, the last 1 ms late: a mean rate of 99.7 Hz.
    let stamps = |late: f64, count: usize| {
        let rows = (0..count).map(|k| {
            let late = if k + 1 == count { late } else { 0.0 };
            format!("{:.4},{}\n", k as f64 / 100.0 + late, k % 7)
        });
        format!("time_s,rate\n{}", rows.collect::<String>())
    };
    assert!(read(stamps(0.001, 40), &at(100.0, "deg/h")).is_ok());
    let other = read(stamps(0.001, 40), &at(101.0, "deg/h")).unwrap_err();
    assert!(
        other.contains("--rate-hz 101 contradicts the time column"),
        "{other}"
    );
}
