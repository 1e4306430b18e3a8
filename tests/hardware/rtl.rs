//! The exported RTL under Icarus Verilog: same words, same trace, same memories.
//!
//! Without `iverilog` and `vvp` the tests print that they are skipped; with `CI=true` in the
//! environment that is a failure.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use fogbench::fpga::board::{CodeScale, Surroundings};
use fogbench::fpga::engine::Engine as _;
use fogbench::fpga::export::{
    ExportSettings, IntegerCodes, PipelineConfig, TopLevel, stimulus_pairs, write_rtl,
};
use fogbench::fpga::float_unit::{FlushToZero, Fp};
use fogbench::fpga::front_end::{FrontEnd, Pair};
use fogbench::fpga::lms::{DesiredSource, LmsConfig, LmsEngine, LmsSettings, lms_stalled_clocks};
use fogbench::fpga::rls::{RlsConfig, RlsEngine, RlsLoad, RlsSettings, rls_stalled_clocks};
use fogbench::fpga::sign_lms::{
    SignLmsConfig, SignLmsEngine, SignLmsSettings, sign_lms_stalled_clocks,
};
use fogbench::fpga::timing::{UnitTiming, Units};
use fogbench::fpga::trace::hex;
use fogbench::vocabulary::{DesiredSignal, Division, OutputRegister, UpdateSign};

use crate::support::stimulus::{SETUPS, Setup, predictor_pairs, samples};
use crate::support::{is_ci, is_long_rtl};

/// Whether the programs are here; panics under CI=true if not.
fn available(programs: &[&str]) -> bool {
    let missing = programs
        .iter()
        .find(|program| Command::new(program).arg("-V").output().is_err());
    let Some(program) = missing else {
        return true;
    };
    assert!(!is_ci(), "{program} is needed under CI=true");
    eprintln!("skipped: {program} is not installed");
    false
}

/// Samples per set-up: everything in the long run (some minutes of Icarus, which simulates about
/// 65,000 clocks per second), or at most `FOGBENCH_RTL_SAMPLES`; elsewhere enough to notice a fault.
fn sample_count(in_long_run: usize, elsewhere: usize) -> usize {
    if let Ok(text) = std::env::var("FOGBENCH_RTL_SAMPLES") {
        let most: usize = text.parse().expect("FOGBENCH_RTL_SAMPLES is a count");
        in_long_run.min(most)
    } else if is_long_rtl() {
        in_long_run
    } else {
        elsewhere
    }
}

fn rls<F: Fp>(tap_count: usize, alpha: f64, division: Division) -> PipelineConfig<F> {
    PipelineConfig::Rls(
        RlsConfig::new(RlsSettings {
            tap_count,
            forgetting_factor: alpha,
            initial_inverse_correlation: 1e4,
            division,
            update_sign: UpdateSign::Corrected,
        })
        .expect("settings are in range"),
    )
}

fn lms(
    tap_count: usize,
    regularisation: Option<f64>,
    desired: DesiredSource,
) -> PipelineConfig<f64> {
    PipelineConfig::Lms(
        LmsConfig::new(LmsSettings {
            tap_count,
            step_size: 0.1,
            regularisation,
            desired,
            update_sign: UpdateSign::Corrected,
        })
        .expect("settings are in range"),
    )
}

fn settings<F: Fp>(pipeline: PipelineConfig<F>, trace_samples: usize) -> ExportSettings<F> {
    ExportSettings {
        pipeline,
        clock_mhz: 40.0,
        front_end: "one-step predictor: x = previous sample, d = sample".to_string(),
        trace_samples,
        codes: None,
        top: None,
    }
}

/// Codes of 1e-4 deg/s for words in deg/h.
fn code_scale() -> CodeScale {
    CodeScale {
        lsb: 1e-4,
        unit: "deg/s".to_string(),
        factor: 3600.0,
        word_unit: "deg/h".to_string(),
    }
}

/// Runs the folder's script with variables of the environment and plusargs of the testbench.
fn run_with(dir: &Path, variables: &[(&str, &str)], plusargs: &[&str]) -> Output {
    // From another directory, so that a dependence on the current one shows.
    Command::new("sh")
        .arg(dir.join("run.sh"))
        .args(plusargs)
        .envs(variables.iter().copied())
        .current_dir("/")
        .output()
        .expect("the program runs")
}

