//! Archives of arrays, and arrays of records: each column under its name.

use std::io::{Cursor, Write as _};
use std::path::Path;

use fogbench::recording::{Log, LogFormat, read_log, read_logs};
use proptest::prelude::*;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use crate::support::transcript::Transcript;
use crate::support::{code, fogbench, stderr, stdout};

/// An NPY file of so many words of a type, whose bytes are given.
fn npy(descr: &str, shape: &str, is_fortran: bool, words: &[u8]) -> Vec<u8> {
    let order = if is_fortran { "True" } else { "False" };
    let heading = format!("{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    let length = u16::try_from(heading.len()).expect("a short heading");
    bytes.extend(length.to_le_bytes());
    bytes.extend(heading.bytes());
    bytes.extend(words);
    bytes
}

fn doubles(words: &[f64]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// A row of binary64.
fn row(words: &[f64]) -> Vec<u8> {
    npy(
        "'<f8'",
        &format!("({},)", words.len()),
        false,
        &doubles(words),
    )
}

/// An archive as `numpy.savez` writes it, or `numpy.savez_compressed`.
fn npz(arrays: &[(&str, Vec<u8>)], is_compressed: bool) -> Vec<u8> {
    let method = match is_compressed {
        true => CompressionMethod::Deflated,
        false => CompressionMethod::Stored,
    };
    let options = SimpleFileOptions::default().compression_method(method);
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in arrays {
        archive
            .start_file(format!("{name}.npy"), options)
            .expect("a name");
        archive.write_all(bytes).expect("memory");
    }
    archive.finish().expect("memory").into_inner()
}

fn format(column: Option<&str>, rate_hz: Option<f64>) -> LogFormat {
    LogFormat {
        rate_hz,
        unit: Some("deg/h".parse().expect("a unit")),
        column: column.map(|name| vec![name.to_owned()]),
        ..LogFormat::default()
    }
}

fn written(bytes: &[u8], then: impl FnOnce(&Path)) {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let path = folder.path().join("log.npz");
    std::fs::write(&path, bytes).expect("writable");
    then(&path);
}

#[track_caller]
fn log(bytes: &[u8], format: &LogFormat) -> Log {
    let mut found = None;
    written(bytes, |path| found = Some(read_log(path, format)));
    let found = found.expect("it was read");
    found.unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn fields_of_records_are_columns_under_their_names() {
    // As an aligned type has it: stamps of 19 digits, three rates, a count with the high byte first, padding.
    let descr = "[('t_ns', '<i8'), ('gyro', '<f4', (3,)), ('n', '>i2'), ('', '|V2'), ('tag', '|S3'), \
                 ('at', '<M8[us]')]";
    let first = 1_700_000_000_123_456_789_i64;
    let mut words = Vec::new();
    for k in 0..40_u8 {
        words.extend((first + 10_000_000 * i64::from(k)).to_le_bytes());
        for axis in 0..3_u8 {
            words.extend((f32::from(k) + 100.0 * f32::from(axis)).to_le_bytes());
        }
        words.extend((-i16::from(k)).to_be_bytes());
        words.extend(b"\xff\xff");
        words.extend(b"abc");
        words.extend((1_700_000_000_000_000 + 10_000 * i64::from(k)).to_le_bytes());
    }
    let bytes = npy(descr, "(40,)", false, &words);
    let wanted: Vec<f64> = (0..40).map(|k| 100.0 + f64::from(k)).collect();
    let time = |name: &str| LogFormat {
        time: Some(vec![name.to_owned()]),
        ..format(Some("gyro[1]"), None)
    };
    for name in ["t_ns", "at"] {
        let read = log(&bytes, &time(name));
        assert_eq!(read.rate_deg_per_h, wanted);
        assert!((read.sample_rate_hz - 100.0).abs() < 1e-9, "{name}");
        assert_eq!(read.column.as_deref(), Some("gyro[1]"));
    }
    let counts = LogFormat {
        column: Some(vec!["n".to_owned()]),
        ..time("t_ns")
    };
    assert_eq!(log(&bytes, &counts).rate_deg_per_h[..3], [0.0, -1.0, -2.0]);
    let all = LogFormat {
        column: Some(vec!["gyro*".to_owned()]),
        ..time("t_ns")
    };
    written(&bytes, |path| {
        let logs = read_logs(path, &all).expect("three columns");
        assert_eq!(logs.len(), 3);
        assert_eq!(logs[2].rate_deg_per_h[0].to_bits(), 200.0_f64.to_bits());
    });
}

#[test]
fn arrays_of_an_archive_are_columns_under_their_names() {
    let words: Vec<f64> = (0..50).map(|k| f64::from(k * k % 17)).collect();
    let stamps: Vec<f64> = (0..50).map(|k| f64::from(k) / 50.0).collect();
    let axes: Vec<f64> = words.iter().flat_map(|word| [-word, *word, 0.5]).collect();
    let text = npy("'<U2'", "(1,)", false, &[b'a', 0, 0, 0, b'b', 0, 0, 0]);
    let archive = |is_compressed| {
        let gyro = npy("'<f8'", "(50, 3)", false, &doubles(&axes));
        let arrays = [
            ("time_s", row(&stamps)),
            ("gyro", gyro),
            ("name", text.clone()),
        ];
        npz(&arrays, is_compressed)
    };
    for is_compressed in [false, true] {
        let read = log(&archive(is_compressed), &format(Some("gyro[1]"), None));
        assert_eq!(read.rate_deg_per_h, words);
        assert!((read.sample_rate_hz - 50.0).abs() < 1e-9);
        // One array is read as its file would be, by its name or without.
        for column in [None, Some("rate")] {
            let one = npz(&[("rate", row(&words))], is_compressed);
            let read = log(&one, &format(column, Some(50.0)));
            assert_eq!(read.rate_deg_per_h, words);
        }
    }
}

#[test]
fn what_is_no_archive_of_columns_is_refused() {
    let words: Vec<f64> = (0..50).map(f64::from).collect();
    let two = [("rate", row(&words)), ("other", row(&words[1..]))];
    let mut broken = npz(&[("rate", row(&words))], false);
    let place = broken
        .windows(8)
        .position(|eight| eight == 40.0_f64.to_le_bytes());
    broken[place.expect("a word")] ^= 1;
    let cut = &npz(&two, true)[..200];
    let name = npz(&[("name", npy("'<U1'", "(1,)", false, b"a\0\0\0"))], false);
    let record = |descr: &str| npy(descr, "(2,)", false, &[0; 48]);
    let folder = tempfile::tempdir().expect("a scratch folder");
    let mut transcript = Transcript::of("npz", "Archives and records that are refused");
    for (given, bytes, more) in [
        ("two arrays", npz(&two, true), &[][..]),
        ("an unknown array", npz(&two, true), &["--column", "gyro"]),
        (
            "arrays of two lengths",
            npz(&two, true),
            &["--column", "rate,other"],
        ),
        ("another check sum", broken, &[]),
        ("half an archive", cut.to_vec(), &[]),
        ("letters alone", name, &[]),
        (
            "letters in records",
            record("[('a', '<f8'), ('b', '|S16')]"),
            &["--column", "b"],
        ),
        ("nested records", record("[('a', [('b', '<f8')])]"), &[]),
        ("objects", record("[('a', '|O')]"), &[]),
        (
            "too few bytes",
            record("[('a', '<f8'), ('b', '<f8', (3,))]"),
            &["--column", "a"],
        ),
    ] {
        std::fs::write(folder.path().join("log.npz"), bytes).expect("writable");
        let command = ["analyze", "log.npz", "--unit", "deg/h", "--rate-hz", "50"];
        let output = fogbench(folder.path(), &[&command[..], more].concat());
        assert_eq!(code(&output), 2, "{given}: {}", stdout(&output));
        transcript.case(given, stderr(&output));
    }
    transcript.check();
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 100, failure_persistence: None, ..ProptestConfig::default()
    })]

    #[test]
    fn columns_in_any_array_are_read_back_to_the_bit(
        rows in prop::collection::vec(prop::collection::vec(-1e4_f64..1e4, 3), 4..30),
        shape in 0..5, is_compressed: bool, column in 0..3_usize,
    ) {
        let count = rows.len();
        let by_row: Vec<f64> = rows.concat();
        let of = |column: usize| rows.iter().map(|row| row[column]).collect::<Vec<f64>>();
        let by_column: Vec<f64> = (0..3).flat_map(of).collect();
        let square = format!("({count}, 3)");
        let (bytes, name) = match shape {
            0 => (npy("'<f8'", &square, false, &doubles(&by_row)), (column + 1).to_string()),
            1 => (npy("'<f8'", &square, true, &doubles(&by_column)), (column + 1).to_string()),
            2 => {
                let descr = "[('x', '<f8'), ('y', '<f8'), ('z', '<f8')]";
                let name = ["x", "y", "z"][column];
                (npy(descr, &format!("({count},)"), false, &doubles(&by_row)), name.to_owned())
            }
            3 => {
                let arrays = [("x", row(&of(0))), ("y", row(&of(1))), ("z", row(&of(2)))];
                (npz(&arrays, is_compressed), ["x", "y", "z"][column].to_owned())
            }
            _ => {
                let other = npy("'<f8'", &square, true, &doubles(&by_column));
                (npz(&[("n", row(&of(0))), ("w", other)], is_compressed), format!("w[{column}]"))
            }
        };
        let read = log(&bytes, &format(Some(&name), Some(50.0)));
        let bits = |words: &[f64]| words.iter().map(|word| word.to_bits()).collect::<Vec<u64>>();
        prop_assert_eq!(bits(&read.rate_deg_per_h), bits(&of(column)));
    }
}
