//! Logs that people brought, and the ways out of what is refused of them.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::Path;

use serde_json::Value;

use crate::support::records::{normals, white};
use crate::support::{assert_close, code, fogbench, scratch, stderr, stdout, write};

/// What `analyze` finds in a file of `folder`.
#[track_caller]
fn analysed(folder: &Path, arguments: &[&str]) -> Value {
    let form = ["--format", "json"];
    let output = fogbench(folder, &[&["analyze"], arguments, &form].concat());
    assert_eq!(code(&output), 0, "{arguments:?}: {}", stderr(&output));
    serde_json::from_str(&stdout(&output)).expect("JSON")
}

/// H24: three hours of white noise and a walk at 200 Hz, in rad/s.
#[test]
fn known_answer_noise_of_three_hours_at_200_hz_comes_back() {
    const WORDS: usize = 3 * 3600 * 200;
    const RAD_PER_DEG_PER_H: f64 = std::f64::consts::PI / 180.0 / 3600.0;
    let (noise, steps) = (normals(24, "white", WORDS), normals(24, "walk", WORDS));
    // N of 0.6492 deg/sqrt(h) is 60 N deg/h/sqrt(Hz); K of 31.6 deg/h/sqrt(h) takes steps of 1/200 s.
    let deviation = 0.6492 * 60.0 * 200.0_f64.sqrt();
    let step = 31.6 / (3600.0 * 200.0_f64).sqrt();
    let mut walk = 0.0;
    let words = noise.iter().zip(&steps).flat_map(|(noise, own)| {
        walk += step * own;
        ((deviation * noise + walk) * RAD_PER_DEG_PER_H).to_le_bytes()
    });
    let folder = scratch();
    let bytes: Vec<u8> = words.collect();
    std::fs::write(folder.path().join("log.f8"), bytes).expect("writable");
    let arguments = [
        "log.f8",
        "--dtype",
        "f8",
        "--unit",
        "rad/s",
        "--rate-hz",
        "200",
    ];
    let json = analysed(folder.path(), &arguments);
    let raw = &json["channels"]["raw"];
    let of = |metric: &str, field: &str| {
        let value = raw[metric][field].as_f64();
        value.unwrap_or_else(|| panic!("{metric} {field}: {raw}"))
    };
    let noise = "angle_random_walk_deg_per_sqrt_h";
    let (low, high) = (of(noise, "low"), of(noise, "high"));
    assert!(
        (low..=high).contains(&0.6492) && high - low < 0.02,
        "{low} to {high}"
    );
    // Three hours tell the walk to a third.
    let walk = "rate_random_walk_deg_per_h_per_sqrt_h";
    let (low, high) = (of(walk, "low"), of(walk, "high"));
    assert!(
        low < 1.1 * 31.6 && high > 31.6 && high < 60.0,
        "{low} to {high}"
    );
    assert_close(of(walk, "value"), 31.6, 0.5, 0.0);
    // There is no flicker to tell.
    let flicker = &raw["bias_instability_deg_per_h"];
    assert!(
        flicker.is_null() || flicker["low"].as_f64() == Some(0.0),
        "{flicker}"
    );
}

const FILTER: &str = "schema = 1\nname = \"live\"\n[[filter]]\nname = \"mean\"\n\
                      [filter.moving_average]\ntaps = 2\n";

/// Stamps at 100 Hz and words in deg/h of three gyros, an encoder and a reference; a change may come upon them.
fn table(change: impl FnOnce(String) -> String) -> String {
    let mut text = "time_s,gx,gy,gz,ref\n".to_owned();
    for (k, word) in white(6, 3000, 1.0).iter().enumerate() {
        let swing = (std::f64::consts::TAU * 0.05 * k as f64).sin();
        let row = format!(
            "{}.{:02}0,{:.3},1,2,{swing:.4}",
            k / 100,
            k % 100,
            word + 100.0 * swing
        );
        writeln!(text, "{row}").expect("a string");
    }
    change(text)
}

/// Options that a text names, but for those of the command itself.
fn named(text: &str, own: &[&str]) -> BTreeSet<String> {
    let words = text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '-'));
    let options = words.filter(|word| word.starts_with("--") && !own.contains(word));
    options.map(str::to_owned).collect()
}

/// A file, what is asked of it, and the sets of options that go on.
type Case = (&'static str, &'static str, &'static [&'static str]);

