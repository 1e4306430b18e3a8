//! `analyze --kalman`: the noise of a log as a linear system, which has the log's Allan variance.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::support::{code, fogbench, stderr, write};
use fogbench::random::Streams;

const RATE_HZ: f64 = 10.0;

/// How the words of a log came about.
#[derive(Clone, Copy, Debug)]
enum Words {
    /// Behind a pole that remembers half of the word before.
    Pole,
    /// Of an angle that is rounded.
    Rounded(f64),
    /// Means of so many.
    Mean(usize),
    /// Behind a pole of so many words.
    LongPole(f64),
}

/// An hour and more of white noise and a walk, with the angle rounded or the words smoothed.
fn log(folder: &Path, words: Words) {
    let mut random = Streams::new(7, 0).stream("log");
    let (mut bias, mut angle, mut before) = (0.0, 0.0_f64, 0.0_f64);
    let mut smooth = 0.0;
    let (mut drives, mut sum) = (std::collections::VecDeque::new(), 0.0);
    let mut text = String::new();
    for _ in 0..60_000 {
        bias += 0.01 * random.normal();
        let decay = match words {
            Words::LongPole(time) => f64::exp(-1.0 / time),
            _ => 0.5,
        };
        let drive = 3.0 * random.normal();
        smooth += (1.0 - decay) * (drive - smooth);
        let word = if let Words::Mean(count) = words {
            drives.push_back(drive);
            sum += drive;
            if drives.len() > count {
                sum -= drives.pop_front().expect("one more than the mean");
            }
            sum / count as f64 + bias
        } else if let Words::Rounded(step) = words {
            // An arcsecond in a second is a degree in an hour.
            angle += (0.2 * random.normal() + bias) / RATE_HZ;
            let rounded = (angle / step).round() * step;
            let word = (rounded - before) * RATE_HZ;
            before = rounded;
            // A little noise behind it: what counts pulses is another matter.
            word + 1e-3 * random.normal()
        } else {
            smooth + bias
        };
        text.push_str(&format!("{word}\n"));
    }
    write(folder, "log.csv", &text);
}

/// Words in an averaging time.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a small positive whole number"
)]
fn words_in(tau_s: f64) -> usize {
    (tau_s * RATE_HZ).round() as usize
}

fn analyze(folder: &Path, more: &[&str]) -> std::process::Output {
    let rate_hz = RATE_HZ.to_string();
    let mut arguments = vec![
        "analyze",
        "log.csv",
        "--rate-hz",
        &rate_hz,
        "--unit",
        "deg/h",
    ];
    arguments.extend(more);
    fogbench(folder, &arguments)
}

fn numbers(value: &Value) -> Vec<f64> {
    let items = value.as_array().expect("an array");
    items
        .iter()
        .map(|it| it.as_f64().expect("a number"))
        .collect()
}

/// The system as somebody would read it who has the file alone.
struct System {
    transition: Vec<Vec<f64>>,
    noise: Vec<Vec<f64>>,
    initial: Vec<Vec<f64>>,
    observation: Vec<f64>,
    cross: Vec<f64>,
    measurement: f64,
}

impl System {
    fn read(document: &Value) -> Self {
        let matrix = |name: &str| -> Vec<Vec<f64>> {
            document[name]
                .as_array()
                .expect("rows")
                .iter()
                .map(numbers)
                .collect()
        };
        Self {
            transition: matrix("F"),
            noise: matrix("Q_d"),
            initial: matrix("P0"),
            observation: numbers(&document["H"]),
            cross: numbers(&document["S"]),
            measurement: document["R"].as_f64().expect("R"),
        }
    }

    /// Allan deviation of m words each by the second moments of state and angle.
    fn allan_deviation(&self, m: usize) -> f64 {
        let n = self.observation.len();
        let mut of_state = self.initial.clone();
        let mut with_sum = vec![0.0; n];
        let mut of_sum = 0.0;
        for word in 0..2 * m {
            let sign = if word < m { -1.0 } else { 1.0 };
            let product = |row: &[f64], column: &dyn Fn(usize) -> f64| -> f64 {
                row.iter()
                    .enumerate()
                    .map(|(k, value)| value * column(k))
                    .sum()
            };
            let seen: Vec<f64> = of_state
                .iter()
                .map(|row| product(row, &|k| self.observation[k]))
                .collect();
            let along = |vector: &[f64]| product(&self.observation, &|k| vector[k]);
            of_sum += 2.0 * sign * along(&with_sum) + along(&seen) + self.measurement;
            let carried: Vec<f64> = (0..n).map(|k| with_sum[k] + sign * seen[k]).collect();
            with_sum = (0..n)
                .map(|row| product(&self.transition[row], &|k| carried[k]) + sign * self.cross[row])
                .collect();
            let halfway: Vec<Vec<f64>> = (0..n)
                .map(|row| {
                    (0..n)
                        .map(|column| product(&self.transition[row], &|k| of_state[k][column]))
                        .collect()
                })
                .collect();
            of_state = (0..n)
                .map(|row| {
                    (0..n)
                        .map(|column| {
                            product(&self.transition[column], &|k| halfway[row][k])
                                + self.noise[row][column]
                        })
                        .collect()
                })
                .collect();
        }
        (of_sum / (2.0 * (m * m) as f64)).sqrt()
    }
}

fn model(folder: &Path, more: &[&str]) -> Value {
    let arguments = [&["--kalman", "noise.json", "-o", "out"][..], more].concat();
    let output = analyze(folder, &arguments);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let text = fs::read_to_string(folder.join("noise.json")).expect("the model");
    serde_json::from_str(&text).expect("JSON")
}

