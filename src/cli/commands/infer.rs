//! `fogbench infer`: which settings make all printed figures at once.

use std::io;

use crate::cli::options::format::Format;
use crate::cli::options::infer::InferOptions;
use crate::cli::terminal::complaint;
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;
use crate::cli::terminal::place::Place;
use crate::experiment::{Inference, check_problem, infer as search};
use crate::report::{InferenceSheet, infer_json, infer_text};
use crate::store::{OutputFolder, StoreError};

/// Searches a problem and prints what its figures say; with a folder, writes it there as well.
pub(in crate::cli) fn infer(options: &InferOptions) -> io::Result<Exit> {
    if options.check {
        return Ok(match check_problem(&options.path) {
            Ok(()) => Exit::Success,
            Err(errors) => {
                complaint::print(&errors);
                Exit::Usage
            }
        });
    }
    let place = Place::new(options.output.as_deref(), "infer", options.force);
    if let Err(exit) = place.check(&[&options.path]) {
        return Ok(exit);
    }
    let inference = match search(&options.path) {
        Ok(inference) => inference,
        Err(errors) => {
            complaint::print(&errors);
            return Ok(Exit::Usage);
        }
    };
    let sheet = sheet(&inference);
    let (text, json) = (infer_text(&sheet), infer_json(&sheet));
    if let Err(exit) = place.fill(|folder| write(folder, &text, &json)) {
        return Ok(exit);
    }
    output::data(&match options.format {
        Format::Text => text,
        Format::Json => json,
        Format::Jsonl => {
            let document: serde_json::Value = serde_json::from_str(&json)?;
            format!("{document}\n")
        }
    })?;
    Ok(Exit::Success)
}

/// What the report shows of an inference.
fn sheet(inference: &Inference) -> InferenceSheet<'_> {
    InferenceSheet {
        problem: &inference.problem.config,
        file: &inference.problem.file,
        parameters: &inference.parameters,
        readings: &inference.readings,
        lacks: &inference.lacks,
        answer: &inference.answer,
    }
}

fn write(folder: &OutputFolder, text: &str, json: &str) -> Result<(), StoreError> {
    let staged = folder.stage()?;
    staged.write("infer.txt", text.as_bytes())?;
    staged.write("infer.json", json.as_bytes())?;
    staged.seal_plainly()?;
    staged.put_files_in_place()
}
