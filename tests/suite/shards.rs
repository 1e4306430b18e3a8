//! Suites in parts: `plan`, `run --shard`, `status` and `merge` end as one suite does, or say why not.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::support::{code, fogbench, stderr, stdout, tree, write};

/// A sweep with repeats and a table, a swing with more of them, a run with samples and one whose filter fails.
fn suite(folder: &Path) {
    let short = "schema = 1\nduration_s = 0.5\nwarm_up_s = 0.1\nfidelity = \"rate\"\n";
    let sweep = "repeats = 2\n[matrix]\n\"gyro.source.power_uw\" = [0.5, 0.87]\n\
                 [[gate]]\nmetric = \"raw.noise_std_deg_per_h\"\nmax = 0.1\n\
                 [[comparison]]\nname = \"T\"\ntitle = \"t\"\nkind = \"sensitivity\"\n\
                 columns = [\"raw.noise_std_deg_per_h\"]\n\
                 [[comparison_row]]\ncomparison = \"T\"\nlabel = \"a\"\nscenarios = [\"sweep\"]\n";
    let swing = "repeats = 7\n[turntable.swing]\nfrequency_hz = 10.0\nsoft_start_s = 0.05\n\
                 angle_amplitude_deg = 1.0\n[[filter]]\nname = \"rls\"\n[filter.rls]\ntaps = 4\n";
    let samples = "[output]\nsamples = \"npy\"\n";
    let diverging = "[[filter]]\nname = \"wrong\"\n[filter.lms]\nnormalised = false\n\
                     allow_unstable = true\nstep_size = 1.0\npipeline = \"textbook\"\n";
    for (name, text) in [
        ("sweep", sweep),
        ("swing", swing),
        ("samples", samples),
        ("diverging", diverging),
    ] {
        let text = format!("name = \"{name}\"\n{short}{text}");
        write(folder, &format!("own/{name}.toml"), &text);
    }
}

fn scratch() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a scratch folder");
    suite(folder.path());
    folder
}

fn shard(folder: &Path, which: &str, output: &str, more: &[&str]) -> Output {
    let arguments = [&["run", "own", "--shard", which, "-o", output], more].concat();
    fogbench(folder, &arguments)
}

/// Runs all shards of `count` in the order that `order` gives.
fn shards(folder: &Path, count: usize, output: &str, order: impl Iterator<Item = usize>) {
    for index in order {
        let threads = (index % 3 + 1).to_string();
        let ended = shard(
            folder,
            &format!("{index}/{count}"),
            output,
            &["-j", &threads],
        );
        assert!([0, 3].contains(&code(&ended)), "{}", stderr(&ended));
    }
}

fn refused(output: &Output, words: &str) {
    let said = stderr(output);
    assert_eq!(code(output), 2, "{said}");
    assert!(said.contains(words), "`{words}` in: {said}");
}

#[test]
fn merged_shards_are_an_unsharded_suite_to_the_byte() {
    let folder = scratch();
    let at = folder.path();
    let whole = fogbench(at, &["run", "own", "-o", "whole"]);
    assert_eq!(code(&whole), 3, "a filter fails: {}", stderr(&whole));
    let expected = tree(&at.join("whole"));
    for count in [1, 2, 7] {
        let output = format!("shards-{count}");
        shards(at, count, &output, (1..=count).rev());
        let merged = format!("merged-{count}");
        let ended = fogbench(at, &["merge", &output, "-o", &merged, "-j", "2"]);
        assert_eq!(stdout(&ended), stdout(&whole), "{count}");
        assert_eq!(code(&ended), code(&whole), "{}", stderr(&ended));
        assert!(
            expected == tree(&at.join(&merged)),
            "{count} shards give other bytes"
        );
    }
    // Folders of their own, and merged into one of these.
    fs::create_dir(at.join("far")).expect("writable");
    for entry in fs::read_dir(at.join("shards-2"))
        .expect("readable")
        .flatten()
    {
        let name = entry.file_name().to_string_lossy().into_owned();
        if name.starts_with("shard-0002") {
            fs::rename(entry.path(), at.join("far").join(name)).expect("writable");
        }
    }
    let ended = fogbench(at, &["merge", "far", "shards-2", "-o", "shards-2"]);
    assert_eq!(code(&ended), 3, "{}", stderr(&ended));
    assert_eq!(stdout(&ended), stdout(&whole));
    let again = fogbench(at, &["merge", "shards-2", "far", "-o", "merged-2"]);
    assert_eq!(
        code(&again),
        3,
        "over the results of before: {}",
        stderr(&again)
    );
    assert!(expected == tree(&at.join("merged-2")));
}

