//! `fogbench budget`: the noise budget of a gyro in closed form.

use std::io;
use std::path::Path;

use super::arguments::{BudgetOptions, Format};
use super::exit::Exit;
use super::{complaint, output};
use crate::experiment::{GyroBudget, gyro_budget};
use crate::report::{budget_csv, budget_json, budget_svg, budget_text, write_atomic};

/// Prints the budget; with a folder, writes `budget.svg` and `budget.csv` into it as well.
pub(super) fn budget(options: &BudgetOptions) -> io::Result<Exit> {
    let budget = match gyro_budget(&options.path, &options.set) {
        Ok(budget) => budget,
        Err(errors) => {
            complaint::print(&errors);
            return Ok(Exit::Usage);
        }
    };
    let GyroBudget { file, sheet } = &budget;
    if let Some(folder) = &options.output {
        std::fs::create_dir_all(folder).map_err(|error| at(folder, &error))?;
        let svg = budget_svg(file, sheet).map(|svg| ("budget.svg", svg));
        for (name, text) in svg.into_iter().chain([("budget.csv", budget_csv(sheet))]) {
            let path = folder.join(name);
            write_atomic(&path, text.as_bytes()).map_err(|error| at(&path, &error))?;
        }
    }
    output::data(&match options.format {
        Format::Text => budget_text(file, sheet),
        Format::Json => budget_json(file, sheet),
        Format::Jsonl => {
            let document: serde_json::Value = serde_json::from_str(&budget_json(file, sheet))?;
            format!("{document}\n")
        }
    })?;
    Ok(Exit::Success)
}

/// An error of the file system with the place it is about.
fn at(path: &Path, error: &io::Error) -> io::Error {
    io::Error::new(
        error.kind(),
        format!("cannot write {}: {error}", path.display()),
    )
}
