//! Malformed scenario files: each gives one clear complaint that points at the wrong place.

use std::fs;
use std::path::PathBuf;

use fogbench::filters::{FilterKind, KINDS};
use fogbench::scenario::{MotionConfig, Resolved, ScenarioError, load_suite, manifest_toml};
use tempfile::TempDir;

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
    let got = complaints("[gyro.coil\nlength_m = 1.0\n");
    assert_eq!(got.len(), 1);
    assert!(got[0].starts_with("x.toml:4:11: syntax error: "), "{got:?}");
}

#[test]
fn duplicate_key_is_a_syntax_error() {
    let got = complaints("seed = 1\nseed = 2\n");
    assert!(
        got[0].starts_with("x.toml:5:1: syntax error: duplicate key seed"),
        "{got:?}"
    );
}

#[test]
fn unknown_key_names_the_nearest_known_one() {
    assert_eq!(
        complaints("[gyro.coil]\n  lenght_m = 800.0\n"),
        ["x.toml:5:3: unknown key gyro.coil.lenght_m: did you mean gyro.coil.length_m?"]
    );
    assert_eq!(
        complaints("[turntables]\nx = 1\n"),
        ["x.toml:4:2: unknown key turntables: did you mean turntable?"]
    );
    assert_eq!(
        complaints("[[filter]]\nname = \"a\"\n[filter.rls]\ntap = 4\n"),
        ["x.toml:7:1: unknown key filter[0].rls.tap: did you mean filter[0].rls.taps?"]
    );
    assert_eq!(
        complaints("[turntable.static]\nfast = true\n"),
        [
            "x.toml:4:12: unknown key turntable.static.fast: turntable.static is a table without keys"
        ]
    );
}

#[test]
fn wrong_type_says_what_is_expected() {
    assert_eq!(
        complaints("[gyro.coil]\nlength_m = \"long\"\n"),
        ["x.toml:5:1: gyro.coil.length_m has the wrong type: \
          expected a number, [1, 50000] m, got a string \"long\""]
    );
    assert_eq!(
        complaints("repeats = 1.5\n"),
        ["x.toml:4:1: repeats has the wrong type: \
          expected a whole number, 1..=100000, got a number with a fraction 1.5"]
    );
    assert_eq!(
        complaints("gyro = 3\n"),
        [
            "x.toml:4:1: gyro has the wrong type: expected a table, written [gyro], got a whole number"
        ]
    );
    assert_eq!(
        complaints("[filter]\nname = \"a\"\n"),
        [
            "x.toml:4:2: filter has the wrong type: expected a table, written [[filter]], got a table"
        ]
    );
    assert_eq!(
        complaints("[gyro]\nnoise.shot = 1\n"),
        [
            "x.toml:5:7: gyro.noise.shot has the wrong type: expected true or false, got a whole number 1"
        ]
    );
}

#[test]
fn unknown_choice_lists_the_choices() {
    assert_eq!(
        complaints("fidelity = \"lop\"\n"),
        ["x.toml:4:1: fidelity = \"lop\" is unknown: \
          expected one of \"loop\", \"rate\" (did you mean \"loop\"?)"]
    );
}

#[test]
fn value_out_of_range_gives_unit_and_range() {
    assert_eq!(
        complaints("[gyro.coil]\nlength_m = -5\n"),
        ["x.toml:5:1: gyro.coil.length_m = -5 m is out of range: allowed [1, 50000] m"]
    );
    assert_eq!(
        complaints("[gyro.output]\nhalf_periods_per_sample = 63\n"),
        [
            "x.toml:5:1: gyro.output.half_periods_per_sample = 63 is out of range: \
          allowed even 2..=1048576"
        ]
    );
    assert_eq!(
        complaints("seed = -1\n"),
        ["x.toml:4:1: seed = -1 is out of range: allowed 0..=9223372036854775807"]
    );
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    assert_eq!(
        complaints("[gyro.source]\npower_uw = nan\nlinewidth_nm = inf\n"),
        [
            "x.toml:5:1: gyro.source.power_uw = nan is not a finite number: allowed [0.001, 100000] uW",
            "x.toml:6:1: gyro.source.linewidth_nm = inf is not a finite number: allowed [1e-6, 500] nm",
        ]
    );
}

