//! Recorded logs: what is read, in which unit, and what is refused where.

use std::path::{Path, PathBuf};

use fogbench::recording::{Log, LogError, LogFormat, RateUnit, TimeUnit, csv_text, read_log};
use fogbench::store::write_npy;

use crate::support::transcript::Transcript;
use crate::support::{assert_close, scratch, write};

/// The transcript of complaints about logs.
const LOGS: &str = "logs";

/// deg/h at 400 Hz, the only column.
fn format() -> LogFormat {
    LogFormat {
        rate_hz: Some(400.0),
        unit: Some(RateUnit::DEG_PER_H.into()),
        ..LogFormat::default()
    }
}

fn read_text(text: &str, format: &LogFormat) -> Result<Log, LogError> {
    let folder = scratch();
    read_log(&write(folder.path(), "log.csv", text), format)
}

#[track_caller]
fn words(text: &str, format: &LogFormat) -> Vec<f64> {
    read_text(text, format)
        .unwrap_or_else(|error| panic!("{text:?}: {error}"))
        .rate_deg_per_h
}

/// The complaint about a text, behind the name of its file.
#[track_caller]
fn complaint(text: &str, format: &LogFormat) -> String {
    let error = read_text(text, format).expect_err("it must be refused");
    error.to_string()
}

/// An NPY file, version 1.0, of any number type and shape.
fn npy(folder: &Path, descr: &str, shape: &str, data: &[u8]) -> PathBuf {
    let mut header = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}");
    while (10 + header.len() + 1) % 64 != 0 {
        header.push(' ');
    }
    header.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend(u16::try_from(header.len()).expect("short").to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(data);
    let path = folder.join("log.npy");
    std::fs::write(&path, bytes).expect("writable");
    path
}

#[test]
fn every_number_type_and_byte_order_of_npy_is_read() {
    let folder = scratch();
    let values = [1.5_f64, -2.25, 1000.0];
    let singles = [1.5_f32, -2.25, 1000.0];
    let wholes = [1_i32, -2, 70_000];
    let bytes = |of: &dyn Fn(usize) -> Vec<u8>| (0..3).flat_map(of).collect::<Vec<u8>>();
    let cases: [(&str, Vec<u8>, [f64; 3]); 8] = [
        ("<f8", bytes(&|k| values[k].to_le_bytes().to_vec()), values),
        (">f8", bytes(&|k| values[k].to_be_bytes().to_vec()), values),
        ("<f4", bytes(&|k| singles[k].to_le_bytes().to_vec()), values),
        (">f4", bytes(&|k| singles[k].to_be_bytes().to_vec()), values),
        (
            "<i4",
            bytes(&|k| wholes[k].to_le_bytes().to_vec()),
            wholes.map(f64::from),
        ),
        (
            ">i4",
            bytes(&|k| wholes[k].to_be_bytes().to_vec()),
            wholes.map(f64::from),
        ),
        (
            "<i8",
            bytes(&|k| i64::from(wholes[k]).to_le_bytes().to_vec()),
            wholes.map(f64::from),
        ),
        (
            ">i8",
            bytes(&|k| i64::from(wholes[k]).to_be_bytes().to_vec()),
            wholes.map(f64::from),
        ),
    ];
    for (descr, data, want) in cases {
        let log = read_log(&npy(folder.path(), descr, "(3,)", &data), &format());
        let log = log.unwrap_or_else(|error| panic!("{descr}: {error}"));
        assert_eq!(log.rate_deg_per_h, want, "{descr}");
        assert_eq!((log.file.as_str(), log.sample_rate_hz), ("log.npy", 400.0));
    }
}

#[test]
fn npy_files_that_hold_something_else_are_refused() {
    let folder = scratch();
    let mut transcript = Transcript::of(LOGS, "NPY files that hold something else");
    let beyond = (1_i64 << 53) + 1;
    let beyond = [7_i64.to_le_bytes(), beyond.to_le_bytes()].concat();
    let no_number = [1.0_f64.to_le_bytes(), f64::NAN.to_le_bytes()].concat();
    for (descr, shape, data) in [
        ("<f8", "(1, 2, 1)", &[0; 16][..]),
        ("<f16", "(2,)", &[0; 32]),
        ("<c16", "(1,)", &[0; 16]),
        ("<f8", "(3,)", &[0; 16]),
        ("<f8", "(900000000000000,)", &[0; 16]),
        ("<f8", "(0,)", &[]),
        ("<i8", "(2,)", &beyond),
        ("<f8", "(2,)", &no_number),
    ] {
        let error = read_log(&npy(folder.path(), descr, shape, data), &format());
        let message = error.expect_err("it must be refused").to_string();
        transcript.case(format!("{descr} {shape}, {} bytes", data.len()), message);
    }
    let path = npy(folder.path(), "<f8", "(1,)", &1.0_f64.to_le_bytes());
    let named = LogFormat {
        column: Some(vec!["rate".to_owned()]),
        ..format()
    };
    let message = read_log(&path, &named).expect_err("no columns");
    transcript.case("column rate of an array", message);
    transcript.check();
}

