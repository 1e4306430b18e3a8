//! `fogbench records`: words of a gyro with their truth, for others to publish against.

use std::io;

use crate::cli::options::records::RecordsOptions;
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;
use crate::cli::terminal::place::Place;
use crate::experiment::{RecordsError, ReferenceRecord, reference_records, write_records};
use crate::wording::counted;

/// Writes the records that are asked for, all of them by default.
pub(in crate::cli) fn records(options: &RecordsOptions) -> io::Result<Exit> {
    let place = Place::new(Some(&options.folder), "records", options.force);
    if let Err(exit) = place.check(&[]) {
        return Ok(exit);
    }
    let names = &options.names;
    let is_chosen = |record: &&ReferenceRecord| {
        names.is_empty() || names.iter().any(|name| name == record.name)
    };
    let chosen = reference_records().iter().filter(is_chosen);
    let mut failure = None;
    let filled = place.fill(|folder| {
        let staged = folder.stage()?;
        let begun = |record: &ReferenceRecord| {
            output::talk(&format!("{}: {}", record.name, record.about));
        };
        match write_records(&staged, chosen.clone(), &begun) {
            Ok(()) => {
                staged.seal_plainly()?;
                staged.put_files_in_place()
            }
            Err(RecordsError::Store(error)) => Err(error),
            Err(error) => {
                failure = Some(error);
                Ok(())
            }
        }
    });
    if let Err(exit) = filled {
        return Ok(exit);
    }
    if let Some(error) = failure {
        output::talk(&format!("error: {error}"));
        return Ok(Exit::Internal);
    }
    output::talk(&format!(
        "{} in {}; datasheet.md describes them",
        counted(chosen.count(), "record"),
        options.folder.display()
    ));
    Ok(Exit::Success)
}
