//! Names the build: what `git describe` says of the sources, else `unknown`.

use std::path::{Path, PathBuf};
use std::process::Command;

/// What the program is made of: a change of these may make a build dirty.
const SOURCES: [&str; 4] = ["build.rs", "src", "Cargo.toml", "Cargo.lock"];

fn main() {
    let package = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    for source in SOURCES {
        println!("cargo::rerun-if-changed={source}");
    }
    let build = describe(&package).unwrap_or_else(|| "unknown".to_owned());
    println!("cargo::rustc-env=FOGBENCH_BUILD={build}");
}

/// The commit of the sources; none where they lie in no repository of their own, as in a package that
/// was downloaded or stands among the files of another project.
fn describe(package: &Path) -> Option<String> {
    let top = PathBuf::from(git(package, &["rev-parse", "--show-toplevel"])?);
    if top.canonicalize().ok()? != package.canonicalize().ok()? {
        return None;
    }
    // A commit moves the branch that the head names, or the head itself. What is not there must not be
    // watched: it would count as changed each time.
    let branch = git(package, &["symbolic-ref", "--quiet", "HEAD"]).unwrap_or_default();
    for name in ["HEAD", branch.as_str(), "refs/tags", "packed-refs"] {
        let path = git(package, &["rev-parse", "--git-path", name])?;
        let path = package.join(path);
        if !name.is_empty() && path.exists() {
            println!("cargo::rerun-if-changed={}", path.display());
        }
    }
    git(package, &["describe", "--always", "--dirty", "--tags"]).filter(|build| !build.is_empty())
}

/// What git answers, or nothing where it fails or is not there.
fn git(folder: &Path, arguments: &[&str]) -> Option<String> {
    let output = Command::new("git")
        .arg("-C")
        .arg(folder)
        .args(arguments)
        .output()
        .ok()
        .filter(|output| output.status.success())?;
    Some(String::from_utf8(output.stdout).ok()?.trim().to_owned())
}
