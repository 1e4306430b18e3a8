//! Options of suites that run in parts: which part, of how many, and where their files are.

use std::path::PathBuf;

use clap::Args;

use crate::cli::options::arguments::{AccountOptions, SelectOptions};
use crate::wording::counted;

/// Variables in which schedulers say which task of an array this is.
pub(in crate::cli) const TASK_VARIABLES: [&str; 4] = [
    "SLURM_ARRAY_TASK_ID",
    "HQ_TASK_ID",
    "JOB_COMPLETION_INDEX",
    "PBS_ARRAY_INDEX",
];

/// Which part of a suite `run` runs.
#[derive(Args, Debug, Default)]
pub(in crate::cli) struct ShardOptions {
    /// Run part i of n, from 1, into a file of its own for `merge`; beside --plan `i` alone, `/n` where i is
    /// what SLURM_ARRAY_TASK_ID, HQ_TASK_ID, JOB_COMPLETION_INDEX or PBS_ARRAY_INDEX says
    #[arg(long, value_name = "i/n", conflicts_with_all = JUDGING)]
    pub(in crate::cli) shard: Option<String>,
    /// Run a part of the plan in FILE, which part as --shard or one of these variables says
    #[arg(long, value_name = "FILE", conflicts_with_all = JUDGING,
          conflicts_with_all = ["paths", "set", "names"])]
    pub(in crate::cli) plan: Option<PathBuf>,
    /// Add K to what the variable says: 1 where the array counts from 0
    #[arg(long, value_name = "K", conflicts_with_all = JUDGING)]
    pub(in crate::cli) shard_offset: Option<u32>,
}

/// Why it is not known which part of a suite is to run.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub(in crate::cli) struct NoShard(String);

/// What a part of a suite cannot do: `merge` judges.
const JUDGING: [&str; 10] = [
    "fail_fast",
    "require_gates",
    "verbose",
    "format",
    "baseline",
    "fail_on",
    "junit",
    "annotations",
    "summary_markdown",
    "bmf",
];

impl ShardOptions {
    /// Whether a part is asked for.
    pub(in crate::cli) fn is_asked(&self) -> bool {
        self.shard.is_some() || self.plan.is_some() || self.shard_offset.is_some()
    }

    /// Which part of how many, from 1.
    ///
    /// * `planned`: how many a plan says; none without a plan.
    /// * `variable`: what a variable of the environment holds.
    ///
    /// # Errors
    /// What is wrong, in words.
    pub(in crate::cli) fn numbers(
        &self,
        planned: Option<u32>,
        variable: &dyn Fn(&str) -> Option<String>,
    ) -> Result<(u32, u32), NoShard> {
        let (asked, count) = self.asked(planned)?;
        let told = told(variable, self.shard_offset.unwrap_or(0))?;
        let index = match (asked, told.first()) {
            (Some(index), None) => index,
            (Some(index), Some((name, other))) => {
                if !told.iter().any(|(_, told)| *told == index) {
                    return Err(NoShard(format!(
                        "--shard asks for {index} and {name} says {other}{}: leave one of them out",
                        self.with_offset()
                    )));
                }
                index
            }
            (None, None) => {
                return Err(NoShard(format!(
                    "which shard of {count}? say --shard, or set one of {}",
                    TASK_VARIABLES.join(", ")
                )));
            }
            (None, Some((name, index))) => {
                if let Some((another, other)) = told.iter().find(|(_, told)| told != index) {
                    return Err(NoShard(format!(
                        "{name} says {index} and {another} {other}: say --shard"
                    )));
                }
                *index
            }
        };
        if (1..=count).contains(&index) {
            return Ok((index, count));
        }
        let hint = match asked {
            None if index == 0 => "; --shard-offset 1 where the array counts from 0",
            _ => "",
        };
        Err(NoShard(format!(
            "there is no shard {index}: shards go from 1 to {count}{hint}"
        )))
    }

    fn with_offset(&self) -> String {
        let offset = self.shard_offset.filter(|offset| *offset > 0);
        offset.map_or_else(String::new, |offset| {
            format!(" with --shard-offset {offset}")
        })
    }

    /// What --shard says: which one, if it says that, and of how many.
    fn asked(&self, planned: Option<u32>) -> Result<(Option<u32>, u32), NoShard> {
        let number = |text: &str| {
            let number = text.parse::<u32>().ok();
            number.ok_or_else(|| {
                NoShard(format!(
                    "--shard {:?}: `{text}` is no number: it is i/n, as in 3/8",
                    self.text()
                ))
            })
        };
        let (index, count) = match self.shard.as_deref().map(|text| text.split_once('/')) {
            None => (None, None),
            Some(None) => (Some(number(self.text())?), None),
            Some(Some(("", count))) => (None, Some(number(count)?)),
            Some(Some((index, count))) => (Some(number(index)?), Some(number(count)?)),
        };
        match (count, planned) {
            (Some(0), _) => Err(NoShard("--shard: of 0 shards there is none".to_owned())),
            (Some(count), Some(planned)) if count != planned => Err(NoShard(format!(
                "--shard says {} and the plan has {planned}",
                counted(count as usize, "shard")
            ))),
            (Some(count), _) | (None, Some(count)) => Ok((index, count)),
            (None, None) => Err(NoShard(
                "--shard is i/n, as in 3/8: the number of shards comes from it or from --plan, never from \
                 the environment"
                    .to_owned(),
            )),
        }
    }

    fn text(&self) -> &str {
        self.shard.as_deref().unwrap_or_default()
    }
}

