//! Where the parameters of a compensation come from: a file, or the scenario of a campaign.
//!
//! Both are read where the key that names them was written and take the place of that key, as the
//! table of a script does: a manifest holds them and needs no other file.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::calibration::{CompensationParameters, TemperatureParameters};
use crate::scenario::document::source::{Label, Mark, Sources, shown_path};
use crate::scenario::document::tree::{Node, Table, Value, parse_document};
use crate::scenario::message::error::{Location, ScenarioError};
use crate::scenario::message::excerpt::excerpt;
use crate::scenario::read::chain;
use crate::scenario::read::draft::Draft;
use crate::scenario::read::files::temperature_source::{self, TemperatureTables};
use crate::scenario::read::input::{self, Input};
use crate::scenario::read::resolved::{InputFile, Resolved};

/// The table of a scenario and of a calibration file.
const TABLE: &str = "compensation";
const FILE: &str = "file";
const PARAMETERS: &str = "parameters";
const CAMPAIGN: &str = "campaign";
const REFERENCE: &str = "reference_temperature_c";
const CAMPAIGN_SCENARIO: &str = "campaign_scenario";

/// The version of calibration files this build reads.
const FILE_VERSION: i64 = 1;

/// Replaces `compensation.file` by the parameters in that file and `compensation.campaign` by the
/// scenario in that file; returns the campaign, if there is one.
///
/// # Errors
/// A file that cannot be read or is no such file, at the line and column that is wrong.
pub(crate) fn read_into(
    root: &mut Table,
    sources: &mut Sources,
    inputs: &mut Vec<InputFile>,
) -> Result<Option<Arc<Resolved>>, Vec<ScenarioError>> {
    let Some(table) = root.get_mut(TABLE).and_then(Node::as_table_mut) else {
        return Ok(None);
    };
    if let Some(named) = Named::of(table, FILE, sources) {
        let node = parameters(&named, sources, inputs)?;
        table.remove(FILE);
        table.insert(PARAMETERS.to_owned(), node);
    }
    if let Some(named) = Named::of(table, CAMPAIGN, sources) {
        let campaign = campaign(&named, sources)?;
        inputs.extend(campaign.inputs.iter().cloned());
        table.remove(CAMPAIGN);
        let node = Node {
            value: Value::Text(campaign.to_toml()),
            mark: Some(named.mark),
        };
        table.insert(CAMPAIGN_SCENARIO.to_owned(), node);
        return Ok(Some(Arc::new(campaign)));
    }
    let written = table.get(CAMPAIGN_SCENARIO);
    // A value that is no text is refused with the other types.
    let Some((text, mark)) = written.and_then(|node| Some((node.as_text()?, node.mark?))) else {
        return Ok(None);
    };
    let text = text.to_owned();
    written_campaign(&text, mark, sources).map(|campaign| Some(Arc::new(campaign)))
}

/// The scenario that a calibration file is checked in where there is none: nothing of it is used.
const FRAME: &str = "schema = 1\nname = \"calibration\"\nduration_s = 1.0\n[turntable.static]\n\
                     [gyro.assembly]\n[compensation]\n";

/// Reads the parameters in a calibration file, and its digest.
///
/// # Errors
/// A file that cannot be read or is no such file, values out of range, at their line and column.
pub fn load_calibration(
    path: &Path,
) -> Result<(CompensationParameters, String), Vec<ScenarioError>> {
    let mut sources = Sources::default();
    let label = Label::of_scenario(path);
    let source = sources.add_frame(shown_path(path), FRAME.to_owned(), label.clone());
    let start = Mark { source, start: 0 };
    let named = Named {
        key: None,
        mark: start,
        path: path.to_owned(),
        label: label.clone(),
    };
    let mut inputs = Vec::new();
    let node = parameters(&named, &mut sources, &mut inputs)?;
    let mut root =
        parse_document(source, FRAME).map_err(|error| vec![sources.error(start, error.message)])?;
    if let Some(table) = root.get_mut(TABLE).and_then(Node::as_table_mut) {
        table.insert(PARAMETERS.to_owned(), node);
    }
    let resolved = Draft::of_record((root, start), sources, label.text(), inputs.clone())
        .resolve()
        .map_err(|unsound| unsound.errors)?;
    let found = resolved.scenario.compensation;
    let found = found.and_then(|compensation| compensation.parameters);
    let digest = inputs.into_iter().next().map(|input| input.digest);
    match (found, digest) {
        (Some(parameters), Some(digest)) => Ok((parameters, digest)),
        _ => Err(vec![resolved_error(path)]),
    }
}

