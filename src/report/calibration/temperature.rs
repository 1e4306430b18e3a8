//! What the temperature does to a gyro, as a table of a calibration file.
//!
//! Everything else in the file stays as it stands, comments included: the table is cut out of the text and
//! written at its end, and what the file holds is compared before and after.

use std::fmt::Write as _;

use toml::{Table, Value};

use crate::report::calibration::documents::quoted;
use crate::report::layout::json::SCHEMA;
use crate::scenario::{TemperatureParameters, TemperatureTables};
use crate::vocabulary::CaseAxis;

/// The table of a calibration file, and those below it that belong to gyros of an assembly.
const TABLE: &str = "temperature";
/// The table that `fogbench calibrate` writes.
const COMPENSATION: &str = "compensation";

/// Coefficients of the temperature of one gyro, and where they come from.
#[derive(Clone, Copy, Debug)]
pub struct TemperatureReport<'a> {
    /// Version of the tool.
    pub tool_version: &'a str,
    /// Name of the log, without its folder.
    pub file: &'a str,
    /// Its column, where it has several.
    pub column: Option<&'a str>,
    /// The gyro of an assembly that it is; none of a gyro alone.
    pub axis: Option<CaseAxis>,
    /// Significant coefficients, the others 0, with the temperatures of the log.
    pub parameters: &'a TemperatureParameters,
}

/// Why there is no such table.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TemperatureTableError {
    /// Nothing to write.
    #[error(
        "no coefficient of the temperature is significant: it takes --temperature-column, and a log in which \
         the temperature changes"
    )]
    NoCoefficient,
    /// The file is no TOML.
    #[error("the file that stands there is no TOML: {0}")]
    NoToml(toml::de::Error),
    /// The table is written in a way that is not cut out.
    #[error(
        "[{0}] of the file that stands there is not a table of lines of its own: take it out by hand"
    )]
    Kept(String),
}

/// Whether a text is a calibration file, which may be written again with another table.
#[must_use]
pub fn is_calibration_toml(text: &str) -> bool {
    let document: Option<Table> = text.parse().ok();
    document.is_some_and(|it| it.contains_key(COMPENSATION) || it.contains_key(TABLE))
}

/// A calibration file with the table of a gyro, in place of one that it has.
///
/// * `file`: its text, nothing of a new one.
///
/// # Errors
/// A file that is no TOML, or whose table does not stand in lines of its own.
pub fn with_temperature(
    file: &str,
    report: &TemperatureReport,
) -> Result<String, TemperatureTableError> {
    let name = TemperatureTables::name(report.axis);
    let before: Table = file.parse().map_err(TemperatureTableError::NoToml)?;
    let mut text = without_table(file, &name);
    if before.is_empty() {
        text = format!("schema = {SCHEMA}\n");
    }
    let own = table(&name, report);
    text.push('\n');
    text.push_str(&own);
    let rest = |mut document: Table| {
        take_out(&mut document, report.axis);
        document
    };
    let is_kept = text
        .parse::<Table>()
        .is_ok_and(|after| before.is_empty() || rest(after) == rest(before));
    match is_kept {
        true => Ok(text),
        false => Err(TemperatureTableError::Kept(name)),
    }
}

/// The table as text.
fn table(name: &str, report: &TemperatureReport) -> String {
    let parameters = toml::to_string(report.parameters);
    let mut text = format!(
        "[{name}]\n# A word is (1 + k (T - T0)) W + b1 (T - T0) + b2 (T - T0)^2 + s dT/dt: T0, b1, b2, s and k.\n{}",
        parameters.expect("a flat table of numbers is TOML")
    );
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "\n[{name}.provenance]\ntool = \"fogbench {}\"\nlog = {}",
        report.tool_version,
        quoted(report.file)
    );
    if let Some(column) = report.column {
        let _ = writeln!(text, "column = {}", quoted(column));
    }
    text
}

