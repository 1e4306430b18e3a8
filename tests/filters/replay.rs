//! Words that were computed elsewhere, beside the run whose samples they are of.

use std::path::Path;
use std::process::Output;

use serde_json::Value;

use crate::support::transcript::Transcript;
use crate::support::{code, fogbench, npy, stderr, stdout, summary, write};

/// A rest of 3 s with a mean of eight and a pipeline, whose samples are written.
const SOURCE: &str = r#"
schema = 1
name = "source"
duration_s = 2.5
warm_up_s = 0.5
fidelity = "rate"
[[filter]]
name = "mean"
[filter.moving_average]
taps = 8
[[filter]]
name = "rls"
[filter.rls]
pipeline = "fpga"
[output]
samples = "npy"
"#;

fn scratch() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(folder.path(), "source.toml", SOURCE);
    let output = fogbench(folder.path(), &["run", "source.toml", "-o", "out"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    folder
}

/// The digest that stands in a file beside samples.
fn digest(file: &Path) -> String {
    let text = std::fs::read_to_string(file).expect("written beside the samples");
    let line = text.lines().last().expect("a line");
    let digest = line.strip_prefix("input_digest = ").expect("the key");
    digest.trim_matches('"').to_owned()
}

/// The scenario again, with its words replayed beside it.
fn replay(folder: &Path, samples: &str, digest: &str, register: &str) -> Output {
    let filter = format!(
        "[[filter]]\nname = \"yours\"\n[filter.replay]\nsamples = \"{samples}\"\n\
         input_digest = \"{digest}\"\noutput_register = \"{register}\"\n"
    );
    let text = SOURCE.replace("\"source\"", "\"replay\"");
    write(folder, "replay.toml", &format!("{text}{filter}"));
    fogbench(folder, &["run", "replay.toml", "-o", "out"])
}

/// Metrics of a channel that follow from its words alone, but for their intervals.
fn measured<'a>(run: &'a Value, channel: &str) -> Vec<(&'a String, &'a Value)> {
    let metrics = run["channels"][channel]["metrics"].as_object();
    let metrics = metrics.expect("metrics").iter();
    metrics
        .map(|(key, metric)| (key, &metric["value"]))
        .collect()
}

#[test]
fn words_of_a_run_replayed_are_measured_as_where_they_were_made() {
    let folder = scratch();
    let samples = folder.path().join("out/source/samples");
    let digest = digest(&samples.join("input_digest.toml"));
    let output = replay(
        folder.path(),
        "out/source/samples/mean.npy",
        &digest,
        "immediate",
    );
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    let out = folder.path().join("out");
    assert_eq!(
        npy(&out.join("replay/samples/yours.npy")),
        npy(&samples.join("mean.npy"))
    );
    let run = summary(&out, "replay");
    let (own, yours) = (measured(&run, "mean"), measured(&run, "yours"));
    assert!(yours.len() >= 8, "{yours:?}");
    for metric in &yours {
        assert!(own.contains(metric), "{metric:?} is not that of the mean");
    }
    let lacking = own
        .iter()
        .filter(|(key, _)| yours.iter().all(|(found, _)| found != key));
    let unavailable = &run["channels"]["yours"]["unavailable"];
    for (key, _) in lacking {
        let reason = unavailable[key.as_str()].as_str().expect("a reason");
        assert!(
            reason.contains("computed elsewhere") || reason.contains("DC gain"),
            "{key}: {reason}"
        );
    }
    assert!(
        unavailable["dc_gain"]
            .as_str()
            .expect("a reason")
            .contains("run again")
    );
}

#[test]
fn the_words_of_an_export_are_those_of_the_pipeline_behind_its_register() {
    let folder = scratch();
    let count = npy(&folder.path().join("out/source/samples/raw.npy"))
        .len()
        .to_string();
    let export = [
        "export",
        "vectors",
        "y",
        "--scenario",
        "source.toml",
        "--filter",
        "rls",
        "--samples",
        &count,
    ];
    let output = fogbench(folder.path(), &export);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let beside = digest(&folder.path().join("y/input_digest.toml"));
    let of_run = digest(&folder.path().join("out/source/samples/input_digest.toml"));
    assert_eq!(beside, of_run);
    let output = replay(folder.path(), "y/y.hex", &beside, "next-sample");
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    let samples = folder.path().join("out/replay/samples");
    assert_eq!(
        npy(&samples.join("yours.npy")),
        npy(&samples.join("rls.npy"))
    );
}

