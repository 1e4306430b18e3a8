//! Programs of the user's in the place of a filter: their words, their misbehaviour and their end.
#![cfg(unix)]

mod twins;

use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::support::{code, fogbench, npy, repository, stderr, stdout, summary, tree, write};

const HEAD: &str =
    "schema = 1\nname = \"s\"\nduration_s = 2.5\nwarm_up_s = 0.5\nfidelity = \"rate\"\n";

/// Whether a program that the tests need is there; its lack is a failure where everything must run.
fn has(program: &str) -> bool {
    let found = Command::new(program)
        .arg("--version")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    let is_there = found.is_ok_and(|status| status.success());
    if !is_there {
        eprintln!("skipped: there is no {program}");
        assert!(
            std::env::var_os("CI").is_none(),
            "{program} is missing under CI"
        );
    }
    is_there
}

/// A folder with the clients of `examples/process`.
fn scratch() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let clients = repository("examples/process");
    for entry in std::fs::read_dir(clients).expect("readable").flatten() {
        // A client that a test has run may have left its cache.
        if entry.path().is_file() {
            std::fs::copy(entry.path(), folder.path().join(entry.file_name())).expect("copied");
        }
    }
    folder
}

/// A filter that is a program, with more keys of it.
fn program(name: &str, command: &str, more: &str) -> String {
    format!("[[filter]]\nname = \"{name}\"\n[filter.process]\ncommand = {command}\n{more}\n")
}

fn run(folder: &Path, text: &str, more: &[&str]) -> Output {
    write(folder, "s.toml", text);
    fogbench(folder, &[&["run", "s.toml", "-o", "out"], more].concat())
}

#[track_caller]
fn allowed(folder: &Path, text: &str, exit: i32) -> Value {
    let output = run(folder, text, &["--allow-programs"]);
    assert_eq!(
        code(&output),
        exit,
        "{}{}",
        stdout(&output),
        stderr(&output)
    );
    summary(&folder.join("out"), "s")
}

/// A Python program that begins as it should, and then does something.
fn misbehaving(folder: &Path, then: &str) {
    let text = format!(
        "import os, struct, sys, time\n\
         i, o = sys.stdin.buffer, sys.stdout.buffer\n\
         def say(b): o.write(b); o.flush()\n\
         def hello(): i.readline(); say(b'{{\"fogbench_filter\": 1, \"name\": \"x\", \"version\": \"1\"}}\\n')\n\
         def block():\n    n = struct.unpack('<I', i.read(4))[0]\n    return n, i.read(8 * n)\n\
         def rest():\n    while True:\n        n, b = block()\n        if n == 0: sys.exit(0)\n        say(struct.pack('<I', n) + b)\n\
         {then}\n"
    );
    write(folder, "bad.py", &text);
}

/// Numbers of the processes whose command holds a text.
fn processes(mark: &str) -> Vec<String> {
    let entries = std::fs::read_dir("/proc").into_iter().flatten().flatten();
    let with_mark = entries.filter_map(|entry| {
        let name = entry.file_name().into_string().ok()?;
        name.parse::<u32>().ok()?;
        let command = std::fs::read(entry.path().join("cmdline")).ok()?;
        let command = String::from_utf8_lossy(&command).into_owned();
        command.contains(mark).then_some(name)
    });
    with_mark.collect()
}