#[test]
fn text_is_read_with_any_delimiter_heading_or_none() {
    // The first column is no time at this rate.
    let by = |column: &str| LogFormat {
        column: Some(vec![column.to_owned()]),
        time: Some(vec!["none".to_owned()]),
        ..format()
    };
    for text in [
        "1\n-2.5\n3e2\n",
        "\u{feff}rate\r\n1\r\n-2.5\r\n3e2\r\n",
        "# gyro 7\n\n\"rate\"\n1\n# pause\n-2.5\n\n  3e2",
    ] {
        assert_eq!(words(text, &format()), [1.0, -2.5, 300.0], "{text:?}");
    }
    for text in [
        "t,rate,temp\n0,1,20\n1,-2.5,21\n",
        "t;rate;temp\n0;1;20\n1;-2.5;21\n",
        "t\trate\ttemp\n0\t1\t20\n1\t-2.5\t21\n",
        "t  rate temp\n0 1   20\n1 -2.5 21\n",
        "\"t\", \"rate\", \"temp\"\n0, 1, 20\n1, -2.5, 21\n",
    ] {
        assert_eq!(words(text, &by("rate")), [1.0, -2.5], "{text:?}");
        assert_eq!(words(text, &by("2")), [1.0, -2.5], "{text:?}");
    }
    let log = read_text("0,1\n1,-2.5\n", &by("2")).expect("two columns");
    assert_eq!(log.column.as_deref(), Some("2"));
    assert_eq!(log.rate_deg_per_h, [1.0, -2.5]);
}

#[test]
fn complaints_about_text_name_line_column_and_way_out() {
    let by = |column: &str| LogFormat {
        column: Some(vec![column.to_owned()]),
        ..format()
    };
    let table = "a,rate\n0,1\n1,2\n";
    let mut transcript = Transcript::of(LOGS, "Tables that cannot be read");
    for (text, column) in [
        ("t,rate\n0,1\n1,x\n", Some("rate")),
        ("t,rate\n0,1\n1,\n", Some("rate")),
        ("t;rate\n0;1.5\n1;1,5\n", Some("rate")),
        ("1\n# two\ninf\n", None),
        ("a,rate\n0,1\n1,2,3\n", Some("rate")),
        (table, None),
        (table, Some("speed")),
        (table, Some("3")),
        ("0,1\n", Some("rate")),
        ("a,a\n0,1\n", Some("a")),
        ("# nothing\n", None),
        ("rate\n", None),
    ] {
        let (format, of) = match column {
            Some(column) => (by(column), format!(" column {column}")),
            None => (format(), String::new()),
        };
        transcript.case(format!("log.csv{of}:\n{text}"), complaint(text, &format));
    }
    let silent = LogFormat {
        rate_hz: None,
        ..format()
    };
    transcript.case(
        "log.csv without a rate:\n1\n2\n",
        complaint("1\n2\n", &silent),
    );

    let folder = scratch();
    let path = folder.path().join("log.csv");
    std::fs::write(&path, b"1\n2\n\xff\xfe\n").expect("writable");
    let message = read_log(&path, &format()).expect_err("no text");
    transcript.case("log.csv:\n1\n2\n\\xff\\xfe\n", message);
    let beyond = complaint(
        "1\n1e308\n",
        &LogFormat {
            unit: Some(RateUnit::RAD_PER_S.into()),
            ..format()
        },
    );
    transcript.case("log.csv in rad/s:\n1\n1e308\n", beyond);
    transcript.check();
    let missing = read_log(&folder.path().join("none.csv"), &format());
    assert!(matches!(missing, Err(LogError::Read { .. })));
}

#[test]
fn units_and_counts_become_deg_per_h() {
    let in_unit = |unit: RateUnit, scale: f64| LogFormat {
        unit: Some(unit.into()),
        scale: Some(scale),
        ..format()
    };
    let earth = 15.041_067;
    let log = words(
        &format!("{}\n", earth / 3600.0),
        &in_unit(RateUnit::DEG_PER_S, 1.0),
    );
    assert_close(log[0], earth, 1e-14, 0.0);
    // 32.8 counts a deg/s, the axis upside down.
    let log = words("41\n", &in_unit(RateUnit::DEG_PER_S, -1.0 / 32.8));
    assert_close(log[0], -4500.0, 1e-14, 0.0);
    // 0.01 arcsec turned in each of 400 samples a second are 4 arcsec/s or 4 deg/h.
    let log = words(
        "0.01\n",
        &in_unit("arcsec/sample".parse().expect("a unit"), 1.0),
    );
    assert_close(log[0], 4.0, 1e-14, 0.0);
    // Words in deg/h are not touched.
    let odd = 1.0_f64 / 3.0;
    assert_eq!(
        words(&format!("{odd:?}\n"), &format())[0].to_bits(),
        odd.to_bits()
    );
}