fn text_of(output: &Output) -> String {
    let error = String::from_utf8_lossy(&output.stderr);
    String::from_utf8_lossy(&output.stdout).into_owned() + &error
}

/// Asserts success and returns what the testbench prints about the run.
#[track_caller]
fn assert_passes_with(dir: &Path, variables: &[(&str, &str)], plusargs: &[&str]) -> String {
    let output = run_with(dir, variables, plusargs);
    let text = text_of(&output);
    assert!(output.status.success() && text.contains("PASS"), "{text}");
    text
}

#[track_caller]
fn assert_passes(dir: &Path) -> String {
    assert_passes_with(dir, &[], &[])
}

/// Words of the clock-less engine, as a vector file: the third opinion beside pipeline and RTL.
fn words_at_once<F: Fp>(pipeline: PipelineConfig<F>, pairs: &[Pair<F>]) -> String {
    let mut outputs = Vec::new();
    match pipeline {
        PipelineConfig::Rls(config) => RlsEngine::new(config).run(pairs, &mut outputs),
        PipelineConfig::Lms(config) => LmsEngine::new(config).run(pairs, &mut outputs),
        PipelineConfig::SignLms(config) => SignLmsEngine::new(config).run(pairs, &mut outputs),
    }
    outputs.iter().map(|word| hex(*word) + "\n").collect()
}

fn export_and_run<F: Fp>(pipeline: PipelineConfig<F>, pairs: &[Pair<F>], trace_samples: usize) {
    let dir = tempfile::tempdir().expect("a temporary folder");
    write_rtl(dir.path(), &settings(pipeline, trace_samples), pairs)
        .expect("the folder is writable");
    let by_clock = fs::read_to_string(dir.path().join("y.hex")).expect("the words are written");
    assert!(by_clock == words_at_once(pipeline, pairs), "{pipeline:?}");
    let report = assert_passes(dir.path());
    assert!(!report.contains(" 0 resets;"), "no reset in {report}");
    let rows = trace_samples.min(pairs.len()) * pipeline.as_pipeline().clocks_per_sample();
    let samples = pairs.len();
    for part in [
        format!(" {samples} samples,"),
        format!(" {rows} trace rows;"),
    ] {
        assert!(report.contains(&part), "no {part} in {report}");
    }
}

#[test]
fn rtl_of_every_setup_has_the_words_and_every_clock_of_the_model() {
    if !available(&["iverilog", "vvp"]) {
        return;
    }
    let traced = sample_count(1000, 20);
    for Setup {
        name,
        alpha,
        division,
    } in SETUPS
    {
        let pairs = predictor_pairs::<f64>(name, sample_count(10_000, 50));
        export_and_run(rls(4, alpha, division), &pairs, traced);
    }
}

/// All set-ups of the given tap counts.
fn check_tap_counts(tap_counts: &[usize]) {
    if !available(&["iverilog", "vvp"]) {
        return;
    }
    for tap_count in tap_counts {
        for Setup {
            name,
            alpha,
            division,
        } in SETUPS
        {
            let pairs = predictor_pairs::<f64>(name, sample_count(10_000, 20));
            export_and_run(rls(*tap_count, alpha, division), &pairs, 0);
        }
    }
}

#[test]
fn rtl_of_one_to_five_taps_has_the_words_of_the_model() {
    check_tap_counts(&[1, 2, 3, 5]);
}

// Apart from the others because its clocks are more than half of all: the two run side by side.
#[test]
fn rtl_of_eight_taps_has_the_words_of_the_model() {
    check_tap_counts(&[8]);
}

#[test]
fn rtl_of_every_number_format_has_the_words_of_the_model() {
    fn check<F: Fp>() {
        let pairs = predictor_pairs::<F>("rocking", 100);
        export_and_run(rls(4, 0.99, Division::Reciprocal), &pairs, 100);
        // Small desired words bring subnormals, large inputs overflow.
        let scale = if F::WIDTH == 64 { 1e-309 } else { 1e-39 };
        let mut pairs = predictor_pairs::<F>("white", 60);
        for pair in &mut pairs {
            pair.desired = F::from_f64(pair.desired.to_f64() * scale);
        }
        pairs[50].input = F::from_f64(1.0 / scale);
        export_and_run(rls(3, 1.0, Division::Elementwise), &pairs, 60);
    }
    if !available(&["iverilog", "vvp"]) {
        return;
    }
    check::<f64>();
    check::<f32>();
    check::<FlushToZero<f64>>();
    check::<FlushToZero<f32>>();
}