#[test]
fn words_of_other_samples_are_refused_with_both_digests() {
    let folder = scratch();
    let own = digest(&folder.path().join("out/source/samples/input_digest.toml"));
    let other = "0".repeat(64);
    let output = replay(
        folder.path(),
        "out/source/samples/mean.npy",
        &other,
        "immediate",
    );
    assert_eq!(code(&output), 3, "{}{}", stdout(&output), stderr(&output));
    let run = summary(&folder.path().join("out"), "replay");
    let error = &run["channels"]["yours"]["error"];
    assert_eq!(error["kind"], "other input");
    let message = error["message"].as_str().expect("a message");
    assert!(
        message.contains(&own) && message.contains(&other),
        "{message}"
    );
    // The channels beside it are measured.
    assert!(run["channels"]["mean"]["dc_gain"]["value"].is_number());
}

#[test]
fn what_no_words_can_be_read_from_is_refused_before_the_run() {
    let folder = scratch();
    let digest = digest(&folder.path().join("out/source/samples/input_digest.toml"));
    write(folder.path(), "short.hex", "3ff8000000000000\n");
    write(folder.path(), "odd.hex", "3ff8000000000000\n1.5\n");
    let mut transcript = Transcript::of("replay", "refused");
    let words = "out/source/samples/mean.npy";
    for (samples, digest, register, more) in [
        ("nowhere.npy", digest.as_str(), "immediate", ""),
        ("short.hex", &digest, "immediate", ""),
        ("odd.hex", &digest, "immediate", ""),
        ("source.toml", &digest, "immediate", ""),
        (words, "beef", "immediate", ""),
        (words, &digest, "later", ""),
        (words, &digest, "immediate", "repeats=2"),
        (words, &digest, "immediate", "trial.filter_state=reset"),
    ] {
        let filter = format!(
            "samples = \"{samples}\"\ninput_digest = \"{digest}\"\noutput_register = \"{register}\"\n"
        );
        let text = SOURCE.replace("samples = \"npy\"", "");
        let text = format!("{text}[[filter]]\nname = \"yours\"\n[filter.replay]\n{filter}");
        write(folder.path(), "replay.toml", &text);
        let mut arguments = vec!["check", "replay.toml"];
        if !more.is_empty() {
            arguments.extend(["--set", more]);
        }
        let output = fogbench(folder.path(), &arguments);
        assert_eq!(code(&output), 2, "{filter}");
        let given = filter.replace(digest.get(8..).unwrap_or("-"), "...");
        transcript.case(format!("{given}{more}"), stderr(&output));
    }
    transcript.check();
}

#[test]
fn a_manifest_names_its_words_and_refuses_others() {
    let folder = scratch();
    let samples = folder.path().join("out/source/samples");
    let digest = digest(&samples.join("input_digest.toml"));
    for name in ["mean", "rls"] {
        let words = std::fs::read(samples.join(format!("{name}.npy"))).expect("written");
        std::fs::write(folder.path().join(format!("{name}.npy")), words).expect("writable");
    }
    let output = replay(folder.path(), "./mean.npy", &digest, "immediate");
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let again = |words: &str| {
        std::fs::copy(
            folder.path().join(words),
            folder.path().join("again/mean.npy"),
        )
        .expect("copied");
        fogbench(folder.path(), &["run", "again/manifest.toml", "-o", "more"])
    };
    std::fs::create_dir(folder.path().join("again")).expect("writable");
    let manifest = folder.path().join("out/replay/manifest.toml");
    std::fs::copy(manifest, folder.path().join("again/manifest.toml")).expect("copied");
    let output = again("mean.npy");
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let read = |out: &str| std::fs::read(folder.path().join(out).join("replay/summary.json"));
    assert_eq!(
        read("more").expect("written"),
        read("out").expect("written")
    );
    let output = again("rls.npy");
    assert_eq!(code(&output), 2);
    let said = stderr(&output);
    assert!(
        said.contains("not the file that the manifest was made from"),
        "{said}"
    );
}
