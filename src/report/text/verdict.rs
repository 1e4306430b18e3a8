//! The verdict on a filter in words.

use crate::gate::{estimate_text, plain};
use crate::metrics::catalogue::{
    ADAPTATION_MEMORY, DELAY_AT_REST, DELAY_UNDER_SWING, GLITCH_RESPONSE, LASTING_RATE_GAIN,
    LINEARITY_ERROR, LOOK_AHEAD, MEMORY_0P1_PERCENT, MEMORY_1_PERCENT,
    NOISE_DELAY_BOUND_NOISE_GAIN, READAPTATION_TIME, SATURATION_GAIN, SINE_GAIN, START_UP,
    STEP_GAIN_1S, STEP_GAIN_10S, STEP_GAIN_100S, SWING_READAPTATION, TIME_INVARIANCE_ERROR,
    TWIN_MEAN_RATIO,
};
use crate::metrics::{
    AgainstOne, ChannelMetrics, Deed, Estimate, FilterVerdict, Finding, MetricKey, REACHES_START,
    filter_verdict,
};

/// Digits of an interval's half width.
const DIGITS: i32 = 2;

/// One sentence on what a filter does, from the intervals of its metrics; `None` for raw and for
/// channels that failed.
pub(crate) fn verdict_text(channel: &ChannelMetrics) -> Option<String> {
    let verdict = filter_verdict(channel)?;
    let mut noise = [fast_noise(&verdict), slow_noise(&verdict)];
    if is_attenuation(&verdict) {
        // What a lower angle random walk is worth stands first.
        noise.reverse();
    }
    let [first, second] = noise;
    let clauses = [
        Some(head(&verdict)),
        first,
        second,
        inside_memory(&verdict),
        verdict.delay_ms.as_ref().map(delay),
        bound(channel, &verdict),
        readaptation(channel, &verdict),
    ];
    let clauses = clauses.into_iter().flatten();
    let clauses: Vec<String> = clauses.chain(black_box(channel)).collect();
    Some(clauses.join("; "))
}

/// An estimate; one without an interval to three decimals, if it has a digit there.
fn text(estimate: &Estimate) -> String {
    let is_exact = estimate.high - estimate.low <= 1e-9 * estimate.value.abs();
    if is_exact && estimate.value.abs() >= 0.1 {
        plain((estimate.value * 1e3).round() / 1e3)
    } else {
        estimate_text(estimate, DIGITS)
    }
}

fn is(finding: Option<Finding>, against_one: AgainstOne) -> bool {
    finding.is_some_and(|finding| finding.against_one == against_one)
}

/// Whether slow noise is lower because the input is, and for no other reason.
fn is_attenuation(verdict: &FilterVerdict) -> bool {
    matches!(verdict.deed, Deed::Attenuates | Deed::AttenuatesAndSmooths)
        && is(verdict.slow_noise, AgainstOne::Equal)
}

/// What it does, with the gains.
fn head(verdict: &FilterVerdict) -> String {
    let level = verdict.motion_gain.or(verdict.dc_gain);
    let what = match verdict.deed {
        _ if level.is_some_and(|gain| gain.estimate.high < 0.0) => "inverts the sign of its input",
        Deed::Attenuates => "reduces noise by attenuating the input",
        _ if is_attenuation(verdict) => "reduces noise by attenuating the input",
        Deed::AttenuatesAndSmooths => "reduces noise by attenuating the input and smoothing it",
        Deed::Smooths => "reduces fast noise by smoothing",
        Deed::Reduces => "reduces noise; whether by attenuating the input cannot be told",
        Deed::Passes => "leaves fast noise as it is",
        Deed::Raises => "raises noise",
        Deed::Undecided => "cannot be told to change fast noise",
        Deed::NotJudged => "noise not judged",
    };
    // Weights that adapt may have had another gain before the motion settled.
    let of_dc = match verdict.motion_gain {
        Some(_) => "DC gain over the record",
        None => "DC gain",
    };
    let gains = [
        ("gain for the motion", verdict.motion_gain),
        (of_dc, verdict.dc_gain),
    ];
    let gains: Vec<String> = gains
        .into_iter()
        .filter_map(|(name, gain)| Some(format!("{name} {}", text(&gain?.estimate))))
        .collect();
    if gains.is_empty() {
        what.to_owned()
    } else {
        format!("{what}: {}", gains.join(", "))
    }
}

/// Whether the scale factor needs restoring.
fn is_scaled(verdict: &FilterVerdict) -> bool {
    is(verdict.level(), AgainstOne::Below) || is(verdict.level(), AgainstOne::Above)
}

