//! The pipes of a program, each served by a thread of its own, so that neither side waits for the other.
//!
//! The threads end with their pipes, which the end of the program closes; nobody waits for them.

use std::io::{self, BufRead, BufReader, Read, Write};
use std::process::{ChildStderr, ChildStdin, ChildStdout};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;

use super::error::ProgramError;

/// Longest first line, bytes.
const LINE_BYTES_MAX: u64 = 1 << 16;
/// Bytes of an answer that a message shows.
const SHOWN_BYTES: usize = 60;
/// Most bytes of stderr that are passed on; what follows is read and dropped.
const STDERR_BYTES_MAX: usize = 1 << 16;
/// Longest part of a line of stderr that is passed on at once, bytes.
const STDERR_LINE_BYTES_MAX: u64 = 1 << 12;
/// Words that are read at a time.
const WORDS_AT_ONCE: usize = 1 << 12;

/// What is expected on stdout next.
#[derive(Clone, Copy, Debug)]
pub(super) enum Expected {
    /// The line that answers the greeting.
    Line,
    /// So many words behind their count.
    Words(u32),
    /// Nothing but the end.
    End,
}

/// What came.
#[derive(Debug)]
pub(super) enum Answer {
    Line(String),
    Words(Vec<f64>),
    End,
}

/// Why an answer is none.
#[derive(Debug)]
pub(super) enum Broken {
    /// The pipe ended.
    Closed,
    /// What came is wrong.
    Wrong(ProgramError),
}

/// Both ends of the threads.
pub(super) struct Pipes {
    /// What is to be written; none behind the last word, which closes the pipe.
    pub(super) write: Option<Sender<Vec<u8>>>,
    /// What is expected.
    pub(super) expect: Sender<Expected>,
    /// What has come of it.
    pub(super) answers: Receiver<Result<Answer, Broken>>,
    /// Lines of stderr.
    pub(super) said: Receiver<String>,
}

impl Pipes {
    /// Serves the pipes of a program.
    pub(super) fn serve(
        stdin: ChildStdin,
        stdout: ChildStdout,
        stderr: ChildStderr,
    ) -> io::Result<Self> {
        let (write, to_write) = channel();
        let (expect, expected) = channel();
        let (answered, answers) = channel();
        let (say, said) = channel();
        let start = |name: &str, work: Box<dyn FnOnce() + Send>| {
            let thread = thread::Builder::new().name(format!("program {name}"));
            thread.spawn(work).map(drop)
        };
        start("stdin", Box::new(move || feed(stdin, &to_write)))?;
        start(
            "stdout",
            Box::new(move || {
                let mut stdout = BufReader::with_capacity(1 << 16, stdout);
                for expected in expected {
                    if answered.send(answer(&mut stdout, expected)).is_err() {
                        return;
                    }
                }
            }),
        )?;
        start("stderr", Box::new(move || listen(stderr, &say)))?;
        Ok(Self {
            write: Some(write),
            expect,
            answers,
            said,
        })
    }
}

/// Writes what is given until there is no more, or nobody reads.
fn feed(mut stdin: ChildStdin, to_write: &Receiver<Vec<u8>>) {
    for bytes in to_write {
        if stdin
            .write_all(&bytes)
            .and_then(|()| stdin.flush())
            .is_err()
        {
            return;
        }
    }
}

/// Passes stderr on by lines, and reads on where nobody wants more, so that the program does not wait.
fn listen(stderr: ChildStderr, say: &Sender<String>) {
    let mut stderr = BufReader::new(stderr);
    let mut left = STDERR_BYTES_MAX;
    let mut line = Vec::new();
    loop {
        line.clear();
        let mut part = stderr.by_ref().take(STDERR_LINE_BYTES_MAX);
        match part.read_until(b'\n', &mut line) {
            Ok(0) | Err(_) => return,
            Ok(_) if left == 0 => {}
            Ok(count) => {
                left = left.saturating_sub(count);
                let text = String::from_utf8_lossy(&line);
                drop(say.send(text.trim_end().to_owned()));
                if left == 0 {
                    drop(say.send(format!(
                        "(more than {STDERR_BYTES_MAX} bytes: the rest is dropped)"
                    )));
                }
            }
        }
    }
}

/// Reads what is expected.
fn answer(stdout: &mut impl BufRead, expected: Expected) -> Result<Answer, Broken> {
    match expected {
        Expected::Line => line(stdout).map(Answer::Line),
        Expected::Words(count) => words(stdout, count).map(Answer::Words),
        Expected::End => end(stdout).map(|()| Answer::End),
    }
}

/// Reads a line; behind it begin the words.
fn line(stdout: &mut impl BufRead) -> Result<String, Broken> {
    let mut line = Vec::new();
    let read = stdout.take(LINE_BYTES_MAX).read_until(b'\n', &mut line);
    read.map_err(|_| Broken::Closed)?;
    if line.pop_if(|last| *last == b'\n').is_some() {
        return Ok(String::from_utf8_lossy(&line).into_owned());
    }
    if line.len() as u64 == LINE_BYTES_MAX {
        return Err(Broken::Wrong(ProgramError::Greeting {
            reason: "it has no end within 65536 bytes",
            line: shown(&line),
        }));
    }
    Err(Broken::Closed)
}

