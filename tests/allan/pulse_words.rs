//! The noise fit of words that count pulses of angle, their remainder carried.

use std::path::Path;

use fogbench::metrics::catalogue::{ANGLE_RANDOM_WALK, QUANTISATION, RATE_RANDOM_WALK};
use fogbench::metrics::{
    AllanOptions, ChannelMetrics, Motion, Record, Settings, measure, record_fit_tau_min_s,
};
use fogbench::signal::Rates;
use rayon::prelude::*;
use serde_json::Value;

use crate::support::records::normals;
use crate::support::{code, fogbench, stderr, stdout, summary, write};

/// Angle random walk of all records, deg/sqrt(h), and in (deg/h) sqrt(s).
const WALK_DEG_PER_SQRT_H: f64 = 0.006;
const WALK: f64 = 60.0 * WALK_DEG_PER_SQRT_H;

/// Flicker of the records, deg/h.
const BIAS_INSTABILITY: f64 = 0.045;

/// Flicker, one value a second: Gauss-Markov noise of equal variance per octave of correlation time.
fn flicker(seed: u64, seconds: usize) -> Vec<f64> {
    let mut values = vec![0.0; seconds];
    // The density B^2/(2 pi f) is that of a variance B^2 ln 2/pi in every octave.
    let deviation = BIAS_INSTABILITY * (2.0_f64.ln() / std::f64::consts::PI).sqrt();
    for octave in 0..14 {
        let decay = (-0.5_f64.powi(octave + 1)).exp();
        let drives = normals(seed, &format!("flicker {octave}"), seconds + 1);
        let mut state = drives[0];
        for (value, drive) in values.iter_mut().zip(&drives[1..]) {
            *value += deviation * state;
            state = decay * state + (1.0 - decay * decay).sqrt() * drive;
        }
    }
    values
}

/// Words of a gyro of this mean rate, deg/h.
struct Words {
    rate_deg_per_h: f64,
    per_second: u32,
    seconds: usize,
}

impl Words {
    fn frequency_hz(&self) -> f64 {
        f64::from(self.per_second)
    }

    /// Mean rate over every word.
    fn rates(&self, seed: u64) -> Vec<f64> {
        let per_second = self.per_second as usize;
        let mut values = normals(seed, "walk", per_second * self.seconds);
        let slow = flicker(seed, self.seconds);
        for (second, slow) in values.chunks_mut(per_second).zip(slow) {
            for value in second {
                *value = self.rate_deg_per_h + slow + WALK * self.frequency_hz().sqrt() * *value;
            }
        }
        values
    }

    /// Pulses of this angle, counted with the remainder carried; the angle starts anywhere in one.
    fn counted(&self, seed: u64, step_arcsec: f64) -> Vec<f64> {
        let mut values = self.rates(seed);
        let start = 10.0 * normals(seed, "start", 1)[0];
        let mut left = step_arcsec * (start.rem_euclid(1.0) - 0.5);
        for value in &mut values {
            let angle = *value / self.frequency_hz() + left;
            let pulses = (angle / step_arcsec).round();
            left = angle - pulses * step_arcsec;
            *value = pulses * step_arcsec * self.frequency_hz();
        }
        values
    }

    fn measured(&self, values: &[f64]) -> ChannelMetrics {
        let record = Record {
            channel_deg_per_h: values,
            raw_deg_per_h: values,
            truth_deg_per_h: Rates::UNKNOWN,
            response_deg_per_h: &[],
            encoder_rad: None,
            drift: None,
            sample_period_s: 1.0 / self.frequency_hz(),
            first_stamp_s: 0.0,
        };
        let settings = Settings {
            motion: Motion::Steady,
            bias_averaging_time_s: 10.0,
            fit_tau_min_s: record_fit_tau_min_s(values, 1.0 / self.frequency_hz()),
            allan: AllanOptions::default(),
            bridges: Vec::new(),
        };
        measure(&record, &settings, None)
    }
}

/// Which answer the words give.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Answer {
    /// The curve of words or of means of them.
    Curve,
    /// The times between pulses.
    Times,
    /// None, or a limit alone.
    Limit,
}

