//! Units with latency and units for synthesis: same words, and the clocks that are foretold.
//!
//! Without `iverilog` the simulations are skipped; with `CI=true` that is a failure.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use fogbench::fpga::board::{Board, CodeScale, Surroundings};
use fogbench::fpga::engine::Engine as _;
use fogbench::fpga::export::{
    ExportSettings, IntegerCodes, PipelineConfig, RtlParts, TopLevel, stimulus_pairs, write_rtl,
    write_rtl_parts,
};
use fogbench::fpga::float_unit::{FlushToZero, Fp};
use fogbench::fpga::front_end::{FrontEnd, Pair};
use fogbench::fpga::kinds::CoreSettings;
use fogbench::fpga::lms::{DesiredSource, LmsSettings};
use fogbench::fpga::rls::{
    RlsConfig, RlsEngine, RlsLoad, RlsPipeline, RlsSettings, rls_stalled_clocks,
    rls_stalled_latency,
};
use fogbench::fpga::timing::{Units, measure, sample_period_us};
use fogbench::vocabulary::{DesiredSignal, Division, OutputRegister, UnitSource, UpdateSign};

use crate::support::fixed::pipelined;
use crate::support::generated::generated;
use crate::support::stimulus::{predictor_pairs, words};
use crate::support::{code, fogbench, repository, stderr};

/// Bench of the units, which holds every line of a file against them.
const UNIT_BENCH: &str = include_str!("../verilog/unit_bench.v");

fn is_ci() -> bool {
    std::env::var("CI").is_ok_and(|value| value == "true")
}

fn has_iverilog() -> bool {
    let found = Command::new("iverilog").arg("-V").output().is_ok();
    assert!(found || !is_ci(), "iverilog is needed under CI=true");
    if !found {
        eprintln!("skipped: iverilog is not installed");
    }
    found
}

/// A repeatable generator: upper bits of a 64-bit LCG (Knuth's constants).
struct Draws(u64);

impl Draws {
    fn word(&mut self) -> u64 {
        let mut half = || {
            self.0 = self
                .0
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            self.0 >> 32
        };
        half() << 32 | half()
    }

    fn below(&mut self, bound: u64) -> u64 {
        (self.word() >> 8) % bound
    }
}

/// The numbers at which something changes, of both signs: zero, the ends of the subnormal numbers and
/// of the normal ones, around one, halves and doubles, infinity, NaN of either kind.
fn special_words<F: Fp>() -> Vec<u64> {
    let fraction = if F::WIDTH == 64 { 52 } else { 23 };
    let high: u64 = (1 << (F::WIDTH - 1 - fraction)) - 1;
    let word = |exponent: u64, bits: u64| exponent << fraction | bits;
    let (ones, bias): (u64, u64) = ((1 << fraction) - 1, high >> 1);
    let magnitudes = [
        word(0, 0),
        word(0, 1),
        word(0, ones),
        word(1, 0),
        word(1, 1),
        word(2, 0),
        word(bias - if F::WIDTH == 64 { 53 } else { 24 }, 0),
        word(bias - 1, 0),
        word(bias - 1, ones),
        word(bias, 0),
        word(bias, 1),
        word(bias + 1, 0),
        word(high - 1, 0),
        word(high - 1, ones),
        word(high, 0),
        word(high, 1),
        word(high, ones),
    ];
    let sign = 1 << (F::WIDTH - 1);
    let both = magnitudes.into_iter().flat_map(|word| [word, word | sign]);
    both.collect()
}

