//! One reader of numbers: logs, stimuli, columns of an assembly, groups and scripts are spelled alike.

use std::path::{Path, PathBuf};

use fogbench::recording::{
    AssemblyColumns, HeadingUnits, LogFormat, RATE_MAX_DEG_PER_H, RateUnit, read_assembly_log,
    read_groups, read_log, read_stimulus,
};
use fogbench::scenario::{MotionConfig, load_suite};
use proptest::prelude::*;

use crate::support::transcript::{Transcript, said_to_each};
use crate::support::{code, fogbench, npy, piped, scratch, stderr, stdout, write};

/// The transcript of what the readers refuse.
const READERS: &str = "readers";

/// deg/h at 100 Hz.
fn format(column: Option<&str>) -> LogFormat {
    LogFormat {
        rate_hz: Some(100.0),
        unit: Some(RateUnit::DEG_PER_H.into()),
        column: column.map(|name| vec![name.to_owned()]),
        ..LogFormat::default()
    }
}

/// How a table is written down.
#[derive(Clone, Debug)]
struct Spelling {
    separator: &'static str,
    line_end: &'static str,
    has_mark: bool,
    is_quoted: bool,
    /// Whether a separator ends every line.
    is_trailing: bool,
    has_comments: bool,
    ends_last_line: bool,
}

const PLAIN: Spelling = Spelling {
    separator: ",",
    line_end: "\n",
    has_mark: false,
    is_quoted: false,
    is_trailing: false,
    has_comments: false,
    ends_last_line: true,
};

impl Spelling {
    fn write(&self, lines: &[Vec<String>]) -> String {
        let mut text = String::new();
        if self.has_mark {
            text.push('\u{feff}');
        }
        for (index, cells) in lines.iter().enumerate() {
            if self.has_comments {
                text.push_str(&format!("  # line {index}{0}{0}", self.line_end));
            }
            let quoted = cells.iter().map(|cell| match self.is_quoted {
                true => format!("\"{cell}\""),
                false => cell.clone(),
            });
            text.push_str(&quoted.collect::<Vec<_>>().join(self.separator));
            if self.is_trailing {
                text.push_str(self.separator);
            }
            if self.ends_last_line || index + 1 < lines.len() {
                text.push_str(self.line_end);
            }
        }
        text
    }
}

fn spelling() -> impl Strategy<Value = Spelling> {
    let separators = prop::sample::select(vec![",", ";", "\t", "  ", " , ", "; "]);
    let line_ends = prop::sample::select(vec!["\n", "\r\n", "\r"]);
    let flags = prop::collection::vec(any::<bool>(), 5);
    (separators, line_ends, flags).prop_map(|(separator, line_end, flags)| Spelling {
        separator,
        line_end,
        has_mark: flags[0],
        is_quoted: flags[1],
        is_trailing: flags[2],
        has_comments: flags[3],
        ends_last_line: flags[4],
    })
}

fn cells(values: &[f64]) -> Vec<String> {
    values.iter().map(|value| format!("{value:?}")).collect()
}

/// Rows of four columns, the last one a temperature.
fn rows() -> impl Strategy<Value = Vec<Vec<f64>>> {
    let rate = || prop_oneof![-1e6..1e6, -1e-6..1e-6, Just(0.0)];
    let row = (rate(), rate(), rate(), -40.0..80.0).prop_map(|(x, y, z, c)| vec![x, y, z, c]);
    prop::collection::vec(row, 1..12)
}

