//! The consent to start programs that files name: on this very command line, or nothing is started.

use std::collections::BTreeSet;

use crate::cli::terminal::complaint;
use crate::cli::terminal::exit::{Exit, io_failure};
use crate::cli::terminal::output;
use crate::experiment::ProgramFiles;
use crate::program::Programs;

/// The right to start programs, where it is given and needed; each is told before.
///
/// # Errors
/// A refusal, already printed, that names what would be started.
pub(super) fn consent(
    programs: impl IntoIterator<Item = ProgramFiles>,
    is_given: bool,
) -> Result<Option<Programs>, Exit> {
    // The points of a sweep share theirs.
    let programs: BTreeSet<ProgramFiles> = programs.into_iter().collect();
    if programs.is_empty() {
        return Ok(None);
    }
    if !is_given {
        let commands: Vec<String> = programs.iter().map(command).collect();
        let message = format!(
            "filters name programs, which are started only with --allow-programs on the command line: \
             {}; nothing was run",
            commands.join("; ")
        );
        complaint::print(&[message]);
        return Err(Exit::Usage);
    }
    for program in &programs {
        output::talk(&format!(
            "filter `{}` starts {}",
            program.filter,
            command(program)
        ));
        for (file, digest) in &program.files {
            output::talk(&format!("  {digest}  {}", file.display()));
        }
    }
    output::talk("  (programs that these start or import, and interpreters, have no digest here)");
    Programs::of_this_program().map(Some).map_err(io_failure)
}

/// A command as a shell would be given it.
fn command(program: &ProgramFiles) -> String {
    let parts = program.command.iter().map(|part| {
        let is_plain = |c: char| c.is_ascii_alphanumeric() || "/._-+=:,@".contains(c);
        if !part.is_empty() && part.chars().all(is_plain) {
            part.clone()
        } else {
            format!("'{}'", part.escape_debug())
        }
    });
    parts.collect::<Vec<_>>().join(" ")
}
