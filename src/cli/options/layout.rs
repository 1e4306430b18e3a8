//! How a log is read: one option for each key of the table `[log]`, made of its declaration.

use clap::builder::{PossibleValuesParser, ValueParser};
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches};

use crate::cli::options::numbers::within;
use crate::declare::{Content, Kind, Row};
use crate::recording::LogFormat;
use crate::scenario::Setting;

/// The keys of `[log]` that options give.
#[derive(Clone, Debug, Default)]
pub(in crate::cli) struct LayoutOptions {
    /// Keys with their values, in the order of the declaration.
    pub(in crate::cli) given: Vec<(&'static str, Setting)>,
}

/// The key of the file that is read: an argument of every command.
const FILE: &str = "file";

/// The rows that are options, with their kinds.
fn rows() -> impl Iterator<Item = (&'static Row, Kind)> {
    let rows = LogFormat::TABLE.rows.iter();
    let rows = rows.filter(|row| row.name != FILE);
    rows.filter_map(|row| match row.content {
        Content::Value(kind) => Some((row, kind)),
        Content::Table(_) | Content::Tables(_) => None,
    })
}

fn option(row: &'static Row, kind: Kind) -> Arg {
    let help: Vec<&str> = row.doc.iter().map(|line| line.trim()).collect();
    let help = help.join(" ");
    let value = match row.unit {
        "" => row.name.rsplit('_').next().unwrap_or(row.name),
        unit => unit,
    };
    let option = Arg::new(row.name)
        .long(row.name.replace('_', "-"))
        .help(help.trim_end_matches('.').to_owned())
        .value_name(value.to_uppercase());
    match kind {
        Kind::Boolean => option.action(ArgAction::SetTrue),
        // Texts may hold commas: they are taken apart where their quotes are known.
        Kind::Texts => option
            .action(ArgAction::Append)
            .value_parser(parser(row, kind)),
        Kind::Choices(_) => option
            .action(ArgAction::Append)
            .value_delimiter(',')
            .value_parser(parser(row, kind)),
        _ => option
            .allow_negative_numbers(true)
            .value_parser(parser(row, kind)),
    }
}

fn parser(row: &'static Row, kind: Kind) -> ValueParser {
    match kind {
        Kind::Float(range) => ValueParser::new(within(range.low, range.high, row.unit)),
        Kind::Integer(range) => clap::value_parser!(i64).range(range.min..=range.max).into(),
        Kind::Choice(words) | Kind::Choices(words) => PossibleValuesParser::new(words).into(),
        _ => clap::builder::NonEmptyStringValueParser::new().into(),
    }
}

/// The value of an option, if it is given.
fn value(row: &'static Row, kind: Kind, given: &ArgMatches) -> Option<Setting> {
    let id = row.name;
    match kind {
        Kind::Float(_) => given.get_one::<f64>(id).map(|number| (*number).into()),
        Kind::Integer(_) => given.get_one::<i64>(id).map(|number| (*number).into()),
        Kind::Boolean => given.get_flag(id).then(|| true.into()),
        Kind::Texts => {
            let texts = given.get_many::<String>(id)?;
            Some(texts.flat_map(|text| parts(text)).collect())
        }
        Kind::Choices(_) => {
            let texts = given.get_many::<String>(id)?;
            Some(texts.cloned().collect())
        }
        _ => given.get_one::<String>(id).map(|text| text.clone().into()),
    }
}

/// The texts of one argument: between commas, but for those inside of `"`.
fn parts(text: &str) -> Vec<String> {
    const QUOTE: char = '"';
    let (mut parts, mut part, mut is_quoted) = (Vec::new(), String::new(), false);
    for letter in text.chars() {
        match letter {
            QUOTE => is_quoted = !is_quoted,
            ',' if !is_quoted => parts.push(std::mem::take(&mut part)),
            letter => part.push(letter),
        }
    }
    // A quote that does not end is a letter, as that of an inch is.
    if is_quoted {
        return text.split(',').map(str::to_owned).collect();
    }
    parts.push(part);
    parts
}

impl FromArgMatches for LayoutOptions {
    fn from_arg_matches(given: &ArgMatches) -> Result<Self, clap::Error> {
        let given = rows().filter_map(|(row, kind)| Some((row.name, value(row, kind, given)?)));
        Ok(Self {
            given: given.collect(),
        })
    }

    fn update_from_arg_matches(&mut self, given: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(given)?;
        Ok(())
    }
}

impl Args for LayoutOptions {
    fn augment_args(command: Command) -> Command {
        command.args(rows().map(|(row, kind)| option(row, kind)))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

#[cfg(test)]
mod tests {
    use super::parts;

    #[test]
    fn a_comma_inside_of_quotes_is_one_of_the_heading() {
        assert_eq!(parts("g_x,g_y"), ["g_x", "g_y"]);
        assert_eq!(parts("\"rate, z [deg/s]\",g_y"), ["rate, z [deg/s]", "g_y"]);
        assert_eq!(parts("3.5\",g_y"), ["3.5\"", "g_y"]);
        assert_eq!(parts("g,"), ["g", ""]);
    }
}
