//! Published figures stand beside simulated ones of the same unit.

use crate::metrics::find;

/// Key and complaint if published figure `index` is given in another unit than the simulated one
/// beside which it is shown.
///
/// A metric that nobody knows is refused with its nearest known one elsewhere.
pub(crate) fn wrong_unit(index: usize, metric: &str, given: &str) -> Option<(String, String)> {
    let known = find(metric)?;
    let is_bare = known.unit == "1" && given.is_empty();
    if given == known.unit || is_bare {
        return None;
    }
    let key = format!("published[{index}].unit");
    let message = format!(
        "{key} = \"{given}\" is not the unit of {metric}: give the value in \"{}\"",
        known.unit
    );
    Some((key, message))
}
