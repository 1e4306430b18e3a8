//! Checks across the keys of the compensation.

use crate::scenario::config::Scenario;
use crate::scenario::config::channels::COMPENSATED;

/// Every complaint about a compensation whose single values are all in order.
pub(crate) fn check(scenario: &Scenario) -> Vec<(String, String)> {
    if scenario.compensation.is_none() {
        return Vec::new();
    }
    let mut complaints = Vec::new();
    if scenario.gyro.assembly.is_none() {
        let message = "compensation needs three gyros: there is no [gyro.assembly]; describe one, \
                       or leave the compensation out";
        complaints.push(("compensation".to_owned(), message.to_owned()));
    }
    let names = scenario.filters.iter().map(|filter| &filter.name);
    for index in names
        .enumerate()
        .filter(|(_, name)| *name == COMPENSATED)
        .map(|(index, _)| index)
    {
        let key = format!("filter[{index}].name");
        let message = format!(
            "{key} = \"{COMPENSATED}\" is the name of the compensated outputs: give the filter \
             another"
        );
        complaints.push((key, message));
    }
    complaints
}
