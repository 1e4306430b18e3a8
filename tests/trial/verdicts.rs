//! The trial of the filters: gain over rate, the noise-delay plane and the verdict in words.

use fogbench::scenario::load_suite;
use fogbench::signal::WeightRule;

use crate::support::{
    assert_close, code, field, fogbench, repository, stderr, stdout, summary, write,
};

const SCENARIO: &str = r#"
schema = 1
name = "gains"
duration_s = 4.0
warm_up_s = 4.0
fidelity = "rate"
trial = { rate_gain = true }
filter = [
    { name = "rls", rls = { pipeline = "textbook" } },
    { name = "mean", moving_average = {} },
]
"#;

fn column(result: &serde_json::Value, channel: &str, name: &str) -> Vec<f64> {
    let values = &result["channels"][channel]["curves"]["rate_gain"][name];
    let values = values.as_array().expect("a column");
    let numbers = values.iter().map(|value| value.as_f64().expect("a number"));
    numbers.collect()
}

#[test]
fn small_rates_are_attenuated_by_what_learns_from_them_and_by_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let path = write(folder.path(), "gains.toml", SCENARIO);
    let run = fogbench(folder.path(), &["run", path.to_str().unwrap(), "-o", "out"]);
    assert_eq!(code(&run), 0, "{}{}", stdout(&run), stderr(&run));
    let output = folder.path().join("out");
    let result = summary(&output, "gains");
    let rates = column(&result, "rls", "rate_deg_per_s");
    assert_eq!((rates.len(), rates[0], rates[10]), (11, 0.001, 100.0));
    // A mean of rounded words passes every rate, to their rounding.
    for name in ["gain", "mean_ratio"] {
        for (value, rate) in column(&result, "mean", name).iter().zip(&rates) {
            // Its first samples in a block are the last of the one before: the noise of a few words.
            let tolerance = if name == "gain" { 1e-9 } else { 0.01 };
            assert!((value - 1.0).abs() < tolerance, "{name} {rate} {value}");
        }
    }
    let ratios = column(&result, "rls", "mean_ratio");
    assert!(ratios[..4].is_sorted(), "{ratios:?}");
    // Four Wiener weights of noise about a mean of m have the sum 4 m^2 / (4 m^2 + s), where s lies
    // between once and twice the variance of one sample, some 19 deg/h, as neighbours correlate by
    // less than one half. The rate comes on top of Earth's 8.47 deg/h.
    let sum = |rate_deg_per_s: f64, s: f64| {
        let mean = 8.47 + 3600.0 * rate_deg_per_s;
        4.0 * mean * mean / (4.0 * mean * mean + s)
    };
    for (ratio, rate) in ratios.iter().zip(&rates) {
        // The words that a block of 1596 begins and ends with enter input and output differently:
        // some five words of 19 deg/h at either end.
        let ends = 0.1 / (8.47 + 3600.0 * rate);
        let low = sum(*rate, 2.2 * 19.0 * 19.0) - ends;
        let high = sum(*rate, 0.8 * 19.0 * 19.0) + ends;
        assert!((low..=high).contains(ratio), "{rate}: {ratio} {low} {high}");
    }
    // Both figures of one twin tell the same: response = total output less what was there before.
    let mean_output = field(&result, "rls.mean_deg_per_h", "value");
    let mean_input = field(&result, "raw.mean_deg_per_h", "value");
    for (index, gain) in column(&result, "rls", "gain").iter().enumerate().skip(2) {
        let rate_deg_per_h = 3600.0 * rates[index];
        let total = gain * rate_deg_per_h + mean_output;
        let ratio = total / (mean_input + rate_deg_per_h);
        assert_close(ratio, ratios[index], 1e-3, 0.0);
    }
    let (low, high) = (
        column(&result, "rls", "mean_ratio_low"),
        column(&result, "rls", "mean_ratio_high"),
    );
    assert!(low.iter().zip(&high).all(|(low, high)| low < high));
    for picture in ["rate-gain.svg", "noise-delay.svg"] {
        assert!(output.join("gains").join(picture).exists(), "{picture}");
    }
    // Nobody asked for the curve by default.
    let set = [
        "run",
        path.to_str().unwrap(),
        "-o",
        "plain",
        "--set",
        "trial.rate_gain=false",
    ];
    assert_eq!(code(&fogbench(folder.path(), &set)), 0);
    let plain = folder.path().join("plain");
    assert!(!plain.join("gains/rate-gain.svg").exists());
    assert!(summary(&plain, "gains")["channels"]["rls"]["curves"]["rate_gain"].is_null());
}

#[test]
fn the_verdict_on_every_filter_stands_in_text_and_summary() {
    let folder = tempfile::tempdir().unwrap();
    let path = repository("scenarios/audit/trial.toml");
    let arguments = [
        "run",
        path.to_str().unwrap(),
        "-o",
        "out",
        "--set",
        "trial.rate_gain=false",
    ];
    let run = fogbench(folder.path(), &arguments);
    assert_eq!(code(&run), 0, "{}{}", stdout(&run), stderr(&run));
    let result = summary(&folder.path().join("out"), "trial");
    let verdict = |channel: &str| {
        let verdict = &result["channels"][channel]["verdict"];
        verdict.as_str().expect("a filter has a verdict").to_owned()
    };
    assert!(result["channels"]["raw"]["verdict"].is_null());
    let rls = verdict("rls");
    assert!(rls.contains("by attenuating the input"), "{rls}");
    assert!(rls.contains("at restored scale"), "{rls}");
    let scenario = &load_suite(&[path], &[]).expect("a scenario")[0].scenario;
    // No filter whose weights are given learns the rate away.
    let given = scenario.filters.iter().filter(|filter| {
        let built = filter.kind.settings().build(1e-4);
        let shape = built.expect("a filter of the bench").shape();
        !matches!(shape.rule, WeightRule::Adaptive { .. })
    });
    let given: Vec<&str> = given.map(|filter| filter.name.as_str()).collect();
    assert!(!given.is_empty());
    for honest in given {
        let said = verdict(honest);
        assert!(
            said.starts_with("reduces fast noise by smoothing: DC gain 1"),
            "{said}"
        );
    }
    let text = stdout(&run);
    let words: Vec<&str> = text.split_whitespace().collect();
    let first: Vec<&str> = rls.split_whitespace().collect();
    let stands = words.windows(first.len()).any(|window| window == first);
    assert!(stands, "{text}");
    // A mean is the best that its taps can do for white noise; the loop's colour leaves it near.
    let over = field(&result, "moving-average.noise_gain_over_bound", "low");
    assert!((0.999..1.2).contains(&over), "{over}");
}

#[test]
fn least_squares_that_forget_nothing_keep_the_gain_they_learned_at_rest() {
    let folder = tempfile::tempdir().unwrap();
    let path = repository("scenarios/audit/static-then-rate.toml");
    let run = fogbench(folder.path(), &["run", path.to_str().unwrap(), "-o", "out"]);
    assert_eq!(code(&run), 0, "{}{}", stdout(&run), stderr(&run));
    let result = summary(&folder.path().join("out"), "static-then-rate");
    let ratio = |channel: &str| field(&result, &format!("{channel}.mean_ratio"), "value");
    assert!(ratio("remembering") < 0.7 * ratio("forgetting"));
}
