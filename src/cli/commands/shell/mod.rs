//! What belongs to a shell: completions and manual pages.

pub(in crate::cli) mod completions;
pub(in crate::cli) mod man;
