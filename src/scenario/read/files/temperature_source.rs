//! The tables `[temperature]` of a calibration file: what the temperature does to one gyro, or to the three of an
//! assembly.
//!
//! ```toml
//! [temperature]                   # one gyro
//! reference_temperature_c = 25.0
//! bias_deg_per_h_per_k = 0.05
//!
//! [temperature.x]                 # gyro x of an assembly
//! reference_temperature_c = 25.0
//! scale_factor_ppm_per_k = 20.0
//! ```

use std::path::Path;
use std::sync::OnceLock;

use crate::calibration::TemperatureParameters;
use crate::declare::{Key, Keys};
use crate::recording::LogFormat;
use crate::scenario::check::leaf::check_leaf;
use crate::scenario::document::deserialize::from_table;
use crate::scenario::document::source::{Label, Mark, Sources, shown_path};
use crate::scenario::document::tree::{Node, Table, parse_document};
use crate::scenario::message::error::{Location, ScenarioError};
use crate::scenario::message::suggest::unknown_in_table;
use crate::scenario::read::input;
use crate::vocabulary::{CaseAxis, Word};

/// The table of a calibration file.
pub(super) const TABLE: &str = "temperature";
/// Of a table: what is said of where it is from.
const PROVENANCE: &str = "provenance";
/// The key that every table has.
const REFERENCE: &str = "reference_temperature_c";

/// What a calibration file says of the temperature.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct TemperatureTables {
    /// Of one gyro alone.
    pub gyro: Option<TemperatureParameters>,
    /// Of the gyros x, y, z of an assembly.
    pub axes: [Option<TemperatureParameters>; 3],
}

impl TemperatureTables {
    /// The table of one gyro alone, or of an axis of an assembly.
    #[must_use]
    pub fn of(&self, axis: Option<CaseAxis>) -> Option<&TemperatureParameters> {
        match axis {
            Some(axis) => self.axes[axis as usize].as_ref(),
            None => self.gyro.as_ref(),
        }
    }

    /// Name of the table of an axis, or of one gyro alone.
    #[must_use]
    pub fn name(axis: Option<CaseAxis>) -> String {
        axis.map_or_else(|| TABLE.to_owned(), |axis| format!("{TABLE}.{axis}"))
    }

    /// What to do where the table that is wanted is not there.
    fn way_out(&self) -> String {
        let of_axes = CaseAxis::ALL.iter().map(|axis| Some(*axis));
        let mut all = std::iter::once(None).chain(of_axes);
        match all.find(|axis| self.of(*axis).is_some()) {
            Some(Some(axis)) => {
                let there = Self::name(Some(axis));
                format!(": [{there}] is there, and --axis {axis} takes it")
            }
            Some(None) => format!(": [{TABLE}] is there: leave --axis out"),
            None => {
                ": `fogbench analyze` with --temperature-column and --temperature-model writes one of a \
                 log in which the temperature changes"
                    .to_owned()
            }
        }
    }
}

/// What the calibration of a log of one gyro lacks: it would do nothing.
#[derive(Debug, thiserror::Error)]
enum IdleCalibration {
    #[error("it has no effect without --calibration: leave it out")]
    Axis,
    #[error(
        "it takes the effect of the temperature out of the words of one gyro: --temperature-column names its \
         column"
    )]
    Temperature,
    #[error("it holds no table [{wanted}]{way_out}")]
    Table { wanted: String, way_out: String },
}

/// The coefficients of the temperature that the calibration of a log of one gyro has, and the digest of the file;
/// nothing of a log without one.
///
/// # Errors
/// As [`load_temperature`]; a calibration that does nothing, or has no table of the gyro.
pub fn load_log_temperature(
    format: &LogFormat,
) -> Result<Option<(TemperatureParameters, String)>, Vec<ScenarioError>> {
    let refuse = |place: &str, error: IdleCalibration| {
        let location = Location::of_file(place.to_owned());
        vec![ScenarioError::at(location, error.to_string())]
    };
    let Some(file) = &format.calibration else {
        return Ok(None);
    };
    if format.temperature_column.is_none() {
        return Err(refuse("--calibration", IdleCalibration::Temperature));
    }
    let path = Path::new(file);
    let (tables, digest) = load_temperature(path)?;
    match tables.of(format.axis) {
        Some(found) => Ok(Some((found.clone(), digest))),
        None => {
            let wanted = TemperatureTables::name(format.axis);
            let way_out = tables.way_out();
            let error = IdleCalibration::Table { wanted, way_out };
            Err(refuse(&shown_path(path), error))
        }
    }
}

