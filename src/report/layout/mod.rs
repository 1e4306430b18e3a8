//! How text is aligned, and JSON and CSV are written.

pub(super) mod csv;
pub(super) mod json;
pub(super) mod markdown;
pub(super) mod text;
