//! The import table of docs/architecture.md as a test: who may import whom, and a few house rules.

use std::fs;
use std::path::{Path, PathBuf};

use crate::support::{repository, rust_files};

/// Module, and the modules of the crate it may import.
const IMPORTS: &[(&str, &[&str])] = &[
    ("units", &[]),
    ("vocabulary", &[]),
    ("declare", &[]),
    ("wording", &[]),
    ("seal", &[]),
    ("program", &[]),
    ("linear_algebra", &[]),
    ("simd", &[]),
    ("random", &["units"]),
    ("signal", &["units"]),
    ("turntable", &["units", "signal", "random", "wording"]),
    ("gyro", &["units", "signal", "random"]),
    ("fpga", &[]),
    ("filters", &["units", "simd", "signal"]),
    ("filters/hardware", &["units", "signal", "filters", "fpga"]),
    (
        "metrics",
        &[
            "units",
            "random",
            "linear_algebra",
            "simd",
            "signal",
            "wording",
        ],
    ),
    ("calibration", &["units", "linear_algebra", "signal"]),
    ("recording", &["units", "signal", "wording"]),
    (
        "scenario",
        &[
            "units",
            "wording",
            "seal",
            "recording",
            "turntable",
            "gyro",
            "filters",
            "calibration",
            "inference",
        ],
    ),
    ("inference", &["random", "linear_algebra"]),
    ("gate", &["metrics", "scenario"]),
    ("comparison", &["metrics", "gate", "scenario"]),
    ("baseline", &["metrics"]),
    ("store", &["seal"]),
    (
        "report",
        &[
            "units",
            "metrics",
            "gate",
            "comparison",
            "baseline",
            "inference",
            "scenario",
            "signal",
            "wording",
        ],
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
            "inference",
            "recording",
            "gate",
            "comparison",
            "baseline",
            "report",
            "program",
            "seal",
            "store",
            "wording",
        ],
    ),
    (
        "cli",
        &[
            "units",
            "program",
            "experiment",
            "filters",
            "metrics",
            "gate",
            "baseline",
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
const FOR_ALL: &[&str] = &["declare", "vocabulary"];

fn sources() -> Vec<PathBuf> {
    rust_files(&repository("src"))
}

fn module_of(path: &Path) -> String {
    let source = repository("src");
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

/// Rooms of a module that may import more than the module.
const ROOMS: &[&str] = &["filters/hardware"];

/// The row of the import table that holds for a file: that of its room, else of its module.
fn row_of(path: &Path) -> String {
    let source = repository("src");
    let room = ROOMS
        .iter()
        .find(|room| path.starts_with(source.join(room)));
    room.map_or_else(|| module_of(path), |room| (*room).to_owned())
}

/// Modules of the crate that a source text names, each with the number of its line.
///
/// `crate::a::b` and groups, `crate::{a::b, c}`, however many lines they take; comments are left out.
fn imported(text: &str) -> Vec<(usize, String)> {
    let code: Vec<&str> = text
        .lines()
        .map(|line| line.split("//").next().unwrap_or_default())
        .collect();
    let code = code.join("\n");
    let mut modules = Vec::new();
    for (at, root) in code.match_indices("crate::") {
        for item in items(&code, at + root.len()) {
            let name: String = code[item..]
                .chars()
                .take_while(|c| c.is_ascii_alphanumeric() || *c == '_')
                .collect();
            if !name.is_empty() {
                modules.push((code[..item].matches('\n').count() + 1, name));
            }
        }
    }
    modules
}

/// Where the items of a path begin that goes on at `start`: there, or one each in its outer braces.
fn items(code: &str, start: usize) -> Vec<usize> {
    let blank = |at: usize| code[at..].len() - code[at..].trim_start().len();
    let start = start + blank(start);
    if !code[start..].starts_with('{') {
        return vec![start];
    }
    let mut depth = 0_usize;
    let mut found = Vec::new();
    for (offset, sign) in code[start..].char_indices() {
        match sign {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            break;
        }
        if depth == 1 && matches!(sign, '{' | ',') {
            let after = start + offset + 1;
            found.push(after + blank(after));
        }
    }
    found
}

fn forbidden_imports(module: &str, text: &str) -> Vec<(usize, String)> {
    let Some((_, allowed)) = IMPORTS.iter().find(|(name, _)| *name == module) else {
        return vec![(0, format!("module `{module}` is not in the import table"))];
    };
    let mut found = Vec::new();
    for (line, import) in imported(text) {
        let known = IMPORTS.iter().any(|(name, _)| *name == import);
        let is_allowed = [allowed, FOR_ALL].concat().contains(&import.as_str());
        if known && import != module && !is_allowed {
            found.push((line, format!("`{module}` may not import `{import}`")));
        }
    }
    found
}

#[test]
fn modules_import_only_what_the_table_allows() {
    let mut complaints = Vec::new();
    for path in sources() {
        let module = row_of(&path);
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
    let pipeline = "use crate::fpga::kinds::KINDS;";
    assert_eq!(forbidden_imports("filters", pipeline).len(), 1);
    assert!(forbidden_imports("filters/hardware", pipeline).is_empty());
}

#[test]
fn an_import_over_several_lines_is_seen() {
    let text = "use crate::{\n    // fpga is not named here\n    gyro::{Gyro, scenario},\n    \
                signal,\n    units::{\n        NANO,\n    },\n};\nfn f(x: crate::random::Stream) {}\n";
    let names = [(3, "gyro"), (4, "signal"), (5, "units"), (9, "random")];
    assert_eq!(
        imported(text),
        names.map(|(line, name)| (line, name.to_owned()))
    );
    assert_eq!(
        forbidden_imports("turntable", text),
        vec![(3, "`turntable` may not import `gyro`".to_owned())]
    );
}

#[test]
fn the_architecture_page_shows_the_import_table() {
    let page =
        fs::read_to_string(repository("docs/architecture.md")).expect("the page is readable");
    for (module, imports) in IMPORTS {
        let own_row = page.lines().find(|line| {
            let first = line
                .trim_start_matches('|')
                .split('|')
                .next()
                .unwrap_or_default();
            line.starts_with('|')
                && first
                    .split_whitespace()
                    .any(|word| word == format!("`{module}`"))
        });
        let row = own_row.unwrap_or_else(|| panic!("the page has no row for `{module}`"));
        let allowed = row.split('|').nth(2).unwrap_or_default();
        if allowed.contains("downwards") || allowed.contains("all of the above") {
            continue;
        }
        for import in *imports {
            assert!(
                allowed
                    .replace('`', " ")
                    .split_whitespace()
                    .any(|word| word == *import),
                "the page's row for `{module}` does not allow `{import}`: {row}"
            );
        }
    }
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

/// The words of the hardware are made by the four operations of its units, each rounded on its own and in
/// the order of the schedule: nothing else may stand in the model. `health` only judges them.
#[test]
fn the_model_of_the_hardware_computes_with_nothing_but_its_units() {
    const FOREIGN: &[&str] = &[
        "nalgebra",
        ".sin(",
        ".cos(",
        ".tan(",
        ".exp(",
        ".ln(",
        ".powi(",
        ".powf(",
        ".sqrt(",
        ".hypot(",
        ".mul_add(",
        ".sum(",
        ".sum::<",
        ".product(",
        ".product::<",
    ];
    let mut seen = 0;
    for path in sources() {
        if module_of(&path) != "fpga" || path.components().any(|part| part.as_os_str() == "health")
        {
            continue;
        }
        seen += 1;
        let text = fs::read_to_string(&path).expect("a source file is readable");
        let code = text.lines().take_while(|line| *line != "#[cfg(test)]");
        for (index, line) in code.enumerate() {
            let code = line.split("//").next().unwrap_or_default();
            let foreign = FOREIGN.iter().find(|word| code.contains(**word));
            assert!(
                foreign.is_none(),
                "{}:{}: {foreign:?} in the model of the hardware",
                path.display(),
                index + 1
            );
        }
    }
    assert!(seen > 20, "the model of the hardware has moved");
}

/// The types of the errors of a text's `Result`s, without blanks; none where an alias gives it.
fn error_types(text: &str) -> Vec<String> {
    let code: String = text.split_whitespace().collect();
    let results = code.match_indices("Result<");
    results
        .filter_map(|(start, name)| {
            let inside = &code[start + name.len()..];
            let (mut depth, mut error) = (0_usize, None);
            for (at, c) in inside.char_indices() {
                match c {
                    '<' | '(' | '[' => depth += 1,
                    '>' if inside[..at].ends_with('-') => {}
                    '>' if depth == 0 => {
                        return error.map(|from: usize| inside[from..at].to_owned());
                    }
                    '>' | ')' | ']' => depth = depth.checked_sub(1)?,
                    ',' if depth == 0 => error = Some(at + 1),
                    _ => {}
                }
            }
            None
        })
        .collect()
}

#[test]
fn errors_are_types() {
    let found =
        error_types("fn f() -> Result<Vec<(u8, String)>,\n String> {} Result<A, B> io::Result<C>");
    assert_eq!(found, ["String", "B"]);
    let mut violations = Vec::new();
    for path in sources() {
        let text = fs::read_to_string(&path).expect("source is readable");
        let is_text = |error: &String| error.trim_matches(['(', ')']).ends_with("String");
        if error_types(&text).iter().any(is_text) || text.contains("type Err = String;") {
            violations.push(path.display().to_string());
        }
    }
    assert!(
        violations.is_empty(),
        "a text is no error: {}",
        violations.join(", ")
    );
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

/// Rooms of a module in the order of the table in its `mod.rs`.
fn rooms_of(module: &str) -> Vec<String> {
    let path = repository(&format!("src/{module}/mod.rs"));
    let text = fs::read_to_string(path).expect("a module has a file");
    let rows = text.lines().filter_map(|line| line.strip_prefix("//! | `"));
    rows.filter_map(|row| Some(row.split_once('`')?.0.to_owned()))
        .collect()
}

/// Rooms that a file of a module names: below the root of the crate, and beside it where it is a room
/// of its own.
fn rooms_named<'a>(module: &str, code: &'a str, is_room: bool) -> Vec<&'a str> {
    let root = format!("crate::{module}::");
    let mut starts: Vec<usize> = code
        .match_indices(&root)
        .map(|(at, _)| at + root.len())
        .collect();
    if is_room {
        starts.extend(
            code.match_indices("use super::")
                .map(|(at, use_)| at + use_.len()),
        );
    }
    let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let name = |start: usize| {
        code[start..]
            .split(|c| !is_name(c))
            .next()
            .unwrap_or_default()
    };
    starts.into_iter().map(name).collect()
}

#[test]
fn rooms_of_metrics_and_report_use_those_before_them_alone() {
    for module in ["metrics", "report"] {
        let rooms = rooms_of(module);
        assert!(rooms.len() > 8, "{module}: {rooms:?}");
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("src")
            .join(module);
        let place = |name: &str| rooms.iter().position(|room| room == name);
        for path in sources().iter().filter(|path| path.starts_with(&folder)) {
            let inside = path.strip_prefix(&folder).expect("it lies there");
            let first = inside.components().next().expect("a name").as_os_str();
            let room = Path::new(first).file_stem().expect("a name");
            let Some(own) = place(&room.to_string_lossy()) else {
                continue;
            };
            let text = fs::read_to_string(path).expect("a source file is readable");
            let code = text
                .split("#[cfg(test)]\nmod tests")
                .next()
                .unwrap_or_default();
            let lines = code
                .lines()
                .map(|line| line.split("//").next().unwrap_or_default());
            let code = lines.collect::<Vec<_>>().join("\n");
            for name in rooms_named(module, &code, inside.components().count() == 1) {
                let is_before = place(name).is_none_or(|other| other <= own);
                assert!(is_before, "{} looks up to `{name}`", path.display());
            }
        }
    }
}