fn fast_noise(verdict: &FilterVerdict) -> Option<String> {
    let ratio = text(&verdict.fast_noise?.estimate);
    let restored = verdict.fast_noise_restored.filter(|_| is_scaled(verdict));
    let restored = restored.map_or_else(String::new, |restored| {
        let by = if verdict.deed == Deed::AttenuatesAndSmooths && is_attenuation(verdict) {
            ", by smoothing too"
        } else {
            ""
        };
        format!(", {} at restored scale{by}", text(&restored.estimate))
    });
    let what = if verdict.deed == Deed::Raises {
        "times its power"
    } else {
        "of its power"
    };
    Some(format!("fast noise {ratio} {what}{restored}"))
}

fn slow_noise(verdict: &FilterVerdict) -> Option<String> {
    let ratio = verdict.slow_noise?;
    let scale = if is_scaled(verdict) {
        " at restored scale"
    } else {
        ""
    };
    let what = match ratio.against_one {
        AgainstOne::Below => "lowered",
        AgainstOne::Equal => "unchanged",
        AgainstOne::Above => "raised by wandering weights",
        AgainstOne::Undecided => "not told apart from raw's",
    };
    let walk = verdict.walk_restored_deg_per_sqrt_h;
    let what = match walk.map(|walk| text(&walk)) {
        Some(walk) => format!("ARW{scale} {walk} deg/sqrt(h), {what}"),
        None => format!("slow noise{scale} {what}"),
    };
    let at = verdict
        .slow_noise_averaging_time_s
        .map_or_else(String::new, |time_s| format!(" at {} s", plain(time_s)));
    let ratio = text(&ratio.estimate);
    Some(format!("{what} (Allan deviation{at} over raw's: {ratio})"))
}

/// What an angle random walk read at 1 s would seem to gain, in the words of `claim`.
fn inside_memory(verdict: &FilterVerdict) -> Option<String> {
    let ratio = verdict.inside_memory?;
    let scale = if is_scaled(verdict) {
        " at restored scale"
    } else {
        ""
    };
    // What wandering weights or attenuation change beyond the memory, the slow noise says.
    let beyond =
        if is(verdict.slow_noise, AgainstOne::Below) || is(verdict.slow_noise, AgainstOne::Above) {
            ""
        } else {
            "; none of it is gained if the ARW is fitted well beyond the memory"
        };
    (ratio.against_one == AgainstOne::Below).then(|| {
        format!(
            "read at 1 s, inside its memory, ARW{scale} is {} of raw's, and a DC gain of that reads the \
             same{beyond}",
            text(&ratio.estimate)
        )
    })
}

fn delay(delay_ms: &Estimate) -> String {
    if delay_ms.high < 0.0 {
        let lead = Estimate::with_interval(-delay_ms.value, -delay_ms.high, -delay_ms.low);
        format!("leads by {} ms", text(&lead))
    } else {
        format!("delays by {} ms", text(delay_ms))
    }
}

/// How long it takes to learn a motion that began within the record.
fn readaptation(channel: &ChannelMetrics, verdict: &FilterVerdict) -> Option<String> {
    if let Some(time_s) = verdict.readaptation_s {
        return Some(format!(
            "passes the new motion to 1 % after {} s",
            text(&time_s)
        ));
    }
    let reason = channel.why_unavailable(&READAPTATION_TIME)?;
    let bound = reason.starts_with("not within the record");
    bound.then(|| format!("does not learn the new motion: {reason}"))
}

/// What a figure of twins is called in the verdict: key, words before and after its value.
const CLAUSES: [(&MetricKey, &str, &str); 17] = [
    (&MEMORY_1_PERCENT, "remembers a word for ", " s to 1 %"),
    (&MEMORY_0P1_PERCENT, "", " s to 0.1 %"),
    (&DELAY_AT_REST, "delays a word by ", " ms"),
    (&DELAY_UNDER_SWING, "a swing by ", " ms"),
    (&START_UP, "starts within ", " s"),
    (&ADAPTATION_MEMORY, "has learned a small step after ", " s"),
    (&SWING_READAPTATION, "a swing after ", " s"),
    (&TWIN_MEAN_RATIO, "mean out over mean in ", ""),
    (&STEP_GAIN_1S, "gain for a small step over 1 s ", ""),
    (&STEP_GAIN_10S, "gain over 10 s ", ""),
    (&STEP_GAIN_100S, "gain over 100 s ", ""),
    (&SINE_GAIN, "gain for a small slow sine ", ""),
    (
        &LASTING_RATE_GAIN,
        "gain for a small rate from the first word on ",
        "",
    ),
    (
        &SATURATION_GAIN,
        "least gain for large steps over the largest ",
        "",
    ),
    (&LINEARITY_ERROR, "departs from a linear filter by ", ""),
    (
        &TIME_INVARIANCE_ERROR,
        "from one that does not change by ",
        "",
    ),
    (&GLITCH_RESPONSE, "passes ", " of a single word far outside"),
];