fn column(rows: &[Vec<f64>], index: usize) -> Vec<f64> {
    rows.iter().map(|row| row[index]).collect()
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 200, failure_persistence: None, ..ProptestConfig::default()
    })]

    #[test]
    fn every_spelling_of_a_table_is_read_to_the_bit(
        spelling in spelling(), rows in rows(), has_heading in any::<bool>()
    ) {
        let folder = scratch();
        let mut lines: Vec<Vec<String>> = rows.iter().map(|row| cells(row)).collect();
        if has_heading {
            let names = ["gx", "g y", "_z", "warmth"];
            let is_blank = spelling.separator.trim().is_empty() && spelling.separator != "\t";
            let names = names.map(|name| match is_blank && !spelling.is_quoted {
                true => name.replace(' ', ""),
                false => name.to_owned(),
            });
            lines.insert(0, names.to_vec());
        }
        let path = write(folder.path(), "log.txt", &spelling.write(&lines));
        for (index, name) in ["1", "2", "3", "4"].into_iter().enumerate() {
            let log = read_log(&path, &format(Some(name))).expect("a table");
            prop_assert_eq!(&log.rate_deg_per_h, &column(&rows, index));
            let words = read_stimulus(&path, Some(name), usize::MAX).expect("a table");
            prop_assert_eq!(&words, &column(&rows, index));
            let some = read_stimulus(&path, Some(name), 3).expect("a table");
            prop_assert_eq!(&some[..], &words[..words.len().min(3)]);
        }
        let columns = AssemblyColumns { gyros: ["3", "1", "2"], temperature: Some("4") };
        let assembly = read_assembly_log(&path, &format(None), &columns).expect("a table");
        for (gyro, index) in assembly.gyros.iter().zip([2, 0, 1]) {
            prop_assert_eq!(&gyro.rate_deg_per_h, &column(&rows, index));
        }
        prop_assert_eq!(assembly.temperature_c, Some(column(&rows, 3)));
    }

    #[test]
    fn every_spelling_of_one_column_is_read_to_the_bit(
        spelling in spelling(), rows in rows(), has_heading in any::<bool>()
    ) {
        let folder = scratch();
        let values = column(&rows, 0);
        let mut lines: Vec<Vec<String>> = values.iter().map(|value| cells(&[*value])).collect();
        if has_heading {
            lines.insert(0, vec!["rate".to_owned()]);
        }
        let path = write(folder.path(), "log.txt", &spelling.write(&lines));
        let log = read_log(&path, &format(None)).expect("a column");
        prop_assert_eq!(&log.rate_deg_per_h, &values);
        prop_assert_eq!(&read_stimulus(&path, None, usize::MAX).expect("a column"), &values);
    }

    #[test]
    fn every_spelling_of_groups_and_scripts_is_the_plain_one(spelling in spelling()) {
        let folder = scratch();
        let words = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<String>>();
        let groups = [
            "mounting,rate_deg_per_s,temperature_c,output_x_deg_per_h,output_y_deg_per_h,\
             output_z_deg_per_h",
            "x,10,25,36037.8,-45.2,19.5",
            "-z,-10.5,26,1.5,2,3e4",
        ].map(words);
        let plain = read_groups(&write(folder.path(), "a.csv", &PLAIN.write(&groups)));
        let spelled = read_groups(&write(folder.path(), "b.csv", &spelling.write(&groups)));
        prop_assert_eq!(plain.expect("groups").groups.len(), 2);
        let spelled = spelled.expect("groups").groups;
        prop_assert_eq!(spelled[1].rate_deg_per_s.to_bits(), (-10.5_f64).to_bits());
        let outputs = spelled[0].output_deg_per_h.map(f64::to_bits);
        prop_assert_eq!(outputs, [36037.8, -45.2, 19.5].map(f64::to_bits));

        let script = ["time_s,rate_deg_per_s", "0,0", "0.5,-1.25e1", "2.0,0.5"].map(words);
        let text = "schema = 1\nname = \"x\"\nduration_s = 2.0\nwarm_up_s = 1.0\n\
                    [turntable.script]\nfile = \"m.csv\"\n";
        write(folder.path(), "m.csv", &spelling.write(&script));
        let runs = load_suite(&[write(folder.path(), "x.toml", text)], &[]).expect("a script");
        let MotionConfig::Script(script) = &runs[0].scenario.turntable.motion else {
            panic!("a script");
        };
        prop_assert_eq!(&script.points.time_s, &[0.0, 0.5, 2.0]);
        prop_assert_eq!(script.points.rate_deg_per_s.as_deref(), Some(&[0.0, -12.5, 0.5][..]));
    }

    #[test]
    fn every_type_of_npy_is_read_to_the_bit(
        values in prop::collection::vec(any::<i32>(), 1..20),
        singles in prop::collection::vec(-1e30_f32..1e30, 1..20),
        doubles in prop::collection::vec(-1e300_f64..1e300, 1..20),
        is_big in any::<bool>(), version in 1_u8..=3,
    ) {
        let folder = scratch();
        let read = |kind: &str, words: Vec<Vec<u8>>, want: Vec<f64>| {
            let order = if want.is_empty() || words[0].len() == 1 { "|" } else if is_big { ">" } else { "<" };
            let bytes = words.into_iter().flat_map(|mut word| {
                if is_big {
                    word.reverse();
                }
                word
            });
            let text = npy_bytes(version, &format!("{order}{kind}"), want.len(), &bytes.collect::<Vec<_>>());
            let path = folder.path().join("log.npy");
            std::fs::write(&path, text).expect("writable");
            // A log holds rates only; a stimulus any number.
            let is_rate = want.iter().all(|rate| rate.abs() <= RATE_MAX_DEG_PER_H);
            match read_log(&path, &format(None)) {
                Ok(log) => assert_eq!(log.rate_deg_per_h, want, "{kind}"),
                Err(error) => assert!(!is_rate, "{kind}: {error}"),
            }
            assert_eq!(read_stimulus(&path, None, usize::MAX).expect(kind), want, "{kind}");
            assert_eq!(read_stimulus(&path, None, 1).expect(kind), want[..1], "{kind}");
        };
        macro_rules! integers {
            ($($kind:ty => $name:literal),*) => { $({
                let cut: Vec<$kind> = values.iter().map(|value| <$kind>::try_from(*value).unwrap_or(<$kind>::MAX)).collect();
                let words = cut.iter().map(|word| word.to_le_bytes().to_vec()).collect();
                let sound = |word: &$kind| i128::from(*word).abs() <= 1 << 53;
                if cut.iter().all(sound) {
                    read($name, words, cut.iter().map(|word| *word as f64).collect());
                }
            })* };
        }
        integers!(i8 => "i1", i16 => "i2", i32 => "i4", i64 => "i8", u8 => "u1", u16 => "u2", u32 => "u4");
        let sums: Vec<u64> = values.iter().map(|value| u64::from(value.unsigned_abs()) << 21).collect();
        read("u8", sums.iter().map(|word| word.to_le_bytes().to_vec()).collect(),
             sums.iter().map(|word| *word as f64).collect());
        read("f4", singles.iter().map(|word| word.to_le_bytes().to_vec()).collect(),
             singles.iter().map(|word| f64::from(*word)).collect());
        read("f8", doubles.iter().map(|word: &f64| word.to_le_bytes().to_vec()).collect(), doubles.clone());
    }
}

