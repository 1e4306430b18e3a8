//! `fogbench plan`: what there is to run, numbered, and in how many parts.

use std::io;
use std::path::{Path, PathBuf};

use crate::cli::commands::select;
use crate::cli::options::arguments::SelectOptions;
use crate::cli::options::shard::PlanOptions;
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::{output, place};
use crate::experiment::{PlanFile, Selected};
use crate::store::SingleFile;
use crate::wording::counted;

/// Seconds that a proposed shard takes: between ten minutes and an hour is worth a job of its own.
const SHARD_S: f64 = 1800.0;
/// Most shards that are proposed: schedulers take arrays of a thousand without being asked.
const SHARDS_MAX: u32 = 1000;
/// How the script begins.
const SCRIPT: &str = "#!/bin/sh\n# fogbench array:";

/// Plans and writes the plan; starts nothing.
pub(in crate::cli) fn plan(options: &PlanOptions) -> io::Result<Exit> {
    let script = script_path(&options.output);
    let plan_file = SingleFile {
        path: &options.output,
        is_ours: Some(PlanFile::is_one),
        force: options.force,
    };
    let script_file = SingleFile {
        path: &script,
        is_ours: Some(|text| text.starts_with(SCRIPT)),
        force: options.force,
    };
    let files = [Some(plan_file), options.slurm.then_some(script_file)];
    for file in files.into_iter().flatten() {
        if let Err(error) = file.check() {
            return Ok(place::refused(&error));
        }
    }
    let listing = match select::listing(&options.select, &|_| false, true) {
        Ok(listing) => listing,
        Err(exit) => return Ok(exit),
    };
    let (list, seconds) = (&listing.list, listing.estimated_s);
    let shards = options
        .shards
        .unwrap_or_else(|| proposed(seconds, list.len()));
    let selected = selected(&options.select);
    let mut written =
        plan_file.write_by(&|out| PlanFile::write(out, list, shards, &selected, seconds));
    if options.slurm {
        written = written.and_then(|()| script_file.write(&array_script(&options.output, shards)));
    }
    if let Err(error) = written {
        return Ok(place::refused(&error));
    }
    let mut text = format!(
        "{} in {}, about {seconds:.0} CPU seconds: {} of about {:.0} s\nplan in {}\n",
        counted(list.runs(), "run"),
        counted(list.len(), "part"),
        counted(shards as usize, "shard"),
        seconds / f64::from(shards),
        options.output.display()
    );
    if options.slurm {
        text.push_str(&format!("submit with: sh {}\n", script.display()));
    }
    output::data(&text)?;
    Ok(Exit::Success)
}

/// What is selected, as a file keeps it.
pub(in crate::cli) fn selected(options: &SelectOptions) -> Selected {
    let paths = options.paths.iter();
    Selected {
        paths: paths
            .map(|path| path.to_string_lossy().into_owned())
            .collect(),
        sets: options.set.clone(),
        names: options.names.clone(),
    }
}

/// The options that select what a file keeps.
pub(in crate::cli) fn select_options(selected: &Selected) -> SelectOptions {
    SelectOptions {
        paths: selected.paths.iter().map(PathBuf::from).collect(),
        set: selected.sets.clone(),
        names: selected.names.clone(),
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a count between the limits, which the float holds exactly"
)]
fn proposed(seconds: f64, units: usize) -> u32 {
    let most = u32::try_from(units)
        .unwrap_or(u32::MAX)
        .clamp(1, SHARDS_MAX);
    (seconds / SHARD_S).ceil().clamp(1.0, f64::from(most)) as u32
}

fn script_path(plan: &Path) -> PathBuf {
    let mut name = plan.as_os_str().to_owned();
    name.push(".slurm");
    name.into()
}

/// A word as a shell takes it.
fn quoted(path: &Path) -> String {
    format!("'{}'", path.to_string_lossy().replace('\'', "'\\''"))
}

fn array_script(plan: &Path, shards: u32) -> String {
    let plan = quoted(plan);
    format!(
        r#"{SCRIPT} submits {shards} shards and the merge behind them, from the folder of the plan's paths.
#   sh FILE                     everything; options of sbatch may follow, as in --partition=short
#   sh FILE --array=3,7-9       shards again, as `fogbench status DIR` lists them
# SHARDS and OUTPUT name the folders; FOGBENCH the program.
set -eu
export FOGBENCH="${{FOGBENCH:-fogbench}}" SHARDS="${{SHARDS:-shards}}" OUTPUT="${{OUTPUT:-output}}"
array=$(sbatch --parsable "$@" <<'ARRAY'
#!/bin/sh
#SBATCH --job-name=fogbench
#SBATCH --array=1-{shards}
#SBATCH --cpus-per-task=1
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=fogbench-%A_%a.log
#SBATCH --signal=B:TERM@60
exec "$FOGBENCH" run --plan {plan} -o "$SHARDS" -j "${{SLURM_CPUS_PER_TASK:-1}}"
ARRAY
)
sbatch --parsable --dependency=afterany:"${{array%%;*}}" <<'MERGE'
#!/bin/sh
#SBATCH --job-name=fogbench-merge
#SBATCH --cpus-per-task=1
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=fogbench-merge-%j.log
exec "$FOGBENCH" merge "$SHARDS" -o "$OUTPUT" -j "${{SLURM_CPUS_PER_TASK:-1}}"
MERGE
"#
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shard_is_proposed_to_take_between_ten_minutes_and_an_hour() {
        for seconds in [3601.0, 10_000.0, 100_000.0, 1_000_000.0] {
            let shard_s = seconds / f64::from(proposed(seconds, 10_000));
            assert!((600.0..=3600.0).contains(&shard_s), "{seconds}: {shard_s}");
        }
        assert_eq!(proposed(5.0, 100), 1);
        assert_eq!(proposed(1e6, 3), 3);
        assert_eq!(proposed(1e9, 1_000_000), 1000);
    }

    #[test]
    fn a_path_is_one_word_of_a_shell() {
        assert_eq!(quoted(Path::new("a b'c.plan")), r"'a b'\''c.plan'");
    }
}
