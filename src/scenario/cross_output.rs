//! Checks across the keys of the rate word.

use super::error::ScenarioError;
use super::gyro_config::OutputQuantisation;
use super::resolved::Resolved;

/// Every complaint about a gyro whose single values are all in order.
pub(crate) fn check(resolved: &Resolved) -> Vec<ScenarioError> {
    output_quantisation(resolved).into_iter().collect()
}

/// A step of the output that would change something must not stand where nothing reads it.
fn output_quantisation(resolved: &Resolved) -> Option<ScenarioError> {
    let (unread, written, other) = match resolved.scenario.gyro.output.quantisation {
        OutputQuantisation::RateWord => ("angle_lsb_arcsec", "rate-word", "angle-carry"),
        OutputQuantisation::AngleCarry => ("rate_lsb_deg_per_s", "angle-carry", "rate-word"),
    };
    let path = format!("gyro.output.{unread}");
    let value = resolved.departure(&path, &path)?;
    let message = format!(
        "{path} = {value} has no effect: quantisation = \"{written}\" does not read it; set \
         quantisation = \"{other}\" or leave the key out"
    );
    Some(ScenarioError::at(resolved.locate(&path), message))
}
