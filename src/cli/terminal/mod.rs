//! What every command says and how it ends: output, complaints, exit codes, panics and signals.

pub(in crate::cli) mod complaint;
pub(in crate::cli) mod exit;
pub(in crate::cli) mod output;
pub(in crate::cli) mod panics;
pub(in crate::cli) mod place;
pub(in crate::cli) mod signals;
