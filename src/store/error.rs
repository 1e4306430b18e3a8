//! Why results are not written.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// What makes a file or folder the user's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Foreign {
    /// No record tells of it.
    Unknown,
    /// Its digest is not the recorded one.
    Changed,
    /// It is a symbolic link.
    Link,
    /// It belongs to results of another kind.
    OtherResult,
    /// It is no folder where a folder belongs.
    NoFolder,
    /// It is no file where a file belongs.
    NoFile,
}

impl fmt::Display for Foreign {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            Self::Unknown => "was not written by fogbench",
            Self::Changed => "was changed after fogbench wrote it",
            Self::Link => "is a symbolic link",
            Self::OtherResult => "belongs to results of another kind",
            Self::NoFolder => "stands where a folder of results belongs",
            Self::NoFile => "stands where a file of results belongs",
        })
    }
}

/// Why results are not written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StoreError {
    /// What would be replaced is the user's.
    #[error(
        "{} would be replaced, but {} {reason}: nothing was done; choose another folder, or \
         replace it with --force",
        folder.display(), path.display()
    )]
    NotOurs {
        /// Folder or file that would be replaced.
        folder: PathBuf,
        /// The file, link or folder that shows it.
        path: PathBuf,
        /// What is the matter with it.
        reason: Foreign,
    },
    /// Another process writes into the folder.
    #[error("{} is in use by {holder}: wait for it, or choose another folder", folder.display())]
    InUse {
        /// The output folder.
        folder: PathBuf,
        /// Who holds its lock, in words.
        holder: String,
    },
    /// The file system refused.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
}

impl StoreError {
    /// Whether the request is refused, rather than the file system failing or the folder in use.
    #[must_use]
    pub fn is_refusal(&self) -> bool {
        matches!(self, Self::NotOurs { .. })
    }

    /// What the system said of `path`, as an error.
    pub(super) fn at(path: &Path) -> impl Fn(io::Error) -> Self {
        move |source| Self::Write {
            path: path.to_owned(),
            source,
        }
    }
}
