//! Tables over several scenarios, as text, JSON and files.

pub(super) mod files;
pub(super) mod json;
pub(super) mod text;
