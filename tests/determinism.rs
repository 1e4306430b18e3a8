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