/// A text without the lines of a table and of the provenance below it, and without the empty lines at its end.
fn without_table(file: &str, name: &str) -> String {
    let provenance = format!("{name}.provenance");
    let mut is_own = false;
    let mut text = String::new();
    for line in file.lines() {
        if let Some(head) = line.trim_start().strip_prefix('[') {
            let head = head.split(']').next().unwrap_or_default().trim();
            is_own = head == name || head == provenance;
        }
        if !is_own {
            text.push_str(line);
            text.push('\n');
        }
    }
    text.truncate(text.trim_end().len());
    text.push('\n');
    text
}

/// Takes the table of a gyro out of a document: of a gyro alone all but the tables of an assembly.
fn take_out(document: &mut Table, axis: Option<CaseAxis>) {
    let Some(Value::Table(all)) = document.get_mut(TABLE) else {
        return;
    };
    match axis {
        Some(axis) => {
            all.remove(axis.word());
        }
        None => all.retain(|key, _| key.parse::<CaseAxis>().is_ok()),
    }
    if all.is_empty() {
        document.remove(TABLE);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signal::TemperatureModel;

    fn report(axis: Option<CaseAxis>, slope: f64) -> String {
        let model = TemperatureModel {
            reference_temperature_c: 25.0,
            bias_deg_per_h_per_k: slope,
            ..TemperatureModel::default()
        };
        let parameters = TemperatureParameters::of(&model, [Some(-10.0), Some(60.0)]);
        let of = |file: &str| {
            let report = TemperatureReport {
                tool_version: "1.2.3",
                file: "warm.csv",
                column: None,
                axis,
                parameters: &parameters,
            };
            with_temperature(file, &report)
        };
        of(FILE).unwrap()
    }

    const FILE: &str = "# Mine.\nschema = 1\n[compensation]\nbias_deg_per_h = [1.0, 2.0, 3.0] # b\n\n\
                        [temperature]\nreference_temperature_c = 20.0\n\n[temperature.y]\n\
                        reference_temperature_c = 30.0\n\n[provenance]\nfile = \"groups.csv\"\n";

    #[test]
    fn a_table_is_replaced_and_all_else_stays_as_it_stands() {
        let text = report(None, 0.05);
        for kept in [
            "# Mine.\n",
            "3.0] # b\n",
            "[temperature.y]\n",
            "\"groups.csv\"\n",
        ] {
            assert!(text.contains(kept), "{text}");
        }
        assert!(
            !text.contains("20.0") && text.contains("bias_deg_per_h_per_k = 0.05\n"),
            "{text}"
        );
        let beside = report(Some(CaseAxis::X), 0.07);
        assert!(
            beside.contains("= 20.0\n") && beside.contains("[temperature.x]\n"),
            "{beside}"
        );
        let other = report(Some(CaseAxis::Y), 0.07);
        assert!(
            !other.contains("= 30.0\n") && other.contains("= 20.0\n"),
            "{other}"
        );
    }

    #[test]
    fn a_table_in_other_words_is_not_lost() {
        let parameters =
            TemperatureParameters::of(&TemperatureModel::default(), [Some(0.0), Some(1.0)]);
        let report = TemperatureReport {
            tool_version: "1.2.3",
            file: "warm.csv",
            column: Some("gyro, \"z\""),
            axis: None,
            parameters: &parameters,
        };
        let dotted = "temperature.reference_temperature_c = 20.0\n[compensation]\n";
        let error = with_temperature(dotted, &report).unwrap_err().to_string();
        assert!(error.starts_with("[temperature] of the file"), "{error}");
        let inside = "[compensation]\nnote = \"\"\"\n[temperature]\n\"\"\"\n";
        assert!(with_temperature(inside, &report).is_err());
        let new = with_temperature("", &report).unwrap();
        assert!(new.starts_with("schema = 1\n\n[temperature]\n"), "{new}");
        assert!(
            is_calibration_toml(&new) && !is_calibration_toml("schema = 1\n"),
            "{new}"
        );
    }
}
