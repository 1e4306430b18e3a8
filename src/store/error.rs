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
    /// It stands where a record belongs, and holds none.
    NoRecord,
    /// It is a file in a place where none is replaced unasked.
    Present,
    /// It is a symbolic link.
    Link,
    /// It is a file that goes by another name as well.
    SecondName,
    /// It belongs to results of another kind.
    OtherResult,
    /// Another command writes there.
    OutputFolder,
    /// It is no folder where a folder belongs.
    NoFolder,
    /// It is no file where a file belongs.
    NoFile,
    /// It is the workshop of an output folder.
    Workshop,
}

impl fmt::Display for Foreign {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            Self::Unknown => "was not written by fogbench",
            Self::Present => "stands there already",
            Self::Changed => "was changed after fogbench wrote it",
            Self::NoRecord => "is no record that fogbench wrote, or was damaged",
            Self::Link => "is a symbolic link",
            Self::SecondName => "is a hard link to a file that goes by another name as well",
            Self::OtherResult => "belongs to results of another kind",
            Self::OutputFolder => "is an output folder of its own",
            Self::NoFolder => "stands where a folder of results belongs",
            Self::NoFile => "stands where a file of results belongs",
            Self::Workshop => "is where fogbench keeps its locks and journals",
        })
    }
}

/// A file or folder of the user's that stays as it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Spared {
    /// It.
    pub path: PathBuf,
    /// What is the matter with it.
    pub reason: Foreign,
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
    /// A file that stands alone would be replaced, and is the user's.
    #[error(
        "{} {reason}: nothing was done; choose another name{}",
        path.display(),
        if matches!(reason, Foreign::Unknown | Foreign::Present) { ", or replace it with --force" } else { "" }
    )]
    FileNotOurs {
        /// The file.
        path: PathBuf,
        /// What is the matter with it.
        reason: Foreign,
    },
    /// No folder of results can be here.
    #[error(
        "{} cannot take results: {} {reason}: nothing was done; choose another folder, or move it away",
        folder.display(), path.display()
    )]
    Obstacle {
        /// The output folder.
        folder: PathBuf,
        /// What is in the way.
        path: PathBuf,
        /// What is the matter with it.
        reason: Foreign,
    },
    /// What was to be replaced has become the user's while the command was at work.
    #[error("{}", spared_text(place, spared, kept.as_deref()))]
    Kept {
        /// Folder that was not replaced, or that holds the files that were not.
        place: PathBuf,
        /// What shows it, each of which stays as it is; one at least.
        spared: Vec<Spared>,
        /// Folder that holds what was to take its place.
        kept: Option<PathBuf>,
    },
    /// Another process writes into the folder.
    #[error("{} is in use by {holder}: wait for it, or choose another folder", folder.display())]
    InUse {
        /// The output folder.
        folder: PathBuf,
        /// Who holds its lock, in words.
        holder: String,
    },
    /// The file system refused to read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
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

fn spared_text(place: &Path, spared: &[Spared], kept: Option<&Path>) -> String {
    let reasons: Vec<String> = spared
        .iter()
        .map(|spared| format!("{} {}", spared.path.display(), spared.reason))
        .collect();
    let reasons = reasons.join("; ");
    kept.map_or_else(
        || format!("{} was not replaced, since {reasons}", place.display()),
        |kept| {
            format!(
                "{reasons}, and stays as it is; what was to take its place is in {}",
                kept.display()
            )
        },
    )
}

impl StoreError {
    /// Whether the request is refused and nothing was done, rather than the file system failing, the
    /// folder in use or something spared half way.
    #[must_use]
    pub fn is_refusal(&self) -> bool {
        matches!(
            self,
            Self::NotOurs { .. } | Self::FileNotOurs { .. } | Self::Obstacle { .. }
        )
    }

    /// What the system said of `path`, as an error.
    pub(super) fn at(path: &Path) -> impl Fn(io::Error) -> Self {
        move |source| Self::Write {
            path: path.to_owned(),
            source,
        }
    }
}
