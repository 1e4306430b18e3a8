//! What may be said on the command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;

use crate::cli::options::baseline::{AgainstOptions, BaselineOptions, CompareOptions};
use crate::cli::options::build_server::BuildServerOptions;
use crate::cli::options::calibrate::CalibrateOptions;
use crate::cli::options::claim::ClaimOptions;
use crate::cli::options::format::Format;
use crate::cli::options::hardware::{ExportOptions, TimingOptions};
use crate::cli::options::infer::InferOptions;
use crate::cli::options::init::InitOptions;
use crate::cli::options::log::{AnalyzeOptions, FilterLogOptions};
use crate::cli::options::points::ScaleFactorOptions;
use crate::cli::options::records::RecordsOptions;
use crate::cli::options::shard::{MergeOptions, PlanOptions, ShardOptions, StatusOptions};
use crate::cli::options::wordlength::WordLengthOptions;
use crate::cli::terminal::output::Colour;

/// Version and build of the program.
const VERSION: &str = concat!(
    env!("CARGO_PKG_VERSION"),
    " (build ",
    env!("FOGBENCH_BUILD"),
    ")"
);

/// Closed-loop fibre-optic-gyro and rate-turntable testbench.
///
/// Runs TOML scenarios through turntable, gyro, denoising filters and metrics, and judges them.
/// Exit codes: 0 all well, 1 a gate failed, 2 usage or scenario error, 3 a channel failed,
/// 4 nothing selected, 70 internal error, 74 input/output error, 75 a shard that SIGTERM stopped and that
/// goes on when it is started again, 129, 130 and 143 ended by SIGHUP, SIGINT and SIGTERM.
#[derive(Debug, Parser)]
#[command(
    name = "fogbench",
    version = VERSION,
    propagate_version = true,
    arg_required_else_help = true
)]
pub(in crate::cli) struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub(in crate::cli) command: Command,
    /// Colours: on terminals unless `NO_COLOR` is set, always or never
    #[arg(long, value_name = "WHEN", value_enum, default_value_t = Colour::Auto, global = true)]
    pub(in crate::cli) color: Colour,
}

/// Commands.
#[derive(Debug, Subcommand)]
pub(in crate::cli) enum Command {
    /// Begin a scenario for a gyro of your own
    Init(InitOptions),
    /// Run scenarios in parallel, write results and evaluate gates
    Run(RunOptions),
    /// List what there is to run in parts on many machines, and write the plan of it
    Plan(PlanOptions),
    /// Make one output folder of the parts that `run --shard` ran, judged as `run` judges
    Merge(MergeOptions),
    /// Say which parts of a plan are done, failed or missing
    Status(StatusOptions),
    /// Check scenario files without running them
    Check(SelectOptions),
    /// Print every resolved run of scenario files, defaults and sweeps included
    Expand(ExpandOptions),
    /// List the runs that a selection holds
    List(ListOptions),
    /// Print what a scenario may hold: every key with type, range, unit, default and meaning
    Reference(ReferenceOptions),
    /// Print the JSON Schema of scenario files
    Schema,
    /// Compare results with earlier ones or with a baseline, metric by metric
    Compare(CompareOptions),
    /// Keep results in a file to compare later ones with
    Baseline(BaselineOptions),
    /// Print the noise budget of a gyro in closed form, without a run
    Budget(BudgetOptions),
    /// Say which settings make all figures of a paper or a data sheet at once
    Infer(InferOptions),
    /// Measure a recorded log: every metric that needs no true rate
    Analyze(AnalyzeOptions),
    /// Replay a recorded log through the filters of a scenario and measure what they make of it
    Filter(FilterLogOptions),
    /// Say what else would read the same as a claimed reduction of noise
    Claim(ClaimOptions),
    /// Find the errors of a three-axis assembly from group means or a simulated campaign
    Calibrate(CalibrateOptions),
    /// Find scale factor, offset and nonlinearity of a gyro from mean outputs at constant rates
    ScaleFactor(ScaleFactorOptions),
    /// Print clocks, units and sample rates of a filter in hardware
    Timing(TimingOptions),
    /// Find the shortest fixed-point words of a filter in hardware, and say what each bit costs
    Wordlength(WordLengthOptions),
    /// Write golden vectors, waveforms or RTL of a hardware pipeline into a folder
    Export(ExportOptions),
    /// Write words of a gyro with their true rate, for filters to be tried on and published against
    Records(RecordsOptions),
    /// Print completions of this command line for a shell
    Completions(CompletionsOptions),
    /// Print the page of the manual, or write those of all commands, as roff
    Man(ManOptions),
}

/// Which scenarios.
#[derive(Args, Debug)]
pub(in crate::cli) struct SelectOptions {
    /// Scenario files and folders [default: every folder of scenarios/]
    pub(in crate::cli) paths: Vec<PathBuf>,
    /// Override a key of every selected scenario; `filter.<name>.<key>` reaches into a filter
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(in crate::cli) set: Vec<String>,
    /// Only scenarios of these names, in which `*` stands for any text and `?` for one character
    #[arg(long = "filter", value_name = "GLOB")]
    pub(in crate::cli) names: Vec<String>,
}

