//! What the README promises, held to the program.

use fogbench::metrics::known_metrics;

use crate::architecture::IMPORTS;

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

#[test]
fn the_readme_shows_the_import_table() {
    for (module, imports) in IMPORTS {
        let own_row = README.lines().find(|line| {
            let first = line
                .trim_start_matches('|')
                .split('|')
                .next()
                .unwrap_or_default();
            line.starts_with('|')
                && first
                    .split_whitespace()
                    .any(|word| word == format!("`{module}`"))
        });
        let row = own_row.unwrap_or_else(|| panic!("the README has no row for `{module}`"));
        let allowed = row.split('|').nth(2).unwrap_or_default();
        if allowed.contains("downwards") || allowed.contains("all of the above") {
            continue;
        }
        for import in *imports {
            assert!(
                allowed
                    .replace('`', " ")
                    .split_whitespace()
                    .any(|word| word == *import),
                "the README's row for `{module}` does not allow `{import}`: {row}"
            );
        }
    }
}
