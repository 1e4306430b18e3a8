//! Options that would do nothing beside the others: refused, each with its reason and the way out.
//!
//! Invariant: an option that is given acts, or the command ends with a usage error; a default never is
//! an error. What clap can say (`requires`, `conflicts_with`) stands at the options; here stands what
//! depends on the value of another one. Clap need not ask for what an option requires if a third one
//! excludes it: where it does not, the two exclude each other by themselves.

use clap::error::ErrorKind;
use clap::parser::ValueSource;
use clap::{ArgMatches, CommandFactory as _, FromArgMatches as _};

use crate::cli::options::arguments::{Arguments, Command};
use crate::cli::options::calibrate::CalibrateOptions;
use crate::cli::options::hardware::{ExportOptions, FilterOptions, Kind, TimingOptions};
use crate::cli::options::log::LogOptions;
use crate::recording::LogMotion;
use crate::vocabulary::{ExportForm, UnitSource, WordFormat};
use crate::wording::option_of;

/// Reads the command line.
///
/// # Errors
/// What clap refuses, and options that would do nothing.
pub(in crate::cli) fn parse() -> Result<Arguments, clap::Error> {
    let arguments = std::env::args_os();
    parse_from(arguments.collect())
}

fn parse_from(words: Vec<std::ffi::OsString>) -> Result<Arguments, clap::Error> {
    let mut command = Arguments::command();
    let matches = command.try_get_matches_from_mut(words)?;
    let arguments = Arguments::from_arg_matches(&matches).map_err(|it| it.format(&mut command))?;
    let Some((name, given)) = matches.subcommand() else {
        return Ok(arguments);
    };
    let complaints = complaints(&arguments.command, given);
    if complaints.is_empty() {
        return Ok(arguments);
    }
    let message = complaints.join("\nerror: ");
    let kind = ErrorKind::ArgumentConflict;
    Err(match command.find_subcommand_mut(name) {
        Some(subcommand) => subcommand.error(kind, message),
        None => command.error(kind, message),
    })
}

/// The options given on the command line that do nothing.
fn complaints(command: &Command, given: &ArgMatches) -> Vec<String> {
    match command {
        Command::Analyze(options) => of_log(&options.log, given),
        Command::Filter(options) => of_log(&options.log, given),
        Command::Timing(options) => of_timing(options, given),
        Command::Export(options) => of_export(options, given),
        Command::Calibrate(options) => of_calibrate(options),
        Command::Init(_)
        | Command::Run(_)
        | Command::Plan(_)
        | Command::Merge(_)
        | Command::Status(_)
        | Command::Check(_)
        | Command::Expand(_)
        | Command::List(_)
        | Command::Reference(_)
        | Command::Schema
        | Command::Compare(_)
        | Command::Baseline(_)
        | Command::Budget(_)
        | Command::Claim(_)
        | Command::Infer(_)
        | Command::Records(_)
        | Command::ScaleFactor(_)
        | Command::Wordlength(_)
        | Command::Completions(_)
        | Command::Man(_) => Vec::new(),
    }
}

/// Those of some options that are given, as they are typed.
fn typed<'a>(given: &ArgMatches, ids: &[&'a str]) -> Vec<String> {
    let is_given = |id: &&&'a str| given.value_source(id) == Some(ValueSource::CommandLine);
    let ids = ids.iter().filter(is_given);
    ids.map(|id| option_of(id)).collect()
}

