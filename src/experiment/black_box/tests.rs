//! Filters whose look-ahead, memory, gains and laws are known.

use super::*;
use crate::filters::{FilterKind, LmsFilterConfig, RlsFilterConfig};
use crate::metrics::SINE_DELAY_MS;
use crate::metrics::catalogue::{
    ADAPTATION_MEMORY, DELAY_UNDER_SWING, GLITCH_RESPONSE, LASTING_RATE_GAIN, LINEARITY_ERROR,
    SATURATION_GAIN, SINE_GAIN, START_UP, STEP_GAIN_1S, STEP_GAIN_10S, SWING_READAPTATION,
    TIME_INVARIANCE_ERROR, TWIN_MEAN_RATIO,
};
use crate::random::Streams;
use crate::vocabulary::DesiredSignal;

const PERIOD_S: f64 = 1e-3;

/// A filter given by what it makes of a record.
struct Given<F>(F, Handing);

impl<F: Fn(&[f64]) -> Vec<f64> + Sync> Subject for Given<F> {
    fn answer(&self, words: &[f64]) -> Result<Option<Vec<f64>>, Unfinished> {
        Ok(Some((self.0)(words)))
    }

    fn handing(&self) -> Handing {
        self.1
    }

    fn register_samples(&self) -> usize {
        0
    }
}

/// White noise of 20 deg/h on 8.47 deg/h.
fn record(words: usize) -> Vec<f64> {
    let mut record = vec![0.0; words];
    Streams::new(7, 0).stream("test").fill_normal(&mut record);
    record.iter().map(|draw| 20.0 * draw + 8.47).collect()
}

fn examined(subject: &dyn Subject, words: &[f64]) -> BlackBox {
    let input = TwinInput {
        words_deg_per_h: words,
        sample_period_s: PERIOD_S,
    };
    let found = examine(subject, &input, Some(BlackBoxTrial::Whole)).expect("nothing stops it");
    found.expect("it is asked for")
}

fn by(filter: impl Fn(&[f64]) -> Vec<f64> + Sync, words: usize) -> BlackBox {
    examined(&Given(filter, Handing::Words), &record(words))
}

#[track_caller]
fn assert_near(found: &BlackBox, key: &MetricKey, expected: f64, tolerance: f64) {
    let value = found.value(key).unwrap_or(f64::NAN);
    let is_near = (value - expected).abs() <= tolerance;
    assert!(is_near, "{}: {value}, not {expected}", key.name);
}

/// Weights of ages `-ahead` on.
fn weighted(weights: &[f64], ahead: usize, words: &[f64]) -> Vec<f64> {
    let at = |now: usize| -> f64 {
        let ages = weights.iter().enumerate();
        let word = |age: usize| Some(*words.get((now + ahead).checked_sub(age)?)?);
        ages.map(|(age, weight)| weight * word(age).unwrap_or(0.0))
            .sum()
    };
    (0..words.len()).map(at).collect()
}

#[test]
fn known_answer_of_a_moving_average_of_eight() {
    let found = by(|words| weighted(&[0.125; 8], 0, words), 8000);
    assert_near(&found, &LOOK_AHEAD, 0.0, 0.0);
    assert_near(&found, &MEMORY_1_PERCENT, 8.0 * PERIOD_S, 1e-12);
    assert_near(&found, &MEMORY_0P1_PERCENT, 8.0 * PERIOD_S, 1e-12);
    assert_near(&found, &STEP_GAIN_1S, 1.0, 1e-9);
    assert_near(&found, &ADAPTATION_MEMORY, 0.0, 16.0 * PERIOD_S);
    // sin(N w / 2) / (N sin(w / 2)) at two cycles in 4000 samples.
    let half = std::f64::consts::PI * 2.0 / 4000.0;
    let expected = (8.0 * half).sin() / (8.0 * half.sin());
    assert_near(&found, &SINE_GAIN, expected, 1e-9);
    let late_ms = found.field(&SINE_GAIN, SINE_DELAY_MS);
    assert!(late_ms.is_some_and(|late_ms| (late_ms - 3.5e3 * PERIOD_S).abs() < 1e-6));
    assert_near(&found, &LINEARITY_ERROR, 0.0, 1e-12);
    assert_near(&found, &TIME_INVARIANCE_ERROR, 0.0, 1e-9);
    assert_near(&found, &GLITCH_RESPONSE, 0.125, 1e-12);
    assert_near(&found, &LASTING_RATE_GAIN, 1.0, 1e-9);
    assert_near(&found, &TWIN_MEAN_RATIO, 1.0, 0.01);
    assert_near(&found, &DELAY_AT_REST, 3.5, 1e-6);
    assert_near(&found, &DELAY_UNDER_SWING, 3.5, 1e-6);
    // A start lacks up to seven words; the last of them may be small.
    assert_near(&found, &START_UP, 7.0 * PERIOD_S, 1.5 * PERIOD_S);
    assert_near(&found, &SATURATION_GAIN, 1.0, 1e-9);
    assert_near(&found, &SWING_READAPTATION, 0.2, 0.201);
}

