//! The reference against the key table, and the laws of merging.

use std::path::PathBuf;

use proptest::prelude::*;

use super::reference_toml;
use crate::gyro::Fidelity;
use crate::scenario::config::Scenario;
use crate::scenario::document::tree::{Node, Table, Value, merge, parse_document};
use crate::scenario::keys::defaults::default_of;
use crate::scenario::keys::schema::{self, Child, Key, Kind, Presence, groups, keys};
use crate::scenario::{Resolved, ScenarioError, load_suite};
use crate::turntable::{MotionConfig, ServoConfig};

/// The least a scenario needs besides the defaults.
const LEAST: &str = "name = \"x\"\nduration_s = 20.0\n";

fn load(text: &str) -> Result<Vec<Resolved>, Vec<ScenarioError>> {
    let folder = tempfile::tempdir().unwrap();
    let file: PathBuf = folder.path().join("x.toml");
    std::fs::write(&file, text).unwrap();
    load_suite(&[file], &[])
}

/// The key a path of a file stands for.
fn key_of(schema_path: &str) -> Option<&'static Key> {
    keys().find(|key| key.path == schema_path)
}

/// The reference with the marks of all alternatives taken off, line by line.
fn enabled_lines() -> Vec<&'static str> {
    reference_toml()
        .lines()
        .map(|line| line.strip_prefix("#| ").unwrap_or(line))
        .collect()
}

/// The commented alternatives of the reference, each a document of its own.
fn alternatives() -> Vec<String> {
    let mut blocks: Vec<String> = Vec::new();
    let mut is_inside = false;
    for line in reference_toml().lines() {
        let Some(content) = line.strip_prefix("#| ") else {
            is_inside = false;
            continue;
        };
        if !is_inside {
            blocks.push(String::new());
        }
        is_inside = true;
        let block = blocks.last_mut().unwrap();
        block.push_str(content);
        block.push('\n');
    }
    blocks
}

/// Every key line or header of a keyless table with its schema path and the comment above it.
fn documented_keys() -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut table = String::new();
    let mut comment = String::new();
    for line in enabled_lines() {
        if let Some(text) = line.strip_prefix('#') {
            comment.push_str(text.trim());
            comment.push('\n');
            continue;
        }
        if let Some(header) = line.strip_prefix('[') {
            let name = header.trim_matches(['[', ']']);
            table = if line.starts_with("[[") {
                format!("{name}[]")
            } else {
                match name.split_once('.') {
                    Some((array, rest)) if matches!(array, "filter" | "gate" | "published") => {
                        format!("{array}[].{rest}")
                    }
                    _ => name.to_owned(),
                }
            };
            if key_of(&table).is_some() {
                found.push((table.clone(), std::mem::take(&mut comment)));
            }
        } else if let Some((name, _)) = line.split_once(" = ")
            && !name.starts_with('"')
        {
            found.push((schema::join(&table, name), comment.clone()));
        }
        comment.clear();
    }
    found
}

#[test]
fn reference_documents_every_key_with_its_exact_unit_and_range() {
    let documented = documented_keys();
    // A former name is read and not shown.
    for key in keys().filter(|key| key.successor.is_none()) {
        let line = key.line();
        let comments: Vec<&String> = documented
            .iter()
            .filter(|(path, _)| path == key.path)
            .map(|(_, comment)| comment)
            .collect();
        assert!(
            !comments.is_empty(),
            "{} is not in reference.toml",
            key.path
        );
        assert!(
            comments
                .iter()
                .any(|comment| comment.lines().next() == Some(line.as_str())),
            "the comment above {} must begin with: {line}",
            key.path
        );
    }
    for (path, _) in documented {
        assert!(key_of(&path).is_some(), "{path} is not a key");
    }
}

#[test]
fn reference_itself_has_no_name_and_gives_every_default() {
    let root = parse_document(0, reference_toml()).ok().unwrap();
    assert!(!root.contains_key("name"));
    for key in keys() {
        let has_default = default_of(key.path).is_some();
        let is_expected = key.presence == Presence::Defaulted;
        assert_eq!(has_default, is_expected, "{}", key.path);
    }
}

#[test]
fn reference_alone_with_a_name_and_duration_resolves() {
    let runs = load(&format!("{LEAST}{}", reference_toml())).unwrap();
    assert_eq!(runs[0].to_toml(), load(LEAST).unwrap()[0].to_toml());
}

/// A filter of a kind in fixed point, without the table of its words.
fn fixed_point(kind: &str) -> String {
    format!(
        "[[filter]]\nname = \"words\"\n[filter.{kind}]\npipeline = \"fpga\"\n\
         number_format = \"fixed\"\n"
    )
}

