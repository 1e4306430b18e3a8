//! Scenarios before they run: written, checked, shown.

pub(in crate::cli) mod check;
pub(in crate::cli) mod expand;
pub(in crate::cli) mod init;
pub(in crate::cli) mod list;
pub(in crate::cli) mod reference;
pub(in crate::cli) mod schema;