/// A pair of words: anything, exponents nearby, exponents at the lower end, words that nearly cancel,
/// words of two bits each, which are often halfway.
fn drawn_pair<F: Fp>(draws: &mut Draws) -> (u64, u64) {
    let fraction = if F::WIDTH == 64 { 52 } else { 23 };
    let high: u64 = (1 << (F::WIDTH - 1 - fraction)) - 1;
    let mask = u64::MAX >> (64 - F::WIDTH);
    let (a, b) = (draws.word() & mask, draws.word() & mask);
    let with =
        |word: u64, exponent: u64| word & !(high << fraction) | (exponent & high) << fraction;
    match draws.below(5) {
        0 => (a, b),
        1 => (a, with(b, (a >> fraction) + draws.below(5))),
        2 => {
            let small = draws.below(60);
            let other = [draws.below(60), (high >> 1) - 30 + draws.below(60)];
            (
                with(a, small),
                with(b, other[usize::from(draws.below(2) == 1)]),
            )
        }
        3 => {
            let places = u64::from(fraction);
            let mut bits = || 1 << draws.below(places) | 1 << draws.below(places);
            let (x, y) = (bits(), bits());
            let exponent = 60 + (a >> fraction & 127);
            let other = exponent - draws.below(places + 4);
            (
                with(x, exponent),
                with(y | (b >> (F::WIDTH - 1)) << (F::WIDTH - 1), other),
            )
        }
        _ => (a, (a ^ draws.below(16)) ^ draws.below(2) << (F::WIDTH - 1)),
    }
}

/// Lines of the bench: operation, operands, and what the processor makes of them.
pub(crate) fn unit_lines<F: Fp>(count: usize) -> String {
    let special = special_words::<F>();
    let pairs = special
        .iter()
        .flat_map(|a| special.iter().map(|b| (*a, *b)));
    let mut draws = Draws(7);
    let drawn = (0..count).map(|_| drawn_pair::<F>(&mut draws));
    let digits = F::WIDTH as usize / 4;
    let mut text = String::new();
    let mut line = |operation: usize, a: u64, b: u64, q: u64| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{operation}{a:0digits$x}{b:0digits$x}{q:0digits$x}");
    };
    for (k, (a, b)) in pairs.chain(drawn).enumerate() {
        let (x, y) = (F::from_bits(a), F::from_bits(b));
        let results = [x.add(y), x.sub(y), x.mul(y), x.div(y)];
        // Each special pair goes through every unit, a drawn one through one.
        let is_special = k < special.len() * special.len();
        for (operation, result) in results.into_iter().enumerate() {
            if is_special || k % 4 == operation {
                line(operation, a, b, result.to_bits());
            }
        }
    }
    if F::WIDTH == 64 {
        for word in words_to_narrow(special, count / 4) {
            line(4, word, 0, narrowed(word, F::FLUSHES_SUBNORMALS));
        }
    }
    text
}

/// Words of binary64 around the ends of binary32, and `count` that are drawn, most within them.
fn words_to_narrow(special: Vec<u64>, count: usize) -> Vec<u64> {
    let ends = [
        0x3690_0000_0000_0000, // half the smallest subnormal number, and around it
        0x3690_0000_0000_0001,
        0x36a0_0000_0000_0000,
        0x36b8_0000_0000_0000,
        0x380f_ffff_c000_0000, // the largest subnormal one, and around half a step above
        0x380f_ffff_dfff_ffff,
        0x380f_ffff_e000_0000,
        0x3810_0000_0000_0000,
        0x3810_0000_2000_0000,
        0x47ef_ffff_e000_0000, // the largest one, and around half a step above
        0x47ef_ffff_efff_ffff,
        0x47ef_ffff_f000_0000,
        0x47f0_0000_0000_0000,
    ];
    let negative = ends.map(|word| word | 1 << 63);
    let mut draws = Draws(11);
    let drawn = (0..count).map(|k| {
        let word = draws.word() & !(0x7ff << 52) | (860 + draws.below(300)) << 52;
        // Some lie halfway between two words.
        let halfway = 1 << 28;
        if k % 4 == 0 {
            word >> 29 << 29 | halfway
        } else {
            word
        }
    });
    special
        .into_iter()
        .chain(ends)
        .chain(negative)
        .chain(drawn)
        .collect()
}

/// Bits of the nearest binary32 of a binary64 word.
#[expect(
    clippy::cast_possible_truncation,
    reason = "the rounding to binary32 is what is asked for"
)]
fn narrowed(word: u64, flushes: bool) -> u64 {
    let narrow = f64::from_bits(word) as f32;
    let bits = if narrow.is_nan() {
        0x7fc0_0000
    } else if flushes && narrow.is_subnormal() {
        narrow.to_bits() & 0x8000_0000
    } else {
        narrow.to_bits()
    };
    u64::from(bits)
}

