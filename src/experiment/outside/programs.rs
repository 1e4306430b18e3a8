//! Which programs a scenario would start, and what is told of them before.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use super::{Outside, OutsideFilter};
use crate::filters::ProcessFilterConfig;
use crate::program::Launch;
use crate::scenario::{NamedFile, Resolved};

/// A program that a filter would start.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub struct ProgramFiles {
    /// Name of the filter.
    pub filter: String,
    /// Program and arguments as they are started, files as absolute paths.
    pub command: Vec<String>,
    /// Files of the command and its inputs, with their BLAKE3 digests.
    pub files: Vec<(PathBuf, String)>,
}

/// The programs that the filters of a scenario would start.
#[must_use]
pub fn program_files(resolved: &Resolved) -> Vec<ProgramFiles> {
    let filters = resolved.scenario.filters.iter().enumerate();
    let programs = filters.filter_map(|(index, filter)| {
        let Some(Outside::Process(config)) = Outside::of(&filter.kind) else {
            return None;
        };
        let program = OutsideFilter::of_log(resolved, index);
        let command = program.launch(config).command.into_iter();
        let command = command.map(|part| part.to_string_lossy().into_owned());
        let files = program.files(config).into_iter();
        Some(ProgramFiles {
            filter: filter.name.clone(),
            command: command.collect(),
            files: files
                .map(|file| (file.path.clone(), file.digest.clone()))
                .collect(),
        })
    });
    programs.collect()
}

impl<'a> OutsideFilter<'a> {
    /// What a program is started as.
    pub(super) fn launch(&self, config: &ProcessFilterConfig) -> Launch {
        let mut command: Vec<OsString> = Vec::new();
        for (index, argument) in config.command.iter().enumerate() {
            let file = self.file(&format!("command[{index}]"));
            command.push(match (file, index) {
                (Some(file), _) => file.path.clone().into(),
                (None, 0) => absolute_program(argument).into(),
                (None, _) => argument.into(),
            });
        }
        let inputs = self.inputs(config).into_iter();
        Launch {
            command,
            inputs: inputs.map(|file| file.path.clone()).collect(),
            start_timeout_s: config.start_timeout_s,
            timeout_s: config.timeout_s,
            memory_mb: config.memory_mb,
        }
    }

    /// Files that the program finds in its folder.
    fn inputs(&self, config: &ProcessFilterConfig) -> Vec<&'a NamedFile> {
        let count = config.inputs.as_ref().map_or(0, Vec::len);
        let inputs = (0..count).filter_map(|index| self.file(&format!("inputs[{index}]")));
        inputs.collect()
    }

    /// Files of the command, and those that the program finds in its folder.
    fn files(&self, config: &ProcessFilterConfig) -> Vec<&'a NamedFile> {
        let arguments = 0..config.command.len();
        let mut files: Vec<&NamedFile> = arguments
            .filter_map(|index| self.file(&format!("command[{index}]")))
            .collect();
        files.extend(self.inputs(config));
        files
    }
}

/// A program as the system would find it: in the folders of PATH where it is a mere name.
fn absolute_program(program: &str) -> PathBuf {
    let is_name = Path::new(program).components().count() == 1;
    let path = std::env::var_os("PATH").filter(|_| is_name);
    let folders = path.iter().flat_map(std::env::split_paths);
    let mut files = folders.map(|folder| folder.join(program));
    files
        .find(|file| is_executable(file))
        .unwrap_or_else(|| program.into())
}

#[cfg(unix)]
fn is_executable(file: &Path) -> bool {
    use std::os::unix::fs::PermissionsExt as _;
    let metadata = file.metadata();
    metadata.is_ok_and(|found| found.is_file() && found.permissions().mode() & 0o111 != 0)
}

#[cfg(not(unix))]
fn is_executable(file: &Path) -> bool {
    file.is_file()
}