#[test]
fn known_answer_of_a_filter_whose_range_ends() {
    let limit = 1000.0;
    let clipped = move |words: &[f64]| -> Vec<f64> {
        let clip = |word: &f64| word.clamp(-limit, limit);
        words.iter().map(clip).collect()
    };
    let found = by(clipped, 8000);
    // Steps of 100 sigma end at half their height, those of 100 000 at a two-thousandth.
    assert_near(&found, &SATURATION_GAIN, 0.001, 1e-4);
    assert_near(&found, &STEP_GAIN_1S, 1.0, 1e-9);
}

#[test]
fn a_mean_in_doubt_gives_no_ratio() {
    let words: Vec<f64> = record(8000).iter().map(|word| word - 8.47).collect();
    let found = examined(&Given(<[f64]>::to_vec, Handing::Words), &words);
    assert_eq!(found.value(&TWIN_MEAN_RATIO), None);
    assert_near(&found, &LASTING_RATE_GAIN, 1.0, 1e-9);
}

#[test]
fn the_runs_of_a_filter_are_as_many_as_the_page_says() {
    let runs = |trial| {
        let runs = std::sync::atomic::AtomicUsize::new(0);
        let counted = |words: &[f64]| {
            runs.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            words.to_vec()
        };
        let input = TwinInput {
            words_deg_per_h: &record(8000),
            sample_period_s: PERIOD_S,
        };
        let found = examine(&Given(counted, Handing::Words), &input, Some(trial));
        assert!(found.is_ok_and(|found| found.is_some()));
        runs.into_inner()
    };
    let page = include_str!("../../../docs/own-filter.md");
    let said = format!(
        "some {} runs of\nthe filter, where `\"whole\"` takes {}",
        runs(BlackBoxTrial::Brief).next_multiple_of(10),
        runs(BlackBoxTrial::Whole).next_multiple_of(10)
    );
    assert!(page.contains(&said), "{said}");
}

#[test]
fn known_answer_of_one_pole_which_remembers_4_6_time_constants() {
    let part = 0.01;
    let pole = move |words: &[f64]| -> Vec<f64> {
        let mut output = 0.0;
        let step = |word: &f64| {
            output += part * (word - output);
            output
        };
        words.iter().map(step).collect()
    };
    let found = by(pole, 20_000);
    let time_constant_s = -PERIOD_S / (1.0_f64 - part).ln();
    assert_near(
        &found,
        &MEMORY_1_PERCENT,
        4.605 * time_constant_s,
        1.5 * PERIOD_S,
    );
    assert_near(
        &found,
        &MEMORY_0P1_PERCENT,
        6.908 * time_constant_s,
        1.5 * PERIOD_S,
    );
    assert_near(&found, &LOOK_AHEAD, 0.0, 0.0);
    assert_near(&found, &STEP_GAIN_1S, 1.0, 1e-3);
    // (1 - part) / part samples.
    assert_near(&found, &DELAY_AT_REST, 99.0, 0.1);
    assert_near(&found, &LINEARITY_ERROR, 0.0, 1e-9);
    assert_near(&found, &TIME_INVARIANCE_ERROR, 0.0, 1e-9);
}

#[test]
fn known_answer_of_filters_that_look_ahead() {
    let three = Given(
        |words: &[f64]| weighted(&[0.25; 4], 3, words),
        Handing::Record,
    );
    let found = examined(&three, &record(4000));
    assert_near(&found, &LOOK_AHEAD, 3.0, 0.0);
    // Ages -3 to 0: their mean.
    assert_near(&found, &DELAY_AT_REST, -1.5 * 1e3 * PERIOD_S, 1e-6);
    let mean = |words: &[f64]| {
        let mean = words.iter().sum::<f64>() / words.len() as f64;
        vec![mean; words.len()]
    };
    let found = examined(&Given(mean, Handing::Record), &record(4000));
    // The last of ten places lies at 95 % of the record and nine words.
    assert_near(&found, &LOOK_AHEAD, 3809.0, 0.0);
    assert_eq!(found.value(&MEMORY_1_PERCENT), None);
    let in_blocks = |words: &[f64]| {
        let block = |block: &[f64]| weighted(&[0.5; 2], 1, block);
        words.chunks(100).flat_map(block).collect::<Vec<f64>>()
    };
    let found = examined(&Given(in_blocks, Handing::Blocks(100)), &record(4000));
    assert_near(&found, &LOOK_AHEAD, 1.0, 0.0);
}

/// A wavelet over the record: the two halves of a block of 2^level words, the finest detail taken away where
/// it is small.
fn haar(words: &[f64]) -> Vec<f64> {
    let pair = |pair: &[f64]| match pair {
        [first, second] => {
            let (mean, detail) = (0.5 * (first + second), 0.5 * (first - second));
            let kept = if detail.abs() > 30.0 { detail } else { 0.0 };
            vec![mean + kept, mean - kept]
        }
        rest => rest.to_vec(),
    };
    words.chunks(2).flat_map(pair).collect()
}

