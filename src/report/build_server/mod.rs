//! What build servers read of a suite: JUnit, annotations, a summary in Markdown, metrics for Bencher.

pub(super) mod bencher;
pub(super) mod github;
pub(super) mod junit;
pub(super) mod markdown;
mod place;
