//! Markdown that says what a text says.

use crate::scenario::bounded;

/// A text that stays within its cell, whatever it holds.
pub(in crate::report) fn cell(text: &str) -> String {
    let mut cell = String::new();
    for c in bounded(text).chars() {
        match c {
            '&' => cell.push_str("&amp;"),
            '<' => cell.push_str("&lt;"),
            '>' => cell.push_str("&gt;"),
            '|' | '`' | '*' | '_' | '[' | ']' | '\\' | '~' => cell.extend(['\\', c]),
            '\n' | '\r' => cell.push(' '),
            c => cell.push(c),
        }
    }
    cell
}
