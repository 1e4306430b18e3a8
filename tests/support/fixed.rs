//! Fixed-point pipelines of any kind on trial: drawn formats, stimuli, clocked runs and simulators.

use std::path::Path;
use std::process::Command;

use fogbench::fpga::export::{FixedExport, write_fixed_rtl};
use fogbench::fpga::fixed::{CodePair, FixedConfig, Overflow, Rounding};
use fogbench::fpga::timing::{UnitTiming, Units};
use fogbench::vocabulary::{DesiredSignal, OutputRegister};

use crate::support::is_ci;

pub(crate) const ROUNDINGS: [Rounding; 3] =
    [Rounding::Truncate, Rounding::HalfUp, Rounding::NearestEven];
pub(crate) const OVERFLOWS: [Overflow; 2] = [Overflow::Saturate, Overflow::Wrap];

/// Units of these latencies: adder, multiplier, divider.
pub(crate) fn pipelined(adder: u64, multiplier: u64, divider: u64) -> Units {
    Units {
        adder: UnitTiming::pipelined(adder),
        multiplier: UnitTiming::pipelined(multiplier),
        divider: UnitTiming::pipelined(divider),
    }
}

/// A repeatable generator (Knuth's constants): upper bits of a 64-bit LCG.
pub(crate) struct Draws(pub(crate) u64);

impl Draws {
    pub(crate) fn below(&mut self, bound: u32) -> u32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        u32::try_from((self.0 >> 33) % u64::from(bound)).expect("below a 32-bit bound")
    }
}

/// An export of a mix: a swing, noise, and the ends of the words; lags and registers in turn.
pub(crate) fn export(config: &FixedConfig, count: u32, trace_samples: usize) -> FixedExport {
    let mut draws = Draws(7);
    let mut samples: Vec<f64> = (0..count)
        .map(|k| {
            let noise = f64::from(draws.below(2001)) / 1000.0 - 1.0;
            0.5 * (0.1 * f64::from(k)).sin() + 0.05 * noise
        })
        .collect();
    let pipeline = config.as_pipeline();
    let format = pipeline.tap_formats().desired;
    // Words of both ends; the wide words of another test are to stay within theirs.
    if format.width() < 48 && samples.len() > 9 {
        samples[9] = -100.0;
    }
    let taps = pipeline.tap_count();
    FixedExport {
        config: *config,
        desired: [DesiredSignal::Current, DesiredSignal::TwoSampleMean][taps % 2],
        input_lag_samples: [1, 1, 3, 0][taps % 4],
        output_register: [OutputRegister::NextSample, OutputRegister::Immediate][taps / 2 % 2],
        samples: samples.iter().map(|value| format.of(*value).code).collect(),
        full_scale: "1".to_owned(),
        clock_mhz: 40.0,
        trace_samples,
    }
}

/// Pairs in the words of a mix.
pub(crate) fn pairs(config: &FixedConfig, count: u32) -> Vec<CodePair> {
    export(config, count, 0).pairs()
}

/// Words and last memories of the clocked pipeline, period and latency checked.
pub(crate) fn run(config: &FixedConfig, pairs: &[CodePair]) -> (Vec<i64>, [Vec<i64>; 2]) {
    let declared = config.as_pipeline();
    let mut pipeline = declared.clocked();
    let (mut next, mut clock, mut start) = (0, 0, None);
    let mut words = Vec::new();
    while next < pairs.len() || !pipeline.is_idle() {
        let tick = pipeline.tick(pairs.get(next).copied());
        if tick.accepted {
            if let Some(start) = start {
                assert_eq!(clock - start, declared.clocks_per_sample());
            }
            start = Some(clock);
            next += 1;
        }
        if let Some(word) = tick.output {
            let start = start.expect("a sample was taken");
            assert_eq!(clock - start, declared.latency_clocks());
            words.push(word);
        }
        clock += 1;
    }
    (words, pipeline.memories().map(<[i64]>::to_vec))
}

