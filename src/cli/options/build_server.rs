//! Options of `run` for build servers.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

/// Build servers that mark lines of files by what a job prints.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Annotations {
    /// GitHub Actions
    Github,
}

/// What a build server gets of a suite.
#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct BuildServerOptions {
    /// Write the JUnit verdict to FILE, with wall times
    #[arg(long, value_name = "FILE")]
    pub(in crate::cli) junit: Option<PathBuf>,
    /// Print failures as the annotations of a build server; on stderr where stdout is JSON
    #[arg(long, value_enum, value_name = "SERVER")]
    pub(in crate::cli) annotations: Option<Annotations>,
    /// Write the verdict in Markdown to FILE, as for the page of a job
    #[arg(long, value_name = "FILE")]
    pub(in crate::cli) summary_markdown: Option<PathBuf>,
    /// Write every metric to FILE in the Bencher Metric Format
    #[arg(long, value_name = "FILE")]
    pub(in crate::cli) bmf: Option<PathBuf>,
}