/// What twins of the record show, one clause for each, and one for each reason why others are lacking; nothing
/// where none ran.
fn black_box(channel: &ChannelMetrics) -> Vec<String> {
    let known = CLAUSES.iter().filter_map(|(key, before, after)| {
        let value = text(&channel.get(key)?.estimate);
        Some(format!("{before}{value}{after}"))
    });
    let keys = CLAUSES.iter().map(|(key, _, _)| *key);
    let keys: Vec<&MetricKey> = [&LOOK_AHEAD].into_iter().chain(keys).collect();
    let why = |key: &MetricKey| channel.why_unavailable(key);
    let lacking = keys.iter().enumerate().filter_map(|(at, key)| {
        let reason = why(key)?;
        let is_first = keys[..at]
            .iter()
            .all(|earlier| why(earlier) != Some(reason));
        let same = keys.iter().filter(|other| why(other) == Some(reason));
        let titles: Vec<String> = same.map(|other| other.title()).collect();
        is_first.then(|| format!("{}: {reason}", titles.join(", ")))
    });
    look_ahead(channel)
        .into_iter()
        .chain(known)
        .chain(lacking)
        .collect()
}

/// How far the filter looks ahead.
fn look_ahead(channel: &ChannelMetrics) -> Option<String> {
    let ahead = channel.get(&LOOK_AHEAD)?;
    if ahead.estimate.value <= 0.0 {
        return Some("looks at no word ahead".to_owned());
    }
    let reaches_start = ahead
        .fields
        .get(REACHES_START)
        .is_some_and(|all| *all > 0.0);
    let at_least = if reaches_start { "at least " } else { "" };
    Some(format!(
        "looks {at_least}{} samples ahead",
        text(&ahead.estimate)
    ))
}

/// Noise against the least that unit DC gain allows.
fn bound(channel: &ChannelMetrics, verdict: &FilterVerdict) -> Option<String> {
    let over = verdict.over_bound?;
    let ratio = text(&over.estimate);
    let least = least(channel);
    Some(match over.against_one {
        AgainstOne::Below if is(verdict.level(), AgainstOne::Below) => {
            format!("its noise is {ratio} of {least}: signal was removed with it")
        }
        AgainstOne::Below => {
            format!(
                "its noise is {ratio} of {least} and fixed weights: its weights follow the noise"
            )
        }
        AgainstOne::Equal => format!("its noise is {ratio} times {least}, as good as that"),
        AgainstOne::Above => format!("its noise is {ratio} times {least}"),
        AgainstOne::Undecided => format!("its noise is not told apart from {least}"),
    })
}