#[test]
fn an_assembly_on_a_table_with_an_encoder_is_the_same_in_parts() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    let text = "schema = 1\nname = \"case\"\nduration_s = 0.5\nwarm_up_s = 0.1\nfidelity = \"rate\"\n\
                repeats = 3\n[gyro.assembly]\n[turntable.encoder]\nresolution_arcsec = 1.0\n\
                [[filter]]\nname = \"lms\"\n[filter.lms]\ntaps = 4\n";
    write(at, "own/case.toml", text);
    let whole = fogbench(at, &["run", "own", "-o", "whole"]);
    assert_eq!(code(&whole), 0, "{}", stderr(&whole));
    shards(at, 2, "out", 1..=2);
    let merged = fogbench(at, &["merge", "out", "-o", "merged"]);
    assert_eq!(code(&merged), 0, "{}", stderr(&merged));
    assert_eq!(stdout(&merged), stdout(&whole));
    assert!(tree(&at.join("whole")) == tree(&at.join("merged")));
}

#[test]
fn every_shard_asks_before_it_starts_a_program_and_a_plan_starts_none() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    let text = "schema = 1\nname = \"program\"\nduration_s = 0.5\nwarm_up_s = 0.1\nfidelity = \"rate\"\n\
                [[filter]]\nname = \"own\"\n[filter.process]\ncommand = [\"cat\"]\n";
    write(at, "own/program.toml", text);
    let planned = fogbench(at, &["plan", "own", "-o", "p.plan"]);
    assert_eq!(code(&planned), 0, "{}", stderr(&planned));
    refused(&shard(at, "1/1", "out", &[]), "--allow-programs");
    assert!(!at.join("out").exists());
}

#[test]
fn a_plan_says_what_its_shards_run_and_refuses_other_scenarios() {
    let folder = scratch();
    let at = folder.path();
    let planned = fogbench(
        at,
        &["plan", "own", "-o", "p.plan", "--shards", "3", "--slurm"],
    );
    assert_eq!(code(&planned), 0, "{}", stderr(&planned));
    assert!(
        stdout(&planned).contains("5 runs in 13 parts"),
        "{}",
        stdout(&planned)
    );
    let plan = fs::read_to_string(at.join("p.plan")).expect("readable");
    let runs = plan.lines().filter(|line| line.contains('\t')).skip(1);
    let runs: Vec<Vec<&str>> = runs.map(|line| line.split('\t').collect()).collect();
    assert_eq!(runs.len(), 13);
    assert_eq!(
        (runs[0][0], runs[0][2], runs[0][3]),
        ("1", "diverging", "all")
    );
    assert_eq!(
        (runs[12][0], runs[12][2], runs[12][3]),
        ("13", "swing", "7-7")
    );
    let script = fs::read_to_string(at.join("p.plan.slurm")).expect("readable");
    for words in [
        "--array=1-3",
        "--requeue",
        "--open-mode=append",
        "exec ",
        "afterany",
    ] {
        assert!(script.contains(words), "{words}");
    }
    let of = |which: &str, more: &[&str]| {
        let arguments = [
            &["run", "--plan", "p.plan", "--shard", which, "-o", "out"],
            more,
        ]
        .concat();
        fogbench(at, &arguments)
    };
    assert_eq!(code(&of("2", &[])), 0);
    let status = fogbench(at, &["status", "out"]);
    assert!(
        stdout(&status).contains("done        1  2\n"),
        "{}",
        stdout(&status)
    );
    assert!(
        stdout(&status).contains("--array=1,3\n"),
        "{}",
        stdout(&status)
    );
    let missing = fogbench(at, &["status", "out", "--missing", "--shard-offset", "1"]);
    assert_eq!(stdout(&missing), "0,2\n");
    refused(&of("4", &[]), "shards go from 1 to 3");
    refused(&of("2/4", &[]), "the plan has 3");
    refused(&of("2", &["own"]), "cannot be used with");
    refused(&of("2", &["--junit", "j.xml"]), "cannot be used with");
}