#[test]
fn numbers_that_do_not_fit_are_told_from_infinity() {
    assert_eq!(
        complaints("[gyro.source]\npower_uw = 1e400\n"),
        [
            "x.toml:5:1: gyro.source.power_uw = 1e400 is beyond the range of binary64: \
          allowed [0.001, 100000] uW"
        ]
    );
    assert_eq!(
        complaints("seed = 18446744073709551616\n"),
        [
            "x.toml:4:1: seed = 18446744073709551616 is beyond 64 bits with sign: \
          allowed 0..=9223372036854775807"
        ]
    );
}

#[test]
fn wrong_elements_of_an_array_are_blamed_where_they_stand() {
    let steps = |rates: &str| {
        complaints(&format!(
            "[turntable.steps]\nrates_deg_per_s = {rates}\ndwell_s = 1\n"
        ))
    };
    assert_eq!(
        steps("[0.0,\n  \"fast\"]"),
        [
            "x.toml:6:3: turntable.steps.rates_deg_per_s[1] has the wrong type: \
          expected a number, [-2000, 2000] deg/s, got a string \"fast\""
        ]
    );
    assert_eq!(
        steps("[0.0, 1, 3e3]"),
        [
            "x.toml:5:28: turntable.steps.rates_deg_per_s[2] = 3000.0 deg/s is out of range: \
          allowed [-2000, 2000] deg/s"
        ]
    );
}

#[test]
fn zero_duration_is_out_of_range() {
    let text = "name = \"x\"\nduration_s = 0.0\n";
    let got = Suite::new(&[("x.toml", text)]).complaints(&["x.toml"], &[]);
    assert_eq!(
        got,
        ["x.toml:2:1: duration_s = 0.0 s is out of range: allowed [1e-6, 10000000] s"]
    );
}

#[test]
fn inherited_values_are_blamed_on_the_base() {
    let base = "# a base\n[gyro.coil]\nlength_m = 90000.0\n";
    let suite = Suite::new(&[
        ("base/b.toml", base),
        (
            "x.toml",
            &scenario("extends = \"base/b.toml\"\n[gyro.coil]\ndiameter_mm = 60.0\n"),
        ),
    ]);
    assert_eq!(
        suite.complaints(&["x.toml"], &[]),
        ["base/b.toml:3:1: gyro.coil.length_m = 90000.0 m is out of range: allowed [1, 50000] m"]
    );
    // A value that the scenario replaces does no harm.
    assert!(suite.load(&["x.toml"], &["gyro.coil.length_m=800"]).is_ok());
}

#[test]
fn set_values_are_blamed_on_the_argument() {
    assert_eq!(
        complaints_of_set("", &["gyro.coil.length_m=-5"]),
        ["--set gyro.coil.length_m=-5: \
          gyro.coil.length_m = -5 m is out of range: allowed [1, 50000] m"]
    );
    assert_eq!(
        complaints_of_set(
            "",
            &[
                "gyro.coil.lenght_m=5",
                "duration_s",
                "seed=[1",
                "fidelity=fast"
            ]
        ),
        [
            "--set gyro.coil.lenght_m=5: \
             unknown key gyro.coil.lenght_m: did you mean gyro.coil.length_m?",
            "--set duration_s: expected key=value, as in gyro.coil.length_m=800",
            "--set seed=[1: syntax error: unclosed array, expected `]` in the value",
            "--set fidelity=fast: fidelity = \"fast\" is unknown: expected one of \"loop\", \"rate\"",
        ]
    );
}

