//! Keys that only work together: raises the share of drawn scenarios that run.

use super::draft::{Draft, FILE, Line};
use super::schema::{self, Table};
use super::values::{Setting, quoted, toml, value};
use crate::support::seeded::Draws;

/// Index of an element behind all that are drawn.
const LAST: usize = 1000;

/// Mends what would be refused for sure, most of the time.
pub(crate) fn apply(draft: &mut Draft, draws: &mut Draws, schema: &Table, setting: Setting) {
    if draws.chance(0.06) {
        unstable_filter(draft, draws);
    }
    if draws.chance(0.1) {
        return;
    }
    let has = |draft: &Draft, prefix: &str| {
        let mut lines = draft.lines.iter();
        lines.any(|line| line.schema_path.starts_with(prefix))
    };
    if has(draft, "turntable.calibration.") {
        campaign(draft, draws, setting);
    }
    if has(draft, "turntable.scale_factor_test.") {
        scale_factor_test(draft, draws, setting);
    }
    if has(draft, "turntable.trapezoid.") {
        trapezoid(draft, draws, setting);
    }
    let needs_assembly = has(draft, "turntable.calibration.") || has(draft, "compensation.");
    if needs_assembly && !has(draft, "gyro.assembly.") {
        let path = "gyro.assembly.theta_xy_arcsec";
        if let Some(leaf) = schema::leaves(schema).get(path)
            && let Some(angle) = value(draws, leaf, setting)
        {
            draft.lines.push(line(path, angle));
        }
    }
}

fn line(path: &str, value: String) -> Line {
    Line {
        schema_path: path.to_owned(),
        element: None,
        key: path.to_owned(),
        value,
        part: FILE.to_owned(),
        stem: None,
        is_needed: false,
        blamed: 0,
    }
}

/// A filter that diverges, half of the time with the gate that expects it.
fn unstable_filter(draft: &mut Draft, draws: &mut Draws) {
    let mut element = |array: &str, key: &str, value: &str| {
        draft.lines.push(Line {
            schema_path: format!("{array}[].{key}"),
            element: Some((array.to_owned(), LAST)),
            key: key.to_owned(),
            value: value.to_owned(),
            part: format!("unstable {array}"),
            stem: None,
            is_needed: true,
            blamed: 0,
        });
    };
    element("filter", "name", "\"unstable\"");
    element("filter", "lms.normalised", "false");
    element("filter", "lms.allow_unstable", "true");
    element("filter", "lms.step_size", "2.0");
    if draws.chance(0.5) {
        element("gate", "metric", "\"unstable.diverged_at_s\"");
        element("gate", "min", "0.0");
        element("gate", "decide", "\"value\"");
    }
}

/// Groups enough to find twelve parameters, short enough for the record.
fn campaign(draft: &mut Draft, draws: &mut Draws, setting: Setting) {
    let each = 2 + draws.below(5);
    let groups = 3 * each;
    let axes = (0..groups).map(|index| quoted(["x", "y", "z"][index / each]));
    let rates = (0..groups).map(|index| {
        let rate = draws.log_uniform(1e-3, 195.0);
        toml(match index % 3 {
            0 => rate,
            1 => -rate,
            _ if draws.chance(0.5) => 0.0,
            _ => rate,
        })
    });
    let rates: Vec<String> = rates.collect();
    let axes: Vec<String> = axes.collect();
    let path = |name: &str| format!("turntable.calibration.{name}");
    draft.set(&path("axes"), format!("[{}]", axes.join(", ")));
    draft.set(&path("rates_deg_per_s"), format!("[{}]", rates.join(", ")));
    // A mean takes forty samples and a ramp eight, at four thousand in a second.
    let slot_s = (setting.duration_s / groups as f64).max(0.04);
    draft.set("duration_s", toml(slot_s * groups as f64));
    draft.set(
        &path("record_s"),
        toml(slot_s * draws.log_uniform(0.3, 0.6)),
    );
    for name in ["change_s", "remount_s"] {
        draft.set(&path(name), toml(slot_s * draws.log_uniform(0.15, 0.35)));
    }
    if draft.value(&path("whole_turns")).is_none() && draws.chance(0.9) {
        draft
            .lines
            .push(line(&path("whole_turns"), "false".to_owned()));
    }
    if draws.chance(0.7) {
        // These two need no change of temperature.
        let estimator = quoted(draws.pick::<&str>(&["batch", "arls"]));
        for (key, value) in [
            ("calibration.estimators", format!("[{estimator}]")),
            ("calibration.apply", estimator),
        ] {
            draft.lines.retain(|line| line.key != key);
            draft.lines.push(line(key, value));
        }
    }
}

/// Enough preferred numbers between the rates, dwells that fit.
fn scale_factor_test(draft: &mut Draft, draws: &mut Draws, setting: Setting) {
    let from = draws.log_uniform(1e-4, 10.0);
    let path = |name: &str| format!("turntable.scale_factor_test.{name}");
    draft.set(&path("from_deg_per_s"), toml(from));
    let to = (from * draws.log_uniform(1e2, 1e4)).min(2000.0);
    draft.set(&path("to_deg_per_s"), toml(to));
    // Up to 2 x 40 rates and two rests, each with a time to settle.
    let slot_s = setting.duration_s / 100.0;
    for name in ["dwell_s", "static_s", "settle_s"] {
        draft.set(&path(name), toml(slot_s * draws.log_uniform(0.3, 1.0)));
    }
    draft.set(&path("dwell_max_s"), toml(slot_s * 2.0));
}

/// Ramps of some samples, cycles that fit.
fn trapezoid(draft: &mut Draft, draws: &mut Draws, setting: Setting) {
    let path = |name: &str| format!("turntable.trapezoid.{name}");
    let sign = if draws.chance(0.5) { 1.0 } else { -1.0 };
    let rate = draws.log_uniform(1e-3, 2000.0);
    let ramp_s = setting.duration_s * draws.log_uniform(0.01, 0.2);
    draft.set(&path("rate_deg_per_s"), toml(sign * rate));
    draft.set(
        &path("acceleration_deg_per_s2"),
        toml((rate / ramp_s).min(1e6)),
    );
    for name in ["hold_s", "rest_s"] {
        draft.set(&path(name), toml(setting.duration_s * draws.unit() * 0.1));
    }
}

/// Does what a complaint says would help, if it says so and one is in the mood; whether it did.
pub(crate) fn way_out(draft: &mut Draft, draws: &mut Draws, message: &str) -> bool {
    if message.contains("[gyro.assembly]") && draws.chance(0.8) {
        draft
            .lines
            .push(line("gyro.assembly.theta_xy_arcsec", "0.0".to_owned()));
        return true;
    }
    let Some((_, offer)) = message.rsplit_once("use ") else {
        return false;
    };
    let Some((key, rest)) = offer.split_once(" = \"") else {
        return false;
    };
    let Some((word, _)) = rest.split_once('"') else {
        return false;
    };
    if draft.value(key).is_none() || !draws.chance(0.7) {
        return false;
    }
    draft.set(key, quoted(word));
    true
}