#[test]
fn a_shard_of_other_scenarios_than_the_planned_ones_is_refused() {
    let folder = scratch();
    let at = folder.path();
    let plan = |more: &[&str]| {
        let arguments = [&["plan", "own", "-o", "p.plan", "--shards", "3"], more].concat();
        fogbench(at, &arguments)
    };
    assert_eq!(code(&plan(&[])), 0);
    let first = || {
        fogbench(
            at,
            &["run", "--plan", "p.plan", "--shard", "1", "-o", "out"],
        )
    };
    let text = fs::read_to_string(at.join("own/swing.toml")).expect("readable");
    write(at, "own/swing.toml", &text.replace("taps = 4", "taps = 5"));
    refused(&first(), "swing has changed");
    write(at, "own/swing.toml", &text);
    write(at, "own/more.toml", &text.replace("\"swing\"", "\"more\""));
    refused(&first(), "more stands where samples was");
    fs::remove_file(at.join("own/more.toml")).expect("removable");
    fs::remove_file(at.join("own/samples.toml")).expect("removable");
    refused(&first(), "sweep/0000 stands where samples was");
    write(at, "p.plan", "thesis");
    refused(&first(), "no plan");
    refused(&plan(&[]), "was not written by fogbench");
    assert_eq!(code(&plan(&["--force"])), 0);
}

#[test]
fn the_environment_says_which_shard_and_never_of_how_many() {
    let folder = scratch();
    let at = folder.path();
    let run = |arguments: &[&str], set: &[(&str, &str)]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fogbench"));
        command.args(["run", "-q", "-o", "out"]).args(arguments);
        command.current_dir(at).envs(set.iter().copied());
        command.output().expect("the program starts")
    };
    let own = |which: &'static str| ["own", "--filter", "samples", "--shard", which];
    let array = [
        ("SLURM_ARRAY_TASK_ID", "2"),
        ("SLURM_ARRAY_TASK_COUNT", "1"),
    ];
    assert_eq!(code(&run(&own("/4"), &array)), 0);
    assert!(at.join("out/shard-0002-of-0004.fogshard").is_file());
    let kubernetes = [("JOB_COMPLETION_INDEX", "0")];
    let offset = [&own("/4")[..], &["--shard-offset", "1"]].concat();
    assert_eq!(code(&run(&offset, &kubernetes)), 0);
    assert!(at.join("out/shard-0001-of-0004.fogshard").is_file());
    refused(&run(&own("/4"), &kubernetes), "--shard-offset 1");
    refused(&run(&own("3/4"), &array), "leave one of them out");
    refused(&run(&own("/4"), &[]), "which shard of 4?");
    refused(&run(&own("2"), &array), "never from");
    refused(&run(&["own", "--shard-offset", "1"], &array), "never from");
}

/// Files of a folder's shards.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("readable").flatten();
    let files = entries.map(|entry| entry.path());
    let mut files: Vec<PathBuf> = files
        .filter(|path| path.extension().is_some_and(|it| it == "fogshard"))
        .collect();
    files.sort();
    files
}