/// Writes the bench of the units over lines and its script into a folder.
pub(crate) fn write_unit_bench<F: Fp>(dir: &Path, lines: &str, latency: u64) {
    let (width, flushes) = (F::WIDTH, u8::from(F::FLUSHES_SUBNORMALS));
    let count = lines.lines().count();
    let script = format!(
        "cd \"$(dirname \"$0\")\"\n\
         iverilog -g2012 -Wall -Wno-timescale -P unit_bench.W={width} -P unit_bench.FTZ={flushes} \
         -P unit_bench.LATENCY={latency} -P unit_bench.COUNT={count} -s unit_bench -o bench \
         unit_bench.v fp_units.v fp_wait.v front_end.v && vvp -n bench\n"
    );
    for (name, text) in [
        ("unit_bench.v", UNIT_BENCH),
        ("units.hex", lines),
        ("fp_units.v", FP_UNITS),
        ("fp_wait.v", FP_WAIT),
        ("front_end.v", FRONT_END),
        ("run.sh", &script),
    ] {
        fs::write(dir.join(name), text).expect("a writable folder");
    }
}

/// Runs the bench of the units over lines; returns what it prints.
fn run_units<F: Fp>(dir: &Path, lines: &str, units: &str, latency: u64) -> String {
    write_unit_bench::<F>(dir, lines, latency);
    fs::write(dir.join("fp_units.v"), units).expect("a writable folder");
    let shell = Command::new("sh").arg(dir.join("run.sh")).output();
    let output = shell.expect("a shell");
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

const FP_WAIT: &str = include_str!("../../src/fpga/export/rtl/fp_wait.v");
const FP_UNITS: &str = include_str!("../../src/fpga/export/rtl/fp_units.v");
const FRONT_END: &str = include_str!("../../src/fpga/export/rtl/front_end.v");
const FP_SIM: &str = include_str!("../../src/fpga/export/rtl/fp_sim.v");

fn check_units<F: Fp>(latencies: &[u64]) {
    if !has_iverilog() {
        return;
    }
    let lines = unit_lines::<F>(if is_ci() { 25_000 } else { 800 });
    let dir = tempfile::tempdir().expect("a temporary folder");
    for latency in latencies {
        let printed = run_units::<F>(dir.path(), &lines, FP_UNITS, *latency);
        assert!(
            printed.contains("PASS"),
            "{}, {latency}: {printed}",
            F::NAME
        );
        assert!(!printed.contains("warning"), "{printed}");
    }
}

#[test]
fn units_for_synthesis_have_the_bits_of_the_processor_in_binary64() {
    check_units::<f64>(&[1, 5]);
}

#[test]
fn units_for_synthesis_have_the_bits_of_the_processor_in_binary32() {
    check_units::<f32>(&[2, 6]);
}

#[test]
fn units_for_synthesis_flush_subnormals_of_binary64() {
    check_units::<FlushToZero<f64>>(&[3, 57]);
}

#[test]
fn units_for_synthesis_flush_subnormals_of_binary32() {
    check_units::<FlushToZero<f32>>(&[4, 28]);
}

#[test]
fn units_of_the_simulator_keep_the_same_handshake() {
    if !has_iverilog() {
        return;
    }
    let dir = tempfile::tempdir().expect("a temporary folder");
    let lines = unit_lines::<f32>(100);
    for latency in [1, 7] {
        let printed = run_units::<f32>(dir.path(), &lines, FP_SIM, latency);
        assert!(printed.contains("PASS"), "{latency}: {printed}");
    }
}

#[test]
fn a_wrong_unit_is_noticed() {
    if !has_iverilog() {
        return;
    }
    let dir = tempfile::tempdir().expect("a temporary folder");
    let lines = unit_lines::<f32>(2000);
    for (right, wrong) in [
        // Ties away from zero; a sticky bit lost; a row of the division left out; NaN let through.
        ("c_s[0] & (c_rest | c_s[1])", "c_s[0]"),
        ("y[0] | rest", "y[0]"),
        ("(QB + N - 1) / N;", "(QB + N - 1) / N - 1;"),
        ("(x_high & y_high & s1_minus)", "1'b0"),
        ("is_last & take", "is_last"),
    ] {
        let units = FP_UNITS.replacen(right, wrong, 1);
        let printed = if units == FP_UNITS {
            let wait = FP_WAIT.replacen(right, wrong, 1);
            assert_ne!(wait, FP_WAIT, "{right}");
            let script = units + &wait.replace("module fp_wait", "module fp_other");
            let script = script.replace("fp_wait #", "fp_other #");
            run_units::<f32>(dir.path(), &lines, &script, 4)
        } else {
            run_units::<f32>(dir.path(), &lines, &units, 4)
        };
        assert!(printed.contains("MISMATCH"), "{right}: {printed}");
    }
}

/// A filter and latencies of its units.
struct Mix {
    load: RlsLoad,
    alpha: f64,
    units: Units,
}

/// Mixes that name every tap count, both divisions, alpha of 1 and below.
fn mixes(count: usize) -> Vec<Mix> {
    let mut draws = Draws(16);
    (0..count)
        .map(|k| {
            let alpha = [1.0, 0.97][k / 8 % 2];
            let load = RlsLoad {
                tap_count: 1 + k % 8,
                division: [Division::Reciprocal, Division::Elementwise][k / 16 % 2],
                forgets: alpha < 1.0,
            };
            let (adder, multiplier) = (1 + draws.below(16), 1 + draws.below(16));
            let units = pipelined(adder, multiplier, 1 + draws.below(64));
            Mix { load, alpha, units }
        })
        .collect()
}

fn config<F: Fp>(mix: &Mix) -> RlsConfig<F> {
    let config = RlsConfig::new(RlsSettings {
        tap_count: mix.load.tap_count,
        forgetting_factor: mix.alpha,
        initial_inverse_correlation: 1e4,
        division: mix.load.division,
        update_sign: UpdateSign::Corrected,
    });
    let config = config.expect("settings are in range");
    config
        .with_units(mix.units)
        .expect("latencies are in range")
}

fn settings<F: Fp>(config: RlsConfig<F>, trace_samples: usize) -> ExportSettings<F> {
    ExportSettings {
        pipeline: PipelineConfig::Rls(config),
        clock_mhz: 40.0,
        front_end: "one-step predictor".to_owned(),
        trace_samples,
        codes: None,
        top: None,
    }
}

/// Runs the folder's script with variables of the environment; returns what it prints.
#[track_caller]
fn assert_passes(dir: &Path, variables: &[(&str, &str)], plusargs: &[&str]) -> String {
    let mut command = Command::new("sh");
    command
        .arg(dir.join("run.sh"))
        .args(plusargs)
        .current_dir("/");
    let output = command
        .envs(variables.iter().copied())
        .output()
        .expect("a shell");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let text = text + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && text.contains("PASS"), "{text}");
    text
}

