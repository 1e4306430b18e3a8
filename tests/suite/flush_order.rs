//! What a rename brings into an output folder is on the disk before: read off the program's own calls.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::support::{scratch, write};

const SHORT: &str = "schema = 1\nduration_s = 1.0\nwarm_up_s = 0.5\nfidelity = \"rate\"\n";

/// Calls that change what a power cut may lose, or that make it safe.
const CALLS: &str = "trace=?open,openat,?creat,write,?pwrite64,?writev,?mkdir,?mkdirat,?link,?linkat,\
                     ?rename,?renameat,?renameat2,?fsync,?fdatasync";

/// Names that are not results: the workshop, where nothing is whole until it is renamed out of it.
const WORKSHOP: &str = ".fogbench";

/// Files and folders with changes that are not on the disk, by the calls of one run.
#[derive(Default)]
struct Unflushed {
    changed: BTreeSet<PathBuf>,
    /// Renames out of the workshop, and how many flushed files and folders they brought.
    installed: Vec<(PathBuf, usize)>,
    flushed: BTreeSet<PathBuf>,
}

impl Unflushed {
    /// Follows one line of the trace, `PID call(arguments) = result`.
    fn follow(&mut self, line: &str) {
        let Some((call, rest)) = line
            .split_once(' ')
            .and_then(|(_, text)| text.trim().split_once('('))
        else {
            return;
        };
        let Some((arguments, result)) = rest.rsplit_once(" = ") else {
            return;
        };
        if result.starts_with('-') {
            return;
        }
        match call {
            "open" | "openat" | "creat" if arguments.contains("O_CREAT") || call == "creat" => {
                self.change_entry(&descriptor(result));
            }
            "write" | "pwrite64" | "writev" => self.change(descriptor(arguments)),
            "mkdir" | "mkdirat" => self.change_entry(&names(arguments)[0]),
            "link" | "linkat" => self.change_entry(&names(arguments)[1]),
            "fsync" | "fdatasync" => {
                let path = descriptor(arguments);
                self.changed.remove(&path);
                self.flushed.insert(path);
            }
            "rename" | "renameat" | "renameat2" => {
                let names = names(arguments);
                let is_exchange = arguments.contains("RENAME_EXCHANGE");
                self.rename(&names[0], &names[1], is_exchange);
            }
            _ => {}
        }
    }

    fn change(&mut self, path: PathBuf) {
        self.flushed.remove(&path);
        self.changed.insert(path);
    }

    /// A name comes or goes: the folder that holds it changes with it.
    fn change_entry(&mut self, path: &Path) {
        self.change(path.to_owned());
        self.change(parent(path));
    }

    fn rename(&mut self, from: &Path, to: &Path, is_exchange: bool) {
        if is_in_workshop(from) && !is_in_workshop(to) {
            let inside = |path: &&PathBuf| path.starts_with(from);
            let lost: Vec<&PathBuf> = self.changed.iter().filter(inside).collect();
            assert!(lost.is_empty(), "{to:?} comes before the disk has {lost:?}");
            let flushed = self.flushed.iter().filter(inside).count();
            self.installed.push((to.to_owned(), flushed));
        }
        for paths in [&mut self.changed, &mut self.flushed] {
            *paths = paths
                .iter()
                .filter(|path| is_exchange || !path.starts_with(to))
                .map(|path| moved(path, from, to, is_exchange))
                .collect();
        }
        self.change(parent(from));
        self.change(parent(to));
    }
}

/// Path of a file after a rename.
fn moved(path: &Path, from: &Path, to: &Path, is_exchange: bool) -> PathBuf {
    let under = |old: &Path, new: &Path| Some(new.join(path.strip_prefix(old).ok()?));
    let back = || is_exchange.then(|| under(to, from)).flatten();
    under(from, to)
        .or_else(back)
        .unwrap_or_else(|| path.to_owned())
}

fn parent(path: &Path) -> PathBuf {
    path.parent().expect("an absolute path").to_owned()
}

fn is_in_workshop(path: &Path) -> bool {
    path.iter().any(|part| part == WORKSHOP)
}

