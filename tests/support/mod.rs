//! Helpers shared by the integration tests.

pub(crate) mod records;

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};

use fogbench::declare::{Content, Presence};
use fogbench::filters::FilterKind;

pub(crate) mod fixed;
pub(crate) mod generated;
pub(crate) mod gyro_cases;
pub(crate) mod inference;
pub(crate) mod junit;
pub(crate) mod patent_cases;
pub(crate) mod reference_gyro;
pub(crate) mod run;
pub(crate) mod seeded;
pub(crate) mod stimulus;
pub(crate) mod svg;
pub(crate) mod tables;
pub(crate) mod transcript;
pub(crate) mod turntable_cases;
pub(crate) mod waveform_gyro;

/// Asserts that `got` equals `want` within `rtol * |want| + atol`.
#[track_caller]
pub(crate) fn assert_close(got: f64, want: f64, rtol: f64, atol: f64) {
    let error = (got - want).abs();
    assert!(
        error <= rtol * want.abs() + atol,
        "got {got}, want {want}: off by {error}, allowed rtol {rtol}, atol {atol}"
    );
}

/// Whether a missing program is a failure.
pub(crate) fn is_ci() -> bool {
    std::env::var("CI").is_ok_and(|value| value == "true")
}

/// Whether simulations of RTL run over all their samples, which takes minutes.
pub(crate) fn is_long_rtl() -> bool {
    std::env::var_os("FOGBENCH_RTL_LONG").is_some()
}

/// A path inside the repository.
pub(crate) fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// A folder of a test's own, which goes with it.
pub(crate) fn scratch() -> tempfile::TempDir {
    tempfile::tempdir().expect("a scratch folder")
}

/// Rust files of a folder and of those below it, in order.
pub(crate) fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder)
        .expect("a folder of sources")
        .flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    paths.sort();
    let is_rust = |path: &Path| path.extension().is_some_and(|extension| extension == "rs");
    let found = paths.into_iter().flat_map(|path| match path.is_dir() {
        true => rust_files(&path),
        false => Some(path)
            .filter(|path| is_rust(path))
            .into_iter()
            .collect(),
    });
    found.collect()
}

/// Kinds of filters that the bench makes by itself: those from outside need keys that have no default.
pub(crate) fn kinds_of_the_bench() -> Vec<&'static str> {
    let rows = FilterKind::TABLE.rows.iter();
    let own = rows.filter(|row| match row.content {
        Content::Table(table) => {
            let mut keys = table.rows.iter();
            keys.all(|key| {
                let is_value = matches!(key.content, Content::Value(_));
                !is_value || key.presence != Presence::Required
            })
        }
        _ => false,
    });
    own.map(|row| row.name).collect()
}

/// Runs the program with `arguments` in `folder`, output captured and colours off.
pub(crate) fn fogbench(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_fogbench"))
        .args(arguments)
        .current_dir(folder)
        .env("NO_COLOR", "1")
        .env_remove("COLUMNS")
        .output()
        .expect("the program starts")
}

/// The program at work with a pipe at each of its ends.
pub(crate) fn on_a_pipe(folder: &Path, arguments: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_fogbench"))
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts")
}

/// What the program says of some bytes on its standard input.
pub(crate) fn piped(folder: &Path, bytes: &[u8], arguments: &[&str]) -> Output {
    let mut child = on_a_pipe(folder, arguments);
    let mut stdin = child.stdin.take().expect("a pipe");
    // A command that refuses its input may end before it has read all of it.
    let _ = stdin.write_all(bytes);
    drop(stdin);
    child.wait_with_output().expect("it ends")
}

/// Runs shipped scenarios of `scenarios/audit` into `folder/out`; they must pass.
#[track_caller]
pub(crate) fn run_audits(folder: &Path, names: &[&str]) -> Output {
    let paths: Vec<String> = names
        .iter()
        .map(|name| repository(&format!("scenarios/audit/{name}.toml")))
        .map(|path| path.to_string_lossy().into_owned())
        .collect();
    let mut arguments = vec!["run"];
    arguments.extend(paths.iter().map(String::as_str));
    arguments.extend(["-o", "out"]);
    let output = fogbench(folder, &arguments);
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    output
}

/// Exit code of a finished program.
pub(crate) fn code(output: &Output) -> i32 {
    output
        .status
        .code()
        .expect("the program was not killed by a signal")
}

/// Standard output as text.
pub(crate) fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("stdout is UTF-8")
}

/// Standard error as text.
pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("stderr is UTF-8")
}

/// Writes `text` to `folder/name`, making folders on the way.
pub(crate) fn write(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().expect("a file lies in a folder")).expect("writable");
    std::fs::write(&path, text).expect("writable");
    path
}

/// Every file below `folder`, as (path below it, bytes), sorted; what the tool keeps for itself in
/// `.fogbench/` is no part of any result.
pub(crate) fn tree(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    fn walk(root: &Path, folder: &Path, files: &mut Vec<(PathBuf, Vec<u8>)>) {
        for entry in std::fs::read_dir(folder)
            .expect("a readable folder")
            .flatten()
        {
            let path = entry.path();
            if path.is_dir() && path.ends_with(".fogbench") {
                continue;
            }
            if path.is_dir() {
                walk(root, &path, files);
            } else {
                let inside = path.strip_prefix(root).expect("below the root").to_owned();
                files.push((inside, std::fs::read(&path).expect("a readable file")));
            }
        }
    }
    let mut files = Vec::new();
    walk(folder, folder, &mut files);
    files.sort();
    files
}

/// A run's `summary.json`.
pub(crate) fn summary(output: &Path, run: &str) -> serde_json::Value {
    let path = output.join(run).join("summary.json");
    let text = std::fs::read_to_string(&path)
        .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    serde_json::from_str(&text).expect("summary.json is JSON")
}

/// `channels.<channel>.<metric>.<field>` of a summary.
#[track_caller]
pub(crate) fn field(summary: &serde_json::Value, metric: &str, field: &str) -> f64 {
    let (channel, name) = metric.rsplit_once('.').expect("<channel>.<metric>");
    summary["channels"][channel][name][field]
        .as_f64()
        .unwrap_or_else(|| panic!("no {metric}.{field} in the summary"))
}

/// The numbers of a one-dimensional NPY file.
pub(crate) fn npy(path: &Path) -> Vec<f64> {
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let file = npyz::NpyFile::new(&bytes[..]).expect("an NPY file");
    file.into_vec().expect("binary64")
}
