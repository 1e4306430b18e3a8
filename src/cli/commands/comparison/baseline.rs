//! `fogbench baseline`: the file that keeps results to compare later ones with.

use std::io;

use crate::baseline::{compare, is_baseline_toml, to_toml, updated};
use crate::cli::commands::comparison::compare::refused;
use crate::cli::options::baseline::{BaselineCommand, BaselineOptions, SaveOptions, UpdateOptions};
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::{output, place};
use crate::experiment::{read_baseline_file, read_output};
use crate::report::comparison_with_baseline_text;
use crate::store::SingleFile;
use crate::wording::counted;

/// Saves or updates a baseline.
pub(in crate::cli) fn baseline(options: &BaselineOptions) -> io::Result<Exit> {
    let done = match &options.command {
        BaselineCommand::Save(options) => save(options),
        BaselineCommand::Update(options) => return update(options),
    };
    Ok(done.map_or_else(|exit| exit, |()| Exit::Success))
}

fn save(options: &SaveOptions) -> Result<(), Exit> {
    let side = read_output(&options.results).map_err(|error| refused(&error))?;
    let path = options.output.as_path();
    let file = SingleFile {
        path,
        is_ours: None,
        force: options.force,
    };
    let is_baseline = std::fs::read_to_string(path).is_ok_and(|text| is_baseline_toml(&text));
    if is_baseline && !options.force {
        output::talk(&format!(
            "error: {} is a baseline: nothing was done; `fogbench baseline update` shows what would \
             change and keeps its tolerances, --force replaces it",
            path.display()
        ));
        return Err(Exit::Usage);
    }
    file.write(&to_toml(&side))
        .map_err(|error| place::refused(&error))?;
    let count = counted(side.entries.len(), "figure");
    output::talk(&format!("{count} in {}", path.display()));
    Ok(())
}

fn update(options: &UpdateOptions) -> io::Result<Exit> {
    let sides = read_baseline_file(&options.baseline)
        .and_then(|old| Ok((old, read_output(&options.results)?)));
    let (old, new) = match sides {
        Ok(sides) => sides,
        Err(error) => return Ok(refused(&error)),
    };
    let later = updated(&old, &new);
    let comparison = compare(&old, &later);
    output::data(&comparison_with_baseline_text(
        comparison.judged(&[]),
        output::colour(),
    ))?;
    let path = options.baseline.as_path();
    if !options.write {
        let path = path.display();
        output::talk(&format!(
            "{path} stays as it is: --write brings it up to date"
        ));
        return Ok(Exit::Success);
    }
    let file = SingleFile {
        path,
        is_ours: Some(is_baseline_toml),
        force: false,
    };
    Ok(match file.write(&to_toml(&later)) {
        Err(error) => place::refused(&error),
        Ok(()) => {
            let count = counted(later.entries.len(), "figure");
            output::talk(&format!("{count} in {}", path.display()));
            Exit::Success
        }
    })
}
