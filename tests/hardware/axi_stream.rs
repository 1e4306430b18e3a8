//! The AXI4-Stream ports of an export: same words under any back-pressure, none lost, none doubled, and
//! flags that tell what happened.
//!
//! Without `iverilog` the simulations are skipped; with `CI=true` that is a failure.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::support::fixed::{has, simulate};
use crate::support::{code, fogbench, is_ci, stderr, write};

/// Samples of which the testbench takes some.
const SAMPLES: usize = 60;

/// A swing with a jump, deg/h.
fn stimulus() -> String {
    let mut text = String::from("rate\n");
    for k in 0_u32..60 {
        let jump = if k < 40 { 0.0 } else { 300.0 };
        let rate = 1000.0 * (0.2 * f64::from(k)).sin() + jump + f64::from(k * k * 37 % 101);
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{rate}");
    }
    text
}

/// Exports with these options into a folder of its own.
fn export(folder: &Path, options: &str) {
    write(folder, "rate.csv", &stimulus());
    let options = options.split_whitespace();
    let given = ["export", "rtl", "rtl", "--stimulus", "rate.csv"];
    let arguments: Vec<&str> = given.into_iter().chain(options).collect();
    let output = fogbench(folder, &arguments);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
}

/// Runs the testbench of the ports and returns what it prints.
fn passes(rtl: &Path) -> String {
    let (passed, text) = simulate(rtl, &[("BENCH", "axis")]);
    let told = format!("PASS stream ports: {SAMPLES} results, three ways; ");
    assert!(passed && text.contains(&told), "{text}");
    let (_, after) = text.split_once(&told).expect("it passed");
    let lost: u32 = after
        .split_once(' ')
        .and_then(|(count, _)| count.parse().ok())
        .expect("a count of lost words");
    assert!(lost > 10, "{text}");
    text
}

/// Whether a word of the vectors is a NaN and whether one is infinite.
fn nan_and_infinite(rtl: &Path) -> (bool, bool) {
    let text = fs::read_to_string(rtl.join("y.hex")).expect("words");
    let words: Vec<f64> = text
        .lines()
        .map(
            |line| match u64::from_str_radix(line, 16).expect("digits") {
                bits if line.len() == 16 => f64::from_bits(bits),
                bits => f64::from(f32::from_bits(u32::try_from(bits).expect("32 bits"))),
            },
        )
        .collect();
    let is_nan = words.iter().any(|word| word.is_nan());
    (is_nan, words.iter().any(|word| word.is_infinite()))
}

#[test]
fn stream_ports_of_every_floating_point_kind_give_the_words_of_the_model() {
    if !has("iverilog") {
        return;
    }
    for (options, wants_nan) in [
        (
            "--taps 3 --forgetting-factor 0.97 --number-format binary64",
            false,
        ),
        (
            "--taps 2 --division elementwise --number-format binary32-ftz --adder-latency 3 \
             --multiplier-latency 2 --divider-latency 5",
            false,
        ),
        // The step of the paper is far too large for words in deg/h.
        ("--kind lms --taps 3", true),
        ("--kind nlms --taps 1 --number-format binary32", false),
        (
            "--kind sign-lms --taps 4 --number-format binary64-ftz",
            false,
        ),
    ] {
        let folder = tempfile::tempdir().expect("a scratch folder");
        export(folder.path(), options);
        let rtl = folder.path().join("rtl");
        let text = passes(&rtl);
        let (nan, infinite) = nan_and_infinite(&rtl);
        assert_eq!(nan, wants_nan, "{options}");
        let flags = format!(
            "flags: nan {} overflow {}",
            u8::from(nan),
            u8::from(infinite)
        );
        assert!(text.contains(&flags), "{options}: no {flags} in {text}");
    }
}

