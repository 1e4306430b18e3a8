//! Published figures stand beside simulated ones of the same unit.

use crate::metrics::find;
use crate::scenario::PublishedConfig;

/// Key and complaint if published figure `index` is given in another unit than the simulated one
/// beside which it is shown.
///
/// A metric that nobody knows is refused with its nearest known one elsewhere.
pub(crate) fn wrong_unit(
    index: usize,
    metric: &str,
    figure: &PublishedConfig,
) -> Option<(String, String)> {
    let known = find(metric)?;
    let given = figure.unit.as_str();
    let unit = match figure.relative_to {
        Some(_) => "1",
        None => known.unit,
    };
    let is_bare = unit == "1" && given.is_empty();
    if given == unit || is_bare {
        return None;
    }
    let key = format!("published[{index}].unit");
    let message = format!(
        "{key} = \"{given}\" is not the unit of {metric}: give the value in \"{}\"",
        unit
    );
    Some((key, message))
}