/// Which task each variable that is set says that this is.
fn told(
    variable: &dyn Fn(&str) -> Option<String>,
    offset: u32,
) -> Result<Vec<(&'static str, u32)>, NoShard> {
    let set = TASK_VARIABLES.iter().filter_map(|name| {
        let text = variable(name).filter(|text| !text.is_empty())?;
        let number = text.parse::<u32>().ok();
        let number = number.and_then(|number| number.checked_add(offset));
        Some(match number {
            Some(number) => Ok((*name, number)),
            None => Err(NoShard(format!("{name} = {text:?} is no number of a task"))),
        })
    });
    set.collect()
}

/// Options of `plan`.
#[derive(Args, Debug)]
pub(in crate::cli) struct PlanOptions {
    #[command(flatten)]
    pub(in crate::cli) select: SelectOptions,
    /// File of the plan
    #[arg(short, long, value_name = "FILE")]
    pub(in crate::cli) output: PathBuf,
    /// Number of shards [default: as many as take half an hour each]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(in crate::cli) shards: Option<u32>,
    /// Write FILE.slurm as well, a script that submits the shards as a job array of Slurm and the merge
    /// behind it
    #[arg(long)]
    pub(in crate::cli) slurm: bool,
    /// Replace files that stand there, be they no plan
    #[arg(long)]
    pub(in crate::cli) force: bool,
}

/// Options of `merge`.
#[derive(Args, Debug)]
pub(in crate::cli) struct MergeOptions {
    /// Folders that hold shards
    #[arg(required = true, value_name = "DIR")]
    pub(in crate::cli) folders: Vec<PathBuf>,
    /// Folder for the results
    #[arg(short, long, value_name = "DIR")]
    pub(in crate::cli) output: PathBuf,
    /// Merge what there is where shards are missing; their runs count as not run
    #[arg(long)]
    pub(in crate::cli) partial: bool,
    /// Replace files and folders that fogbench did not write, or that were changed since
    #[arg(long)]
    pub(in crate::cli) force: bool,
    #[command(flatten)]
    pub(in crate::cli) account: AccountOptions,
}

/// Options of `status`.
#[derive(Args, Debug)]
pub(in crate::cli) struct StatusOptions {
    /// Folder that holds shards
    #[arg(value_name = "DIR")]
    pub(in crate::cli) folder: PathBuf,
    /// Print the missing ones alone, ready for --array
    #[arg(long)]
    pub(in crate::cli) missing: bool,
    /// Take K off the numbers, for an array that counts from 0 and runs with this --shard-offset
    #[arg(long, value_name = "K", default_value_t = 0)]
    pub(in crate::cli) shard_offset: u32,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(
        shard: Option<&str>,
        planned: Option<u32>,
        offset: Option<u32>,
        set: &[(&str, &str)],
    ) -> Result<(u32, u32), NoShard> {
        let options = ShardOptions {
            shard: shard.map(str::to_owned),
            plan: None,
            shard_offset: offset,
        };
        options.numbers(planned, &|name| {
            let found = set.iter().find(|(known, _)| *known == name);
            found.map(|(_, value)| (*value).to_owned())
        })
    }

    #[test]
    fn the_environment_gives_the_number_of_the_shard_alone() {
        for name in TASK_VARIABLES {
            assert_eq!(numbers(Some("/8"), None, None, &[(name, "3")]), Ok((3, 8)));
            assert_eq!(numbers(None, Some(8), None, &[(name, "8")]), Ok((8, 8)));
            assert_eq!(numbers(None, Some(8), Some(1), &[(name, "0")]), Ok((1, 8)));
        }
        let array = [
            ("SLURM_ARRAY_TASK_ID", "7"),
            ("SLURM_ARRAY_TASK_COUNT", "3"),
            ("SLURM_ARRAY_TASK_MAX", "8"),
        ];
        assert_eq!(numbers(None, Some(12), None, &array), Ok((7, 12)));
        assert!(numbers(None, None, None, &array).is_err(), "never n");
    }

    #[test]
    fn what_is_said_on_the_command_line_counts_unless_the_environment_contradicts_it() {
        assert_eq!(numbers(Some("3/8"), None, None, &[]), Ok((3, 8)));
        assert_eq!(numbers(Some("3"), Some(8), None, &[]), Ok((3, 8)));
        assert_eq!(
            numbers(Some("3/8"), Some(8), None, &[("HQ_TASK_ID", "3")]),
            Ok((3, 8))
        );
        for (shard, planned, set) in [
            (Some("0/8"), None, vec![]),
            (Some("9/8"), None, vec![]),
            (Some("1/0"), None, vec![]),
            (Some("3"), None, vec![]),
            (Some("x/8"), None, vec![]),
            (Some("-1/8"), None, vec![]),
            (Some("3/8"), Some(9), vec![]),
            (Some("3/8"), None, vec![("HQ_TASK_ID", "4")]),
            (None, Some(8), vec![]),
            (None, Some(8), vec![("HQ_TASK_ID", "")]),
            (None, Some(8), vec![("HQ_TASK_ID", "two")]),
            (None, Some(8), vec![("JOB_COMPLETION_INDEX", "0")]),
            (
                None,
                Some(8),
                vec![("HQ_TASK_ID", "2"), ("SLURM_ARRAY_TASK_ID", "1")],
            ),
        ] {
            let found = numbers(shard, planned, None, &set);
            assert!(found.is_err(), "{shard:?} {planned:?} {set:?}: {found:?}");
        }
    }
}