/// An NPY file of one dimension, of versions 1 to 3.
fn npy_bytes(version: u8, descr: &str, count: usize, data: &[u8]) -> Vec<u8> {
    let dictionary =
        format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': ({count},), }}");
    npy_of(version, &dictionary, data)
}

fn npy_of(version: u8, dictionary: &str, data: &[u8]) -> Vec<u8> {
    let mut bytes = b"\x93NUMPY".to_vec();
    bytes.extend([version, 0]);
    let length = u32::try_from(dictionary.len() + 1).expect("short");
    match version {
        1 => bytes.extend(u16::try_from(length).expect("short").to_le_bytes()),
        _ => bytes.extend(length.to_le_bytes()),
    }
    bytes.extend(dictionary.as_bytes());
    bytes.push(b'\n');
    bytes.extend(data);
    bytes
}

/// The complaints of each reader, of logs, stimuli, assemblies, groups and scripts, about bytes.
fn complaints(bytes: &[u8]) -> Vec<String> {
    let folder = scratch();
    let path = folder.path().join("f.x");
    std::fs::write(&path, bytes).expect("writable");
    let columns = AssemblyColumns {
        gyros: ["1", "2", "3"],
        temperature: None,
    };
    let text = "schema = 1\nname = \"x\"\nduration_s = 2.0\n[turntable.script]\nfile = \"f.x\"\n";
    let scenario = write(folder.path(), "x.toml", text);
    let found = [
        read_log(&path, &format(None))
            .err()
            .map(|it| it.to_string()),
        read_stimulus(&path, None, 1000)
            .err()
            .map(|it| it.to_string()),
        read_assembly_log(&path, &format(None), &columns)
            .err()
            .map(|it| it.to_string()),
        read_groups(&path).err().map(|it| it.to_string()),
        load_suite(&[scenario], &[])
            .err()
            .map(|it| it[0].to_string()),
    ];
    let refused = found.into_iter().map(|message| {
        message.unwrap_or_else(|| panic!("{:?} is read", bytes.escape_ascii().to_string()))
    });
    refused.collect()
}