/// Resets the pipeline in every clock of its first two samples: nothing of the past is left.
///
/// * `clears`: clocks of clearing.
pub(crate) fn check_resets(config: &FixedConfig, clears: usize) {
    let declared = config.as_pipeline();
    let pairs = pairs(config, 20);
    let (wanted, _) = run(config, &pairs);
    let fresh = declared.clocked().memories().map(<[i64]>::to_vec);
    for clock in 0..2 * declared.clocks_per_sample() + 2 {
        let mut pipeline = declared.clocked();
        for _ in 0..clock {
            pipeline.tick(pairs.last().copied());
        }
        pipeline.reset();
        for _ in 0..clock % 7 {
            pipeline.tick(None);
        }
        pipeline.reset();
        let mut cleared = 0;
        while !pipeline.is_idle() {
            assert!(!pipeline.tick(pairs.first().copied()).accepted);
            cleared += 1;
        }
        assert_eq!(cleared, clears);
        assert_eq!(pipeline.memories().map(<[i64]>::to_vec), fresh, "{clock}");
        let (mut next, mut words) = (0, Vec::new());
        while next < pairs.len() || !pipeline.is_idle() {
            let tick = pipeline.tick(pairs.get(next).copied());
            next += usize::from(tick.accepted);
            words.extend(tick.output);
        }
        assert_eq!(words, wanted, "{clock}");
    }
}

/// Whether a program is there; under CI it has to be.
pub(crate) fn has(program: &str) -> bool {
    let found = Command::new(program).arg("-V").output().is_ok();
    assert!(found || !is_ci(), "{program} is needed under CI=true");
    if !found {
        eprintln!("skipped: {program} is not installed");
    }
    found
}

/// Runs the script of a folder; returns what it prints.
pub(crate) fn simulate(dir: &Path, variables: &[(&str, &str)]) -> (bool, String) {
    let output = Command::new("sh")
        .arg(dir.join("run.sh"))
        .envs(variables.iter().copied())
        .current_dir("/")
        .output()
        .expect("a shell");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let text = text + &String::from_utf8_lossy(&output.stderr);
    (output.status.success(), text)
}

/// Exports and simulates: core and top level have the words and clocks of the model.
pub(crate) fn check_rtl(export: &FixedExport, variables: &[(&str, &str)]) {
    let dir = tempfile::tempdir().expect("a scratch folder");
    write_fixed_rtl(dir.path(), export).expect("a writable folder");
    // The stream ports have tests of their own.
    let variables = [variables, &[("BENCH", "core top")]].concat();
    let (passed, text) = simulate(dir.path(), &variables);
    let benches = text.matches("PASS").count();
    assert!(passed && benches == 2, "{export:?}: {text}");
}

/// Exports and simulates with each of some texts of `params.vh` changed: every change is noticed.
pub(crate) fn check_noticed(export: &FixedExport, changes: &[(&str, &str)]) {
    let dir = tempfile::tempdir().expect("a scratch folder");
    write_fixed_rtl(dir.path(), export).expect("a writable folder");
    let path = dir.path().join("params.vh");
    let text = std::fs::read_to_string(&path).expect("parameters");
    for (right, wrong) in changes {
        assert!(text.contains(right), "{right}: {text}");
        std::fs::write(&path, text.replace(right, wrong)).expect("a writable folder");
        let (passed, printed) = simulate(dir.path(), &[]);
        let is_noticed = !passed && printed.contains("MISMATCH");
        assert!(is_noticed, "{right}: {printed}");
    }
}

/// Does something for every seed, two at a time.
pub(crate) fn for_each_seed(seeds: std::ops::Range<u32>, check: impl Fn(u32) + Sync) {
    std::thread::scope(|scope| {
        for part in 0..2 {
            let (seeds, check) = (seeds.clone(), &check);
            scope.spawn(move || seeds.filter(|seed| seed % 2 == part).for_each(check));
        }
    });
}
