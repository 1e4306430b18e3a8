//! The record of a folder: its files by name and digest.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io;
use std::path::Path;

use super::WORKSHOP;
use super::files::read_text;
use crate::seal;

/// File that records a folder with the origin of a run.
pub const MANIFEST_FILE: &str = "manifest.toml";
/// File that records a folder without one.
pub const RECORD_FILE: &str = ".fogbench.toml";

const FIRST_FILE: &str = "\n[[file]]\n";
/// How the line begins that says what a folder holds.
const HOLDS: &str = "holds = \"";

/// Files of a folder, `/` between the parts of a name, with their BLAKE3 digests in hexadecimal.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Record {
    pub(super) files: BTreeMap<String, String>,
    /// What the folder holds, as the text above the record says; a manifest does not.
    pub(super) holds: Option<String>,
}

/// What a file that ought to hold a record holds.
#[derive(Debug)]
pub(super) enum Sealed {
    /// A record as it was written.
    Whole(Record),
    /// A record that was changed afterwards.
    Changed,
    /// None.
    Absent,
}

impl Record {
    /// Records every file of a folder but the record's own.
    pub(super) fn of(folder: &Path) -> io::Result<Self> {
        let mut record = Self::default();
        record.enter(folder, "")?;
        record.files.remove(MANIFEST_FILE);
        record.files.remove(RECORD_FILE);
        Ok(record)
    }

    fn enter(&mut self, folder: &Path, prefix: &str) -> io::Result<()> {
        for entry in fs::read_dir(folder)? {
            let entry = entry?;
            let file_name = entry.file_name();
            let Some(name) = file_name.to_str() else {
                let message = format!("{} is no name in Unicode", entry.path().display());
                return Err(io::Error::new(io::ErrorKind::InvalidData, message));
            };
            if prefix.is_empty() && name == WORKSHOP {
                continue;
            }
            let name = format!("{prefix}{name}");
            if entry.file_type()?.is_dir() {
                self.enter(&entry.path(), &format!("{name}/"))?;
            } else {
                self.files.insert(name, digest_of(&entry.path())?);
            }
        }
        Ok(())
    }

    /// The record in the manifest of a folder; none where there is none as it was written.
    #[must_use]
    pub fn of_manifest(folder: &Path) -> Option<Self> {
        match Self::read(&folder.join(MANIFEST_FILE)) {
            Ok(Sealed::Whole(record)) => Some(record),
            _ => None,
        }
    }

    /// Names of the files, in order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.files.keys().map(String::as_str)
    }

    /// `head` with the record below it and, last, a digest of the text itself.
    pub(super) fn sealed(&self, head: &str) -> String {
        let mut text = head.to_owned();
        for (name, digest) in &self.files {
            text.push_str(FIRST_FILE);
            let name = toml::Value::from(name.as_str());
            text.push_str(&format!("name = {name}\nblake3 = \"{digest}\"\n"));
        }
        seal::seal(&text)
    }

    /// Reads the record of a file; see [`Record::sealed`].
    pub(super) fn read(path: &Path) -> io::Result<Sealed> {
        match read_text(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Sealed::Absent),
            text => Ok(text?.map_or(Sealed::Absent, |text| Self::parse(&text))),
        }
    }

    pub(super) fn parse(text: &str) -> Sealed {
        let sealed = match seal::open(text) {
            seal::Sealed::Whole(sealed) => sealed,
            seal::Sealed::Broken => return Sealed::Changed,
            seal::Sealed::Absent => return Sealed::Absent,
        };
        let mut above_tables = sealed.lines().take_while(|line| !line.starts_with('['));
        let holds = above_tables.find_map(|line| {
            let word = line.strip_prefix(HOLDS)?.strip_suffix('"')?;
            Some(word.to_owned())
        });
        let Some(start) = sealed.find(FIRST_FILE) else {
            let files = BTreeMap::new();
            return Sealed::Whole(Self { files, holds });
        };
        let files = sealed[start..].parse::<toml::Table>().ok().and_then(|all| {
            let files = all.get("file")?.as_array()?.iter();
            let entry = |file: &toml::Value| {
                let text = |key| file.get(key)?.as_str().map(str::to_owned);
                Some((text("name")?, text("blake3")?))
            };
            files.map(entry).collect::<Option<BTreeMap<_, _>>>()
        });
        files.map_or(Sealed::Changed, |files| {
            Sealed::Whole(Self { files, holds })
        })
    }
}

/// What stands above the record of a manifest.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Head {
    /// The text, less its line `build`.
    pub text: String,
    /// That line.
    pub build: Option<String>,
}

impl Head {
    /// The head of a sealed text, or of one that is to be sealed.
    #[must_use]
    pub fn of(text: &str) -> Self {
        let head = head_of(text);
        let [before, after] = seal::without_build(head);
        let build = &head[before.len()..head.len() - after.len()];
        Self {
            text: [before, after].concat(),
            build: (!build.is_empty()).then(|| build.to_owned()),
        }
    }
}

/// What stands above the record in a sealed text; all of a text without one.
pub(super) fn head_of(text: &str) -> &str {
    let sealed = seal::above(text);
    let start = sealed.find(FIRST_FILE);
    start.map_or(sealed, |start| &sealed[..start])
}

/// BLAKE3 of a file, hexadecimal.
pub fn digest_of(path: &Path) -> io::Result<String> {
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(File::open(path)?)?;
    Ok(hasher.finalize().to_hex().to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "manifest = 1\nbuild = \"v1-3-gabc\"\n\n[tool]\nname = \"fogbench\"\n";

    fn sample() -> Record {
        let names = ["a b.csv", "samples/raw.npy"].map(str::to_owned);
        Record {
            files: names.map(|name| (name, "00".to_owned())).into(),
            holds: None,
        }
    }

    #[test]
    fn a_record_reads_back_and_its_text_is_one_document() {
        let text = sample().sealed(HEAD);
        text.parse::<toml::Table>().expect("TOML");
        assert!(matches!(Record::parse(&text), Sealed::Whole(found) if found == sample()));
        assert_eq!(head_of(&text), HEAD);
        let of_log = sample().sealed("schema = 1\nholds = \"log\"\n");
        let holds = |sealed| matches!(sealed, Sealed::Whole(found) if found.holds.as_deref() == Some("log"));
        assert!(holds(Record::parse(&of_log)));
        let empty = Record::default().sealed(HEAD);
        assert!(matches!(Record::parse(&empty), Sealed::Whole(found) if found.files.is_empty()));
        assert_eq!(head_of(&empty), HEAD);
    }

    #[test]
    fn any_change_but_of_the_build_breaks_the_seal() {
        let text = sample().sealed(HEAD);
        let other_build = text.replace("v1-3-gabc", "v1-4-gdef-dirty");
        assert!(matches!(Record::parse(&other_build), Sealed::Whole(_)));
        let without = text.replace("build = \"v1-3-gabc\"\n", "");
        assert!(matches!(Record::parse(&without), Sealed::Whole(_)));
        for changed in [
            text.replace("manifest = 1", "manifest = 2"),
            text.replace("\"00\"", "\"01\""),
            text.replace("[tool]\n", "[tool]\nbuild = \"x\"\n"),
            format!("{text}\n[more]\n"),
            text.replace("# Of", "# On") + "x = 1\n",
        ] {
            assert!(
                matches!(Record::parse(&changed), Sealed::Changed),
                "{changed}"
            );
        }
        assert!(matches!(Record::parse(HEAD), Sealed::Absent));
    }
}
