//! Digests by which any change shows: of words, and at the end of a text as its seal.
//!
//! Invariant: knows lines and numbers, not what they mean; imports nothing.

/// How a seal begins.
const SEAL: &str = "\n[record]\n";
/// The one line that a seal leaves out: two builds of one version give the same.
const BUILD_LINE: &str = "build = ";

/// BLAKE3 of words, as little-endian binary64 one after another, hexadecimal.
pub(crate) fn digest_of_words(words: &[f64]) -> String {
    let mut hasher = blake3::Hasher::new();
    let mut bytes = Vec::with_capacity(8 * WORDS_AT_ONCE);
    for words in words.chunks(WORDS_AT_ONCE) {
        bytes.clear();
        bytes.extend(words.iter().flat_map(|word| word.to_le_bytes()));
        hasher.update(&bytes);
    }
    hasher.finalize().to_hex().to_string()
}

/// BLAKE3 of bytes, hexadecimal.
pub(crate) fn digest_of_bytes(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex().to_string()
}

/// Words that are hashed together.
const WORDS_AT_ONCE: usize = 1 << 12;

/// What the seal of a text says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sealed<'a> {
    /// The text above the seal is as it was sealed.
    Whole(&'a str),
    /// The text above the seal, the seal or both were changed.
    Broken,
    /// There is no seal.
    Absent,
}

/// A text with its seal below it.
pub(crate) fn seal(text: &str) -> String {
    let digest = digest_of(text);
    format!("{text}{SEAL}# Of the text above, less its line `build`.\nblake3 = \"{digest}\"\n")
}

/// What the seal of a text says of it.
pub(crate) fn open(text: &str) -> Sealed<'_> {
    let Some(end) = text.rfind(SEAL) else {
        return Sealed::Absent;
    };
    let (above, found) = text.split_at(end);
    if found == &seal(above)[end..] {
        Sealed::Whole(above)
    } else {
        Sealed::Broken
    }
}

/// What stands above the seal of a text, or would.
pub(crate) fn above(text: &str) -> &str {
    text.rfind(SEAL).map_or(text, |end| &text[..end])
}

/// BLAKE3 of a text less its line `build` above the first table.
fn digest_of(text: &str) -> String {
    let mut hasher = blake3::Hasher::new();
    for part in without_build(text) {
        hasher.update(part.as_bytes());
    }
    hasher.finalize().to_hex().to_string()
}

/// A text in the parts before and after its line `build` above the first table.
pub(crate) fn without_build(text: &str) -> [&str; 2] {
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        if line.starts_with('[') {
            break;
        }
        if line.starts_with(BUILD_LINE) {
            return [&text[..start], &text[start + line.len()..]];
        }
        start += line.len();
    }
    [text, ""]
}
