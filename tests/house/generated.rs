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

#[test]
fn the_generated_schema_of_problems_is_that_of_the_declared_tables() {
    let text = format!("{:#}\n", fogbench::scenario::problem_schema());
    generated("scenarios/infer/problem.schema.json", &text);
}

/// The page of the keys of problems, but for what stands above them.
fn problem_page() -> String {
    let mut page = String::from(
        "# Keys of a problem\n\nGenerated from the declarations: what a file of \
         [`fogbench infer`](infer.md) may hold. `[]` is an element of an array of tables.\n",
    );
    for key in fogbench::scenario::problem_keys() {
        page.push_str(&format!(
            "\n- `{} = {}`: {} {}\n",
            key.path,
            key.literal,
            key.sentence(),
            key.line()
        ));
    }
    page
}

#[test]
fn the_generated_page_of_problems_is_that_of_the_declared_tables() {
    generated("docs/problem.md", &problem_page());
}

/// The line by which an editor finds the schema of a scenario, as taplo reads it.
const SCHEMA_LINE: &str = "#:schema ";

#[test]
fn every_shipped_scenario_begins_with_a_line_that_leads_to_the_generated_schema() {
    let checked_in = |name: &str| {
        let schema = repository(name).canonicalize();
        schema.expect("the schema is checked in")
    };
    let of_scenarios = checked_in("scenarios/scenario.schema.json");
    let of_problems = checked_in("scenarios/infer/problem.schema.json");
    let mut folders = vec![repository("scenarios")];
    let mut files = 0;
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("the folder is readable") {
            let file = entry.expect("its entries are readable").path();
            if file.is_dir() {
                folders.push(file);
            } else if file
                .extension()
                .is_some_and(|extension| extension == "toml")
            {
                let text = std::fs::read_to_string(&file).expect("a scenario is text");
                let named = text
                    .lines()
                    .next()
                    .and_then(|line| line.strip_prefix(SCHEMA_LINE));
                let found = named.and_then(|named| folder.join(named.trim()).canonicalize().ok());
                let is_problem = file.parent() == of_problems.parent();
                let schema = if is_problem {
                    &of_problems
                } else {
                    &of_scenarios
                };
                assert_eq!(found.as_ref(), Some(schema), "{}", file.display());
                files += 1;
            }
        }
    }
    assert!(files > 10, "{files} files");
}