#[test]
fn known_answer_of_a_wavelet_over_the_record() {
    let found = examined(&Given(haar, Handing::Record), &record(4001));
    assert_near(&found, &LOOK_AHEAD, 1.0, 0.0);
    assert!(found.value(&LINEARITY_ERROR) > Some(0.1));
    // A record that begins an odd number of words later has other pairs.
    assert!(found.value(&TIME_INVARIANCE_ERROR) > Some(0.1));
    assert_near(&found, &STEP_GAIN_1S, 1.0, 0.02);
    // A word moves the other of its pair, and no further one.
    assert!(found.value(&MEMORY_0P1_PERCENT) <= Some(2.0 * PERIOD_S));
}

#[test]
fn known_answer_of_a_median_which_is_not_linear() {
    let median = |words: &[f64]| -> Vec<f64> {
        let at = |now: usize| {
            let mut window = words[now.saturating_sub(4)..=now].to_vec();
            window.sort_by(f64::total_cmp);
            window[window.len() / 2]
        };
        (0..words.len()).map(at).collect()
    };
    let found = by(median, 8000);
    assert!(found.value(&LINEARITY_ERROR) > Some(0.2));
    assert_near(&found, &TIME_INVARIANCE_ERROR, 0.0, 0.0);
    assert_near(&found, &STEP_GAIN_1S, 1.0, 1e-9);
    // A word is in five windows.
    assert!(found.value(&MEMORY_0P1_PERCENT) <= Some(5.0 * PERIOD_S));
    // A glitch moves the median by a neighbour's distance, not by its own height.
    assert!(found.value(&GLITCH_RESPONSE) < Some(0.03));
    assert_near(&found, &LOOK_AHEAD, 0.0, 0.0);
}

#[test]
fn one_that_answers_otherwise_each_time_is_not_measured() {
    let calls = std::sync::atomic::AtomicU32::new(0);
    let found = by(
        |words| {
            let call = calls.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            words.iter().map(|word| word + f64::from(call)).collect()
        },
        1000,
    );
    for key in all_keys() {
        assert_eq!(found.value(key), None, "{}", key.name);
    }
}

fn built_in(kind: &FilterKind, words: usize) -> BlackBox {
    let subject = BuiltIn {
        kind,
        register_samples: 1,
        sample_period_s: PERIOD_S,
    };
    examined(&subject, &record(words))
}

#[test]
fn known_answer_of_least_squares_that_forget_nothing() {
    let kind = FilterKind::Rls(RlsFilterConfig::reference());
    let found = built_in(&kind, 40_000);
    assert_near(&found, &LOOK_AHEAD, 0.0, 0.0);
    // What one word has taught the weights is less than a thousandth of what it is weighed by.
    assert_near(&found, &MEMORY_1_PERCENT, 4.5 * PERIOD_S, 0.6 * PERIOD_S);
    // Wiener weights of a predictor by 4: p m^2 / (s^2 + p m^2).
    let power = 4.0 * 8.47_f64.powi(2);
    let wiener = power / (400.0 + power);
    assert_near(&found, &STEP_GAIN_1S, wiener, 0.05);
    assert_near(&found, &STEP_GAIN_10S, wiener, 0.15);
    assert_near(&found, &SINE_GAIN, wiener, 0.15);
    assert_near(&found, &TWIN_MEAN_RATIO, wiener, 0.1);
    // What lasts is learned: g + m dg/dm = g + 2 g (1 - g).
    let lasting = wiener + 2.0 * wiener * (1.0 - wiener);
    assert_near(&found, &LASTING_RATE_GAIN, lasting, 0.1);
    // A large step leaves the filter nothing but itself to predict.
    assert!(found.value(&SATURATION_GAIN) > Some(0.9));
    // What the weights have learned does not end with the record.
    assert_eq!(found.value(&ADAPTATION_MEMORY), None);
    assert!(found.value(&LINEARITY_ERROR) > Some(0.05));
}

#[test]
fn known_answer_of_normalised_least_mean_squares() {
    // It learns to be the mean of two words, which it aims at, and is as good as fixed.
    let found = built_in(&FilterKind::Lms(LmsFilterConfig::reference()), 20_000);
    assert_near(&found, &MEMORY_0P1_PERCENT, 2.0 * PERIOD_S, 1e-12);
    assert_near(&found, &DELAY_AT_REST, 0.5 + 1.0, 1e-3);
    assert_near(&found, &STEP_GAIN_1S, 1.0, 1e-9);
    assert_near(&found, &LINEARITY_ERROR, 0.0, 1e-9);
    // A predictor has nothing but noise to learn from.
    let kind = FilterKind::Lms(LmsFilterConfig {
        desired: DesiredSignal::Current,
        input_lag_samples: 1,
        ..LmsFilterConfig::reference()
    });
    let found = built_in(&kind, 20_000);
    assert_near(&found, &LOOK_AHEAD, 0.0, 0.0);
    assert!(found.value(&LINEARITY_ERROR) > Some(0.2));
    assert!(found.value(&MEMORY_1_PERCENT) > Some(4.0 * PERIOD_S));
    // It forgets: where the record began does not matter later.
    assert!(found.value(&MEMORY_0P1_PERCENT) < Some(0.5));
    assert_near(&found, &TIME_INVARIANCE_ERROR, 0.0, 1e-9);
}
