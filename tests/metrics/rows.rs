//! Every declared row of metrics, curves and files: something that yields it, how repeats pool it, its
//! heading, and its row in the documents.

use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::fs;
use std::sync::LazyLock;

use fogbench::Scenario;
use fogbench::metrics::catalogue::{BIAS_REPEATABILITY, SCALE_FACTOR_REPEATABILITY};
use fogbench::metrics::{
    Applies, ChannelMetrics, Dwell, FilterFacts, Motion, RateGain, Record, Staircase, TwoRuns,
    WarmRecord, aggregate, known_curves, known_metrics, measure, measure_temperature,
};
use fogbench::report::{Place, artefacts, curve_csv};
use fogbench::signal::{FilterShape, Rates, WeightRule};

use crate::support::records::{settings, white};
use crate::support::{code, fogbench, repository, stderr, tree, write};

/// Sample period of the synthetic records, s: a record of ten minutes has few samples.
const PERIOD_S: f64 = 0.05;
const SAMPLES: usize = 12_000;
const REPEATS: u64 = 6;

/// Weights of the filter under test: the mean of three samples.
const TAPS: usize = 3;

/// A motion with its true rate and what the gyro adds to it.
struct Case {
    motion: Motion,
    truth: Vec<f64>,
    noise: fn(u64) -> Vec<f64>,
}

fn small_noise(seed: u64) -> Vec<f64> {
    white(seed, SAMPLES, 0.2)
}

/// White noise, flicker as a sum of relaxations an octave apart, and a random walk.
fn coloured_noise(seed: u64) -> Vec<f64> {
    let mut sum = white(seed, SAMPLES, 1.0);
    for octave in 0..10 {
        let decay = (-(2.0_f64.powi(-octave))).exp();
        let drive = white(
            seed + 100 * (u64::from(octave.unsigned_abs()) + 1),
            SAMPLES,
            1.0,
        );
        let mut state = 0.0;
        for (value, drive) in sum.iter_mut().zip(&drive) {
            state = decay * state + (1.0 - decay * decay).sqrt() * drive;
            *value += 0.5 * state;
        }
    }
    let mut walk = 0.0;
    for (value, step) in sum.iter_mut().zip(white(seed + 5000, SAMPLES, 0.05)) {
        walk += step;
        *value += walk;
    }
    sum
}

/// Noise of the rounded angle, and a ramp.
fn rounded_ramp(seed: u64) -> Vec<f64> {
    let angle = white(seed, SAMPLES + 1, 1.0);
    let ramp = |index: usize| 0.01 * index as f64;
    let words = angle.windows(2).enumerate();
    words
        .map(|(index, two)| two[1] - two[0] + ramp(index))
        .collect()
}

/// White noise, noise correlated over 6 s, and a sine of 4 s.
fn correlated_beside_sine(seed: u64) -> Vec<f64> {
    let mut sum = white(seed, SAMPLES, 1.0);
    let decay = (-PERIOD_S / 6.0).exp();
    let mut state = 0.0;
    for (index, (value, drive)) in sum
        .iter_mut()
        .zip(white(seed + 900, SAMPLES, 1.0))
        .enumerate()
    {
        state = decay * state + (1.0 - decay * decay).sqrt() * drive;
        *value += 2.0 * state + 3.0 * (TAU * index as f64 * PERIOD_S / 4.0).sin();
    }
    sum
}

fn sines(frequencies_hz: &[f64]) -> Vec<f64> {
    let at = |index: usize| {
        let time_s = (index + 1) as f64 * PERIOD_S;
        let each = frequencies_hz.iter();
        each.map(|frequency_hz| 100.0 * (TAU * frequency_hz * time_s).cos())
            .sum::<f64>()
    };
    (0..SAMPLES).map(|index| 8.0 + at(index)).collect()
}

/// Rates of both senses, zero, and a rate held twice with a little more beside it.
fn staircase() -> Case {
    let rates = [0.0, 100.0, -100.0, 200.0, -200.0, 110.0, 0.0, 100.0];
    let each = SAMPLES / rates.len();
    let dwells = rates.iter().enumerate().map(|(at, rate_deg_per_h)| Dwell {
        samples: at * each + 20..(at + 1) * each,
        rate_deg_per_h: *rate_deg_per_h,
    });
    Case {
        motion: Motion::Steps {
            last_step_index: 7 * each,
            step_deg_per_h: 100.0,
            staircase: Staircase {
                dwells: dwells.collect(),
                settle_s: 1.0,
                rest_deg_per_h: 0.0,
                has_static_zeros: false,
                is_found: false,
            },
        },
        truth: (0..SAMPLES).map(|index| rates[index / each]).collect(),
        noise: small_noise,
    }
}

