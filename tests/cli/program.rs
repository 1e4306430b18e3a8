//! The program as a user meets it: exit codes, files, messages.

use std::path::Path;

use crate::support::transcript::{Transcript, said_to_each};
use crate::support::{
    code, field, fogbench, repository, scratch, stderr, stdout, summary, tree, write,
};

/// The transcript of commands.
const COMMANDS: &str = "commands";

/// A scenario of two seconds of the rate model; runs in a fraction of a second.
const SHORT: &str = "schema = 1
name = \"short\"
duration_s = 2.0
warm_up_s = 1.0
fidelity = \"rate\"
";

#[test]
fn lists_and_checks_print_what_the_transcript_holds() {
    let commands = [
        "list scenarios/quick",
        "list no-such-folder",
        "check scenarios/quick scenarios/paper",
        "check scenarios/quick/swing.toml --set gyro.coil.length_m=-5",
        "check scenarios/quick/swing.toml --set gyro.coil.lenght_m=5",
    ];
    said_to_each(COMMANDS, "Lists and checks", commands, |arguments| {
        let words: Vec<&str> = arguments.split(' ').collect();
        let output = fogbench(&repository(""), &words);
        let ended = match code(&output) {
            0 => String::new(),
            code => format!("exit code {code}\n"),
        };
        format!("{ended}{}{}", stdout(&output), stderr(&output))
    });
}