#[test]
fn each_alternative_of_the_reference_validates_when_enabled() {
    for block in alternatives() {
        let least: String = LEAST
            .lines()
            .filter(|line| !block.starts_with(line.split(' ').next().unwrap()))
            .map(|line| format!("{line}\n"))
            .collect();
        // Four groups of ten minutes and their pauses do not fit into twenty seconds.
        let is_campaign = block.starts_with("[turntable.calibration]");
        let least = least.replace("20.0", if is_campaign { "3180.0" } else { "20.0" });
        let base = if block.starts_with("extends") {
            "extends = \"base.toml\"\n".to_owned()
        } else if let Some(rest) = block.strip_prefix("[filter.") {
            // A table inside that of a kind acts in a filter whose words it describes.
            let kind = rest.split(['.', ']']).next().unwrap();
            format!("{}{block}", fixed_point(kind))
        } else {
            block.clone()
        };
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("base.toml"), reference_toml()).unwrap();
        let motion = "time_s,rate_deg_per_s\n0,0\n20,1\n";
        std::fs::write(folder.path().join("motion.csv"), motion).unwrap();
        let calibration = "schema = 1\n[compensation]\ntheta_xy_arcsec = 1.0\n\
            [temperature.x]\nreference_temperature_c = 25.0\nbias_deg_per_h_per_k = 0.1\n";
        std::fs::write(folder.path().join("calibration.toml"), calibration).unwrap();
        std::fs::write(folder.path().join("campaign.toml"), LEAST).unwrap();
        for named in ["y.npy", "f.py", "weights.csv", "log.csv", "segments.csv"] {
            std::fs::write(folder.path().join(named), "").unwrap();
        }
        let file = folder.path().join("x.toml");
        let extends = if base.starts_with("extends") {
            ""
        } else {
            "extends = \"base.toml\"\n"
        };
        std::fs::write(&file, format!("{least}{extends}{base}")).unwrap();
        if let Err(mut errors) = load_suite(&[file], &[]) {
            // No log is all that the keys of its reading say, some of which exclude each other.
            errors.retain(|error| !error.message.starts_with("log.file: "));
            if block.starts_with("[log]") && errors.is_empty() {
                continue;
            }
            panic!("{block}\n{errors:?}");
        }
    }
    assert!(alternatives().len() >= 12);
}

#[test]
fn the_reference_in_memory_has_the_defaults_of_the_file() {
    let run = load(LEAST).unwrap().remove(0);
    let mut built = Scenario::reference();
    built.name = "x".to_owned();
    assert_eq!(built, run.scenario);
}

#[test]
fn an_alternative_that_breaks_a_range_is_refused() {
    let block = alternatives()
        .into_iter()
        .find(|block| block.contains("frequency_hz = 5.0"))
        .unwrap();
    let broken = block.replace("frequency_hz = 5.0", "frequency_hz = -5.0");
    assert!(load(&format!("{LEAST}{broken}")).is_err());
}

#[test]
fn every_group_stands_in_a_table_that_knows_its_alternatives() {
    for group in groups() {
        for name in group.alternatives {
            assert!(
                schema::child(group.table, name).is_some(),
                "{}.{name}",
                group.table
            );
        }
    }
}

#[test]
fn a_chosen_alternative_replaces_the_default_one_and_brings_its_own_defaults() {
    let text = "[turntable.swing]\nfrequency_hz = 5.0\nangle_amplitude_deg = 1.0\n\
                [turntable.servo.second_order]\nnatural_frequency_hz = 50.0\ndamping_ratio = 0.7\n";
    let run = load(&format!("{LEAST}{text}")).unwrap().remove(0);
    let MotionConfig::Swing(swing) = &run.scenario.turntable.motion else {
        panic!("{:?}", run.scenario.turntable.motion);
    };
    assert_eq!(swing.soft_start_s.to_bits(), 1.0_f64.to_bits());
    assert!(swing.rate_amplitude_deg_per_s.is_none());
    assert!(matches!(
        run.scenario.turntable.servo,
        ServoConfig::SecondOrder(_)
    ));
    assert_eq!(run.scenario.fidelity, Fidelity::Loop);
    assert!(!run.to_toml().contains("static"));
}

#[test]
fn suggestions_prefer_the_same_table_and_are_none_when_nothing_is_near() {
    let found = crate::scenario::message::suggest::suggestions;
    assert_eq!(found("gyro.coil", "lenght_m"), ["gyro.coil.length_m"]);
    assert_eq!(found("gyro", "length_m"), ["gyro.coil.length_m"]);
    assert!(found("", "completely_different").is_empty());
}