/// An assembly has no reference; a swing no Allan curve, no noise fit and no means at rest.
fn of_log(options: &LogOptions, given: &ArgMatches) -> Vec<String> {
    if !options.columns.is_empty() {
        let idle = typed(given, &["reference_column", "reference_unit"]).into_iter();
        let idle: Vec<String> = idle
            .map(|option| format!("{option} has no effect beside --columns: leave one of them out"))
            .collect();
        if !idle.is_empty() {
            return idle;
        }
    }
    let gives_axis = ["columns", "calibration", "temperature_model", "layout"];
    let is_given = |id: &&str| matches!(given.try_contains_id(id), Ok(true));
    if !gives_axis.iter().any(is_given) && !typed(given, &["axis"]).is_empty() {
        return vec![
            "--axis has no effect without --calibration, or --temperature-model: leave it out"
                .to_owned(),
        ];
    }
    const AT_REST: [&str; 4] = [
        "bias_averaging_time_s",
        "fit_tau_min_s",
        "allan_estimator",
        "averaging_times",
    ];
    let motion = given.try_get_one::<String>("motion").ok().flatten();
    let motion = motion.and_then(|motion| motion.parse().ok());
    let what = match motion {
        Some(LogMotion::Swing { .. }) => "a swing",
        Some(LogMotion::Dwells) => "dwells",
        _ => {
            let idle = typed(given, &["settle_s"]).into_iter();
            let without = "has no effect without dwells: leave it out, or say --motion dwells";
            return idle.map(|option| format!("{option} {without}")).collect();
        }
    };
    let idle = typed(given, &AT_REST).into_iter();
    idle.map(|option| {
        format!("{option} has no effect on {what}: leave it out, or --motion if the gyro rested")
    })
    .collect()
}

/// Constants that a kind of filter does not have.
fn of_filter(options: &FilterOptions, given: &ArgMatches) -> Vec<String> {
    const OF_RLS: [&str; 3] = [
        "division",
        "forgetting_factor",
        "initial_inverse_correlation",
    ];
    let (kind, foreign): (_, &[&str]) = match options.kind {
        Kind::Rls => ("rls", &["step_size", "regularisation"]),
        Kind::Lms => ("lms", &["regularisation"]),
        Kind::Nlms => ("nlms", &[]),
        Kind::SignLms => ("sign-lms", &[]),
    };
    let of_rls: &[&str] = match options.kind {
        Kind::Rls => &[],
        _ => &OF_RLS,
    };
    let idle = typed(given, foreign)
        .into_iter()
        .chain(typed(given, of_rls));
    let mut complaints: Vec<String> = idle
        .map(|option| {
            format!("{option} has no effect on --kind {kind}: leave it out, or name another kind")
        })
        .collect();
    if options.number_format == WordFormat::Fixed && options.kind == Kind::Rls {
        complaints.extend(of_fixed(given, &["division"]));
    }
    complaints
}

/// Options that fixed point has no use for.
fn of_fixed(given: &ArgMatches, ids: &[&str]) -> Vec<String> {
    let idle = typed(given, ids).into_iter();
    idle.map(|option| {
        format!("{option} has no effect on --number-format fixed: leave one of them out")
    })
    .collect()
}

fn of_timing(options: &TimingOptions, given: &ArgMatches) -> Vec<String> {
    let kind = options.filter.kind;
    let mut complaints = of_filter(&options.filter, given);
    if options.filter.number_format == WordFormat::Fixed {
        complaints.extend(of_fixed(given, &["initiation_interval"]));
        let idle: &[&str] = match kind {
            Kind::Rls => &["ram_ports"],
            // Nothing but their divider can be waited for.
            _ => &["adder_latency", "multiplier_latency"],
        };
        complaints.extend(of_fixed(given, idle));
    }
    if kind != Kind::Rls && !typed(given, &["ram_ports"]).is_empty() {
        complaints.push(
            "--ram-ports has no effect but on --kind rls, the only one with an interleaved model: \
             leave it out"
                .to_owned(),
        );
    }
    if kind == Kind::Lms && !typed(given, &["divider_latency"]).is_empty() {
        complaints.push(
            "--divider-latency has no effect on --kind lms, which divides nowhere: leave it out"
                .to_owned(),
        );
    }
    complaints
}