#[test]
fn what_is_no_text_is_refused_alike_by_every_reader() {
    let mut transcript = Transcript::of(READERS, "What is no text is refused by every reader");
    for (what, bytes) in [
        ("a\\x00,b\n1,2", b"a\x00,b\n1,2\n".to_vec()),
        ("a,b,\\xb5\n1,2,3", b"a,b,\xb5\n1,2,3\n".to_vec()),
        (
            "a comment of a megabyte",
            [b"# ".to_vec(), vec![b'x'; 1 << 20]].concat(),
        ),
    ] {
        transcript.case(what, complaints(&bytes).join("\n"));
    }
    transcript.check();
    // Nothing is repeated in full.
    for message in &complaints(&vec![b'1'; 1 << 20])[..4] {
        assert!(message.len() < 400, "{message}");
    }
}

#[test]
fn a_first_line_that_begins_like_a_number_is_never_passed_over() {
    let folder = scratch();
    let first_lines = [
        "1.0x",
        "-1.5.2",
        "+3 deg",
        "1e5.5",
        "0x1F",
        "(3.5)",
        "'3.5'",
        "\u{2212}3",
        "1,5;2",
        "\"1st\"",
        "3_000",
        "-",
        "*",
        "12:30:00",
        "\u{feff}\u{feff}1.0",
    ];
    let title = "First lines that begin like a number are never passed over";
    said_to_each(READERS, title, first_lines, |first| {
        let path = write(folder.path(), "log.csv", &format!("{first}\n1.0\n2.0\n"));
        let of_log = read_log(&path, &format(None)).expect_err(first);
        let of_stimulus = read_stimulus(&path, None, 9).expect_err(first);
        let (of_log, of_stimulus) = (of_log.to_string(), of_stimulus.to_string());
        match of_log == of_stimulus {
            true => of_log,
            false => format!("{of_log}\n{of_stimulus}"),
        }
    });
    for heading in [
        "x1.0",
        "rate (deg/h)",
        "deg/h",
        "°/s",
        "[1/s] x".trim_start_matches("[1/s] "),
        "ω",
        "_1",
    ] {
        let path = write(folder.path(), "log.csv", &format!("{heading}\n1.0\n2.0\n"));
        let format = LogFormat {
            heading_units: Some(HeadingUnits::Ignore),
            ..format(Some("1"))
        };
        let log = read_log(&path, &format).expect(heading);
        assert_eq!(log.rate_deg_per_h, [1.0, 2.0], "{heading}");
    }
}