#[test]
fn a_nan_takes_the_same_way_through_the_rtl() {
    if !available(&["iverilog", "vvp"]) {
        return;
    }
    let mut pairs = predictor_pairs::<f64>("white", 8);
    pairs[3].input = f64::NAN;
    export_and_run(rls(4, 1.0, Division::Reciprocal), &pairs, 8);
}

#[test]
fn rtl_of_lms_and_nlms_has_the_words_and_every_clock_of_the_model() {
    if !available(&["iverilog", "vvp"]) {
        return;
    }
    for regularisation in [None, Some(1e-3)] {
        for (tap_count, desired, most) in [
            (10, DesiredSource::MeanOfTwoNewest, 10_000),
            (10, DesiredSource::Port, 1000),
            (1, DesiredSource::Port, 1000),
        ] {
            let count = sample_count(most, 60);
            let pairs = predictor_pairs::<f64>("rocking", count);
            let traced = sample_count(1000, 60);
            export_and_run(lms(tap_count, regularisation, desired), &pairs, traced);
        }
    }
}

/// `period n` of the testbench's report.
fn reported_period(report: &str) -> u64 {
    let (_, after) = report.split_once("period ").expect("a period is printed");
    let (digits, _) = after.split_once(',').expect("a comma follows");
    digits.parse().expect("a number of clocks")
}

#[test]
fn a_slow_divider_keeps_every_word_and_takes_the_clocks_of_the_timing_model() {
    if !available(&["iverilog", "vvp"]) {
        return;
    }
    let pairs = predictor_pairs::<f64>("rocking", 6);
    let units = |latency_clocks| Units {
        divider: UnitTiming::iterative(latency_clocks),
        ..Units::ONE_CLOCK
    };
    let dir = tempfile::tempdir().unwrap();
    for (division, alpha) in [
        (Division::Reciprocal, 1.0),
        (Division::Reciprocal, 0.99),
        (Division::Elementwise, 1.0),
        (Division::Elementwise, 0.99),
    ] {
        write_rtl(dir.path(), &settings(rls(4, alpha, division), 6), &pairs).unwrap();
        for latency in [10, 56] {
            let variable = latency.to_string();
            let report = assert_passes_with(dir.path(), &[("DIV_LATENCY", &variable)], &[]);
            let load = RlsLoad {
                tap_count: 4,
                division,
                forgets: alpha < 1.0,
            };
            let want = rls_stalled_clocks(load, units(latency)).unwrap();
            assert_eq!(reported_period(&report), want, "{division:?}, {latency}");
        }
    }
    let nlms = lms(10, Some(1e-3), DesiredSource::MeanOfTwoNewest);
    write_rtl(dir.path(), &settings(nlms, 6), &pairs).unwrap();
    for latency in [10, 56] {
        let variable = latency.to_string();
        let report = assert_passes_with(dir.path(), &[("DIV_LATENCY", &variable)], &[]);
        let want = lms_stalled_clocks(10, true, units(latency)).unwrap();
        assert_eq!(reported_period(&report), want, "NLMS, {latency}");
    }
}

#[test]
fn pauses_a_withdrawn_strobe_and_a_black_box_change_no_word() {
    if !available(&["iverilog", "vvp"]) {
        return;
    }
    let pairs = predictor_pairs::<f64>("white", 12);
    let dir = tempfile::tempdir().unwrap();
    let pipeline = rls(4, 0.99, Division::Reciprocal);
    write_rtl(dir.path(), &settings(pipeline, 12), &pairs).unwrap();
    let report = assert_passes_with(dir.path(), &[], &["+GAP=150", "+GAP_SEED=7", "+WITHDRAW"]);
    assert!(!report.contains(" 2 idle;"), "no pause in {report}");
    assert_passes_with(dir.path(), &[("BLACK_BOX", "1")], &["+GAP=3"]);
}

