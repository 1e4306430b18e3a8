//! What is said of a log that options do not fit: the line, what stands there, and the option that goes on.

use std::fmt::Write as _;
use std::path::Path;

use crate::support::records::white;
use crate::support::transcript::Transcript;
use crate::support::{code, fogbench, scratch, stderr, write};

/// Words and stamps between some signs, with a decimal point or comma.
fn table(separator: &str, decimal: &str, stamp: impl Fn(f64) -> String) -> String {
    let mut text = format!("time{separator}rate\n");
    for (k, word) in white(3, 400, 1.0).iter().enumerate() {
        let seconds = 0.01 * f64::from(u16::try_from(k).expect("few"));
        let stamp = stamp(seconds).replace('.', decimal);
        let word = format!("{word:.4}").replace('.', decimal);
        writeln!(text, "{stamp}{separator}{word}").expect("a string takes it");
    }
    text
}

/// What `analyze` says of a file: its exit code, and its last line.
fn analysed(folder: &Path, arguments: &str) -> (i32, String) {
    let mut words = vec!["analyze"];
    words.extend(arguments.split(' ').filter(|word| !word.is_empty()));
    words.extend(["--unit", "deg/h"]);
    let output = fogbench(folder, &words);
    let said = stderr(&output);
    (
        code(&output),
        said.lines().last().unwrap_or_default().to_owned(),
    )
}

/// Tables of the same numbers, each with how it is cut.
const TABLES: [(&str, &str, &str); 5] = [
    ("comma.csv", ",", "."),
    ("semicolon.csv", ";", ","),
    ("tab.csv", "\t", "."),
    ("tab-comma.csv", "\t", ","),
    ("blanks.csv", " ", "."),
];

#[test]
fn a_separator_or_sign_that_does_not_fit_is_answered_with_those_that_do() {
    let folder = scratch();
    let mut transcript = Transcript::of("log_refusals", "Separators and decimal signs");
    let given = ["tab", "semicolon", "comma", "blanks"].map(|it| format!("--separator {it}"));
    let given = given
        .into_iter()
        .chain(["point", "comma"].map(|it| format!("--decimal {it}")));
    let given: Vec<String> = given.collect();
    for (file, separator, decimal) in TABLES {
        write(
            folder.path(),
            file,
            &table(separator, decimal, |seconds| format!("{seconds:.2}")),
        );
        for given in &given {
            let arguments = format!("{file} {given}");
            let (exit, said) = analysed(folder.path(), &arguments);
            if exit == 0 {
                continue;
            }
            transcript.case(&arguments, &said);
            // What is said leads on.
            let advice = said
                .split("but with ")
                .nth(1)
                .and_then(|it| it.split(", as").next());
            let advice = advice.unwrap_or_else(|| panic!("{arguments}: {said}"));
            let (exit, said) = analysed(folder.path(), &format!("{file} {advice}"));
            assert_eq!(exit, 0, "{file} {advice}: {said}");
        }
    }
    transcript.check();
}

#[test]
fn stamps_of_dates_are_read_however_blanks_stand_in_them() {
    let folder = scratch();
    for form in [
        "2024-03-01 12:00:{s}",
        "2024-03-01T12:00:{s}Z",
        "2024-03-01 12:00:{s} Z",
        "2024-03-01 12:00:{s} UTC",
        "2024-03-01  12:00:{s} +01:00",
        "2024-03-01 12:00:{s}+01",
        "2024-03-01 12:00:{s} -0330",
        "9:05:{s}",
        "2024-03-01 01:00:{s} PM",
        "01-Mar-2024 12:00:{s}",
    ] {
        let stamp = |seconds: f64| form.replace("{s}", &format!("{seconds:06.3}"));
        write(folder.path(), "log.csv", &table(",", ".", stamp));
        let (exit, said) = analysed(folder.path(), "log.csv");
        assert_eq!(exit, 0, "{form}: {said}");
        assert!(said.contains("time time in iso"), "{form}: {said}");
    }
    // With decimal commas and blanks between cells, what stands behind the time is a number.
    let stamp = |seconds: f64| format!("12:00:{seconds:06.3}");
    let text = table(" ", ",", stamp)
        .replace(" -", " -1")
        .replace(" 0", " -10");
    write(folder.path(), "log.csv", &text);
    let (exit, said) = analysed(folder.path(), "log.csv");
    assert_eq!(exit, 0, "{said}");
    assert!(said.contains("2 columns between blanks"), "{said}");
}