#[test]
fn what_is_poisoned_mixed_double_or_missing_is_not_merged() {
    let folder = scratch();
    let at = folder.path();
    shards(at, 3, "good", 1..=3);
    let merge = |folders: &[&str]| fogbench(at, &[&["merge", "-o", "out"], folders].concat());
    let copy = |to: &str, indices: &[usize]| {
        let _ = fs::remove_dir_all(at.join(to));
        fs::create_dir(at.join(to)).expect("writable");
        for index in indices {
            for end in ["fogshard", "toml"] {
                let name = format!("shard-{index:04}-of-0003.{end}");
                let from = at.join("good").join(&name);
                fs::copy(from, at.join(to).join(name)).expect("writable");
            }
        }
    };
    copy("some", &[2]);
    refused(&merge(&["some"]), "2 of 3 shards are missing: 1,3");
    copy("more", &[1, 2]);
    refused(&merge(&["some", "more"]), "shard 2 is there twice");
    // The folder said twice is one folder.
    refused(&merge(&["some", "some/."]), "shards are missing: 1,3");
    // Any byte.
    copy("bad", &[1, 2, 3]);
    let victim = at.join("bad/shard-0002-of-0003.fogshard");
    let sound = fs::read(&victim).expect("readable");
    for place in [3, 40, sound.len() / 2, sound.len() - 1] {
        let mut bytes = sound.clone();
        bytes[place] ^= 1;
        fs::write(&victim, &bytes).expect("writable");
        refused(&merge(&["bad"]), "shard-0002-of-0003.fogshard");
        let status = fogbench(at, &["status", "bad", "--missing"]);
        assert_eq!(stdout(&status), "2\n", "{}", stderr(&status));
    }
    fs::write(&victim, &sound[..sound.len() - 5]).expect("writable");
    refused(&merge(&["bad"]), "cut short");
    fs::write(&victim, &sound).expect("writable");
    fs::remove_file(at.join("bad/shard-0003-of-0003.toml")).expect("removable");
    refused(&merge(&["bad"]), "record of completion");
    // A record of another shard's file.
    let record = at.join("good/shard-0001-of-0003.toml");
    fs::copy(record, at.join("bad/shard-0003-of-0003.toml")).expect("writable");
    refused(&merge(&["bad"]), "is not the record of");
    // Of another plan, and of another number of shards.
    let other = shard(at, "1/3", "other", &["--set", "seed=7"]);
    assert!([0, 3].contains(&code(&other)), "{}", stderr(&other));
    copy("some", &[2, 3]);
    refused(&merge(&["some", "other"]), "not of one plan: digests");
    let other = shard(at, "1/2", "halves", &[]);
    assert!([0, 3].contains(&code(&other)), "{}", stderr(&other));
    refused(&merge(&["some", "halves"]), "not of one plan: counts");
    // Scenarios that have changed since.
    let text = fs::read_to_string(at.join("own/swing.toml")).expect("readable");
    write(at, "own/swing.toml", &text.replace("taps = 4", "taps = 5"));
    refused(&merge(&["good"]), "other scenarios");
    write(at, "own/swing.toml", &text);
    assert!(!at.join("out").exists(), "nothing was made by a refusal");
    refused(&merge(&["own"]), "no complete shard");
    assert_eq!(code(&merge(&["nowhere"])), 74);
    assert_eq!(files(&at.join("good")).len(), 3);
    assert_eq!(code(&merge(&["good"])), 3);
}

#[test]
fn a_partial_merge_says_everywhere_that_it_is_one() {
    let folder = scratch();
    let at = folder.path();
    shards(at, 7, "some", [1, 2, 3].into_iter());
    let merged = fogbench(at, &["merge", "some", "-o", "out", "--partial"]);
    assert_eq!(code(&merged), 3, "{}", stderr(&merged));
    assert!(stderr(&merged).contains("partial: 4 of 7 shards are missing: 4-7"));
    assert!(stdout(&merged).contains("3 not run"), "{}", stdout(&merged));
    let text = |name: &str| fs::read_to_string(at.join("out").join(name)).expect(name);
    for name in ["summary.json", "metrics.csv", "junit.xml"] {
        assert!(text(name).contains("not_run"), "{name}");
    }
    assert!(text("index.html").contains("not run"), "index.html");
    assert!(
        !at.join("out/swing").exists(),
        "a run that lacks repeats has no result"
    );
}

#[test]
fn a_shard_that_is_complete_is_not_run_again_and_the_users_file_stays() {
    let folder = scratch();
    let at = folder.path();
    let first = shard(at, "2/3", "out", &[]);
    assert_eq!(code(&first), 0, "{}", stderr(&first));
    let path = at.join("out/shard-0002-of-0003.fogshard");
    let before = fs::read(&path).expect("readable");
    let again = shard(at, "2/3", "out", &["--resume"]);
    assert_eq!(code(&again), 0, "{}", stderr(&again));
    assert!(stderr(&again).contains("4 of 4 done, 4 of them before"));
    assert_eq!(fs::read(&path).expect("readable"), before);
    // A kill between the file and its record.
    let record = at.join("out/shard-0002-of-0003.toml");
    let text = fs::read(&record).expect("readable");
    fs::remove_file(&record).expect("removable");
    assert_eq!(code(&shard(at, "2/3", "out", &[])), 0);
    assert_eq!(fs::read(&record).expect("readable"), text);
    fs::write(&path, "thesis").expect("writable");
    refused(&shard(at, "2/3", "out", &[]), "was not written by fogbench");
    let forced = shard(at, "2/3", "out", &["--force"]);
    assert_eq!(code(&forced), 0, "{}", stderr(&forced));
}