#[test]
fn a_missing_simulator_and_missing_vectors_have_exit_codes_of_their_own() {
    let dir = tempfile::tempdir().unwrap();
    let pairs = predictor_pairs::<f64>("white", 2);
    let pipeline = rls(2, 1.0, Division::Reciprocal);
    write_rtl(dir.path(), &settings(pipeline, 0), &pairs).unwrap();
    let missing = run_with(dir.path(), &[("SIM", "no-such-iverilog")], &[]);
    assert_eq!(missing.status.code(), Some(127), "{}", text_of(&missing));
    fs::remove_file(dir.path().join("params.vh")).unwrap();
    let missing = run_with(dir.path(), &[], &[]);
    assert_eq!(missing.status.code(), Some(2), "{}", text_of(&missing));
    let refused = write_rtl(dir.path(), &settings(pipeline, 0), &[]).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "number of samples to export = 0 is out of range: expected at least 1"
    );
}

#[test]
fn rtl_runs_under_verilator_where_it_is_installed() {
    // Half a minute of C++ compilation: in CI only.
    if !is_ci() || Command::new("verilator").arg("-V").output().is_err() {
        eprintln!("skipped: runs in CI with verilator only");
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let pairs = predictor_pairs::<f64>("rocking", 2000);
    let pipeline = rls(4, 0.99, Division::Reciprocal);
    write_rtl(dir.path(), &settings(pipeline, 100), &pairs).unwrap();
    assert_passes_with(dir.path(), &[("SIM", "verilator")], &[]);
}

#[test]
fn a_wrong_vector_fails_and_is_named() {
    if !available(&["iverilog", "vvp"]) {
        return;
    }
    let dir = tempfile::tempdir().expect("a temporary folder");
    let pairs = predictor_pairs::<f64>("white", 5);
    let pipeline = rls(4, 1.0, Division::Reciprocal);
    write_rtl(dir.path(), &settings(pipeline, 5), &pairs).unwrap();
    assert_passes(dir.path());
    for (file, place) in [
        ("y.hex", "y"),
        ("trace.csv", "ra_wdata"),
        ("ram_final.hex", "RAMB[23]"),
    ] {
        write_rtl(dir.path(), &settings(pipeline, 5), &pairs).unwrap();
        // The last hexadecimal digit of the last word, or of the first word loaded, is changed.
        let path = dir.path().join(file);
        let text = fs::read_to_string(&path).unwrap();
        let wrong = if file == "trace.csv" {
            text.replacen("1,1,0,1,0000000000000000", "1,1,0,1,0000000000000001", 1)
        } else {
            let (head, last) = text.trim_end().rsplit_once('\n').unwrap();
            let flipped = u64::from_str_radix(last, 16).unwrap() ^ 1;
            format!("{head}\n{flipped:016x}\n")
        };
        assert_ne!(wrong, text);
        fs::write(&path, wrong).unwrap();
        let output = run_with(dir.path(), &[], &[]);
        let printed = text_of(&output);
        assert_eq!(output.status.code(), Some(1), "{file}: {printed}");
        for word in ["MISMATCH", "clock", "state", place, "expected", "got"] {
            assert!(printed.contains(word), "{file}: no {word} in {printed}");
        }
    }
}

#[test]
fn hexadecimal_files_are_complete_and_parameters_name_every_choice() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let signal = samples("static", 7);
    let codes: Vec<i32> = (0..7).map(|k| 3 - k).collect();
    let pairs = stimulus_pairs::<f64>(&signal, &mut FrontEnd::one_step_predictor()).unwrap();
    let mut settings = settings(rls(4, 0.99, Division::Reciprocal), 2);
    settings.codes = Some(IntegerCodes {
        codes,
        scale: code_scale(),
    });
    write_rtl(dir.path(), &settings, &pairs).unwrap();
    let read = |name: &str| fs::read_to_string(dir.path().join(name)).unwrap();
    for (name, lines) in [
        ("in.hex", 14),
        ("y.hex", 7),
        ("ram_init.hex", 32),
        ("ram_final.hex", 32),
        ("in_codes.hex", 7),
        ("trace.csv", 1 + 1 + 2 * 108),
    ] {
        let text = read(name);
        assert_eq!(text.lines().count(), lines, "{name}");
        assert!(text.ends_with('\n'), "{name}");
    }
    assert_eq!(read("in_codes.hex").lines().last(), Some("fffffffd"));
    let first = u64::from_str_radix(read("in.hex").lines().nth(2).unwrap(), 16).unwrap();
    assert_eq!(first, signal[0].to_bits());
    let json: serde_json::Value = serde_json::from_str(&read("params.json")).unwrap();
    assert_eq!(json["filter"], "rls");
    assert_eq!(json["clocks_per_sample"], 108);
    assert_eq!(json["latency_clocks"], 99);
    assert_eq!(json["alpha_bits"], "3fefae147ae147ae");
    assert_eq!(json["code_lsb"], 1e-4);
    assert_eq!(json["subnormals"], "kept");
    settings.codes.as_mut().unwrap().codes.pop();
    let refused = write_rtl(dir.path(), &settings, &pairs).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "integer codes holds 6 values: expected 7, one per sample"
    );
    let refused = stimulus_pairs::<f64>(&[0.0, f64::INFINITY], &mut FrontEnd::one_step_predictor());
    assert_eq!(
        refused.unwrap_err().to_string(),
        "stimulus sample 1 is inf: expected a number that is finite in binary64"
    );
    let refused = stimulus_pairs::<f32>(&[1e300], &mut FrontEnd::one_step_predictor());
    assert_eq!(
        refused.unwrap_err().to_string(),
        "stimulus sample 0 is 1e300: expected a number that is finite in binary32"
    );
}

