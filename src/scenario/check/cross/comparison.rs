//! Checks of the tables that close the suite: names that refer to one another.

use crate::scenario::config::ComparisonColumn;
use crate::scenario::document::address::{self, AddressError};
use crate::scenario::keys::schema::Kind;
use crate::scenario::read::resolved::Resolved;

/// Key and complaint of everything that refers to nothing.
pub(in crate::scenario) fn check(resolved: &Resolved) -> Vec<(String, String)> {
    let scenario = &resolved.scenario;
    let names: Vec<&str> = scenario
        .comparisons
        .iter()
        .map(|comparison| comparison.name.as_str())
        .collect();
    let mut complaints = Vec::new();
    for (index, comparison) in scenario.comparisons.iter().enumerate() {
        let slug = slug(&comparison.name);
        let is_taken = names[..index].iter().any(|name| self::slug(name) == slug);
        if is_taken || slug.is_empty() {
            let key = format!("comparison[{index}].name");
            let message = format!(
                "{key} = \"{}\" gives no file name of its own (`{slug}`): use other letters and digits",
                comparison.name
            );
            complaints.push((key, message));
        }
        if let Some(written) = &comparison.per_change_of
            && let Err(error) = numeric(resolved, written)
        {
            let key = format!("comparison[{index}].per_change_of");
            complaints.push((key.clone(), format!("{key}: {error}")));
        }
        for column in &comparison.columns {
            if ComparisonColumn::parse(column).is_none() {
                let key = format!("comparison[{index}].columns");
                let message = format!(
                    "{key}: \"{column}\" is neither <channel>.<metric> nor <channel>.<metric> / <channel>"
                );
                complaints.push((key, message));
            }
        }
    }
    let rows = scenario.comparison_rows.iter().enumerate();
    let of_rows = rows.map(|(index, row)| {
        let key = format!("comparison_row[{index}].comparison");
        (key, Some(row.comparison.as_str()))
    });
    let assumptions = scenario.assumptions.iter().enumerate();
    let of_assumptions = assumptions.map(|(index, assumption)| {
        let key = format!("assumption[{index}].comparison");
        (key, assumption.comparison.as_deref())
    });
    for (key, name) in of_rows.chain(of_assumptions) {
        if let Some(name) = name.filter(|name| !names.contains(name)) {
            let known = names.join(", ");
            let message = format!(
                "{key} = \"{name}\": there is no comparison of that name: expected one of {known}"
            );
            complaints.push((key, message));
        }
    }
    for (index, assumption) in scenario.assumptions.iter().enumerate() {
        // A scenario may put other filters in the place of its base's.
        let is_of_a_filter = assumption.key.starts_with("filter.");
        if let Err(error) = address::resolve(resolved.tree(), &assumption.key)
            && !is_of_a_filter
        {
            let key = format!("assumption[{index}].key");
            complaints.push((key.clone(), format!("{key}: {error}")));
        }
    }
    complaints
}

/// Why a metric has no change for each unit of a key.
#[derive(Debug, thiserror::Error)]
enum ChangeError {
    #[error("{0} is not a number")]
    NotANumber(String),
    #[error(transparent)]
    Address(#[from] AddressError),
}

/// Whether a key stands for a number; one of a filter may be another scenario's.
fn numeric(resolved: &Resolved, written: &str) -> Result<(), ChangeError> {
    match address::resolve(resolved.tree(), written) {
        Ok((_, Some(key))) if matches!(key.kind, Kind::Float(_) | Kind::Integer(_)) => Ok(()),
        Ok(_) => Err(ChangeError::NotANumber(written.to_owned())),
        Err(_) if written.starts_with("filter.") => Ok(()),
        Err(error) => Err(error.into()),
    }
}

/// A name as part of a file name: small letters and digits, everything else a hyphen.
pub(crate) fn slug(name: &str) -> String {
    let lower = name.to_lowercase();
    let words = lower.split(|c: char| !c.is_ascii_alphanumeric());
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    words.join("-")
}