#[test]
fn a_log_comes_back_from_its_system() {
    for (words, state) in [
        (Words::Pole, "angle_random_walk"),
        (Words::Rounded(0.1), "quantisation"),
        // One pole of the fit's own is twice the Allan deviation of a mean of eight at two words.
        (Words::Mean(8), "smoothing_7"),
        (Words::LongPole(5.0), "smoothing_9"),
    ] {
        let folder = tempfile::tempdir().expect("a scratch folder");
        log(folder.path(), words);
        let document = model(folder.path(), &[]);
        let states = document["states"].as_array().expect("states");
        let names: Vec<&str> = states.iter().filter_map(|it| it["name"].as_str()).collect();
        assert!(
            names.contains(&state) && names.contains(&"bias"),
            "{names:?}"
        );
        assert_eq!(document["F"].as_array().expect("rows").len(), names.len());
        let longest = document["tau_max_s"].as_f64().expect("a time");
        assert!(
            (longest - 0.1 * 60_000.0 / RATE_HZ).abs() < 1.0,
            "{longest}"
        );
        let system = System::read(&document);
        let fit: Value = serde_json::from_str(
            &fs::read_to_string(folder.path().join("out/summary.json")).expect("a summary"),
        )
        .expect("JSON");
        let curve = &fit["channels"]["raw"]["curves"]["allan_fit"];
        let (tau, deviation) = (
            numbers(&curve["tau_s"]),
            numbers(&curve["deviation_deg_per_h"]),
        );
        let mut compared = 0;
        for (tau_s, measured) in tau.iter().zip(deviation) {
            let m = words_in(*tau_s);
            if !(2..=1000).contains(&m) || *tau_s > longest {
                continue;
            }
            let got = system.allan_deviation(m);
            // Three standard errors of the curve: 1.5 T/tau degrees of freedom and more.
            let tolerance = 0.03 + 3.0 * (m as f64 / 180_000.0).sqrt();
            assert!(
                (got / measured - 1.0).abs() < tolerance,
                "{state} {tau_s}: {got} {measured}"
            );
            compared += 1;
        }
        assert!(compared > 15, "{compared}");
        for point in document["allan_deviation"].as_array().expect("a curve") {
            let tau_s = point["tau_s"].as_f64().expect("a time");
            let m = words_in(tau_s);
            if m <= 1000 {
                let stated = point["deviation_deg_per_h"].as_f64().expect("a deviation");
                let got = system.allan_deviation(m);
                assert!((got / stated - 1.0).abs() < 0.03, "{tau_s}: {got} {stated}");
            }
        }
    }
}

#[test]
fn the_range_of_a_system_is_that_in_which_it_is_the_words() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    log(folder.path(), Words::Mean(50));
    let document = model(folder.path(), &[]);
    let number = |value: &Value| value.as_f64().expect("a number");
    let shortest = number(&document["tau_min_s"]);
    assert!((0.3..25.0).contains(&shortest), "{shortest}");
    let curve = document["allan_deviation"].as_array().expect("a curve");
    assert!((number(&curve[0]["tau_s"]) - shortest).abs() < 1e-9);
    log(folder.path(), Words::Mean(8));
    let document = model(folder.path(), &[]);
    let shortest = number(&document["tau_min_s"]);
    assert!((shortest - 2.0 / RATE_HZ).abs() < 1e-9, "{shortest}");
}

#[test]
fn outliers_are_left_out_and_shorten_nothing() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    log(folder.path(), Words::Pole);
    let clean = model(folder.path(), &[]);
    let text = fs::read_to_string(folder.path().join("log.csv")).expect("the log");
    let mut words: Vec<&str> = text.lines().collect();
    (words[20_000], words[41_000]) = ("4000.0", "-6000.0");
    write(folder.path(), "log.csv", &(words.join("\n") + "\n"));
    let spoiled = model(folder.path(), &[]);
    for key in ["R", "tau_max_s"] {
        let [wanted, got] = [&clean, &spoiled].map(|it| it[key].as_f64().expect("a number"));
        assert!((got / wanted - 1.0).abs() < 0.02, "{key}: {got} {wanted}");
    }
}

#[test]
fn a_file_of_the_user_stays() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    log(folder.path(), Words::Pole);
    write(folder.path(), "noise.json", "{\"mine\": true}\n");
    let refused = analyze(folder.path(), &["--kalman", "noise.json"]);
    assert_eq!(code(&refused), 2);
    assert!(stderr(&refused).contains("noise.json was not written by fogbench"));
    let kept = fs::read_to_string(folder.path().join("noise.json")).expect("the file");
    assert_eq!(kept, "{\"mine\": true}\n");
    assert_eq!(
        code(&analyze(folder.path(), &["--kalman", "log.csv", "--force"])),
        2
    );
    assert_eq!(
        code(&analyze(
            folder.path(),
            &["--kalman", "noise.json", "--force"]
        )),
        0
    );
    // What was written before is replaced without a word.
    assert_eq!(
        code(&analyze(folder.path(), &["--kalman", "noise.json"])),
        0
    );
}

#[test]
fn a_record_without_a_fit_has_no_system() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(folder.path(), "log.csv", "1\n2\n1\n3\n2\n1\n4\n2\n3\n1\n");
    let output = analyze(folder.path(), &["--kalman", "noise.json"]);
    assert_eq!(code(&output), 3, "{}", stderr(&output));
    assert!(
        stderr(&output).contains("no --kalman noise.json: "),
        "{}",
        stderr(&output)
    );
    assert!(!folder.path().join("noise.json").exists());
}
