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

/// Printed noise and that of two seeds over the root of two, of every channel.
fn printed_and_of_two_seeds(folder: &Path, name: &str, motion: &str) -> Vec<(String, f64, f64)> {
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
    ["raw", "mean", "pole"]
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
            let printed = field(&result, &format!("{channel}.noise_std_deg_per_h"), "value");
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
        for (channel, printed, wanted) in printed_and_of_two_seeds(folder.path(), name, &motion) {
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
