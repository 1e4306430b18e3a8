//! A small suite, what it leaves when nothing interrupts it, and an output folder to interrupt it in.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use super::case::Fault;
use crate::support::{code, stderr, stdout, tree, write};

/// Files by path.
pub(crate) type Files = BTreeMap<PathBuf, Vec<u8>>;

/// Folders of runs: the suite's, then the one of another scenario.
const RUNS: [&str; 5] = ["plain", "sweep/0000", "sweep/0001", "gated", OTHER];
/// Folder of the scenario beside the suite.
const OTHER: &str = "other";
/// Folder in which the tool keeps its books.
const BOOKS: &str = ".fogbench";

const SHORT: &str = "schema = 1\nduration_s = 0.05\nwarm_up_s = 0.02\nfidelity = \"rate\"\n\
    [turntable.rotation]\nrate_deg_per_s = 1.0\nsoft_start_s = 0.01\n";

/// Files of the user's in the output folder; the last lie where an earlier version cleaned up.
const MINE: [&str; 4] = [
    "notes.txt",
    "mine/thesis.txt",
    ".plain.old/summary.json",
    ".junit.xml.partial",
];

/// What stands in the output folder before a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Start {
    /// Files of the user's alone.
    Empty,
    /// Results of the same scenarios with another duration as well.
    Old,
    /// The very results that the run will give.
    New,
}

/// Which results a run gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Version {
    Old,
    New,
}

/// The suite in its folder.
pub(crate) struct Yard {
    folder: tempfile::TempDir,
    /// Exit code of the suite: a gate of it fails.
    pub(crate) exit: i32,
    /// How long it takes.
    pub(crate) length: Duration,
    old: Files,
    new: Files,
    other: Files,
}

impl Yard {
    /// Writes the suite and runs it without interruption.
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().expect("a scratch folder");
        let scenario = |name: &str, more: &str| format!("name = \"{name}\"\n{SHORT}{more}");
        let at = folder.path();
        let samples = "[output]\nsamples = \"npy\"\n[[filter]]\nname = \"lms\"\n[filter.lms]\n";
        write(at, "suite/plain.toml", &scenario("plain", samples));
        let swept = "[matrix]\n\"gyro.coil.length_m\" = [700.0, 800.0]\n";
        write(at, "suite/sweep.toml", &scenario("sweep", swept));
        let gate = "[[gate]]\nmetric = \"raw.mean_deg_per_h\"\nmax = -1e6\n";
        write(at, "suite/gated.toml", &scenario("gated", gate));
        write(at, "other.toml", &scenario(OTHER, ""));
        let mut yard = Self {
            folder,
            exit: 0,
            length: Duration::ZERO,
            old: Files::new(),
            new: Files::new(),
            other: Files::new(),
        };
        let ended = yard.run("old", Version::Old, &[]);
        assert_eq!(ended.code, 1, "{}", ended.talk);
        let started = Instant::now();
        yard.exit = yard.run("new", Version::New, &[]).code;
        yard.length = started.elapsed();
        assert_eq!(yard.run_other("beside").code, 0);
        yard.old = yard.files("old");
        yard.new = yard.files("new");
        yard.other = yard.files("beside");
        assert!(yard.old != yard.new && yard.new.len() > 20);
        yard
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Makes an output folder that holds files of the user's and earlier results.
    pub(crate) fn prepare(&self, name: &str, start: Start) -> Result<(), Fault> {
        let output = self.path(name);
        if output.exists() {
            fs::remove_dir_all(&output).map_err(|error| fault("prepare", &error))?;
        }
        match start {
            Start::Empty => {}
            Start::Old => copy(&self.path("old"), &output),
            Start::New => copy(&self.path("new"), &output),
        }
        for mine in MINE {
            write(&output, mine, mine);
        }
        Ok(())
    }