fn of_export(options: &ExportOptions, given: &ArgMatches) -> Vec<String> {
    const OF_FILTER: [&str; 9] = [
        "kind",
        "taps",
        "clock_mhz",
        "division",
        "forgetting_factor",
        "initial_inverse_correlation",
        "step_size",
        "regularisation",
        "number_format",
    ];
    let mut complaints = match &options.name {
        Some(name) => {
            let idle = typed(given, &OF_FILTER).into_iter();
            idle.map(|option| {
                format!(
                    "{option} has no effect beside --filter {name}, which is taken from the scenario \
                     as it stands there: change the key in the scenario, or leave --filter out to \
                     describe a filter by options"
                )
            })
            .collect()
        }
        None => of_filter(&options.filter, given),
    };
    let is_fixed = options.filter.number_format == WordFormat::Fixed;
    if options.name.is_none() && is_fixed {
        complaints.extend(of_fixed(given, &["units"]));
    }
    let is_counted = !typed(given, &["samples"]).is_empty();
    if options.what == ExportForm::Waveform && is_counted && options.samples > options.trace_samples
    {
        complaints.push(format!(
            "--samples {} has no effect on a waveform of {} samples: give --trace-samples {0} to draw \
             as many",
            options.samples, options.trace_samples
        ));
    }
    if options.what != ExportForm::Rtl {
        let idle = typed(given, &["units", "synth"]).into_iter();
        complaints.extend(
            idle.map(|option| {
                format!("{option} has no effect but on an export of rtl: leave it out")
            }),
        );
    }
    if options.synth.is_some() && options.units == Some(UnitSource::Behavioural) {
        complaints.push(
            "--units behavioural has no effect beside --synth: leave it out, as they cannot be \
             synthesised"
                .to_owned(),
        );
    }
    complaints
}