const CASES: [Case; 13] = [
    (
        "gap.csv",
        "analyze",
        &[
            "--split-gaps",
            "--gap-aware 100",
            "--rows :1400",
            "--to-s 13",
        ],
    ),
    ("nan.csv", "analyze", &["--missing gap"]),
    ("crowd.csv", "analyze", &["--max-gap-s 1"]),
    (
        "gap.csv",
        "analyze --motion swing:5",
        &["--rows :1400", "--to-s 13"],
    ),
    (
        "gap.csv",
        "analyze --reference-column ref --reference-unit deg/h",
        &["--rows :1400", "--to-s 13"],
    ),
    (
        "gap.csv",
        "filter --filters live.toml",
        &["--rows :1400", "--to-s 13"],
    ),
    (
        "nan.csv",
        "filter --filters live.toml",
        &["--missing gap --rows :1400"],
    ),
    (
        "crowd.csv",
        "filter --filters live.toml",
        &["--max-gap-s 1"],
    ),
    (
        "gap.csv",
        "filter --filters live.toml --rate-hz 100 --pass text",
        &[],
    ),
    (
        "nan.csv",
        "filter --filters live.toml --rate-hz 100 --pass text",
        &[],
    ),
    (
        "crowd.csv",
        "filter --filters live.toml --rate-hz 100 --pass text",
        &["--max-gap-s 1"],
    ),
    (
        "gap.csv",
        "analyze --columns gx,gy,gz --axis x --calibration calibration.toml",
        &["--rows :1400", "--to-s 13"],
    ),
    (
        "nan.csv",
        "analyze --columns gx,gy,gz --axis x --calibration calibration.toml",
        &["--missing gap --rows :1400"],
    ),
];

#[test]
fn a_refusal_names_no_option_that_the_same_command_refuses_and_those_named_go_on() {
    let folder = scratch();
    let path = folder.path();
    write(path, "live.toml", FILTER);
    let assembly = "schema = 1\n[compensation]\nbias_deg_per_h = [1.0, 0.0, 0.0]\n";
    write(path, "calibration.toml", assembly);
    let gap = |text: String| {
        let rows: Vec<&str> = text.lines().collect();
        [&rows[..1500], &rows[1600..]].concat().join("\n") + "\n"
    };
    write(path, "gap.csv", &table(gap));
    let nan = |text: String| {
        let of = |line: &str| match line.split(',').collect::<Vec<_>>()[..] {
            ["20.000", _, y, z, reference] => format!("20.000,nan,{y},{z},{reference}\n"),
            _ => format!("{line}\n"),
        };
        text.lines().map(of).collect::<String>()
    };
    write(path, "nan.csv", &table(nan));
    write(
        path,
        "crowd.csv",
        &table(|text| text.replace("\n20.000,", "\n19.991,")),
    );
    for (file, command, ways) in CASES {
        let words: Vec<&str> = command.split(' ').collect();
        let column: &[&str] = if command.contains("--columns") {
            &[]
        } else {
            &["--column", "gx"]
        };
        let own = [&words[..1], &[file, "--unit", "deg/h"], column, &words[1..]].concat();
        let output = fogbench(path, &own);
        assert_eq!(code(&output), 2, "{file} {command}: {}", stdout(&output));
        let said = stderr(&output);
        let found = named(&said, &["--rate-hz", "--time"]);
        let options = ways.iter().flat_map(|way| way.split(' '));
        let options: BTreeSet<String> = options
            .filter(|word| word.starts_with("--"))
            .map(str::to_owned)
            .collect();
        assert_eq!(found, options, "{file} {command}: {said}");
        for way in ways {
            let way: Vec<&str> = way.split(' ').collect();
            let output = fogbench(path, &[&own[..], &way].concat());
            assert_eq!(
                code(&output),
                0,
                "{file} {command} {way:?}: {}",
                stderr(&output)
            );
        }
    }
    let scenario = FILTER.replace(
        "[[filter]]",
        "[log]\nfile = \"gap.csv\"\nunit = \"deg/h\"\ncolumn = [\"gx\"]\n[[filter]]",
    );
    write(path, "log.toml", &scenario);
    let output = fogbench(path, &["check", "log.toml"]);
    let said = stderr(&output);
    assert!(said.contains("log.rows or log.to_s takes a part"), "{said}");
    assert!(!said.contains("log.split_gaps"), "{said}");
}

/// Words of white noise, as text with so many digits.
fn words(count: usize) -> Vec<String> {
    white(8, count, 0.2)
        .iter()
        .map(|word| format!("{:.6}", word + 0.05))
        .collect()
}

/// A file that is odd, and what it is to come out as.
struct Odd {
    what: &'static str,
    bytes: Vec<u8>,
    options: &'static [&'static str],
    rate_hz: f64,
}