fn resolved_error(path: &Path) -> ScenarioError {
    let location = Location::of_file(shown_path(path));
    ScenarioError::at(location, "it holds no parameters")
}

/// A file that a key or the command line names.
struct Named {
    /// The key, if it is one.
    key: Option<&'static str>,
    mark: Mark,
    path: PathBuf,
    label: Label,
}

impl Named {
    /// What `compensation.<key>` names; none if it is absent or no text.
    fn of(table: &Table, key: &'static str, sources: &Sources) -> Option<Self> {
        let node = table.get(key)?;
        let mark = node.mark?;
        let (path, label) = sources.beside(mark, node.as_text()?);
        Some(Self {
            key: Some(key),
            mark,
            path,
            label,
        })
    }

    /// A complaint at the key, or about the file.
    fn error(&self, sources: &Sources, message: &str) -> ScenarioError {
        let shown = shown_path(&self.path);
        let by_key = self.key.map(|key| format!("{TABLE}.{key} = {shown}: "));
        sources.error(self.mark, by_key.unwrap_or_default() + message)
    }

    /// The text of the file and its digest.
    fn read(&self, sources: &Sources) -> Result<Input, ScenarioError> {
        input::read(&self.path).map_err(|error| self.error(sources, &error.to_string()))
    }
}

/// The parameters in a calibration file, every value marked where it stands; what its tables say of the
/// temperature among them.
fn parameters(
    named: &Named,
    sources: &mut Sources,
    inputs: &mut Vec<InputFile>,
) -> Result<Node, Vec<ScenarioError>> {
    let Input { text, digest } = named.read(sources).map_err(|error| vec![error])?;
    let shown = shown_path(&named.path);
    let source = sources.add_file(shown, text.clone(), named.label.clone());
    inputs.push(InputFile {
        file: named.label.text(),
        digest,
    });
    let start = Mark { source, start: 0 };
    let mut root = parse_document(source, &text).map_err(|error| {
        let start = error.start;
        vec![sources.error(Mark { source, start }, error.message)]
    })?;
    if let Some(version) = root.get("schema")
        && !matches!(version.value, Value::Integer(FILE_VERSION))
    {
        let mark = version.mark.unwrap_or(start);
        let written = version.value.to_toml();
        let message = format!(
            "schema = {} is not supported: this build reads calibration files of schema \
             {FILE_VERSION}",
            excerpt(&written)
        );
        return Err(vec![sources.error(mark, message)]);
    }
    let temperature = root.remove(temperature_source::TABLE);
    match root.remove(TABLE) {
        Some(mut node) if node.as_table().is_some() => {
            if let Some(temperature) = temperature {
                let tables = temperature_source::tables_of(&temperature, start, sources)?;
                follow_temperature(&mut node, &tables, temperature.mark.unwrap_or(start));
            }
            Ok(node)
        }
        _ => {
            let message = format!(
                "this is no calibration file: expected a table [{TABLE}] with the parameters, as \
                 `fogbench calibrate` writes it"
            );
            Err(vec![sources.error(start, message)])
        }
    }
}

