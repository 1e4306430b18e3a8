//! The hardware commands as a user meets them: `timing`, `export`, and the audit scenarios.

use std::path::Path;
use std::process::Command;

use crate::support::transcript::Transcript;
use crate::support::{code, fogbench, repository, scratch, stderr, stdout, summary, write};

#[test]
fn published_timing_at_four_taps_and_forty_megahertz_is_printed() {
    let folder = scratch();
    let arguments = ["timing", "--taps", "4", "--clock-mhz", "40"];
    let text = stdout(&fogbench(folder.path(), &arguments));
    for part in ["108 clocks", "2.70 us", "370.4 kHz", "99 clocks, 2.475 us"] {
        assert!(text.contains(part), "no `{part}` in:\n{text}");
    }
    let json = stdout(&fogbench(
        folder.path(),
        &[&arguments[..], &["--format", "json"]].concat(),
    ));
    let report: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(report["clocks_per_sample"], 108);
    assert_eq!(report["latency_clocks"], 99);
    let number = |key: &str| report[key].as_f64().expect("a number");
    assert!((number("sample_period_us") - 2.7).abs() < 1e-12);
    assert!((number("latency_us") - 2.475).abs() < 1e-12);
    assert!((number("sample_rate_max_khz") - 1e3 / 2.7).abs() < 1e-9);
    assert_eq!(report["table"].as_array().expect("rows").len(), 6);
}

#[test]
fn units_with_latency_stall_the_pipeline() {
    // HardFloat's divider of 56 clocks: 108 + 55.
    let folder = scratch();
    let output = fogbench(
        folder.path(),
        &["timing", "--divider-latency", "56", "--format", "jsonl"],
    );
    let report: serde_json::Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    assert_eq!(report["stalled"]["clocks"], 163);
}

#[test]
fn bad_hardware_parameters_exit_2_and_say_the_range() {
    let folder = scratch();
    write(folder.path(), "good.csv", "1.0\n2.0\n");
    write(folder.path(), "bad.csv", "rate\n1.0\nnan\n");
    write(folder.path(), "words.csv", "rate\n1.0\ntwo\n");
    let mut transcript = Transcript::of("hardware", "Parameters of hardware that cannot be");
    let good = "export vectors out --stimulus good.csv";
    for arguments in [
        "timing --taps 0",
        "timing --forgetting-factor 1.5",
        "timing --clock-mhz 0",
        "timing --adder-latency 0",
        &format!("{good} --taps 0"),
        &format!("{good} --forgetting-factor 0"),
        &format!("{good} --initial-inverse-correlation=-1"),
        "export vectors out --stimulus bad.csv",
        "export vectors out --stimulus words.csv",
        &format!("{good} --synth ecp5"),
        &format!("{good} --kind nlms --adder-latency 3"),
        "export rtl out --stimulus good.csv --synth ecp5 --units behavioural",
    ] {
        let words: Vec<&str> = arguments.split(' ').collect();
        let output = fogbench(folder.path(), &words);
        assert_eq!(code(&output), 2, "{arguments}");
        transcript.case(arguments, stderr(&output));
    }
    let arguments = ["export", "vectors", "out", "--stimulus", "none.csv"];
    let missing = fogbench(folder.path(), &arguments);
    assert_eq!(code(&missing), 74, "{}", stderr(&missing));
    transcript.case(arguments.join(" "), stderr(&missing));
    transcript.check();
    assert!(
        !folder.path().join("out").exists(),
        "nothing is written in error"
    );
}

/// A scenario whose filter has fixed-point words.
fn fixed_scenario(keys: &str) -> String {
    format!(
        "schema = 1\nname = \"a\"\nduration_s = 1.0\nwarm_up_s = 0.0\nfidelity = \"rate\"\n\
         [[filter]]\nname = \"rls\"\n[filter.rls]\npipeline = \"fpga\"\nnumber_format = \"fixed\"\n\
         {keys}"
    )
}

