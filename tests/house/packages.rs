//! The packages that the lock file names.

use std::collections::BTreeSet;
use std::fs;
use std::process::Command;

use serde_json::Value;

use crate::support::{repository, rust_files, stdout};

/// Version of Rust as numbers; what is left out is 0.
fn version(text: &str) -> Vec<u32> {
    let parts = text.split('.').map(|part| part.parse().expect("a number"));
    let mut parts: Vec<u32> = parts.collect();
    parts.resize(3, 0);
    parts
}

/// The packages of this machine: those of other systems need not have been fetched.
fn packages() -> Vec<Value> {
    let host = Command::new("rustc").arg("-vV").output();
    let host = stdout(&host.expect("the compiler starts"));
    let host = host.lines().find_map(|line| line.strip_prefix("host: "));
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--locked", "--offline", "--format-version", "1"])
        .args(["--filter-platform", host.expect("the compiler has a host")])
        .current_dir(repository(""))
        .output()
        .expect("cargo starts");
    assert!(output.status.success(), "cargo metadata");
    let metadata: Value = serde_json::from_str(&stdout(&output)).expect("cargo prints JSON");
    metadata["packages"]
        .as_array()
        .expect("a list of packages")
        .clone()
}

#[test]
fn no_package_asks_for_a_newer_rust_than_ours() {
    let ours = version(env!("CARGO_PKG_RUST_VERSION"));
    let packages = packages();
    let newer: Vec<String> = packages
        .iter()
        .filter_map(|package| Some((package, package["rust_version"].as_str()?)))
        .filter(|(_, asked)| version(asked) > ours)
        .map(|(package, asked)| format!("{} asks for Rust {asked}", package["name"]))
        .collect();
    assert!(newer.is_empty(), "{}", newer.join("\n"));
    assert!(packages.len() > 1, "the packages are listed");
}

#[test]
fn versions_of_rust_compare_as_numbers() {
    assert!(version("1.90") < version("1.100"));
    assert!(version("1.90.1") > version("1.90"));
}

#[test]
fn the_library_alone_brings_at_most_sixty_packages() {
    let count = |features: &str| {
        let output = Command::new(env!("CARGO"))
            .args(["tree", "--locked", "--offline", "--edges", "normal"])
            .args(["--prefix", "none", "--format", "{p}"])
            .args(["--no-default-features", "--features", features])
            .current_dir(repository(""))
            .output()
            .expect("cargo starts");
        assert!(output.status.success(), "cargo tree");
        let text = stdout(&output);
        let names = text.lines().map(|line| line.trim_end_matches(" (*)"));
        names.collect::<BTreeSet<_>>().len()
    };
    let alone = count("");
    assert!(alone <= 60, "{alone} packages without features");
    assert!(alone < count("cli"), "the program needs more");
}

#[test]
fn the_packaged_crate_holds_every_file_that_the_program_embeds() {
    let output = Command::new(env!("CARGO"))
        .args(["package", "--list", "--allow-dirty", "--offline"])
        .current_dir(repository(""))
        .output()
        .expect("cargo starts");
    assert!(output.status.success(), "cargo package --list");
    let text = stdout(&output);
    let packaged: BTreeSet<&str> = text.lines().collect();
    let mut embedded = 0;
    for file in rust_files(&repository("src")) {
        let source = fs::read_to_string(&file).expect("a source is text");
        for part in source.split("include_str!(\"").skip(1) {
            let name = part.split('"').next().expect("a name");
            let path = file.with_file_name(name);
            let path = path.canonicalize().expect("an embedded file is there");
            let root = repository("").canonicalize().expect("the repository");
            let path = path.strip_prefix(root).expect("a file of the repository");
            let path = path.to_str().expect("a name in ASCII");
            assert!(packaged.contains(path), "{path} is not packaged");
            embedded += 1;
        }
    }
    assert!(embedded > 20, "embedded files are found, {embedded}");
}
