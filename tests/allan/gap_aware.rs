//! Differences of the Allan deviation that span gaps: those whose three angles exist, and no others.

use std::fmt::Write as _;
use std::path::Path;

use fogbench::metrics::{
    AllanEstimator, AllanOptions, allan_variant_across, overlapping_allan, overlapping_allan_across,
};
use fogbench::signal::Bridge;
use serde_json::Value;

use crate::support::records::white;
use crate::support::transcript::Transcript;
use crate::support::{assert_close, code, fogbench, scratch, stderr, stdout, write};

/// Gaps of a record of 2000 words, of one word to seven.
const GAPS: [(usize, usize); 6] = [
    (3, 4),
    (250, 257),
    (300, 301),
    (301 + 9, 301 + 11),
    (1500, 1504),
    (1990, 1993),
];

/// Words with gaps, and these with the mean rates over them.
fn gappy(words: &[f64], is_known: bool) -> (Vec<f64>, Vec<Bridge>) {
    let mut present = words.to_vec();
    let bridges = GAPS.map(|(from, end)| {
        present[from..end].fill(f64::NAN);
        Bridge {
            words: from..end,
            mean_deg_per_h: words[from..end].iter().sum::<f64>() / (end - from) as f64,
            is_known,
        }
    });
    (present, bridges.into())
}

/// The deviation over differences of angles as `gradev` takes them: those of which all angles exist, none
/// within a gap; with `share` at most that part of each mean rate missing.
fn plain(words: &[f64], m: usize, order: usize, stride: usize, share: f64) -> (f64, usize) {
    let mut angles = vec![0.0];
    for word in words {
        angles.push(angles[angles.len() - 1] + word);
    }
    let inside = |angle: usize| GAPS.iter().any(|(from, end)| *from < angle && angle < *end);
    let missing = |from: usize| {
        let is_missing = |word: &usize| GAPS.iter().any(|(a, b)| (*a..*b).contains(word));
        (from..from + m).filter(is_missing).count() as f64
    };
    let (mut sum, mut count) = (0.0, 0);
    for k in (0..)
        .step_by(stride)
        .take_while(|k| k + order * m < angles.len())
    {
        let all = (0..=order).all(|step| !inside(k + step * m))
            && (0..order).all(|step| missing(k + step * m) <= share * m as f64);
        let x = |step: usize| angles[k + step * m];
        let difference = match order {
            2 => x(2) - 2.0 * x(1) + x(0),
            _ => x(3) - 3.0 * x(2) + 3.0 * x(1) - x(0),
        };
        if all {
            sum += difference * difference;
            count += 1;
        }
    }
    let scale = if order == 2 { 2.0 } else { 6.0 };
    ((sum / (scale * (m * m * count) as f64)).sqrt(), count)
}

#[test]
fn differences_that_span_gaps_are_those_of_which_all_angles_exist() {
    let words = white(11, 2000, 3.0);
    for (is_known, share) in [(true, 1.0), (false, 0.1)] {
        let (present, bridges) = gappy(&words, is_known);
        let points = overlapping_allan_across(&present, 0.5, &bridges);
        assert!(points.len() > 20, "{}", points.len());
        for point in &points {
            let (deviation, count) = plain(&words, point.averaged_samples, 2, 1, share);
            assert_eq!(point.count, count, "m = {}", point.averaged_samples);
            assert_close(point.deviation_deg_per_h.value, deviation, 1e-9, 0.0);
        }
        let longest = points.last().expect("a point");
        let cut = overlapping_allan(&present, 0.5);
        let without = cut
            .iter()
            .find(|it| it.averaged_samples == longest.averaged_samples);
        assert!(without.is_none_or(|it| it.count < longest.count / 2));
        for (estimator, order, is_plain) in [
            (AllanEstimator::Overlapping, 2, false),
            (AllanEstimator::Plain, 2, true),
            (AllanEstimator::Hadamard, 3, false),
            (AllanEstimator::PlainHadamard, 3, true),
        ] {
            let options = AllanOptions {
                estimator,
                ..AllanOptions::default()
            };
            let points = allan_variant_across(&present, 0.5, &options, &bridges);
            assert!(points.len() > 6);
            for found in points {
                let m = found.point.averaged_samples;
                let stride = if is_plain { m } else { 1 };
                let (deviation, count) = plain(&words, m, order, stride, share);
                assert_eq!(found.point.count, count, "{estimator:?} m = {m}");
                assert_close(found.point.deviation_deg_per_h.value, deviation, 1e-9, 0.0);
            }
        }
    }
}

/// What `analyze` says of a file.
#[track_caller]
fn analysed(folder: &Path, arguments: &[&str]) -> Value {
    let command = [&["analyze"], arguments, &["--format", "json"]].concat();
    let output = fogbench(folder, &command);
    assert_eq!(code(&output), 0, "{arguments:?}: {}", stderr(&output));
    serde_json::from_str(&stdout(&output)).expect("JSON")
}

/// A column of the Allan curve.
fn column(json: &Value, name: &str) -> Vec<f64> {
    let column = json["channels"]["raw"]["curves"]["allan"][name].as_array();
    let column = column.unwrap_or_else(|| panic!("no {name}"));
    column
        .iter()
        .map(|it| it.as_f64().expect("a number"))
        .collect()
}

