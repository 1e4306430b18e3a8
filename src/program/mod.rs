//! A program of the user's in the place of a filter: how it is started, spoken to and ended.
//!
//! ```text
//!  fogbench ──starts──> supervisor ──starts──> program ──may start──> anything
//!     │                     └─ kills all of them when the program ends, when fogbench asks for it,
//!     │                        and when fogbench is gone
//!     ├──words──> stdin of the program
//!     ├<─words─── its stdout
//!     └<─text──── its stderr
//! ```
//!
//! The supervisor is this very program again ([`supervise`]): it ends what the program leaves behind even
//! where fogbench itself is killed. On Linux it adopts every orphan below it, so that a session of its
//! own saves nothing; on other systems of the Unix kind it ends the process group of the program. Elsewhere no
//! program is started.
//!
//! Invariant: knows words, not what they mean, and nothing of scenarios; imports nothing of the crate.

mod error;
mod folder;
mod pipes;
mod session;
#[cfg(unix)]
mod supervisor;

pub(crate) use error::FaultKind;
pub(crate) use session::{Greeting, Interrupted, Launch, Listener, Session};
#[cfg(all(unix, feature = "cli"))]
pub(crate) use supervisor::supervise;

/// The version of the protocol that is spoken.
pub(crate) const PROTOCOL: u32 = 1;

/// Variables of the environment that a program is given as they are; all others are taken away.
pub(crate) const ENVIRONMENT: [&str; 11] = [
    "PATH",
    "HOME",
    "USER",
    "LOGNAME",
    "LANG",
    "LC_ALL",
    "LC_CTYPE",
    "TZ",
    "LD_LIBRARY_PATH",
    "VIRTUAL_ENV",
    "PYENV_ROOT",
];

/// Variables that every program is given: one thread, the same order of hashed things in each run, and no
/// files beside the program's own.
pub(crate) const GIVEN_ENVIRONMENT: [(&str, &str); 5] = [
    ("OMP_NUM_THREADS", "1"),
    ("OPENBLAS_NUM_THREADS", "1"),
    ("MKL_NUM_THREADS", "1"),
    ("PYTHONHASHSEED", "0"),
    ("PYTHONDONTWRITEBYTECODE", "1"),
];

/// The right to start programs, which only the command line can give.
#[derive(Clone, Debug)]
pub struct Programs {
    supervisor: std::path::PathBuf,
}

impl Programs {
    /// The right, for the program that runs: it is started again as the supervisor of each.
    ///
    /// # Errors
    /// Where it lies cannot be told.
    #[cfg(feature = "cli")]
    pub(crate) fn of_this_program() -> std::io::Result<Self> {
        // What runs, even if another file has taken its place.
        let own = std::path::Path::new("/proc/self/exe");
        let supervisor = if own.exists() {
            own.to_owned()
        } else {
            std::env::current_exe()?
        };
        Ok(Self { supervisor })
    }
}

/// First argument of the program where it is to be a supervisor.
pub(crate) const SUPERVISE: &str = "supervise-program";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_names_what_a_program_is_given_of_the_environment() {
        let page = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/own-filter.md");
        let page = std::fs::read_to_string(page).expect("the page is readable");
        let given = GIVEN_ENVIRONMENT.iter().map(|(name, _)| name);
        for name in ENVIRONMENT.iter().chain(given) {
            assert!(page.contains(&format!("`{name}`")), "{name} is not named");
        }
    }
}