fn cases() -> Vec<Case> {
    let case = |motion, truth, noise| Case {
        motion,
        truth,
        noise,
    };
    let still = || vec![8.0; SAMPLES];
    let swing = || sines(&[1.0]);
    let tones = vec![0.5, 2.0, 4.0, 6.0];
    let mut late = still();
    late[SAMPLES / 4..].fill(108.0);
    vec![
        case(Motion::Steady, still(), coloured_noise),
        case(Motion::Steady, still(), rounded_ramp),
        case(Motion::Steady, still(), correlated_beside_sine),
        case(Motion::Swing { frequency_hz: 1.0 }, swing(), small_noise),
        case(
            Motion::SwingFromRest { frequency_hz: 1.0 },
            swing(),
            small_noise,
        ),
        case(
            Motion::MultiSine {
                frequencies_hz: tones.clone(),
            },
            sines(&tones),
            small_noise,
        ),
        case(Motion::General, late, small_noise),
        staircase(),
    ]
}

/// Two runs of a filter that differ by noise in all they can differ by.
fn two_runs() -> TwoRuns {
    let mut runs = TwoRuns::of_blocks(4);
    for sums in [
        &mut runs.whole,
        &mut runs.through_weights,
        &mut runs.of_weights,
    ] {
        for (block, sums) in sums.iter_mut().enumerate() {
            white(block as u64, 50, 1.0)
                .iter()
                .for_each(|it| sums.take(*it));
        }
    }
    runs
}

fn facts() -> FilterFacts {
    let weight = 1.0 / TAPS as f64;
    FilterFacts {
        shape: FilterShape {
            taps: Some(TAPS),
            newest_age_samples: 0,
            register_samples: 0,
            rule: WeightRule::Fixed(vec![weight; TAPS]),
        },
        dc_gain: Some(1.0),
        dc_gain_adapted: Some(1.0),
        mean_weights: None,
        block_weights: Vec::new(),
        block_dc_gains_adapted: Vec::new(),
        learning: None,
        weights_of_other_runs: Vec::new(),
        two_runs: Some(two_runs()),
        added_rate_deg_per_h: 1.0,
        rate_gains: vec![RateGain {
            rate_deg_per_s: 1.0,
            block_gains: vec![1.0, 0.9],
            block_mean_ratios: vec![1.0, 0.9],
        }],
        latency_s: 0.0,
    }
}

/// Raw and filter of one repeat.
fn measured(case: &Case, seed: u64) -> [ChannelMetrics; 2] {
    let noise = (case.noise)(seed);
    let raw: Vec<f64> = case
        .truth
        .iter()
        .zip(&noise)
        .map(|(rate, noise)| rate + noise)
        .collect();
    let filtered: Vec<f64> = (0..SAMPLES)
        .map(|index| {
            let window = &raw[(index + 1).saturating_sub(TAPS)..=index];
            window.iter().sum::<f64>() / window.len() as f64
        })
        .collect();
    let mut angle = 0.0;
    let angles: Vec<f64> = case
        .truth
        .iter()
        .map(|rate| {
            angle += rate / 3600.0_f64.to_degrees() * PERIOD_S;
            angle
        })
        .collect();
    let mut settings = settings(case.motion.clone());
    settings.fit_tau_min_s = 10.0 * PERIOD_S;
    [(&raw, None), (&filtered, Some(&facts()))].map(|(channel, filter)| {
        let record = Record {
            channel_deg_per_h: channel,
            raw_deg_per_h: &raw,
            truth_deg_per_h: Rates::Words(&case.truth),
            response_deg_per_h: &[],
            encoder_rad: Some(&angles),
            sample_period_s: PERIOD_S,
            first_stamp_s: PERIOD_S,
            drift: None,
        };
        measure(&record, &settings, filter)
    })
}

/// What is found in some record.
#[derive(Default)]
struct Found {
    metrics: BTreeSet<String>,
    curves: BTreeSet<String>,
}

impl Found {
    fn add(&mut self, channel: &ChannelMetrics) {
        self.metrics.extend(channel.metrics.keys().cloned());
        self.curves.extend(channel.curves.keys().cloned());
    }
}

/// What single records and their repeats pooled hold, and channels of one repeat.
static FOUND: LazyLock<Findings> = LazyLock::new(found);

/// Found in single records, in pooled ones, and the channels by name.
type Findings = (Found, Found, Vec<(String, ChannelMetrics)>);

fn found() -> Findings {
    let (mut single, mut pooled) = (Found::default(), Found::default());
    let mut channels = Vec::new();
    for case in cases() {
        let repeats: Vec<_> = (1..=REPEATS).map(|seed| measured(&case, seed)).collect();
        for channel in 0..2 {
            let own: Vec<_> = repeats
                .iter()
                .map(|repeat| repeat[channel].clone())
                .collect();
            own.iter().for_each(|repeat| single.add(repeat));
            pooled.add(&aggregate(&own));
            channels.push((format!("channel-{}", channels.len()), own[0].clone()));
        }
    }
    let warm: Vec<_> = (1..=REPEATS).map(beside_temperature).collect();
    warm.iter().for_each(|repeat| single.add(repeat));
    pooled.add(&aggregate(&warm));
    channels.push(("warm".to_owned(), warm[0].clone()));
    (single, pooled, channels)
}

