//! Page of the scenario keys: the reference file as tables, one for each table of keys.

/// Paragraphs of comment that end the first sentence of a key say one of these.
const PRESENCES: [&str; 3] = ["default.", "required.", "optional."];

const HEAD: &str = "\
# Scenario keys

<!-- Generated from scenarios/reference.toml by the test `generated_page_of_the_scenario_keys`. -->

A scenario is a TOML file. Every key is declared once, beside the equations that use it; printed from these
declarations are this page, [`scenarios/reference.toml`](../scenarios/reference.toml), a scenario of
defaults with the same text as comments, and the JSON Schema for editors,
[`scenarios/scenario.schema.json`](../scenarios/scenario.schema.json) (`fogbench schema` prints it).

";

/// Line of the reference without the mark of an alternative.
enum Line<'a> {
    Blank,
    Rule,
    Comment(&'a str),
    Table(&'a str),
    Value {
        key: &'a str,
        value: &'a str,
    },
    /// Continuation of a value over several lines.
    More(&'a str),
}

impl<'a> Line<'a> {
    fn of(line: &'a str) -> Self {
        let text = line.strip_prefix("#| ").unwrap_or(line);
        if text.is_empty() || line == "#|" {
            Self::Blank
        } else if text.starts_with("# ---") {
            Self::Rule
        } else if let Some(comment) = text.strip_prefix('#') {
            Self::Comment(comment.trim())
        } else if text.starts_with('[') {
            Self::Table(text)
        } else if let Some((key, value)) = text.split_once(" = ") {
            Self::Value { key, value }
        } else {
            Self::More(text.trim())
        }
    }
}

struct Key {
    name: String,
    /// Comment of the key as one paragraph; empty where a later alternative repeats it.
    comment: String,
    value: String,
}

/// Table of keys, with what the reference says before it.
#[derive(Default)]
struct Table {
    name: String,
    prose: Vec<String>,
    keys: Vec<Key>,
}

/// Part of the reference between two rules.
#[derive(Default)]
struct Part {
    prose: Vec<String>,
    tables: Vec<Table>,
}

impl Part {
    fn table(&mut self, name: &str) -> &mut Table {
        let found = self.tables.iter().position(|table| table.name == name);
        let index = found.unwrap_or_else(|| {
            self.tables.push(Table {
                name: name.to_owned(),
                ..Table::default()
            });
            self.tables.len() - 1
        });
        &mut self.tables[index]
    }
}

fn parts(reference: &str) -> Vec<Part> {
    let mut parts = vec![Part::default()];
    let mut table = String::new();
    let mut comment: Vec<&str> = Vec::new();
    for line in reference.lines() {
        let is_general = parts.len() == 1;
        let part = parts.last_mut().expect("there is a first part");
        match Line::of(line) {
            Line::Rule => {
                parts.push(Part::default());
                table.clear();
            }
            Line::Comment(text) if !text.is_empty() => comment.push(text),
            Line::Comment(_) | Line::Blank => {
                if !comment.is_empty() {
                    part.prose.push(std::mem::take(&mut comment).join(" "));
                }
            }
            Line::Table(name) => {
                name.clone_into(&mut table);
                // What stands before the table is about it, save the first paragraph of the part.
                let heads = if is_general { part.prose.len() } else { 1 };
                let mut prose = part.prose.split_off(heads.min(part.prose.len()));
                if !comment.is_empty() {
                    prose.push(std::mem::take(&mut comment).join(" "));
                }
                let entry = part.table(name);
                // Prose before a second alternative of the same keys introduces that example only.
                if entry.keys.is_empty() {
                    entry.prose.extend(prose);
                }
            }
            Line::Value { key, value } => {
                let entry = part.table(&table);
                entry.keys.push(Key {
                    name: key.to_owned(),
                    comment: std::mem::take(&mut comment).join(" "),
                    value: value.to_owned(),
                });
            }
            Line::More(text) => {
                let key = part.table(&table).keys.last_mut();
                key.expect("a value goes on").value.push_str(text);
            }
        }
    }
    parts
}

/// Type and range, unit, presence and meaning of a key's comment.
fn declared(comment: &str) -> (&str, &str, &str, &str) {
    let (end, presence) = PRESENCES
        .iter()
        .filter_map(|presence| comment.find(presence).map(|at| (at, *presence)))
        .min()
        .unwrap_or_else(|| panic!("no presence in the comment of a key: {comment}"));
    let meaning = comment[end + presence.len()..].trim();
    let head = comment[..end].trim_end_matches("; ");
    let (kind, unit) = head.split_once("; unit ").unwrap_or((head, ""));
    (kind, unit, presence.trim_end_matches('.'), meaning)
}

/// Text of the reference as Markdown.
fn markdown(text: &str) -> String {
    text.replace('|', "\\|")
        .replace('*', "\\*")
        .replace('<', "&lt;")
}

/// Paragraph that begins as a sentence.
fn paragraph(text: &str) -> String {
    let text = text.trim_start_matches([':', '.', ' ']);
    let mut letters = text.chars();
    let is_file = text
        .split(' ')
        .next()
        .is_some_and(|word| word.contains('.'));
    let first = letters
        .next()
        .map(|c| if is_file { c } else { c.to_ascii_uppercase() });
    let sentence: String = first.into_iter().chain(letters).collect();
    if sentence.is_empty() {
        sentence
    } else {
        format!("{}\n\n", markdown(&sentence))
    }
}

fn row(key: &Key) -> String {
    let (kind, unit, presence, meaning) = declared(&key.comment);
    let default = match presence {
        "default" => format!("`{}`", key.value),
        other => other.to_owned(),
    };
    let cells = [kind, unit, &default, meaning].map(markdown);
    format!("| `{}` | {} |\n", key.name, cells.join(" | "))
}

/// Appends the tables of a part; every key must have its comment in one of the alternatives.
fn tables(part: &Part, page: &mut String) {
    for table in &part.tables {
        let keys = &table.keys;
        let documented: Vec<&Key> = keys.iter().filter(|key| !key.comment.is_empty()).collect();
        for key in keys {
            // The keys of a matrix are paths to keys of other tables.
            let is_path = key.name.starts_with('"');
            let is_documented = is_path || documented.iter().any(|other| other.name == key.name);
            assert!(is_documented, "{}.{} has no comment", table.name, key.name);
        }
        if documented.is_empty() && table.prose.is_empty() {
            continue;
        }
        if !table.name.is_empty() {
            page.push_str(&format!("### `{}`\n\n", table.name));
        }
        page.extend(table.prose.iter().map(|prose| paragraph(prose)));
        if !documented.is_empty() {
            page.push_str(
                "| key | type and range | unit | default | meaning |\n|---|---|---|---|---|\n",
            );
            page.extend(documented.iter().map(|key| row(key)));
            page.push('\n');
        }
    }
}

/// Markdown page of a reference file.
pub(crate) fn page(reference: &str) -> String {
    let mut page = HEAD.to_owned();
    let mut parts = parts(reference);
    let first = parts.remove(0);
    let general = first.prose.iter().skip(1);
    page.extend(general.map(|prose| paragraph(&prose.replace("this file", "`reference.toml`"))));
    page.push_str("## Scenario\n\n");
    tables(&first, &mut page);
    for part in &parts {
        let prose = part.prose.first().expect("a part begins with its subject");
        let end = prose.find([':', '.']).unwrap_or(prose.len());
        page.push_str(&format!(
            "## {}\n\n{}",
            &prose[..end],
            paragraph(&prose[end..])
        ));
        page.extend(part.prose[1..].iter().map(|prose| paragraph(prose)));
        tables(part, &mut page);
    }
    page.truncate(page.trim_end().len());
    page.push('\n');
    page
}