#[test]
fn a_fixed_point_filter_of_a_scenario_runs_and_its_export_proves_itself() {
    let folder = scratch();
    let keys = "taps = 8\nforgetting_factor = 0.97\ninitial_inverse_correlation = 1e-5\n\
                [filter.rls.fixed]\nword_bits = 36\nrounding = \"nearest-even\"\n\
                r.word_bits = 40\ny = { integer_bits = 2, overflow = \"wrap\" }\n";
    write(folder.path(), "a.toml", &fixed_scenario(keys));
    let output = fogbench(folder.path(), &["run", "a.toml", "-o", "out"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let rls = &summary(folder.path(), "out/a")["channels"]["rls"];
    assert_eq!(rls["clocks_per_sample"]["value"], 252.0, "{rls}");
    let arguments = "export rtl rtl --scenario a.toml --filter rls --samples 60";
    let arguments: Vec<&str> = arguments.split(' ').collect();
    let output = fogbench(folder.path(), &arguments);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let parameters = std::fs::read_to_string(folder.path().join("rtl/params.json"));
    let parameters: serde_json::Value =
        serde_json::from_str(&parameters.expect("parameters")).expect("JSON");
    let formats = &parameters["formats"];
    assert_eq!(parameters["p"], 8);
    assert_eq!(formats["R"]["fraction_bits"], 26);
    assert_eq!(formats["y"]["overflow"], "wrap");
    assert_eq!(formats["k"]["rounding"], "nearest-even");
    if Command::new("iverilog").arg("-V").output().is_err() {
        assert!(!crate::support::is_ci(), "iverilog is missing under CI");
        eprintln!("skipped: iverilog is not installed");
        return;
    }
    let run = Command::new("sh")
        .arg(folder.path().join("rtl/run.sh"))
        .output();
    let text = stdout(&run.expect("a shell"));
    // The core, its top level, and the stream ports around it.
    assert_eq!(text.matches("PASS").count(), 3, "{text}");
}

#[test]
fn words_that_are_too_short_are_told_beside_their_twin_in_binary64() {
    let folder = scratch();
    let text = fixed_scenario("initial_inverse_correlation = 1.97e-5\n").replace(
        "[[filter]]",
        "[turntable.swing]\nfrequency_hz = 10.0\nrate_amplitude_deg_per_s = 1.0\nsoft_start_s = 0.0\n[[filter]]",
    );
    let float = "[[filter]]\nname = \"float\"\n[filter.rls]\npipeline = \"fpga\"\n\
                 initial_inverse_correlation = 1.97e-5\n";
    write(folder.path(), "a.toml", &format!("{text}{float}"));
    let run = |out: &str, set: &[&str]| {
        let mut arguments = vec!["run", "a.toml", "-o", out];
        arguments.extend(set.iter().flat_map(|one| ["--set", *one]));
        let output = fogbench(folder.path(), &arguments);
        let words = summary(&folder.path().join(out), "a")["channels"].clone();
        (code(&output), words)
    };
    let figure = |channel: &serde_json::Value, name: &str| channel[name]["value"].as_f64();
    let (exit, channels) = run("wide", &["filter.rls.fixed.word_bits=44"]);
    assert_eq!(exit, 0);
    let (wide, float) = (&channels["rls"], &channels["float"]);
    for signal in ["x", "d", "t", "den", "k", "r", "w", "y"] {
        assert_eq!(
            figure(wide, &format!("overflows_{signal}")),
            Some(0.0),
            "{signal}"
        );
    }
    assert_eq!(figure(wide, "indefinite_at_s"), None);
    assert!(figure(wide, "rounding_error_over_signal").expect("an error") < 1e-6);
    // The twin is the channel of the same filter in binary64.
    for (own, difference, unit) in [
        ("delay_vs_raw_ms", "delay_minus_binary64_us", 1e-3),
        ("dc_gain", "dc_gain_minus_binary64", 1.0),
    ] {
        let found = figure(wide, difference).expect("a difference") * unit;
        let wanted = figure(wide, own).expect("a figure") - figure(float, own).expect("a figure");
        assert!((found - wanted).abs() < 1e-9, "{own}: {found:e} {wanted:e}");
        assert!(wanted.abs() < 1e-5, "{own}: {wanted:e}");
    }
    assert_eq!(figure(float, "overflows_x"), None);
    // Sixteen bits hold R for a moment; half the full scale is too small for the swing.
    let (exit, channels) = run("short", &["filter.rls.fixed.word_bits=16"]);
    let short = &channels["rls"];
    assert_ne!(exit, 0, "{short}");
    let indefinite_at = figure(short, "indefinite_at_s").expect("R fails");
    let diverged_at = figure(short, "diverged_at_s").expect("the output fails");
    assert!(indefinite_at <= diverged_at && diverged_at < 1.0, "{short}");
    let (_, channels) = run("small", &["filter.rls.fixed.full_scale_deg_per_h=1800"]);
    let overflows = figure(&channels["rls"], "overflows_d").expect("a count");
    assert!(overflows > 0.0, "{overflows}");
}

#[test]
fn figures_of_fixed_point_are_gated_and_refused_elsewhere() {
    let folder = scratch();
    let gate = |channel: &str| {
        format!(
            "{}[[filter]]\nname = \"float\"\n[filter.rls]\npipeline = \"fpga\"\n\
             [[gate]]\nmetric = \"{channel}.angle_random_walk_over_binary64\"\nmax = 1.01\n",
            fixed_scenario("initial_inverse_correlation = 1.97e-5\n")
        )
    };
    write(folder.path(), "a.toml", &gate("float"));
    let refused = fogbench(folder.path(), &["check", "a.toml"]);
    assert_eq!(code(&refused), 2);
    let text = stderr(&refused);
    assert!(
        text.contains("only a filter with number_format = \"fixed\" has it"),
        "{text}"
    );
    write(folder.path(), "a.toml", &gate("rls"));
    let passed = fogbench(folder.path(), &["run", "a.toml", "-o", "out"]);
    assert_eq!(code(&passed), 0, "{}{}", stdout(&passed), stderr(&passed));
}

#[test]
fn fixed_point_that_cannot_be_names_key_bits_and_limit() {
    let folder = scratch();
    let mut transcript = Transcript::of("fixed-point", "Fixed-point words that cannot be");
    for keys in [
        "",
        "initial_inverse_correlation = 1e-15\n",
        "initial_inverse_correlation = 1e-5\nfixed.word_bits = 49\n",
        "initial_inverse_correlation = 1e-5\nfixed.x = \"Q1.31\"\n",
        "initial_inverse_correlation = 1e-5\nfixed.r = { integer_bits = 40 }\n",
        "initial_inverse_correlation = 1e-5\nfixed.y.rounding = \"up\"\n",
        "initial_inverse_correlation = 1e-5\nupdate_sign = \"as-printed\"\n",
        "initial_inverse_correlation = 1e-5\ndivision = \"elementwise\"\n",
        "initial_inverse_correlation = 1e-7\nforgetting_factor = 0.001\n\
         fixed.r = { integer_bits = 10, word_bits = 10 }\n",
    ] {
        write(folder.path(), "a.toml", &fixed_scenario(keys));
        let output = fogbench(folder.path(), &["check", "a.toml"]);
        assert_eq!(code(&output), 2, "{keys}{}", stdout(&output));
        transcript.case(keys.trim_end(), stderr(&output));
    }
    write(folder.path(), "s.csv", "1.0\n2.0\n");
    let arguments = "export waveform out --stimulus s.csv --number-format fixed";
    let words: Vec<&str> = arguments.split(' ').collect();
    let output = fogbench(folder.path(), &words);
    assert_eq!(code(&output), 2);
    transcript.case(arguments, stderr(&output));
    transcript.check();
}

#[test]
fn clocks_of_a_fixed_point_filter_are_printed() {
    let folder = scratch();
    let arguments = "timing --number-format fixed --divider-latency 48";
    let words: Vec<&str> = arguments.split(' ').collect();
    let text = stdout(&fogbench(folder.path(), &words));
    for part in ["fixed point", "80 clocks a sample", "stalled         268"] {
        assert!(text.contains(part), "no `{part}` in:\n{text}");
    }
    assert!(!text.contains("Table 1"), "{text}");
    let slow = "timing --number-format fixed --adder-latency 3 --multiplier-latency 4 --divider-latency 30";
    let words: Vec<&str> = slow.split(' ').collect();
    let text = stdout(&fogbench(folder.path(), &words));
    // The same clocks that the clocked model and the Verilog take.
    assert!(text.contains("stalled         352"), "{text}");
    assert!(!text.contains("estimate"), "{text}");
}

#[test]
fn an_exported_folder_simulates_from_anywhere() {
    let folder = scratch();
    write(
        folder.path(),
        "a.toml",
        "schema = 1\nname = \"a\"\nduration_s = 1.0\nwarm_up_s = 0.0\nfidelity = \"rate\"\n\
         [[filter]]\nname = \"rls\"\n[filter.rls]\npipeline = \"fpga\"\n",
    );
    let output = fogbench(
        folder.path(),
        &[
            "export",
            "rtl",
            "deep/rtl",
            "--scenario",
            "a.toml",
            "--filter",
            "rls",
            "--samples",
            "50",
        ],
    );
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let rtl = folder.path().join("deep/rtl");
    let codes = std::fs::read_to_string(rtl.join("in_codes.hex")).expect("codes of the gyro");
    assert_eq!(codes.lines().count(), 50);
    let has_simulator = Command::new("iverilog").arg("-V").output().is_ok();
    if !has_simulator {
        assert!(
            std::env::var_os("CI").is_none(),
            "iverilog is missing under CI"
        );
        eprintln!("skipped: iverilog is not installed");
        return;
    }
    let run = |script: &Path| {
        Command::new("sh")
            .arg(script)
            .current_dir("/")
            .output()
            .expect("a shell")
    };
    let passed = run(&rtl.join("run.sh"));
    let report = String::from_utf8_lossy(&passed.stdout);
    assert!(passed.status.success(), "{report}");
    // The gyro's codes went in at the board's port.
    assert!(report.contains("PASS top level: 50 results"), "{report}");
    let words = std::fs::read_to_string(rtl.join("y.hex")).expect("words");
    let last = words.trim_end().len() - 1;
    let digit = if words.as_bytes()[last] == b'0' {
        "1"
    } else {
        "0"
    };
    let wrong = format!("{}{digit}\n", &words[..last]);
    std::fs::write(rtl.join("y.hex"), wrong).expect("writable");
    assert!(
        !run(&rtl.join("run.sh")).status.success(),
        "a wrong word must fail the testbench"
    );
}

#[test]
fn waveforms_and_recorded_stimuli_are_exported() {
    let folder = scratch();
    write(folder.path(), "s.csv", "1.0\n-2.5\n0.75\n");
    let output = fogbench(
        folder.path(),
        &[
            "export",
            "waveform",
            "wave",
            "--stimulus",
            "s.csv",
            "--kind",
            "nlms",
            "--taps",
            "10",
        ],
    );
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    for name in ["wave.vcd", "wave.fst"] {
        assert!(folder.path().join("wave").join(name).exists(), "{name}");
    }
}

#[test]
fn the_audit_scenarios_pass_and_print_theory_beside_observation() {
    let folder = scratch();
    let audit = repository("scenarios/audit");
    let output = fogbench(
        folder.path(),
        &["run", "-v", audit.to_str().expect("UTF-8")],
    );
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let words: Vec<String> = stdout(&output)
        .split_whitespace()
        .map(str::to_owned)
        .collect();
    let text = words.join(" ");
    assert!(
        text.contains("= 3144 samples (0.788 s); it failed after"),
        "{text}"
    );
    assert!(text.contains("does not excite every tap"), "{text}");
    let order = summary(&folder.path().join("output"), "rls-update-order");
    let channels = &order["channels"];
    assert_eq!(channels["schedule"]["asymmetry_max"]["value"], 0.0);
    assert_eq!(channels["schedule"]["clocks_per_sample"]["value"], 108.0);
    assert_eq!(
        channels["gain-first"]["predicted_failure_s"]["samples"]
            .as_f64()
            .map(f64::round),
        Some(3144.0)
    );
}
