//! Output samples that are means of rate words (`gyro.output.average_samples`).

use std::path::Path;

use crate::support::{assert_close, code, field, fogbench, npy, stderr, summary, write};

const AVERAGE: usize = 40;

/// Runs a scenario whose output averages `average` words, and returns its summary.
fn run(folder: &Path, name: &str, average: usize, rest: &str) -> serde_json::Value {
    let text = format!(
        "schema = 1\nname = \"{name}\"\nfidelity = \"rate\"\nduration_s = 2.0\n{rest}\
         [gyro.output]\naverage_samples = {average}\n[output]\nsamples = \"npy\"\n"
    );
    write(folder, &format!("{name}.toml"), &text);
    let output = fogbench(folder, &["run", &format!("{name}.toml"), "-o", "out"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    summary(&folder.join("out"), name)
}

fn samples(folder: &Path, name: &str, channel: &str) -> Vec<f64> {
    npy(&folder.join(format!("out/{name}/samples/{channel}.npy")))
}

#[test]
fn a_sample_is_the_mean_of_its_words_and_truth_the_rate_at_its_end() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let folder = folder.path();
    let swing = "[turntable.swing]\nrate_amplitude_deg_per_s = 1.0\nfrequency_hz = 4.0\n\
                 soft_start_s = 0.0\n";
    let assembly = "[turntable.rotation]\nrate_deg_per_s = 7.0\nsoft_start_s = 0.0\n\
                    [gyro.assembly]\nbias_deg_per_h = [1.0, 2.0, 3.0]\n";
    for (case, rest, raw, truth) in [
        ("swing", swing, "raw", "truth"),
        ("case", assembly, "y_raw", "y_truth"),
    ] {
        let rest = format!("warm_up_s = 0.0\n{rest}");
        let (words_name, means_name) = (format!("{case}-words"), format!("{case}-means"));
        run(folder, &words_name, 1, &rest);
        run(folder, &means_name, AVERAGE, &rest);
        let words = samples(folder, &words_name, raw);
        let means = samples(folder, &means_name, raw);
        assert_eq!(means.len(), words.len() / AVERAGE);
        for (sample, of) in means.iter().zip(words.chunks_exact(AVERAGE)) {
            let mean = of.iter().sum::<f64>() / AVERAGE as f64;
            assert_close(*sample, mean, 1e-12, 1e-12);
        }
        let rates = samples(folder, &words_name, truth);
        let ends = samples(folder, &means_name, truth);
        for (end, of) in ends.iter().zip(rates.chunks_exact(AVERAGE)) {
            assert_eq!(end.to_bits(), of[AVERAGE - 1].to_bits());
        }
    }
}

#[test]
fn the_output_rate_and_the_delay_of_the_mean_are_reported() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let swing = "warm_up_s = 1.3\n[turntable.swing]\nrate_amplitude_deg_per_s = 10.0\n\
                 frequency_hz = 2.0\n";
    let of = |name: &str, average: usize| run(folder.path(), name, average, swing);
    let (words, means) = (of("words", 1), of("means", AVERAGE));
    let gyro = |summary: &serde_json::Value, key: &str| {
        summary["gyro"][key].as_f64().expect("a number of the gyro")
    };
    let rate_hz = gyro(&words, "output_rate_hz");
    assert_close(
        gyro(&means, "output_rate_hz"),
        rate_hz / AVERAGE as f64,
        1e-12,
        0.0,
    );
    // The mean of n words stamped at the end of the last is (n - 1) / 2 words late.
    let later_ms = 1e3 * 0.5 * (AVERAGE as f64 - 1.0) / rate_hz;
    let delay = |summary| field(summary, "raw.delay_vs_truth_ms", "value");
    assert_close(delay(&means) - delay(&words), later_ms, 0.0, 0.01);
    assert_close(gyro(&means, "delay_ms"), delay(&means), 0.0, 0.02);
}

#[test]
fn samples_that_see_two_rates_of_a_staircase_belong_to_neither_dwell() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    // The settling is far shorter than a sample; without noise nothing else can hide the steps.
    let silent = "warm_up_s = 0.7\n[turntable.steps]\n\
                  rates_deg_per_s = [-10.0, 0.0, 5.0, 10.0]\ndwell_s = 0.4567\nsettle_s = 0.005\n\
                  [gyro.noise]\nshot = false\nthermal = false\namplifier = false\nrin = false\n\
                  [gyro.adc]\nbits = 0\n[gyro.modulator]\ndac_bits = 0\n";
    let summary = run(folder.path(), "stairs", AVERAGE, silent);
    let ppm = field(&summary, "raw.scale_factor_nonlinearity_ppm", "value");
    // Words without noise err by half their step, 5 ppm; a sample astray is 45 times less than a
    // dwell and off by thousands.
    assert!(
        ppm.abs() < 10.0,
        "a sample across a step spoils a dwell: {ppm} ppm"
    );
}
