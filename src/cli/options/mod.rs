//! What the command line can be asked for: arguments, their ranges and words, and options that would do
//! nothing beside others.

pub(in crate::cli) mod arguments;
pub(in crate::cli) mod baseline;
pub(in crate::cli) mod build_server;
pub(in crate::cli) mod calibrate;
pub(in crate::cli) mod claim;
pub(in crate::cli) mod format;
pub(in crate::cli) mod hardware;
pub(in crate::cli) mod idle;
pub(in crate::cli) mod infer;
pub(in crate::cli) mod init;
pub(in crate::cli) mod layout;
pub(in crate::cli) mod log;
pub(in crate::cli) mod numbers;
pub(in crate::cli) mod points;
pub(in crate::cli) mod records;
pub(in crate::cli) mod shard;
pub(in crate::cli) mod wordlength;
pub(in crate::cli) mod words;
