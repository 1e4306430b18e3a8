//! Same scenario, seed and version: same bytes, for any number of threads.

use crate::support::{code, fogbench, stderr, tree, write};

#[test]
fn one_and_two_threads_write_the_same_bytes() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let scenario = |name: &str, more: &str| {
        format!(
            "schema = 1\nname = \"{name}\"\nduration_s = 3.0\nwarm_up_s = 1.0\n{more}\n\
             [output]\nsamples = \"npy\"\n[[filter]]\nname = \"lms\"\n[filter.lms]\n\
             [[filter]]\nname = \"rls\"\n[filter.rls]\n"
        )
    };
    let swing = "[turntable.swing]\nrate_amplitude_deg_per_s = 1.0\nfrequency_hz = 10.0\n";
    write(folder.path(), "set/static.toml", &scenario("static", ""));
    write(folder.path(), "set/swing.toml", &scenario("swing", swing));
    let repeats = scenario("repeats", "fidelity = \"rate\"\nrepeats = 5")
        .replace("[output]\nsamples = \"npy\"\n", "");
    write(folder.path(), "set/repeats.toml", &repeats);
    for jobs in ["1", "2"] {
        let output = fogbench(folder.path(), &["run", "set", "-j", jobs, "-o", jobs]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
    }
    let (one, two) = (
        tree(&folder.path().join("1")),
        tree(&folder.path().join("2")),
    );
    assert!(one.len() > 20, "{} files", one.len());
    for ((path, first), (other, second)) in one.iter().zip(&two) {
        assert_eq!(path, other);
        assert!(first == second, "{} differs", path.display());
    }
    assert_eq!(one.len(), two.len());
}

#[test]
fn another_seed_gives_other_bytes() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let text = "schema = 1\nname = \"a\"\nduration_s = 1.0\nwarm_up_s = 0.0\n";
    write(
        folder.path(),
        "a.toml",
        &format!("{text}[output]\nsamples = \"npy\"\n"),
    );
    let words = |seed: &str| {
        let set = format!("seed={seed}");
        fogbench(folder.path(), &["run", "a.toml", "--set", &set, "-o", seed]);
        std::fs::read(folder.path().join(seed).join("a/samples/raw.npy")).expect("written")
    };
    assert_ne!(words("1"), words("2"));
    assert_eq!(words("1"), words("1"));
}

#[test]
fn the_way_a_path_is_typed_does_not_reach_the_results() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let text = "schema = 1\nname = \"a\"\nextends = \"../base/b.toml\"\nduration_s = 1.0\n\
                warm_up_s = 0.0\n[[gate]]\nmetric = \"raw.mean_deg_per_h\"\nmin = 0.0\n\
                [[filter]]\nname = \"rls\"\n[filter.rls]\ninitial_inverse_correlation = 1e6\n";
    let file = write(folder.path(), "in/a.toml", text);
    write(folder.path(), "base/b.toml", "fidelity = \"rate\"\n");
    let (top, inside) = (folder.path(), folder.path().join("in"));
    let absolute = file.to_string_lossy();
    let cases = [
        (top, "in/a.toml"),
        (top, "./base/../in/a.toml"),
        (top, "in"),
        (inside.as_path(), "a.toml"),
        (inside.as_path(), &absolute),
        (std::path::Path::new("/"), &absolute),
    ];
    let mut results = Vec::new();
    for (index, (start, path)) in cases.into_iter().enumerate() {
        let target = top.join(format!("out{index}"));
        let output = fogbench(start, &["run", path, "-o", &target.to_string_lossy()]);
        assert_eq!(code(&output), 0, "{path}: {}", stderr(&output));
        results.push(tree(&target));
    }
    let manifest = top.join("out0/a/manifest.toml");
    let target = top.join("again");
    let arguments = [
        "run",
        &manifest.to_string_lossy(),
        "-o",
        &target.to_string_lossy(),
    ];
    assert_eq!(code(&fogbench(top, &arguments)), 0);
    results.push(tree(&target));
    for (index, result) in results.iter().enumerate() {
        assert_eq!(results[0].len(), result.len());
        for ((path, first), (other, bytes)) in results[0].iter().zip(result) {
            assert_eq!(path, other);
            assert!(first == bytes, "case {index}: {} differs", path.display());
        }
    }
    let summary = crate::support::summary(&top.join("out0"), "a");
    assert_eq!(summary["gates"][0]["location"], "a.toml:7:1");
    assert!(summary["notes"].is_array(), "the case has a warning too");
}
