//! The commands, a file for each, and the selection of scenarios that several share.

pub(in crate::cli) mod budget;
pub(in crate::cli) mod calibrate;
pub(in crate::cli) mod comparison;
mod consent;
pub(in crate::cli) mod export;
pub(in crate::cli) mod infer;
pub(in crate::cli) mod log;
pub(in crate::cli) mod points;
pub(in crate::cli) mod records;
pub(in crate::cli) mod run;
pub(in crate::cli) mod scenarios;
pub(in crate::cli) mod select;
pub(in crate::cli) mod shards;
pub(in crate::cli) mod shell;
pub(in crate::cli) mod timing;
pub(in crate::cli) mod wordlength;
