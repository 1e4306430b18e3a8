//! The exports in which mutants are tried, and what their testbenches say of one.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use fogbench::fpga::float_unit::{FlushToZero, Fp};

use super::super::rtl_units::{unit_lines, write_unit_bench};
use crate::support::{code, fogbench, stderr, write};

/// Filters of the exports.
const FILTERS: &str = include_str!("exports.toml");

/// Samples of an export: those of which the testbench of the stream ports takes some, and a few more.
const SAMPLES: &str = "64";

/// Longest time of a script, which takes up to three seconds; a mutant may never end.
const LONGEST_S: &str = "60";

/// Pairs drawn for the bench of the units, beside the special ones.
const UNIT_PAIRS: usize = 400;

/// An export and a run of its script: filter, options of the command, variables and arguments of the
/// script. Those that take least time come first.
type Run = (&'static str, &'static str, &'static str, &'static str);

/// Options of units for synthesis of three mixes of latencies; the shortest are of one clock.
const SHORT_UNITS: &str = "--units synthesizable";
const MIDDLE_UNITS: &str =
    "--units synthesizable --adder-latency 3 --multiplier-latency 2 --divider-latency 5";
const LONG_UNITS: &str =
    "--units synthesizable --adder-latency 4 --multiplier-latency 6 --divider-latency 30";

/// Pauses between the samples, and a strobe that is withdrawn.
const PAUSES: &str = "+GAP=30 +GAP_SEED=3 +WITHDRAW";

/// Runs of the filters of the scenario, and of some on words that leave the numbers.
const RUNS: [Run; 33] = [
    ("lms", "", "", ""),
    ("sign-lms", "", "", ""),
    ("nlms", "", "", ""),
    ("sign-lms-error", "", "", ""),
    ("sign-lms-one", "", "", ""),
    ("rls", "", "", ""),
    ("lms-fixed", "", "", ""),
    ("sign-lms-fixed", "", "", ""),
    ("sign-lms-fixed-error", "", "", ""),
    ("nlms-fixed", "", "", ""),
    ("nlms-fixed-wide", "", "", ""),
    ("rls-fixed-wrapping", "", "", ""),
    ("rls-fixed-short", "", "", ""),
    ("rls-fixed", "", "", ""),
    (
        "wide-lms",
        "--stimulus binary64.csv --kind lms --taps 2",
        "",
        "",
    ),
    (
        "wide-nlms",
        "--stimulus binary32.csv --kind nlms --taps 2 --number-format binary32",
        "",
        "",
    ),
    (
        "wide-nlms-double",
        "--stimulus binary64.csv --kind nlms --taps 3",
        "",
        "",
    ),
    (
        "wide-sign-lms",
        "--stimulus binary64.csv --kind sign-lms --taps 4",
        "",
        "",
    ),
    (
        "wide-sign-lms-single",
        "--stimulus binary32.csv --kind sign-lms --taps 2 --number-format binary32",
        "",
        "",
    ),
    (
        "wide-rls",
        "--stimulus binary32.csv --taps 2 --forgetting-factor 0.97 --number-format binary32",
        "",
        "",
    ),
    (
        "wide-rls-elements",
        "--stimulus binary64.csv --taps 2 --division elementwise",
        "",
        "",
    ),
    ("rls-printed", SHORT_UNITS, "", ""),
    ("rls-flushed", MIDDLE_UNITS, "", ""),
    ("rls-single", LONG_UNITS, "", ""),
    ("nlms", "", "DIV_LATENCY=3", PAUSES),
    ("sign-lms", "", "DIV_LATENCY=5", PAUSES),
    ("rls", "", "BENCH=core", "+GAP=90 +GAP_SEED=3 +WITHDRAW"),
    ("nlms-fixed", "", "DIV_LATENCY=5", ""),
    ("sign-lms-fixed", "", "DIV_LATENCY=2", ""),
    ("rls-fixed", "", "DIV_LATENCY=4", ""),
    (
        "rls-fixed",
        "",
        "ADD_LATENCY=3 MUL_LATENCY=2 DIV_LATENCY=9",
        "",
    ),
    (
        "rls-fixed-wrapping",
        "",
        "ADD_LATENCY=4 MUL_LATENCY=3 DIV_LATENCY=5",
        "",
    ),
    (
        "rls-fixed-short",
        "",
        "ADD_LATENCY=2 MUL_LATENCY=5 DIV_LATENCY=30",
        "",
    ),
];

/// Words of a stimulus: of a swing with noise, then some so large that their squares are infinite.
fn wide_stimulus(large: f64) -> String {
    let mut text = String::from("rate\n");
    for k in 0_u32..64 {
        let rate = match k {
            45 => large,
            50 => -1.0 / large,
            55 => -large,
            _ => 1000.0 * (0.2 * f64::from(k)).sin() + f64::from(k * k * 37 % 101),
        };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{rate:e}");
    }
    text
}

/// A folder with Verilog and a script `run.sh` which fails when something is wrong.
#[derive(Clone, Debug)]
pub(super) struct Place {
    folder: PathBuf,
    variables: Vec<(String, String)>,
    arguments: Vec<String>,
}

/// What became of a mutant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    /// A testbench said so, or did not come to an end.
    Caught,
    /// Every testbench passed.
    Survived,
    /// It is no Verilog.
    NotCompiled,
}