/// Samples of each of them.
const ODD_SAMPLES: usize = 2000;

fn odd(
    what: &'static str,
    bytes: impl Into<Vec<u8>>,
    options: &'static [&'static str],
    rate_hz: f64,
) -> Odd {
    Odd {
        what,
        bytes: bytes.into(),
        options,
        rate_hz,
    }
}

/// A text in UTF-16 with its mark.
fn utf16(text: &str) -> Vec<u8> {
    let units = std::iter::once(0xfeff).chain(text.encode_utf16());
    units.flat_map(u16::to_le_bytes).collect()
}

/// A line for each word.
fn rows(line: impl Fn(usize, &str) -> String) -> String {
    let own = words(ODD_SAMPLES);
    let lines = own.iter().enumerate();
    lines.map(|(k, word)| line(k, word) + "\n").collect()
}

fn odd_tables() -> Vec<Odd> {
    let comma = |word: &str| word.replace('.', ",");
    let quoted = rows(|k, word| format!("\"{}\";\"{}\"", 5 * k, comma(word)));
    let units = format!(
        "Device: X\nRate: 200\n\ntime,omega\n[s],[mdeg/s]\n{}",
        rows(|k, word| format!("{:.3},{word}", k as f64 / 200.0))
    );
    let own = words(ODD_SAMPLES);
    let wrapped: String = own.chunks(7).map(|row| row.join(" ") + "\r\n").collect();
    vec![
        odd(
            "quoted cells with decimal commas",
            format!("\"t [ms]\";\"rate [°/s]\"\n{quoted}"),
            &[],
            200.0,
        ),
        odd(
            "UTF-16 of a spreadsheet",
            utf16(&units.replace('\n', "\r\n")),
            &[],
            200.0,
        ),
        odd(
            "the heading again, where a logger began anew",
            units.replacen("\n0.010,", "\ntime,omega\n[s],[mdeg/s]\n0.010,", 1),
            &[],
            200.0,
        ),
        odd(
            "the same with blanks, marks and a separator about its cells",
            units.replacen(
                "\n0.010,",
                "\n time , omega\n\"[s]\",\"[mdeg/s]\"\ntime,omega,\n0.010,",
                1,
            ),
            &[],
            200.0,
        ),
        odd("a preamble of keys and a row of units", units, &[], 200.0),
        odd(
            "rows that are wrapped, without a heading",
            wrapped,
            &[
                "--wrapped-columns",
                "1",
                "--rate-hz",
                "200",
                "--unit",
                "deg/s",
            ],
            200.0,
        ),
    ]
}

fn odd_clocks() -> Vec<Odd> {
    let counter = rows(|k, word| format!("{}\t{word}", (k + 250) % 256));
    let over = rows(|k, word| {
        let tick = 604_798 * 100 + k;
        let (week, tick) = (2300 + tick / 60_480_000, tick % 60_480_000);
        format!("{week},{}.{:02},{word}", tick / 100, tick % 100)
    });
    let date = rows(|k, word| {
        let (s, ms) = (50 + k / 200, k % 200 * 5);
        format!("01.03.2024 ignored;2024-03-01 23:59:{s:02}.{ms:03};{word}")
    });
    vec![
        odd(
            "a counter of 8 bits that rolls over, beside a rate",
            format!("# serial 0042, firmware 1.7\n# cnt(-)\trate(deg/s)\n{counter}"),
            &["--rate-hz", "200", "--time-unit", "sample", "--time", "cnt"],
            200.0,
        ),
        odd(
            "week and seconds over the end of a week",
            format!("week,sow [s],gyro_dps\n{over}"),
            &["--time", "week,sow"],
            100.0,
        ),
        odd(
            "dates with blanks",
            format!("note;utc;rate dps\n{date}"),
            &["--column", "rate"],
            200.0,
        ),
    ]
}

#[test]
fn odd_files_come_out_whole_at_their_rate() {
    let folder = scratch();
    for odd in odd_tables().into_iter().chain(odd_clocks()) {
        std::fs::write(folder.path().join("odd.txt"), odd.bytes).expect("writable");
        let json = analysed(folder.path(), &[&["odd.txt"], odd.options].concat());
        assert_eq!(json["log"]["samples"], ODD_SAMPLES, "{}", odd.what);
        let rate_hz = json["log"]["rate_hz"].as_f64().expect("a rate");
        assert_close(rate_hz, odd.rate_hz, 1e-6, 0.0);
    }
}
