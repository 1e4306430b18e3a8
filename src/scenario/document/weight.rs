//! The memory that a TOML document will take, told before it is parsed.

use toml_parser::Source;
use toml_parser::lexer::TokenKind;

/// Most memory that the documents of one scenario may take, bytes: several times what the longest
/// script table in a manifest needs.
pub(crate) const MEMORY_BYTES_MAX: u64 = 200_000_000;

/// Memory of a token while the parser works, bytes.
const TOKEN_BYTES: u64 = 48;
/// Memory of a value, bytes.
const VALUE_BYTES: u64 = 160;
/// Memory of a table, bytes.
const TABLE_BYTES: u64 = 1200;

/// Open brackets beyond which the parser refuses a document anyway.
const DEPTH_MAX: usize = 128;

/// Takes the memory of a document off what is left.
///
/// # Errors
/// The byte of the text at which nothing is left.
pub(crate) fn charge(text: &str, left: &mut u64) -> Result<(), usize> {
    let mut state = State::default();
    for token in Source::new(text).lex() {
        let bytes = TOKEN_BYTES + state.after(token.kind());
        *left = left.checked_sub(bytes).ok_or(token.span().start())?;
    }
    Ok(())
}

/// Where in a document a token stands.
#[derive(Debug, Default)]
struct State {
    /// Whether it stands behind an equals sign.
    is_value: bool,
    /// For each open bracket of a value, whether it is that of an array.
    arrays: Vec<bool>,
}

impl State {
    /// Memory of what a token begins, bytes.
    fn after(&mut self, kind: TokenKind) -> u64 {
        let is_in_array = self.arrays.last().copied().unwrap_or(false);
        match kind {
            TokenKind::Equals => {
                self.is_value = true;
                VALUE_BYTES
            }
            TokenKind::Comma => VALUE_BYTES,
            TokenKind::Newline => {
                self.is_value &= !self.arrays.is_empty();
                0
            }
            // The point of a number in an array, and the heading of a table.
            TokenKind::Dot if is_in_array => 0,
            TokenKind::LeftSquareBracket if self.is_value => {
                self.open(true);
                VALUE_BYTES
            }
            TokenKind::LeftCurlyBracket => {
                self.open(false);
                TABLE_BYTES
            }
            TokenKind::Dot | TokenKind::LeftSquareBracket => TABLE_BYTES,
            TokenKind::RightSquareBracket | TokenKind::RightCurlyBracket => {
                self.arrays.pop();
                0
            }
            _ => 0,
        }
    }

    fn open(&mut self, is_array: bool) {
        if self.arrays.len() < DEPTH_MAX {
            self.arrays.push(is_array);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn weight(text: &str) -> u64 {
        let mut left = MEMORY_BYTES_MAX;
        charge(text, &mut left).expect("a short text");
        MEMORY_BYTES_MAX - left
    }

    /// Memory beyond that of the tokens.
    fn parts(text: &str) -> u64 {
        weight(text) - TOKEN_BYTES * Source::new(text).lex().count() as u64
    }

    #[test]
    fn values_and_tables_are_told_from_points_and_commas_in_strings() {
        assert_eq!(parts("# a.b = [1, 2]\n"), 0);
        assert_eq!(parts("a = 'x,y.z'\n"), VALUE_BYTES);
        assert_eq!(parts("a = [1.5, 2.5]\nb = 1\n"), 4 * VALUE_BYTES);
        assert_eq!(parts("a = [\n1.5,\n2.5]\n"), 3 * VALUE_BYTES);
        assert_eq!(parts("[a.b]\n"), 2 * TABLE_BYTES);
        assert_eq!(
            parts("a = [{ b.c = 1 }]\n"),
            2 * TABLE_BYTES + 3 * VALUE_BYTES
        );
    }

    #[test]
    fn the_place_where_memory_ends_is_told() {
        let mut left = 10 * TOKEN_BYTES + 4 * VALUE_BYTES;
        assert_eq!(charge("a=[1,1,1,1,1]", &mut left), Err(8));
    }
}
