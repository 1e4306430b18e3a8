//! Long texts, shortened for messages.

use std::borrow::Cow;

/// Most characters of a value, a key or a `--set` argument in a message.
const VALUE_CHARACTERS_MAX: usize = 160;

/// Most characters of a message: above those of the longest list of allowed words.
const MESSAGE_CHARACTERS_MAX: usize = 4000;

/// A value as messages show it: a long one by its beginning, its length and its end.
#[must_use]
pub fn excerpt(value: &str) -> Cow<'_, str> {
    shortened(value, VALUE_CHARACTERS_MAX)
}

/// A message as it is printed: whatever stands in it, it stays readable.
#[must_use]
pub fn bounded(message: &str) -> Cow<'_, str> {
    shortened(message, MESSAGE_CHARACTERS_MAX)
}

/// A text of up to `characters_max` characters as it is, else its first two thirds and its last.
fn shortened(text: &str, characters_max: usize) -> Cow<'_, str> {
    if text.len() <= characters_max {
        return Cow::Borrowed(text);
    }
    let count = text.chars().count();
    if count <= characters_max {
        return Cow::Borrowed(text);
    }
    let at = |index: usize| {
        text.char_indices()
            .nth(index)
            .map_or(text.len(), |(at, _)| at)
    };
    let head = &text[..at(characters_max * 2 / 3)];
    let tail = &text[at(count - characters_max / 3)..];
    Cow::Owned(format!("{head} ... ({count} characters) ... {tail}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_values_stay_and_long_ones_tell_their_length() {
        assert_eq!(excerpt("abc"), "abc");
        let exact = "é".repeat(VALUE_CHARACTERS_MAX);
        assert_eq!(excerpt(&exact), exact, "characters count, not bytes");
        let long = format!("begin{}end", "é".repeat(120_000));
        let short = excerpt(&long);
        assert!(
            short.starts_with("begin") && short.ends_with("end"),
            "{short}"
        );
        assert!(short.contains("(120008 characters)"), "{short}");
        assert!(short.chars().count() < VALUE_CHARACTERS_MAX + 40, "{short}");
    }
}