    /// Arguments of a run of the suite.
    pub(crate) fn arguments(&self, name: &str, version: Version, more: &[&str]) -> Vec<String> {
        let mut arguments = vec!["run", "suite", "-o", name];
        if version == Version::Old {
            arguments.extend(["--set", "duration_s=0.04"]);
        }
        arguments.extend(more);
        arguments.into_iter().map(str::to_owned).collect()
    }

    /// Runs the suite to its end.
    pub(crate) fn run(&self, name: &str, version: Version, more: &[&str]) -> Ended {
        self.start(&self.arguments(name, version, more)).end()
    }

    /// Runs the scenario beside the suite to its end.
    pub(crate) fn run_other(&self, name: &str) -> Ended {
        let arguments = ["run", "other.toml", "-o", name].map(str::to_owned);
        self.start(&arguments).end()
    }

    /// Starts the program.
    pub(crate) fn start(&self, arguments: &[String]) -> Running {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fogbench"));
        command.args(arguments);
        self.spawn(command)
    }

    /// Starts the program under `strace`, which kills it at call `count` of one of `calls`.
    pub(crate) fn start_traced(&self, calls: &str, count: usize, arguments: &[String]) -> Running {
        let mut command = Command::new("strace");
        command
            .args(["-f", "-qq", "-o", "/dev/null", "-e"])
            .arg(format!("trace={calls}"))
            .arg("-e")
            .arg(format!("inject={calls}:signal=KILL:when={count}"))
            .arg(env!("CARGO_BIN_EXE_fogbench"))
            .args(arguments);
        self.spawn(command)
    }

    fn spawn(&self, mut command: Command) -> Running {
        let child = command
            .current_dir(self.folder.path())
            .env("NO_COLOR", "1")
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        Running(child)
    }

    /// Results in an output folder: everything but the books and the user's files.
    pub(crate) fn files(&self, name: &str) -> Files {
        let files = tree(&self.path(name)).into_iter();
        let is_mine = |path: &Path| MINE.iter().any(|mine| path == Path::new(mine));
        files
            .filter(|(path, _)| !path.starts_with(BOOKS) && !is_mine(path))
            .collect()
    }

    /// Checks that nothing in an output folder is half and that the user's files are untouched;
    /// gives the folders that are there.
    pub(crate) fn check_whole(&self, name: &str) -> Result<Vec<&'static str>, Fault> {
        self.check_mine(name)?;
        let mut files = self.files(name);
        let mut there = Vec::new();
        for run in RUNS {
            let found = split_off(&mut files, run);
            if found.is_empty() {
                continue;
            }
            let versions = [&self.old, &self.new, &self.other];
            let is_whole = versions.iter().any(|version| inside(version, run) == found);
            if !is_whole {
                let names: Vec<_> = found.keys().collect();
                return Err(Fault::new("half folder", format!("{run}: {names:?}")));
            }
            there.push(run);
        }
        for (path, bytes) in files {
            check_loose(&path, &bytes)?;
        }
        Ok(there)
    }

    /// Checks that an output folder holds the results of one version, and only those.
    pub(crate) fn check_final(&self, name: &str, version: Version) -> Result<(), Fault> {
        self.check_mine(name)?;
        let mut files = self.files(name);
        split_off(&mut files, OTHER);
        let wanted = match version {
            Version::Old => &self.old,
            Version::New => &self.new,
        };
        let names = |files: &Files| files.keys().cloned().collect::<Vec<_>>();
        if names(&files) != names(wanted) {
            let message = format!("{:?}, expected {:?}", names(&files), names(wanted));
            return Err(Fault::new("other files at the end", message));
        }
        let differs = files.iter().find(|(path, bytes)| wanted[*path] != **bytes);
        match differs {
            None => Ok(()),
            Some((path, _)) => {
                let path = path.display().to_string();
                Err(Fault::new("other bytes at the end", path))
            }
        }
    }

    fn check_mine(&self, name: &str) -> Result<(), Fault> {
        for mine in MINE {
            let text = fs::read_to_string(self.path(name).join(mine));
            if !text.is_ok_and(|text| text == mine) {
                return Err(Fault::new("the user's file is lost", mine));
            }
        }
        Ok(())
    }
}

