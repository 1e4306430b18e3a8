//! Rows of CSV, as RFC 4180 has them with plain line feeds.

/// Adds a row, its cells quoted where a comma, a quote or an end of a line would break it.
pub(in crate::report) fn push_row(text: &mut String, cells: impl IntoIterator<Item = String>) {
    for (index, cell) in cells.into_iter().enumerate() {
        if index > 0 {
            text.push(',');
        }
        if cell.contains([',', '"', '\n', '\r']) {
            text.push('"');
            text.push_str(&cell.replace('"', "\"\""));
            text.push('"');
        } else {
            text.push_str(&cell);
        }
    }
    text.push('\n');
}
