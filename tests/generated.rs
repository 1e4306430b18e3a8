//! Generated files of the repository: each is what its declarations say.
//!
//! `FOGBENCH_BLESS=1 cargo test --test integration generated` writes all of them.

use crate::support::generated::generated;

#[test]
fn the_generated_schema_is_that_of_the_declared_keys() {
    let text = format!("{:#}\n", fogbench::scenario::json_schema());
    generated("scenarios/scenario.schema.json", &text);
}
