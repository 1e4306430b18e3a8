//! Files of the repository that are generated: compared in every test run, written on request.

use super::repository;

/// The variable that makes the tests write what they would compare.
const BLESS: &str = "FOGBENCH_BLESS";

/// Holds a file of the repository to the text it is generated as; with `FOGBENCH_BLESS=1` writes it.
///
/// The test that calls it has `generated` in its name, so that one command writes all of them:
/// `FOGBENCH_BLESS=1 cargo test --test integration generated`.
///
/// * `path`: from the root of the repository, with forward slashes.
#[track_caller]
pub(crate) fn generated(path: &str, text: &str) {
    let file = repository(path);
    let found = std::fs::read_to_string(&file).unwrap_or_default();
    if found == text {
        return;
    }
    if std::env::var_os(BLESS).is_some_and(|value| value == "1") {
        if let Some(folder) = file.parent() {
            std::fs::create_dir_all(folder).expect("the folder of a generated file can be made");
        }
        std::fs::write(&file, text).expect("a generated file can be written");
        return;
    }
    let (line, found, wanted) = first_difference(&found, text);
    panic!(
        "{path} is not what is generated from the declarations; line {line} is\n  {found}\nand \
         should be\n  {wanted}\nwrite it anew with {BLESS}=1 cargo test --test integration generated"
    );
}

/// Number of the first line that differs, from 1, with both lines.
fn first_difference(found: &str, wanted: &str) -> (usize, String, String) {
    let mut found = found.split('\n');
    let mut wanted = wanted.split('\n');
    let mut line = 0;
    loop {
        line += 1;
        let pair = (found.next(), wanted.next());
        if pair.0 != pair.1 || pair == (None, None) {
            let shown = |text: Option<&str>| text.unwrap_or("(the end of the file)").to_owned();
            return (line, shown(pair.0), shown(pair.1));
        }
    }
}

#[test]
fn the_first_difference_is_told_by_line() {
    let differs = |found, wanted| first_difference(found, wanted).0;
    assert_eq!(differs("a\nb\n", "a\nc\n"), 2);
    assert_eq!(differs("a\n", "a\nb\n"), 2);
    assert_eq!(differs("", "a"), 1);
}
