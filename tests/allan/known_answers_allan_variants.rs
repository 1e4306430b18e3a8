//! Published and cross-checked answers for the whole family of Allan deviations.

use fogbench::metrics::{
    AllanEstimator, AllanOptions, AllanVariantPoint, PowerLaw, allan_variant, allan_variant_at,
};
use fogbench::vocabulary::AveragingTimes;

use crate::support::assert_close;
use crate::support::records::white;

const ESTIMATORS: [AllanEstimator; 5] = [
    AllanEstimator::Overlapping,
    AllanEstimator::Plain,
    AllanEstimator::Modified,
    AllanEstimator::Hadamard,
    AllanEstimator::PlainHadamard,
];

fn at(values: &[f64], factors: &[usize], estimator: AllanEstimator) -> Vec<AllanVariantPoint> {
    let options = AllanOptions {
        estimator,
        ..AllanOptions::default()
    };
    allan_variant_at(values, 1.0, factors, &options)
}

fn agree(values: &[f64], factors: &[usize], estimator: AllanEstimator, known: &[f64], rtol: f64) {
    let points = at(values, factors, estimator);
    assert_eq!(points.len(), known.len());
    for (point, wanted) in points.iter().zip(known) {
        assert_close(point.point.deviation_deg_per_h.value, *wanted, rtol, 0.0);
    }
}

/// NIST SP 1065 section 12.4: n' = 16807 n mod (2^31 - 1) from 1234567890 on, over 2^31 - 1.
fn nist_sequence(count: usize) -> Vec<f64> {
    let mut state = 1_234_567_890_u64;
    (0..count)
        .map(|_| {
            let value = state as f64 / 2_147_483_647.0;
            state = 16_807 * state % 2_147_483_647;
            value
        })
        .collect()
}

#[test]
fn known_answer_k17_every_estimator_on_the_nbs_nine_point_set() {
    // NIST SP 1065 table 30 (NBS Monograph 140, annex 8.E), seven digits.
    let values = [
        892.0, 809.0, 823.0, 798.0, 671.0, 644.0, 883.0, 903.0, 677.0,
    ];
    for (estimator, known) in ESTIMATORS.into_iter().zip([
        [91.229_45, 85.952_87],
        [91.229_45, 115.808_2],
        [91.229_45, 74.788_49],
        [70.806_07, 85.614_87],
        [70.806_07, 116.798_0],
    ]) {
        agree(&values, &[1, 2], estimator, &known, 2e-7);
    }
}

#[test]
fn known_answer_k18_every_estimator_on_the_nist_thousand_point_set() {
    // NIST SP 1065 table 31, seven digits.
    let values = nist_sequence(1000);
    for (estimator, known) in ESTIMATORS.into_iter().zip([
        [2.922_319e-1, 9.159_953e-2, 3.241_343e-2],
        [2.922_319e-1, 9.965_736e-2, 3.897_804e-2],
        [2.922_319e-1, 6.172_376e-2, 2.170_921e-2],
        [2.943_883e-1, 9.581_083e-2, 3.237_638e-2],
        [2.943_883e-1, 1.052_754e-1, 3.910_861e-2],
    ]) {
        agree(&values, &[1, 10, 100], estimator, &known, 2e-7);
    }
}

/// Walk and white noise on a large mean, as the script below makes it.
fn walk_and_white() -> Vec<f64> {
    let draws = nist_sequence(10_000);
    let mut walk = 0.0;
    (0..5000)
        .map(|k| {
            walk += draws[k] - 0.5;
            1e3 + walk * 0.05 + draws[5000 + k] * 8.0
        })
        .collect()
}