#[test]
fn model_and_timing_have_the_same_clocks_and_words_for_200_mixes_of_latencies() {
    for mix in mixes(200) {
        let config = config::<f64>(&mix);
        let pairs = predictor_pairs::<f64>("white", 5);
        let (mut wanted, mut got) = (Vec::new(), Vec::new());
        RlsEngine::new(config).run(&pairs, &mut wanted);
        let mut pipeline = RlsPipeline::new(config);
        pipeline.run(&pairs, &mut got);
        assert_eq!(
            words(&got),
            words(&wanted),
            "{:?}, {:?}",
            mix.load,
            mix.units
        );
        let used = measure(RlsPipeline::new(config));
        let clocks = rls_stalled_clocks(mix.load, mix.units).expect("in range");
        let latency = rls_stalled_latency(mix.load, mix.units).expect("in range");
        assert_eq!(
            (used.clocks_per_sample, used.latency_clocks),
            (clocks, latency)
        );
        let by_state: u64 = used.states.iter().map(|state| state.clocks).sum();
        assert_eq!(by_state, clocks);
    }
}

#[test]
fn rtl_has_the_clocks_and_words_of_the_model_for_units_of_any_latency() {
    if !has_iverilog() {
        return;
    }
    // Every clock of a sample is compared; all 200 in CI, elsewhere one of each tap count and more.
    let chosen = if is_ci() { 1 } else { 19 };
    let dir = tempfile::tempdir().expect("a temporary folder");
    for mix in mixes(200).iter().step_by(chosen) {
        let pairs = predictor_pairs::<f64>("white", 4);
        write_rtl(dir.path(), &settings(config(mix), 2), &pairs).expect("a writable folder");
        let report = assert_passes(dir.path(), &[], &["+RESETS=0"]);
        let clocks = rls_stalled_clocks(mix.load, mix.units).expect("in range");
        assert!(report.contains(&format!("period {clocks},")), "{report}");
        let rows = report.split("; ").find(|part| part.contains("trace rows"));
        assert!(!rows.expect("rows are told").starts_with("0 "), "{report}");
    }
}

