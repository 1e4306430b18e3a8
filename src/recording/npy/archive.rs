//! NPZ archives: arrays under names, stored or deflated.

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use zip::ZipArchive;
use zip::result::ZipError;

use super::array;
use super::gather::{Gather, PlacedWord, each_word};
use super::heading::ArrayHeading;
use crate::recording::column::Columns;
use crate::recording::error::LogError;
use crate::recording::input::Input;
use crate::recording::layout::Fault;
use crate::recording::layout::Layout;
use crate::recording::layout::columns::{Selection, choose};
use crate::recording::log::format::LogFormat;
use crate::recording::text::lines::listed;
use crate::recording::text::table::Wanted;

/// First bytes of an archive.
const MAGIC: &[u8] = b"PK\x03\x04";
/// End of the name of an array.
const ARRAY: &str = ".npy";
/// Most bytes of an array, which is unpacked as a whole.
const ARRAY_BYTES_MAX: u64 = 1 << 31;

/// Why an archive is not read.
#[derive(Debug, thiserror::Error)]
enum ArchiveError {
    #[error(
        "an archive on a pipe: write it into a file first, as its list of arrays stands at its end"
    )]
    Pipe,
    #[error("not a whole NPZ archive, or packed otherwise than numpy.savez does: {0}")]
    Zip(#[from] ZipError),
    #[error("an archive without an array, whose name would end in .npy")]
    Empty,
    #[error("array {name}: {message}")]
    Unpacked {
        name: String,
        message: std::io::Error,
    },
    #[error(
        "array {name} has {bytes} bytes: allowed up to {ARRAY_BYTES_MAX} in an archive; as an NPY file it may \
         have any number"
    )]
    TooLong { name: String, bytes: u64 },
}

/// Whether a file is an archive.
pub(in crate::recording) fn is_archive(input: &Input, format: &LogFormat) -> bool {
    format.dtype.is_none() && input.starts_with(MAGIC)
}

/// An array of an archive.
struct Member {
    /// Index in the archive.
    index: usize,
    /// Name without its end.
    name: String,
}

/// An array whose heading was read.
struct Described {
    member: Member,
    heading: ArrayHeading,
    /// Number of its first column among those of all arrays.
    first: usize,
}

/// Reads columns of the arrays of an archive: of one array as of an NPY file; of several each is a column under
/// its name, and what has columns itself one for each.
///
/// # Errors
/// An archive on a pipe or packed otherwise, arrays of several lengths, whatever is wrong with an array.
pub(in crate::recording) fn read(
    path: &Path,
    input: &Input,
    wanted: &Wanted<'_>,
) -> Result<Columns, LogError> {
    let refuse = |error: ArchiveError| LogError::of_file(path, error);
    if input.length().is_none() {
        return Err(refuse(ArchiveError::Pipe));
    }
    let file = File::open(path).map_err(|error| LogError::read(path, error))?;
    let mut archive =
        ZipArchive::new(BufReader::new(file)).map_err(|error| refuse(error.into()))?;
    let members: Vec<Member> = (0..archive.len())
        .filter_map(|index| {
            let name = archive
                .name_for_index(index)?
                .strip_suffix(ARRAY)?
                .to_owned();
            Some(Member { index, name })
        })
        .collect();
    match &members[..] {
        [] => Err(refuse(ArchiveError::Empty)),
        [one] => {
            let array = unpacked(&mut archive, one).map_err(refuse)?;
            // Its name asks for no more than it has.
            let is_own = matches!(&wanted.columns, Selection::Named([name]) if *name == one.name);
            let columns = match is_own {
                true => Selection::Named(&[]),
                false => wanted.columns.clone(),
            };
            let wanted = Wanted {
                columns,
                ..wanted.clone()
            };
            array::read(path, array, &wanted)
        }
        _ => read_several(path, &mut archive, members, wanted),
    }
}

fn read_several(
    path: &Path,
    archive: &mut ZipArchive<BufReader<File>>,
    members: Vec<Member>,
    wanted: &Wanted<'_>,
) -> Result<Columns, LogError> {
    let refuse = |error: ArchiveError| LogError::of_file(path, error);
    let (mut arrays, mut names, mut units) = (Vec::new(), Vec::new(), Vec::new());
    for member in members {
        let mut array = unpacked(archive, &member).map_err(refuse)?;
        // An array of another kind, such as a text, stands beside the others.
        let Ok(heading) = array::read_heading(path, &mut array, wanted.format) else {
            continue;
        };
        let first = names.len();
        for (name, unit) in heading.columns() {
            names.push(format!("{}{name}", member.name));
            units.push(unit);
        }
        arrays.push(Described {
            member,
            heading,
            first,
        });
    }
    let layout = Layout::of_fields(names, units);
    let chosen = choose(
        &layout,
        wanted.format,
        &[],
        &wanted.columns,
        wanted.needs_time,
    )
    .map_err(|error| Fault::from(error).of(path))?;
    let found = format!("arrays {}", listed(&layout.names));
    let mut gather = Gather::new(path, &layout, chosen, wanted, found);
    let samples_max = u64::try_from(wanted.samples_max).unwrap_or(u64::MAX);
    for array in arrays {
        let mut own = array.first..array.first + array.heading.columns().len();
        if !own.any(|column| gather.wants(column)) {
            continue;
        }
        let mut words = unpacked(archive, &array.member).map_err(refuse)?;
        array::read_heading(path, &mut words, wanted.format)?;
        let mut take = |word: PlacedWord<'_>| {
            let column = array.first + word.column;
            gather.take(&PlacedWord { column, ..word })
        };
        each_word(path, &array.heading, &mut words, samples_max, &mut take)?;
    }
    gather.end()
}

/// The bytes of an array, whose check sum is right.
fn unpacked(
    archive: &mut ZipArchive<BufReader<File>>,
    member: &Member,
) -> Result<Input, ArchiveError> {
    let packed = archive.by_index(member.index)?;
    let (name, bytes) = (member.name.clone(), packed.size());
    if bytes > ARRAY_BYTES_MAX {
        return Err(ArchiveError::TooLong { name, bytes });
    }
    let mut unpacked = Vec::new();
    let read = packed.take(bytes + 1).read_to_end(&mut unpacked);
    read.map_err(|message| ArchiveError::Unpacked { name, message })?;
    Ok(Input::of_bytes(unpacked))
}
