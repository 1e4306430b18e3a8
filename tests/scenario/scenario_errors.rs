//! Malformed scenario files: each gives one clear complaint that points at the wrong place.

use std::fs;
use std::path::PathBuf;

use fogbench::filters::FilterKind;
use fogbench::scenario::{MotionConfig, Resolved, ScenarioError, load_suite, manifest_toml};
use tempfile::TempDir;

use crate::support::transcript::{Transcript, said_to_each};

/// The transcript of complaints about scenarios.
const SCENARIO: &str = "scenario";

/// A folder of scenario files.
struct Suite {
    folder: TempDir,
}

impl Suite {
    fn new(files: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        for (name, text) in files {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().expect("it stands in the folder"))
                .and_then(|()| fs::write(path, text))
                .expect("the temporary folder can be written");
        }
        Self { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn load(&self, names: &[&str], sets: &[&str]) -> Result<Vec<Resolved>, Vec<ScenarioError>> {
        let paths: Vec<PathBuf> = names.iter().map(|name| self.path(name)).collect();
        let sets: Vec<String> = sets.iter().map(|&set| set.to_owned()).collect();
        load_suite(&paths, &sets)
    }

    /// The complaints, one a line, without the path of the folder.
    fn complaints(&self, names: &[&str], sets: &[&str]) -> Vec<String> {
        let folder = format!("{}/", self.folder.path().display());
        let errors = self.load(names, sets).expect_err("the suite is malformed");
        errors
            .iter()
            .map(|error| error.to_string().replace(&folder, ""))
            .collect()
    }
}

/// A sound scenario of three lines, then more.
fn scenario(more: &str) -> String {
    format!("schema = 1\nname = \"x\"\nduration_s = 20.0\n{more}")
}

/// Complaints about one file `x.toml`: a sound head of three lines, then `more`.
fn complaints(more: &str) -> Vec<String> {
    Suite::new(&[("x.toml", &scenario(more))]).complaints(&["x.toml"], &[])
}

/// Complaints about a sound file under `--set` arguments.
fn complaints_of_set(more: &str, sets: &[&str]) -> Vec<String> {
    Suite::new(&[("x.toml", &scenario(more))]).complaints(&["x.toml"], sets)
}

/// Holds the complaints about a sound head with each of some endings.
#[track_caller]
fn complaints_of_each<I: std::fmt::Display>(
    title: &'static str,
    given: impl IntoIterator<Item = I>,
) {
    said_to_each(SCENARIO, title, given, |more| complaints(more).join("\n"));
}

/// Files of a suite as a transcript shows them, and the complaints about some of them.
fn suite_case(files: &[(&str, &str)], names: &[&str]) -> (String, String) {
    let shown = files.iter().map(|(name, text)| format!("{name}:\n{text}"));
    let given = shown.collect::<Vec<_>>().join("\n");
    let complaints = Suite::new(files).complaints(names, &[]);
    (given, complaints.join("\n"))
}

/// Adds what is said about a sound file, with `more`, under `--set` arguments.
fn set_case(transcript: &mut Transcript, more: &str, sets: &[&str]) {
    let arguments = sets.iter().map(|set| format!("--set {set}\n"));
    let given = format!("{more}{}", arguments.collect::<String>());
    transcript.case(given, complaints_of_set(more, sets).join("\n"));
}

fn run(more: &str, sets: &[&str]) -> Resolved {
    let mut runs = Suite::new(&[("x.toml", &scenario(more))])
        .load(&["x.toml"], sets)
        .expect("the scenario is sound");
    assert_eq!(runs.len(), 1);
    runs.remove(0)
}

#[test]
fn a_sound_scenario_gives_no_complaint() {
    let run = run("", &[]);
    assert_eq!(run.file, "x.toml", "no absolute path reaches the results");
    assert_eq!(run.folder(), "x");
    assert_eq!(run.inputs.len(), 1);
}

#[test]
fn syntax_error_points_at_its_column() {
    complaints_of_each(
        "Syntax errors point at their column",
        ["[gyro.coil\nlength_m = 1.0\n", "seed = 1\nseed = 2\n"],
    );
}

#[test]
fn unknown_key_names_the_nearest_known_one() {
    complaints_of_each(
        "Unknown keys name the nearest known one",
        [
            "[gyro.coil]\n  lenght_m = 800.0\n",
            "[turntables]\nx = 1\n",
            "[[filter]]\nname = \"a\"\n[filter.rls]\ntap = 4\n",
            "[turntable.static]\nfast = true\n",
        ],
    );
}

#[test]
fn wrong_type_says_what_is_expected() {
    complaints_of_each(
        "Wrong types say what is expected",
        [
            "[gyro.coil]\nlength_m = \"long\"\n",
            "repeats = 1.5\n",
            "gyro = 3\n",
            "[filter]\nname = \"a\"\n",
            "[gyro]\nnoise.shot = 1\n",
        ],
    );
}

#[test]
fn unknown_choice_lists_the_choices() {
    complaints_of_each(
        "Unknown choices list the choices",
        ["fidelity = \"lop\"\n", "fidelity = \"fast\"\n"],
    );
}

#[test]
fn value_out_of_range_gives_unit_and_range() {
    complaints_of_each(
        "Values out of range give unit and range",
        [
            "[gyro.coil]\nlength_m = -5\n",
            "[gyro.output]\nhalf_periods_per_sample = 63\n",
            "seed = -1\n",
            "[gyro.source]\npower_uw = nan\nlinewidth_nm = inf\n",
            "[gyro.source]\npower_uw = 1e400\n",
            "seed = 18446744073709551616\n",
            "[turntable.steps]\nrates_deg_per_s = [0.0, 1, 3e3]\ndwell_s = 1\n",
            "[turntable.steps]\nrates_deg_per_s = [0.0,\n  \"fast\"]\ndwell_s = 1\n",
        ],
    );
}

#[test]
fn inherited_values_are_blamed_on_the_base() {
    let base = "# a base\n[gyro.coil]\nlength_m = 90000.0\n";
    let text = scenario("extends = \"base/b.toml\"\n[gyro.coil]\ndiameter_mm = 60.0\n");
    let files = [("base/b.toml", base), ("x.toml", &text)];
    let mut transcript = Transcript::of(SCENARIO, "Inherited values are blamed on the base");
    let (given, said) = suite_case(&files, &["x.toml"]);
    transcript.case(given, said);
    transcript.check();
    // A value that the scenario replaces does no harm.
    let suite = Suite::new(&files);
    assert!(suite.load(&["x.toml"], &["gyro.coil.length_m=800"]).is_ok());
}

#[test]
fn set_values_are_blamed_on_the_argument() {
    let mut transcript = Transcript::of(SCENARIO, "Set values are blamed on the argument");
    set_case(&mut transcript, "", &["gyro.coil.length_m=-5"]);
    let four = [
        "gyro.coil.lenght_m=5",
        "duration_s",
        "seed=[1",
        "fidelity=fast",
    ];
    set_case(&mut transcript, "", &four);
    // Sweeps and bases cannot be set.
    set_case(
        &mut transcript,
        "",
        &["matrix.seed=[1,2]", "extends=y.toml"],
    );
    let filter = "[[filter]]\nname = \"rls\"\n[filter.rls]\n";
    set_case(&mut transcript, filter, &["filter[].rls.taps=4"]);
    set_case(&mut transcript, filter, &["filter.other.taps=8"]);
    set_case(&mut transcript, filter, &["filter[2].rls.taps=1"]);
    transcript.check();
}

#[test]
fn set_addresses_a_filter_by_name_and_by_index() {
    let filters =
        "[[filter]]\nname = \"fast\"\n[filter.rls]\n[[filter]]\nname = \"slow\"\n[filter.lms]\n";
    let run = run(
        filters,
        &[
            "filter.fast.taps=8",
            "filter[1].lms.step_size=1",
            "fidelity=rate",
            "filter.slow.desired=current",
        ],
    );
    let FilterKind::Rls(fast) = &run.scenario.filters[0].kind else {
        panic!()
    };
    let FilterKind::Lms(slow) = &run.scenario.filters[1].kind else {
        panic!()
    };
    assert_eq!(fast.taps, 8);
    assert_eq!(slow.step_size.to_bits(), 1.0_f64.to_bits());
}

#[test]
fn bases_that_cannot_be_read_are_named_where_they_are_asked_for() {
    let files = [
        ("x.toml", &*scenario("extends = \"y.toml\"\n")),
        ("y.toml", "seed = 2\nextends = \"./x.toml\"\n"),
    ];
    let mut transcript = Transcript::of(SCENARIO, "Bases that cannot be read");
    let (given, said) = suite_case(&files, &["x.toml"]);
    transcript.case(given, said);
    let nowhere = "extends = \"nowhere.toml\"\n";
    transcript.case(nowhere, complaints(nowhere).join("\n"));
    let (given, said) = suite_case(
        &[("s/x.toml", &scenario("extends = \".\"\n"))],
        &["s/x.toml"],
    );
    transcript.case(given, said);
    transcript.case("check none.toml", suite_case(&[], &["none.toml"]).1);
    // A missing base does not hide what is wrong here.
    let both = "extends = \"nowhere.toml\"\n[gyro.coil]\nlenght_m = 1\n";
    transcript.case(both, complaints(both).join("\n"));
    transcript.check();
}

#[test]
fn missing_required_keys_are_named() {
    let mut transcript = Transcript::of(SCENARIO, "Missing keys are named");
    let (given, said) = suite_case(&[("x.toml", "seed = 3\n")], &["x.toml"]);
    transcript.case(given, said);
    // Names are not inherited.
    let files = [
        ("x.toml", &*scenario("")),
        ("y.toml", "extends = \"x.toml\"\n"),
    ];
    let (given, said) = suite_case(&files, &["y.toml"]);
    transcript.case(given, said);
    let filter = "[[filter]]\nname = \"a\"\n";
    transcript.case(filter, complaints(filter).join("\n"));
    transcript.check();
}

#[test]
fn bad_reserved_and_repeated_names_are_refused() {
    let mut transcript = Transcript::of(SCENARIO, "Bad, reserved and repeated names are refused");
    let (given, said) = suite_case(
        &[("x.toml", "name = \"Swing 5\"\nduration_s = 1\n")],
        &["x.toml"],
    );
    transcript.case(given, said);
    for more in [
        "[[filter]]\nname = \"truth\"\n[filter.rls]\n",
        "[[filter]]\nname = \"a\"\n[filter.rls]\n[[filter]]\nname = \"a\"\n[filter.lms]\n",
    ] {
        transcript.case(more, complaints(more).join("\n"));
    }
    let long = format!("name={}", "a".repeat(65));
    set_case(&mut transcript, "", &["name=time_s"]);
    set_case(&mut transcript, "", &[&long]);
    let files = [("s/a.toml", &*scenario("")), ("s/b.toml", &*scenario(""))];
    let (given, said) = suite_case(&files, &["s"]);
    transcript.case(given, said);
    transcript.check();
    let fits = format!("name={}", "a".repeat(64));
    assert_eq!(run("", &[&fits]).scenario.name.len(), 64);
}

#[test]
fn a_later_file_replaces_the_motion() {
    let suite = Suite::new(&[
        ("b.toml", "[turntable.rotation]\nrate_deg_per_s = 1.0\n"),
        (
            "x.toml",
            &scenario(
                "extends = \"b.toml\"\n[turntable.steps]\nrates_deg_per_s = [0, 1]\ndwell_s = 10\n",
            ),
        ),
    ]);
    let runs = suite.load(&["x.toml"], &[]).unwrap();
    assert!(matches!(
        runs[0].scenario.turntable.motion,
        MotionConfig::Steps(_)
    ));
}

#[test]
fn a_set_amplitude_of_a_swing_replaces_the_other() {
    let swing = "[turntable.swing]\nfrequency_hz = 5.0\n";
    let one = format!("{swing}rate_amplitude_deg_per_s = 1.0\n");
    let MotionConfig::Swing(swing) = run(&one, &["turntable.swing.angle_amplitude_deg=2"])
        .scenario
        .turntable
        .motion
    else {
        panic!()
    };
    assert!(swing.rate_amplitude_deg_per_s.is_none());
}

#[test]
fn times_that_do_not_fit_are_refused() {
    complaints_of_each(
        "Times that do not fit are refused",
        [
            "[turntable.steps]\nrates_deg_per_s = [0.0, 1.0, 2.0]\ndwell_s = 7.0\n",
            "warm_up_s = 0.5\n[turntable.rotation]\nrate_deg_per_s = 1.0\n",
            "[turntable.swing]\nfrequency_hz = 999.0\nangle_amplitude_deg = 1e-3\n",
        ],
    );
}

#[test]
fn gates_need_limits_and_channels() {
    complaints_of_each(
        "Gates need limits and channels",
        [
            "[[gate]]\nmetric = \"raw.noise_gain\"\n",
            "[[gate]]\nmetric = \"raw.noise_gain\"\nmin = 2\nmax = 1\n",
            "[[gate]]\nmetric = \"rls.noise_gain\"\nmin = 2\nrelative_to = \"lms\"\n",
            "[[published]]\nmetric = \"lms.noise_gain\"\nvalue = 1\nunit = \"1\"\nsource = \"s\"\n",
        ],
    );
    said_to_each(
        SCENARIO,
        "Metrics that do not exist are found when the suite is planned",
        [
            "[[gate]]\nmetric = \"noise_gain\"\nmin = 2\n",
            "[[gate]]\nmetric = \"raw.arw\"\nmax = 1\n",
            // Beside an unknown key and beside a contradiction.
            "sed = 1\n[[gate]]\nmetric = \"raw.arw\"\nmax = 1\n\
             [[gate]]\nmetric = \"mean_deg_per_h\"\nmax = 1\n",
            "[turntable.trapezoid]\nrate_deg_per_s = 0\nacceleration_deg_per_s2 = 1\nhold_s = 1\n\
             [[gate]]\nmetric = \"raw.arw\"\nmax = 1\n[[gate]]\nmetric = \"mean_deg_per_h\"\nmax = 1\n",
        ],
        |more| {
            let suite = Suite::new(&[("x.toml", &scenario(more))]);
            let planned = fogbench::experiment::plan_suite(&[suite.path("x.toml")], &[]);
            let errors = planned.expect_err("there is no such metric");
            let texts: Vec<String> = errors.iter().map(ToString::to_string).collect();
            texts.join("\n")
        },
    );
}

#[test]
fn other_versions_are_refused_alone() {
    let mut transcript = Transcript::of(SCENARIO, "Other versions are refused alone");
    for (name, text) in [
        ("x.toml", "schema = 2\nname = \"x\"\nnew_key = 1\n"),
        ("m.toml", "manifest = 2\n"),
        ("n.toml", "manifest = 1\n"),
    ] {
        let (given, said) = suite_case(&[(name, text)], &[name]);
        transcript.case(given, said);
    }
    transcript.check();
}

#[test]
fn all_complaints_of_all_files_come_at_once() {
    let files = [
        ("s/a.toml", &*scenario("sed = 1\nrepeats = 0\n")),
        ("s/b.toml", "name = \"b\"\nduration_s = -1\n"),
        ("s/c.toml", "name = \n"),
    ];
    let mut transcript = Transcript::of(SCENARIO, "All complaints of all files come at once");
    let (given, said) = suite_case(&files, &["s"]);
    transcript.case(given, said);
    // Later layers are checked though an earlier one complains: an unknown key, a value out of
    // range, an inert key and a gate of no channel.
    let four = "sed = 2\n[gyro.coil]\nlength_m = -5\n[gyro.slow_noise]\n\
                gauss_markov_correlation_time_s = 7.0\n\
                [[gate]]\nmetric = \"rls.noise_gain\"\nmax = 1\n";
    transcript.case(four, complaints(four).join("\n"));
    transcript.check();
}

#[test]
fn folders_take_named_files_in_the_order_of_their_paths() {
    let named = |name: &str| format!("name = \"{name}\"\nduration_s = 1\n");
    let suite = Suite::new(&[
        ("s/b/z.toml", &named("first")),
        ("s/c.toml", &named("second")),
        ("s/base.toml", "seed = 4\n"),
        ("s/.hidden.toml", "not toml"),
        ("s/notes.txt", "not toml"),
    ]);
    let runs = suite.load(&["s", "s/c.toml"], &[]).unwrap();
    let names: Vec<&str> = runs.iter().map(|run| run.scenario.name.as_str()).collect();
    assert_eq!(names, ["first", "second"]);
    assert!(
        Suite::new(&[("s/base.toml", "seed = 4\n")])
            .load(&["s"], &[])
            .unwrap()
            .is_empty()
    );
}

#[test]
fn a_matrix_is_the_product_of_its_keys_in_the_order_of_the_file() {
    let text = scenario(
        "[matrix]\n\"gyro.source.power_uw\" = [0.5, 2]\nseed = [1, 2, 3]\n\
         gyro.coil.length_m = [800.0]\n",
    );
    let runs = Suite::new(&[("x.toml", &text)])
        .load(&["x.toml"], &[])
        .unwrap();
    assert_eq!(runs.len(), 6);
    assert_eq!(runs[4].folder(), "x/0004");
    let point = runs[4].sweep.as_ref().unwrap();
    assert_eq!((point.index, point.count), (4, 6));
    let want = [
        ("gyro.source.power_uw", "2.0"),
        ("seed", "2"),
        ("gyro.coil.length_m", "800.0"),
    ];
    let want = want.map(|(key, value)| (key.to_owned(), value.to_owned()));
    assert_eq!(point.assignments, want);
    assert_eq!(runs[4].scenario.seed, 2);
    assert!(runs.windows(2).all(|pair| pair[0].digest != pair[1].digest));
}

#[test]
fn a_range_of_a_matrix_stands_for_the_array_of_its_values() {
    let expanded = |matrix: &str| {
        let text = scenario(matrix);
        let runs = Suite::new(&[("x.toml", &text)]).load(&["x.toml"], &[]);
        let runs = runs.unwrap().into_iter();
        runs.map(|run| (run.digest, run.sweep.unwrap().assignments))
            .collect::<Vec<_>>()
    };
    for (range, array) in [
        (
            "\"gyro.source.power_uw\" = { from = 0.5, to = 2, count = 4 }\n",
            "\"gyro.source.power_uw\" = [0.5, 1.0, 1.5, 2]\n",
        ),
        (
            "gyro.source.power_uw = { from = 0.5, to = 2, count = 3, spacing = \"log\" }\n",
            "\"gyro.source.power_uw\" = [0.5, 1.0, 2.0]\n",
        ),
        (
            "seed = { from = 7, to = 1, count = 3 }\n",
            "seed = [7, 4, 1]\n",
        ),
        (
            "[matrix.repeats]\nfrom = 1\nto = 50\ncount = 3\nspacing = \"log\"\n",
            "repeats = [1, 7, 50]\n",
        ),
    ] {
        let [range, array] = [range, array].map(|it| expanded(&format!("[matrix]\n{it}")));
        assert_eq!(range, array);
    }
}

#[test]
fn wrong_ranges_are_refused_where_they_are_wrong() {
    let mut transcript = Transcript::of(SCENARIO, "Wrong ranges are refused where they are wrong");
    for range in [
        "\"gyro.source.power_uw\" = { from = 0.5, to = 0.5, count = 3 }",
        "\"gyro.source.power_uw\" = { from = 0.5, to = -2.0, count = 3 }",
        "\"gyro.source.power_uw\" = { from = 0.5, to = inf, count = 3 }",
        "\"gyro.source.power_uw\" = { from = 0.5, to = 2.0, count = 1 }",
        "\"gyro.source.power_uw\" = { from = 0.5, to = 2.0, count = 10001 }",
        "\"gyro.source.power_uw\" = { from = 0.5, to = 2.0, count = 2.5 }",
        "\"gyro.source.power_uw\" = { from = 0.5, to = 2.0 }",
        "\"gyro.source.power_uw\" = { from = 0.5, to = 2.0, step = 0.1 }",
        "\"gyro.source.power_uw\" = { from = 0.5, to = 2.0, count = 3, spacing = \"cubic\" }",
        "\"gyro.source.powr_uw\" = { from = 0.5, to = 2.0, count = 3 }",
        "\"turntable.site.latitude_deg\" = { from = 0.0, to = 80.0, count = 3, spacing = \"log\" }",
        "seed = { from = 1, to = 10, count = 5 }",
        "seed = { from = 1, to = 5, count = 9, spacing = \"log\" }",
        "seed = { from = 1.0, to = 5, count = 5 }",
        "fidelity = { from = 1, to = 5, count = 5 }",
        "seed = { from = 1, to = 5000, count = 5000 }\nrepeats = { from = 1, to = 3, count = 3 }",
    ] {
        let text = format!("[matrix]\n{range}\n");
        transcript.case(&text, complaints(&text).join("\n"));
    }
    transcript.check();
}

#[test]
fn wrong_matrices_are_refused_where_they_are_wrong() {
    let mut transcript =
        Transcript::of(SCENARIO, "Wrong matrices are refused where they are wrong");
    for more in [
        "[matrix]\n\"gyro.source.powr_uw\" = [1]\nseed = []\nrepeats = 2\nname = [\"a\"]\n",
        "[matrix]\n\"gyro.source.power_uw\" = [0.5, -2.0]\nseed = [1, 2]\n",
        "[matrix]\n",
    ] {
        transcript.case(more, complaints(more).join("\n"));
    }
    set_case(&mut transcript, "[matrix]\nseed = [1, 2]\n", &["seed=3"]);
    transcript.check();
}

#[test]
fn a_manifest_repeats_its_run() {
    let text = scenario(
        "description = \"quoted \\\"text\\\" and \\\\ a line\\nbreak\"\n\
         [[filter]]\nname = \"rls\"\n[filter.rls]\ntaps = 3\n\
         [[gate]]\nmetric = \"rls.noise_gain\"\nmax = 1\n\
         [matrix]\n\"filter.rls.taps\" = [3, 5]\n\"gyro.output.rate_lsb_deg_per_s\" = [0, 1e-7]\n",
    );
    let suite = Suite::new(&[("x.toml", &text)]);
    for run in suite.load(&["x.toml"], &[]).unwrap() {
        let manifest = manifest_toml(&run, "0.1.0", "b");
        fs::write(suite.path("manifest.toml"), &manifest).unwrap();
        let again = suite.load(&["manifest.toml"], &[]).unwrap();
        assert_eq!(again.len(), 1);
        assert_eq!(again[0], run);
        assert_eq!(manifest_toml(&again[0], "0.1.0", "b"), manifest);
        // The canonical text is a scenario that resolves to itself.
        fs::write(suite.path("y.toml"), run.to_toml()).unwrap();
        let canonical = suite.load(&["y.toml"], &[]).unwrap();
        assert_eq!(canonical[0].to_toml(), run.to_toml());
        assert_eq!(canonical[0].digest, run.digest);
    }
}

#[test]
fn a_changed_manifest_is_its_own_origin() {
    let text =
        scenario("[matrix]\nseed = [4, 5]\n[[gate]]\nmetric = \"raw.noise_gain\"\nmax = 1\n");
    let suite = Suite::new(&[("x.toml", &text)]);
    let run = suite.load(&["x.toml"], &[]).unwrap().remove(1);
    let manifest = manifest_toml(&run, env!("CARGO_PKG_VERSION"), "b");
    let load = |text: &str, sets: &[&str]| {
        fs::write(suite.path("m.toml"), text).unwrap();
        suite.load(&["m.toml"], sets).unwrap().remove(0)
    };
    // Setting what stands there already changes nothing, and the place of the gate is kept.
    let same = load(&manifest, &["duration_s=20"]);
    assert_eq!(same, run);
    assert_eq!(same.gate_place(0), "x.toml:7:1");
    let set = load(&manifest, &["duration_s=10"]);
    let edited = load(
        &manifest.replace("duration_s = 20.0", "duration_s = 10.0"),
        &[],
    );
    for changed in [&set, &edited] {
        assert_eq!(changed.file, "m.toml");
        assert_eq!(changed.inputs.len(), 1);
        assert_eq!(changed.inputs[0].file, "m.toml");
        assert_eq!(
            changed.folder(),
            "x/0001",
            "its swept key has its value still"
        );
    }
    let digest = |text: &str| blake3::hash(text.as_bytes()).to_hex().to_string();
    assert_eq!(set.inputs[0].digest, digest(&manifest));
    assert_ne!(edited.inputs[0].digest, set.inputs[0].digest);
    assert_eq!(load(&manifest, &["seed=6"]).sweep, None);
    // The manifest of the changed run is true of itself.
    let again = load(&manifest_toml(&set, env!("CARGO_PKG_VERSION"), "b"), &[]);
    assert_eq!(again, set);
}

#[test]
fn a_manifest_of_another_version_of_the_tool_warns() {
    let run = run("", &[]);
    let suite = Suite::new(&[("m.toml", &manifest_toml(&run, "0.0.1", "b"))]);
    let again = suite.load(&["m.toml"], &[]).unwrap().remove(0);
    assert_eq!(again.warnings.len(), 1);
    assert!(
        again.warnings[0].starts_with("m.toml was written by fogbench 0.0.1, this is "),
        "{:?}",
        again.warnings
    );
    let suite = Suite::new(&[(
        "m.toml",
        &manifest_toml(&run, env!("CARGO_PKG_VERSION"), "b"),
    )]);
    assert!(suite.load(&["m.toml"], &[]).unwrap()[0].warnings.is_empty());
}

#[test]
fn spelling_does_not_change_the_digest() {
    let plain = run("[gyro.coil]\nlength_m = 800\n", &[]);
    let other = run(
        "gyro = { coil = { length_m = 8.0e2 } } # comment\n",
        &["seed=1"],
    );
    assert_eq!(plain.digest, other.digest);
    assert_ne!(plain.digest, run("seed = 2\n", &[]).digest);
}

#[test]
fn keys_are_located_and_defaults_at_their_nearest_ancestor() {
    let suite = Suite::new(&[(
        "x.toml",
        &scenario(
            "[[filter]]\nname = \"a\"\n  [filter.lms]\n  taps = 2\n[[gate]]\nmax = 1\nmetric = \"a.b\"\n",
        ),
    )]);
    let run = suite.load(&["x.toml"], &["repeats=2"]).unwrap().remove(0);
    let at = |key: &str| {
        let location = run.locate(key);
        (location.line, location.column)
    };
    assert_eq!(at("filter[0].lms.taps"), (7, 3));
    assert_eq!(at("filter[0].lms.step_size"), (6, 11));
    assert_eq!(at("filter[0].name"), (5, 1));
    assert_eq!(at("gate[0].metric"), (10, 1));
    assert_eq!(at("gate[0].min"), (8, 1));
    assert_eq!(at("gyro.coil.length_m"), (1, 1));
    assert_eq!(run.locate("repeats").to_string(), "--set repeats=2");
}

#[test]
fn files_below_the_working_directory_are_shown_by_their_relative_path() {
    let base = PathBuf::from("scenarios/./base/../base/fog70.toml");
    let errors = load_suite(std::slice::from_ref(&base), &[]).unwrap_err();
    let got = errors[0].to_string();
    assert!(
        got.starts_with("scenarios/base/fog70.toml:1:1: name is required"),
        "{got}"
    );
    let sets = ["name=x", "duration_s=1"].map(str::to_owned);
    let runs = load_suite(&[base], &sets).unwrap();
    assert_eq!(runs[0].shown_file(), "scenarios/base/fog70.toml");
    assert_eq!(runs[0].file, "fog70.toml", "results do not name the folder");
    assert_eq!(runs[0].inputs[0].file, runs[0].file);
}

#[test]
fn inputs_are_labelled_as_seen_from_the_folder_of_the_scenario() {
    let extends = |base: &str| scenario(&format!("extends = \"{base}\"\n"));
    let suite = Suite::new(&[
        ("a/base.toml", "extends = \"./more/./b.toml\"\n"),
        ("a/more/b.toml", "extends = \"../../c/c.toml\"\n"),
        ("c/c.toml", "seed = 2\n"),
        ("a/x.toml", &extends("more/../base.toml")),
    ]);
    let labels = |run: &Resolved| -> Vec<String> {
        run.inputs.iter().map(|input| input.file.clone()).collect()
    };
    let run = suite.load(&["a/x.toml"], &[]).unwrap().remove(0);
    assert_eq!(
        labels(&run),
        ["../c/c.toml", "more/b.toml", "base.toml", "x.toml"]
    );
    let absolute = extends(&suite.path("c/c.toml").to_string_lossy());
    fs::write(suite.path("y.toml"), absolute).unwrap();
    let run = suite.load(&["y.toml"], &[]).unwrap().remove(0);
    assert_eq!(labels(&run), ["c.toml", "y.toml"], "no absolute path");
}

/// The worked example of the documentation.
const EXAMPLE: &str = r#"#:schema ./scenario.schema.json
schema = 1
name = "swing-5hz"
extends = "../base/fog70.toml"    # deep merge; arrays replaced; cycles refused
seed = 1
repeats = 1                       # independent noise, same everything else
duration_s = 20.0
warm_up_s = 20.0                  # simulated and filtered, left out of every metric
fidelity = "loop"                 # every half modulation period; "rate" = output-rate equivalent

[turntable.swing]
rate_amplitude_deg_per_s = 1.0    # or angle_amplitude_deg
frequency_hz = 5.0
[turntable.site]
latitude_deg = 34.27
[gyro.coil]
length_m = 800.0
diameter_mm = 70.0
[gyro.source]
wavelength_nm = 1310.0
[gyro.temperature.soak]
temperature_c = 25.0
[[filter]]
name = "rls"
[filter.rls]                      # the table's name is the kind
taps = 4
forgetting_factor = 1.0
pipeline = "textbook"
[[gate]]
metric = "rls.delay_vs_raw_ms"
min = 0.33
max = 0.35
[[published]]
metric = "rls.delay_vs_raw_ms"
value = 0.25
unit = "ms"
source = "paper, section 4.2"
[output]
samples = "npy"
[matrix]
"gyro.source.power_uw" = [0.5, 0.87, 2.0]
"#;

#[test]
fn the_worked_example_loads() {
    let base = include_str!("../../scenarios/base/fog70.toml");
    let suite = Suite::new(&[("base/fog70.toml", base), ("paper/x.toml", EXAMPLE)]);
    let runs = suite.load(&["paper", "base"], &[]).unwrap();
    assert_eq!(runs.len(), 3);
    assert_eq!(runs[2].folder(), "swing-5hz/0002");
    assert_eq!(
        runs[0].inputs[0].file, "../base/fog70.toml",
        "the innermost base comes first"
    );
}

#[test]
fn contradictions_are_refused_with_the_reason() {
    complaints_of_each(
        "Contradictions are refused with the reason",
        [
            "[gyro.detector]\ngate_spikes = false\n",
            "[gyro.detector]\ngate_spikes = false\ngate_duty = 1.0\n[gyro.modulator]\nscheme = \"four-state\"\n",
            "[gyro.modulator]\nscheme = \"four-state\"\nintensity_modulation = 1e-3\n",
            "[gyro.modulator]\nscheme = \"four-state-half\"\n[gyro.adc]\nsamples_per_half_period = 7\n",
            "[turntable.static]\n[turntable.rotation]\nrate_deg_per_s = 1.0\n",
            "[turntable.swing]\nfrequency_hz = 5.0\n",
            "[turntable.swing]\nfrequency_hz = 5.0\nrate_amplitude_deg_per_s = 1.0\nangle_amplitude_deg = 1.0\n",
        ],
    );
}

#[test]
fn complaints_that_only_follow_from_a_fault_are_not_made() {
    // A missing duration makes no record too short, and a misspelt table no channel unknown.
    let gate = "[[gate]]\nmetric = \"raw.bias_stability_100s_deg_per_h\"\nmax = 1\n";
    let suite = Suite::new(&[
        (
            "d.toml",
            &format!("name = \"d\"\nduration_s = \"long\"\n{gate}"),
        ),
        (
            "f.toml",
            "name = \"f\"\nduration_s = 20.0\n[[filtre]]\nname = \"a\"\n[filtre.rls]\n\
             [[gate]]\nmetric = \"a.noise_gain\"\nmax = 1\n",
        ),
        (
            "w.toml",
            "name = \"w\"\nduration_s = 20.0\nwarm_up_s = -1\n[turntable.swing]\n\
             frequency_hz = 1\nangle_amplitude_deg = 1\n",
        ),
    ]);
    for (file, count) in [("d.toml", 1), ("f.toml", 1), ("w.toml", 1)] {
        let path = suite.path(file);
        let errors = fogbench::experiment::plan_suite(&[path], &[]).unwrap_err();
        assert_eq!(errors.len(), count, "{file}: {errors:#?}");
    }
}

#[test]
fn complaints_show_the_text_that_they_are_about() {
    let shown = |more: &str, sets: &[&str]| {
        let suite = Suite::new(&[("x.toml", &scenario(more))]);
        let errors = suite.load(&["x.toml"], sets).unwrap_err();
        let (text, line, span) = errors[0].source().unwrap();
        (line, text[span].to_owned())
    };
    let coil = "[gyro.coil]\n";
    assert_eq!(
        shown(&format!("{coil}  lenght_m = 1 # m\n"), &[]),
        (5, "lenght_m".to_owned())
    );
    assert_eq!(
        shown(&format!("{coil}length_m = -5 # m\n"), &[]),
        (5, "length_m = -5".to_owned())
    );
    assert_eq!(shown("", &["seed=-1"]), (1, "seed=-1".to_owned()));
    // What is missing cannot be shown.
    let suite = Suite::new(&[("x.toml", "seed = 3\n")]);
    let errors = suite.load(&["x.toml"], &[]).unwrap_err();
    assert!(
        errors.iter().all(|error| error.source().is_none()),
        "{errors:?}"
    );
}

#[test]
fn a_hint_leads_to_the_filter_that_was_meant_and_a_kind_that_is_replaced_is_said() {
    let text = "schema = 1\nname = \"x\"\nduration_s = 20.0\n[[filter]]\nname = \"l\"\n[filter.lms]\n\
                [[filter]]\nname = \"r\"\n[filter.rls]\n";
    let suite = Suite::new(&[("x.toml", text)]);
    let refused = |set: &str| {
        let errors = suite.load(&["x.toml"], &[set]).expect_err("refused");
        errors[0].to_string()
    };
    let hint = refused("filter[].rls.taps=5");
    assert!(
        hint.contains("as in filter[1].rls.taps, or its name, as in filter.r.taps"),
        "{hint}"
    );
    let hint = refused("filter[].lms.taps=5");
    assert!(
        hint.contains("as in filter[0].lms.taps, or its name, as in filter.l.taps"),
        "{hint}"
    );
    let hint = refused("filter[].sign_lms.taps=5");
    assert!(
        hint.contains("no [[filter]] with a table [filter.sign_lms]"),
        "{hint}"
    );
    let remarks = |set: &str| {
        let runs = suite.load(&["x.toml"], &[set]).expect("sound");
        runs[0].remarks.concat()
    };
    for set in ["filter[0].rls.taps=5", "filter.l.rls.taps=5"] {
        let said = remarks(set);
        assert!(
            said.contains("filter \"l\", of the kind lms, is of the kind rls"),
            "{said}"
        );
    }
    assert_eq!(remarks("filter[1].rls.taps=5"), "");
    assert_eq!(remarks("filter.l.taps=5"), "");
    let swept = format!("{text}[matrix]\n\"filter.l.rls.taps\" = [3, 4]\n");
    let suite = Suite::new(&[("x.toml", &swept)]);
    let runs = suite.load(&["x.toml"], &[]).expect("sound");
    assert!(runs[0].remarks.concat().contains("is of the kind rls"));
}

#[test]
fn a_value_that_is_swept_twice_is_said_once() {
    let text = "schema = 1\nname = \"x\"\nduration_s = 20.0\n[matrix]\nseed = [1, 2, 1]\n";
    let suite = Suite::new(&[("x.toml", text)]);
    let runs = suite.load(&["x.toml"], &[]).expect("sound");
    let remarks: Vec<&String> = runs.iter().flat_map(|run| &run.remarks).collect();
    let [remark] = &remarks[..] else {
        panic!("{remarks:?}");
    };
    assert!(
        remark.contains("seed = 1 stands more than once"),
        "{remark}"
    );
}

#[test]
fn a_suggested_metric_is_one_that_the_channel_has() {
    let refused = |metric: &str| {
        let text = format!(
            "schema = 1\nname = \"x\"\nduration_s = 20.0\n[[filter]]\nname = \"rls\"\n[filter.rls]\n\
             [[gate]]\nmetric = \"{metric}\"\nmax = 1.0\n"
        );
        let suite = Suite::new(&[("x.toml", &text)]);
        let plans = fogbench::experiment::plan_suite(&[suite.path("x.toml")], &[]);
        plans.expect_err("refused")[0].to_string()
    };
    for metric in ["raw.gain", "raw.latency"] {
        let said = refused(metric);
        assert!(!said.contains("did you mean"), "{said}");
    }
    let said = refused("rls.mean_deg_per_s");
    assert!(said.contains("1 deg/s is 3600 deg/h"), "{said}");
    let said = refused("raw.bias");
    assert!(!said.contains("`mean_deg_per_h`"), "{said}");
}