#[test]
fn resets_and_latencies_of_ones_own_leave_the_words_as_they_are() {
    if !has_iverilog() {
        return;
    }
    let dir = tempfile::tempdir().expect("a temporary folder");
    for mix in mixes(200).iter().skip(10).step_by(64) {
        let pairs = predictor_pairs::<f64>("white", 4);
        write_rtl(dir.path(), &settings(config(mix), 2), &pairs).expect("a writable folder");
        let report = assert_passes(dir.path(), &[], &["+GAP=700", "+GAP_SEED=3", "+WITHDRAW"]);
        assert!(!report.contains(" 0 resets;"), "{report}");
        let other = [
            ("ADD_LATENCY", "3"),
            ("MUL_LATENCY", "2"),
            ("DIV_LATENCY", "5"),
        ];
        let report = assert_passes(dir.path(), &other, &["+RESETS=0"]);
        let clocks = rls_stalled_clocks(mix.load, pipelined(3, 2, 5)).expect("in range");
        assert!(report.contains(&format!("period {clocks},")), "{report}");
    }
}

/// The handshake of a unit that takes as long as it likes, another time each time.
const WITHHOLDING: &str = "module fp_wait #(parameter LATENCY = 1) (input wire clk, input wire rst,
    input wire req, input wire take, output wire first, output wire done);
    reg ready;
    integer seed;
    initial begin ready = 1'b0; seed = LATENCY; end
    always @(posedge clk)
        if (rst | ~req | take) ready <= $unsigned($random(seed)) % 3 == 0;
        else if (!ready) ready <= $unsigned($random(seed)) % 3 == 0;
    assign done  = req & ready;
    assign first = 1'b1;
endmodule
";

#[test]
fn units_that_stall_at_random_change_no_word() {
    if !has_iverilog() {
        return;
    }
    let dir = tempfile::tempdir().expect("a temporary folder");
    for mix in mixes(32).iter().skip(3).step_by(9) {
        let one_clock = Mix {
            units: Units::ONE_CLOCK,
            ..*mix
        };
        for latency in ["1", "2"] {
            let pairs = predictor_pairs::<f64>("white", 6);
            let settings = settings(config(&one_clock), 2);
            write_rtl(dir.path(), &settings, &pairs).expect("a writable folder");
            fs::write(dir.path().join("fp_wait.v"), WITHHOLDING).expect("a writable folder");
            let variables = [("SIM_FLAGS", "-DVEC_ANY_CLOCKS"), ("ADD_LATENCY", latency)];
            assert_passes(dir.path(), &variables, &["+GAP=40", "+GAP_SEED=9"]);
        }
    }
}