/// A file of the suite as a whole.
fn check_loose(path: &Path, bytes: &[u8]) -> Result<(), Fault> {
    let name = path.display().to_string();
    let text = String::from_utf8_lossy(bytes);
    // The pictures of a sweep stand beside its points, with a record of them.
    let (folder, file) = name.rsplit_once('/').unwrap_or(("", &name));
    let is_of_sweep = folder == "sweep" && (file == ".fogbench.toml" || file.ends_with(".svg"));
    let own = if is_of_sweep { file } else { name.as_str() };
    let is_whole = match own {
        _ if own.ends_with(".svg") => text.trim_end().ends_with("</svg>"),
        "summary.json" => serde_json::from_str::<serde_json::Value>(&text).is_ok(),
        "index.html" => text.trim_end().ends_with("</html>"),
        "metrics.csv" => is_whole_table(&text),
        "junit.xml" => text.trim_end().ends_with("</testsuites>"),
        ".fogbench.toml" => toml::from_str::<toml::Table>(&text).is_ok(),
        _ => return Err(Fault::new("stray file", name)),
    };
    if is_whole {
        Ok(())
    } else {
        Err(Fault::new("half file", format!("{name}: {text}")))
    }
}

/// Whether a CSV ends with a whole row, as long as its first.
fn is_whole_table(text: &str) -> bool {
    let cells = |row: &str| row.matches(',').count();
    let mut rows = text.lines();
    let first = rows.next().map(cells);
    text.ends_with('\n') && first.is_some() && rows.last().map(cells) == first
}

/// Takes the files below a folder out of a list.
fn split_off(files: &mut Files, folder: &str) -> Files {
    let found = inside(files, folder);
    files.retain(|path, _| !path.starts_with(folder));
    found
}

/// The files below a folder.
fn inside(files: &Files, folder: &str) -> Files {
    let files = files.iter().filter(|(path, _)| path.starts_with(folder));
    files
        .map(|(path, bytes)| (path.clone(), bytes.clone()))
        .collect()
}

fn copy(from: &Path, to: &Path) {
    for (path, bytes) in tree(from) {
        let target = to.join(path);
        let folder = target.parent().expect("a file lies in a folder");
        fs::create_dir_all(folder).expect("writable");
        fs::write(target, bytes).expect("writable");
    }
}

fn fault(kind: &str, error: &dyn std::fmt::Display) -> Fault {
    Fault::new(kind, error.to_string())
}

/// The program at work.
pub(crate) struct Running(Child);

/// How the program ended.
pub(crate) struct Ended {
    /// Exit code, or 128 and the signal.
    pub(crate) code: i32,
    /// Standard error.
    pub(crate) talk: String,
}

impl Running {
    /// Kills it now.
    pub(crate) fn kill(&mut self) {
        // It may have ended by itself.
        let _ = self.0.kill();
    }

    /// Sends it a signal by name, such as `INT`.
    pub(crate) fn signal(&self, name: &str) {
        let sent = Command::new("kill")
            .args([format!("-{name}"), self.0.id().to_string()])
            .stderr(Stdio::null())
            .status();
        // It may have ended by itself.
        drop(sent);
    }

    /// Waits for its end.
    pub(crate) fn end(self) -> Ended {
        let output = self.0.wait_with_output().expect("the program ends");
        let signal = {
            #[cfg(unix)]
            {
                use std::os::unix::process::ExitStatusExt as _;
                output.status.signal()
            }
            #[cfg(not(unix))]
            {
                None::<i32>
            }
        };
        Ended {
            code: signal.map_or_else(|| code(&output), |signal| 128 + signal),
            talk: stdout(&output) + &stderr(&output),
        }
    }
}
