//! What is wrong with the groups of a file, in its own words: lines and headings.

use crate::calibration::{Finding, Scope};
use crate::recording::{RateUnit, RecordedGroups};

/// How far the ratio of two units may be from the one found: the scale error that is believed.
const TOLERANCE: f64 = 0.1;

/// A finding with the lines it is about, and units as the headings name them.
pub(super) fn complaint(finding: &Finding, recorded: &RecordedGroups) -> String {
    match finding {
        Finding::WrongUnit { ratio, scope } => {
            let lines = lines(scope, recorded);
            match readings(*ratio, recorded) {
                Some(readings) => format!("{readings} {scope}{lines} (ratio {ratio:.4e})"),
                None => format!("{finding}{lines}"),
            }
        }
        Finding::ReversedSense(scope)
        | Finding::SwappedAxes { scope, .. }
        | Finding::UnknownRatio { scope, .. } => format!("{finding}{}", lines(scope, recorded)),
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
fn readings(ratio: f64, recorded: &RecordedGroups) -> Option<String> {
    let [x, y, z] = recorded.output_unit;
    if x != y || y != z {
        return None;
    }
    let unit = |unit: RateUnit| unit.to_deg_per_h(1.0, 1.0);
    let of_size = |size: f64| {
        let mut units = RateUnit::rates();
        units.find(|known| (unit(*known) / size - 1.0).abs() < TOLERANCE)
    };
    let outputs = of_size(unit(x) / ratio)
        .map(|meant| format!("the outputs look like {meant} under headings of {x}"));
    let rates = of_size(unit(recorded.rate_unit) * ratio).map(|meant| {
        let stated = recorded.rate_unit;
        format!("the table rates look like {meant} under a heading of {stated}")
    });
    let found: Vec<String> = outputs.into_iter().chain(rates).collect();
    (!found.is_empty()).then(|| found.join(", or "))
}