#[test]
fn a_filter_of_units_for_synthesis_has_the_words_of_the_model() {
    fn check<F: Fp>(units: Units) {
        let mix = Mix {
            load: RlsLoad {
                tap_count: 3,
                division: Division::Reciprocal,
                forgets: true,
            },
            alpha: 0.97,
            units,
        };
        let pairs: Vec<Pair<F>> = predictor_pairs("rocking", 12);
        let dir = tempfile::tempdir().expect("a temporary folder");
        let parts = RtlParts {
            units: UnitSource::Synthesizable,
            device: None,
        };
        write_rtl_parts(dir.path(), &settings(config(&mix), 4), &pairs, parts)
            .expect("a writable folder");
        assert!(!dir.path().join("fp_sim.v").exists());
        assert_passes(dir.path(), &[], &[]);
    }
    if !has_iverilog() {
        return;
    }
    check::<f64>(pipelined(4, 5, 16));
    check::<f32>(Units::ONE_CLOCK);
    check::<FlushToZero<f64>>(pipelined(2, 1, 3));
    check::<FlushToZero<f32>>(pipelined(5, 3, 30));
}

/// A filter that forgets, of three taps.
fn forgetting(units: Units) -> Mix {
    let load = RlsLoad {
        tap_count: 3,
        division: Division::Elementwise,
        forgets: true,
    };
    Mix {
        load,
        alpha: 0.97,
        units,
    }
}

fn surroundings(desired: DesiredSignal) -> Surroundings {
    Surroundings {
        desired,
        input_lag_samples: 2,
        output_register: OutputRegister::NextSample,
        scale: Some(CodeScale {
            lsb: 1e-4,
            unit: "deg/s".to_owned(),
            factor: 3600.0,
            word_unit: "deg/h".to_owned(),
        }),
    }
}

#[test]
fn front_end_of_units_with_latency_adds_it_and_no_clock_to_the_period() {
    let mix = forgetting(pipelined(3, 5, 9));
    let clocks = rls_stalled_clocks(mix.load, mix.units).expect("in range");
    for (desired, front) in [
        (DesiredSignal::Current, 1 + 2 * 5),
        (DesiredSignal::TwoSampleMean, 1 + 2 * 5 + 3 + 5),
    ] {
        let used = Board::new(RlsPipeline::new(config::<f64>(&mix)), surroundings(desired)).usage();
        assert_eq!(used.front_end_clocks, front);
        assert_eq!(used.clocks_per_sample, clocks);
    }
}

#[test]
fn the_top_level_of_units_with_latency_has_the_words_and_clocks_of_the_model() {
    fn check<F: Fp>(desired: DesiredSignal, source: UnitSource) {
        let around = surroundings(desired);
        let scale = around.scale.clone().expect("codes");
        let codes: Vec<i32> = (0..12_i32).map(|k| (k * k * 37) % 2001 - 1000).collect();
        let samples: Vec<f64> = codes.iter().map(|code| scale.word(*code)).collect();
        let pairs = stimulus_pairs(&samples, &mut FrontEnd::<F>::new(desired, 2)).expect("finite");
        let mut settings = settings(config(&forgetting(pipelined(3, 2, 7))), 1);
        settings.codes = Some(IntegerCodes { codes, scale });
        settings.top = Some(TopLevel {
            surroundings: around,
            samples: samples.into_iter().map(F::from_f64).collect(),
        });
        let dir = tempfile::tempdir().expect("a temporary folder");
        let parts = RtlParts {
            units: source,
            device: None,
        };
        write_rtl_parts(dir.path(), &settings, &pairs, parts).expect("a writable folder");
        let report = assert_passes(dir.path(), &[("BENCH", "top")], &[]);
        assert!(report.contains("PASS top level: 12 results"), "{report}");
    }
    if !has_iverilog() {
        return;
    }
    check::<f64>(DesiredSignal::TwoSampleMean, UnitSource::Behavioural);
    check::<f32>(DesiredSignal::Current, UnitSource::Synthesizable);
}

