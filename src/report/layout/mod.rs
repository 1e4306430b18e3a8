//! How text is aligned and JSON is written.

pub(super) mod json;
pub(super) mod text;
