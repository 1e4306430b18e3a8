//! The process between fogbench and a program: it starts the program, waits for its end and kills what
//! is left.
//!
//! It has a process group of its own, as the program has, so that no key of the terminal ends it before
//! its work is done.

use std::ffi::OsString;
use std::fs::File;
use std::io;
use std::os::unix::process::CommandExt as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::Duration;

use rustix::process::{Pid, Signal, WaitOptions, WaitStatus, kill_process_group, waitpid};

use super::folder::{End, is_to_stop, say_end};

/// Time between two looks at fogbench, the wish to stop and the memory.
const TICK: Duration = Duration::from_millis(20);
/// Times that what is left is looked for and killed before it is given up.
const SWEEPS_MAX: u32 = 500;
/// Time between two of them.
const SWEEP_TICK: Duration = Duration::from_millis(5);

/// Memory, MB, that the program was found to take beyond its limit; 0 as long as it was not.
static MEMORY_FOUND_MB: AtomicU64 = AtomicU64::new(0);

/// What a supervisor is to do, as its arguments say it.
struct Task {
    /// Number of the process of fogbench.
    parent: Option<Pid>,
    folder: PathBuf,
    work: PathBuf,
    /// None: no limit.
    memory_mb: Option<u64>,
    command: Vec<OsString>,
}

/// Supervises a program, if the arguments of this one ask for it; `None` if they do not.
#[cfg(feature = "cli")]
pub(crate) fn supervise(mut arguments: impl Iterator<Item = OsString>) -> Option<()> {
    arguments.next()?;
    if arguments.next()? != super::SUPERVISE {
        return None;
    }
    let (parent, folder, work) = (arguments.next()?, arguments.next()?, arguments.next()?);
    let memory = arguments.next()?;
    let task = Task {
        parent: Pid::from_raw(parent.to_str()?.parse().ok()?),
        folder: folder.into(),
        work: work.into(),
        memory_mb: memory.to_str()?.parse().ok().filter(|limit| *limit > 0),
        command: arguments.collect(),
    };
    let end = run(&task).unwrap_or_else(|error| End::NotStarted(error.to_string()));
    // Where nobody can read it, fogbench is gone, and its folder is this one's to clear.
    if is_orphan(task.parent) {
        drop(std::fs::remove_dir_all(&task.folder));
    } else {
        drop(say_end(&task.folder, &end));
    }
    Some(())
}

/// Whether fogbench is gone.
fn is_orphan(parent: Option<Pid>) -> bool {
    rustix::process::getppid() != parent
}

fn run(task: &Task) -> io::Result<End> {
    adopt_orphans();
    let Some((program, arguments)) = task.command.split_first() else {
        return Ok(End::NotStarted("no command".to_owned()));
    };
    let mut command = Command::new(program);
    command
        .args(arguments)
        .current_dir(&task.work)
        .process_group(0);
    let child = match command.spawn() {
        Ok(child) => child,
        Err(error) => return Ok(End::NotStarted(error.to_string())),
    };
    let pid = Pid::from_child(&child);
    // The pipes are the program's alone: their ends show that it has ended.
    let nothing = File::options().read(true).write(true).open("/dev/null")?;
    rustix::stdio::dup2_stdin(&nothing)?;
    rustix::stdio::dup2_stdout(&nothing)?;
    rustix::stdio::dup2_stderr(&nothing)?;
    let watched = (task.parent, task.folder.clone(), task.memory_mb);
    let watch = move || watch(watched.0, &watched.1, watched.2, pid);
    if let Err(error) = thread::Builder::new().spawn(watch) {
        kill_all(pid);
        return Err(error);
    }
    let status = wait(pid)?;
    sweep(pid);
    let found_mb = MEMORY_FOUND_MB.load(Ordering::SeqCst);
    Ok(
        match (found_mb, status.exit_status(), status.terminating_signal()) {
            (1.., _, _) => End::Memory(found_mb),
            (0, Some(code), _) => End::Code(code),
            (0, None, signal) => End::Signal(signal.unwrap_or_default()),
        },
    )
}

/// Waits for the end of one process.
fn wait(pid: Pid) -> io::Result<WaitStatus> {
    loop {
        match waitpid(Some(pid), WaitOptions::empty()) {
            Ok(Some((_, status))) => return Ok(status),
            Ok(None) | Err(rustix::io::Errno::INTR) => {}
            Err(error) => return Err(error.into()),
        }
    }
}