/// The line enhancer with the patent's constants, deg/h.
fn line_enhancer<F: Fp>(settings: SignLmsSettings) -> PipelineConfig<F> {
    PipelineConfig::SignLms(SignLmsConfig::new(settings).expect("settings are in range"))
}

const LINE_ENHANCER: SignLmsSettings = SignLmsSettings {
    tap_count: 20,
    delay_samples: 15,
    normalised: false,
    step: 0.005,
    regularisation: 1e-4,
    initial_weight: 0.05,
    guard: None,
    norm_recompute_samples: 0,
};

/// Pairs of the samples behind the delay, with a step of rate in the middle.
fn delayed_pairs<F: Fp>(count: usize, delay: usize, step: f64) -> Vec<Pair<F>> {
    let mut front_end = FrontEnd::new(DesiredSignal::Current, delay);
    samples("white", count)
        .iter()
        .enumerate()
        .map(|(n, sample)| {
            let rate = if n < count / 2 { 1.0 } else { step };
            front_end.pair(F::from_f64(rate + 0.5 * sample))
        })
        .collect()
}

#[test]
fn rtl_of_the_line_enhancer_has_the_words_and_every_clock_of_the_model() {
    fn check<F: Fp>(settings: SignLmsSettings, count: usize) {
        let pairs = delayed_pairs::<F>(count, settings.delay_samples, 40.0);
        export_and_run(line_enhancer(settings), &pairs, count.min(100));
    }
    if !available(&["iverilog", "vvp"]) {
        return;
    }
    let count = sample_count(10_000, 150);
    check::<f64>(LINE_ENHANCER, count);
    let guarded = SignLmsSettings {
        guard: Some(6.0),
        norm_recompute_samples: 33,
        ..LINE_ENHANCER
    };
    check::<f64>(guarded, count);
    check::<f32>(guarded, count);
    check::<FlushToZero<f64>>(guarded, count);
    check::<FlushToZero<f32>>(guarded, count);
    let normalised = SignLmsSettings {
        normalised: true,
        initial_weight: 0.0,
        ..guarded
    };
    check::<f64>(normalised, count);
    for (tap_count, delay_samples, norm_recompute_samples) in [(1, 1, 1), (2, 3, 2), (3, 1, 7)] {
        let few = SignLmsSettings {
            tap_count,
            delay_samples,
            norm_recompute_samples,
            ..guarded
        };
        check::<f64>(few, 60);
    }
}