/// A log of one column with these lines among its samples.
fn log_with(folder: &Path, lines: &[(usize, &str)]) -> Result<usize, String> {
    let mut text: Vec<String> = (0..40).map(|sample| format!("{}", sample % 7)).collect();
    for (at, line) in lines {
        text.insert(*at, (*line).to_owned());
    }
    let file = write(folder, "log.csv", &(text.join("\n") + "\n"));
    let log = read_log(&file, &format(None));
    log.map(|log| log.rate_deg_per_h.len())
        .map_err(|error| error.to_string())
}

#[test]
fn a_sample_that_is_missing_is_not_passed_over() {
    let folder = scratch();
    let with = |lines: &[(usize, &str)]| log_with(folder.path(), lines);
    // Before and behind the samples an empty line means nothing.
    assert_eq!(
        with(&[(0, ""), (1, "rate"), (2, ""), (43, ""), (44, "")]),
        Ok(40)
    );
    assert_eq!(with(&[(7, "# pause")]), Ok(40));
    for missing in ["#N/A", "N/A", "null", "NaN", "_"] {
        assert!(with(&[(7, missing)]).is_err(), "{missing}");
    }
    for first in ["N/A", "NA", "#N/A", "None", "~99"] {
        assert!(with(&[(0, first)]).is_err(), "{first}");
    }
    // Between them it may be a sample that is missing, which is said.
    assert_eq!(with(&[(7, ""), (9, "  "), (10, "")]), Ok(40));
    let said = read_log(&folder.path().join("log.csv"), &format(None))
        .expect("a log")
        .notes();
    assert!(
        said[0].contains("2 empty lines between the samples, from line 8 on"),
        "{said:?}"
    );
    // A time column shows that nothing is missing.
    let timed = LogFormat {
        rate_hz: None,
        time: Some(vec!["t".to_owned()]),
        ..format(None)
    };
    let file = write(folder.path(), "timed.csv", "t,g\n0,1\n1,2\n\n2,1\n3,2\n");
    let log = read_log(&file, &timed).expect("a log");
    assert_eq!(log.rate_deg_per_h, [1.0, 2.0, 1.0, 2.0]);
    assert!(!log.notes()[0].contains("empty"));
}

#[test]
fn a_heading_of_numbers_is_not_taken_for_a_sample() {
    // What pandas writes for a table whose columns have no names.
    let folder = scratch();
    let path = write(folder.path(), "log.csv", ",0\n0,1.5\n1,2.5\n");
    let message = read_log(&path, &format(Some("2"))).expect_err("a heading");
    let mut transcript = Transcript::of(READERS, "A heading of numbers is not taken for a sample");
    transcript.case(",0\n0,1.5\n1,2.5", message);
    transcript.check();
    // Words that stand in every row are no heading.
    let path = write(folder.path(), "log.csv", "ok,1.5\nbad,2.5\n");
    let log = read_log(&path, &format(Some("2"))).expect("a state beside the rate");
    assert_eq!(log.rate_deg_per_h, [1.5, 2.5]);
}

#[test]
fn columns_of_an_assembly_are_four_different_ones() {
    let folder = scratch();
    let path = write(
        folder.path(),
        "log.csv",
        "t,gx,gy,gz,c\n0,1,2,3,25\n0.01,1,2,3,251\n",
    );
    let read = |gyros: [&str; 3], temperature: Option<&str>, time: Option<&str>| {
        let columns = AssemblyColumns { gyros, temperature };
        let format = LogFormat {
            time: time.map(|name| vec![name.to_owned()]),
            ..format(None)
        };
        read_assembly_log(&path, &format, &columns).map_err(|error| error.to_string())
    };
    let xyz = ["gx", "gy", "gz"];
    assert!(read(xyz, None, Some("t")).is_ok());
    let mut transcript = Transcript::of(READERS, "Columns of an assembly are different ones");
    for (gyros, temperature, time) in [
        (["gx", "gx", "gz"], None, None),
        (["gx", "gy", "2"], None, None),
        (xyz, Some("gz"), None),
        (xyz, Some("t"), Some("t")),
        (["gx", "gy", "g"], None, None),
        (xyz, Some("c"), None),
    ] {
        let given = format!("{gyros:?}, temperature {temperature:?}, time {time:?}");
        let message = read(gyros, temperature, time)
            .map(|_| ())
            .expect_err(&given);
        transcript.case(&given, message);
    }
    transcript.check();
}