#[test]
fn an_export_for_synthesis_holds_its_units_and_its_script() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("s.csv"), "1.0\n-2.5\n0.75\n2.0\n").expect("writable");
    let run = |more: &str| {
        let words = format!("export rtl out --force --stimulus s.csv --taps 2 {more}");
        fogbench(folder.path(), &words.split(' ').collect::<Vec<_>>())
    };
    let latencies = "--adder-latency 2 --multiplier-latency 3 --divider-latency 4";
    let output = run(&format!("{latencies} --synth ecp5"));
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let out = folder.path().join("out");
    let script = fs::read_to_string(out.join("synth.sh")).expect("the script");
    assert!(script.contains("device=ecp5\ntop=rls_top\n"), "{script}");
    assert!(!script.contains('@'), "{script}");
    let sources = script
        .lines()
        .find_map(|line| line.strip_prefix("sources=\""));
    let sources = sources.expect("the sources").trim_end_matches('"');
    for source in sources.split(' ') {
        assert!(out.join(source).exists(), "{source}");
    }
    let json = fs::read_to_string(out.join("params.json")).expect("parameters");
    for part in [
        "\"add_latency\": 2,",
        "\"mul_latency\": 3,",
        "\"div_latency\": 4,",
    ] {
        assert!(json.contains(part), "{part} in {json}");
    }
    if has_iverilog() {
        assert_passes(&out, &[], &[]);
    }
}

#[test]
fn units_of_other_latencies_are_refused_where_there_is_no_machine() {
    let lms = CoreSettings::Lms(LmsSettings {
        tap_count: 4,
        step_size: 0.5,
        regularisation: Some(1.0),
        desired: DesiredSource::Port,
        update_sign: UpdateSign::Corrected,
    });
    assert!(lms.config_with::<f64>(Units::ONE_CLOCK).is_ok());
    let refused = lms.config_with::<f64>(pipelined(1, 3, 1)).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "latency of a unit = 3 is out of range: expected 1 clock: only rls is exported with more; \
         run.sh takes DIV_LATENCY for the others"
    );
    let load = mixes(1);
    let config = config::<f64>(&load[0]);
    assert!(config.with_units(pipelined(0, 1, 1)).is_err());
    assert!(config.with_units(pipelined(1, 1, 1001)).is_err());
}

/// The table of the page on hardware: what was measured, and the clocks that the machine takes.
fn table_of_syntheses() -> String {
    let rows = include_str!("../synthesis/table.csv");
    let mut text = String::from(
        "taps  words     device  clocks  Fmax MHz  us a sample      kHz   LUTs     FFs  DSPs  LUT RAMs\n",
    );
    let headings: Vec<&str> = rows.lines().next().expect("headings").split(',').collect();
    for row in rows.lines().skip(1) {
        let cells: Vec<&str> = row.split(',').collect();
        let cell = |name: &str| {
            let place = headings.iter().position(|heading| *heading == name);
            cells[place.expect("a heading")]
        };
        let count = |name: &str| cell(name).parse::<u64>().expect("a count");
        let load = RlsLoad {
            tap_count: usize::try_from(count("taps")).expect("a few"),
            division: Division::Reciprocal,
            forgets: true,
        };
        let units = pipelined(count("adder"), count("multiplier"), count("divider"));
        let clocks = rls_stalled_clocks(load, units).expect("in range");
        let rates = match cell("fmax_mhz").parse::<f64>() {
            Ok(fmax) => {
                let period_us = sample_period_us(clocks, fmax);
                format!("{fmax:>8.1}  {period_us:>11.1} {:>8.1}", 1e3 / period_us)
            }
            Err(_) if cell("device") == "xilinx" => {
                format!("{:>8}  {:>11} {:>8}", "no router", "", "")
            }
            Err(_) => format!("{:>8}  {:>11} {:>8}", "unrouted", "", ""),
        };
        writeln!(
            text,
            "{:>4}  {:8}  {:6}  {clocks:>6}  {rates} {:>6}  {:>6}  {:>4}  {:>8}",
            cell("taps"),
            cell("format"),
            cell("device"),
            cell("luts"),
            cell("flip_flops"),
            cell("dsps"),
            cell("lut_rams"),
        )
        .expect("writing to a string cannot fail");
    }
    text
}

#[test]
fn generated_table_of_the_syntheses() {
    let page = fs::read_to_string(repository("docs/hardware.md")).expect("the page");
    let mark = "<!-- generated from tests/synthesis/table.csv -->\n```text\n";
    let (before, after) = page.split_once(mark).expect("the place of the table");
    let (_, after) = after.split_once("```\n").expect("its end");
    let table = table_of_syntheses();
    generated(
        "docs/hardware.md",
        &format!("{before}{mark}{table}```\n{after}"),
    );
}