/// Kills everything once fogbench is gone, asks for it, or the memory is beyond its limit.
fn watch(parent: Option<Pid>, folder: &Path, memory_mb: Option<u64>, program: Pid) {
    loop {
        thread::sleep(TICK);
        if let Some(limit_mb) = memory_mb {
            let found_mb = resident_mb();
            if found_mb > limit_mb {
                MEMORY_FOUND_MB.store(found_mb, Ordering::SeqCst);
                return kill_all(program);
            }
        }
        if is_orphan(parent) || is_to_stop(folder) {
            return kill_all(program);
        }
    }
}

/// Kills the group of the program, and on Linux everything below this process.
fn kill_all(program: Pid) {
    // What has ended already cannot be killed.
    let _ = kill_process_group(program, Signal::KILL);
    for process in descendants() {
        let _ = rustix::process::kill_process(process, Signal::KILL);
    }
}

/// Kills what the program has left behind, until there is nothing.
fn sweep(program: Pid) {
    for _ in 0..SWEEPS_MAX {
        kill_all(program);
        // What has ended is taken note of, or it would be found again.
        while let Ok(Some(_)) = rustix::process::wait(WaitOptions::NOHANG) {}
        if descendants().is_empty() {
            return;
        }
        thread::sleep(SWEEP_TICK);
    }
}

/// Lets every process below this one that loses its parent become a child of this one.
#[cfg(target_os = "linux")]
fn adopt_orphans() {
    // Without it, what has a session of its own is not found once its parent has ended.
    let _ = rustix::process::set_child_subreaper(Some(rustix::process::getpid()));
}

#[cfg(not(target_os = "linux"))]
fn adopt_orphans() {}

/// Every process below this one.
#[cfg(target_os = "linux")]
fn descendants() -> Vec<Pid> {
    let own = rustix::process::getpid();
    let parents = parents();
    let mut found = vec![own];
    let mut next = 0;
    while let Some(&parent) = found.get(next) {
        let children = parents.iter().filter(|(_, of)| *of == parent);
        found.extend(children.map(|(process, _)| *process));
        next += 1;
    }
    found.split_off(1)
}

/// The processes of the system, each with its parent.
#[cfg(target_os = "linux")]
fn parents() -> Vec<(Pid, Pid)> {
    let entries = std::fs::read_dir("/proc").into_iter().flatten().flatten();
    let with_parent = entries.filter_map(|entry| {
        let process: i32 = entry.file_name().to_str()?.parse().ok()?;
        let stat = std::fs::read_to_string(entry.path().join("stat")).ok()?;
        Some((Pid::from_raw(process)?, Pid::from_raw(parent_in(&stat)?)?))
    });
    with_parent.collect()
}

/// The parent in the state of a process: the second field behind its name, which may hold anything.
#[cfg(target_os = "linux")]
fn parent_in(stat: &str) -> Option<i32> {
    let (_, behind_name) = stat.rsplit_once(')')?;
    behind_name.split_whitespace().nth(1)?.parse().ok()
}

/// Resident memory of everything below this process, MB.
#[cfg(target_os = "linux")]
fn resident_mb() -> u64 {
    const MB: u64 = 1_000_000;
    let page = rustix::param::page_size() as u64;
    let of = |process: Pid| {
        let file = format!("/proc/{}/statm", process.as_raw_nonzero());
        let text = std::fs::read_to_string(file).ok()?;
        text.split_whitespace().nth(1)?.parse::<u64>().ok()
    };
    let pages: u64 = descendants().into_iter().filter_map(of).sum();
    pages * page / MB
}

#[cfg(not(target_os = "linux"))]
fn descendants() -> Vec<Pid> {
    Vec::new()
}

/// Not told by other systems.
#[cfg(not(target_os = "linux"))]
fn resident_mb() -> u64 {
    0
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn the_parent_stands_behind_whatever_a_process_calls_itself() {
        assert_eq!(parent_in("12 (a) b) S 7 12 12 0 -1"), Some(7));
        assert_eq!(parent_in("12 (sh) R 1 12"), Some(1));
        assert_eq!(parent_in("12 sh"), None);
    }

    #[test]
    fn this_process_stands_among_those_of_the_system() {
        let own = rustix::process::getpid();
        let parents = parents();
        assert!(parents.iter().any(|(process, _)| *process == own));
    }
}