/// What both readers of arrays say about bytes, in the same words.
#[track_caller]
fn refused_array(bytes: &[u8]) -> String {
    let folder = scratch();
    let path = folder.path().join("log.npy");
    std::fs::write(&path, bytes).expect("writable");
    let of_log = read_log(&path, &format(None)).expect_err("no array");
    let of_stimulus = read_stimulus(&path, None, 2).expect_err("no array");
    assert_eq!(of_log.to_string(), of_stimulus.to_string());
    of_log.to_string()
}

#[test]
fn npy_files_with_a_wrong_heading_are_refused_and_nothing_is_set_aside_for_them() {
    let data = [0_u8; 32];
    let mut transcript = Transcript::of(READERS, "NPY files with a wrong heading");
    for (version, descr, count) in [
        (1, "<f8", 3),
        (1, "<f8", 5),
        (4, "<f8", 4),
        (1, "<f8", usize::MAX),
        (1, "|f8", 4),
        (1, "<U8", 1),
        (1, "|b1", 32),
        (1, "é8", 4),
    ] {
        let said = refused_array(&npy_bytes(version, descr, count, &data));
        let given = format!("version {version}, {descr}, {count} numbers in 32 bytes");
        transcript.case(given, said);
    }
    transcript.check();
}

#[test]
fn npy_files_of_another_shape_are_refused_and_no_heading_is_followed_deeply() {
    let data = [0_u8; 32];
    let plain = |rest: &str| format!("{{'descr': '<f8', 'fortran_order': False, {rest}}}");
    let nested = "(".repeat(60_000);
    let mut transcript = Transcript::of(READERS, "NPY files of another shape");
    for rest in [
        "'shape': ()",
        "'shape': (18446744073709551615, 18446744073709551615)",
        "'shape': (99999999999999999999,)",
        "'shape': (-4,)",
        "'shape': (4,), 'shape': (4,)",
    ] {
        transcript.case(rest, refused_array(&npy_of(1, &plain(rest), &data)));
    }
    let fields = "{'descr': [('a', [('b', '<f8')])], 'fortran_order': False, 'shape': (4,)}";
    for (what, bytes) in [
        (fields, npy_of(1, fields, &data)),
        (
            "'shape': ((((((...",
            npy_of(1, &plain(&format!("'shape': {nested}")), &data),
        ),
        (
            "a heading of 70000 spaces",
            npy_of(2, &" ".repeat(70_000), &data),
        ),
        (
            "\\x93NUMPY\\x02\\x00\\xff\\xff\\xff\\xff{",
            b"\x93NUMPY\x02\x00\xff\xff\xff\xff{".to_vec(),
        ),
        ("\\x93NUMPY\\x01", b"\x93NUMPY\x01".to_vec()),
        ("no number", npy_bytes(1, "<f8", 0, &[])),
        (
            "1 and infinity",
            npy_bytes(1, "<f4", 2, &[0, 0, 128, 63, 0, 0, 128, 127]),
        ),
        ("2^64 - 1", npy_bytes(1, ">u8", 1, &[255; 8])),
    ] {
        transcript.case(what, refused_array(&bytes));
    }
    transcript.check();
}

/// 300 numbers, a line each.
fn numbers() -> String {
    (0..300)
        .map(|k| format!("{:?}\n", 10.0 + f64::from(k % 7)))
        .collect()
}