/// Refuses an axis of a log that nothing asks for.
///
/// # Errors
/// An axis without a calibration.
pub(super) fn check_axis(format: &LogFormat) -> Result<(), ScenarioError> {
    if format.axis.is_none() || format.calibration.is_some() {
        return Ok(());
    }
    let location = Location::of_file("--axis".to_owned());
    Err(ScenarioError::at(
        location,
        IdleCalibration::Axis.to_string(),
    ))
}

/// Reads what a calibration file says of the temperature, which may be nothing, and its digest.
///
/// # Errors
/// A file that cannot be read, values out of range, keys that are not known, at their line and column.
pub fn load_temperature(path: &Path) -> Result<(TemperatureTables, String), Vec<ScenarioError>> {
    let shown = shown_path(path);
    let text = input::read(path).map_err(|error| {
        let location = Location::of_file(shown.clone());
        vec![ScenarioError::at(location, error.to_string())]
    })?;
    let mut sources = Sources::default();
    let source = sources.add_file(shown, text.text.clone(), Label::of_scenario(path));
    let at = |start: usize| Mark { source, start };
    let root = parse_document(source, &text.text)
        .map_err(|error| vec![sources.error(at(error.start), error.message)])?;
    let Some(node) = root.get(TABLE) else {
        return Ok((TemperatureTables::default(), text.digest));
    };
    tables_of(node, at(0), &sources).map(|tables| (tables, text.digest))
}

/// The tables below `[temperature]`.
pub(super) fn tables_of(
    node: &Node,
    start: Mark,
    sources: &Sources,
) -> Result<TemperatureTables, Vec<ScenarioError>> {
    let mut reader = Reader {
        sources,
        errors: Vec::new(),
    };
    let mark = node.mark.unwrap_or(start);
    let mut tables = TemperatureTables::default();
    match node.as_table() {
        Some(table) => {
            let mut own = table.clone();
            own.remove(PROVENANCE);
            for (axis, found) in CaseAxis::ALL.iter().zip(&mut tables.axes) {
                if let Some(inner) = own.remove(axis.word()) {
                    let name = TemperatureTables::name(Some(*axis));
                    *found = reader.parameters(&name, &inner, mark);
                }
            }
            if !own.is_empty() || table.is_empty() {
                tables.gyro = reader.checked(TABLE, &own, mark);
            }
        }
        None => reader.complain(
            mark,
            format!("{TABLE} has the wrong type: expected a table"),
        ),
    }
    match reader.errors.is_empty() {
        true => Ok(tables),
        false => Err(reader.errors),
    }
}

/// Reads tables, and keeps what is wrong with them.
struct Reader<'a> {
    sources: &'a Sources,
    errors: Vec<ScenarioError>,
}

impl Reader<'_> {
    fn complain(&mut self, mark: Mark, message: String) {
        self.errors.push(self.sources.error(mark, message));
    }

    /// The parameters of a table by its name.
    fn parameters(
        &mut self,
        name: &str,
        node: &Node,
        above: Mark,
    ) -> Option<TemperatureParameters> {
        let mark = node.mark.unwrap_or(above);
        let Some(table) = node.as_table() else {
            self.complain(mark, format!("{name} has the wrong type: expected a table"));
            return None;
        };
        let mut table = table.clone();
        table.remove(PROVENANCE);
        self.checked(name, &table, mark)
    }

    /// The parameters of a table whose values are checked.
    fn checked(&mut self, name: &str, table: &Table, mark: Mark) -> Option<TemperatureParameters> {
        let before = self.errors.len();
        for (key, node) in table {
            let place = node.mark.unwrap_or(mark);
            let shown = format!("{name}.{key}");
            match keys().iter().find(|known| known.path == key) {
                Some(known) => {
                    if let Err(fault) = check_leaf(known, &shown, node) {
                        self.complain(fault.mark.unwrap_or(place), fault.to_string());
                    }
                }
                None => {
                    let known = keys().iter().map(|known| known.path);
                    self.complain(place, unknown_in_table(&shown, key, known));
                }
            }
        }
        if !table.contains_key(REFERENCE) {
            let message = format!(
                "{name}.{REFERENCE} is required: expected the temperature that the coefficients are told at"
            );
            self.complain(mark, message);
        }
        if self.errors.len() > before {
            return None;
        }
        match from_table(table) {
            Ok(parameters) => Some(parameters),
            Err(error) => {
                self.complain(mark, format!("{name}: {error}"));
                None
            }
        }
    }
}

fn keys() -> &'static [Key] {
    static KEYS: OnceLock<Keys> = OnceLock::new();
    &KEYS
        .get_or_init(|| Keys::of(&TemperatureParameters::TABLE))
        .keys
}