/// The least noise in words, with the samples that reach it where they are known.
fn least(channel: &ChannelMetrics) -> String {
    let fields = channel.get(&NOISE_DELAY_BOUND_NOISE_GAIN);
    let field = |name: &str| fields.and_then(|metric| metric.fields.get(name).copied());
    let taps = match field("taps").zip(field("first_age_samples")) {
        Some((taps, first)) => format!(
            "{} consecutive taps (ages {} to {})",
            plain(taps),
            plain(first),
            plain(first + taps - 1.0)
        ),
        None => "as many consecutive taps".to_owned(),
    };
    format!(
        "the least that {taps} allow at this delay with unit DC gain (sparse ones may do better)"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::Metric;
    use crate::metrics::catalogue::DC_GAIN;

    fn words(entries: &[(&str, f64, f64)]) -> String {
        let metrics = entries.iter().map(|(name, low, high)| {
            let estimate = Estimate::with_interval(0.5 * (low + high), *low, *high);
            let metric = Metric::new(estimate, "1").with("averaging_time_s", 1.0);
            ((*name).to_owned(), metric)
        });
        let channel = ChannelMetrics {
            metrics: metrics.collect(),
            ..ChannelMetrics::default()
        };
        verdict_text(&channel).expect("a filter has a verdict")
    }

    #[test]
    fn attenuation_is_called_attenuation() {
        let said = words(&[
            ("dc_gain", 0.49, 0.49),
            ("noise_gain", 0.11, 0.13),
            ("weight_noise_ratio", 0.98, 1.02),
            (
                "angle_random_walk_over_dc_gain_deg_per_sqrt_h",
                0.0059,
                0.0061,
            ),
            ("delay_at_dc_ms", 0.75, 0.75),
            ("noise_gain_over_bound", 0.37, 0.43),
        ]);
        assert_eq!(
            said,
            "reduces noise by attenuating the input: DC gain 0.49; ARW at restored scale 0.00600 \
             ±0.00010 deg/sqrt(h), unchanged (Allan deviation at 1 s over raw's: 1.000 ±0.020); fast \
             noise 0.120 ±0.010 of its power, 0.500 ±0.042 at restored scale, by smoothing too; \
             delays by 0.75 ms; its noise is 0.400 ±0.030 of the least that as many consecutive taps \
             allow at this delay with unit DC gain (sparse ones may do better): signal was removed with \
             it"
        );
    }

    #[test]
    fn what_is_read_inside_the_memory_is_no_gain() {
        let said = words(&[
            ("dc_gain", 1.0, 1.0),
            ("noise_gain", 0.1, 0.12),
            ("weight_noise_ratio", 0.99, 1.01),
            ("allan_ratio_inside_memory", 0.69, 0.73),
        ]);
        let words_of_claim = "; read at 1 s, inside its memory, ARW is 0.710 ±0.020 of raw's, and a DC \
                              gain of that reads the same; none of it is gained if the ARW is fitted \
                              well beyond the memory";
        assert!(said.contains(words_of_claim), "{said}");
        let open = words(&[
            ("dc_gain", 1.0, 1.0),
            ("allan_ratio_inside_memory", 0.9, 1.1),
        ]);
        assert!(!open.contains("inside its memory"), "{open}");
    }

    #[test]
    fn what_twins_show_has_a_clause_each() {
        let said = words(&[
            ("dc_gain", 1.0, 1.0),
            ("look_ahead_samples", 3.0, 3.0),
            ("memory_1_percent_s", 0.25, 0.25),
            ("step_gain_1s", 0.5, 0.5),
            ("linearity_error", 0.2, 0.2),
        ]);
        assert!(
            said.ends_with(
                "; looks 3 samples ahead; remembers a word for 0.25 s to 1 %; gain for a small \
                 step over 1 s 0.5; departs from a linear filter by 0.2"
            ),
            "{said}"
        );
        assert!(said.contains("DC gain 0.5"), "{said}");
    }

    #[test]
    fn what_twins_leave_out_for_one_reason_has_one_clause() {
        let mut channel = ChannelMetrics::default();
        channel.put(&DC_GAIN, Estimate::exact(1.0));
        channel.miss(&LINEARITY_ERROR, "nobody asked for it");
        channel.miss(&STEP_GAIN_10S, "the record is short");
        channel.miss(&GLITCH_RESPONSE, "nobody asked for it");
        let said = verdict_text(&channel).expect("a filter has a verdict");
        assert!(
            said.ends_with(
                "; step gain, 10 s: the record is short; linearity error, glitch response: \
                 nobody asked for it"
            ),
            "{said}"
        );
    }

    #[test]
    fn smoothing_raising_and_doubt_are_told_apart() {
        let smooths = words(&[
            ("dc_gain", 1.0, 1.0),
            ("noise_gain", 0.48, 0.52),
            ("weight_noise_ratio", 0.99, 1.01),
        ]);
        assert!(smooths.starts_with("reduces fast noise by smoothing: DC gain 1; "));
        assert!(smooths.contains("slow noise unchanged"), "{smooths}");
        let raises = words(&[("amplitude_ratio", 1.0, 1.0), ("noise_gain", 1.2, 1.4)]);
        assert!(
            raises.starts_with("raises noise: gain for the motion 1; "),
            "{raises}"
        );
        assert!(raises.contains("fast noise 1.30 ±0.10 times its power"));
        let doubt = words(&[("dc_gain", 1.0, 1.0), ("noise_gain", 0.8, 1.2)]);
        assert!(doubt.starts_with("cannot be told to change fast noise"));
        let wanders = words(&[("dc_gain", 1.0, 1.0), ("weight_noise_ratio", 1.2, 1.4)]);
        assert!(wanders.starts_with("noise not judged: DC gain 1; "));
        assert!(wanders.contains("raised by wandering weights"), "{wanders}");
        let leads = words(&[("dc_gain", 1.0, 1.0), ("delay_vs_raw_ms", -0.2, -0.1)]);
        assert!(leads.ends_with("leads by 0.150 ±0.050 ms"), "{leads}");
    }
}
