//! What reads the same as a claimed reduction of noise, as text and JSON.

use std::fmt::Write as _;

use serde_json::json;

use crate::gate::{plain, three_digits};
use crate::metrics::{Claim, ClaimedFigure, Lookalikes};
use crate::report::layout::json::pretty;
use crate::report::layout::text::wrapped;

/// Columns of the text.
const WIDTH: usize = 100;

/// A claim for people; with the rate of the words, how many taps the mean has.
#[must_use]
pub fn claim_text(claim: &Claim, rate_hz: Option<f64>) -> String {
    let (name, unit) = match claim.figure {
        ClaimedFigure::AngleRandomWalk => ("ARW", "deg/sqrt(h)"),
        ClaimedFigure::BiasStability => ("bias stability", "deg/h"),
    };
    let mut text = format!(
        "{name} {} -> {} {unit}, read at {} s",
        plain(claim.before),
        plain(claim.after),
        plain(claim.averaging_time_s)
    );
    let Some(found) = claim.lookalikes() else {
        text.push_str(": none, it is not lower than before\n");
        return text;
    };
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        ": {} % of it is left. This reads the same:",
        three_digits(100.0 * claim.ratio())
    );
    for line in lines(claim.figure, &found, rate_hz) {
        text.push_str(&wrapped(&line, "  ", WIDTH));
    }
    text
}

/// What reads the same, the simplest first.
fn lines(figure: ClaimedFigure, found: &Lookalikes, rate_hz: Option<f64>) -> [String; 4] {
    let taps = rate_hz.map_or_else(String::new, |rate_hz| {
        let rate = plain(rate_hz);
        match found.mean_taps(rate_hz) {
            Some(taps) => format!(", {} taps at {rate} Hz", plain(taps)),
            None => format!(", for which words at {rate} Hz are too slow"),
        }
    });
    let none = match figure {
        ClaimedFigure::AngleRandomWalk => "if the ARW was fitted well beyond the filter's memory",
        ClaimedFigure::BiasStability => {
            "if the averaging time is well beyond the filter's memory and the noise is white"
        }
    };
    [
        format!(
            "a DC gain of {}: every rate is lowered with the noise",
            three_digits(found.dc_gain)
        ),
        format!(
            "on white noise, a one-pole low pass with a time constant of {} s (half power at {} Hz), \
             delay {} s",
            three_digits(found.one_pole_time_constant_s),
            three_digits(found.one_pole_cutoff_hz()),
            three_digits(found.one_pole_time_constant_s)
        ),
        format!(
            "on white noise, a mean over {} s{taps}, delay {} s",
            three_digits(found.mean_length_s),
            three_digits(found.mean_delay_s(rate_hz))
        ),
        format!("none, {none}: a low pass of unit DC gain leaves it as it was"),
    ]
}

/// A claim as JSON; without `lookalikes` where nothing is lower than before.
#[must_use]
pub fn claim_json(claim: &Claim, rate_hz: Option<f64>) -> String {
    let figure = match claim.figure {
        ClaimedFigure::AngleRandomWalk => "angle_random_walk_deg_per_sqrt_h",
        ClaimedFigure::BiasStability => "bias_stability_deg_per_h",
    };
    let mut document = json!({
        "figure": figure,
        "before": claim.before,
        "after": claim.after,
        "ratio": claim.ratio(),
        "averaging_time_s": claim.averaging_time_s,
        "verdict": "none",
    });
    if let Some(found) = claim.lookalikes() {
        let mut mean = json!({
            "length_s": found.mean_length_s,
            "delay_s": found.mean_delay_s(rate_hz),
        });
        if let Some(rate_hz) = rate_hz {
            mean["taps"] = found.mean_taps(rate_hz).into();
            mean["rate_hz"] = rate_hz.into();
        }
        document["verdict"] = "reads-the-same".into();
        document["lookalikes"] = json!({
            "dc_gain": found.dc_gain,
            "one_pole": {
                "time_constant_s": found.one_pole_time_constant_s,
                "cutoff_hz": found.one_pole_cutoff_hz(),
                "delay_s": found.one_pole_time_constant_s,
            },
            "mean": mean,
            "low_pass_beyond_its_memory": "none",
        });
    }
    pretty(&document)
}