/// Options of `expand`.
#[derive(Args, Debug)]
pub(in crate::cli) struct ExpandOptions {
    #[command(flatten)]
    pub(in crate::cli) select: SelectOptions,
    /// Say behind each value of a single run where it comes from: `assumed` where nobody set it, the base
    /// that says it, or --set
    #[arg(long)]
    pub(in crate::cli) origins: bool,
}

/// Whose results `run --resume` takes over.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum ResumeFrom {
    /// Those of this very build
    SameBuild,
    /// Those of any build of this version
    AnyBuild,
}

/// Options of `reference`.
#[derive(Args, Debug)]
pub(in crate::cli) struct ReferenceOptions {
    /// A key or a table, as in gyro.noise or filter.rls.taps [default: all]
    pub(in crate::cli) key: Option<String>,
}

/// Options of `completions`.
#[derive(Args, Debug)]
pub(in crate::cli) struct CompletionsOptions {
    /// Shell that completes
    #[arg(value_enum)]
    pub(in crate::cli) shell: Shell,
}

/// Options of `man`.
#[derive(Args, Debug)]
pub(in crate::cli) struct ManOptions {
    /// Folder that receives a page for each command [default: print that of the program]
    #[arg(value_name = "DIR")]
    pub(in crate::cli) folder: Option<PathBuf>,
    /// Replace files that stand there, be they no such pages
    #[arg(long, requires = "folder")]
    pub(in crate::cli) force: bool,
}

/// Options of `budget`.
#[derive(Args, Debug)]
pub(in crate::cli) struct BudgetOptions {
    /// Scenario file, or a base without a name
    pub(in crate::cli) path: PathBuf,
    /// Override a key
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(in crate::cli) set: Vec<String>,
    /// Folder for budget.svg and budget.csv [default: neither is written]
    #[arg(short, long, value_name = "DIR")]
    pub(in crate::cli) output: Option<PathBuf>,
    /// Replace files in the folder that fogbench did not write
    #[arg(long, requires = "output")]
    pub(in crate::cli) force: bool,
    /// Form of the budget on stdout
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(in crate::cli) format: Format,
}

/// Options of `list`.
#[derive(Args, Debug)]
pub(in crate::cli) struct ListOptions {
    #[command(flatten)]
    pub(in crate::cli) select: SelectOptions,
    /// Form of the list
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(in crate::cli) format: Format,
}

/// Options of `run`.
#[derive(Args, Debug)]
pub(in crate::cli) struct RunOptions {
    #[command(flatten)]
    pub(in crate::cli) select: SelectOptions,
    /// Folder for the results
    #[arg(short, long, value_name = "DIR", default_value = "output")]
    pub(in crate::cli) output: PathBuf,
    /// Replace files and folders that fogbench did not write, or that were changed since
    #[arg(long)]
    pub(in crate::cli) force: bool,
    /// Take over undamaged results of the same build, scenario, seed and inputs; `any-build`: of any
    /// build of this version
    #[arg(long, value_name = "BUILD", num_args = 0..=1, require_equals = true,
          default_missing_value = "same-build")]
    pub(in crate::cli) resume: Option<ResumeFrom>,
    /// Start the programs that filters of the kind `process` name; without it nothing is started
    #[arg(long)]
    pub(in crate::cli) allow_programs: bool,
    /// Start no further run once one has failed, be it by a gate
    #[arg(long)]
    pub(in crate::cli) fail_fast: bool,
    #[command(flatten)]
    pub(in crate::cli) shard: ShardOptions,
    #[command(flatten)]
    pub(in crate::cli) account: AccountOptions,
}

/// How a suite is judged and told, be it run or merged.
#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct AccountOptions {
    /// Fail where no selected scenario has a gate
    #[arg(long)]
    pub(in crate::cli) require_gates: bool,
    /// Threads, at most 256; 0 = RAYON_NUM_THREADS, else one per core; no result depends on it
    #[arg(short, long, value_name = "N", default_value_t = 0,
          value_parser = clap::value_parser!(u16).range(0..=256))]
    pub(in crate::cli) jobs: u16,
    /// Print the full account of every run, as for a single one; else a line of each scenario
    #[arg(short, long, conflicts_with = "quiet")]
    pub(in crate::cli) verbose: bool,
    /// Print what failed and the verdict alone, and no progress
    #[arg(short, long)]
    pub(in crate::cli) quiet: bool,
    /// Form of the results on stdout
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(in crate::cli) format: Format,
    #[command(flatten)]
    pub(in crate::cli) against: AgainstOptions,
    #[command(flatten)]
    pub(in crate::cli) server: BuildServerOptions,
}