/// Path behind the first file descriptor of a text, `4</path>`.
fn descriptor(text: &str) -> PathBuf {
    let path = text
        .split_once('<')
        .and_then(|(_, rest)| rest.split_once('>'));
    path.map_or_else(PathBuf::new, |(path, _)| path.into())
}

/// Quoted paths of a call.
fn names(arguments: &str) -> Vec<PathBuf> {
    arguments
        .split('"')
        .skip(1)
        .step_by(2)
        .map(PathBuf::from)
        .collect()
}

/// Lines of a trace, those of calls another thread cut in two made whole at their end.
fn whole_lines(trace: &str) -> Vec<String> {
    let mut open: Vec<(String, String)> = Vec::new();
    let mut lines = Vec::new();
    for line in trace.lines() {
        let thread = line.split(' ').next().unwrap_or_default().to_owned();
        if let Some(start) = line.strip_suffix(" <unfinished ...>") {
            open.push((thread, start.to_owned()));
        } else if let Some((_, end)) = line.split_once(" resumed>") {
            let place = open.iter().position(|(of, _)| *of == thread);
            let (_, start) = open.swap_remove(place.expect("a call that began"));
            lines.push(start + end);
        } else {
            lines.push(line.to_owned());
        }
    }
    lines
}

/// Runs the program under `strace` and gives what its calls left unflushed; none where there is no `strace`.
fn traced(folder: &Path, arguments: &[&str]) -> Option<Unflushed> {
    let trace = folder.join("trace.txt");
    let status = Command::new("strace")
        .args(["-f", "-qq", "-y", "-s", "0", "-e", CALLS, "-o"])
        .arg(&trace)
        .arg(env!("CARGO_BIN_EXE_fogbench"))
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    let Ok(status) = status else {
        assert!(std::env::var_os("CI").is_none(), "CI has strace");
        return None;
    };
    assert!(status.success(), "{arguments:?}");
    let text = fs::read_to_string(&trace).expect("a trace");
    let mut unflushed = Unflushed::default();
    for line in whole_lines(&text) {
        unflushed.follow(&line);
    }
    Some(unflushed)
}

/// Asserts that a command's results, `expected` of them by one rename each, were flushed before it and
/// their names after it.
#[track_caller]
fn is_flushed(folder: &Path, output: &str, arguments: &[&str], expected: &[&str]) {
    let output = folder.join(output);
    let place = output.to_str().expect("a path in Unicode");
    for _ in ["into nothing", "over earlier results"] {
        let Some(unflushed) = traced(folder, &[arguments, &["-o", place]].concat()) else {
            return;
        };
        for name in expected {
            let path = output.join(name);
            let found = unflushed.installed.iter().find(|(to, _)| *to == path);
            let (_, flushed) = found.unwrap_or_else(|| panic!("no rename brings {path:?}"));
            let files = if path.is_dir() {
                fs::read_dir(&path).expect("readable").count() + 1
            } else {
                1
            };
            assert_eq!(*flushed, files, "files flushed of {path:?}");
        }
        let names = unflushed.changed.iter();
        let left: Vec<_> = names
            .filter(|path| path.starts_with(&output) && !is_in_workshop(path))
            .collect();
        assert!(left.is_empty(), "never flushed: {left:?}");
    }
}

#[test]
fn a_run_is_on_the_disk_before_its_folder_is_renamed_into_place() {
    let folder = scratch();
    for name in ["first", "second"] {
        let text = format!("name = \"{name}\"\n{SHORT}");
        write(folder.path(), &format!("suite/{name}.toml"), &text);
    }
    let expected = ["first", "second", "summary.json", "junit.xml"];
    is_flushed(folder.path(), "out", &["run", "suite"], &expected);
}

#[test]
fn an_analysis_is_on_the_disk_before_its_files_are_renamed_into_place() {
    let folder = scratch();
    let rows: String = (0..400)
        .map(|k: i32| format!("{}\n", (k * 37) % 101))
        .collect();
    write(folder.path(), "log.csv", &format!("rate\n{rows}"));
    let arguments = ["analyze", "log.csv", "--rate-hz", "10", "--unit", "deg/h"];
    is_flushed(folder.path(), "out", &arguments, &["summary.json"]);
}