#[test]
fn the_line_enhancer_waits_for_a_slow_divider_and_takes_a_nan_as_the_model_does() {
    if !available(&["iverilog", "vvp"]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let pipeline = line_enhancer::<f64>(LINE_ENHANCER);
    let pairs = delayed_pairs::<f64>(40, 15, 2.0);
    write_rtl(dir.path(), &settings(pipeline, 20), &pairs).unwrap();
    let slow = Units {
        divider: UnitTiming::iterative(56),
        ..Units::ONE_CLOCK
    };
    let clocks = sign_lms_stalled_clocks(20, false, slow).unwrap();
    assert_eq!(clocks, 122);
    let report = assert_passes_with(dir.path(), &[("DIV_LATENCY", "56")], &["+GAP=300"]);
    assert!(report.contains(&format!("period {clocks},")), "{report}");
    assert_passes_with(dir.path(), &[], &["+WITHDRAW", "+GAP=90", "+GAP_SEED=3"]);
    let mut pairs = delayed_pairs::<f64>(60, 15, 2.0);
    pairs[20].input = f64::NAN;
    pairs[40].desired = f64::INFINITY;
    for guard in [None, Some(10.0)] {
        let settings = SignLmsSettings {
            guard,
            norm_recompute_samples: 20,
            ..LINE_ENHANCER
        };
        export_and_run(line_enhancer(settings), &pairs, 60);
    }
}

/// The top level around a pipeline.
fn top<F: Fp>(
    desired: DesiredSignal,
    output_register: OutputRegister,
    scale: Option<CodeScale>,
    samples: &[f64],
) -> TopLevel<F> {
    TopLevel {
        surroundings: Surroundings {
            desired,
            input_lag_samples: 2,
            output_register,
            scale,
        },
        samples: samples.iter().copied().map(F::from_f64).collect(),
    }
}

#[test]
fn the_top_level_has_the_exported_constants_and_the_words_of_the_model() {
    fn check<F: Fp>(desired: DesiredSignal, register: OutputRegister, coded: bool) {
        let codes: Vec<i32> = (0..30_i32).map(|k| (k * k * 37) % 2001 - 1000).collect();
        let codes = IntegerCodes {
            codes: [&codes[..], &[0, i32::MAX, i32::MIN]].concat(),
            scale: code_scale(),
        };
        let words: Vec<f64> = codes.codes.iter().map(|k| codes.scale.word(*k)).collect();
        assert!(codes.give(&words));
        // A small rate below zero is rounded to -0, which no code is.
        let signed: Vec<f64> = words
            .iter()
            .map(|it| if *it == 0.0 { -0.0 } else { *it })
            .collect();
        assert!(codes.give(&signed));
        assert!(!codes.give(&signed.iter().map(|it| it + 1e-9).collect::<Vec<_>>()));
        let pairs = stimulus_pairs(&words, &mut FrontEnd::<F>::new(desired, 2)).unwrap();
        let mut settings = settings(rls(3, 0.97, Division::Elementwise), 0);
        let scale = coded.then(code_scale);
        settings.top = Some(top(desired, register, scale, &words));
        settings.codes = Some(codes);
        let dir = tempfile::tempdir().unwrap();
        write_rtl(dir.path(), &settings, &pairs).unwrap();
        let report = assert_passes_with(dir.path(), &[("BENCH", "top")], &[]);
        assert!(report.contains("PASS top level: 33 results"), "{report}");
        let text = fs::read_to_string(dir.path().join("rls_top.v")).unwrap();
        let alpha = format!("{}'h{}", F::WIDTH, hex(F::from_f64(0.97)));
        for part in [".P(3)", ".DIV_ELEM(1)", &format!(".ALPHA({alpha})")] {
            assert!(text.contains(part), "no {part} in {text}");
        }
        // A wrong factor, as one who takes the words for deg/s would put in, is noticed.
        let wrong = text.replace("64'h40ac200000000000", "64'h3ff0000000000000");
        fs::write(dir.path().join("rls_top.v"), &wrong).unwrap();
        let output = run_with(dir.path(), &[("BENCH", "top")], &[]);
        assert_eq!(output.status.success(), !coded, "{}", text_of(&output));
    }
    if !available(&["iverilog", "vvp"]) {
        return;
    }
    let (current, mean) = (DesiredSignal::Current, DesiredSignal::TwoSampleMean);
    check::<f64>(current, OutputRegister::NextSample, true);
    check::<f32>(mean, OutputRegister::Immediate, true);
    check::<FlushToZero<f64>>(mean, OutputRegister::NextSample, false);
    check::<FlushToZero<f32>>(current, OutputRegister::Immediate, false);
}

/// Number of cells of the statistics whose type starts with `kind`.
fn cells(statistics: &str, kind: &str) -> usize {
    let lines = statistics.lines().map(str::split_whitespace);
    lines
        .filter_map(|mut words| Some((words.next()?, words.next()?.parse::<usize>().ok()?)))
        .filter(|(name, _)| name.starts_with(kind))
        .map(|(_, count)| count)
        .sum()
}

#[test]
fn yosys_maps_the_control_machines_onto_an_ice40() {
    if !available(&["yosys"]) {
        return;
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/fpga/export/rtl");
    // Flip-flops: state 4, phase 1, row 2, column 2, ring slot 2, element address 5; LMS: state 4,
    // tap 4, ring slot 4. The look-up tables depend a little on the version of yosys.
    for (name, parameter, flip_flops, tables) in [
        ("rls_ctrl", "P 4", 17, 85..=125),
        ("lms_ctrl", "N 10", 12, 45..=70),
        // State 4, tap 5, slot 5, head 5, age 20, held 8.
        ("sign_lms_ctrl", "M 20", 47, 130..=210),
    ] {
        let script = format!(
            "read_verilog {}; chparam -set {parameter} {name}; synth_ice40 -top {name}; \
             select -assert-none t:$_DLATCH_*; tee -o /dev/stderr stat",
            root.join(format!("{name}.v")).display()
        );
        let output = Command::new("yosys")
            .args(["-q", "-p", &script])
            .output()
            .unwrap();
        let text = text_of(&output);
        assert!(output.status.success(), "{text}");
        assert_eq!(cells(&text, "SB_DFF"), flip_flops, "{text}");
        assert!(tables.contains(&cells(&text, "SB_LUT4")), "{text}");
    }
}

/// The arithmetic units as ports only: what a user replaces by units of their own.
const BLACK_BOXES: &str = "\
(* blackbox *) module fp_add #(parameter W = 64, parameter FTZ = 0, parameter LATENCY = 1)
    (input clk, input rst, input req, input take, input [W-1:0] a, input [W-1:0] b,
     input sub, output done, output [W-1:0] q); endmodule
(* blackbox *) module fp_mul #(parameter W = 64, parameter FTZ = 0, parameter LATENCY = 1)
    (input clk, input rst, input req, input take, input [W-1:0] a, input [W-1:0] b,
     output done, output [W-1:0] q); endmodule
(* blackbox *) module fp_div #(parameter W = 64, parameter FTZ = 0, parameter LATENCY = 1)
    (input clk, input rst, input req, input take, input [W-1:0] a, input [W-1:0] b,
     output done, output [W-1:0] q); endmodule
";

#[test]
fn yosys_maps_the_datapaths_onto_distributed_memory() {
    if !is_ci() || !available(&["yosys"]) {
        eprintln!("skipped: runs in CI only");
        return;
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/fpga/export/rtl");
    let dir = tempfile::tempdir().unwrap();
    let boxes = dir.path().join("boxes.v");
    fs::write(&boxes, BLACK_BOXES).unwrap();
    for name in ["rls", "lms", "sign_lms"] {
        let file = |suffix: &str| root.join(suffix).display().to_string();
        // Plain LMS never divides.
        let dividers = u8::from(name != "lms");
        let script = format!(
            "read_verilog {} {} {} {} {}; synth_xilinx -flatten -top {name}_core; \
             select -assert-count 1 t:fp_add; select -assert-count 1 t:fp_mul; \
             select -assert-count {dividers} t:fp_div; stat",
            boxes.display(),
            file(&format!("{name}_core.v")),
            file(&format!("{name}_ctrl.v")),
            file("den_check.v"),
            file("sp_ram.v"),
        );
        let output = Command::new("yosys")
            .args(["-p", &script])
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success(), "{text}");
        assert!(text.contains("RAM32M") && text.contains("FDRE"), "{text}");
    }
}
