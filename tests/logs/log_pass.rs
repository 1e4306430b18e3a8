//! Filtered words passed on as they come: what a slow pipe sees, that they are the words of a replay, and
//! how it ends.

use std::fmt::Write as _;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout};

use fogbench::recording::read_words;
use fogbench::store::write_npy;

use crate::support::records::white;
use crate::support::transcript::Transcript;
use crate::support::{code, fogbench, on_a_pipe, stderr, write};

/// Filters of the bench: a mean, a low pass, the textbook and a pipeline.
const FILTERS: &str = "schema = 1
name = \"live\"

[[filter]]
name = \"mean\"
moving_average.taps = 8

[[filter]]
name = \"rls\"
[filter.rls]
pipeline = \"textbook\"

[[filter]]
name = \"lms\"
[filter.lms]
pipeline = \"fpga\"
clock_mhz = 40.0
";

/// A filter that 3000 zeros end.
const FAILING: &str = "schema = 1
name = \"failing\"

[[filter]]
name = \"rls\"
[filter.rls]
pipeline = \"textbook\"
forgetting_factor = 0.5
";

/// A folder with the filters.
fn scratch() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(folder.path(), "live.toml", FILTERS);
    write(folder.path(), "failing.toml", FAILING);
    folder
}

/// A recorder's end and a reader's end of the program.
struct Live {
    child: Child,
    words: ChildStdin,
    passed: BufReader<ChildStdout>,
}

fn live(folder: &Path, more: &[&str]) -> Live {
    let common = ["filter", "-", "--unit", "deg/h", "--filters", "live.toml"];
    let mut child = on_a_pipe(folder, &[&common[..], more].concat());
    Live {
        words: child.stdin.take().expect("a pipe"),
        passed: BufReader::new(child.stdout.take().expect("a pipe")),
        child,
    }
}

impl Live {
    fn send(&mut self, bytes: &[u8]) {
        self.words.write_all(bytes).expect("it reads");
        self.words.flush().expect("it reads");
    }

    /// Numbers of binary64 that have come out.
    fn take(&mut self, count: usize) -> Vec<f64> {
        let mut bytes = vec![0; 8 * count];
        self.passed.read_exact(&mut bytes).expect("words come out");
        let words = bytes.chunks_exact(8);
        words
            .map(|word| f64::from_le_bytes(word.try_into().expect("eight bytes")))
            .collect()
    }

    /// A line that has come out.
    fn line(&mut self) -> String {
        let mut line = String::new();
        self.passed.read_line(&mut line).expect("a line comes out");
        line.trim_end().to_owned()
    }

    /// Ends the input: exit code, what still came out, what was said.
    fn end(mut self) -> (Option<i32>, Vec<u8>, String) {
        drop(self.words);
        let mut rest = Vec::new();
        self.passed.read_to_end(&mut rest).expect("it ends");
        let mut said = String::new();
        let mut errors = self.child.stderr.take().expect("a pipe");
        errors.read_to_string(&mut said).expect("it ends");
        let status = self.child.wait().expect("it ends");
        (status.code(), rest, said)
    }
}

