//! The reference records: read back, repeated to the byte, and nobody's files overwritten.

use std::fs;
use std::path::Path;

use crate::support::{assert_close, code, field, fogbench, stderr, stdout, summary};

fn written(folder: &Path, output: &str) {
    let run = fogbench(folder, &["records", "rest-fast", "steps", "-o", output]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
}

#[test]
fn records_are_read_back_with_the_figures_of_the_scenario_beside_them() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    written(folder.path(), "out");
    let sheet = fs::read_to_string(folder.path().join("out/datasheet.md")).expect("a data sheet");
    for part in [
        "`rest-fast`",
        "`steps`",
        "`truth_deg_per_h`",
        "angle random walk",
    ] {
        assert!(sheet.contains(part), "{part}: {sheet}");
    }
    assert!(!sheet.contains("`warm-up`"), "{sheet}");
    let run = ["run", "out/rest-fast/scenario.toml", "-o", "again"];
    let run = fogbench(folder.path(), &run);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let again = summary(&folder.path().join("again"), "rest-fast");
    let of_csv = [
        "--column",
        "raw_deg_per_h",
        "--reference-column",
        "truth_deg_per_h",
    ];
    let of_npy = ["--rate-hz", "3989.453870213599", "--unit", "deg/h"];
    for (file, own) in [("record.csv", of_csv), ("raw_deg_per_h.npy", of_npy)] {
        let path = format!("out/rest-fast/{file}");
        let arguments = ["analyze", path.as_str(), "--format", "json"];
        let analyzed = fogbench(folder.path(), &[arguments, own].concat());
        assert_eq!(code(&analyzed), 0, "{}", stderr(&analyzed));
        let found: serde_json::Value = serde_json::from_str(&stdout(&analyzed)).expect("JSON");
        for key in ["mean_deg_per_h", "bias_stability_1s_deg_per_h"] {
            let value = |result| field(result, &format!("raw.{key}"), "value");
            assert_close(value(&found), value(&again), 1e-6, 0.0);
        }
    }
}

#[test]
fn records_are_the_same_bytes_each_time_and_have_checksums() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    written(folder.path(), "one");
    written(folder.path(), "two");
    let sums = fs::read_to_string(folder.path().join("one/checksums.txt")).expect("checksums");
    let other = fs::read_to_string(folder.path().join("two/checksums.txt")).expect("checksums");
    assert_eq!(sums, other);
    // Scenario, CSV and five columns of two records, and the data sheet.
    assert_eq!(sums.lines().count(), 15, "{sums}");
    for line in sums.lines() {
        let (digest, name) = line.split_once("  ").expect("digest and name");
        let bytes = fs::read(folder.path().join("one").join(name)).expect("a file of the list");
        assert_eq!(blake3::hash(&bytes).to_hex().as_str(), digest, "{name}");
    }
}

#[test]
fn records_replace_nothing_of_somebody_else() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    fs::create_dir(folder.path().join("out")).expect("a folder");
    let own = folder.path().join("out/datasheet.md");
    fs::write(&own, "mine").expect("a file");
    let refused = fogbench(folder.path(), &["records", "swing-5hz", "-o", "out"]);
    assert_eq!(code(&refused), 2, "{}", stderr(&refused));
    assert_eq!(fs::read_to_string(&own).expect("still there"), "mine");
    let unknown = fogbench(folder.path(), &["records", "rset", "-o", "out"]);
    assert_eq!(code(&unknown), 2);
    assert!(stderr(&unknown).contains("'rest'"), "{}", stderr(&unknown));
}