/// A time column at `rate_hz` with stamps moved by `jitter_s` in turn.
fn timed(rate_hz: f64, count: usize, jitter_s: f64) -> String {
    let mut text = "time,rate\n".to_owned();
    for k in 0..count {
        let moved = [0.0, jitter_s, -jitter_s][k % 3];
        text.push_str(&format!("{:?},{k}\n", 1e6 + k as f64 / rate_hz + moved));
    }
    text
}

fn by_time() -> LogFormat {
    LogFormat {
        rate_hz: None,
        time: Some(vec!["time".to_owned()]),
        ..format()
    }
}

#[test]
fn a_time_column_gives_the_rate_and_its_jitter() {
    // 300 samples: the last one is moved back, so the mean step is 299/250 s less 0.1 ms over 299.
    let log = read_text(&timed(250.0, 300, 1e-4), &by_time()).expect("equal spacing");
    let want = 299.0 / (299.0 / 250.0 - 1e-4);
    // Stamps near 1e6 s are rounded to 2^-33 s, 1.2e-10 s.
    assert_close(log.sample_rate_hz, want, 1e-9, 0.0);
    let timing = log.timing.expect("a time column");
    assert!(
        (1.0e-4..=2.1e-4).contains(&timing.jitter_max_s),
        "{timing:?}"
    );
    assert_close(log.rate_deg_per_h[7], 7.0, 0.0, 0.0);
    let mut transcript = Transcript::of(LOGS, "Notes on a time column without a gap");
    transcript.case("stamps with jitter", log.notes().join("\n"));
    transcript.check();

    let milliseconds = LogFormat {
        time_unit: Some(vec![TimeUnit::Milliseconds]),
        ..by_time()
    };
    let log = read_text("time,rate\n0,1\n4,2\n8,3\n", &milliseconds).expect("250 Hz");
    assert_close(log.sample_rate_hz, 250.0, 1e-12, 0.0);
    // A rate that is given is used as it is.
    let both = LogFormat {
        rate_hz: Some(250.1),
        ..milliseconds
    };
    let log = read_text("time,rate\n0,1\n4,2\n8,3\n", &both).expect("within 0.1 %");
    assert_close(log.sample_rate_hz, 250.1, 0.0, 0.0);
}

#[test]
fn gaps_repeats_and_contradictions_of_a_time_column_are_refused_with_place_and_size() {
    let mut transcript = Transcript::of(LOGS, "Gaps, repeats and contradictions of a time column");
    for text in [
        "time,rate\n0,1\n0.1,2\n0.2,3\n0.5,4\n0.6,5\n",
        "time,rate\n0,1\n0.1,2\n0.1,3\n0.2,4\n0.3,5\n",
        "time,rate\n0,1\n0.1,2\n0.13,3\n0.2,4\n0.3,5\n0.4,6\n",
        "time,rate\n0,1\n",
    ] {
        transcript.case(text, complaint(text, &by_time()));
    }
    let text = "time,rate\n0,1\n0.1,2\n0.2,3\n";
    let given = LogFormat {
        rate_hz: Some(9.9),
        ..by_time()
    };
    transcript.case(format!("--rate-hz 9.9\n{text}"), complaint(text, &given));
    let itself = LogFormat {
        column: Some(vec!["1".to_owned()]),
        ..by_time()
    };
    transcript.case(format!("--column 1\n{text}"), complaint(text, &itself));
    transcript.check();
}

#[test]
fn written_csv_and_npy_are_read_back_to_the_bit() {
    let folder = scratch();
    let rates: Vec<f64> = (0..500)
        .map(|k| (f64::from(k) * 0.37).sin() / 3.0)
        .collect();
    let csv = write(folder.path(), "log.csv", &csv_text(&rates, 1.0 / 400.0));
    let timed = LogFormat {
        rate_hz: None,
        time: Some(vec!["time_s".to_owned()]),
        ..format()
    };
    let log = read_log(&csv, &timed).expect("own CSV");
    assert_eq!(log.rate_deg_per_h, rates);
    assert_close(log.sample_rate_hz, 400.0, 1e-12, 0.0);
    let npy = folder.path().join("log.npy");
    write_npy(&npy, &rates).expect("writable");
    let log = read_log(&npy, &format()).expect("own NPY");
    assert_eq!(log.rate_deg_per_h, rates);
}