#[test]
fn every_estimator_agrees_with_allantools() {
    // python -m pip install allantools (2024.06), then, lcg(n) being `nist_sequence`:
    //   y = 1e3 + numpy.cumsum(lcg(5000) - 0.5) * 0.05 + lcg(10000)[5000:] * 8
    //   for name in ["oadev", "adev", "mdev", "ohdev", "hdev"]:
    //       t, d, e, n = getattr(allantools, name)(y, rate=1.0, data_type="freq", taus=taus)
    let taus = [1, 2, 3, 7, 16, 50, 200, 1000];
    let values = walk_and_white();
    for (estimator, known) in ESTIMATORS.into_iter().zip([
        [
            (2.332928035033706, 4999),
            (1.627446746090049, 4997),
            (1.333628221763704, 4995),
            (0.8694029505891433, 4987),
            (0.5899158922116684, 4969),
            (0.3464613306914043, 4901),
            (0.2100822945986361, 4601),
            (0.1530526289622791, 3001),
        ],
        [
            (2.332928035033706, 4999),
            (1.639198939490491, 2499),
            (1.29361357328136, 1665),
            (0.8723495202783325, 713),
            (0.5758507503053343, 311),
            (0.3316884896280675, 99),
            (0.2354485187070173, 24),
            (0.159211783261498, 4),
        ],
        [
            (2.332928035033706, 4999),
            (1.285390650757537, 4996),
            (0.9943468647907606, 4993),
            (0.6248397262799741, 4981),
            (0.4240936292436384, 4954),
            (0.251556951761119, 4852),
            (0.1639149327134043, 4402),
            (0.13584593768348, 2002),
        ],
        [
            (2.340159521627466, 4998),
            (1.623383917661903, 4995),
            (1.336240282141794, 4992),
            (0.8644224848448674, 4980),
            (0.5860580933915477, 4953),
            (0.3464164879028205, 4851),
            (0.200178784796683, 4401),
            (0.1472972298032562, 2001),
        ],
        [
            (2.340159521627466, 4998),
            (1.639705590595542, 2498),
            (1.287850212768356, 1664),
            (0.8702092729181408, 712),
            (0.5731982758271426, 310),
            (0.3309699263203576, 98),
            (0.2364254538150331, 23),
            (0.1825578258168457, 3),
        ],
    ]) {
        let points = at(&values, &taus, estimator);
        assert_eq!(points.len(), known.len());
        for (point, (deviation, count)) in points.iter().zip(known) {
            assert_close(point.point.deviation_deg_per_h.value, deviation, 1e-9, 0.0);
            assert_eq!((point.point.count, point.left_out), (count, 0));
        }
    }
}

/// Rates of even exponent: differences and sums of white noise.
fn power_law(seed: u64, count: usize, alpha: i32) -> Vec<f64> {
    let mut values = white(seed, count + 1, 1.0);
    if alpha == 2 {
        return values.windows(2).map(|two| two[1] - two[0]).collect();
    }
    for _ in 0..-alpha / 2 {
        let mut sum = 0.0;
        for value in &mut values {
            sum += *value;
            *value = sum;
        }
    }
    values
}

#[test]
fn noise_is_identified_from_white_angle_to_random_run() {
    for (alpha, noise) in [
        (2, PowerLaw::AngleWhite),
        (0, PowerLaw::RateWhite),
        (-2, PowerLaw::RateRandomWalk),
        (-4, PowerLaw::RateRandomRun),
    ] {
        assert_eq!(noise.alpha(), alpha);
        let values = power_law(5, 16_384, alpha);
        // From 512 means on the autocorrelation is known to 0.04; rounding allows 0.2.
        for point in at(&values, &[1, 4, 16, 32], AllanEstimator::Hadamard) {
            assert!(point.noise_identified);
            assert_eq!(point.noise, noise, "m {}", point.point.averaged_samples);
        }
    }
    // The Allan variance knows nothing steeper than a walk.
    let run = at(&power_law(5, 16_384, -4), &[4], AllanEstimator::Overlapping);
    assert_eq!(run[0].noise, PowerLaw::RateRandomWalk);
    // Fewer than thirty means: the last law found.
    let few = at(
        &power_law(5, 1000, -2),
        &[32, 40],
        AllanEstimator::Overlapping,
    );
    assert!(few[0].noise_identified && !few[1].noise_identified);
    assert_eq!(few[0].noise, few[1].noise);
}