#[test]
fn json_schema_follows_the_key_table() {
    let document = crate::scenario::json_schema();
    let length = &document["properties"]["gyro"]["properties"]["coil"]["properties"]["length_m"];
    assert_eq!(length["minimum"], 1.0);
    assert_eq!(length["maximum"], 50_000.0);
    assert_eq!(length["default"], 800.0);
    let rls = &document["properties"]["filter"]["items"]["properties"]["rls"]["properties"];
    assert_eq!(rls["taps"]["maximum"], 64);
    assert_eq!(document["additionalProperties"], false);
    for key in keys() {
        let mut at = &document;
        for name in key.path.split('.') {
            at = match name.strip_suffix("[]") {
                None => &at["properties"][name],
                Some(name) => &at["properties"][name]["items"],
            };
        }
        assert!(
            at["description"].as_str().unwrap().contains(key.unit),
            "{}",
            key.path
        );
    }
}

#[test]
fn json_schema_asks_for_what_the_reader_asks_for() {
    let document = crate::scenario::json_schema();
    let items = |name: &str| &document["properties"][name]["items"];
    let required = |name: &str| serde_json::json!({"required": [name]});
    assert_eq!(
        items("gate")["anyOf"],
        serde_json::json!([required("min"), required("max")])
    );
    let kinds = groups().iter().find(|group| group.table == "filter[]");
    let kinds = kinds.expect("filters are of one kind").alternatives;
    let one_of: Vec<_> = kinds.iter().map(|kind| required(kind)).collect();
    assert_eq!(items("filter")["oneOf"], serde_json::json!(one_of));
    assert!(kinds.len() > 2);
    let reserved = serde_json::json!({"enum": ["raw", "truth", "time_s", "encoder_arcsec"]});
    assert_eq!(document["properties"]["name"]["not"], reserved);
    assert_eq!(items("filter")["properties"]["name"]["not"], reserved);
    // A file that extends another may leave the choice to it; one that does not may not.
    let open = &document["properties"]["turntable"]["properties"]["swing"];
    let closed = &document["then"]["properties"]["turntable"]["properties"]["swing"];
    assert!(open["oneOf"].is_null() && open["not"].is_object());
    assert_eq!(closed["oneOf"].as_array().unwrap().len(), 2);
    assert_eq!(document["if"]["not"], required("extends"));
}

#[test]
fn leaves_of_the_key_table_are_no_tables() {
    for key in keys() {
        let is_prefix = |other: &&Key| other.path.starts_with(&format!("{}.", key.path));
        assert!(keys().find(is_prefix).is_none(), "{}", key.path);
        assert!(!matches!(key.kind, Kind::EmptyTable) || key.unit.is_empty());
        let (parent, name) = key.path.rsplit_once('.').unwrap_or(("", key.path));
        assert!(matches!(schema::child(parent, name), Some(Child::Leaf(_))));
    }
}

/// Trees over a small alphabet, so that keys meet; none of them is the table of a group.
fn trees() -> impl Strategy<Value = Table> {
    let leaf = any::<i64>().prop_map(|number| Node {
        value: Value::Integer(number),
        mark: None,
    });
    let node = leaf.prop_recursive(3, 24, 4, |inner| {
        prop::collection::btree_map("[a-c]", inner, 0..4).prop_map(|table| Node {
            value: table.into(),
            mark: None,
        })
    });
    prop::collection::btree_map("[a-c]", node, 0..4)
}

fn merged(mut base: Table, over: &Table) -> Table {
    merge("", &mut base, over.clone());
    base
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn merging_with_nothing_changes_nothing(tree in trees()) {
        prop_assert_eq!(&merged(tree.clone(), &Table::new()), &tree);
        prop_assert_eq!(&merged(Table::new(), &tree), &tree);
        prop_assert_eq!(&merged(tree.clone(), &tree), &tree);
    }

    #[test]
    fn the_later_value_wins_and_tables_merge_key_by_key(base in trees(), over in trees()) {
        let both = merged(base.clone(), &over);
        for (key, node) in &both {
            match (base.get(key), over.get(key)) {
                (Some(earlier), None) => prop_assert_eq!(node, earlier),
                (None, Some(later)) => prop_assert_eq!(node, later),
                (Some(earlier), Some(later)) => match (earlier.as_table(), later.as_table()) {
                    (Some(earlier), Some(later)) => {
                        prop_assert_eq!(node.as_table().unwrap(), &merged(earlier.clone(), later));
                    }
                    _ => prop_assert_eq!(node, later),
                },
                (None, None) => prop_assert!(false, "{} came from nowhere", key),
            }
        }
        prop_assert!(base.keys().chain(over.keys()).all(|key| both.contains_key(key)));
    }
}
