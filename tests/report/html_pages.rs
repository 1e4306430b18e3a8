//! `report.html` and `index.html` as files; `tests/pages` looks at them in a browser.

use std::fs;
use std::path::Path;

use fogbench::comparison::Comparison;
use fogbench::report::{RunOutcome, SuiteReport, suite_page};

use crate::support::{code, fogbench, stderr, tree, write};

const SHORT: &str = "schema = 1\nduration_s = 1.0\nwarm_up_s = 0.5\nfidelity = \"rate\"\n";
/// No page is larger.
const BYTES_MAX: usize = 2_000_000;

fn page(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).expect("a page")
}

#[test]
fn pages_stand_alone_and_what_a_scenario_says_is_no_markup() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    let words = "description = \"<script>alert(1)</script> & 'co'\"\n\
                 [[published]]\nmetric = \"raw.noise_std_deg_per_h\"\nvalue = 1.0\nunit = \"deg/h\"\n\
                 source = \"<img src=x onerror=alert(1)>\"\n\
                 [[comparison]]\nname = \"T\"\ntitle = \"<b>t</b>\"\nkind = \"published\"\n\
                 columns = [\"raw.noise_std_deg_per_h\"]\n\
                 [[comparison_row]]\ncomparison = \"T\"\nlabel = \"<i>a</i>\"\nscenarios = [\"s\"]\n";
    write(at, "s.toml", &format!("name = \"s\"\n{SHORT}{words}"));
    let output = fogbench(at, &["run", "s.toml"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    for (name, said) in [
        (
            "index.html",
            ["&lt;b&gt;t&lt;/b&gt;", "&lt;i&gt;a&lt;/i&gt;"],
        ),
        (
            "s/report.html",
            ["&lt;script&gt;alert(1)", "&lt;img src=x onerror"],
        ),
    ] {
        let text = page(&at.join("output"), name);
        for said in said {
            assert!(text.contains(said), "{name} says {said}");
        }
        for markup in ["<script>alert", "<img", "<b>t", "<i>a"] {
            assert!(!text.contains(markup), "{name} has {markup}");
        }
        // What a browser would ask for stands in attributes like these.
        for outside in [
            "src=\"",
            "url(",
            "@import",
            "href=\"http",
            "<iframe",
            "<object",
        ] {
            assert!(!text.contains(outside), "{name} has {outside}");
        }
        assert!(text.contains("Content-Security-Policy") && text.len() < BYTES_MAX);
        // Folders of this machine are nobody's business.
        assert!(!text.contains(&at.to_string_lossy().into_owned()), "{name}");
    }
}

#[test]
fn a_run_from_its_manifest_and_any_number_of_threads_give_the_same_pages() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    let sweep = "[[filter]]\nname = \"lms\"\n[filter.lms]\n[[gate]]\nmetric = \"lms.dc_gain\"\nmax = 0.1\n\
                 [matrix]\n\"gyro.source.power_uw\" = [0.5, 0.87]\n";
    write(at, "s.toml", &format!("name = \"s\"\n{SHORT}{sweep}"));
    for (jobs, output) in [("1", "a"), ("2", "b")] {
        fogbench(at, &["run", "s.toml", "-j", jobs, "-o", output]);
    }
    assert!(tree(&at.join("a")) == tree(&at.join("b")));
    let assumed = "gyro.slow_noise.bias_instability_deg_per_h";
    let first = page(at, "a/s/0001/report.html");
    assert!(first.contains(&format!("<code>{assumed}</code>")));
    assert!(!first.contains("<code>duration_s</code>"));
    fogbench(at, &["run", "a/s/0001/manifest.toml", "-o", "c"]);
    assert_eq!(first, page(at, "c/s/0001/report.html"));
    // What was set on the command line is not assumed.
    let set = format!("{assumed}=0.02");
    fogbench(
        at,
        &["run", "a/s/0001/manifest.toml", "--set", &set, "-o", "d"],
    );
    assert!(!page(at, "d/s/0001/report.html").contains(&format!("<code>{assumed}</code>")));
}

#[test]
fn a_long_sweep_has_pages_of_what_failed_unless_all_are_asked_for() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    let seeds: Vec<String> = (1..=101).map(|seed: u32| seed.to_string()).collect();
    let text = format!(
        "name = \"s\"\nschema = 1\nduration_s = 0.02\nwarm_up_s = 0.01\nfidelity = \"rate\"\n\
         [[gate]]\nmetric = \"raw.mean_deg_per_h\"\nmin = 8.0\ndecide = \"value\"\n[matrix]\nseed = [{}]\n",
        seeds.join(", ")
    );
    write(at, "s.toml", &text);
    let pages = |set: &[&str]| -> Vec<bool> {
        let run = fogbench(at, &[&["run", "s.toml"], set].concat());
        assert_eq!(code(&run), 1, "{}", stderr(&run));
        let summary = page(at, "output/summary.json");
        let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
        let runs = summary["runs"].as_array().expect("runs").iter();
        runs.map(|run| {
            let folder = run["folder"].as_str().expect("a folder");
            let has_page = at.join("output").join(folder).join("report.html").is_file();
            let link = format!("{folder}/{}.", if has_page { "report" } else { "summary" });
            assert!(page(at, "output/index.html").contains(&link), "{link}");
            has_page == (run["status"] != "pass")
        })
        .collect()
    };
    let all = ["--set", "output.report=all"];
    assert!(pages(&[]).iter().all(|is_of_failed| *is_of_failed));
    assert!(!pages(&all).iter().all(|is_of_failed| *is_of_failed));
    // A short one has all of them, or those that are asked for.
    write(at, "s.toml", &text.replace("2, 3, 4, 5, 6, ", ""));
    assert!(!pages(&[]).iter().all(|is_of_failed| *is_of_failed));
    let failed = ["--set", "output.report=failed"];
    assert!(pages(&failed).iter().all(|is_of_failed| *is_of_failed));
}

#[test]
fn the_index_of_ten_thousand_points_is_small_and_shows_what_failed() {
    let failed = [17, 4711, 9998];
    let runs: Vec<RunOutcome> = (0..10_000)
        .map(|index| {
            let set = vec![("gyro.source.power_uw".to_owned(), format!("{index}.5"))];
            let folder = format!("m/{index:04}");
            let run = match failed.contains(&index) {
                true => RunOutcome::failed("m", &folder, "m.toml", "the reason".to_owned()),
                false => RunOutcome::not_run("m", &folder, "m.toml"),
            };
            run.at(Some((index, set)))
        })
        .collect();
    let suite = SuiteReport {
        tool_version: "0.1.0",
        runs: &runs,
        across: &Comparison::default(),
        stale: &[],
        against: None,
    };
    let page = suite_page(&suite, &[], &[]);
    assert!(page.len() < BYTES_MAX, "{} bytes", page.len());
    assert_eq!(
        page.matches("<th scope=\"row\">m/").count() + failed.len(),
        500
    );
    for index in failed {
        assert!(
            page.contains(&format!("m/{index:04}/summary.json")),
            "{index}"
        );
    }
    assert!(page.contains("href=\"metrics.csv\""));
}
