//! The commands, a file for each, and the selection of scenarios that several share.

pub(in crate::cli) mod baseline;
pub(in crate::cli) mod budget;
pub(in crate::cli) mod calibrate;
pub(in crate::cli) mod check;
pub(in crate::cli) mod claim;
pub(in crate::cli) mod compare;
pub(in crate::cli) mod completions;
mod consent;
pub(in crate::cli) mod expand;
pub(in crate::cli) mod export;
pub(in crate::cli) mod infer;
pub(in crate::cli) mod init;
pub(in crate::cli) mod list;
pub(in crate::cli) mod log;
pub(in crate::cli) mod man;
pub(in crate::cli) mod reference;
pub(in crate::cli) mod run;
pub(in crate::cli) mod schema;
pub(in crate::cli) mod select;
pub(in crate::cli) mod timing;
