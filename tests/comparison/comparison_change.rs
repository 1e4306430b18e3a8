//! Tables that close with the largest change of each column per unit of a key.

use std::path::Path;

use serde_json::Value;

use crate::support::transcript::Transcript;
use crate::support::{assert_close, code, fogbench, stderr, stdout, write};

/// A gyro whose bias and scale factor depend on temperature alone in a known way.
const WARMED: &str = r#"
schema = 1
duration_s = 8.0
warm_up_s = 1.0
fidelity = "rate"

[gyro.thermal]
bias_deg_per_h_per_k = 2.0
bias_deg_per_h_per_k2 = 0.01
length_ppm_per_k = 0.0
diameter_ppm_per_k = 50.0
wavelength_nm_per_k = 0.0

[[comparison]]
name = "Bias"
title = "bias over temperature"
kind = "sensitivity"
columns = ["raw.mean_error_deg_per_h"]
per_change_of = "gyro.temperature.soak.temperature_c"
[[comparison]]
name = "Scale factor"
title = "scale factor over temperature"
kind = "sensitivity"
columns = ["raw.scale_factor_error_ppm", "raw.scale_factor_asymmetry_ppm"]
per_change_of = "gyro.temperature.soak.temperature_c"

[[comparison_row]]
comparison = "Bias"
label = "cold"
scenarios = ["cold"]
[[comparison_row]]
comparison = "Bias"
label = "room"
scenarios = ["room"]
[[comparison_row]]
comparison = "Bias"
label = "hot"
scenarios = ["hot"]
[[comparison_row]]
comparison = "Scale factor"
label = "at"
scenarios = ["turned"]
"#;

fn suite_json(output: &Path) -> Value {
    let text = std::fs::read_to_string(output.join("summary.json")).expect("written");
    serde_json::from_str(&text).expect("JSON")
}

/// A folder with three scenarios at rest and a sweep of a scale factor test over temperature.
fn warmed() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(folder.path(), "base.toml", WARMED);
    let scenario = |name: &str, rest: &str| {
        let text = format!("name = \"{name}\"\nextends = \"base.toml\"\n{rest}");
        write(folder.path(), &format!("{name}.toml"), &text);
    };
    scenario("room", "");
    scenario("hot", "[gyro.temperature.soak]\ntemperature_c = 60.0\n");
    scenario("cold", "[gyro.temperature.soak]\ntemperature_c = -40.0\n");
    scenario(
        "turned",
        "duration_s = 9.0\n\
         [turntable.scale_factor_test]\npreferred_series = \"R5\"\nfrom_deg_per_s = 0.4\n\
         to_deg_per_s = 40.0\ndwell_s = 0.1\nstatic_s = 0.5\nsettle_s = 0.1\n\
         [matrix]\n\"gyro.temperature.soak.temperature_c\" = [-40.0, 25.0, 60.0, 70.0]\n",
    );
    folder
}

#[test]
fn a_table_over_temperature_closes_with_the_temperature_sensitivity_of_the_coefficients() {
    let folder = warmed();
    let output = fogbench(folder.path(), &["run", "-v", "."]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let results = folder.path().join("output");
    let json = suite_json(&results);
    let number = |value: &Value| value.as_f64().expect("a number");

    let bias = &json["sensitivities"][0]["change_per_unit"];
    assert_eq!(bias["from"], "room");
    let largest = &bias["columns"][0];
    // 2 + 0.01 x 35 K; the larger distance of the cold row gives only 2 - 0.01 x 65 K.
    assert_close(number(&largest["value"]), 2.35, 0.0, 0.01);
    assert_eq!(largest["unit"], "deg/h per C");
    assert_eq!(largest["at"], "hot");
    let (low, high) = (number(&largest["low"]), number(&largest["high"]));
    assert!(low < 2.35 && 2.35 < high && high - low < 0.1, "{largest}");

    let factor = &json["sensitivities"][1]["change_per_unit"];
    assert_eq!(factor["from"], "at 25.0", "the base point, not the middle");
    assert_close(number(&factor["columns"][0]["value"]), 50.0, 0.0, 0.5);
    assert_eq!(factor["columns"][0]["unit"], "ppm per C");

    let text = stdout(&output);
    let heading = "largest change per C of gyro.temperature.soak.temperature_c from row \"room\"\n";
    assert!(text.contains(heading), "{text}");
    assert!(text.contains(" deg/h per C  to row \"hot\"\n"), "{text}");
    let csv = std::fs::read_to_string(results.join("sensitivity-bias.csv")).expect("written");
    let last = csv.lines().last().expect("a closing line");
    assert!(
        last.contains("raw.mean_error_deg_per_h,deg/h per C,,2.3"),
        "{csv}"
    );
    assert!(last.ends_with(",hot"), "{csv}");
}

#[test]
fn a_part_of_a_table_over_temperature_has_no_closing_line() {
    let folder = warmed();
    let output = fogbench(folder.path(), &["run", "room.toml"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let json = suite_json(&folder.path().join("output"));
    let table = &json["sensitivities"][0];
    assert_eq!(table["rows"][0]["at"].as_f64(), Some(25.0));
    assert!(table.get("change_per_unit").is_none(), "{table}");
}

#[test]
fn a_table_whose_rows_do_not_differ_in_one_number_is_refused() {
    let complaint = |file: &str, change: (&str, &str)| {
        let folder = warmed();
        let path = folder.path().join(file);
        let text = std::fs::read_to_string(path).expect("written");
        assert!(text.contains(change.0), "{file} has no {}", change.0);
        write(folder.path(), file, &text.replacen(change.0, change.1, 1));
        let output = fogbench(folder.path(), &["check", "."]);
        assert_eq!(code(&output), 2, "{change:?} was accepted");
        stderr(&output)
    };
    let key = "gyro.temperature.soak.temperature_c";
    let ramp = "[gyro.temperature.ramp]\nstart_c = 25.0\nend_c = 60.0\nrate_c_per_min = 1.0\n";
    let soak = "[gyro.temperature.soak]\ntemperature_c = 60.0\n";
    let mut transcript = Transcript::of("comparison", "Changes per unit that cannot be");
    for (file, change) in [
        ("hot.toml", (soak, ramp)),
        (
            "base.toml",
            ("scenarios = [\"hot\"]", "scenarios = [\"hot\", \"room\"]"),
        ),
        ("turned.toml", ("[matrix]\n", "[matrix]\nseed = [1, 2]\n")),
        ("base.toml", (key, "turntable.site.latitude_deg")),
        ("base.toml", (key, "fidelity")),
        ("base.toml", (key, "gyro.temperature.soak.temperature")),
    ] {
        let given = format!("{file}: {}\nwhere {} stood", change.1, change.0);
        transcript.case(given, complaint(file, change));
    }
    transcript.check();
}
