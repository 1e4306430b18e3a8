//! `fogbench init`: a first scenario for somebody's own gyro.

use std::io;

use crate::cli::options::init::InitOptions;
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::{complaint, output, place};
use crate::experiment::starter_scenario;
use crate::scenario::{RESERVED, reserved};
use crate::store::SingleFile;

/// Prints the scenario, or writes it where nothing stands yet.
pub(in crate::cli) fn init(options: &InitOptions) -> io::Result<Exit> {
    if RESERVED.contains(&options.name.as_str()) {
        complaint::print(&[reserved(&format!("--name {}", options.name))]);
        return Ok(Exit::Usage);
    }
    let text = match starter_scenario(&options.name, &options.gyro()) {
        Ok(text) => text,
        Err(error) => {
            complaint::print(&[format!("no such gyro can be modelled: {error}")]);
            return Ok(Exit::Usage);
        }
    };
    let Some(path) = options.output.as_deref() else {
        output::data(&text)?;
        return Ok(Exit::Success);
    };
    let file = SingleFile {
        path,
        // A scenario is its owner's to edit: none is replaced unasked, be it one that was begun here.
        is_ours: None,
        force: options.force,
    };
    Ok(match file.write(&text) {
        Err(error) => place::refused(&error),
        Ok(()) => {
            let path = path.display();
            output::talk(&format!("{path} is written; `fogbench run {path}` runs it"));
            Exit::Success
        }
    })
}
