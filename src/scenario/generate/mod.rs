//! What is printed from the declarations: the reference and the JSON Schema.

pub(in crate::scenario) mod json_schema;
pub(in crate::scenario) mod problem_schema;
pub(in crate::scenario) mod reference;
pub(in crate::scenario) mod reference_part;
