//! Options of comparisons with earlier results.

use std::path::PathBuf;

use clap::builder::PossibleValue;
use clap::{Args, Subcommand, ValueEnum};

use crate::baseline::Outcome;

/// What may be among the outcomes that fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::cli) enum FailOn {
    /// An outcome other than the same.
    Outcome(Outcome),
    /// None of them.
    Never,
}

impl FailOn {
    /// Every outcome but the last, which is the same, then none.
    const ALL: [Self; Outcome::ALL.len()] = {
        let mut all = [Self::Never; Outcome::ALL.len()];
        let mut index = 0;
        while index + 1 < all.len() {
            all[index] = Self::Outcome(Outcome::ALL[index]);
            index += 1;
        }
        all
    };

    /// The outcomes of a list; none where it says that something fails and that nothing does.
    pub(in crate::cli) fn outcomes(list: &[Self]) -> Option<Vec<Outcome>> {
        let outcomes: Vec<Outcome> = list
            .iter()
            .filter_map(|fail_on| match fail_on {
                Self::Outcome(outcome) => Some(*outcome),
                Self::Never => None,
            })
            .collect();
        (outcomes.is_empty() || outcomes.len() == list.len()).then_some(outcomes)
    }
}

impl ValueEnum for FailOn {
    fn value_variants<'a>() -> &'a [Self] {
        &Self::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let (name, meaning) = match self {
            Self::Outcome(outcome) => (outcome.as_str(), outcome.meaning()),
            Self::Never => ("never", "Nothing"),
        };
        Some(PossibleValue::new(name).help(meaning))
    }
}

/// Forms of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum ComparisonFormat {
    /// Lines for people
    Text,
    /// One JSON document
    Json,
    /// A table in Markdown
    Markdown,
}

/// Options of `compare`.
#[derive(Args, Debug)]
pub(in crate::cli) struct CompareOptions {
    /// Earlier results: an output folder, the folder of a run, or a baseline
    pub(in crate::cli) old: PathBuf,
    /// Later results, as well
    pub(in crate::cli) new: PathBuf,
    /// Outcomes that end with 1, between commas
    #[arg(
        long,
        value_enum,
        value_name = "LIST",
        value_delimiter = ',',
        default_value = "worse,removed"
    )]
    pub(in crate::cli) fail_on: Vec<FailOn>,
    /// Form of the comparison
    #[arg(long, value_enum, default_value_t = ComparisonFormat::Text)]
    pub(in crate::cli) format: ComparisonFormat,
    /// Write a page for a browser as well, with curves and gates of both on one another
    #[arg(long, value_name = "FILE")]
    pub(in crate::cli) html: Option<PathBuf>,
    /// Replace a file that stands there, be it no such page
    #[arg(long, requires = "html")]
    pub(in crate::cli) force: bool,
}

/// Commands on baselines.
#[derive(Debug, Subcommand)]
pub(in crate::cli) enum BaselineCommand {
    /// Write the figures of an output folder into a new baseline
    Save(SaveOptions),
    /// Show how an output folder differs from a baseline, and bring that up to date if told to
    Update(UpdateOptions),
}

/// Options of `baseline`.
#[derive(Args, Debug)]
pub(in crate::cli) struct BaselineOptions {
    #[command(subcommand)]
    pub(in crate::cli) command: BaselineCommand,
}

/// Options of `baseline save`.
#[derive(Args, Debug)]
pub(in crate::cli) struct SaveOptions {
    /// Output folder of `run`, or the folder of a run
    pub(in crate::cli) results: PathBuf,
    /// File of the baseline
    #[arg(short, long, value_name = "FILE")]
    pub(in crate::cli) output: PathBuf,
    /// Replace a file that stands there, be it a baseline
    #[arg(long)]
    pub(in crate::cli) force: bool,
}

/// Options of `baseline update`.
#[derive(Args, Debug)]
pub(in crate::cli) struct UpdateOptions {
    /// File of the baseline
    pub(in crate::cli) baseline: PathBuf,
    /// Output folder of `run`, or the folder of a run
    pub(in crate::cli) results: PathBuf,
    /// Write the baseline; directions and tolerances in it stay
    #[arg(long)]
    pub(in crate::cli) write: bool,
}

/// What `run` compares its results with.
#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct AgainstOptions {
    /// Compare the results with a baseline, or earlier results: end with 1 where one is worse or gone
    #[arg(long, value_name = "FILE")]
    pub(in crate::cli) baseline: Option<PathBuf>,
    /// Outcomes of the comparison that end with 1, between commas
    #[arg(
        long,
        value_enum,
        value_name = "LIST",
        value_delimiter = ',',
        requires = "baseline",
        default_value = "worse,removed"
    )]
    pub(in crate::cli) fail_on: Vec<FailOn>,
}
