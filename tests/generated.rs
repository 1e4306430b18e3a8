//! Generated files of the repository: each is what its declarations say.
//!
//! `FOGBENCH_BLESS=1 cargo test --test integration generated` writes all of them.

use crate::support::generated::generated;
use crate::support::repository;

#[test]
fn the_generated_schema_is_that_of_the_declared_keys() {
    let text = format!("{:#}\n", fogbench::scenario::json_schema());
    generated("scenarios/scenario.schema.json", &text);
}

#[test]
fn the_generated_reference_is_that_of_the_declared_keys() {
    generated(
        "scenarios/reference.toml",
        fogbench::scenario::reference_toml(),
    );
}

/// The line by which an editor finds the schema of a scenario, as taplo reads it.
const SCHEMA_LINE: &str = "#:schema ";

#[test]
fn every_schema_line_of_a_shipped_scenario_leads_to_the_generated_schema() {
    let schema = repository("scenarios/scenario.schema.json");
    let schema = schema.canonicalize().expect("the schema is checked in");
    let mut lines = 0;
    for group in ["audit", "base", "paper", "patent", "quick"] {
        let folder = repository("scenarios").join(group);
        for entry in std::fs::read_dir(&folder).expect("the folder is readable") {
            let file = entry.expect("its entries are readable").path();
            let text = std::fs::read_to_string(&file).expect("a scenario is text");
            let Some(named) = text.lines().find_map(|line| line.strip_prefix(SCHEMA_LINE)) else {
                continue;
            };
            lines += 1;
            let found = folder.join(named.trim()).canonicalize();
            assert_eq!(found.ok().as_ref(), Some(&schema), "{}", file.display());
        }
    }
    assert!(lines > 10, "{lines} lines");
}
