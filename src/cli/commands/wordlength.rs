//! `fogbench wordlength`: the shortest fixed-point words of a filter.

use std::fmt::Write as _;
use std::io;

use serde_json::{Value, json};

use crate::cli::options::wordlength::WordLengthOptions;
use crate::cli::terminal::complaint;
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;
use crate::cli::terminal::place::Place;
use crate::experiment::{WordLengthLimits, WordLengthTrial, WordLengths, plan_suite, word_lengths};
use crate::report::{WordLengthPoint, WordLengthSheet, word_length_pictures};
use crate::wording::counted;

/// Searches and prints the trials, and the table of the shortest words; with a folder, writes them there as
/// well, and their picture.
pub(in crate::cli) fn wordlength(options: &WordLengthOptions) -> io::Result<Exit> {
    let place = Place::new(options.output.as_deref(), "wordlength", options.force);
    if let Err(exit) = place.check(&[&options.path]) {
        return Ok(exit);
    }
    let plans = match plan_suite(std::slice::from_ref(&options.path), &options.set) {
        Ok(plans) => plans,
        Err(errors) => {
            complaint::print(&errors);
            return Ok(Exit::Usage);
        }
    };
    let path = options.path.display();
    let [plan] = plans.as_slice() else {
        let runs = counted(plans.len(), "run");
        complaint::print(&[format!("{path}: holds {runs}: expected one")]);
        return Ok(Exit::Usage);
    };
    let limits = WordLengthLimits {
        arw_ratio_max: options.max_arw_ratio,
        delay_change_max_us: options.max_delay_change_us,
        survive_s: options.survive_s,
    };
    let found = match word_lengths(plan, &options.name, limits) {
        Ok(found) => found,
        Err(error) => {
            complaint::print(&[format!("{path}: {error}")]);
            return Ok(Exit::Usage);
        }
    };
    let (text, json) = (
        text(&found, &options.name),
        format!("{:#}\n", json_of(&found)),
    );
    if options.output.is_some() {
        let title = format!(
            "{}: words of {}",
            plan.resolved().scenario.name,
            options.name
        );
        let pictures = word_length_pictures(&sheet(&found, title, limits));
        let own = [("wordlength.txt", &*text), ("wordlength.json", &*json)];
        if let Err(exit) = place.fill_with(&own, &pictures, &[]) {
            return Ok(exit);
        }
    }
    output::data(&options.format.of(|| text, || json)?)?;
    Ok(match found.best() {
        Some(_) => Exit::Success,
        None => Exit::GateFailed,
    })
}

/// What the picture shows of a search.
fn sheet(found: &WordLengths, title: String, limits: WordLengthLimits) -> WordLengthSheet {
    let best = found.best();
    let trials = found.uniform.iter().chain(&found.greedy);
    let points = trials.map(|trial| WordLengthPoint {
        bits: trial.words.total_bits(),
        is_uniform: found.uniform.contains(trial),
        arw_ratio: trial.arw_ratio,
        delay_change_us: trial.delay_change_us,
        diverged_at_s: trial.diverged_at_s,
        is_pareto: found.is_pareto(trial),
        is_best: best.is_some_and(|best| std::ptr::eq(best, trial)),
    });
    let ratios = limits.arw_ratios();
    WordLengthSheet {
        title,
        points: points.collect(),
        arw_ratios: [*ratios.start(), *ratios.end()],
        delay_change_max_us: limits.delay_change_max_us,
        filtered_s: found.filtered_s,
    }
}

fn text(found: &WordLengths, name: &str) -> String {
    let mut text = format!(
        "{} of the gyro; * no other words are better in bits, noise, delay and life at once\n",
        counted(found.samples, "sample")
    );
    write_head(&mut text, found);
    for trial in &found.uniform {
        write_row(&mut text, found, trial);
    }
    if !found.greedy.is_empty() {
        text.push_str("signal by signal\n");
    }
    for trial in &found.greedy {
        write_row(&mut text, found, trial);
    }
    match found.best() {
        Some(best) => {
            // Writing to a string cannot fail.
            let _ = write!(
                text,
                "\n# filter `{name}`: pipeline = \"fpga\", number_format = \"fixed\"\n\
                 [filter.{}.fixed]\n{}",
                found.kind,
                best.words.to_toml()
            );
        }
        None => text.push_str("\nno words of up to 48 bits do\n"),
    }
    text
}

fn write_head(text: &mut String, found: &WordLengths) {
    text.push_str("   bits ");
    let trial = found.uniform.first();
    let signals = trial.map_or(&[][..], |trial| &trial.words.signals);
    for (name, _) in signals {
        // Writing to a string cannot fail.
        let _ = write!(text, " {name:>2}");
    }
    text.push_str("  ARW/binary64  delay - binary64 us  indefinite s  fails s\n");
}

fn write_row(text: &mut String, found: &WordLengths, trial: &WordLengthTrial) {
    let mark = if found.is_pareto(trial) { '*' } else { ' ' };
    let _ = write!(text, "{mark}  {:>4} ", trial.words.total_bits());
    for (_, word) in &trial.words.signals {
        let _ = write!(text, " {:>2}", word.word_bits);
    }
    let figure = |value: Option<f64>, digits: usize| {
        value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
    };
    let _ = writeln!(
        text,
        "  {:>12}  {:>19}  {:>12}  {:>7}",
        figure(trial.arw_ratio, 4),
        figure(trial.delay_change_us, 3),
        figure(trial.indefinite_at_s, 3),
        figure(trial.diverged_at_s, 3)
    );
}

fn json_of(found: &WordLengths) -> Value {
    let trial = |trial: &WordLengthTrial| {
        let signals = trial.words.signals.iter();
        let bits: serde_json::Map<String, Value> = signals
            .map(|(name, word)| ((*name).to_owned(), word.word_bits.into()))
            .collect();
        json!({
            "word_bits": bits, "total_bits": trial.words.total_bits(),
            "arw_ratio": trial.arw_ratio, "delay_change_us": trial.delay_change_us,
            "indefinite_at_s": trial.indefinite_at_s, "diverged_at_s": trial.diverged_at_s,
            "does": trial.does, "pareto": found.is_pareto(trial),
        })
    };
    json!({
        "samples": found.samples,
        "uniform": found.uniform.iter().map(trial).collect::<Vec<_>>(),
        "greedy": found.greedy.iter().map(trial).collect::<Vec<_>>(),
        "best": found.best().map(|best| best.words.to_toml()),
    })
}