/// Waits until no process holds a text in its command.
#[track_caller]
fn nothing_is_left(mark: &str) {
    let began = Instant::now();
    while !processes(mark).is_empty() {
        assert!(began.elapsed() < Duration::from_secs(8), "{mark} lives on");
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn a_mean_in_python_and_in_c_is_that_of_the_bench_to_the_bit_and_in_every_figure() {
    if !has("python3") || !has("cc") {
        return;
    }
    let folder = scratch();
    let built = Command::new("cc")
        .args(["-O2", "-ffp-contract=off", "-o", "mean", "mean.c"])
        .current_dir(folder.path())
        .status();
    assert!(built.expect("cc starts").success());
    let own = "[[filter]]\nname = \"own\"\n[filter.moving_average]\ntaps = 8\n";
    let taps = "parameters = { taps = 8 }\nblock_samples = 1000";
    let python = program("python", "[\"python3\", \"./mean.py\"]", taps);
    let c = program("c", "[\"./mean\"]", &format!("{taps}\nmode = \"record\""));
    let samples = "[output]\nsamples = \"npy\"\n";
    let run = allowed(
        folder.path(),
        &format!("{HEAD}{own}{python}{c}{samples}"),
        0,
    );
    let words = |name: &str| npy(&folder.path().join(format!("out/s/samples/{name}.npy")));
    let bits = |name: &str| {
        words(name)
            .into_iter()
            .map(f64::to_bits)
            .collect::<Vec<_>>()
    };
    let channel = |name: &str| {
        let mut channel = run["channels"][name].clone();
        let verdict = channel["verdict"].as_str().expect("a verdict");
        channel["verdict"] = verdict.replace(&format!("{name}: "), "").into();
        channel
    };
    for other in ["python", "c"] {
        assert_eq!(bits(other), bits("own"), "{other}");
        assert_eq!(channel(other), channel("own"), "{other}");
    }
}

#[test]
fn a_mean_in_octave_is_that_of_the_bench_but_for_the_order_of_its_sums() {
    if Command::new("octave-cli")
        .arg("--version")
        .output()
        .is_err()
    {
        eprintln!("skipped: there is no octave-cli");
        return;
    }
    let folder = scratch();
    let own = "[[filter]]\nname = \"own\"\n[filter.moving_average]\ntaps = 8\n";
    let command = "[\"octave-cli\", \"--quiet\", \"--no-init-file\", \"./mean.m\"]";
    let octave = program("octave", command, "parameters = { taps = 8 }");
    let samples = "[output]\nsamples = \"npy\"\n";
    allowed(folder.path(), &format!("{HEAD}{own}{octave}{samples}"), 0);
    let words = |name: &str| npy(&folder.path().join(format!("out/s/samples/{name}.npy")));
    for (octave, own) in words("octave").into_iter().zip(words("own")) {
        assert!(
            (octave - own).abs() <= 1e-12 * own.abs().max(1.0),
            "{octave} {own}"
        );
    }
}

#[test]
fn recursive_least_squares_in_python_have_the_words_and_the_gain_of_the_bench() {
    if !has("python3") {
        return;
    }
    let folder = scratch();
    let own = "[[filter]]\nname = \"own\"\n[filter.rls]\nforgetting_factor = 0.99\n";
    let forgetting = "parameters = { forgetting_factor = 0.99 }";
    let python = program("python", "[\"python3\", \"./rls.py\"]", forgetting);
    let samples = "[output]\nsamples = \"npy\"\n";
    let run = allowed(folder.path(), &format!("{HEAD}{own}{python}{samples}"), 0);
    let words = |name: &str| npy(&folder.path().join(format!("out/s/samples/{name}.npy")));
    let bits = |name: &str| {
        words(name)
            .into_iter()
            .map(f64::to_bits)
            .collect::<Vec<_>>()
    };
    assert_eq!(bits("python"), bits("own"));
    let gain = |name: &str| run["channels"][name]["dc_gain_adapted"]["value"].clone();
    let [python, own] = ["python", "own"].map(|name| gain(name).as_f64().expect("a gain"));
    assert!((python - own).abs() < 1e-9, "{python} {own}");
    let lack = &run["channels"]["python"]["unavailable"]["dc_gain"];
    assert!(
        lack.as_str()
            .expect("a reason")
            .contains("does not show its weights")
    );
}

#[test]
fn nothing_is_started_without_consent_on_the_command_line() {
    let folder = scratch();
    let touch = "[\"sh\", \"-c\", \"touch started; exit 1\"]";
    let mark = folder.path().join("started");
    let touch = touch.replace("started", &mark.to_string_lossy());
    let text = format!("{HEAD}{}", program("p", &touch, ""));
    let output = run(folder.path(), &text, &[]);
    assert_eq!(code(&output), 2);
    let said = stderr(&output);
    assert!(
        said.contains("--allow-programs") && said.contains("touch"),
        "{said}"
    );
    for command in ["check", "expand", "list", "budget"] {
        let output = fogbench(folder.path(), &[command, "s.toml"]);
        assert_eq!(code(&output), 0, "{command}: {}", stderr(&output));
    }
    assert!(!mark.exists() && !folder.path().join("out").exists());
    write(folder.path(), "log.csv", &"1.0\n".repeat(500));
    let filter = [
        "filter",
        "log.csv",
        "--rate-hz",
        "100",
        "--filters",
        "s.toml",
    ];
    assert_eq!(code(&fogbench(folder.path(), &filter)), 2);
    assert!(!mark.exists());
    let output = run(folder.path(), &text, &["--allow-programs"]);
    assert_eq!(code(&output), 3);
    assert!(mark.exists());
    // What is told before names the program by its whole path.
    assert!(
        stderr(&output).contains("filter `p` starts /"),
        "{}",
        stderr(&output)
    );
}

/// What a program does, the kind of failure that it is, and what is said of it.
const MISBEHAVIOUR: [(&str, &str, &str); 18] = [
    (
        "sys.exit(3)",
        "program",
        "ended with exit code 3 before answer to the greeting",
    ),
    (
        "hello(); block(); os.kill(os.getpid(), 11)",
        "program",
        "ended by signal 11",
    ),
    (
        "hello(); block(); time.sleep(600)",
        "time-out",
        "no answer to a block within 0.5 s",
    ),
    (
        "time.sleep(600)",
        "time-out",
        "no answer to the greeting within 0.5 s",
    ),
    (
        "while True: say(b'x' * 65536)",
        "program",
        "it has no end within 65536 bytes",
    ),
    (
        "hello()\nwhile True: say(b'x' * 65536)",
        "program",
        "print to stderr",
    ),
    ("say(b'hello\\n')", "program", "it began with `hello`"),
    (
        "hello(); n, b = block(); say(struct.pack('<I', n + 1) + b)",
        "program",
        "words to",
    ),
    (
        "hello(); n, b = block(); say(struct.pack('<I', 2**32 - 1))",
        "program",
        "words to",
    ),
    (
        "hello(); print('tick', flush=True); rest()",
        "program",
        "print to stderr",
    ),
    (
        "hello(); n, b = block(); say(struct.pack('<I', n) + b[:80] + struct.pack('<d', float('nan')) + b[88:])",
        "program",
        "failed at sample 10: its word is NaN",
    ),
    (
        "hello(); n, b = block(); say(struct.pack('<I', n) + b[:-8]); sys.exit(0)",
        "program",
        "ended without an error before",
    ),
    // More bytes behind the last word, and an end that does not come.
    (
        "hello()\nwhile True:\n    n, b = block()\n    if n == 0: say(b'xy'); break\n    say(struct.pack('<I', n) + b)",
        "program",
        "2 more bytes came behind the last word",
    ),
    (
        "hello()\nwhile True:\n    n, b = block()\n    if n == 0: time.sleep(600)\n    say(struct.pack('<I', n) + b)",
        "time-out",
        "no end behind the last word",
    ),
    (
        "hello()\nwhile True:\n    n, b = block()\n    if n == 0: sys.exit(9)\n    say(struct.pack('<I', n) + b)",
        "program",
        "answered every word and then ended with exit code 9",
    ),
    // It goes on answering, and too slowly.
    (
        "hello(); n, b = block(); say(struct.pack('<I', n))\nfor k in range(600): say(b[k:k + 1]); time.sleep(0.1)",
        "time-out",
        "no answer to a block within 0.5 s",
    ),
    (
        "import signal; signal.signal(signal.SIGTERM, signal.SIG_IGN); hello(); block(); time.sleep(600)",
        "time-out",
        "no answer to a block within 0.5 s",
    ),
    // It reads ahead.
    (
        "hello(); block(); block()",
        "time-out",
        "no answer to a block",
    ),
];

#[test]
fn a_program_that_misbehaves_fails_its_channel_and_no_other() {
    if !has("python3") {
        return;
    }
    let folder = tempfile::tempdir().expect("a scratch folder");
    let head = HEAD
        .replace("2.5", "0.3")
        .replace("warm_up_s = 0.5", "warm_up_s = 0.1");
    let beside = "[[filter]]\nname = \"own\"\n[filter.moving_average]\n";
    for (then, kind, said) in MISBEHAVIOUR {
        misbehaving(folder.path(), then);
        let start_s = if then.starts_with("time.sleep") {
            0.5
        } else {
            30.0
        };
        let bad = program(
            "bad",
            "[\"python3\", \"./bad.py\"]",
            &format!("start_timeout_s = {start_s}\ntimeout_s = 0.5\nblock_samples = 500"),
        );
        let run = allowed(folder.path(), &format!("{head}{bad}{beside}"), 3);
        let error = &run["channels"]["bad"]["error"];
        assert_eq!(error["kind"], kind, "{then}: {error}");
        let message = error["message"].as_str().expect("a message");
        assert!(message.contains(said), "{then}: {message}");
        assert!(
            run["channels"]["own"]["dc_gain"]["value"].is_number(),
            "{then}"
        );
    }
    nothing_is_left(&folder.path().to_string_lossy());
}

#[test]
fn what_a_program_says_goes_to_the_terminal_and_beside_the_results_alone() {
    if !has("python3") {
        return;
    }
    let folder = tempfile::tempdir().expect("a scratch folder");
    misbehaving(
        folder.path(),
        "hello()\nfor k in range(20000): print('line', k, file=sys.stderr)\nsys.stderr.flush(); rest()",
    );
    let text = format!("{HEAD}{}", program("p", "[\"python3\", \"./bad.py\"]", ""));
    let output = run(folder.path(), &text, &["--allow-programs"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let said = stderr(&output);
    assert!(said.contains("s p: line 0\n"), "{said}");
    assert!(
        said.contains("the rest is dropped") && !said.contains("line 19999"),
        "{said}"
    );
    let out = folder.path().join("out");
    let log = std::fs::read_to_string(out.join(".fogbench/programs.log")).expect("written");
    assert!(log.starts_with("s p: line 0\n"), "{log}");
    // The next suite may write there.
    let before = tree(&out.join("s"));
    assert_eq!(code(&run(folder.path(), &text, &["--allow-programs"])), 0);
    assert_eq!(tree(&out.join("s")), before);
}

#[test]
fn a_program_finds_its_inputs_and_parameters_and_a_bare_environment_in_a_fresh_folder() {
    if !has("python3") {
        return;
    }
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(folder.path(), "data/gain.txt", "0.5");
    write(
        folder.path(),
        "gain.py",
        "import json, os, struct, sys\n\
         i, o = sys.stdin.buffer, sys.stdout.buffer\n\
         bench = json.loads(i.readline())\n\
         assert bench['unit'] == 'deg/h' and bench['channel'] == 'raw', bench\n\
         assert bench['parameters'] == {'name': 'x', 'on': True, 'list': [1, 2.5]}, bench\n\
         assert 'SECRET' not in os.environ and os.environ['OMP_NUM_THREADS'] == '1'\n\
         assert os.environ['PYTHONHASHSEED'] == '0'\n\
         assert os.listdir('.') == ['gain.txt'], os.listdir('.')\n\
         gain = float(open('gain.txt').read())\n\
         open('mine.txt', 'w').write('left behind')\n\
         o.write(b'{\"fogbench_filter\": 1, \"name\": \"gain\", \"version\": \"1\"}\\n'); o.flush()\n\
         while True:\n    (n,) = struct.unpack('<I', i.read(4))\n    if n == 0: break\n\
         \x20   words = struct.unpack('<%dd' % n, i.read(8 * n))\n\
         \x20   o.write(struct.pack('<I%dd' % n, n, *[gain * w for w in words])); o.flush()\n",
    );
    let more =
        "inputs = [\"data/gain.txt\"]\nparameters = { name = \"x\", on = true, list = [1, 2.5] }";
    let text = format!(
        "{HEAD}{}",
        program("p", "[\"python3\", \"./gain.py\"]", more)
    );
    write(folder.path(), "s.toml", &text);
    let output = Command::new(env!("CARGO_BIN_EXE_fogbench"))
        .args(["run", "s.toml", "-o", "out", "--allow-programs"])
        .current_dir(folder.path())
        .env("SECRET", "1")
        .output()
        .expect("the program starts");
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let run = summary(&folder.path().join("out"), "s");
    assert_eq!(run["channels"]["p"]["dc_gain"]["value"], 0.5);
    let manifest = std::fs::read_to_string(folder.path().join("out/s/manifest.toml"));
    let manifest = manifest.expect("written");
    assert!(
        manifest.contains("file = \"gain.py\"") && manifest.contains("file = \"data/gain.txt\"")
    );
    // A sweep reaches the names that only the program knows.
    let sets = ["--set", "filter.p.parameters.on=false", "--allow-programs"];
    let output = self::run(folder.path(), &text, &sets);
    assert_eq!(code(&output), 3);
}

#[test]
fn a_changed_program_is_refused_by_its_manifest_and_run_again_by_resume() {
    if !has("python3") {
        return;
    }
    let folder = scratch();
    let mean = program("p", "[\"python3\", \"./mean.py\"]", "");
    let text = format!("{HEAD}{mean}");
    allowed(folder.path(), &text, 0);
    let resume = ["--resume=any-build", "--allow-programs"];
    let output = run(folder.path(), &text, &resume);
    assert!(
        stderr(&output).contains("s: taken over"),
        "{}",
        stderr(&output)
    );
    // Consent is asked for by every command line.
    assert_eq!(code(&run(folder.path(), &text, &["--resume=any-build"])), 2);
    std::fs::create_dir(folder.path().join("again")).expect("writable");
    for name in ["mean.py", "fogbench_filter.py"] {
        std::fs::copy(
            folder.path().join(name),
            folder.path().join("again").join(name),
        )
        .expect("copied");
    }
    let manifest = folder.path().join("out/s/manifest.toml");
    std::fs::copy(manifest, folder.path().join("again/manifest.toml")).expect("copied");
    let again = |more: &[&str]| {
        let arguments = ["run", "again/manifest.toml", "-o", "more"];
        fogbench(folder.path(), &[&arguments[..], more].concat())
    };
    assert_eq!(code(&again(&[])), 2);
    let output = again(&["--allow-programs"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let read = |out: &str| std::fs::read(folder.path().join(out).join("s/summary.json"));
    assert_eq!(
        read("more").expect("written"),
        read("out").expect("written")
    );
    for place in ["again/mean.py", "mean.py"] {
        let path = folder.path().join(place);
        let changed = std::fs::read_to_string(&path).expect("readable") + "# changed\n";
        std::fs::write(path, changed).expect("writable");
    }
    let output = again(&["--allow-programs"]);
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("not the file that the manifest was made from"));
    let output = run(folder.path(), &text, &resume);
    assert_eq!(code(&output), 0);
    assert!(
        !stderr(&output).contains("taken over"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn a_time_out_is_never_taken_over() {
    if !has("python3") {
        return;
    }
    let folder = tempfile::tempdir().expect("a scratch folder");
    misbehaving(folder.path(), "hello(); block(); time.sleep(600)");
    let slow = program("slow", "[\"python3\", \"./bad.py\"]", "timeout_s = 0.3");
    let text = format!("{HEAD}{slow}");
    allowed(folder.path(), &text, 3);
    let output = run(
        folder.path(),
        &text,
        &["--resume=any-build", "--allow-programs"],
    );
    assert_eq!(code(&output), 3);
    assert!(
        !stderr(&output).contains("taken over"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn memory_beyond_the_limit_ends_a_program() {
    if !has("python3") || !cfg!(target_os = "linux") {
        return;
    }
    let folder = tempfile::tempdir().expect("a scratch folder");
    misbehaving(
        folder.path(),
        "hello(); block(); b = bytearray(b'x' * 700_000_000); time.sleep(600)",
    );
    let large = program("large", "[\"python3\", \"./bad.py\"]", "memory_mb = 512");
    let run = allowed(folder.path(), &format!("{HEAD}{large}"), 3);
    let error = &run["channels"]["large"]["error"];
    assert_eq!(error["kind"], "memory", "{error}");
    assert!(
        error["message"]
            .as_str()
            .expect("a message")
            .contains("allowed up to 512 MB")
    );
}

/// A program that leaves a child with a session of its own, which heeds no signal that can be heeded.
const LEAVING: &str = "if os.fork() == 0:\n    os.setsid()\n    import signal\n    signal.signal(signal.SIGTERM, signal.SIG_IGN)\n    os.execvp('sh', ['sh', '-c', 'trap \"\" TERM; while true; do sleep 1; done', MARK])\n";

#[test]
fn nothing_lives_on_when_a_program_ends_though_it_has_a_session_of_its_own() {
    if !has("python3") || !cfg!(target_os = "linux") {
        return;
    }
    let folder = tempfile::tempdir().expect("a scratch folder");
    let mark = format!("mark-of-{}", folder.path().display()).replace('/', "-");
    misbehaving(
        folder.path(),
        &format!("MARK = '{mark}'\n{LEAVING}hello(); rest()"),
    );
    let text = format!("{HEAD}{}", program("p", "[\"python3\", \"./bad.py\"]", ""));
    allowed(folder.path(), &text, 0);
    nothing_is_left(&mark);
}

#[test]
fn nothing_lives_on_when_fogbench_is_interrupted_or_killed() {
    if !has("python3") || !cfg!(target_os = "linux") {
        return;
    }
    for signal in ["KILL", "TERM", "INT"] {
        let folder = tempfile::tempdir().expect("a scratch folder");
        let mark = format!("mark-of-{}", folder.path().display()).replace('/', "-");
        let hang = "import signal; signal.signal(signal.SIGTERM, signal.SIG_IGN); time.sleep(600)";
        misbehaving(
            folder.path(),
            &format!("MARK = '{mark}'\n{LEAVING}hello(); block(); {hang}"),
        );
        let command = format!("[\"python3\", \"./bad.py\", \"{mark}\"]");
        write(
            folder.path(),
            "s.toml",
            &format!("{HEAD}{}", program("p", &command, "")),
        );
        let mut fogbench = Command::new(env!("CARGO_BIN_EXE_fogbench"))
            .args(["run", "s.toml", "-o", "out", "--allow-programs"])
            .current_dir(folder.path())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("the program starts");
        let began = Instant::now();
        // The supervisor, the program and what it left.
        while processes(&mark).len() < 3 {
            assert!(
                began.elapsed() < Duration::from_secs(60),
                "the program does not start"
            );
            std::thread::sleep(Duration::from_millis(20));
        }
        let killed = Command::new("kill")
            .args([&format!("-{signal}"), &fogbench.id().to_string()])
            .status();
        assert!(killed.expect("kill starts").success());
        fogbench.wait().expect("it ends");
        nothing_is_left(&mark);
        let left = std::fs::read_dir(std::env::temp_dir())
            .expect("readable")
            .flatten();
        let own = format!("fogbench-program-{}-", fogbench.id());
        let left = left.filter(|entry| entry.file_name().to_string_lossy().starts_with(&own));
        std::thread::sleep(Duration::from_millis(100));
        assert_eq!(
            left.filter(|entry| entry.path().exists()).count(),
            0,
            "{signal}"
        );
    }
}

#[test]
fn a_program_does_not_start_afresh_within_a_record() {
    let folder = scratch();
    let mean = program("p", "[\"python3\", \"./mean.py\"]", "");
    write(folder.path(), "s.toml", &format!("{HEAD}{mean}"));
    let output = fogbench(
        folder.path(),
        &["check", "s.toml", "--set", "trial.filter_state=reset"],
    );
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("filter[0].process: trial.filter_state"));
}

#[test]
fn a_program_that_answers_otherwise_each_time_is_told() {
    if !has("python3") {
        return;
    }
    let folder = tempfile::tempdir().expect("a scratch folder");
    misbehaving(
        folder.path(),
        "import random\nhello()\nwhile True:\n    n, b = block()\n    if n == 0: break\n\
         \x20   w = struct.unpack('<%dd' % n, b)\n\
         \x20   say(struct.pack('<I%dd' % n, n, *[x + random.random() for x in w]))",
    );
    let random = program("p", "[\"python3\", \"./bad.py\"]", "");
    let run = allowed(folder.path(), &format!("{HEAD}{random}"), 0);
    let notes = run["notes"].to_string();
    assert!(notes.contains("do not repeat to the byte"), "{notes}");
    let lack = &run["channels"]["p"]["unavailable"]["dc_gain_adapted"];
    assert!(
        lack.as_str().expect("a reason").contains("run again"),
        "{lack}"
    );
    assert!(run["channels"]["p"]["noise_gain"]["value"].is_number());
}