#[test]
fn stream_ports_of_every_fixed_point_kind_give_words_and_faults_of_the_model() {
    if !has("iverilog") {
        return;
    }
    let mut overflown = Vec::new();
    for kind in ["rls", "lms", "nlms", "sign-lms"] {
        let folder = tempfile::tempdir().expect("a scratch folder");
        let options = format!("--kind {kind} --number-format fixed --taps 3");
        export(folder.path(), &options);
        let rtl = folder.path().join("rtl");
        let text = passes(&rtl);
        let parameters = fs::read_to_string(rtl.join("params.vh")).expect("parameters");
        let at = |name: &str| {
            let line = parameters.lines().find(|line| line.contains(name));
            let (_, value) = line.and_then(|line| line.rsplit_once(' ')).expect(name);
            value.parse::<i32>().expect("a sample")
        };
        let [overflow, indefinite] =
            ["VEC_AXIS_OVERFLOW_AT", "VEC_AXIS_INDEFINITE_AT"].map(|name| u8::from(at(name) >= 0));
        let flags = format!("flags: nan 0 overflow {overflow} indefinite {indefinite}");
        assert!(text.contains(&flags), "{kind}: no {flags} in {text}");
        overflown.push(overflow);
        // A flag that comes with another sample, or not at all, is noticed.
        for name in ["VEC_AXIS_OVERFLOW_AT", "VEC_AXIS_INDEFINITE_AT"] {
            let right = format!("{name} {}\n", at(name));
            let wrong = format!("{name} {}\n", if at(name) == 5 { -1 } else { 5 });
            let changed = parameters.replace(&right, &wrong);
            fs::write(rtl.join("params.vh"), &changed).expect("a writable folder");
            let (passed, text) = simulate(&rtl, &[("BENCH", "axis")]);
            assert!(!passed && text.contains("MISMATCH"), "{name}: {text}");
        }
    }
    assert!(overflown.contains(&0) && overflown.contains(&1));
}

#[test]
fn stream_ports_take_the_codes_of_a_gyro_and_words_of_any_width() {
    if !has("iverilog") {
        return;
    }
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(
        folder.path(),
        "a.toml",
        "schema = 1\nname = \"a\"\nduration_s = 1.0\nwarm_up_s = 0.25\nfidelity = \"rate\"\n\
         [[filter]]\nname = \"f\"\n[filter.rls]\npipeline = \"fpga\"\noutput_register = \"immediate\"\n\
         desired = \"two-sample-mean\"\n\
         [[filter]]\nname = \"q\"\n[filter.rls]\npipeline = \"fpga\"\nnumber_format = \"fixed\"\n\
         initial_inverse_correlation = 1.97e-5\n[filter.rls.fixed]\nd.word_bits = 21\ny.word_bits = 27\n",
    );
    for (filter, ports) in [("f", ["31:0", "63:0"]), ("q", ["23:0", "31:0"])] {
        let arguments = [
            "export",
            "rtl",
            filter,
            "--scenario",
            "a.toml",
            "--filter",
            filter,
            "--samples",
            "60",
        ];
        let output = fogbench(folder.path(), &arguments);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let rtl = folder.path().join(filter);
        passes(&rtl);
        let name = if filter == "f" { "rls" } else { "rls_fixed" };
        let text = fs::read_to_string(rtl.join(format!("{name}_axis.v"))).expect("the ports");
        let [input, output] = ports;
        for port in [
            format!("input  wire [{input}] s_axis_tdata"),
            format!("output wire [{output}] m_axis_tdata"),
        ] {
            assert!(text.contains(&port), "no {port} in {text}");
        }
    }
}