/// A key that an option and `--set` both give.
fn of_calibrate(options: &CalibrateOptions) -> Vec<String> {
    let keys = |set: &String| set.split('=').next().unwrap_or_default().trim().to_owned();
    let set: Vec<String> = options.set.iter().map(keys).collect();
    let twice = options.keys_given().into_iter();
    twice
        .filter(|(_, key)| set.contains(key))
        .map(|(option, key)| {
            format!("{option} and --set {key} give the same key: leave one of them out")
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use clap::Parser as _;

    use super::*;

    /// The complaints about a command line that clap itself accepts.
    fn refused(line: &str) -> String {
        let words = line.split(' ').map(Into::into).collect();
        match parse_from(words) {
            Ok(_) => String::new(),
            Err(error) => error.to_string(),
        }
    }

    #[test]
    fn the_command_line_is_sound() {
        Arguments::command().debug_assert();
        assert!(Arguments::try_parse_from(["fogbench", "schema"]).is_ok());
    }

    /// Asserts that a command line is refused for some options, each with the reason.
    #[track_caller]
    fn assert_idle(line: &str, options: &[&str], reason: &str) {
        let text = refused(line);
        assert!(text.contains(reason), "{line}: {text}");
        for option in options {
            assert!(
                text.contains(&format!("error: {option} ")),
                "{line}: {text}"
            );
        }
        let complaints = text.matches("error: ").count();
        assert_eq!(complaints, options.len(), "{line}: {text}");
    }

    #[test]
    fn options_of_a_record_at_rest_are_refused_beside_a_swing() {
        assert_idle(
            "fogbench analyze a.csv --unit deg/h --rate-hz 100 --motion swing:5 \
             --bias-averaging-time-s 1 --fit-tau-min-s 1 --allan-estimator plain \
             --averaging-times all",
            &[
                "--bias-averaging-time-s",
                "--fit-tau-min-s",
                "--allan-estimator",
                "--averaging-times",
            ],
            "on a swing",
        );
    }

    #[test]
    fn options_that_describe_a_filter_are_refused_beside_one_of_a_scenario() {
        assert_idle(
            "fogbench export rtl out --scenario a.toml --filter rls --kind rls --taps 4 \
             --clock-mhz 40 --division elementwise --forgetting-factor 1 \
             --initial-inverse-correlation 1 --step-size 1 --regularisation 1 \
             --number-format binary32",
            &[
                "--kind",
                "--taps",
                "--clock-mhz",
                "--division",
                "--forgetting-factor",
                "--initial-inverse-correlation",
                "--step-size",
                "--regularisation",
                "--number-format",
            ],
            "beside --filter rls",
        );
    }

    #[test]
    fn constants_that_a_kind_of_filter_lacks_are_refused() {
        let stimulus = "fogbench export waveform out --stimulus a.csv";
        assert_idle(
            "fogbench timing --step-size 1 --regularisation 1",
            &["--step-size", "--regularisation"],
            "on --kind rls",
        );
        assert_idle(
            "fogbench timing --kind lms --division elementwise --forgetting-factor 0.9 \
             --initial-inverse-correlation 1 --regularisation 1 --ram-ports 2 --divider-latency 9",
            &[
                "--division",
                "--forgetting-factor",
                "--initial-inverse-correlation",
                "--regularisation",
                "--ram-ports",
                "--divider-latency",
            ],
            "--kind lms",
        );
        assert_idle(
            &format!("{stimulus} --samples 20 --kind nlms --division reciprocal"),
            &["--samples 20", "--division"],
            "has no effect on",
        );
        assert_idle(
            &format!("{stimulus} --kind sign-lms --forgetting-factor 0.5"),
            &["--forgetting-factor"],
            "on --kind sign-lms",
        );
    }

    #[test]
    fn what_fixed_point_lacks_is_refused() {
        assert_idle(
            "fogbench timing --number-format fixed --division elementwise --initiation-interval 2 \
             --ram-ports 2",
            &["--division", "--initiation-interval", "--ram-ports"],
            "--number-format fixed",
        );
        assert_idle(
            "fogbench timing --number-format fixed --kind lms --adder-latency 2 --multiplier-latency 2",
            &["--adder-latency", "--multiplier-latency"],
            "--number-format fixed",
        );
    }

    #[test]
    fn a_key_given_twice_is_refused() {
        assert_idle(
            "fogbench calibrate a.toml --estimator batch --set calibration.apply=arls",
            &["--estimator and --set calibration.apply"],
            "leave one of them out",
        );
    }

    #[test]
    fn options_that_need_another_one_ask_for_it() {
        let log = "fogbench analyze a.csv --unit deg/h --rate-hz 100";
        for (line, lacking) in [
            (
                format!("{log} --columns a,b,c --axis x --calibration c --column gx"),
                "--column",
            ),
            (format!("{log} --axis x"), "--calibration"),
            (format!("{log} --columns a,b,c"), "--calibration"),
            (format!("{log} --compensation-form exact"), "--columns"),
            (
                "fogbench filter a.csv --unit deg/h --rate-hz 1 --filters a.toml --csv".to_owned(),
                "--output",
            ),
            (
                "fogbench export rtl o --scenario a.toml --column 2".to_owned(),
                "--scenario",
            ),
            (
                "fogbench export rtl o --stimulus a.csv --filter rls".to_owned(),
                "--stimulus",
            ),
        ] {
            let text = refused(&line);
            assert!(text.contains(lacking), "{line}: {text}");
        }
    }

    #[test]
    fn options_that_act_and_defaults_are_taken() {
        for line in [
            "fogbench analyze a.csv --unit deg/h --rate-hz 100 --motion swing:5 --warm-up-s 1",
            "fogbench analyze a.csv --unit deg/h --time t --time-unit ms --averaging-times all",
            "fogbench timing --division elementwise --forgetting-factor 0.9 --ram-ports 2",
            "fogbench timing --kind nlms --regularisation 1 --divider-latency 9",
            "fogbench timing --kind sign-lms --step-size 1 --divider-latency 9",
            "fogbench timing --number-format fixed --forgetting-factor 0.9 --divider-latency 9",
            "fogbench timing --number-format fixed --kind nlms --divider-latency 9",
            "fogbench export rtl out --scenario a.toml --filter rls --samples 20 --trace-samples 5",
            "fogbench export rtl out --scenario a.toml --kind lms --taps 8 --step-size 0.1",
            "fogbench export waveform out --stimulus a.csv --column 2 --samples 20 --trace-samples 20",
            "fogbench calibrate a.toml --estimator batch --set seed=2",
        ] {
            assert_eq!(refused(line), "", "{line}");
        }
    }
}