/// Words of an exported stimulus.
fn exported(folder: &Path, file: &str) -> Vec<f64> {
    let arguments = [
        "export",
        "vectors",
        "out",
        "--stimulus",
        file,
        "--taps",
        "2",
        "--samples",
        "400",
    ];
    let output = fogbench(folder, &arguments);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let hex = std::fs::read_to_string(folder.join("out/in.hex")).expect("words");
    hex.lines()
        .skip(1)
        .step_by(2)
        .map(|line| f64::from_bits(u64::from_str_radix(line.trim(), 16).expect("hex")))
        .collect()
}

#[test]
fn a_stimulus_is_read_as_a_log_is() {
    let folder = scratch();
    write(folder.path(), "plain.csv", &numbers());
    write(folder.path(), "bom.csv", &format!("\u{feff}{}", numbers()));
    let rows = numbers()
        .lines()
        .map(|line| format!("1;{line};\r\n"))
        .collect::<String>();
    write(folder.path(), "table.csv", &format!("t;rate;\r\n{rows}"));
    let plain = exported(folder.path(), "plain.csv");
    assert_eq!(plain.len(), 300);
    assert_eq!(exported(folder.path(), "bom.csv"), plain);
    let mut arguments = vec!["export", "vectors", "out", "--stimulus", "table.csv"];
    let mut transcript = Transcript::of(READERS, "A stimulus is read as a log is");
    let output = fogbench(folder.path(), &arguments);
    transcript.case("a stimulus of two columns", stderr(&output));
    arguments.extend(["--column", "rate", "--taps", "2"]);
    let output = fogbench(folder.path(), &arguments);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    transcript.case("--column rate", stderr(&output));

    write(
        folder.path(),
        "firstbad.csv",
        &format!("1.0x\n{}", numbers()),
    );
    let data: Vec<u8> = (0..2000).flat_map(|k| f64::from(k).to_le_bytes()).collect();
    std::fs::write(
        folder.path().join("fewer.npy"),
        npy_bytes(1, "<f8", 500, &data),
    )
    .expect("a file");
    for file in ["firstbad.csv", "fewer.npy"] {
        for command in [
            &["export", "vectors", "o", "--stimulus", file][..],
            &["analyze", file, "--unit", "deg/h", "--rate-hz", "100"],
        ] {
            let output = fogbench(folder.path(), command);
            assert_eq!(code(&output), 2, "{command:?}: {}", stdout(&output));
            transcript.case(command.join(" "), stderr(&output));
        }
    }
    transcript.check();
}

#[test]
fn a_stimulus_in_words_of_four_bytes_is_exported() {
    let folder = scratch();
    let data: Vec<u8> = (0..40_u8)
        .flat_map(|k| f32::from(k).to_be_bytes())
        .collect();
    std::fs::write(folder.path().join("s.npy"), npy_bytes(1, ">f4", 40, &data)).expect("a file");
    let words = exported(folder.path(), "s.npy");
    assert_eq!(words, (0..40).map(f64::from).collect::<Vec<_>>());
}

#[cfg(target_os = "linux")]
#[test]
fn pipes_are_read_and_endless_devices_are_refused() {
    let folder = scratch();
    let piped = |bytes: &[u8], arguments: &[&str]| piped(folder.path(), bytes, arguments);
    let log = [
        "analyze",
        "/dev/stdin",
        "--unit",
        "deg/h",
        "--rate-hz",
        "100",
    ];
    let output = piped(numbers().as_bytes(), &log);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(stdout(&output).contains("300 samples"));
    let output = piped(
        numbers().as_bytes(),
        &["analyze", "-", "--unit", "deg/h", "--rate-hz", "100"],
    );
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(stdout(&output).contains("300 samples"));
    let data: Vec<u8> = (0..300)
        .flat_map(|k| f64::from(k % 5).to_le_bytes())
        .collect();
    let output = piped(&npy_bytes(1, "<f8", 300, &data), &log);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let mut transcript = Transcript::of(READERS, "Pipes and endless devices");
    let output = piped(&npy_bytes(1, "<f8", 299, &data), &log);
    let given = "a pipe of 300 numbers whose heading names 299";
    transcript.case(given.to_owned(), stderr(&output));
    let output = piped(&npy_bytes(1, "<f8", 301, &data), &log);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let note = "the input ended behind 300 of the 301 numbers that its heading names";
    assert!(stdout(&output).contains(note), "{}", stdout(&output));
    for arguments in [
        &["analyze", "/dev/zero", "--unit", "deg/h", "--rate-hz", "1"][..],
        &["export", "vectors", "o", "--stimulus", "/dev/zero"],
        &["calibrate", "/dev/zero", "--latitude-deg", "30"],
    ] {
        let output = fogbench(folder.path(), arguments);
        assert_eq!(code(&output), 2, "{}", stderr(&output));
        transcript.case(arguments.join(" "), stderr(&output));
    }
    transcript.check();
}

