//! What `run --baseline` prints: how the results of a suite compare with earlier ones.

use crate::baseline::Judged;
use crate::cli::commands::comparison::compare::{exit_of, outcomes, refused, side};
use crate::cli::options::arguments::RunOptions;
use crate::cli::options::format::Format;
use crate::cli::terminal::exit::{Exit, io_failure};
use crate::cli::terminal::output;
use crate::experiment::{Against, Earlier, SuiteOutcome};
use crate::report::{comparison_with_baseline_markdown, comparison_with_baseline_text};

/// Reads the earlier results before anything runs, which may replace them; none if none are asked for.
///
/// A refusal is printed before its exit code is returned.
pub(super) fn earlier(options: &RunOptions) -> Result<Option<Earlier>, Exit> {
    let select = &options.select;
    let fail_on = outcomes(&options.account.against.fail_on)?;
    let side = options
        .account
        .against
        .baseline
        .as_deref()
        .map(side)
        .transpose()?;
    Ok(side.map(|side| Earlier {
        side,
        fail_on: fail_on.clone(),
        // Whoever names a file or a scenario asks for that alone.
        is_whole: select.names.is_empty() && select.paths.iter().all(|path| path.is_dir()),
    }))
}

/// What came of the comparison.
pub(super) struct Compared {
    /// How the program ends by it.
    pub(super) exit: Exit,
    /// The same in Markdown.
    pub(super) markdown: String,
}

impl Compared {
    fn nothing(exit: Exit) -> Self {
        Self {
            exit,
            markdown: String::new(),
        }
    }

    /// Prints what differs: on stdout where that is text.
    pub(super) fn print(suite: &SuiteOutcome, options: &RunOptions) -> Self {
        let Some(judged) = suite.against.judged() else {
            return Self::nothing(match &suite.against {
                Against::Unreadable(error) => refused(error),
                Against::Stopped => {
                    output::talk(
                        "not compared with the baseline: the suite was stopped before its end",
                    );
                    Exit::Success
                }
                _ => Exit::Success,
            });
        };
        Self {
            exit: exit_of(judged).worst(printed(judged, options)),
            markdown: comparison_with_baseline_markdown(judged.comparison),
        }
    }
}

fn printed(judged: Judged, options: &RunOptions) -> Exit {
    let is_text = options.account.format == Format::Text;
    let colour = is_text && output::colour();
    let text = comparison_with_baseline_text(judged, colour);
    if is_text {
        return output::data(&text).map_or_else(io_failure, |()| Exit::Success);
    }
    text.lines().for_each(output::talk);
    Exit::Success
}