#[test]
fn sweeps_and_bases_cannot_be_set() {
    assert_eq!(
        complaints_of_set("", &["matrix.seed=[1,2]", "extends=y.toml"]),
        [
            "--set matrix.seed=[1,2]: matrix.seed cannot be set: \
             write the sweep into a file, or give one value, as in seed=2",
            "--set extends=y.toml: extends cannot be set: write it into a file",
        ]
    );
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
    assert_eq!(
        complaints_of_set(filters, &["filter.other.taps=8", "filter[2].rls.taps=1"]),
        [
            "--set filter.other.taps=8: there is no filter named other: expected one of fast, slow",
            "--set filter[2].rls.taps=1: there is no filter[2]: the scenario has 2 of them, counted from 0",
        ]
    );
}

#[test]
fn cycle_in_extends_is_refused_where_it_closes() {
    let suite = Suite::new(&[
        ("x.toml", &scenario("extends = \"y.toml\"\n")),
        ("y.toml", "seed = 2\nextends = \"./x.toml\"\n"),
    ]);
    let got = suite.complaints(&["x.toml"], &[]);
    assert_eq!(
        got,
        ["y.toml:2:1: extends = \"./x.toml\" closes a cycle: x.toml is being extended already"]
    );
}

#[test]
fn missing_files_are_named() {
    let got = complaints("extends = \"nowhere.toml\"\n");
    assert_eq!(got, ["x.toml:4:1: extends nowhere.toml: no such file"]);
    let suite = Suite::new(&[("s/x.toml", &scenario("extends = \".\"\n"))]);
    let got = suite.complaints(&["s/x.toml"], &[]);
    assert_eq!(got, ["s/x.toml:4:1: extends s: it is a folder, not a file"]);
    let suite = Suite::new(&[]);
    assert_eq!(
        suite.complaints(&["none.toml"], &[]),
        ["none.toml: no such file or folder"]
    );
}

#[test]
fn missing_required_keys_are_named() {
    let suite = Suite::new(&[("x.toml", "seed = 3\n")]);
    let got = suite.complaints(&["x.toml"], &[]);
    assert_eq!(got.len(), 2, "{got:?}");
    assert!(
        got[0].starts_with("x.toml:1:1: name is required: expected a name "),
        "{got:?}"
    );
    assert!(
        got[1].starts_with("x.toml:1:1: duration_s is required: expected a number, [1e-6, "),
        "{got:?}"
    );
    let kinds: Vec<String> = KINDS
        .iter()
        .map(|kind| format!("filter[0].{kind}"))
        .collect();
    assert_eq!(
        complaints("[[filter]]\nname = \"a\"\n"),
        [format!(
            "x.toml:4:1: filter[0] needs exactly one filter kind: {}",
            kinds.join(", ")
        )]
    );
}

#[test]
fn names_are_not_inherited() {
    let suite = Suite::new(&[
        ("x.toml", &scenario("")),
        ("y.toml", "extends = \"x.toml\"\n"),
    ]);
    let got = suite.complaints(&["y.toml"], &[]);
    assert!(
        got[0].starts_with("y.toml:1:1: name is required"),
        "{got:?}"
    );
}

#[test]
fn bad_reserved_and_repeated_names_are_refused() {
    let suite = Suite::new(&[("x.toml", "name = \"Swing 5\"\nduration_s = 1\n")]);
    assert_eq!(
        suite.complaints(&["x.toml"], &[]),
        ["x.toml:1:1: name = \"Swing 5\" is not a valid name: allowed [a-z0-9][a-z0-9_-]{0,63}"]
    );
    assert_eq!(
        complaints("[[filter]]\nname = \"truth\"\n[filter.rls]\n"),
        [
            "x.toml:5:1: filter[0].name = \"truth\" is a reserved name: \
          raw, truth, time_s, encoder_arcsec have a meaning of their own"
        ]
    );
    assert_eq!(
        complaints(
            "[[filter]]\nname = \"a\"\n[filter.rls]\n[[filter]]\nname = \"a\"\n[filter.lms]\n"
        ),
        [
            "x.toml:8:1: filter[1].name = \"a\" is the name of filter[0] already: \
          give each channel its own"
        ]
    );
    assert_eq!(
        complaints_of_set("", &["name=time_s"]),
        ["--set name=time_s: name = \"time_s\" is a reserved name: \
          raw, truth, time_s, encoder_arcsec have a meaning of their own"]
    );
    let long = format!("name={}", "a".repeat(65));
    assert!(complaints_of_set("", &[&long])[0].contains("is not a valid name"));
    let fits = format!("name={}", "a".repeat(64));
    assert_eq!(run("", &[&fits]).scenario.name.len(), 64);
}

