//! A program of the user's in the place of a filter.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::common::{Complaints, Filter};
use super::kind::FilterSettings;
use crate::declare::{Content, FromLiteral, Kind, Setting, Shape, table};
use crate::vocabulary::{OutputRegister, words};

table! {
    /// A program of the user's that makes the words, over its standard input and output. It is started only with
    /// --allow-programs on the command line.
    pub struct ProcessFilterConfig {
        /// Program and arguments, without a shell. What begins with ./ or ../ is a file beside the file that names
        /// it; a program without a folder is looked for in PATH.
        command: Vec<String>, example ["python3", "./f.py"], kind Command;
        /// Whether the program is given its words block by block, or the record as a whole.
        mode: ProcessMode = "stream";
        /// Words of a block in the mode "stream"; the last block may be shorter. Source of the default: long
        /// against the cost of handing it over.
        block_samples: u32 = 4096, in 1..=1_048_576;
        /// Time for each block and for the end behind the last one. Source of the default: assumed.
        timeout_s: f64 = 60.0, in 0.01..=86400.0, "s";
        /// Time from the start to the answer to the greeting. Source of the default: assumed.
        start_timeout_s: f64 = 60.0, in 0.01..=86400.0, "s";
        /// Most resident memory of the program and all that it starts, looked at every 20 ms. No limit without
        /// it; only Linux tells the memory.
        memory_mb: Option<u32>, example 2048, in 512..=1_048_576, "MB";
        /// Files that the program reads: copies of them stand in the folder in which it works.
        inputs: Option<Vec<String>>, example ["weights.csv"], kind Files;
        /// Settings that the program is told, under names of its own.
        parameters: Option<Parameters>, example "{ window = 8 }";
        /// When the result appears: at the next sample tick, or at that of the newest sample.
        output_register: OutputRegister = "next-sample";
    }
}

words! {
    /// How a program is given its words.
    pub enum ProcessMode {
        /// Block by block: an answer knows no later block.
        Stream = "stream",
        /// All at once.
        Record = "record",
    }
}

/// Settings that are passed on to a program.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(transparent)]
pub struct Parameters(BTreeMap<String, Parameter>);

/// One of them.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(untagged)]
pub enum Parameter {
    /// Yes or no.
    Boolean(bool),
    /// A whole number.
    Integer(i64),
    /// A number.
    Float(f64),
    /// A text.
    Text(String),
    /// Several.
    Array(Vec<Parameter>),
}

impl Setting for Parameters {
    const SHAPE: Shape = Shape::Plain(Content::Value(Kind::Parameters));
    const LIST: Shape = Shape::Impossible;
}

impl FromLiteral<&str> for Parameters {
    fn from_literal(_: &str) -> Self {
        Self::default()
    }
}

impl FilterSettings for ProcessFilterConfig {
    fn check(&self, complaints: &mut Complaints) {
        let program = &self.command[0];
        let has_folder = Path::new(program).components().count() > 1;
        if has_folder && !is_file_argument(program) && !Path::new(program).is_absolute() {
            let message = format!(
                "= \"{program}\" is no program: write ./{program} for a file beside the scenario"
            );
            complaints.key("command", &message);
        }
        let mut names = BTreeSet::new();
        for input in self.inputs.iter().flatten() {
            let name = Path::new(input).file_name();
            if !names.insert(name) {
                let message = format!("names two files `{input}`: they stand in one folder");
                complaints.key("inputs", &message);
            }
        }
    }

    fn build(&self, _sample_period_s: f64) -> Option<Box<dyn Filter>> {
        None
    }
}

/// Whether an argument of a command is a file beside the scenario.
#[must_use]
pub fn is_file_argument(argument: &str) -> bool {
    argument.starts_with("./") || argument.starts_with("../")
}
