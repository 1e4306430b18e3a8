//! A comparison with earlier results as text, JSON and Markdown.

pub(super) mod json;
pub(super) mod markdown;
pub(super) mod rows;
pub(super) mod text;