#[test]
fn what_cannot_be_read_is_told_with_its_line_and_the_option_that_says_more() {
    let folder = scratch();
    let mut transcript = Transcript::of("log_refusals", "Stamps, columns, parts");
    let plain = table(",", ".", |seconds| format!("{seconds:.2}"));
    write(folder.path(), "plain.csv", &plain);
    let stamped = |form: &'static str| {
        table(",", ".", move |seconds| {
            form.replace("{s}", &format!("{seconds:06.3}"))
        })
    };
    write(folder.path(), "us.csv", &stamped("03/01/2024 12:00:{s}"));
    let apart = plain.replace(",-", " , - ").replace(',', " , ");
    write(folder.path(), "apart.csv", &apart);
    let points = table(";", ",", |seconds| format!("{seconds:.2}")) + "4,00;1.5\n";
    write(folder.path(), "point.csv", &points);
    let mixed = plain.clone() + "4.00,1;5\n";
    write(folder.path(), "mixed.csv", &mixed);
    let clock = |k: f64| format!("{:02}:59:{:05.2}", if k < 1.0 { 12 } else { 1 }, 20.0 + k);
    write(folder.path(), "clock.csv", &table(",", ".", clock));
    write(
        folder.path(),
        "still.csv",
        &table(",", ".", |_| "0".to_owned()),
    );
    write(folder.path(), "footer.csv", &(plain.clone() + "END\n"));
    for arguments in [
        "plain.csv --column rat3",
        "plain.csv --time rat3",
        "plain.csv --column a*",
        "plain.csv --reference-column rat3",
        "plain.csv --reference-column rate",
        "plain.csv --temperature-column oven",
        "plain.csv --column time --time time",
        "plain.csv --column rate --reference-column rate",
        "plain.csv --column rate,rate",
        "plain.csv --from-s 1e6",
        "plain.csv --rows 500:",
        "plain.csv --skip-lines 5000",
        "plain.csv --encoding utf-16-le",
        "plain.csv --time-unit iso",
        "us.csv --column rate --time time",
        "us.csv --column rate --time time --time-unit iso",
        "apart.csv",
        "point.csv",
        "mixed.csv",
        "clock.csv",
        "still.csv",
        "footer.csv",
        "us.csv",
    ] {
        let (exit, said) = analysed(folder.path(), arguments);
        assert_eq!(exit, 2, "{arguments}: {said}");
        transcript.case(arguments, said);
    }
    transcript.check();
}

#[test]
fn what_a_table_of_a_scenario_asks_for_in_vain_is_told_at_its_key() {
    let folder = scratch();
    let plain = table(",", ".", |seconds| format!("{seconds:.2}"));
    write(folder.path(), "log.csv", &plain);
    write(folder.path(), "parts.csv", "from_s,to_s\n100,200\n");
    let mut transcript = Transcript::of("log_refusals", "The table of a scenario");
    for (key, value) in [
        ("column", "[\"rat3\"]"),
        ("time", "[\"rat3\"]"),
        ("reference_column", "\"rat3\""),
        ("temperature_column", "\"oven\""),
        ("separator", "\"tab\""),
        ("decimal", "\"comma\""),
        ("heading_line", "900"),
        ("units_line", "900"),
        ("skip_lines", "5000"),
        ("encoding", "\"utf-16-be\""),
        ("wrapped_columns", "3"),
        ("rows", "\"500:\""),
        ("from_s", "1e6"),
        ("segments", "\"parts.csv\""),
        ("rate_hz", "3.0"),
        ("scale", "0.0"),
        ("kind", "\"angle\""),
    ] {
        let column = match key {
            "column" | "reference_column" => String::new(),
            _ => "column = [\"rate\"]\n".to_owned(),
        };
        let log = format!("schema = 1\n[log]\nfile = \"log.csv\"\nunit = \"deg/h\"\n{column}");
        write(
            folder.path(),
            "log.toml",
            &format!("{log}{key} = {value}\n"),
        );
        let output = fogbench(folder.path(), &["check", "log.toml"]);
        let said = stderr(&output);
        assert_eq!(code(&output), 2, "{key}: {said}");
        let own = format!("error: log.toml:{}:1: ", 1 + log.lines().count());
        let first = said.lines().next().unwrap_or_default();
        assert!(first.starts_with(&own), "{key}: {first}");
        assert!(first.contains(&format!("log.{key}")), "{key}: {first}");
        let first = first.replace(&*folder.path().to_string_lossy(), "");
        transcript.case(format!("{key} = {value}"), first);
    }
    transcript.check();
}
