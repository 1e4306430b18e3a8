//! Values that nobody set: marked where they shape a result, and told from those of a base.

use std::path::Path;

use crate::support::{code, fogbench, repository, scratch, stderr, stdout, summary, write};

/// A scenario that sets next to nothing.
const BARE: &str = "schema = 1
name = \"bare\"
duration_s = 20.0
fidelity = \"rate\"
";

/// What a command says that ends well, line breaks left aside.
fn said(folder: &Path, line: &str) -> String {
    let words: Vec<&str> = line.split(' ').collect();
    let output = fogbench(folder, &words);
    assert_eq!(
        code(&output),
        0,
        "{line}: {}{}",
        stdout(&output),
        stderr(&output)
    );
    stdout(&output)
}

fn in_a_row(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn a_run_says_which_of_its_figures_rest_on_what_nobody_set() {
    let folder = scratch();
    write(folder.path(), "bare.toml", BARE);
    let text = in_a_row(&said(folder.path(), "run bare.toml"));
    for part in [
        "loop bandwidth 2000 Hz (assumed),",
        "ARW budget (theory, at a power that is assumed)",
        "assumed, as nobody set it: ",
        "power_uw = 0.87 uW",
        "bias_instability_deg_per_h = 0.045 deg/h",
        "latitude_deg = 34.27 deg",
        "`fogbench expand --origins` list",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    // The layers of the winding shape nothing at a temperature that stays.
    assert!(!text.contains("layers ="), "{text}");
    let set = "run bare.toml --set gyro.controller.loop_bandwidth_hz=2000.0 --set gyro.source.power_uw=0.87 \
               --set gyro.slow_noise.bias_instability_deg_per_h=0.045";
    let text = in_a_row(&said(folder.path(), set));
    for part in [
        "Hz (assumed)",
        "power that is assumed",
        "power_uw =",
        "bias_instability_deg_per_h =",
    ] {
        assert!(!text.contains(part), "{part}: {text}");
    }
    assert!(
        text.contains("assumed, as nobody set it: half_periods_per_sample = 64,"),
        "{text}"
    );
}

#[test]
fn a_bias_instability_that_says_an_assumption_again_is_told() {
    let folder = scratch();
    let long = BARE.replace("20.0", "3600.0");
    write(
        folder.path(),
        "bare.toml",
        &format!(
            "{long}[gyro.output]\nhalf_periods_per_sample = 6400\n\
             [[gate]]\nmetric = \"raw.bias_instability_deg_per_h\"\nmax = 1.0\n\
             [[gate]]\nmetric = \"raw.angle_random_walk_deg_per_sqrt_h\"\nmax = 1.0\n"
        ),
    );
    let text = in_a_row(&said(folder.path(), "run bare.toml -o out"));
    let told = "the measured bias instability and rate random walk say it again";
    assert!(text.contains(told), "{text}");
    let key = "gyro.slow_noise.bias_instability_deg_per_h";
    let told = format!("this says an assumption again: nobody set {key}");
    assert_eq!(text.matches(&told).count(), 1, "{text}");
    let result = summary(&folder.path().join("out"), "bare");
    assert_eq!(result["gates"][0]["says_again"], key);
    assert!(result["gates"][1]["says_again"].is_null());
    let shaping = result["assumed"]["shaping"].as_array().expect("a list");
    let entry = shaping.iter().find(|entry| entry["key"] == key);
    let entry = entry.expect("the bias instability");
    assert_eq!(
        (&entry["value"], &entry["unit"]),
        (&0.045.into(), &"deg/h".into())
    );
    assert!(result["assumed"]["count"].as_u64() > Some(100), "{result}");
    let set = "run bare.toml --set gyro.slow_noise.bias_instability_deg_per_h=0.1";
    assert!(!in_a_row(&said(folder.path(), set)).contains("the measured bias instability"));
}

#[test]
fn a_budget_names_what_nobody_set() {
    let folder = scratch();
    write(folder.path(), "bare.toml", BARE);
    let text = in_a_row(&said(folder.path(), "budget bare.toml"));
    assert!(
        text.contains("assumed, as nobody set it: ") && text.contains("wavelength_nm = 1310"),
        "{text}"
    );
    assert!(text.contains("power_uw = 0.87 uW"), "{text}");
    let set = "budget bare.toml --set gyro.source.power_uw=1.0";
    assert!(!in_a_row(&said(folder.path(), set)).contains("power_uw ="));
}

#[test]
fn origins_tell_assumptions_bases_and_options_apart() {
    let folder = scratch();
    write(
        folder.path(),
        "base.toml",
        "schema = 1\n[gyro.coil]\nlength_m = 900.0\n",
    );
    let own = format!(
        "{BARE}extends = \"base.toml\"\n[[filter]]\nname = \"f\"\n[filter.rls]\ntaps = 3\n"
    );
    write(folder.path(), "own.toml", &own);
    let line = "expand own.toml --origins --set gyro.coil.diameter_mm=80.0";
    let text = said(folder.path(), line);
    let of = |start: &str| {
        let found = text.lines().find(|line| line.starts_with(start));
        found.unwrap_or_else(|| panic!("{start}: {text}"))
    };
    assert_eq!(of("duration_s"), "duration_s = 20.0");
    assert_eq!(of("length_m"), "length_m = 900.0  # from base.toml");
    assert_eq!(of("diameter_mm"), "diameter_mm = 80.0  # from --set");
    assert_eq!(of("power_uw"), "power_uw = 0.87  # assumed");
    assert_eq!(of("taps"), "taps = 3");
    assert_eq!(
        of("forgetting_factor"),
        "forgetting_factor = 1.0  # assumed"
    );
    // It is the text without them, and reads as it.
    let plain = said(folder.path(), &line.replace(" --origins", ""));
    let bare: Vec<&str> = text
        .lines()
        .map(|line| line.split("  # ").next().unwrap_or(line))
        .collect();
    assert_eq!(bare.join("\n"), plain.trim_end());
    write(
        folder.path(),
        "sweep.toml",
        &format!("{BARE}[matrix]\nseed = [1, 2]\n"),
    );
    let sweep = fogbench(folder.path(), &["expand", "sweep.toml", "--origins"]);
    assert_eq!(code(&sweep), 2);
    assert!(
        stderr(&sweep).contains("the selection holds 2"),
        "{}",
        stderr(&sweep)
    );
}

#[test]
fn a_scenario_on_the_base_of_a_publication_does_not_print_its_open_readings() {
    let folder = scratch();
    let base = repository("scenarios/base/paper.toml");
    let own = format!("{BARE}extends = {:?}\n", base.display().to_string());
    write(folder.path(), "own.toml", &own);
    let open = "what the publication leaves open";
    let text = said(folder.path(), "run own.toml -v");
    assert!(!text.contains(open) && !text.contains("Xi'an"), "{text}");
    let summary = std::fs::read_to_string(folder.path().join("output/summary.json"));
    assert!(!summary.expect("written").contains("Xi'an"));
    let origins = said(folder.path(), "expand own.toml --origins");
    assert!(origins.contains("taps = 10  # from "), "{origins}");
    // One of the publication's own does.
    let paper = repository("scenarios/paper/static-25c.toml");
    let line = format!(
        "run {} -v -o p --set fidelity=rate --set duration_s=300.0 --set gyro.output.half_periods_per_sample=640 --set gate=[]",
        paper.display()
    );
    let words: Vec<&str> = line.split(' ').collect();
    let output = fogbench(folder.path(), &words);
    assert!(
        stdout(&output).contains(open),
        "{}{}",
        stdout(&output),
        stderr(&output)
    );
}