/// Groups of a small assembly at both senses of each mounting.
fn six_groups() -> String {
    let heading = "mounting,rate_deg_per_s,temperature_c,output_x_deg_per_s,output_y_deg_per_s,\
                   output_z_deg_per_s";
    let mut groups = format!("{heading}\n");
    for (line, k) in ["x,10", "x,-10", "y,10", "y,-10", "z,10", "z,-10"]
        .into_iter()
        .zip(0..)
    {
        let (axis, rate) = line.split_once(',').expect("two");
        let rate: f64 = rate.parse().expect("a number");
        let out = ["x", "y", "z"].map(|other| {
            if other == axis {
                rate * 1.001 + 0.002
            } else {
                0.001
            }
        });
        groups.push_str(&format!(
            "{line},{},{},{},{}\n",
            25 + k,
            out[0],
            out[1],
            out[2]
        ));
    }
    groups
}

#[test]
fn a_calibration_file_is_read_with_a_byte_order_mark_and_crlf() {
    let folder = scratch();
    write(folder.path(), "groups.csv", &six_groups());
    let arguments = [
        "calibrate",
        "groups.csv",
        "--latitude-deg",
        "32",
        "-o",
        "out",
    ];
    let output = fogbench(folder.path(), &arguments);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let path: PathBuf = folder.path().join("out/calibration.toml");
    let text = std::fs::read_to_string(&path).expect("a calibration");
    write(
        folder.path(),
        "bom.toml",
        &format!("\u{feff}{}", text.replace('\n', "\r\n")),
    );
    let rows: String = (0..300)
        .map(|k| format!("{},{},{}\n", k % 7, k % 5, k % 3))
        .collect();
    write(folder.path(), "log.csv", &format!("gx,gy,gz\n{rows}"));
    let compensated = |file: &str| {
        let output = fogbench(
            folder.path(),
            &[
                "filter",
                "log.csv",
                "--unit",
                "deg/h",
                "--rate-hz",
                "100",
                "--columns",
                "gx,gy,gz",
                "--axis",
                "y",
                "--calibration",
                file,
                "--filters",
                "f.toml",
                "-o",
                "words",
            ],
        );
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        npy(&folder.path().join("words/samples/compensated.npy"))
    };
    let filters = "schema = 1\n[[filter]]\nname = \"m\"\n[filter.moving_average]\ntaps = 2\n";
    write(folder.path(), "f.toml", filters);
    assert_eq!(compensated("bom.toml"), compensated("out/calibration.toml"));
}

#[test]
fn a_decimal_comma_is_named_where_it_makes_two_columns() {
    let folder = scratch();
    let said = |text: &str| {
        write(folder.path(), "log.csv", text);
        let read = read_log(&folder.path().join("log.csv"), &format(None));
        read.expect_err("two columns").to_string()
    };
    let comma = said("9,12\n9,13\n-8,9\n");
    assert!(
        comma.contains("if `9,12` is one number, say --decimal comma"),
        "{comma}"
    );
    for text in ["9.5,12\n", "9, 12\n", "a,x\n9,12\n", "9;12\n"] {
        assert!(!said(text).contains("comma"), "{text}");
    }
}
