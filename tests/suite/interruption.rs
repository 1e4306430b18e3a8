//! What is left of a suite, and of its verdict, when the reader of its output goes, a signal comes,
//! a file grows too large, threads run out or a run breaks an invariant.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::time::{Duration, Instant};

use fogbench::experiment::{
    Observer, Progress, SuiteError, SuiteOptions, SuiteOutcome, plan_suite, run_suite,
};
use fogbench::report::{RunOutcome, RunReport, RunStatus};
use serde_json::Value;

use crate::support::{scratch, write};

/// A second of the rate model.
const SHORT: &str = "duration_s = 1.0\nwarm_up_s = 0.5\nfidelity = \"rate\"\n";

/// How long a block waits for another run to end.
const PATIENCE: Duration = Duration::from_secs(60);

fn scenario(folder: &Path, name: &str, text: &str) -> PathBuf {
    let text = format!("schema = 1\nname = \"{name}\"\n{text}");
    write(folder, &format!("{name}.toml"), &text)
}

fn suite_summary(output: &Path) -> Value {
    let text = std::fs::read_to_string(output.join("summary.json")).expect("a summary");
    serde_json::from_str(&text).expect("JSON")
}

/// Folder and status of every run of a suite.
fn statuses(output: &Path) -> Vec<(String, String)> {
    let summary = suite_summary(output);
    let word = |run: &Value, key: &str| run[key].as_str().expect("a word").to_owned();
    let runs = summary["runs"].as_array().expect("runs").iter();
    runs.map(|run| (word(run, "folder"), word(run, "status")))
        .collect()
}

fn pair(folder: &str, status: &str) -> (String, String) {
    (folder.to_owned(), status.to_owned())
}

/// Where an observer does something to a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    /// In the first block of a repeat after the first.
    LaterRepeat,
    /// Where the run is reported.
    Finished,
    /// Where its failure is reported.
    Failed,
}

/// Breaks an invariant in one place.
struct Breaks {
    place: Place,
    blocks: AtomicU32,
}

impl Progress for Breaks {
    fn advanced(&self, _simulated_s: f64) {
        let block = self.blocks.fetch_add(1, Ordering::SeqCst);
        assert!(
            self.place != Place::LaterRepeat || block != 2,
            "planted fault"
        );
    }
}

impl Observer for Breaks {
    fn finished(&self, _index: usize, report: &RunReport) {
        let breaks = self.place != Place::LaterRepeat && report.scenario.name == "broken";
        assert!(!breaks, "planted fault");
    }

    fn failed(&self, _index: usize, _outcome: &RunOutcome) {
        assert!(self.place != Place::Failed, "planted fault, once more");
    }
}

#[test]
fn a_panic_anywhere_fails_one_run_and_the_suite_has_its_verdict() {
    for place in [Place::LaterRepeat, Place::Finished, Place::Failed] {
        let folder = scratch();
        let paths = [
            scenario(folder.path(), "broken", &format!("repeats = 4\n{SHORT}")),
            scenario(folder.path(), "fine", SHORT),
        ];
        let plans = plan_suite(&paths, &[]).expect("sound scenarios");
        let options = SuiteOptions {
            threads: 2,
            ..SuiteOptions::new(folder.path().join("out"))
        };
        let observer = Breaks {
            place,
            blocks: AtomicU32::new(0),
        };
        let outcome = run_suite(&plans, &options, &observer).expect("a writable folder");
        assert!(outcome.broken, "{place:?}");
        let ended = statuses(&options.output);
        // Which run is in its third block depends on the threads; that it is one does not.
        let failed = ended.iter().filter(|(_, status)| status == "run_failed");
        assert_eq!(failed.count(), 1, "{place:?}: {ended:?}");
        assert_eq!(ended.iter().filter(|(_, it)| it == "pass").count(), 1);
        let junit = std::fs::read_to_string(options.output.join("junit.xml")).expect("written");
        assert!(junit.contains("planted fault"), "{place:?}: {junit}");
    }
}

/// Stops the suite once its runs have simulated for `stop_s`, or one of them has finished.
struct Stops {
    stop_s: f64,
    /// A run whose blocks are longer waits for another that ends first, whatever the threads do.
    waits_beyond_s: f64,
    advanced_s: Mutex<f64>,
    stopped: AtomicBool,
    finished: AtomicU32,
}