/// Puts what tables say of the gyros x, y, z in the place of the linear coefficients of a calibration, told at its
/// reference temperatures. Values that are no three numbers are left for the checks to refuse.
fn follow_temperature(node: &mut Node, tables: &TemperatureTables, mark: Mark) {
    type Coefficient = fn(&TemperatureParameters) -> Option<f64>;
    const KEYS: [(&str, Coefficient); 4] = [
        ("bias_deg_per_h_per_k", |it| it.bias_deg_per_h_per_k),
        ("bias_deg_per_h_per_k2", |it| it.bias_deg_per_h_per_k2),
        ("bias_deg_per_h_per_k_per_min", |it| {
            it.bias_deg_per_h_per_k_per_min
        }),
        ("scale_factor_ppm_per_k", |it| it.scale_factor_ppm_per_k),
    ];
    let Some(table) = node.as_table_mut() else {
        return;
    };
    let default = CompensationParameters::reference().reference_temperature_c;
    let Some(reference_c) = triple(table, REFERENCE, default) else {
        return;
    };
    for (key, coefficient) in KEYS {
        let Some(mut values) = triple(table, key, [0.0; 3]) else {
            continue;
        };
        let axes = values.iter_mut().zip(&tables.axes).zip(reference_c);
        for ((value, own), reference_c) in axes {
            if let Some(own) = own {
                *value = coefficient(&own.about(reference_c)).unwrap_or(0.0);
            }
        }
        let number = |value: &f64| Node {
            value: Value::Float(*value),
            mark: Some(mark),
        };
        let value = Value::Array(Arc::new(values.iter().map(number).collect()));
        let mark = Some(mark);
        table.insert(key.to_owned(), Node { value, mark });
    }
}

/// The three numbers of a key, or its default; nothing of another value.
fn triple(table: &Table, key: &str, default: [f64; 3]) -> Option<[f64; 3]> {
    let Some(node) = table.get(key) else {
        return Some(default);
    };
    let numbers = node.as_array()?.iter().map(|node| match &node.value {
        Value::Float(value) => Some(*value),
        #[expect(
            clippy::cast_precision_loss,
            reason = "whole numbers of keys are converted so"
        )]
        Value::Integer(value) => Some(*value as f64),
        _ => None,
    });
    numbers.collect::<Option<Vec<f64>>>()?.try_into().ok()
}

/// The scenario of a campaign in a file.
fn campaign(named: &Named, sources: &Sources) -> Result<Resolved, Vec<ScenarioError>> {
    if !named.path.is_file() {
        named.read(sources).map_err(|error| vec![error])?;
    }
    let draft = chain::load_campaign(&named.path, &named.label)?;
    resolve(draft)
}

/// The scenario of a campaign as a manifest holds it.
fn written_campaign(
    text: &str,
    mark: Mark,
    sources: &Sources,
) -> Result<Resolved, Vec<ScenarioError>> {
    let mut own = Sources::default();
    let shown = format!(
        "{} ({TABLE}.{CAMPAIGN_SCENARIO})",
        sources.locate(mark).file
    );
    let label = Label::of_scenario(&PathBuf::from(&shown));
    let source = own.add_file(shown, text.to_owned(), label.clone());
    let root = parse_document(source, text).map_err(|error| {
        let start = error.start;
        vec![own.error(Mark { source, start }, error.message)]
    })?;
    let start = Mark { source, start: 0 };
    resolve(Draft::of_record(
        (root, start),
        own,
        label.text(),
        Vec::new(),
    ))
}

/// Resolves a campaign; one that is a sweep or is compensated itself is refused.
fn resolve(draft: Draft) -> Result<Resolved, Vec<ScenarioError>> {
    for (key, reason) in [
        (
            "matrix",
            "a sweep: one campaign gives one set of parameters",
        ),
        (
            TABLE,
            "compensated itself: a calibration needs the outputs as they are",
        ),
    ] {
        if let Some(node) = draft.root.get(key) {
            let mark = node.mark.unwrap_or(draft.root_mark);
            let message = format!("{key}: a campaign for a compensation must not be {reason}");
            return Err(vec![draft.sources.error(mark, message)]);
        }
    }
    draft.resolve().map_err(|unsound| unsound.errors)
}
