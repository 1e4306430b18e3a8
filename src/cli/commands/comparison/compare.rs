//! `fogbench compare`: results against earlier ones.

use std::io;
use std::path::Path;

use crate::baseline::{Judged, Outcome, Side, compare as compare_sides};
use crate::cli::options::baseline::{CompareOptions, ComparisonFormat, FailOn};
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::{complaint, output, place};
use crate::experiment::{SideError, read_side};
use crate::report::{
    ComparedSides, comparison_page, comparison_with_baseline_json,
    comparison_with_baseline_markdown, comparison_with_baseline_text, is_comparison_page,
};
use crate::store::SingleFile;

/// Prints what differs, and fails on what it is to fail on.
pub(in crate::cli) fn compare(options: &CompareOptions) -> io::Result<Exit> {
    let fail_on = match outcomes(&options.fail_on) {
        Ok(fail_on) => fail_on,
        Err(exit) => return Ok(exit),
    };
    let page = options.html.as_deref().map(|path| SingleFile {
        path,
        is_ours: Some(is_comparison_page),
        force: options.force,
    });
    let read = [options.old.as_path(), options.new.as_path()];
    if let Some(Err(exit)) = page.map(|page| place::check_file(page, &read)) {
        return Ok(exit);
    }
    let sides = side(&options.old).and_then(|old| Ok((old, side(&options.new)?)));
    let (old, new) = match sides {
        Ok(sides) => sides,
        Err(exit) => return Ok(exit),
    };
    let comparison = compare_sides(&old, &new);
    let judged = comparison.judged(&fail_on);
    output::data(&match options.format {
        ComparisonFormat::Text => comparison_with_baseline_text(judged, output::colour()),
        ComparisonFormat::Json => comparison_with_baseline_json(judged),
        ComparisonFormat::Markdown => comparison_with_baseline_markdown(&comparison),
    })?;
    let exit = exit_of(judged);
    let Some(page) = page else {
        return Ok(exit);
    };
    let compared = ComparedSides {
        judged,
        old: &old,
        new: &new,
    };
    Ok(match page.write(&comparison_page(&compared)) {
        Ok(()) => exit,
        Err(error) => exit.worst(place::refused(&error)),
    })
}

/// The outcomes that are to fail.
///
/// A refusal is printed before its exit code is returned.
pub(in crate::cli) fn outcomes(list: &[FailOn]) -> Result<Vec<Outcome>, Exit> {
    FailOn::outcomes(list).ok_or_else(|| {
        let said = "--fail-on never stands alone: it says that nothing fails";
        complaint::print(&[said.to_owned()]);
        Exit::Usage
    })
}

/// How a comparison ends.
pub(in crate::cli) fn exit_of(judged: Judged) -> Exit {
    if judged.has_failed() {
        Exit::GateFailed
    } else {
        Exit::Success
    }
}

/// The side that a path leads to; a refusal is printed before its exit code is returned.
pub(in crate::cli) fn side(path: &Path) -> Result<Side, Exit> {
    read_side(path).map_err(|error| refused(&error))
}

/// Says why a side cannot be read.
pub(in crate::cli) fn refused(error: &SideError) -> Exit {
    output::talk(&format!("error: {error}"));
    if error.is_io() { Exit::Io } else { Exit::Usage }
}