/// White noise beside a temperature that rises and falls.
fn beside_temperature(seed: u64) -> ChannelMetrics {
    let words = small_noise(seed);
    let at = |index: usize| 25.0 + 5.0 * (TAU * index as f64 / 5000.0).sin();
    let temperature_c: Vec<f64> = (0..SAMPLES).map(at).collect();
    let record = WarmRecord {
        words_deg_per_h: &words,
        truth_deg_per_h: &[],
        temperature_c: &temperature_c,
        sample_period_s: PERIOD_S,
        first_stamp_s: PERIOD_S,
        swing_hz: None,
    };
    let mut metrics = ChannelMetrics::default();
    measure_temperature(&record, None, &mut metrics);
    metrics
}

/// A pipeline that fails early for the order of its update, and a sound one.
const PIPELINES: &str = r#"
schema = 1
name = "pipelines"
duration_s = 0.2
warm_up_s = 0.05

[[filter]]
name = "sound"
[filter.rls]
pipeline = "fpga"

[[filter]]
name = "winding"
[filter.rls]
forgetting_factor = 0.99
pipeline = "fpga"
update_order = "gain-first"
"#;

fn of_pipelines() -> BTreeSet<String> {
    let run = Scenario::from_toml(PIPELINES).expect("a sound text").run();
    let run = run.expect("it runs");
    let channels = run.channels();
    channels
        .flat_map(|(_, metrics)| metrics.metrics.keys().cloned())
        .collect()
}

#[test]
fn every_metric_is_yielded_pooled_headed_and_documented() {
    let (single, pooled, _) = &*FOUND;
    let pipelines = of_pipelines();
    let page = fs::read_to_string(repository("docs/metrics.md")).expect("the page is there");
    for key in known_metrics() {
        let name = key.name;
        assert!(
            !key.title().is_empty() && !key.definition.is_empty(),
            "{name}"
        );
        assert!(!key.pooling().is_empty(), "{name}");
        assert!(
            page.contains(&format!("| `{name}` |")),
            "{name} is not documented"
        );
        let is_of_repeats = [&BIAS_REPEATABILITY, &SCALE_FACTOR_REPEATABILITY].contains(key);
        let is_yielded = match key.applies {
            // The tests of campaigns, of failures, of logs, of black boxes and of fixed point have those.
            Applies::Calibration | Applies::Log | Applies::Twins | Applies::FixedPoint => true,
            Applies::Pipeline => pipelines.contains(name),
            _ if name == "diverged_at_s" => true,
            _ if is_of_repeats => pooled.metrics.contains(name),
            _ => single.metrics.contains(name) && pooled.metrics.contains(name),
        };
        assert!(is_yielded, "no record yields {name}");
    }
}

#[test]
fn every_curve_is_yielded_pooled_and_documented_and_its_file_has_its_columns() {
    let (single, pooled, channels) = &*FOUND;
    let page = fs::read_to_string(repository("docs/files.md")).expect("the page is there");
    for key in known_curves() {
        let name = key.name;
        assert!(single.curves.contains(name), "no record yields {name}");
        assert!(pooled.curves.contains(name), "repeats lose {name}");
        assert!(
            page.contains(&format!("\n### {name}\n")),
            "{name} is not documented"
        );
        let csv = curve_csv(key, channels).expect("a channel has it");
        let head: BTreeSet<&str> = csv.lines().next().expect("a heading").split(',').collect();
        let columns = key
            .columns
            .iter()
            .chain(key.words)
            .map(|column| column.name);
        let declared: BTreeSet<&str> = columns.chain(["channel"]).collect();
        assert_eq!(head, declared, "{name}");
    }
}

#[test]
fn every_file_of_a_run_and_of_its_suite_is_a_row_and_every_row_is_documented() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let text = "schema = 1\nname = \"files\"\nduration_s = 2.0\nwarm_up_s = 1.0\n\
        [output]\nsamples = \"npy\"\n[turntable.swing]\nrate_amplitude_deg_per_s = 1.0\n\
        frequency_hz = 5.0\n[[filter]]\nname = \"rls\"\n[filter.rls]\n";
    write(folder.path(), "files.toml", text);
    let output = fogbench(folder.path(), &["run", "files.toml", "-o", "out"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let is_row = |place: Place, name: &str| {
        artefacts()
            .iter()
            .filter(|row| row.places.contains(&place))
            .any(|row| {
                let (start, end) = match (row.name.find('<'), row.name.rfind('>')) {
                    (Some(from), Some(to)) => (&row.name[..from], &row.name[to + 1..]),
                    _ => return row.name == name,
                };
                name.starts_with(start) && name.ends_with(end)
            })
    };
    let mut files = 0;
    for (path, _) in tree(&folder.path().join("out")) {
        let path = path.to_string_lossy().into_owned();
        match path.split_once('/') {
            Some((".fogbench", _)) => continue,
            Some((_, name)) => assert!(is_row(Place::Run, name), "{path}"),
            None => assert!(is_row(Place::Suite, &path), "{path}"),
        }
        files += 1;
    }
    assert!(files > 12, "{files} files");
    let page = fs::read_to_string(repository("docs/files.md")).expect("the page is there");
    for row in artefacts() {
        assert!(
            page.contains(&format!("| `{}` |", row.name)),
            "{} is not documented",
            row.name
        );
    }
}