#[test]
fn broken_stream_ports_are_noticed() {
    if !has("iverilog") {
        return;
    }
    let folder = tempfile::tempdir().expect("a scratch folder");
    export(
        folder.path(),
        "--kind lms --taps 2 --number-format fixed --samples 60",
    );
    let rtl = folder.path().join("rtl");
    let path = rtl.join("axi_stream.v");
    let text = fs::read_to_string(&path).expect("the ports");
    for (right, wrong) in [
        // A third sample is taken while two results wait.
        ("sample_ready & ~due[1]", "sample_ready"),
        // A word goes as soon as the next has come.
        (
            "if (given | (held == 2'd0)) oldest",
            "if (given | result_valid) oldest",
        ),
        // A word that waits is not kept.
        ("if (given | (held == 2'd0)) oldest", "if (given) oldest"),
        // Valid for one clock, whether the word was taken or not.
        ("assign m_axis_tvalid = held", "assign m_axis_tvalid = due"),
        // Not every lost word, or words that are not lost.
        ("~s_axis_tvalid | (sample != waiting)", "~s_axis_tvalid"),
        ("~s_axis_tvalid | (sample != waiting)", "sample != waiting"),
        (
            "waited  <= s_axis_tvalid & ~s_axis_tready",
            "waited  <= s_axis_tvalid",
        ),
        ("lost       | (flag_overrun & ~flags_clear)", "lost"),
        (
            "lost       | (flag_overrun & ~flags_clear)",
            "~flags_clear & (lost | flag_overrun)",
        ),
        ("flag_overrun & ~flags_clear", "flag_overrun"),
        // A reset that forgets the samples under way.
        ("due    <= 2'd0;\n", ""),
    ] {
        assert_eq!(text.matches(right).count(), 1, "{right}");
        fs::write(&path, text.replace(right, wrong)).expect("a writable folder");
        let (passed, printed) = simulate(&rtl, &[("BENCH", "axis")]);
        let is_noticed = !passed && printed.contains("MISMATCH");
        assert!(is_noticed, "{right} -> {wrong}: {printed}");
    }
}

/// Runs a script of yosys over the sources of the ports of a kind; returns what it prints.
fn yosys(rtl: &Path, kind: &str, sources: &str, script: &str) -> String {
    let top = format!("{kind}_axis");
    let script = format!(
        "read_verilog -DSYNTHESIS {top}.v axi_stream.v {kind}_top.v {kind}_core.v sp_ram.v {sources}; \
         hierarchy -check -top {top}; proc; select -assert-none t:$dlatch; {script}"
    );
    let output = Command::new("yosys")
        .args(["-p", &script])
        .current_dir(rtl)
        .output()
        .expect("yosys runs");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{script}: {text}{error}");
    text
}

#[test]
fn yosys_knows_every_module_behind_the_stream_ports_and_maps_them() {
    if !has("yosys") {
        return;
    }
    let float = "front_end.v den_check.v fp_wait.v fp_units.v";
    for (kind, own, control) in [
        ("rls", "--units synthesizable", "rls_ctrl.v"),
        ("lms", "--units synthesizable", "lms_ctrl.v"),
        ("sign-lms", "--units synthesizable", "sign_lms_ctrl.v"),
        ("rls", "--number-format fixed", ""),
        ("nlms", "--number-format fixed", "lms_ctrl.v"),
        ("sign-lms", "--number-format fixed", "sign_lms_ctrl.v"),
    ] {
        let folder = tempfile::tempdir().expect("a scratch folder");
        let is_fixed = own.contains("fixed");
        let format = if is_fixed {
            ""
        } else {
            " --number-format binary32"
        };
        let options = format!("--kind {kind} --taps 2 --samples 5 {own}{format}");
        export(folder.path(), &options);
        let rtl = folder.path().join("rtl");
        let name = kind.replace("nlms", "lms").replace('-', "_");
        let (name, parts) = match is_fixed {
            true => (format!("{name}_fixed"), "fx_front_end.v fx.v fp_wait.v"),
            false => (name, float),
        };
        let sources = format!("{parts} {control}");
        // What is left are cells that yosys knows: no module that it does not, no black box.
        let script = "flatten; opt -fast; check -assert; select -assert-none t:* t:$* %d";
        yosys(&rtl, &name, &sources, script);
        // The mapping of multipliers and dividers takes minutes.
        if is_ci() && kind == "lms" {
            let text = yosys(
                &rtl,
                &name,
                &sources,
                "synth_ecp5; hierarchy -check; check -assert; stat",
            );
            assert!(text.contains("TRELLIS_FF"), "{text}");
        }
    }
}