#[test]
fn an_angle_that_ran_on_is_known_behind_a_gap() {
    // Words of 1 s: their angle in arcsec, of which those within the gaps were not recorded.
    let words = white(12, 2000, 3.0);
    let mut text = "time_s,angle [arcsec]\n0.000,0\n".to_owned();
    let mut angle = 0.0;
    for (k, word) in words.iter().enumerate() {
        angle += word;
        let is_lost = GAPS.iter().any(|(from, end)| *from < k + 1 && k + 1 < *end);
        if !is_lost {
            writeln!(text, "{}.000,{angle:.12}", k + 1).expect("a string takes it");
        }
    }
    let folder = scratch();
    write(folder.path(), "angle.csv", &text);
    let json = analysed(
        folder.path(),
        &["angle.csv", "--kind", "angle", "--gap-aware", "6"],
    );
    let (taus, deviations) = (column(&json, "tau_s"), column(&json, "deviation_deg_per_h"));
    let counts = column(&json, "count");
    assert!(taus.len() > 7);
    let points = taus.into_iter().zip(deviations).zip(counts);
    for (octave, ((tau, deviation), count)) in points.enumerate() {
        let m = 1 << octave;
        assert_close(tau, m as f64, 1e-12, 0.0);
        // 1 arcsec in 1 s is 1 deg/h.
        let (wanted, used) = plain(&words, m, 2, 1, 1.0);
        assert_close(deviation, wanted, 1e-8, 0.0);
        assert_close(count, used as f64, 0.0, 0.0);
    }
}

/// H3 of the cases, and worse: stamps of white noise, every twentieth of which is lost.
fn lossy(count: usize, is_lost: impl Fn(usize) -> bool) -> String {
    let mut text = "time_s,rate [rad/s]\n".to_owned();
    // An angle random walk of 3.44 deg/sqrt(h) in words of 5 ms.
    let words = white(13, count, 0.001 / 0.005_f64.sqrt());
    for (k, word) in words.iter().enumerate().filter(|(k, _)| !is_lost(*k)) {
        writeln!(text, "{:.3},{word:.9}", k as f64 / 200.0).expect("a string takes it");
    }
    text
}

#[test]
fn a_lost_sample_is_spanned_and_the_noise_is_that_of_the_words() {
    let folder = scratch();
    let name = "log.csv";
    let long = |json: &Value| column(json, "count").last().copied().expect("a point");
    for (count, rate, is_lost) in [
        (1200, "200", (|k| k == 700) as fn(usize) -> bool),
        (40_000, "200", |k| k % 20 == 11),
    ] {
        write(folder.path(), name, &lossy(count, is_lost));
        let aware = analysed(folder.path(), &[name, "--gap-aware", "1"]);
        let cut = analysed(folder.path(), &[name, "--split-gaps"]);
        let walk = &aware["channels"]["raw"]["angle_random_walk_deg_per_sqrt_h"];
        let end = |end: &str| {
            walk[end]
                .as_f64()
                .unwrap_or_else(|| panic!("{walk} {rate}"))
        };
        assert!(end("low") < 3.44 && 3.44 < end("high"), "{walk}");
        assert!(column(&aware, "tau_s").len() >= column(&cut, "tau_s").len());
        assert!(
            long(&aware) > 1.3 * long(&cut),
            "{} {}",
            long(&aware),
            long(&cut)
        );
        if count > 10_000 {
            // A twentieth of the words is assumed, which adds at most as much to the variance.
            assert_close(end("value"), 3.44, 0.03, 0.0);
        }
    }
}

#[test]
fn what_is_said_of_gaps_that_are_spanned() {
    let folder = scratch();
    let mut transcript = Transcript::of("gap-aware", "Gaps that differences span");
    for (lost, more) in [
        (700..701, &["--gap-aware", "1"][..]),
        (700..720, &["--gap-aware", "3"]),
        (700..720, &["--gap-aware", "3", "--split-gaps"]),
    ] {
        write(
            folder.path(),
            "log.csv",
            &lossy(1200, |k| lost.contains(&k) || k == 300),
        );
        let output = fogbench(folder.path(), &[&["analyze", "log.csv"], more].concat());
        transcript.case(
            format!("{lost:?} {}", more.join(" ")),
            format!("{}{}", stdout(&output), stderr(&output)),
        );
    }
    let nan = lossy(1200, |_| false)
        .replace("\n1.500,", "\n1.500,nan ")
        .replace("nan -", "nan");
    let nan: String = nan
        .lines()
        .map(|line| match line.split_once("nan") {
            Some((stamp, _)) => format!("{stamp}nan\n"),
            None => format!("{line}\n"),
        })
        .collect();
    write(folder.path(), "log.csv", &nan);
    let more = ["--missing", "gap", "--gap-aware", "2"];
    let output = fogbench(
        folder.path(),
        &[&["analyze", "log.csv"], &more[..]].concat(),
    );
    transcript.case(
        more.join(" "),
        format!("{}{}", stdout(&output), stderr(&output)),
    );
    transcript.check();
}