#[cfg(unix)]
mod signals {
    use std::process::{Child, Stdio};
    use std::time::{Duration, Instant};

    use super::*;

    /// Many repeats of one short run.
    fn many(folder: &Path) {
        let text = "schema = 1\nname = \"many\"\nduration_s = 5.0\nwarm_up_s = 0.1\n\
                    fidelity = \"rate\"\nrepeats = 40\n";
        write(folder, "own/many.toml", text);
    }

    fn start(folder: &Path, output: &str) -> Child {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fogbench"));
        command.args(["run", "own", "--shard", "1/2", "-j", "1", "-o", output]);
        command
            .current_dir(folder)
            .stderr(Stdio::null())
            .stdout(Stdio::null());
        command.spawn().expect("the program starts")
    }

    /// Waits until the file at work holds more than `bytes`.
    fn wait_for_work(child: &mut Child, path: &Path, bytes: u64) {
        let began = Instant::now();
        while fs::metadata(path).map_or(0, |file| file.len()) <= bytes {
            assert!(
                began.elapsed() < Duration::from_secs(120),
                "no work is done"
            );
            assert!(
                child.try_wait().expect("a child").is_none(),
                "ended before it was stopped"
            );
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    fn send(child: &Child, signal: &str) {
        let id = child.id().to_string();
        let sent = Command::new("kill").args([signal, &id]).status();
        assert!(sent.expect("kill starts").success());
    }

    #[test]
    fn a_shard_that_is_stopped_or_killed_goes_on_and_gives_the_same_bytes() {
        let folder = tempfile::tempdir().expect("a scratch folder");
        let at = folder.path();
        many(at);
        let whole = fogbench(at, &["run", "own", "-o", "whole"]);
        assert_eq!(code(&whole), 0, "{}", stderr(&whole));
        let part = at.join("out/.fogbench/shard-0001-of-0002.fogshard.part");
        let mut child = start(at, "out");
        wait_for_work(&mut child, &part, 20_000);
        // However fast it is, it is at work as long as the rest of this looks at it.
        send(&child, "-STOP");
        // Meanwhile nobody else has the folder.
        for arguments in [
            &["run", "own", "-o", "out"][..],
            &["merge", "out", "-o", "merged"],
            &["run", "own", "--shard", "1/2", "-o", "out"],
        ] {
            let refused = fogbench(at, arguments);
            let said = stderr(&refused);
            assert_eq!(code(&refused), 74, "{arguments:?}: {said}");
            assert!(said.contains("in use by process"), "{said}");
        }
        let status = fogbench(at, &["status", "out"]);
        assert!(
            stdout(&status).contains("running     1  1\n"),
            "{}",
            stdout(&status)
        );
        send(&child, "-TERM");
        send(&child, "-CONT");
        assert_eq!(child.wait().expect("a child").code(), Some(75));
        let kept = fs::metadata(&part).expect("what is finished").len();
        let status = fogbench(at, &["status", "out"]);
        assert!(
            stdout(&status).contains("begun       1  1\n"),
            "{}",
            stdout(&status)
        );
        assert!(
            stdout(&status).contains("--array=1-2\n"),
            "{}",
            stdout(&status)
        );
        let mut child = start(at, "out");
        wait_for_work(&mut child, &part, kept);
        send(&child, "-KILL");
        assert_eq!(child.wait().expect("a child").code(), None);
        let other = shard(at, "2/2", "out", &[]);
        assert_eq!(code(&other), 0, "{}", stderr(&other));
        let last = shard(at, "1/2", "out", &[]);
        assert_eq!(code(&last), 0, "{}", stderr(&last));
        assert!(
            stderr(&last).contains("of them before"),
            "{}",
            stderr(&last)
        );
        let merged = fogbench(at, &["merge", "out", "-o", "merged"]);
        assert_eq!(code(&merged), 0, "{}", stderr(&merged));
        assert_eq!(stdout(&merged), stdout(&whole));
        assert!(tree(&at.join("whole")) == tree(&at.join("merged")));
    }
}
