//! What the README promises, held to the program.

use fogbench::metrics::known_metrics;

const README: &str = include_str!("../README.md");

#[test]
fn the_readme_defines_every_metric() {
    let missing: Vec<String> = known_metrics()
        .iter()
        .map(|known| {
            format!(
                "| `{}` | {} | {} |",
                known.name, known.unit, known.definition
            )
        })
        .filter(|row| !README.contains(row.as_str()))
        .collect();
    assert!(
        missing.is_empty(),
        "rows missing from the README:\n{}",
        missing.join("\n")
    );
}
