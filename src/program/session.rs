//! One program from its start to its end.

use std::ffi::OsString;
use std::fs;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::RecvTimeoutError;
use std::thread;
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use super::error::ProgramError;
use super::folder::{End, Folder};
use super::pipes::{Answer, Broken, Expected, Pipes, shown};
use super::{ENVIRONMENT, GIVEN_ENVIRONMENT, PROTOCOL, Programs, SUPERVISE};

/// Time between two looks at what the program says and at the wish to stop.
const TICK: Duration = Duration::from_millis(20);
/// Time that the supervisor has to end once it is asked to.
const GRACE: Duration = Duration::from_secs(2);

/// Whoever waits for a program.
pub(crate) trait Listener: Sync {
    /// Hears a line that the program wrote on stderr.
    fn said(&self, line: &str);
    /// Whether to stop waiting.
    fn should_stop(&self) -> bool;
}

/// What is started, and within which bounds.
#[derive(Clone, Debug)]
pub(crate) struct Launch {
    /// Program, absolute, and arguments.
    pub(crate) command: Vec<OsString>,
    /// Files that are put into the folder in which it works.
    pub(crate) inputs: Vec<PathBuf>,
    /// Time from the start to the answer to the greeting, s.
    pub(crate) start_timeout_s: f64,
    /// Time for each block and for the end, s.
    pub(crate) timeout_s: f64,
    /// Resident memory of the program and all that it starts; none: no limit.
    pub(crate) memory_mb: Option<u32>,
}

/// The first line that a program is given.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Greeting<P> {
    fogbench_filter: u32,
    /// Words per second.
    pub(crate) rate_hz: f64,
    /// Unit of the words.
    pub(crate) unit: &'static str,
    /// Channel that the words are of.
    pub(crate) channel: String,
    /// Most words of a block.
    pub(crate) block_samples: u32,
    /// Settings of the user's.
    pub(crate) parameters: P,
}

impl<P> Greeting<P> {
    /// A greeting in the version that is spoken.
    pub(crate) fn new(rate_hz: f64, channel: String, block_samples: u32, parameters: P) -> Self {
        Self {
            fogbench_filter: PROTOCOL,
            rate_hz,
            unit: "deg/h",
            channel,
            block_samples,
            parameters,
        }
    }
}

/// The line that a program answers.
#[derive(Clone, Debug, Deserialize)]
#[expect(
    dead_code,
    reason = "name and version are asked for, so that every program has them"
)]
struct Introduction {
    fogbench_filter: u32,
    name: String,
    version: String,
    /// Whether what it answers depends on the block alone.
    #[serde(default)]
    stateless: bool,
}

/// Why a session came to no end.
#[derive(Debug)]
pub(crate) enum Interrupted {
    /// The listener wanted to stop.
    Stopped,
    /// The program is at fault, or the system.
    Failed(ProgramError),
}

impl From<ProgramError> for Interrupted {
    fn from(error: ProgramError) -> Self {
        Self::Failed(error)
    }
}

/// What is waited for, how long, and which key says so.
#[derive(Clone, Copy, Debug)]
struct Wait {
    awaited: &'static str,
    timeout_s: f64,
    key: &'static str,
}

impl Wait {
    fn timed_out(self) -> ProgramError {
        ProgramError::TimeOut {
            awaited: self.awaited,
            timeout_s: self.timeout_s,
            key: self.key,
        }
    }
}

/// A program that runs. It is ended, with all that it started, when the session is dropped.
pub(crate) struct Session<'a> {
    supervisor: Child,
    folder: Folder,
    pipes: Pipes,
    timeout_s: f64,
    memory_mb: Option<u32>,
    listener: &'a dyn Listener,
    is_stateless: bool,
}

