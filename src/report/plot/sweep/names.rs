//! Names of keys that fit where they stand.

use super::super::drawing::picture::text_width;

const ELLIPSIS: char = '\u{2026}';

/// The shortest end of each path, in whole words between dots, that no other path ends with; the path where
/// there is none.
pub(super) fn short_names(paths: &[&str]) -> Vec<String> {
    let short = |(own, path): (usize, &&str)| {
        let starts = path.rmatch_indices('.').map(|(dot, _)| dot + 1);
        let mut ends = starts.map(|start| &path[start..]);
        let is_unique = |end: &&str| {
            let mut others = paths.iter().enumerate().filter(|(other, _)| *other != own);
            others.all(|(_, other)| !ends_with(other, end))
        };
        ends.find(is_unique).unwrap_or(path).to_owned()
    };
    paths.iter().enumerate().map(short).collect()
}

/// Whether a path ends with whole words.
fn ends_with(path: &str, end: &str) -> bool {
    path.strip_suffix(end)
        .is_some_and(|rest| rest.is_empty() || rest.ends_with('.'))
}

/// The first of some texts that is no wider than a room in pixels, else the end of the last.
pub(super) fn fitting(texts: &[String], size: f64, room: f64) -> String {
    let fits = |text: &&String| text_width(text, size) <= room;
    match (texts.iter().find(fits), texts.last()) {
        (Some(text), _) => text.clone(),
        (None, Some(last)) => cut(last, size, room, |rest| {
            rest.remove(0);
        }),
        (None, None) => String::new(),
    }
}

/// The start of a text that is no wider than a room in pixels, all of it where it is not.
pub(super) fn start(text: &str, size: f64, room: f64) -> String {
    let mut kept = cut(text, size, room, |rest| {
        rest.pop();
    });
    // The mark stands where the rest is missing.
    if let Some(rest) = kept.strip_prefix(ELLIPSIS) {
        kept = format!("{rest}{ELLIPSIS}");
    }
    kept
}

/// A text with the mark of what is missing before it, taken from until it fits.
fn cut(text: &str, size: f64, room: f64, take: impl Fn(&mut Vec<char>)) -> String {
    if text_width(text, size) <= room {
        return text.to_owned();
    }
    let mut rest: Vec<char> = text.chars().collect();
    loop {
        let kept: String = std::iter::once(ELLIPSIS)
            .chain(rest.iter().copied())
            .collect();
        if rest.is_empty() || text_width(&kept, size) <= room {
            return kept;
        }
        take(&mut rest);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_short_name_is_the_shortest_end_of_a_path_that_is_its_own() {
        let paths = [
            "filter.rls.taps",
            "filter.mean.taps",
            "gyro.loop.bandwidth_hz",
            "seed",
            "gyro.seed",
        ];
        let short = ["rls.taps", "mean.taps", "bandwidth_hz", "seed", "gyro.seed"];
        assert_eq!(short_names(&paths), short);
        assert_eq!(short_names(&["filter.rls.taps"]), ["taps"]);
        assert_eq!(short_names(&["a.taps", "a.ztaps"]), ["taps", "ztaps"]);
    }

    #[test]
    fn what_does_not_fit_is_cut_where_it_says_least() {
        let texts = ["gyro.coil.length_m [m]", "length_m [m]"].map(str::to_owned);
        assert_eq!(fitting(&texts, 14.0, 300.0), texts[0]);
        assert_eq!(fitting(&texts, 14.0, 120.0), texts[1]);
        let end = fitting(&texts, 14.0, 60.0);
        assert!(
            end.starts_with(ELLIPSIS) && end.ends_with("_m [m]"),
            "{end}"
        );
        assert!(text_width(&end, 14.0) <= 60.0);
        let head = start("a long heading", 14.0, 60.0);
        assert!(
            head.starts_with("a lo") && head.ends_with(ELLIPSIS),
            "{head}"
        );
        assert_eq!(start("short", 14.0, 60.0), "short");
    }
}
