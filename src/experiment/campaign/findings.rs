//! What is wrong with the groups of a file, in its own words: lines and headings.

use crate::calibration::{Finding, SCALE_ERROR_MAX, Scope};
use crate::recording::{RateUnit, RecordedGroups};

/// How far a known ratio of units may be from that of two headings: rounding.
const ROUNDING: f64 = 1e-6;

/// A finding with the lines it is about, and units as the headings name them.
pub(crate) fn complaint(finding: &Finding, recorded: &RecordedGroups) -> String {
    match finding {
        Finding::WrongUnit { ratio, scope } => {
            let lines = lines(scope, recorded);
            match readings(*ratio, recorded, ROUNDING) {
                Some(readings) => format!("{readings} {scope}{lines} (ratio {ratio:.4e})"),
                None => format!("{finding}{lines}"),
            }
        }
        Finding::UnknownRatio { ratio, scope } => {
            let readings = readings(*ratio, recorded, SCALE_ERROR_MAX);
            let readings = readings.map_or_else(String::new, |it| format!(": {it}"));
            format!("{finding}{}{readings}", lines(scope, recorded))
        }
        Finding::ReversedSense(scope) | Finding::SwappedAxes { scope, .. } => {
            format!("{finding}{}", lines(scope, recorded))
        }
        Finding::MountingMissing(_) => finding.to_string(),
    }
}

/// Lines of single groups.
fn lines(scope: &Scope, recorded: &RecordedGroups) -> String {
    let Scope::Groups(groups) = scope else {
        return String::new();
    };
    let found = groups.iter().filter_map(|number| {
        let group = recorded.groups.get(number - 1)?;
        Some(group.line.to_string())
    });
    let found: Vec<String> = found.collect();
    let plural = if found.len() > 1 { "s" } else { "" };
    format!(" (line{plural} {})", found.join(", "))
}

/// Which units the columns would have to be in for outputs and rates to agree.
fn readings(ratio: f64, recorded: &RecordedGroups, tolerance: f64) -> Option<String> {
    let [x, y, z] = recorded.output_unit;
    if x != y || y != z {
        return None;
    }
    let unit = |unit: RateUnit| unit.to_deg_per_h(1.0, 1.0);
    let of_size = |size: f64| {
        let distance = |known: &RateUnit| (unit(*known) / size).ln().abs();
        let likely = RateUnit::rates().filter(|known| distance(known) < tolerance);
        likely.min_by(|a, b| distance(a).total_cmp(&distance(b)))
    };
    let outputs = of_size(unit(x) / ratio.abs())
        .map(|meant| format!("the outputs look like {meant} under headings of {x}"));
    let stated = recorded.rate_unit;
    let rates = of_size(unit(stated) * ratio.abs())
        .map(|meant| format!("the table rates look like {meant} under a heading of {stated}"));
    let found: Vec<String> = outputs.into_iter().chain(rates).collect();
    (!found.is_empty()).then(|| found.join(", or "))
}
