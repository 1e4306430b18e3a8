//! Aligned text.

/// Rows of cells under a heading, columns aligned; numbers to the left, as their widths differ.
#[derive(Debug, Default)]
pub(crate) struct Grid {
    rows: Vec<Vec<String>>,
}

impl Grid {
    /// Adds a row.
    pub(crate) fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }

    /// Lines of text, each behind `indent`, columns two blanks apart, no trailing blanks.
    pub(crate) fn lines(&self, indent: &str) -> String {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let widths: Vec<usize> = (0..columns).map(|column| self.width(column)).collect();
        let mut text = String::new();
        for row in &self.rows {
            let mut line = String::from(indent);
            for (cell, width) in row.iter().zip(&widths) {
                line.push_str(cell);
                let pad = width + 2 - visible_width(cell);
                line.extend(std::iter::repeat_n(' ', pad));
            }
            text.push_str(line.trim_end());
            text.push('\n');
        }
        text
    }

    fn width(&self, column: usize) -> usize {
        self.rows
            .iter()
            .filter_map(|row| row.get(column))
            .map(|cell| visible_width(cell))
            .max()
            .unwrap_or(0)
    }
}

/// Characters a terminal shows: colour sequences (`ESC [ ... m`) have no width.
pub(crate) fn visible_width(text: &str) -> usize {
    let mut width = 0;
    let mut in_escape = false;
    for character in text.chars() {
        match (in_escape, character) {
            (false, '\u{1b}') => in_escape = true,
            (false, _) => width += 1,
            (true, 'm') => in_escape = false,
            (true, _) => {}
        }
    }
    width
}

/// Colours of a terminal; text without colour says the same in words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tone {
    /// All is well.
    Good,
    /// Something failed.
    Bad,
    /// Undecided or worth a look.
    Doubt,
    /// A heading.
    Heading,
}

/// `text` in a tone, or as it is without colour.
pub(crate) fn toned(text: &str, tone: Tone, colour: bool) -> String {
    let code = match tone {
        Tone::Good => "32",
        Tone::Bad => "1;31",
        Tone::Doubt => "33",
        Tone::Heading => "1",
    };
    if colour {
        format!("\u{1b}[{code}m{text}\u{1b}[0m")
    } else {
        text.to_owned()
    }
}

/// `text` broken at blanks into lines of at most `width`, each behind `indent`.
pub(crate) fn wrapped(text: &str, indent: &str, width: usize) -> String {
    let mut lines = String::new();
    let mut line = String::from(indent);
    let mut is_empty = true;
    for word in text.split_whitespace() {
        if !is_empty && visible_width(&line) + 1 + visible_width(word) > width {
            lines.push_str(&line);
            lines.push('\n');
            line = String::from(indent);
            is_empty = true;
        }
        if !is_empty {
            line.push(' ');
        }
        line.push_str(word);
        is_empty = false;
    }
    lines.push_str(&line);
    lines.push('\n');
    lines
}

/// `head`, then as many of `parts` as a line of `width` holds, the first in any case, then `aside`.
pub(crate) fn fitted(head: &str, parts: &[String], aside: &str, width: usize) -> String {
    let mut line = head.to_owned();
    let room = width.saturating_sub(visible_width(aside) + 2);
    for (index, part) in parts.iter().enumerate() {
        let gap = if index == 0 { "  " } else { "; " };
        if index > 0 && visible_width(&line) + gap.len() + visible_width(part) > room {
            break;
        }
        line.push_str(gap);
        line.push_str(part);
    }
    let mut line = line.trim_end().to_owned();
    if !aside.is_empty() {
        line.push_str("  ");
        line.push_str(aside);
    }
    line.push('\n');
    line
}

/// A name with its unit in brackets, where it has one.
pub(crate) fn with_unit(name: &str, unit: &str) -> String {
    match unit {
        "" => name.to_owned(),
        unit => format!("{name} [{unit}]"),
    }
}