#[test]
fn grids_end_where_the_record_stops_supporting_them() {
    let values = white(1, 1000, 1.0);
    let longest = |estimator, taus| {
        let options = AllanOptions {
            estimator,
            taus,
            ..AllanOptions::default()
        };
        let points = allan_variant(&values, 1.0, &options);
        let last = points[points.len() - 1].point.averaged_samples;
        (points.len(), last)
    };
    assert_eq!(
        longest(AllanEstimator::Overlapping, AveragingTimes::Octave),
        (8, 128)
    );
    assert_eq!(
        longest(AllanEstimator::Plain, AveragingTimes::Decade),
        (8, 200)
    );
    assert_eq!(
        longest(AllanEstimator::Modified, AveragingTimes::All),
        (200, 200)
    );
    assert_eq!(
        AveragingTimes::Decade.averaging_factors(60),
        [1, 2, 5, 10, 20, 50]
    );
}

/// Every difference from its definition, block means compared one by one.
fn from_definition(values: &[f64], m: usize, estimator: AllanEstimator) -> (f64, usize, usize) {
    let mean = |start: usize| -> f64 { values[start..start + m].iter().sum::<f64>() / m as f64 };
    let (weights, divisor): (&[f64], f64) = match estimator {
        AllanEstimator::Hadamard | AllanEstimator::PlainHadamard => (&[1.0, -2.0, 1.0], 6.0),
        _ => (&[-1.0, 1.0], 2.0),
    };
    let stride = match estimator {
        AllanEstimator::Plain | AllanEstimator::PlainHadamard => m,
        _ => 1,
    };
    let averaged = if estimator == AllanEstimator::Modified {
        m
    } else {
        1
    };
    let span = weights.len() * m + averaged - 1;
    let (mut sum, mut count, mut left_out) = (0.0, 0, 0);
    for start in (0..=values.len() - span).step_by(stride) {
        if values[start..start + span].iter().any(|v| v.is_nan()) {
            left_out += 1;
            continue;
        }
        let difference = |from: usize| -> f64 {
            let blocks = weights.iter().enumerate();
            blocks
                .map(|(block, weight)| weight * mean(from + block * m))
                .sum()
        };
        let average = (start..start + averaged).map(difference).sum::<f64>() / averaged as f64;
        sum += average * average;
        count += 1;
    }
    ((sum / (divisor * count as f64)).sqrt(), count, left_out)
}

#[test]
fn differences_that_touch_a_gap_are_left_out_and_counted() {
    let mut values = walk_and_white();
    values.truncate(600);
    for missing in [0, 17, 18, 19, 300, 431, 599] {
        values[missing] = f64::NAN;
    }
    for estimator in ESTIMATORS {
        for point in at(&values, &[1, 2, 7, 30], estimator) {
            let m = point.point.averaged_samples;
            let (deviation, count, left_out) = from_definition(&values, m, estimator);
            assert_close(point.point.deviation_deg_per_h.value, deviation, 1e-9, 0.0);
            assert_eq!(
                (point.point.count, point.left_out),
                (count, left_out),
                "{estimator:?} {m}"
            );
            assert!(left_out > 0);
        }
    }
    // The longest run without a gap, 280 samples, holds no difference of this length.
    assert!(at(&values, &[145], AllanEstimator::Overlapping).is_empty());
    assert!(allan_variant(&[f64::NAN; 64], 1.0, &AllanOptions::default()).is_empty());
}

#[test]
fn gaps_cost_degrees_of_freedom_in_proportion() {
    let mut values = white(2, 4000, 1.0);
    let whole = at(&values, &[8], AllanEstimator::Overlapping)[0];
    values[1000..2000].fill(f64::NAN);
    let gapped = at(&values, &[8], AllanEstimator::Overlapping)[0];
    assert_eq!(gapped.left_out, 1000 + 15);
    let share = gapped.point.count as f64 / whole.point.count as f64;
    let freedom = gapped.point.degrees_of_freedom / whole.point.degrees_of_freedom;
    assert_close(freedom, share, 1e-12, 0.0);
}