/// The answer of a record, whose words are checked to name it and whose quantisation to be the true one;
/// none where the test of the fit rejects it, as it does with one record in a hundred and some more.
fn answer(metrics: &ChannelMetrics, step_arcsec: f64, point: &str) -> Option<Answer> {
    let words = |name: &str| metrics.pulse_words.get(name).map_or("", String::as_str);
    let told = words(ANGLE_RANDOM_WALK.name);
    let Ok(walk) = metrics.metric(&ANGLE_RANDOM_WALK) else {
        let reason = metrics.why_unavailable(&ANGLE_RANDOM_WALK);
        let reason = reason.expect("a reason");
        if reason == "the output does not vary over the record" {
            return Some(Answer::Limit);
        }
        if reason.contains("is not described by the noise terms") {
            return None;
        }
        assert!(
            reason.starts_with("not bounded: pulses of"),
            "{point}: {reason}"
        );
        let (_, most) = reason.split_once("it is ").expect("a limit");
        let most = most.split(' ').next().expect("a number");
        let most: f64 = most.parse().expect("a number");
        assert!(most > WALK_DEG_PER_SQRT_H, "{point}: {reason}");
        assert!(most < 40.0 * WALK_DEG_PER_SQRT_H, "{point}: {reason}");
        return Some(Answer::Limit);
    };
    assert!(walk.high < 3.0 * WALK_DEG_PER_SQRT_H, "{point}: {walk:?}");
    let quantisation = metrics.metric(&QUANTISATION).expect("a quantisation");
    let wanted = step_arcsec / 12.0_f64.sqrt();
    if told.is_empty() {
        // Dithered within a word by the noise: an ordinary quantisation.
        assert!(step_arcsec <= 0.2, "{point}: {quantisation:?}");
        assert!(
            quantisation.high > 0.8 * wanted,
            "{point}: {quantisation:?}"
        );
        return Some(Answer::Curve);
    }
    assert!(
        (quantisation.value / wanted - 1.0).abs() < 1e-6,
        "{point}: {quantisation:?}"
    );
    let told_step = words(QUANTISATION.name);
    assert!(
        told_step.starts_with(&format!("from the step of {step_arcsec} arcsec")),
        "{point}: {told_step}"
    );
    if told.starts_with("from the times between pulses") {
        Some(Answer::Times)
    } else {
        assert!(told.starts_with("from the curve of"), "{point}: {told}");
        Some(Answer::Curve)
    }
}

/// Records of every point of a table, all of which must give the named answer; their intervals together must
/// hold the true walk as often as they say, four standard errors of chance allowed.
fn check(words: &Words, steps: &[(f64, Answer)], seeds: std::ops::Range<u64>) {
    let records: Vec<(f64, Answer, u64)> = steps
        .iter()
        .flat_map(|&(step, wanted)| seeds.clone().map(move |seed| (step, wanted, seed)))
        .collect();
    let held: Vec<(bool, Option<bool>)> = records
        .par_iter()
        .map(|&(step, wanted, seed)| {
            let metrics = words.measured(&words.counted(seed, step));
            let point = format!(
                "{} Hz, {} deg/h, {step} arcsec, seed {seed}",
                words.per_second, words.rate_deg_per_h
            );
            let found = answer(&metrics, step, &point);
            assert!(found.is_none_or(|it| it == wanted), "{point}: {found:?}");
            let walk = metrics.metric(&ANGLE_RANDOM_WALK).ok();
            let holds = walk.map(|it| (it.low..=it.high).contains(&WALK_DEG_PER_SQRT_H));
            (found.is_none(), holds)
        })
        .collect();
    // Records of the same seed share their noise: the steps count as three.
    let allowed = |share: f64, count: f64| share * count + 4.0 * (3.0 * share * count).sqrt();
    let rejected = held.iter().filter(|(rejected, _)| *rejected).count() as f64;
    let count = held.len() as f64;
    assert!(
        rejected <= allowed(0.02, count),
        "{rejected} of {count} rejected"
    );
    let told: Vec<bool> = held.into_iter().filter_map(|(_, holds)| holds).collect();
    let missed = told.iter().filter(|held| !**held).count() as f64;
    let count = told.len() as f64;
    assert!(
        missed <= allowed(0.05, count),
        "{missed} of {count} intervals miss"
    );
}

use Answer::{Curve, Limit, Times};

#[test]
fn an_hour_at_10_hz_names_its_answer() {
    let mut words = Words {
        rate_deg_per_h: 8.47,
        per_second: 10,
        seconds: 3600,
    };
    let turning = [
        (0.02, Curve),
        (0.05, Curve),
        (0.1, Curve),
        (0.2, Curve),
        (0.5, Curve),
        (1.0, Curve),
        (2.0, Times),
        (5.0, Times),
        (10.0, Times),
        (20.0, Times),
    ];
    check(&words, &turning, 40..42);
    words.rate_deg_per_h = 0.0;
    // Pulses of 5 arcsec lie on the border: an hour just has the range in which they lose their phase.
    let at_rest = [
        (0.02, Curve),
        (0.05, Curve),
        (0.1, Curve),
        (0.2, Curve),
        (0.5, Curve),
        (1.0, Curve),
        (2.0, Curve),
        (3.0, Curve),
        (10.0, Limit),
        (20.0, Limit),
    ];
    check(&words, &at_rest, 50..52);
}