/// Reads words behind their count, which is checked before any room is made for them.
fn words(stdout: &mut impl Read, wanted: u32) -> Result<Vec<f64>, Broken> {
    let mut count = [0; 4];
    stdout.read_exact(&mut count).map_err(|_| Broken::Closed)?;
    let found = u32::from_le_bytes(count);
    if found != wanted {
        let is_text = |byte: &u8| byte.is_ascii_graphic() || matches!(byte, b' ' | b'\n' | b'\t');
        let error = if count.iter().all(is_text) {
            let mut rest = Vec::new();
            // What is there: a program that waits for the next block writes no more.
            let mut more = [0; SHOWN_BYTES];
            let read = stdout.read(&mut more).unwrap_or(0);
            rest.extend_from_slice(&count);
            rest.extend_from_slice(&more[..read]);
            ProgramError::Text(shown(&rest))
        } else {
            ProgramError::Count { wanted, found }
        };
        return Err(Broken::Wrong(error));
    }
    let wanted = wanted as usize;
    let mut words = Vec::with_capacity(wanted);
    let mut bytes = vec![0; 8 * wanted.min(WORDS_AT_ONCE)];
    while words.len() < wanted {
        let part = &mut bytes[..8 * (wanted - words.len()).min(WORDS_AT_ONCE)];
        stdout.read_exact(part).map_err(|_| Broken::Closed)?;
        let (parts, _) = part.as_chunks::<8>();
        let start = words.len();
        words.extend(parts.iter().map(|bytes| f64::from_le_bytes(*bytes)));
        if let Some(index) = words[start..].iter().position(|value| !value.is_finite()) {
            let index = start + index;
            let value = words[index];
            return Err(Broken::Wrong(ProgramError::NotFinite { index, value }));
        }
    }
    Ok(words)
}

/// Reads to the end, behind which nothing may stand. Of a flood no more is read than tells it.
fn end(stdout: &mut impl Read) -> Result<(), Broken> {
    let mut surplus = [0; 1 << 12];
    match stdout.read(&mut surplus) {
        Ok(0) | Err(_) => Ok(()),
        Ok(count) => Err(Broken::Wrong(ProgramError::Surplus(count))),
    }
}

/// The beginning of what a program wrote, as a message shows it.
pub(super) fn shown(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(SHOWN_BYTES)]);
    text.trim_end().escape_debug().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn framed(count: u32, words: &[f64]) -> Vec<u8> {
        let mut bytes = count.to_le_bytes().to_vec();
        bytes.extend(words.iter().flat_map(|word| word.to_le_bytes()));
        bytes
    }

    fn wrong(bytes: &[u8], wanted: u32) -> String {
        match words(&mut &bytes[..], wanted) {
            Err(Broken::Wrong(error)) => error.to_string(),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn words_stand_behind_their_count() {
        let bytes = framed(3, &[1.5, -0.0, 5e-324]);
        let read = words(&mut &bytes[..], 3).unwrap();
        let bits: Vec<u64> = read.iter().map(|word| word.to_bits()).collect();
        assert_eq!(bits, [1.5_f64, -0.0, 5e-324].map(f64::to_bits));
        assert!(matches!(words(&mut &bytes[..20], 3), Err(Broken::Closed)));
    }

    #[test]
    fn another_count_is_refused_before_room_is_made_for_it() {
        let bytes = framed(u32::MAX, &[1.0]);
        assert!(wrong(&bytes, 1).starts_with("it answered 4294967295 words to 1"));
    }

    #[test]
    fn text_is_told_from_a_count() {
        let said = wrong(b"hello world\n", 2);
        assert!(said.contains("beginning with `hello world`"), "{said}");
    }

    #[test]
    fn a_word_that_is_none_is_told_by_its_place() {
        let bytes = framed(2, &[1.0, f64::NAN]);
        let Err(Broken::Wrong(error)) = words(&mut &bytes[..], 2) else {
            panic!("a NaN passed");
        };
        assert_eq!(error.word(), 1);
    }

    #[test]
    fn a_first_line_ends_or_is_refused() {
        assert_eq!(line(&mut &b"{}\nrest"[..]).unwrap(), "{}");
        assert!(matches!(line(&mut &b"{}"[..]), Err(Broken::Closed)));
        let flood = vec![b'x'; 1 << 17];
        assert!(matches!(line(&mut &flood[..]), Err(Broken::Wrong(_))));
    }

    #[test]
    fn nothing_may_stand_behind_the_last_word() {
        assert!(end(&mut &b""[..]).is_ok());
        assert!(matches!(
            end(&mut &b"ab"[..]),
            Err(Broken::Wrong(ProgramError::Surplus(2)))
        ));
    }
}
