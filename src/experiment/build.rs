//! Which version and which build of the program this is.

/// Version of the program, as every result names it.
pub(super) const VERSION: &str = env!("CARGO_PKG_VERSION");

/// What `git describe` said of the sources, `-dirty` behind it where they were changed; `unknown` where
/// they were in no repository.
pub const BUILD: &str = env!("FOGBENCH_BUILD");

/// Whether two results of `build` come from the same program: a name that other sources may share says
/// nothing.
pub(super) fn names_one_program(build: &str) -> bool {
    build != "unknown" && !build.ends_with("-dirty")
}
