//! The hardware commands as a user meets them: `timing`, `export`, and the audit scenarios.

use std::path::Path;
use std::process::Command;

use crate::support::transcript::Transcript;
use crate::support::{code, fogbench, repository, stderr, stdout, summary, write};

fn scratch() -> tempfile::TempDir {
    tempfile::tempdir().expect("a scratch folder")
}

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