fn bytes_of(words: &[f64]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// The words of the three filters as a replay of a log writes them, word by word.
fn replayed(folder: &Path, words: &[f64]) -> Vec<f64> {
    write_npy(&folder.join("log.npy"), words).expect("a file");
    let output = fogbench(
        folder,
        &[
            "filter",
            "log.npy",
            "--rate-hz",
            "100",
            "--unit",
            "deg/h",
            "--filters",
            "live.toml",
            "-o",
            "replay",
        ],
    );
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let columns = ["mean", "rls", "lms"]
        .map(|name| read_words(&folder.join(format!("replay/samples/{name}.npy"))).expect("words"));
    let rows = (0..words.len()).flat_map(|row| columns.iter().map(move |column| column[row]));
    rows.collect()
}

#[cfg(target_os = "linux")]
#[test]
fn words_come_out_before_the_next_ones_go_in_and_are_those_of_a_replay() {
    let folder = scratch();
    let words = white(5, 700, 20.0);
    let wanted = replayed(folder.path(), &words);
    let mut live = live(
        folder.path(),
        &["--dtype", "f8", "--rate-hz", "100", "--pass", "f8"],
    );
    let mut passed = Vec::new();
    // One word, some at once, half a word.
    for part in [&words[..1], &words[1..4], &words[4..300]] {
        live.send(&bytes_of(part));
        passed.extend(live.take(3 * part.len()));
    }
    let rest = bytes_of(&words[300..]);
    live.send(&rest[..12]);
    passed.extend(live.take(3));
    live.send(&rest[12..]);
    let (code, rest, said) = live.end();
    assert_eq!((code, said.as_str()), (Some(0), ""));
    let rest = rest.chunks_exact(8);
    passed.extend(rest.map(|word| f64::from_le_bytes(word.try_into().expect("eight bytes"))));
    assert_eq!(passed, wanted);
}

#[cfg(target_os = "linux")]
#[test]
fn rows_of_a_text_come_out_line_by_line_with_all_their_digits() {
    let folder = scratch();
    let words = white(6, 300, 20.0);
    let wanted = replayed(folder.path(), &words);
    let mut live = live(folder.path(), &["--rate-hz", "100", "--pass", "text"]);
    let mut passed = Vec::new();
    let mut row = |line: String| {
        let cells = line
            .split(',')
            .map(|cell| cell.parse::<f64>().expect("a number"));
        passed.extend(cells);
    };
    // The layout is found from the first fifty lines.
    let mut first = "time_s,rate [deg/h]\n".to_owned();
    let line = |k: usize| format!("{}.{:02},{:?}\n", k / 100, k % 100, words[k]);
    for k in 0..49 {
        first.push_str(&line(k));
    }
    live.send(first.as_bytes());
    assert_eq!(live.line(), "mean_deg_per_h,rls_deg_per_h,lms_deg_per_h");
    (0..49).for_each(|_| row(live.line()));
    for k in 49..60 {
        live.send(line(k).as_bytes());
        row(live.line());
    }
    // A comment and an empty line hold nothing back.
    live.send(format!("{}# pause\n\n", line(60)).as_bytes());
    row(live.line());
    let mut rest = String::new();
    for k in 61..300 {
        rest.push_str(&line(k));
    }
    live.send(rest.as_bytes());
    let (code, rest, said) = live.end();
    let rest = String::from_utf8(rest).expect("text");
    rest.lines().for_each(|line| row(line.to_owned()));
    assert_eq!(code, Some(0));
    assert_eq!(passed, wanted);
    let layout = "-: 2 columns between commas, heading in line 1, rows from line 2, data rate [deg/h], \
                  time time_s in s\n";
    assert!(said.starts_with(layout), "{said}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_reader_that_goes_away_ends_it_quietly() {
    let folder = scratch();
    let Live {
        mut child,
        mut words,
        passed,
    } = live(
        folder.path(),
        &["--dtype", "f8", "--rate-hz", "100", "--pass", "f4"],
    );
    drop(passed);
    let block = bytes_of(&white(7, 1000, 20.0));
    // Until its end of the pipe is closed.
    while words.write_all(&block).is_ok() {}
    let mut said = String::new();
    let mut errors = child.stderr.take().expect("a pipe");
    errors.read_to_string(&mut said).expect("it ends");
    assert_eq!(child.wait().expect("it ends").code(), Some(0));
    assert_eq!(said, "");
}

#[test]
fn what_came_before_a_fault_has_been_passed_on() {
    let folder = scratch();
    let mut text = "time_s,rate [deg/h]\n".to_owned();
    for k in 0..200 {
        let _ = writeln!(text, "{}.{:02},{}", k / 100, k % 100, (k * 37) % 101);
    }
    let mut transcript = Transcript::of("log-pass", "Faults of words that are passed on");
    let common = [
        "--filters",
        "live.toml",
        "--rate-hz",
        "100",
        "--pass",
        "text",
    ];
    for (name, text, rows) in [
        ("word.csv", text.replace("1.50,", "1.50,x"), 150),
        ("gap.csv", text.replace("1.50,", "1.95,"), 150),
        ("rate.csv", text.replace("1.50,96", "1.50,1e13"), 150),
    ] {
        write(folder.path(), name, &text);
        let output = fogbench(folder.path(), &[&["filter", name], &common[..]].concat());
        assert_eq!(code(&output), 2, "{name}");
        let passed = String::from_utf8(output.stdout.clone()).expect("text");
        assert_eq!(passed.lines().count(), 1 + rows, "{name}");
        transcript.case(name, stderr(&output));
    }
    let mut zeros = "1\n2\n-1\n".to_owned();
    zeros.push_str(&"0\n".repeat(3000));
    write(folder.path(), "zeros.csv", &zeros);
    let failing = [
        "--filters",
        "failing.toml",
        "--rate-hz",
        "100",
        "--pass",
        "text",
    ];
    let file = ["filter", "zeros.csv", "--unit", "deg/h"];
    let output = fogbench(folder.path(), &[&file[..], &failing[..]].concat());
    assert_eq!(code(&output), 3, "{}", stderr(&output));
    transcript.case("zeros.csv", stderr(&output));
    transcript.check();
}

#[test]
fn what_needs_a_whole_log_is_refused() {
    let folder = scratch();
    write(folder.path(), "log.csv", "a [deg/h],b [deg/h]\n1,2\n3,4\n");
    let program = "schema = 1\nname = \"program\"\n[[filter]]\nname = \"own\"\n\
                   [filter.process]\ncommand = [\"cat\"]\n";
    write(folder.path(), "program.toml", program);
    let mut transcript = Transcript::of("log-pass", "What is not passed on");
    let rate = ["--rate-hz", "100"];
    for (filters, more) in [
        ("live.toml", &["--column", "a"][..]),
        ("live.toml", &["--column", "a,b", "--rate-hz", "100"]),
        (
            "live.toml",
            &[&["--column", "a", "--rows", "1:2"][..], &rate].concat(),
        ),
        (
            "live.toml",
            &[&["--column", "a", "--missing", "gap"][..], &rate].concat(),
        ),
        (
            "live.toml",
            &["--column", "a", "--rate-hz", "100", "-o", "out"],
        ),
        ("program.toml", &["--column", "a", "--rate-hz", "100"]),
    ] {
        let command = ["filter", "log.csv", "--filters", filters, "--pass", "text"];
        let output = fogbench(folder.path(), &[&command[..], more].concat());
        assert_eq!(code(&output), 2, "{more:?}");
        transcript.case(format!("{filters} {}", more.join(" ")), stderr(&output));
    }
    transcript.check();
}