#[test]
fn a_passing_run_exits_0_and_writes_the_contracted_files() {
    let folder = scratch();
    let gate =
        "[[gate]]\nmetric = \"raw.mean_deg_per_h\"\nmin = 5.0\nmax = 12.0\ndecide = \"value\"\n";
    write(
        folder.path(),
        "a.toml",
        &format!("{SHORT}{gate}[output]\nsamples = \"npy\"\n"),
    );
    let output = fogbench(folder.path(), &["run", "a.toml"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let names: Vec<String> = tree(&folder.path().join("output"))
        .iter()
        .map(|(path, _)| path.to_string_lossy().into_owned())
        .collect();
    for name in [
        "junit.xml",
        "short/allan.csv",
        "short/manifest.toml",
        "short/psd.csv",
        "short/samples/raw.npy",
        "short/samples/time_s.npy",
        "short/samples/truth.npy",
        "short/summary.json",
        "summary.json",
    ] {
        assert!(
            names.iter().any(|found| found == name),
            "{name} is missing from {names:?}"
        );
    }
    assert!(
        names.iter().any(|name| name.ends_with(".svg")),
        "no picture in {names:?}"
    );
    let text = stdout(&output);
    assert!(
        text.contains("short") && text.contains("raw.mean_deg_per_h"),
        "{text}"
    );
}

#[test]
fn a_failing_gate_exits_1_and_keeps_the_results() {
    let folder = scratch();
    let gate = "[[gate]]\nmetric = \"raw.mean_deg_per_h\"\nmax = 1.0\n";
    write(folder.path(), "a.toml", &format!("{SHORT}{gate}"));
    let output = fogbench(folder.path(), &["run", "a.toml", "-o", "results"]);
    assert_eq!(code(&output), 1, "{}", stderr(&output));
    let summary = summary(&folder.path().join("results"), "short");
    assert_eq!(summary["gates"][0]["verdict"], "fail");
    let junit = std::fs::read_to_string(folder.path().join("results/junit.xml")).expect("written");
    assert!(junit.contains("failures=\"1\""), "{junit}");
}

#[test]
fn an_inconclusive_gate_fails_unless_it_is_allowed() {
    let folder = scratch();
    // The limit lies inside the interval of the mean: neither side can be shown.
    let gate = "[[gate]]\nmetric = \"raw.mean_deg_per_h\"\nmin = 8.47\n";
    write(folder.path(), "a.toml", &format!("{SHORT}{gate}"));
    assert_eq!(code(&fogbench(folder.path(), &["run", "a.toml"])), 1);
    let verdict = summary(&folder.path().join("output"), "short")["gates"][0]["verdict"].clone();
    assert_eq!(verdict, "inconclusive");
    write(
        folder.path(),
        "a.toml",
        &format!("{SHORT}{gate}inconclusive = \"allow\"\n"),
    );
    assert_eq!(code(&fogbench(folder.path(), &["run", "a.toml"])), 0);
}

#[test]
fn a_diverging_channel_exits_3_unless_a_gate_expects_it() {
    let folder = scratch();
    let filter = "[[filter]]\nname = \"wrong\"\n[filter.rls]\nupdate_sign = \"as-printed\"\n";
    write(folder.path(), "a.toml", &format!("{SHORT}{filter}"));
    let output = fogbench(folder.path(), &["run", "a.toml"]);
    assert_eq!(code(&output), 3, "{}", stdout(&output));
    let run = summary(&folder.path().join("output"), "short");
    assert_eq!(run["channels"]["wrong"]["error"]["kind"], "diverged");
    assert!(
        run["channels"]["wrong"]["mean_deg_per_h"].is_null(),
        "a diverged channel has numbers"
    );
    assert!(
        field(&run, "raw.mean_deg_per_h", "value").is_finite(),
        "raw goes on"
    );
    let gate = "[[gate]]\nmetric = \"wrong.diverged_at_s\"\nmax = 3.0\n";
    write(folder.path(), "a.toml", &format!("{SHORT}{filter}{gate}"));
    let output = fogbench(folder.path(), &["run", "a.toml"]);
    assert_eq!(code(&output), 0, "{}", stdout(&output));
}

#[test]
fn a_bad_file_exits_2_before_anything_runs_and_earlier_results_stay() {
    let folder = scratch();
    write(folder.path(), "good.toml", SHORT);
    assert_eq!(code(&fogbench(folder.path(), &["run", "good.toml"])), 0);
    let before = tree(&folder.path().join("output"));
    write(
        folder.path(),
        "bad.toml",
        "schema = 1\nname = \"bad\"\nduration_s = -1.0\n",
    );
    let output = fogbench(folder.path(), &["run", "good.toml", "bad.toml"]);
    assert_eq!(code(&output), 2);
    let mut transcript = Transcript::of(COMMANDS, "A bad file ends before anything runs");
    transcript.case("run good.toml bad.toml", stderr(&output));
    transcript.check();
    assert!(stdout(&output).is_empty(), "nothing may run");
    assert_eq!(before, tree(&folder.path().join("output")));
}

#[test]
fn a_gate_that_the_duration_can_never_support_exits_2() {
    let folder = scratch();
    let gate = "[[gate]]\nmetric = \"raw.bias_stability_100s_deg_per_h\"\nmax = 1.0\n";
    write(folder.path(), "a.toml", &format!("{SHORT}{gate}"));
    let output = fogbench(folder.path(), &["check", "a.toml"]);
    assert_eq!(code(&output), 2);
    let mut transcript = Transcript::of(COMMANDS, "A gate that the duration can never support");
    transcript.case(gate, stderr(&output));
    transcript.check();
}

#[test]
fn a_gyro_of_nothing_but_noise_exits_2_at_the_key_to_blame() {
    let folder = scratch();
    let scenario = "name = \"x\"\nduration_s = 1.0\nwarm_up_s = 0.0\n";
    let mut transcript = Transcript::of(COMMANDS, "A gyro of nothing but noise");
    for set in [
        "gyro.noise.technical_phase_urad_per_sqrt_hz=1e6",
        "gyro.controller.loop_bandwidth_hz=1e5",
    ] {
        write(folder.path(), "x.toml", scenario);
        for command in ["check", "budget"] {
            let arguments = [command, "x.toml", "--set", "gyro.adc.bits=0", "--set", set];
            let output = fogbench(folder.path(), &arguments);
            assert_eq!(code(&output), 2, "{command} {set}");
            transcript.case(format!("{command} x.toml --set {set}"), stderr(&output));
        }
    }
    transcript.check();
}

/// Parts of the gyro whose least value is one of the physics: key, a value just below the least one,
/// and the least one.
const LEAST_PARTS: [(&str, &str, &str); 8] = [
    ("gyro.coil.length_m", "0.999", "1"),
    ("gyro.coil.diameter_mm", "0.999", "1"),
    ("gyro.coil.group_index", "0.999", "1"),
    ("gyro.source.wavelength_nm", "199.9", "200"),
    ("gyro.source.power_uw", "0.000999", "1e-3"),
    ("gyro.source.linewidth_nm", "9.99e-7", "1e-6"),
    ("gyro.source.visibility", "0.000999", "1e-3"),
    ("gyro.detector.transimpedance_kohm", "0.000999", "1e-3"),
];

#[test]
fn a_part_below_its_least_value_exits_2_with_line_unit_and_range() {
    let folder = scratch();
    let mut transcript = Transcript::of(COMMANDS, "Parts below their least value");
    for (key, below, _) in LEAST_PARTS {
        let (table, name) = key.rsplit_once('.').expect("a key in a table");
        let more = format!("[{table}]\n{name} = {below}\n");
        write(folder.path(), "a.toml", &format!("{SHORT}{more}"));
        let said = ["check", "run", "budget"].map(|command| {
            let output = fogbench(folder.path(), &[command, "a.toml"]);
            assert_eq!(code(&output), 2, "{command} {key}");
            stderr(&output)
        });
        assert!(said[0] == said[1] && said[1] == said[2], "{said:?}");
        transcript.case(more, &said[0]);
    }
    transcript.check();
}

#[test]
fn the_least_value_itself_is_in_range() {
    let folder = scratch();
    // An ideal converter, as the noise of so little transimpedance is far below a step of the real one.
    let adc = "[gyro.adc]\nbits = 0\n";
    write(folder.path(), "a.toml", &format!("{SHORT}{adc}"));
    for (key, _, least) in LEAST_PARTS {
        let set = format!("{key}={least}");
        let output = fogbench(folder.path(), &["check", "a.toml", "--set", &set]);
        assert_eq!(code(&output), 0, "{set}: {}", stderr(&output));
    }
}

#[test]
fn an_unknown_metric_in_a_gate_names_the_nearest_one() {
    let folder = scratch();
    let gate = "[[gate]]\nmetric = \"raw.mean_deg_per_hour\"\nmax = 1.0\n";
    write(folder.path(), "a.toml", &format!("{SHORT}{gate}"));
    let output = fogbench(folder.path(), &["check", "a.toml"]);
    assert_eq!(code(&output), 2);
    let mut transcript = Transcript::of(COMMANDS, "An unknown metric in a gate");
    transcript.case(gate, stderr(&output));
    transcript.check();
}

#[test]
fn an_unstable_step_is_refused_unless_it_is_asked_for() {
    let folder = scratch();
    let filter = "[[filter]]\nname = \"lms\"\n[filter.lms]\nnormalised = false\n";
    write(folder.path(), "a.toml", &format!("{SHORT}{filter}"));
    let output = fogbench(folder.path(), &["check", "a.toml"]);
    assert_eq!(code(&output), 2);
    let mut transcript = Transcript::of(COMMANDS, "An unstable step is refused unless asked for");
    transcript.case(filter, stderr(&output));
    transcript.check();
    write(
        folder.path(),
        "a.toml",
        &format!("{SHORT}{filter}allow_unstable = true\n"),
    );
    assert_eq!(code(&fogbench(folder.path(), &["check", "a.toml"])), 0);
}

#[test]
fn nothing_selected_exits_4() {
    let folder = scratch();
    write(folder.path(), "bases/base.toml", "schema = 1\nseed = 2\n");
    said_to_each(
        COMMANDS,
        "Nothing selected",
        ["run", "run bases"],
        |arguments| {
            let words: Vec<&str> = arguments.split(' ').collect();
            let output = fogbench(folder.path(), &words);
            assert_eq!(code(&output), 4);
            stderr(&output)
        },
    );
}

#[test]
fn wrong_usage_exits_2() {
    let folder = scratch();
    let wrong = ["run --no-such-option", "run missing.toml"];
    said_to_each(COMMANDS, "Wrong usage", wrong, |arguments| {
        let words: Vec<&str> = arguments.split(' ').collect();
        let output = fogbench(folder.path(), &words);
        assert_eq!(code(&output), 2);
        stderr(&output)
    });
}

#[test]
fn a_file_in_the_place_of_the_output_folder_exits_2() {
    let folder = scratch();
    write(folder.path(), "a.toml", SHORT);
    write(
        folder.path(),
        "taken",
        "a file stands where the folder should",
    );
    let output = fogbench(folder.path(), &["run", "a.toml", "-o", "taken"]);
    assert_eq!(code(&output), 2, "{}", stderr(&output));
}

#[test]
fn a_manifest_repeats_its_run_to_the_byte() {
    let folder = scratch();
    let filter = "[[filter]]\nname = \"rls\"\n[filter.rls]\ntaps = 3\n";
    let samples = "[output]\nsamples = \"npy\"\n";
    write(
        folder.path(),
        "in/a.toml",
        &format!("{SHORT}{samples}{filter}"),
    );
    let arguments = ["run", "in/a.toml", "--set", "seed=5", "-o", "first"];
    assert_eq!(code(&fogbench(folder.path(), &arguments)), 0);
    let output = fogbench(
        folder.path(),
        &["run", "first/short/manifest.toml", "-o", "second"],
    );
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let (first, second) = (folder.path().join("first"), folder.path().join("second"));
    assert_eq!(names_and_bytes(&first), names_and_bytes(&second));
}

fn names_and_bytes(folder: &Path) -> Vec<(String, String)> {
    let named = |(path, bytes): &(std::path::PathBuf, Vec<u8>)| {
        (
            path.to_string_lossy().into_owned(),
            String::from_utf8_lossy(bytes).into_owned(),
        )
    };
    tree(folder).iter().map(named).collect()
}

#[test]
fn a_sweep_writes_one_folder_per_point_and_its_points_share_the_noise() {
    let folder = scratch();
    let matrix = "[matrix]\n\"bias_averaging_time_s\" = [0.5, 1.0]\n";
    write(folder.path(), "a.toml", &format!("{SHORT}{matrix}"));
    let output = fogbench(folder.path(), &["run", "a.toml"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let results = folder.path().join("output");
    let (one, two) = (
        summary(&results, "short/0000"),
        summary(&results, "short/0001"),
    );
    let bits = |run| field(run, "raw.mean_deg_per_h", "value").to_bits();
    assert_eq!(
        bits(&one),
        bits(&two),
        "the points of a sweep draw the same noise"
    );
    let listed = stdout(&fogbench(folder.path(), &["list", "a.toml"]));
    assert_eq!(listed.lines().count(), 2, "{listed}");
}

#[test]
fn expanded_scenarios_can_be_read_back() {
    let folder = scratch();
    let path = repository("scenarios/paper/swing-5hz.toml");
    let expanded = stdout(&fogbench(
        folder.path(),
        &["expand", &path.to_string_lossy()],
    ));
    write(folder.path(), "expanded.toml", &expanded);
    let again = fogbench(folder.path(), &["expand", "expanded.toml"]);
    assert_eq!(code(&again), 0, "{}", stderr(&again));
    let body = |text: &str| text.lines().skip(1).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(body(&expanded), body(&stdout(&again)));
}

#[test]
fn expanded_sweeps_are_one_document() {
    let folder = scratch();
    let path = repository("scenarios/paper/variants-latitude.toml");
    let path = path.to_string_lossy();
    let expanded = stdout(&fogbench(folder.path(), &["expand", &path]));
    let document: toml::Table = expanded.parse().expect("valid TOML");
    let runs = document["run"].as_array().expect("an array of tables");
    let latitudes: Vec<_> = runs
        .iter()
        .filter_map(|run| run["turntable"]["site"]["latitude_deg"].as_float())
        .collect();
    assert_eq!(latitudes, [34.27, 26.65, 0.0]);
    assert_eq!(runs[1]["filter"][1]["name"].as_str(), Some("rls"));
    // Each element is a scenario of its own.
    let mut single = runs[1].as_table().expect("a table").clone();
    single.remove("matrix");
    write(folder.path(), "one.toml", &single.to_string());
    let check = fogbench(folder.path(), &["check", "one.toml"]);
    assert_eq!(code(&check), 0, "{}", stderr(&check));
}

#[test]
fn json_formats_are_json() {
    let folder = scratch();
    write(folder.path(), "a.toml", SHORT);
    for format in ["json", "jsonl"] {
        let output = fogbench(folder.path(), &["run", "a.toml", "--format", format]);
        let text = stdout(&output);
        serde_json::from_str::<serde_json::Value>(&text)
            .unwrap_or_else(|error| panic!("{format}: {error}: {text}"));
    }
}

#[test]
fn the_schema_is_json_and_knows_the_keys() {
    let folder = scratch();
    let text = stdout(&fogbench(folder.path(), &["schema"]));
    let schema: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert!(
        schema["properties"]["gyro"]["properties"]["coil"].is_object(),
        "{text}"
    );
}

#[test]
fn a_published_figure_in_another_unit_exits_2() {
    let folder = scratch();
    let published = |metric: &str, unit: &str| {
        let head = format!("[[published]]\nmetric = \"{metric}\"\nvalue = 1.0\n");
        let text = format!("{SHORT}{head}unit = \"{unit}\"\nsource = \"a book\"\n");
        write(folder.path(), "a.toml", &text);
        fogbench(folder.path(), &["check", "a.toml"])
    };
    let output = published("raw.mean_deg_per_h", "deg/s");
    assert_eq!(code(&output), 2);
    let mut transcript = Transcript::of(COMMANDS, "A published figure in another unit");
    transcript.case("raw.mean_deg_per_h in deg/s", stderr(&output));
    transcript.check();
    let output = published("raw.mean_deg_per_h", "deg/h");
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert_eq!(stdout(&output), "1 run of 1 file is sound\n");
}