/// Exports all filters into a folder; beside them come the benches of the units for synthesis.
pub(super) fn places(folder: &Path) -> Vec<Place> {
    write(folder, "exports.toml", FILTERS);
    write(folder, "binary64.csv", &wide_stimulus(1e160));
    write(folder, "binary32.csv", &wide_stimulus(1e30));
    let mut places = vec![
        unit_place::<f32>(folder, 2),
        unit_place::<FlushToZero<f32>>(folder, 6),
        unit_place::<f64>(folder, 5),
        unit_place::<FlushToZero<f64>>(folder, 4),
    ];
    places.extend(RUNS.iter().enumerate().map(|(k, run)| {
        let (filter, options, variables, arguments) = run;
        let name = format!("{k}-{filter}");
        export(folder, &name, filter, options);
        let variables = variables.split_whitespace().map(|variable| {
            let (name, value) = variable.split_once('=').expect("a variable");
            (name.to_owned(), value.to_owned())
        });
        Place {
            folder: folder.join(name),
            variables: variables.collect(),
            arguments: arguments.split_whitespace().map(str::to_owned).collect(),
        }
    }));
    places
}

/// Exports a filter of the scenario, or with the options what they describe.
fn export(folder: &Path, name: &str, filter: &str, options: &str) {
    let has_stimulus = options.contains("--stimulus");
    // What follows a word that is no number is looked at in every clock.
    let traced = if has_stimulus { SAMPLES } else { "6" };
    let mut given = vec!["export", "rtl", name, "--samples", SAMPLES];
    given.extend(["--trace-samples", traced]);
    if !has_stimulus {
        given.extend(["--scenario", "exports.toml", "--filter", filter]);
    }
    given.extend(options.split_whitespace());
    let output = fogbench(folder, &given);
    assert_eq!(code(&output), 0, "{filter}: {}", stderr(&output));
}

/// The bench of the units of a format.
fn unit_place<F: Fp>(folder: &Path, latency: u64) -> Place {
    let folder = folder.join(format!("units-{}-{latency}", F::NAME));
    fs::create_dir(&folder).expect("a writable folder");
    write_unit_bench::<F>(&folder, &unit_lines::<F>(UNIT_PAIRS), latency);
    Place {
        folder,
        variables: Vec::new(),
        arguments: Vec::new(),
    }
}

impl Place {
    /// Names and texts of what is the design: Verilog but for testbenches and the units that the
    /// simulator computes.
    pub(super) fn design(&self) -> Vec<(String, String)> {
        let entries = fs::read_dir(&self.folder).expect("an export");
        let mut files: Vec<(String, String)> = entries
            .filter_map(|entry| {
                let path = entry.expect("an entry").path();
                let name = path.file_name()?.to_str()?.to_owned();
                let is_design = name.ends_with(".v")
                    && !name.ends_with("_bench.v")
                    && !name.starts_with("tb_")
                    && name != "fp_sim.v";
                is_design.then(|| (name, fs::read_to_string(&path).expect("Verilog")))
            })
            .collect();
        files.sort();
        files
    }

    /// Whether a file of this text stands in the folder.
    pub(super) fn has(&self, file: &str, text: &str) -> bool {
        fs::read_to_string(self.folder.join(file)).is_ok_and(|found| found == text)
    }

    /// The same in another folder.
    pub(super) fn copied_below(&self, folder: &Path) -> Self {
        let name = self.folder.file_name().expect("a name");
        let copy = folder.join(name);
        fs::create_dir(&copy).expect("a writable folder");
        for entry in fs::read_dir(&self.folder).expect("an export") {
            let path = entry.expect("an entry").path();
            if path.is_file() {
                let name = path.file_name().expect("a name");
                fs::copy(&path, copy.join(name)).expect("a writable folder");
            }
        }
        Self {
            folder: copy,
            ..self.clone()
        }
    }

    /// Which testbenches see a file: all, but for what stands above the core.
    fn benches(file: &str) -> &'static str {
        if file.ends_with("_axis.v") || file == "axi_stream.v" {
            "axis"
        } else if file.ends_with("_top.v") || file.ends_with("front_end.v") {
            "top axis"
        } else {
            "core top axis"
        }
    }

    /// Runs the script as it is.
    pub(super) fn run(&self, file: &str) -> (Outcome, String) {
        let output = Command::new("timeout")
            .args(["--kill-after=1", LONGEST_S, "sh"])
            .arg(self.folder.join("run.sh"))
            .args(&self.arguments)
            .env("BENCH", Self::benches(file))
            .envs(self.variables.iter().cloned())
            .env("TMPDIR", &self.folder)
            .current_dir("/")
            .output()
            .expect("timeout and a shell");
        let text = String::from_utf8_lossy(&output.stdout).into_owned()
            + &String::from_utf8_lossy(&output.stderr);
        let is_judged = ["MISMATCH", "FATAL", "BROKEN"]
            .iter()
            .any(|word| text.contains(word));
        // The time is over, or the simulator itself was stopped.
        let was_stopped = output.status.code().is_none_or(|code| code >= 124);
        let outcome = match output.status.success() {
            true => Outcome::Survived,
            false if is_judged || was_stopped => Outcome::Caught,
            false => Outcome::NotCompiled,
        };
        (outcome, text)
    }

    /// Runs the script with another text of a file.
    pub(super) fn run_with(&self, file: &str, original: &str, mutated: &str) -> Outcome {
        let path = self.folder.join(file);
        fs::write(&path, mutated).expect("a writable folder");
        let (outcome, _) = self.run(file);
        fs::write(&path, original).expect("a writable folder");
        outcome
    }
}