impl Stops {
    fn after(stop_s: f64) -> Self {
        Self {
            stop_s,
            waits_beyond_s: f64::INFINITY,
            advanced_s: Mutex::new(0.0),
            stopped: AtomicBool::new(false),
            finished: AtomicU32::new(0),
        }
    }
}

impl Progress for Stops {
    fn advanced(&self, simulated_s: f64) {
        let mut advanced_s = self.advanced_s.lock().expect("nothing panics here");
        *advanced_s += simulated_s;
        self.stopped
            .fetch_or(*advanced_s >= self.stop_s, Ordering::SeqCst);
        drop(advanced_s);
        let began = Instant::now();
        while simulated_s > self.waits_beyond_s && !self.should_stop() && began.elapsed() < PATIENCE
        {
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    fn should_stop(&self) -> bool {
        self.stopped.load(Ordering::SeqCst)
    }
}

impl Observer for Stops {
    fn finished(&self, _index: usize, _report: &RunReport) {
        self.finished.fetch_add(1, Ordering::SeqCst);
        self.stopped.store(true, Ordering::SeqCst);
    }

    fn failed(&self, _index: usize, outcome: &RunOutcome) {
        panic!("a stopped run has not failed: {:?}", outcome.error);
    }
}

#[test]
fn a_suite_stops_between_blocks_repeats_and_channels_and_says_what_has_not_run() {
    // Half-way through the record, before the measurement, and among the repeats.
    for (repeats, stop_s) in [(1, 10.0), (1, 20.4), (50, 60.0)] {
        let folder = scratch();
        let text = format!(
            "repeats = {repeats}\nduration_s = 20.0\nwarm_up_s = 0.5\nfidelity = \"rate\"\n"
        );
        let path = scenario(folder.path(), "long", &text);
        let plans = plan_suite(&[path], &[]).expect("a sound scenario");
        let options = SuiteOptions {
            threads: 2,
            ..SuiteOptions::new(folder.path().join("out"))
        };
        let observer = Stops::after(stop_s);
        let outcome = run_suite(&plans, &options, &observer).expect("a writable folder");
        assert!(!outcome.broken);
        assert_eq!(outcome.runs[0].status(), RunStatus::NotRun);
        assert_eq!(observer.finished.load(Ordering::SeqCst), 0);
        let advanced_s = *observer.advanced_s.lock().expect("nothing panics here");
        // Two threads may each be in a block of four seconds.
        assert!(advanced_s < stop_s + 10.0, "{advanced_s} s after {stop_s}");
        assert_eq!(statuses(&options.output), [pair("long", "not_run")]);
        assert!(
            !options.output.join("long").exists(),
            "a stopped run has no folder"
        );
    }
}

#[test]
fn what_ended_before_a_stop_stays_and_a_stopped_campaign_has_not_failed() {
    let folder = scratch();
    let base = crate::support::repository("scenarios/base/patent.toml");
    let campaign = format!(
        "extends = \"{}\"\nduration_s = 6480.0\n[turntable.calibration]\n\
         axes = [\"x\", \"x\", \"y\", \"y\", \"z\", \"z\"]\n\
         rates_deg_per_s = [10.0, -90.0, 50.0, 20.0, 90.0, -10.0]\n",
        base.display()
    );
    scenario(folder.path(), "campaign", &campaign);
    let compensated = format!(
        "extends = \"{}\"\n{SHORT}[compensation]\ncampaign = \"campaign.toml\"\n",
        base.display()
    );
    let paths = [
        scenario(folder.path(), "a-first", SHORT),
        scenario(folder.path(), "compensated", &compensated),
    ];
    let plans = plan_suite(&paths, &[]).expect("sound scenarios");
    let options = SuiteOptions {
        threads: 2,
        ..SuiteOptions::new(folder.path().join("out"))
    };
    let observer = Stops {
        waits_beyond_s: 2.0,
        ..Stops::after(f64::INFINITY)
    };
    let outcome = run_suite(&plans, &options, &observer).expect("a writable folder");
    assert!(!outcome.broken);
    assert_eq!(
        statuses(&options.output),
        [pair("a-first", "pass"), pair("compensated", "not_run")]
    );
    assert!(options.output.join("a-first/summary.json").is_file());
    assert_eq!(suite_summary(&options.output)["totals"]["runs"], 2);
    let junit = std::fs::read_to_string(options.output.join("junit.xml")).expect("written");
    assert!(
        junit.contains("<skipped") && junit.contains("not_run"),
        "{junit}"
    );
}

/// Wants to stop in the middle of a stage that does not end before the suite gives it up.
struct Stuck {
    output: PathBuf,
    is_stopped: AtomicBool,
    is_abandoned: AtomicBool,
}

impl Progress for Stuck {
    fn advanced(&self, _simulated_s: f64) {
        self.is_stopped.store(true, Ordering::SeqCst);
        while !self.is_abandoned.load(Ordering::SeqCst) {
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    fn should_stop(&self) -> bool {
        // Once given up, the run would like to go on: the ledger must not take it.
        self.is_stopped.load(Ordering::SeqCst) && !self.is_abandoned.load(Ordering::SeqCst)
    }
}

impl Observer for Stuck {
    fn abandoned(&self, result: &Result<SuiteOutcome, SuiteError>) {
        let outcome = result.as_ref().expect("a writable folder");
        assert_eq!(outcome.runs[0].status(), RunStatus::NotRun);
        assert_eq!(statuses(&self.output), [pair("stuck", "not_run")]);
        self.is_abandoned.store(true, Ordering::SeqCst);
    }
}

#[test]
fn a_run_that_is_given_up_writes_nothing_more() {
    let folder = scratch();
    let path = scenario(folder.path(), "stuck", SHORT);
    let plans = plan_suite(&[path], &[]).expect("a sound scenario");
    let output = folder.path().join("out");
    let options = SuiteOptions {
        threads: 1,
        ..SuiteOptions::new(output.clone())
    };
    let observer = Stuck {
        output: output.clone(),
        is_stopped: AtomicBool::new(false),
        is_abandoned: AtomicBool::new(false),
    };
    let outcome = run_suite(&plans, &options, &observer).expect("a writable folder");
    assert!(observer.is_abandoned.load(Ordering::SeqCst));
    assert_eq!(outcome.runs[0].status(), RunStatus::NotRun);
    assert!(!output.join("stuck").exists(), "written after the verdict");
    assert_eq!(statuses(&output), [pair("stuck", "not_run")]);
}

/// The program under signals, limits and lost readers.
#[cfg(target_os = "linux")]
mod process {
    use std::io::Read;
    use std::process::{Child, Command, Stdio};

    use super::*;
    use crate::support::{code, fogbench, repository, stderr, stdout};

    const INTERRUPT: u32 = 2;
    const HANG_UP: u32 = 1;
    const TERMINATE: u32 = 15;

    /// A loop run of an hour: minutes of work.
    const LONG: &str = "duration_s = 3600.0\nwarm_up_s = 1.0\nfidelity = \"loop\"\n";

    /// The program with the signals as a terminal leaves them, whatever this test was started under.
    fn program(folder: &Path, arguments: &[&str]) -> Command {
        let mut command = Command::new("env");
        let signals = [INTERRUPT, HANG_UP, TERMINATE];
        if signals
            .iter()
            .any(|signal| holds("self", "SigIgn", *signal))
        {
            command.arg("--default-signal=HUP,INT,TERM");
        }
        command
            .arg(env!("CARGO_BIN_EXE_fogbench"))
            .args(arguments)
            .current_dir(folder)
            .env("NO_COLOR", "1")
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped());
        command
    }

    /// A line of `/proc/<process>/status`.
    fn status(process: &str, key: &str) -> Option<String> {
        let text = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
        let mut lines = text.lines();
        let line = lines.find_map(|line| line.strip_prefix(key)?.strip_prefix(':'))?;
        Some(line.trim().to_owned())
    }

    /// Whether a set of signals of a process holds `signal`.
    fn holds(process: &str, set: &str, signal: u32) -> bool {
        let bits = status(process, set).and_then(|set| u64::from_str_radix(&set, 16).ok());
        bits.is_some_and(|bits| bits >> (signal - 1) & 1 == 1)
    }

    /// Waits for what a running program does.
    #[track_caller]
    fn wait_until(child: &mut Child, what: &str, mut is_so: impl FnMut() -> bool) {
        let start = Instant::now();
        while !is_so() {
            let ended = child.try_wait().expect("a child");
            assert!(ended.is_none(), "ended before it was {what}: {ended:?}");
            assert!(start.elapsed() < Duration::from_secs(120), "never {what}");
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    fn send(child: &Child, signal: u32) {
        let sent = Command::new("sh")
            .arg("-c")
            .arg(format!("kill -{signal} {}", child.id()))
            .status();
        assert!(sent.expect("a shell").success());
    }

    /// Starts the program and waits until it has its handlers.
    fn start(folder: &Path, arguments: &[&str]) -> Child {
        let mut child = program(folder, arguments).spawn().expect("it starts");
        let process = child.id().to_string();
        wait_until(&mut child, "ready", || holds(&process, "SigCgt", TERMINATE));
        child
    }

    /// Exit code and stderr of a program that ends within ten seconds; a quiet machine takes two.
    #[track_caller]
    fn end(mut child: Child) -> (i32, String) {
        let start = Instant::now();
        let status = loop {
            if let Some(status) = child.try_wait().expect("a child") {
                break status;
            }
            if start.elapsed() > Duration::from_secs(10) {
                child.kill().expect("a child");
                panic!("still running ten seconds after the signal");
            }
            std::thread::sleep(Duration::from_millis(10));
        };
        let mut talk = String::new();
        let mut stream = child.stderr.take().expect("piped");
        stream.read_to_string(&mut talk).expect("UTF-8");
        let code = status.code();
        (
            code.unwrap_or_else(|| panic!("{status}, no exit code: {talk}")),
            talk,
        )
    }

    #[test]
    fn every_signal_has_its_exit_code_and_what_is_finished_stays() {
        for (signal, expected) in [(INTERRUPT, 130), (TERMINATE, 143), (HANG_UP, 129)] {
            let folder = scratch();
            scenario(folder.path(), "done", SHORT);
            scenario(folder.path(), "long", LONG);
            let mut child = start(folder.path(), &["run", "done.toml", "long.toml", "-j", "2"]);
            let output = folder.path().join("output");
            wait_until(&mut child, "at work", || {
                output.join("done/summary.json").is_file()
            });
            send(&child, signal);
            let (code, talk) = end(child);
            assert_eq!(code, expected, "{talk}");
            assert_eq!(
                statuses(&output),
                [pair("done", "pass"), pair("long", "not_run")]
            );
            let said = "interrupted: 1 of 2 runs finished; the same command with --resume goes on";
            assert!(talk.lines().any(|line| line == said), "{talk}");
            assert_eq!(suite_summary(&output)["totals"]["not_run"], 1);
            let junit = std::fs::read_to_string(output.join("junit.xml")).expect("written");
            assert!(
                junit.contains("tests=\"2\" failures=\"0\" errors=\"0\"")
                    && junit.matches("skipped=\"1\"").count() == 1,
                "{junit}"
            );
        }
    }

    /// Every kind of motion, each in an hour or so, and many repeats.
    fn kinds() -> Vec<(&'static str, String)> {
        let hour = "duration_s = 3600.0\nwarm_up_s = 1.0\n";
        let motion = |table: &str, keys: &str| format!("{hour}[turntable.{table}]\n{keys}\n");
        let base = repository("scenarios/base/patent.toml");
        let campaign = format!(
            "extends = \"{}\"\nrepeats = 1000\nduration_s = 6480.0\n[turntable.calibration]\n\
             axes = [\"x\", \"x\", \"y\", \"y\", \"z\", \"z\"]\n\
             rates_deg_per_s = [10.0, -90.0, 50.0, 20.0, 90.0, -10.0]\n",
            base.display()
        );
        let swing = "rate_amplitude_deg_per_s = 1.0\nfrequency_hz = 5.0";
        let tones = "frequencies_hz = [1.0, 3.0]\nrate_amplitudes_deg_per_s = [1.0]";
        let test = "from_deg_per_s = 0.1\nto_deg_per_s = 100.0\ndwell_s = 10.0\nstatic_s = 10.0";
        let trapezoid = "rate_deg_per_s = 10.0\nacceleration_deg_per_s2 = 10.0\nhold_s = 1.0";
        let chirp = "rate_amplitude_deg_per_s = 1.0\nstart_frequency_hz = 1.0\n\
             end_frequency_hz = 5.0\nsweep_s = 100.0";
        let script = "time_s = [0.0, 7200.0]\nrate_deg_per_s = [0.0, 1.0]";
        vec![
            ("static", motion("static", "")),
            ("swing", motion("swing", swing)),
            ("multi-sine", motion("multi_sine", tones)),
            (
                "steps",
                motion("steps", "rates_deg_per_s = [0.0, 9.0]\ndwell_s = 9.0"),
            ),
            ("scale-factor-test", motion("scale_factor_test", test)),
            ("rotation", motion("rotation", "rate_deg_per_s = 10.0")),
            ("trapezoid", motion("trapezoid", trapezoid)),
            ("chirp", motion("chirp", chirp)),
            (
                "test-signal",
                motion(
                    "test_signal",
                    "shape = \"blocks\"\nrate_amplitude_deg_per_s = 1.0\nlength_s = 100.0",
                ),
            ),
            ("script", motion("script.points", script)),
            ("calibration", campaign),
            (
                "repeats",
                "repeats = 10000\nduration_s = 5.0\nwarm_up_s = 1.0\n".to_owned(),
            ),
        ]
    }

    #[test]
    fn every_motion_fidelity_and_number_of_repeats_stops() {
        let signals = [(INTERRUPT, 130), (TERMINATE, 143), (HANG_UP, 129)];
        let mut signals = signals.into_iter().cycle();
        for (name, text) in kinds() {
            for fidelity in ["loop", "rate"] {
                let (signal, expected) = signals.next().expect("a cycle");
                let folder = scratch();
                let text = format!("fidelity = \"{fidelity}\"\n{text}");
                let file = scenario(folder.path(), name, &text);
                let mut child = start(folder.path(), &["run", &file.to_string_lossy()]);
                wait_until(&mut child, "at work", || {
                    folder.path().join("output").is_dir()
                });
                std::thread::sleep(Duration::from_millis(200));
                send(&child, signal);
                let (code, talk) = end(child);
                assert_eq!(code, expected, "{name}, {fidelity}: {talk}");
                let output = folder.path().join("output");
                assert_eq!(
                    statuses(&output),
                    [pair(name, "not_run")],
                    "{name}, {fidelity}: {talk}"
                );
            }
        }
    }

    #[test]
    fn a_reader_that_stalls_does_not_hold_up_the_end() {
        for signals in [1, 2] {
            let folder = scratch();
            for index in 0..6 {
                scenario(folder.path(), &format!("s{index}"), SHORT);
            }
            scenario(folder.path(), "z", LONG);
            let arguments = ["run", ".", "--format", "jsonl", "-j", "2"];
            let mut command = program(folder.path(), &arguments);
            let child = command.stdout(Stdio::piped()).spawn();
            let mut child = child.expect("it starts");
            let output = folder.path().join("output");
            // Four summaries are more than a pipe holds, and nobody reads them.
            wait_until(&mut child, "at work", || {
                let finished =
                    |index: &u32| output.join(format!("s{index}/summary.json")).is_file();
                (0..6).filter(finished).count() >= 4
            });
            send(&child, TERMINATE);
            if signals == 1 {
                let (code, talk) = end(child);
                assert_eq!(code, 143, "{talk}");
                assert!(talk.contains(" of 7 runs finished"), "{talk}");
                assert_eq!(statuses(&output)[6], pair("z", "not_run"));
            } else {
                // Signals sent while one of their kind waits for its delivery are one signal: on a busy
                // machine the second has to come again.
                for _ in 0..10 {
                    std::thread::sleep(Duration::from_millis(100));
                    if child.try_wait().expect("a child").is_some() {
                        break;
                    }
                    send(&child, TERMINATE);
                }
                let (code, talk) = end(child);
                assert_eq!(code, 143, "{talk}");
                assert!(
                    !talk.contains("ended before everything was written"),
                    "it waited for the deadline: {talk}"
                );
            }
        }
    }

    #[test]
    fn other_commands_end_at_a_signal() {
        let folder = scratch();
        let kinds = kinds();
        let campaign = kinds.iter().find(|(name, _)| *name == "calibration");
        let (_, campaign) = campaign.expect("a kind of motion");
        scenario(folder.path(), "campaign", campaign);
        let values: Vec<String> = (1..=5000).map(|step| format!("{step}.0")).collect();
        let matrix = format!(
            "{SHORT}[matrix]\n\"gyro.source.power_uw\" = [{}]\n",
            values.join(", ").replace(".0", "e-3")
        );
        scenario(folder.path(), "matrix", &matrix);
        for (arguments, signal, expected) in [
            (["calibrate", "campaign.toml"], INTERRUPT, 130),
            (["check", "matrix.toml"], HANG_UP, 129),
            (["run", "matrix.toml"], TERMINATE, 143),
        ] {
            let child = start(folder.path(), &arguments);
            std::thread::sleep(Duration::from_millis(20));
            send(&child, signal);
            let (code, talk) = end(child);
            assert_eq!(code, expected, "{arguments:?}: {talk}");
        }
    }

    #[test]
    fn a_signal_that_was_ignored_stays_ignored() {
        let folder = scratch();
        scenario(folder.path(), "a", &format!("repeats = 20\n{SHORT}"));
        let mut child = Command::new("sh")
            .args(["-c", "trap '' HUP; exec \"$0\" \"$@\""])
            .arg(env!("CARGO_BIN_EXE_fogbench"))
            .args(["run", "a.toml"])
            .current_dir(folder.path())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .expect("it starts");
        let process = child.id().to_string();
        wait_until(&mut child, "ready", || holds(&process, "SigCgt", TERMINATE));
        assert!(holds(&process, "SigIgn", HANG_UP) && !holds(&process, "SigCgt", HANG_UP));
        send(&child, HANG_UP);
        let output = child.wait_with_output().expect("it ends");
        assert_eq!(code(&output), 0, "{}", stderr(&output));
    }

    #[test]
    fn a_reader_that_goes_ends_the_printing_and_not_the_verdict() {
        let folder = scratch();
        let gate = "[[gate]]\nmetric = \"raw.mean_deg_per_h\"\nmax = 1.0\n";
        scenario(folder.path(), "fails", &format!("{SHORT}{gate}"));
        let longer = SHORT.replace("1.0", "2.0").replace("0.5", "1.0");
        let wrong = "[[filter]]\nname = \"wrong\"\n[filter.rls]\nupdate_sign = \"as-printed\"\n";
        scenario(folder.path(), "diverges", &format!("{longer}{wrong}"));
        scenario(folder.path(), "passes", SHORT);
        let log: String = (0..4000)
            .map(|index| format!("{}\n", 8.0 + f64::from(index * 7919 % 101) * 0.4))
            .collect();
        write(folder.path(), "log.csv", &log);
        let filter = [
            "filter",
            "log.csv",
            "--filters",
            "diverges.toml",
            "--unit",
            "deg/h",
            "--rate-hz",
            "3989.0",
        ];
        let cases: [(&[&str], i32); 7] = [
            (&["run", "fails.toml"], 1),
            (&["run", "diverges.toml"], 3),
            (&["run", "passes.toml"], 0),
            (&["run", "fails.toml", "diverges.toml", "passes.toml"], 3),
            (&["run", "passes.toml", "--format", "jsonl"], 0),
            (&["check", "passes.toml"], 0),
            (&["check", "absent.toml"], 2),
        ];
        for (arguments, expected) in cases.into_iter().chain([(&filter[..], 3)]) {
            let heard = fogbench(folder.path(), arguments);
            assert_eq!(code(&heard), expected, "{arguments:?}: {}", stderr(&heard));
            let mut child = program(folder.path(), arguments)
                .stdout(Stdio::piped())
                .spawn()
                .expect("it starts");
            drop(child.stdout.take());
            let (code, talk) = end(child);
            assert_eq!(code, expected, "{arguments:?} into a closed pipe: {talk}");
            assert!(!talk.contains("roken pipe"), "{talk}");
            let full = std::fs::File::options().write(true).open("/dev/full");
            let output = program(folder.path(), arguments)
                .stdout(full.expect("Linux has it"))
                .output()
                .expect("it starts");
            let prints = !stdout(&heard).is_empty();
            let expected = if prints { 74 } else { expected };
            assert_eq!(output.status.code(), Some(expected), "{arguments:?}");
            let says = stderr(&output).contains("cannot write to standard output: ");
            assert_eq!(says, prints, "{arguments:?}");
        }
    }

    #[test]
    fn a_suite_has_its_verdict_whatever_the_stack_of_the_shell() {
        let folder = scratch();
        scenario(folder.path(), "a", SHORT);
        let output = Command::new("sh")
            .args(["-c", "ulimit -s 64; exec \"$0\" run a.toml"])
            .arg(env!("CARGO_BIN_EXE_fogbench"))
            .current_dir(folder.path())
            .output()
            .expect("it starts");
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert!(folder.path().join("output/junit.xml").exists());
    }

    #[test]
    fn a_file_beyond_the_size_limit_fails_its_run_and_the_suite_has_its_verdict() {
        let folder = scratch();
        let long = "duration_s = 60.0\nwarm_up_s = 0.5\nfidelity = \"rate\"\n[output]\nsamples = \"npy\"\n";
        scenario(folder.path(), "a", long);
        let gate = "[[gate]]\nmetric = \"raw.mean_deg_per_h\"\nmax = 1.0\n";
        scenario(folder.path(), "b", &format!("{SHORT}{gate}"));
        let run = |limit: &str| {
            let output = Command::new("sh")
                .args([
                    "-c",
                    &format!("{limit}; exec \"$0\" run a.toml b.toml -j 1"),
                ])
                .arg(env!("CARGO_BIN_EXE_fogbench"))
                .current_dir(folder.path())
                .output()
                .expect("it starts");
            (output.status.code(), stderr(&output))
        };
        assert_eq!(run("true").0, Some(1));
        let before = std::fs::read(folder.path().join("output/a/manifest.toml")).expect("written");
        let (code, talk) = run("ulimit -f 1000");
        assert_eq!(code, Some(74), "{talk}");
        assert!(
            talk.contains("error: a: ") && talk.contains("File too large"),
            "{talk}"
        );
        let output = folder.path().join("output");
        assert_eq!(
            statuses(&output),
            [pair("a", "run_failed"), pair("b", "gate_failed")]
        );
        let suite = suite_summary(&output);
        let reason = suite["runs"][0]["error"].as_str().expect("a reason");
        assert!(
            reason.contains("a/samples") || reason.contains(".npy"),
            "{reason}"
        );
        assert_eq!(suite["stale"], serde_json::json!(["a"]));
        let after = std::fs::read(output.join("a/manifest.toml")).expect("it stays");
        assert!(before == after, "the earlier result stands");
        let junit = std::fs::read_to_string(output.join("junit.xml")).expect("written");
        assert!(junit.contains("File too large"), "{junit}");
    }

    #[test]
    fn threads_are_capped_whatever_the_environment_says() {
        let folder = scratch();
        scenario(folder.path(), "long", LONG);
        let mut command = program(folder.path(), &["run", "long.toml"]);
        let child = command.env("RAYON_NUM_THREADS", "100000000").spawn();
        let mut child = child.expect("it starts");
        let process = child.id().to_string();
        let threads = || {
            let threads = status(&process, "Threads")?;
            threads.parse::<usize>().ok()
        };
        wait_until(&mut child, "at work", || {
            threads().is_some_and(|count| count > 200)
        });
        std::thread::sleep(Duration::from_millis(200));
        let count = threads().expect("it runs");
        send(&child, TERMINATE);
        let (code, talk) = end(child);
        assert_eq!(code, 143, "{talk}");
        assert!(count <= 256 + 3, "{count} threads");
    }

    #[test]
    fn a_senseless_number_of_threads_is_one_per_core() {
        let folder = scratch();
        scenario(folder.path(), "a", SHORT);
        for word in ["", "0", "-3", "many", "99999999999999999999999999"] {
            let mut command = program(folder.path(), &["run", "a.toml"]);
            let output = command.env("RAYON_NUM_THREADS", word).output();
            assert_eq!(output.expect("it starts").status.code(), Some(0), "{word}");
        }
    }

    #[test]
    fn a_system_without_room_for_threads_gives_fewer_or_none() {
        let folder = scratch();
        scenario(folder.path(), "a", SHORT);
        for kilobytes in [60_000, 150_000, 300_000, 900_000] {
            let script = format!("ulimit -v {kilobytes}; exec \"$0\" run a.toml -j 256");
            let output = Command::new("sh")
                .args(["-c", &script])
                .arg(env!("CARGO_BIN_EXE_fogbench"))
                .current_dir(folder.path())
                .output()
                .expect("it starts");
            let (code, talk) = (output.status.code(), stderr(&output));
            let fewer = code == Some(0) && talk.contains(" of 256 threads");
            let none = code == Some(74) && talk.contains("cannot start a thread");
            assert!(fewer || none, "{kilobytes} kB: {code:?}, {talk}");
        }
    }
}
