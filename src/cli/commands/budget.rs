//! `fogbench budget`: the noise budget of a gyro in closed form.

use std::io;

use crate::cli::options::arguments::BudgetOptions;
use crate::cli::terminal::complaint;
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;
use crate::cli::terminal::place::Place;
use crate::experiment::{GyroBudget, gyro_budget};
use crate::report::{budget_assumed_text as assumed_text, budget_files, budget_json, budget_text};
use crate::store::{OutputFolder, StoreError};

/// Prints the budget; with a folder, writes `budget.svg` and `budget.csv` into it as well.
pub(in crate::cli) fn budget(options: &BudgetOptions) -> io::Result<Exit> {
    let place = Place::new(options.output.as_deref(), "budget", options.force);
    if let Err(exit) = place.check(&[&options.path]) {
        return Ok(exit);
    }
    let budget = match gyro_budget(&options.path, &options.set) {
        Ok(budget) => budget,
        Err(errors) => {
            complaint::print(&errors);
            return Ok(Exit::Usage);
        }
    };
    let GyroBudget {
        file,
        sheet,
        assumed,
    } = &budget;
    if let Err(exit) = place.fill(|folder| write(folder, &budget)) {
        return Ok(exit);
    }
    output::data(&options.format.of(
        || budget_text(file, sheet) + &assumed_text(assumed, output::width()),
        || budget_json(file, sheet),
    )?)?;
    Ok(Exit::Success)
}

fn write(folder: &OutputFolder, budget: &GyroBudget) -> Result<(), StoreError> {
    let GyroBudget { file, sheet, .. } = budget;
    let staged = folder.stage()?;
    for (name, text) in budget_files(file, sheet) {
        staged.write(&name, text.as_bytes())?;
    }
    staged.seal_plainly()?;
    staged.put_files_in_place()
}
