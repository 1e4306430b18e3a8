//! Noise of channels in motion: what two seeds differ by, whatever the table does.

use std::path::Path;

use crate::support::{
    assert_close, code, field, fogbench, npy, repository, stderr, summary, write,
};

/// Filters of given weights, on a gyro with little noise of its own.
const CHANNELS: &str = r#"
[gyro.noise]
thermal = false
shot = false
rin = false
[gyro.adc]
bits = 0
[gyro.output]
average_samples = 4
rate_lsb_deg_per_s = 1e-6
[output]
samples = "npy"
[[filter]]
name = "mean"
[filter.moving_average]
taps = 8
[[filter]]
name = "pole"
[filter.one_pole]
cutoff_hz = 20.0
"#;

/// A table of mass and friction.
const DIRECT_DRIVE: &str = "[turntable.servo.direct_drive]\n";

/// Filters that adapt within a tenth of the record.
const ADAPTIVE: &str = r#"
[[filter]]
name = "rls"
[filter.rls]
forgetting_factor = 0.98
[[filter]]
name = "lms"
[filter.lms]
"#;

/// A metric of channels as printed, and the noise of two seeds over the root of two.
fn printed_and_of_two_seeds(
    folder: &Path,
    (name, motion): (&str, &str),
    channels: &[&str],
    metric: &str,
) -> Vec<(String, f64, f64)> {
    let base = repository("scenarios/base/fog70.toml");
    let text = format!(
        "schema = 1\nname = \"{name}\"\ndescription = \"Noise in motion.\"\nextends = {base:?}\n\
         duration_s = 10.0\nwarm_up_s = 2.0\nfidelity = \"rate\"\n{motion}\n{CHANNELS}"
    );
    write(folder, &format!("{name}.toml"), &text);
    for seed in ["1", "2"] {
        let set = format!("seed={seed}");
        let file = format!("{name}.toml");
        let out = format!("out{seed}");
        let run = fogbench(folder, &["run", &file, "-o", &out, "--set", &set]);
        assert_eq!(code(&run), 0, "{}", stderr(&run));
    }
    let result = summary(&folder.join("out1"), name);
    channels
        .iter()
        .map(|channel| {
            let words =
                |seed: u32| npy(&folder.join(format!("out{seed}/{name}/samples/{channel}.npy")));
            let (one, two) = (words(1), words(2));
            // Of steps the last quarter after the last of them counts.
            let tail_percent = if name == "steps" { 125 } else { 1000 };
            let first = one.len() - one.len() * tail_percent / 1200;
            let differences: Vec<f64> = one[first..]
                .iter()
                .zip(&two[first..])
                .map(|(one, two)| one - two)
                .collect();
            let count = differences.len() as f64;
            let mean = differences.iter().sum::<f64>() / count;
            let square: f64 = differences.iter().map(|it| (it - mean).powi(2)).sum();
            let printed = field(&result, &format!("{channel}.{metric}"), "value");
            (
                (*channel).to_owned(),
                printed,
                (0.5 * square / count).sqrt(),
            )
        })
        .collect()
}

#[test]
fn motion_of_the_table_never_counts_as_noise() {
    let folder = tempfile::tempdir().unwrap();
    let swing = "[turntable.swing]\nrate_amplitude_deg_per_s = 10.0\nfrequency_hz = 2.0\n";
    let multi = "[turntable.multi_sine]\nfrequencies_hz = [1.0, 3.0, 11.0]\n\
                 rate_amplitudes_deg_per_s = [5.0]\n";
    let lagging =
        "[turntable.servo.second_order]\nnatural_frequency_hz = 40.0\ndamping_ratio = 0.7\n";
    let rotation = "[turntable.rotation]\nrate_deg_per_s = 5.0\n";
    let steps = "[turntable.steps]\nrates_deg_per_s = [1.0, 10.0]\ndwell_s = 5.0\n";
    for (name, motion) in [
        ("swing", format!("{swing}{DIRECT_DRIVE}")),
        ("lagging", format!("{swing}{lagging}")),
        ("multi", format!("{multi}{DIRECT_DRIVE}")),
        ("rotation", format!("{rotation}{DIRECT_DRIVE}")),
        ("steps", format!("{steps}{DIRECT_DRIVE}")),
    ] {
        let channels = ["raw", "mean", "pole"];
        let found = printed_and_of_two_seeds(
            folder.path(),
            (name, &motion),
            &channels,
            "noise_std_deg_per_h",
        );
        for (channel, printed, wanted) in found {
            // 10 s of 997 Hz, of the pole 600 independent samples: 3 %.
            let tolerance = match (channel.as_str(), name) {
                ("pole", "steps") => 0.35,
                ("pole", _) | (_, "steps") => 0.12,
                _ => 0.04,
            };
            println!("{name} {channel} {printed} {wanted}");
            assert_close(printed, wanted, tolerance, 0.0);
        }
    }
}

#[test]
fn two_runs_of_an_adaptive_filter_differ_as_two_seeds_do_and_the_parts_are_told_apart() {
    let folder = tempfile::tempdir().unwrap();
    let swing = "[turntable.swing]\nrate_amplitude_deg_per_s = 10.0\nfrequency_hz = 2.0\n";
    let motion = format!("{swing}{ADAPTIVE}");
    let metric = "two_run_noise_std_deg_per_h";
    let found =
        printed_and_of_two_seeds(folder.path(), ("swing", &motion), &["rls", "lms"], metric);
    let result = summary(&folder.path().join("out1"), "swing");
    for (channel, printed, wanted) in found {
        println!("{channel} {printed} {wanted}");
        assert_close(printed, wanted, 0.1, 0.0);
        let part = |name: &str| field(&result, &format!("{channel}.{metric}"), name);
        let through = part("noise_through_weights_deg_per_h");
        let of_weights = part("weight_noise_times_motion_deg_per_h");
        println!("{channel} {through} {of_weights}");
        // The parts go together or against each other, by no more than their sizes.
        assert!(printed <= through + of_weights, "{channel}");
        assert!(printed >= (through - of_weights).abs(), "{channel}");
    }
}
