//! Texts of a scenario that refer to something: channels, metrics, names, files.

use fogbench::metrics::known_metrics;

use super::draft::Draft;
use super::schema::{self, Kind, Leaf, Table};
use super::values::{length, quoted, word_array};
use crate::support::seeded::Draws;

/// Words with everything that a report must escape.
const WORDS: [&str; 8] = [
    "plain",
    "two words",
    "a, b; \"c\"",
    "<b>&amp;</b>",
    "\u{e9}\u{3a9}\u{6f22}",
    "tab\there",
    "line\nbreak",
    "= 1 + 1 | x",
];

/// A value of a text, an array of words or a table of the schema's own.
pub(crate) fn value(
    draws: &mut Draws,
    draft: &Draft,
    schema: &Table,
    (schema_path, index): (&str, Option<usize>),
    leaf: &Leaf,
) -> Option<String> {
    let channels = [vec!["raw".to_owned()], draft.names("filter")].concat();
    let last = schema_path.rsplit('.').next().unwrap_or(schema_path);
    let known = draft.names("comparison");
    let text = match (last, schema_path) {
        (_, "extends" | "matrix" | "compensation.file" | "compensation.campaign") => return None,
        (_, "turntable.script.file") => "motion.csv".to_owned(),
        (_, "compensation.campaign_scenario") => campaign(draws),
        (_, "filter[].name") => format!("f{}", index.unwrap_or(0)),
        ("metric", _) => metric(draws, &channels),
        ("relative_to", _) => draws.pick(&channels).clone(),
        ("columns", _) => {
            let columns: Vec<String> = (0..length(draws))
                .map(|_| metric(draws, &channels))
                .collect();
            let count = columns.len();
            return Some(word_array(draws, &columns, count));
        }
        ("scenarios", _) => return Some(word_array(draws, &["case".to_owned()], 1)),
        ("scenario", _) => "case".to_owned(),
        ("comparison", _) if !known.is_empty() => draws.pick(&known).clone(),
        ("name", _) => format!("Table {}", index.unwrap_or(0)),
        ("file", _) => "rate.svg".to_owned(),
        ("unit", _) => draws.pick(known_metrics()).unit.to_owned(),
        ("key" | "per_change_of", _) => key(draws, schema),
        _ if matches!(leaf.kind, Kind::Text) => (*draws.pick(&WORDS)).to_owned(),
        _ => return None,
    };
    Some(quoted(&text))
}

/// `<channel>.<metric>`.
fn metric(draws: &mut Draws, channels: &[String]) -> String {
    let metric = draws.pick(known_metrics()).name;
    format!("{}.{metric}", draws.pick(channels))
}

/// Any key of the schema outside arrays.
fn key(draws: &mut Draws, schema: &Table) -> String {
    let leaves = schema::leaves(schema);
    let keys: Vec<&String> = leaves.keys().filter(|key| !key.contains('[')).collect();
    (*draws.pick(&keys)).clone()
}

/// A calibration campaign of a second.
fn campaign(draws: &mut Draws) -> String {
    let rate_deg_per_s = draws.log_uniform(1.0, 150.0);
    format!(
        "schema = 1\nname = \"campaign\"\nduration_s = 1.0\nwarm_up_s = 0.1\nfidelity = \"rate\"\n\
         [gyro.assembly]\n[turntable.calibration]\n\
         axes = [\"x\", \"x\", \"x\", \"y\", \"y\", \"y\", \"z\", \"z\", \"z\"]\n\
         rates_deg_per_s = [{0}, -{0}, 0.0, {0}, -{0}, 0.0, {0}, -{0}, 0.0]\n\
         record_s = 0.07\nchange_s = 0.02\nremount_s = 0.04\nwhole_turns = false\n\
         [calibration]\napply = \"batch\"\nestimators = [\"batch\"]\n",
        super::values::toml(rate_deg_per_s)
    )
}
