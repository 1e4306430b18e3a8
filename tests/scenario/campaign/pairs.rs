//! Two processes that write into one output folder at the same time.

use std::thread;
use std::time::Duration;

use super::case::Fault;
use super::setting;
use super::tally::Tally;
use super::yard::{Ended, Start, Version, Yard};
use crate::support::seeded::{Draws, case_seed};

/// Pairs of the small form.
const SMALL: u64 = 4;
/// Exit code of the process that finds the folder in use.
const IN_USE: i32 = 74;

#[test]
fn of_two_processes_on_one_folder_one_writes_at_a_time() {
    let yard = Yard::new();
    let mut tally = Tally::default();
    let campaign_seed = setting("FOGBENCH_SEED", 12);
    for index in 0..setting("FOGBENCH_PAIRS", SMALL) {
        let seed = case_seed(campaign_seed, index);
        if let Err(fault) = pair(&yard, &mut Draws::new(seed), &mut tally) {
            tally.fault("pair", seed, &fault, "");
        }
    }
    println!("{}", tally.report());
    assert!(tally.is_clean(), "faults:\n{}", tally.report());
}

fn pair(yard: &Yard, draws: &mut Draws, tally: &mut Tally) -> Result<(), Fault> {
    let start = *draws.pick(&[Start::Empty, Start::Old, Start::New]);
    yard.prepare("out", start)?;
    let versions = [Version::New, *draws.pick(&[Version::New, Version::Old])];
    let arguments = versions.map(|version| {
        let jobs = *draws.pick(&["1", "2"]);
        yard.arguments("out", version, &["-j", jobs])
    });
    let delay = yard.length.mul_f64(draws.unit() * draws.unit() * 1.2);
    let first = yard.start(&arguments[0]);
    thread::sleep(if draws.chance(0.3) {
        Duration::ZERO
    } else {
        delay
    });
    let second = yard.start(&arguments[1]);
    let ended = [first.end(), second.end()];
    for (ended, version) in ended.iter().zip(versions) {
        check_end(yard, ended, version)?;
    }
    yard.check_whole("out")?;
    let winners: Vec<Version> = ended
        .iter()
        .zip(versions)
        .filter(|(ended, _)| ended.code == yard.exit)
        .map(|(_, version)| version)
        .collect();
    tally.count(match winners.len() {
        0 => return Err(Fault::new("both lose", ended[0].talk.clone())),
        1 => "one wrote, the other gave way",
        _ => "both wrote in turn",
    });
    let finals = winners
        .iter()
        .map(|version| yard.check_final("out", *version));
    let results: Vec<_> = finals.collect();
    match results.iter().any(Result::is_ok) {
        true => Ok(()),
        false => results.into_iter().next_back().unwrap_or(Ok(())),
    }
}

/// A process wrote everything, or says who is at work.
fn check_end(yard: &Yard, ended: &Ended, version: Version) -> Result<(), Fault> {
    let is_told = ended.talk.contains("in use by process");
    if ended.code == yard.exit || ended.code == IN_USE && is_told {
        return Ok(());
    }
    let message = format!("{version:?}: {} {}", ended.code, ended.talk);
    Err(Fault::new("wrong end of one of two", message))
}
