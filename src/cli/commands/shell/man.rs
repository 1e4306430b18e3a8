//! `fogbench man`: the pages of the manual.

use std::fs;
use std::io;

use clap::CommandFactory as _;
use clap_mangen::Man;

use crate::cli::options::arguments::{Arguments, ManOptions};
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::{output, place};
use crate::store::SingleFile;

/// Prints the page of the program, or writes those of all commands into a folder.
pub(in crate::cli) fn man(options: &ManOptions) -> io::Result<Exit> {
    let mut program = Arguments::command();
    program.build();
    let Some(folder) = &options.folder else {
        output::data(&text(program)?)?;
        return Ok(Exit::Success);
    };
    let mut pages = Vec::new();
    collect(program, &mut pages)?;
    let paths = pages.iter().map(|(name, _)| folder.join(name));
    let paths: Vec<_> = paths.collect();
    let file = |path| SingleFile {
        path,
        is_ours: Some(is_page),
        force: options.force,
    };
    // Everything is looked at before anything is written.
    if let Some(error) = paths.iter().find_map(|path| file(path).check().err()) {
        return Ok(place::refused(&error));
    }
    if let Err(error) = fs::create_dir_all(folder) {
        let folder = folder.display();
        output::talk(&format!(
            "error: {folder} can be no folder: {error}: nothing was done"
        ));
        return Ok(Exit::Io);
    }
    for (path, (_, text)) in paths.iter().zip(&pages) {
        if let Err(error) = file(path).write(text) {
            return Ok(place::refused(&error));
        }
    }
    output::talk(&format!(
        "{} pages are written into {}",
        pages.len(),
        folder.display()
    ));
    Ok(Exit::Success)
}

/// Name of the file and text of the page of a command, and of all below it.
fn collect(command: clap::Command, pages: &mut Vec<(String, String)>) -> io::Result<()> {
    for below in command.get_subcommands() {
        // A command has its help in its own page.
        if below.get_name() != "help" {
            collect(below.clone(), pages)?;
        }
    }
    let man = Man::new(command.clone());
    pages.push((man.get_filename(), text(command)?));
    Ok(())
}

fn text(command: clap::Command) -> io::Result<String> {
    let mut text = Vec::new();
    Man::new(command).render(&mut text)?;
    Ok(String::from_utf8_lossy(&text).into_owned())
}

/// Whether a text is such a page.
fn is_page(text: &str) -> bool {
    text.contains("\n.TH fogbench")
}