#[test]
fn two_scenarios_of_one_name_are_refused() {
    let suite = Suite::new(&[("s/a.toml", &scenario("")), ("s/b.toml", &scenario(""))]);
    assert_eq!(
        suite.complaints(&["s"], &[]),
        [
            "s/b.toml:2:1: name = \"x\" is the name of the scenario at s/a.toml:2:1 already: \
          give each scenario its own"
        ]
    );
}

#[test]
fn two_motions_in_one_file_are_refused_but_a_later_file_replaces_the_motion() {
    assert_eq!(
        complaints("[turntable.static]\n[turntable.rotation]\nrate_deg_per_s = 1.0\n"),
        [
            "x.toml:5:12: turntable.rotation contradicts turntable.static: give exactly one motion: \
          turntable.static, turntable.swing, turntable.multi_sine, turntable.steps, \
             turntable.scale_factor_test, turntable.rotation, turntable.trapezoid, turntable.chirp, \
             turntable.script, turntable.calibration"
        ]
    );
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
fn a_swing_has_exactly_one_amplitude() {
    let swing = "[turntable.swing]\nfrequency_hz = 5.0\n";
    assert_eq!(
        complaints(swing),
        ["x.toml:4:12: turntable.swing needs exactly one amplitude: \
          turntable.swing.rate_amplitude_deg_per_s, turntable.swing.angle_amplitude_deg"]
    );
    let both = format!("{swing}rate_amplitude_deg_per_s = 1.0\nangle_amplitude_deg = 1.0\n");
    let got = complaints(&both);
    assert_eq!(got.len(), 1);
    assert!(
        got[0].starts_with("x.toml:7:1: turntable.swing.angle_amplitude_deg contradicts "),
        "{got:?}"
    );
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
    assert_eq!(
        complaints("[turntable.steps]\nrates_deg_per_s = [0.0, 1.0, 2.0]\ndwell_s = 7.0\n"),
        ["x.toml:6:1: turntable.steps.dwell_s = 7.0 s is too long: \
          3 rates take 21.0 s, but duration_s = 20.0 s"]
    );
    assert_eq!(
        complaints("warm_up_s = 0.5\n[turntable.rotation]\nrate_deg_per_s = 1.0\n"),
        [
            "x.toml:4:1: turntable.rotation.soft_start_s = 1.0 s is longer than the warm-up: \
          allowed [0, warm_up_s = 0.5] s"
        ]
    );
    let got = complaints("[turntable.swing]\nfrequency_hz = 500.0\nangle_amplitude_deg = 1e-3\n");
    // 3989.45 Hz / 8.
    assert!(
        got[0].starts_with(
            "x.toml:5:1: turntable.swing.frequency_hz = 500.0 Hz is too fast: allowed up to 498.68"
        ),
        "{got:?}"
    );
}

#[test]
fn gates_need_limits_and_channels() {
    let gate = |body: &str| complaints(&format!("[[gate]]\n{body}"));
    assert_eq!(
        gate("metric = \"raw.noise_gain\"\n"),
        ["x.toml:4:1: gate[0] has no limit: give min, max or both"]
    );
    assert_eq!(
        gate("metric = \"raw.noise_gain\"\nmin = 2\nmax = 1\n"),
        ["x.toml:6:1: gate[0].min = 2.0 is greater than gate[0].max = 1.0"]
    );
    let text = scenario("[[gate]]\nmetric = \"noise_gain\"\nmin = 2\n");
    let suite = Suite::new(&[("x.toml", &text)]);
    let errors = fogbench::experiment::plan_suite(&[suite.path("x.toml")], &[]).unwrap_err();
    assert!(
        errors[0]
            .message
            .starts_with("gate[0].metric = \"noise_gain\" names no channel"),
        "{errors:?}"
    );
    assert_eq!(
        gate("metric = \"rls.noise_gain\"\nmin = 2\nrelative_to = \"lms\"\n"),
        [
            "x.toml:5:1: gate[0].metric = \"rls.noise_gain\": \
             there is no channel rls: expected one of raw",
            "x.toml:7:1: gate[0].relative_to = \"lms\": there is no channel lms: expected one of raw",
        ]
    );
    let published =
        "[[published]]\nmetric = \"lms.noise_gain\"\nvalue = 1\nunit = \"1\"\nsource = \"s\"\n";
    assert_eq!(
        complaints(published),
        ["x.toml:5:1: published[0].metric = \"lms.noise_gain\": \
          there is no channel lms: expected one of raw"]
    );
}

#[test]
fn other_versions_are_refused_alone() {
    let text = "schema = 2\nname = \"x\"\nnew_key = 1\n";
    let got = Suite::new(&[("x.toml", text)]).complaints(&["x.toml"], &[]);
    assert_eq!(
        got,
        ["x.toml:1:1: schema = 2 is not supported: this build reads schema 1"]
    );
}

#[test]
fn all_complaints_of_all_files_come_at_once() {
    let suite = Suite::new(&[
        ("s/a.toml", &scenario("sed = 1\nrepeats = 0\n")),
        ("s/b.toml", "name = \"b\"\nduration_s = -1\n"),
        ("s/c.toml", "name = \n"),
    ]);
    let got = suite.complaints(&["s"], &[]);
    assert_eq!(got.len(), 4, "{got:?}");
    assert!(
        got.iter()
            .filter(|line| line.starts_with("s/a.toml"))
            .count()
            == 2
    );
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
fn wrong_matrices_are_refused_where_they_are_wrong() {
    assert_eq!(
        complaints(
            "[matrix]\n\"gyro.source.powr_uw\" = [1]\nseed = []\nrepeats = 2\nname = [\"a\"]\n"
        ),
        [
            "x.toml:5:1: matrix: unknown key gyro.source.powr_uw: did you mean gyro.source.power_uw?",
            "x.toml:6:1: matrix: seed has no values: expected a non-empty array",
            "x.toml:7:1: matrix: repeats has the wrong type: \
             expected an array of values, got a whole number",
            "x.toml:8:1: matrix: name cannot be swept",
        ]
    );
    assert_eq!(
        complaints("[matrix]\n\"gyro.source.power_uw\" = [0.5, -2.0]\nseed = [1, 2]\n"),
        ["x.toml:5:32: gyro.source.power_uw = -2.0 uW is out of range: allowed [0.001, 100000] uW"]
    );
    assert!(complaints("[matrix]\n")[0].starts_with("x.toml:4:2: matrix is empty"));
    assert_eq!(
        complaints_of_set("[matrix]\nseed = [1, 2]\n", &["seed=3"]),
        ["x.toml:5:1: matrix: seed is swept here and given by --set: leave one of them out"]
    );
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
fn manifests_of_other_versions_or_damaged_ones_are_refused() {
    let suite = Suite::new(&[("m.toml", "manifest = 2\n"), ("n.toml", "manifest = 1\n")]);
    assert_eq!(
        suite.complaints(&["m.toml"], &[]),
        ["m.toml:1:1: manifest = 2 is not supported: this build reads manifest 1"]
    );
    assert!(
        suite.complaints(&["n.toml"], &[])[0].starts_with("n.toml:1:1: the manifest is damaged")
    );
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
    let base = include_str!("../scenarios/base/fog70.toml");
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
fn contradictory_bias_waves_are_refused_with_the_reason() {
    for (more, reason) in [
        (
            "[gyro.detector]\ngate_spikes = false\n",
            "averages the whole half period, but gyro.detector.gate_duty = 0.7",
        ),
        (
            "[gyro.detector]\ngate_spikes = false\ngate_duty = 1.0\n\
             [gyro.modulator]\nscheme = \"four-state\"\n",
            "averages the spikes of a square wave",
        ),
        (
            "[gyro.modulator]\nscheme = \"four-state\"\nintensity_modulation = 1e-3\n",
            "goes with the two states of a square wave",
        ),
        (
            "[gyro.modulator]\nscheme = \"four-state-half\"\n\
             [gyro.adc]\nsamples_per_half_period = 7\n",
            "samples_per_half_period = 7 is odd",
        ),
    ] {
        let found = complaints(more);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].contains(reason), "{found:?}");
    }
}

#[test]
fn later_layers_are_checked_though_an_earlier_one_complains() {
    // An unknown key, a value out of range, a contradiction and an inert key.
    let got = complaints(
        "sed = 2\n[gyro.coil]\nlength_m = -5\n[gyro.slow_noise]\n\
         gauss_markov_correlation_time_s = 7.0\n[[gate]]\nmetric = \"rls.noise_gain\"\nmax = 1\n",
    );
    let starts = [
        "x.toml:4:1: unknown key sed: did you mean seed?",
        "x.toml:6:1: gyro.coil.length_m = -5 m is out of range",
        "x.toml:8:1: gyro.slow_noise.gauss_markov_correlation_time_s = 7.0 has no effect",
        "x.toml:10:1: gate[0].metric = \"rls.noise_gain\": there is no channel rls",
    ];
    assert_eq!(got.len(), starts.len(), "{got:#?}");
    for (line, start) in got.iter().zip(starts) {
        assert!(line.starts_with(start), "{line}");
    }
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
fn a_missing_base_does_not_hide_what_is_wrong_here() {
    let got = complaints("extends = \"nowhere.toml\"\n[gyro.coil]\nlenght_m = 1\n");
    assert_eq!(
        got,
        [
            "x.toml:4:1: extends nowhere.toml: no such file",
            "x.toml:6:1: unknown key gyro.coil.lenght_m: did you mean gyro.coil.length_m?",
        ]
    );
}

#[test]
fn a_bad_metric_is_found_beside_an_unknown_key_and_a_contradiction() {
    let gates =
        "[[gate]]\nmetric = \"raw.arw\"\nmax = 1\n[[gate]]\nmetric = \"mean_deg_per_h\"\nmax = 1\n";
    for more in [
        "sed = 1\n",
        "[turntable.trapezoid]\nrate_deg_per_s = 0\nacceleration_deg_per_s2 = 1\nhold_s = 1\n",
    ] {
        let suite = Suite::new(&[("x.toml", &scenario(&format!("{more}{gates}")))]);
        let errors = fogbench::experiment::plan_suite(&[suite.path("x.toml")], &[]).unwrap_err();
        let texts: Vec<String> = errors.iter().map(ToString::to_string).collect();
        assert_eq!(texts.len(), 3, "{texts:#?}");
        assert!(
            texts[1].contains("did you mean `angle_random_walk_deg_per_sqrt_h`?"),
            "{texts:#?}"
        );
        assert!(texts[2].contains("as in raw.mean_deg_per_h"), "{texts:#?}");
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
fn array_brackets_without_an_index_are_explained() {
    let got = complaints_of_set(
        "[[filter]]\nname = \"rls\"\n[filter.rls]\n",
        &["filter[].rls.taps=4"],
    );
    assert_eq!(
        got,
        [
            "--set filter[].rls.taps=4: `filter[].rls.taps` does not say which filter: give its index, \
          as in filter[0].rls.taps, or the name of a filter, as in filter.rls.taps"
        ]
    );
}
