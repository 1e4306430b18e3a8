//! The import table of the README as a test: who may import whom, and a few house rules.

use std::fs;
use std::path::{Path, PathBuf};

/// Module, and the modules of the crate it may import.
pub(crate) const IMPORTS: &[(&str, &[&str])] = &[
    ("units", &[]),
    ("vocabulary", &[]),
    ("wording", &[]),
    ("linear_algebra", &[]),
    ("random", &["units"]),
    ("signal", &["units"]),
    ("scenario", &["units", "recording", "wording"]),
    ("turntable", &["units", "signal", "random", "scenario"]),
    ("gyro", &["units", "signal", "random", "scenario"]),
    ("fpga", &[]),
    ("filters", &["signal"]),
    ("metrics", &["units", "linear_algebra", "signal", "wording"]),
    ("calibration", &["units", "linear_algebra", "signal"]),
    ("recording", &["units", "signal", "wording"]),
    ("gate", &["metrics", "scenario"]),
    ("store", &[]),
    (
        "report",
        &["units", "metrics", "gate", "scenario", "signal", "wording"],
    ),
    (
        "experiment",
        &[
            "units",
            "random",
            "signal",
            "scenario",
            "turntable",
            "gyro",
            "fpga",
            "filters",
            "metrics",
            "calibration",
            "recording",
            "gate",
            "report",
            "store",
            "wording",
        ],
    ),
    (
        "cli",
        &[
            "units",
            "experiment",
            "gate",
            "recording",
            "report",
            "scenario",
            "store",
            "fpga",
            "wording",
        ],
    ),
];

/// Modules that every other one may import.
pub(crate) const FOR_ALL: &[&str] = &["vocabulary"];

fn rust_files(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<_> = fs::read_dir(folder)
        .expect("a source folder is readable")
        .flatten()
        .collect();
    entries.sort_by_key(std::fs::DirEntry::path);
    for entry in entries {
        let path = entry.path();
        if path.is_dir() {
            rust_files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

fn sources() -> Vec<PathBuf> {
    let mut found = Vec::new();
    rust_files(
        &Path::new(env!("CARGO_MANIFEST_DIR")).join("src"),
        &mut found,
    );
    found
}

fn module_of(path: &Path) -> String {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let inside = path
        .strip_prefix(source)
        .expect("every source lies under src");
    let first = inside
        .components()
        .next()
        .expect("a path has a first component");
    Path::new(first.as_os_str())
        .file_stem()
        .expect("a name")
        .to_string_lossy()
        .into_owned()
}

/// Modules of the crate that a line of code names: `crate::a::b` and `crate::{a::b, c}`.
fn imported(line: &str) -> Vec<String> {
    let code = line.split("//").next().unwrap_or_default();
    let name = |text: &str| -> String {
        text.chars()
            .take_while(|c| c.is_ascii_alphanumeric() || *c == '_')
            .collect()
    };
    let mut modules = Vec::new();
    for rest in code.split("crate::").skip(1) {
        if let Some(group) = rest.strip_prefix('{') {
            modules.extend(group.split(',').map(|item| name(item.trim())));
        } else {
            modules.push(name(rest));
        }
    }
    modules.retain(|module| !module.is_empty());
    modules
}

fn forbidden_imports(module: &str, text: &str) -> Vec<(usize, String)> {
    let Some((_, allowed)) = IMPORTS.iter().find(|(name, _)| *name == module) else {
        return vec![(0, format!("module `{module}` is not in the import table"))];
    };
    let mut found = Vec::new();
    for (index, line) in text.lines().enumerate() {
        for import in imported(line) {
            let known = IMPORTS.iter().any(|(name, _)| *name == import);
            let import_name = import.as_str();
            let is_allowed = allowed.contains(&import_name) || FOR_ALL.contains(&import_name);
            if known && import != module && !is_allowed {
                found.push((index + 1, format!("`{module}` may not import `{import}`")));
            }
        }
    }
    found
}

#[test]
fn modules_import_only_what_the_table_allows() {
    let mut complaints = Vec::new();
    for path in sources() {
        let module = module_of(&path);
        if module == "lib" || module == "main" {
            continue;
        }
        let text = fs::read_to_string(&path).expect("a source file is readable");
        for (line, complaint) in forbidden_imports(&module, &text) {
            complaints.push(format!("{}:{line}: {complaint}", path.display()));
        }
    }
    assert!(
        complaints.is_empty(),
        "forbidden imports:\n{}",
        complaints.join("\n")
    );
}

#[test]
fn a_forbidden_import_is_found() {
    let found = forbidden_imports("turntable", "use crate::units;\nuse crate::gyro::Gyro;\n");
    assert_eq!(
        found,
        vec![(2, "`turntable` may not import `gyro`".to_owned())]
    );
    assert_eq!(
        forbidden_imports("filters", "use crate::{signal::A, scenario::B};").len(),
        1
    );
    assert!(forbidden_imports("gate", "// use crate::gyro::Gyro;").is_empty());
}

#[test]
fn only_the_command_line_prints() {
    for path in sources() {
        let module = module_of(&path);
        let text = fs::read_to_string(&path).expect("a source file is readable");
        for (index, line) in text.lines().enumerate() {
            let code = line.split("//").next().unwrap_or_default();
            let prints = ["println!", "eprintln!", "print!(", "eprint!("];
            assert!(
                module == "cli" || !prints.iter().any(|word| code.contains(word)),
                "{}:{}: prints outside `cli`",
                path.display(),
                index + 1
            );
        }
    }
}

#[test]
fn plotters_is_used_by_the_report_alone() {
    for path in sources() {
        let text = fs::read_to_string(&path).expect("a source file is readable");
        assert!(
            module_of(&path) == "report" || !text.contains("plotters::"),
            "{} uses plotters",
            path.display()
        );
    }
}

/// A file has one subject, whatever its length: this guards only against files that nobody reads whole.
const LINES_MAX: usize = 600;

#[test]
fn no_source_file_is_too_long_to_be_read_whole() {
    for path in sources() {
        let text = fs::read_to_string(&path).expect("a source file is readable");
        let lines = text
            .lines()
            .take_while(|line| *line != "#[cfg(test)]")
            .count();
        assert!(lines <= LINES_MAX, "{} has {lines} lines", path.display());
    }
}