impl<'a> Session<'a> {
    /// Starts a program and greets it.
    ///
    /// # Errors
    /// Where it cannot be started, does not answer in time, or answers anything else.
    pub(crate) fn start<P: Serialize>(
        programs: &Programs,
        launch: &Launch,
        greeting: &Greeting<P>,
        listener: &'a dyn Listener,
    ) -> Result<Self, Interrupted> {
        let mut session = Self::launch(programs, launch, listener)?;
        let mut line = serde_json::to_vec(greeting)
            .map_err(|error| ProgramError::Start(format!("its parameters are no JSON: {error}")))?;
        line.push(b'\n');
        let wait = Wait {
            awaited: "answer to the greeting",
            timeout_s: launch.start_timeout_s,
            key: "start_timeout_s",
        };
        let answer = session.ask(line, Expected::Line, wait)?;
        if let Answer::Line(line) = answer {
            session.is_stateless = introduction(&line)?.stateless;
        }
        Ok(session)
    }

    /// Whether the program says that what it answers depends on the block alone.
    pub(crate) fn is_stateless(&self) -> bool {
        self.is_stateless
    }

    fn launch(
        programs: &Programs,
        launch: &Launch,
        listener: &'a dyn Listener,
    ) -> Result<Self, ProgramError> {
        if cfg!(not(unix)) {
            let lack = "this system is not known to end all that a program starts";
            return Err(ProgramError::Start(lack.to_owned()));
        }
        let folder = Folder::new()?;
        for input in &launch.inputs {
            let name = input.file_name().unwrap_or_default();
            fs::copy(input, folder.work().join(name))?;
        }
        let mut supervisor = Command::new(&programs.supervisor);
        supervisor
            .arg(SUPERVISE)
            .arg(std::process::id().to_string())
            .arg(folder.path())
            .arg(folder.work())
            .arg(launch.memory_mb.unwrap_or(0).to_string())
            .args(&launch.command)
            .env_clear()
            .envs(
                ENVIRONMENT
                    .iter()
                    .filter_map(|name| Some((*name, std::env::var_os(name)?))),
            )
            .envs(GIVEN_ENVIRONMENT)
            .env("TMPDIR", folder.work())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut supervisor, 0);
        let mut supervisor = supervisor.spawn()?;
        let taken = (
            supervisor.stdin.take(),
            supervisor.stdout.take(),
            supervisor.stderr.take(),
        );
        let (Some(stdin), Some(stdout), Some(stderr)) = taken else {
            unreachable!("all three were asked for");
        };
        Ok(Self {
            pipes: Pipes::serve(stdin, stdout, stderr)?,
            supervisor,
            folder,
            timeout_s: launch.timeout_s,
            memory_mb: launch.memory_mb,
            listener,
            is_stateless: false,
        })
    }

    /// Gives words and takes as many back.
    ///
    /// # Errors
    /// Where it answers anything else, or not in time.
    ///
    /// # Panics
    /// If there are more words than a count can say.
    pub(crate) fn exchange(&mut self, words: &[f64]) -> Result<Vec<f64>, Interrupted> {
        let count = u32::try_from(words.len()).expect("a record has fewer words than 2^32");
        let mut bytes = vec![0; 4 + 8 * words.len()];
        let (head, body) = bytes.split_at_mut(4);
        head.copy_from_slice(&count.to_le_bytes());
        // In chunks of eight, which become one copy.
        let (places, _) = body.as_chunks_mut::<8>();
        for (place, word) in places.iter_mut().zip(words) {
            *place = word.to_le_bytes();
        }
        let wait = self.wait("answer to a block");
        match self.ask(bytes, Expected::Words(count), wait)? {
            Answer::Words(words) => Ok(words),
            other => unreachable!("words were expected, not {other:?}"),
        }
    }

    /// Says that there are no more words, and waits for the end of the program.
    ///
    /// # Errors
    /// Where it writes more, does not end in time, or ends with an error.
    pub(crate) fn finish(mut self) -> Result<(), Interrupted> {
        let began = Instant::now();
        let wait = self.wait("end behind the last word");
        self.ask(0_u32.to_le_bytes().to_vec(), Expected::End, wait)?;
        while self
            .supervisor
            .try_wait()
            .map_err(ProgramError::from)?
            .is_none()
        {
            self.hear();
            if self.listener.should_stop() {
                return Err(Interrupted::Stopped);
            }
            if began.elapsed().as_secs_f64() > self.timeout_s {
                return Err(wait.timed_out().into());
            }
            thread::sleep(Duration::from_millis(1));
        }
        self.hear();
        match self.folder.end() {
            Some(End::Code(0)) => Ok(()),
            Some(End::Memory(found_mb)) => Err(self.too_large(found_mb).into()),
            Some(end) => Err(ProgramError::EndedBadly(end.words()).into()),
            None => Err(ProgramError::EndedBadly("without a trace".to_owned()).into()),
        }
    }

    /// Writes, and waits for what is expected.
    fn ask(
        &mut self,
        bytes: Vec<u8>,
        expected: Expected,
        wait: Wait,
    ) -> Result<Answer, Interrupted> {
        let is_last = matches!(expected, Expected::End);
        // Whoever reads the answer first: it waits at the pipe when the answer comes. A thread that is gone has
        // met the end of its pipe, which the answer tells.
        let _ = self.pipes.expect.send(expected);
        let _ = self.pipes.write.as_ref().map(|write| write.send(bytes));
        if is_last {
            self.pipes.write = None;
        }
        let deadline = Instant::now() + Duration::from_secs_f64(wait.timeout_s);
        loop {
            self.hear();
            let left = deadline.saturating_duration_since(Instant::now());
            match self.pipes.answers.recv_timeout(TICK.min(left)) {
                Ok(Ok(answer)) => return Ok(answer),
                Ok(Err(Broken::Wrong(error))) => return Err(error.into()),
                Ok(Err(Broken::Closed)) | Err(RecvTimeoutError::Disconnected) => {
                    return Err(self.ended(wait.awaited).into());
                }
                Err(RecvTimeoutError::Timeout) if left.is_zero() => {
                    return Err(wait.timed_out().into());
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
            if self.listener.should_stop() {
                return Err(Interrupted::Stopped);
            }
        }
    }

    /// Passes on what the program has said.
    fn hear(&self) {
        for line in self.pipes.said.try_iter() {
            self.listener.said(&line);
        }
    }

    /// Waiting as long as a block may take.
    fn wait(&self, awaited: &'static str) -> Wait {
        Wait {
            awaited,
            timeout_s: self.timeout_s,
            key: "timeout_s",
        }
    }

    fn too_large(&self, found_mb: u64) -> ProgramError {
        ProgramError::Memory {
            found_mb,
            limit_mb: self.memory_mb.map_or(0, u64::from),
        }
    }

    /// Why a program that ended did so.
    fn ended(&mut self, awaited: &'static str) -> ProgramError {
        // One that has only closed its pipes is ended.
        let asked = Instant::now();
        let mut is_asked = false;
        while self.folder.end().is_none() && asked.elapsed() < GRACE {
            if !is_asked && asked.elapsed() > GRACE / 4 {
                is_asked = true;
                drop(self.folder.ask_to_stop());
            }
            thread::sleep(Duration::from_millis(1));
        }
        self.hear();
        match self.folder.end() {
            Some(End::NotStarted(why)) => ProgramError::Start(why),
            Some(End::Memory(found_mb)) => self.too_large(found_mb),
            Some(_) if is_asked => ProgramError::Ended {
                how: "its output".to_owned(),
                awaited,
            },
            end => ProgramError::Ended {
                how: end.map_or_else(|| "without a trace".to_owned(), |end| end.words()),
                awaited,
            },
        }
    }
}

impl Drop for Session<'_> {
    fn drop(&mut self) {
        let is_over = |supervisor: &mut Child| !matches!(supervisor.try_wait(), Ok(None));
        if !is_over(&mut self.supervisor) {
            drop(self.folder.ask_to_stop());
            let asked = Instant::now();
            while !is_over(&mut self.supervisor) && asked.elapsed() < GRACE {
                thread::sleep(Duration::from_millis(1));
            }
        }
        self.hear();
    }
}

/// What a program says of itself; refuses an answer to the greeting that is none, or of another version.
fn introduction(line: &str) -> Result<Introduction, ProgramError> {
    let refuse = |reason| ProgramError::Greeting {
        reason,
        line: shown(line.as_bytes()),
    };
    let found: Introduction = serde_json::from_str(line).map_err(|_| {
        refuse("expected {\"fogbench_filter\": 1, \"name\": \"...\", \"version\": \"...\"}")
    })?;
    if found.fogbench_filter != PROTOCOL {
        return Err(refuse("expected version 1 of the protocol"));
    }
    Ok(found)
}
