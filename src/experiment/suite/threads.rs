//! Threads: how many, and what to do where the system gives fewer.

use std::io;
use std::num::IntErrorKind;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::available_parallelism;

use rayon::{ThreadBuilder, ThreadPool, ThreadPoolBuilder};

/// Most threads that are ever started: more only cost memory.
pub const THREADS_MAX: usize = 256;

/// Environment variable that says how many threads to start where nothing else does.
const VARIABLE: &str = "RAYON_NUM_THREADS";

/// Threads to start where `asked` are asked for, [`THREADS_MAX`] at most; 0 = what the environment
/// variable `RAYON_NUM_THREADS` says, one per core if it says nothing.
#[must_use]
pub fn thread_count(asked: usize) -> usize {
    let of_environment = || std::env::var(VARIABLE).ok().and_then(|text| number(&text));
    let given = Some(asked).filter(|count| *count > 0);
    let count = given
        .or_else(of_environment)
        .unwrap_or_else(|| available_parallelism().map_or(1, usize::from));
    count.clamp(1, THREADS_MAX)
}

/// A number of threads; none for 0 and for what is no number. One too large to hold is still one.
fn number(text: &str) -> Option<usize> {
    match text.trim().parse::<usize>() {
        Ok(count) => Some(count).filter(|count| *count > 0),
        Err(error) => (*error.kind() == IntErrorKind::PosOverflow).then_some(usize::MAX),
    }
}

/// A pool of `count` threads, or of fewer where the system refuses.
///
/// # Errors
/// What the system says if it gives not one.
pub(crate) fn pool(count: usize) -> io::Result<ThreadPool> {
    let (count, place) = Crew::muster(count, start)?.places();
    let pool = ThreadPoolBuilder::new().num_threads(count);
    pool.spawn_handler(place).build().map_err(io::Error::other)
}

/// Starts the threads on which everything outside a suite is computed, as many as [`thread_count`]
/// says or fewer where the system refuses; where it gives none, the calling thread works alone. To
/// be called once, before the first such computation.
pub fn start_threads() {
    // Refused only if the threads run already, and then there is nothing to start.
    let pool = ThreadPoolBuilder::new();
    let _ = match Crew::muster(thread_count(0), start) {
        Ok(crew) => {
            let (count, place) = crew.places();
            pool.num_threads(count).spawn_handler(place).build_global()
        }
        Err(_) => pool.num_threads(1).use_current_thread().build_global(),
    };
}

/// Threads that stand ready to join a pool.
///
/// A pool that is refused a thread is not built at all, and the one that serves the whole program
/// cannot be tried twice. So the threads are started first, and the pool is made of those there are.
struct Crew {
    hands: Vec<Hand>,
}

/// Gives a waiting thread its place in a pool; dropped, it dismisses the thread.
type Hand = SyncSender<ThreadBuilder>;

impl Crew {
    /// Asks `start` for `count` threads, one after the other. Of those there are after a refusal half are kept: a system
    /// at its limit needs room for the work.
    ///
    /// # Errors
    /// The refusal, if there is not one thread.
    fn muster(count: usize, start: impl Fn(usize) -> io::Result<Hand>) -> io::Result<Self> {
        let mut hands = Vec::with_capacity(count);
        for before in 0..count {
            match start(before) {
                Ok(hand) => hands.push(hand),
                Err(refusal) if hands.is_empty() => return Err(refusal),
                Err(_) => {
                    hands.truncate(hands.len().div_ceil(2));
                    break;
                }
            }
        }
        Ok(Self { hands })
    }

    /// The number of threads, and how a pool of so many is given them.
    fn places(self) -> (usize, impl FnMut(ThreadBuilder) -> io::Result<()>) {
        let count = self.hands.len();
        let mut hands = self.hands.into_iter();
        let place = move |thread| {
            let hand = hands.next().ok_or(io::ErrorKind::WouldBlock)?;
            // The thread waits for its place until this hand is dropped.
            hand.send(thread)
                .map_err(|_| io::ErrorKind::BrokenPipe.into())
        };
        (count, place)
    }
}

/// Starts a thread that waits for its place in a pool, after `before` others, if there is memory for
/// the work of all of them.
///
/// Memory that runs out is no error that a thread could report: it ends the program. So there must
/// be room to begin with, and each thread is seen to run before the next is started.
fn start(before: usize) -> io::Result<Hand> {
    const WORK_BYTES: usize = 32 << 20;
    const ROOM_BYTES_MAX: usize = 512 << 20;
    let mut room: Vec<u8> = Vec::new();
    room.try_reserve_exact((WORK_BYTES * (before + 1)).min(ROOM_BYTES_MAX))
        .map_err(|_| io::ErrorKind::OutOfMemory)?;
    drop(room);
    let (hand, place) = sync_channel::<ThreadBuilder>(1);
    let (started, starts) = sync_channel::<()>(1);
    std::thread::Builder::new().spawn(move || {
        // Nobody waits for it any more if the program is about to end.
        let _ = started.send(());
        if let Ok(thread) = place.recv() {
            thread.run();
        }
    })?;
    starts.recv().map_err(|_| io::ErrorKind::WouldBlock)?;
    Ok(hand)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_of_threads_is_capped_wherever_it_comes_from() {
        assert_eq!(thread_count(3), 3);
        assert_eq!(thread_count(100_000), THREADS_MAX);
        assert!((1..=THREADS_MAX).contains(&thread_count(0)));
    }

    #[test]
    fn a_word_of_the_environment_is_a_number_or_nothing() {
        assert_eq!(number(" 7 "), Some(7));
        assert_eq!(number("100000000"), Some(100_000_000));
        assert_eq!(number("99999999999999999999999"), Some(usize::MAX));
        for nonsense in ["", "0", "-1", "two", "1.5"] {
            assert_eq!(number(nonsense), None, "{nonsense}");
        }
    }

    #[test]
    fn a_pool_is_made_of_the_threads_there_are() {
        for (granted, kept) in [(9, 8), (8, 8), (7, 4), (1, 1)] {
            let grudging = |before| {
                if before < granted {
                    start(before)
                } else {
                    Err(io::ErrorKind::WouldBlock.into())
                }
            };
            let crew = Crew::muster(8, grudging).expect("a thread");
            let (count, place) = crew.places();
            let pool = ThreadPoolBuilder::new().num_threads(count);
            let pool = pool.spawn_handler(place).build().expect("all are there");
            assert_eq!(pool.current_num_threads(), kept, "of {granted} granted");
            assert_eq!(pool.install(|| 6 * 7), 42);
        }
        let none = Crew::muster(8, |_| Err(io::ErrorKind::OutOfMemory.into()));
        let refusal = none.err().expect("no thread");
        assert_eq!(refusal.kind(), io::ErrorKind::OutOfMemory);
    }
}