/// An hour just has the averaging times in which pulses of 5 arcsec at rest lose their phase: some records show
/// the walk, others a limit. None takes the pulses for noise.
#[test]
fn pulses_on_the_border_are_recognised_whatever_they_answer() {
    let words = Words {
        rate_deg_per_h: 0.0,
        per_second: 10,
        seconds: 3600,
    };
    let seeds: Vec<u64> = (100..140).collect();
    let found: Vec<(Option<Answer>, bool)> = seeds
        .par_iter()
        .map(|&seed| {
            let metrics = words.measured(&words.counted(seed, 5.0));
            let walk = metrics.metric(&ANGLE_RANDOM_WALK).ok();
            let misses = walk
                .is_some_and(|it| it.low > WALK_DEG_PER_SQRT_H || it.high < WALK_DEG_PER_SQRT_H);
            (answer(&metrics, 5.0, &format!("seed {seed}")), misses)
        })
        .collect();
    let of = |wanted: Option<Answer>| found.iter().filter(|it| it.0 == wanted).count();
    let missed = found.iter().filter(|it| it.1).count();
    assert!(of(Some(Curve)) > 0 && of(Some(Limit)) > 0, "{found:?}");
    assert!(of(None) <= 2, "{found:?}");
    assert!(missed <= 4, "{found:?}");
}

#[test]
fn minutes_at_4_khz_name_their_answer() {
    let mut words = Words {
        rate_deg_per_h: 8.47,
        per_second: 4000,
        seconds: 120,
    };
    let turning = [(0.02, Curve), (0.1, Curve), (1.0, Times), (5.0, Times)];
    check(&words, &turning, 60..61);
    words.rate_deg_per_h = 0.0;
    check(&words, &[(0.05, Curve), (0.2, Curve), (2.0, Limit)], 70..71);
}

/// Rounded words without carry, and those of a step lost in their noise, are measured as before.
#[test]
fn words_without_carry_are_no_pulses() {
    let words = Words {
        rate_deg_per_h: 8.47,
        per_second: 10,
        seconds: 3600,
    };
    for step in [0.5, 1.0, 2.0] {
        let rounded: Vec<f64> = words
            .rates(3)
            .iter()
            .map(|rate| (rate / step).round() * step)
            .collect();
        let metrics = words.measured(&rounded);
        assert!(
            metrics.pulse_words.is_empty(),
            "{step}: {:?}",
            metrics.pulse_words
        );
        assert!(metrics.metric(&ANGLE_RANDOM_WALK).is_ok());
    }
}

/// Two minutes at rest, pulses of an arcsecond.
const COUNTED: &str = "schema = 1
name = \"counted\"
duration_s = 120.0
warm_up_s = 1.0
bias_averaging_time_s = 2.0
fidelity = \"rate\"

[gyro.output]
quantisation = \"angle-carry\"
angle_lsb_arcsec = 1.0

[[filter]]
name = \"mean\"
[filter.moving_average]
taps = 8

[output]
samples = \"npy\"
";

fn check_channel(channel: &Value) {
    let walk = &channel["angle_random_walk_deg_per_sqrt_h"];
    let value = |key: &str| walk[key].as_f64().expect("a number");
    assert!(value("low") < 0.006 && value("high") > 0.006, "{walk}");
    assert!(value("high") < 1.3 * value("low"), "{walk}");
    let told = &channel["pulse_words"];
    let word = |key: &str| told[key].as_str().expect("words").to_owned();
    let of_walk = word("angle_random_walk_deg_per_sqrt_h");
    assert!(
        of_walk.starts_with("from the times between pulses"),
        "{of_walk}"
    );
    let of_step = word("quantisation_arcsec");
    assert!(
        of_step.starts_with("from the step of 1 arcsec"),
        "{of_step}"
    );
    let quantisation = &channel["quantisation_arcsec"];
    let found = quantisation["value"].as_f64().expect("a number");
    assert!(
        (found - 1.0 / 12.0_f64.sqrt()).abs() < 1e-9,
        "{quantisation}"
    );
    // It was 110 deg/h/sqrt(h) for none.
    let walk = channel[RATE_RANDOM_WALK.name]["value"].as_f64();
    assert!(walk.is_none_or(|walk| walk < 20.0), "{walk:?}");
}

#[test]
fn a_run_that_counts_pulses_and_its_log_say_how_the_noise_was_found() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(folder.path(), "counted.toml", COUNTED);
    let output = fogbench(folder.path(), &["run", "counted.toml"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(
        stdout(&output).contains("from the step of 1 arcsec"),
        "{}",
        stdout(&output)
    );
    let run = summary(Path::new(&folder.path().join("output")), "counted");
    check_channel(&run["channels"]["raw"]);
    // Behind a filter the pulses need to lose their phase, for which the record is too short.
    let filtered = &run["channels"]["mean"];
    let reason = &filtered["unavailable"]["angle_random_walk_deg_per_sqrt_h"];
    let reason = reason.as_str().expect("a reason");
    assert!(reason.contains("lose their phase"), "{reason}");
    let rate_hz = run["gyro"]["output_rate_hz"].to_string();
    let samples = "output/counted/samples/raw.npy";
    let arguments = [
        "analyze",
        samples,
        "--unit",
        "deg/h",
        "--warm-up-s",
        "1",
        "--format",
        "json",
        "--rate-hz",
        &rate_hz,
    ];
    let output = fogbench(folder.path(), &arguments);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let log: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    check_channel(&log["channels"]["raw"]);
}
