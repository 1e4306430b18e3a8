//! Why a baseline cannot be read.

/// Why a baseline cannot be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BaselineError {
    /// The text is no TOML of this form.
    #[error("{0}")]
    Syntax(String),
    /// Another program's version of the form.
    #[error("schema = {0} is not supported: this build reads schema 1")]
    Schema(i64),
    /// A word that stands for nothing.
    #[error("{id}: direction = \"{word}\" is none of lower, higher, none")]
    Direction {
        /// The metric.
        id: String,
        /// The word.
        word: String,
    },
    /// A number that makes no sense.
    #[error("{id}: {key} = {value} is out of range: {expected}")]
    Range {
        /// The metric.
        id: String,
        /// The key.
        key: &'static str,
        /// Its value.
        value: f64,
        /// What may stand there.
        expected: &'static str,
    },
    /// A digest that no scenario has.
    #[error(
        "{id}: digest = {digest:?} is no digest of a scenario: expected hexadecimal digits, as `baseline save` writes them"
    )]
    Digest {
        /// Figure.
        id: String,
        /// What stands there.
        digest: String,
    },
    /// A name that no scenario can have.
    #[error("`{0}` holds a character that no name has")]
    Name(String),
    /// The same metric twice.
    #[error("{0} stands twice")]
    Twice(String),
}
