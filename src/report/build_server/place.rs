//! Place of a gate, taken apart.

/// File and line out of a place `file:line:column`; none for a `--set` argument, which has neither.
pub(super) fn file_and_line(place: &str) -> Option<(&str, usize)> {
    if place.starts_with("--set ") {
        return None;
    }
    let mut parts = place.rsplitn(3, ':');
    let _column: usize = parts.next()?.parse().ok()?;
    let line = parts.next()?.parse().ok()?;
    Some((parts.next()?, line))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_falls_apart_at_its_last_two_colons() {
        assert_eq!(file_and_line("a/b.toml:12:1"), Some(("a/b.toml", 12)));
        assert_eq!(file_and_line("c:/b.toml:12:1"), Some(("c:/b.toml", 12)));
        assert_eq!(file_and_line("--set gate=[1:2:3]"), None);
        assert_eq!(file_and_line("b.toml"), None);
    }
}
