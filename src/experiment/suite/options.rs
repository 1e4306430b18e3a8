//! How a suite is run.

use std::path::PathBuf;

use crate::baseline::{Outcome, Side};

/// Earlier results, and how those of a suite are judged by them.
#[derive(Clone, Debug)]
pub struct Earlier {
    /// The results.
    pub side: Side,
    /// Outcomes that fail.
    pub fail_on: Vec<Outcome>,
    /// Whether the suite holds all there is, so that a scenario that it lacks is gone.
    pub is_whole: bool,
}

/// How a suite is run.
#[derive(Clone, Debug)]
pub struct SuiteOptions {
    /// Folder that receives the results; made if absent.
    pub output: PathBuf,
    /// Threads, as [`thread_count`](super::thread_count) takes them.
    pub threads: usize,
    /// Whether to replace files and folders in `output` that are the user's.
    pub force: bool,
    /// Which results of an earlier suite to take over.
    pub resume: Resume,
    /// Earlier results that those of the suite are compared with.
    pub earlier: Option<Earlier>,
}

impl SuiteOptions {
    /// Runs everything into `output`, on a thread for each core, and replaces nothing of the user's.
    #[must_use]
    pub fn new(output: PathBuf) -> Self {
        Self {
            output,
            threads: 0,
            force: false,
            resume: Resume::Never,
            earlier: None,
        }
    }
}

/// Which results of an earlier suite are taken over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Resume {
    /// None: everything runs.
    Never,
    /// Those that this very build wrote, as far as its name tells: none if the build is unknown or was
    /// made of changed sources.
    SameBuild,
    /// Those of any build of this version.
    AnyBuild,
}
