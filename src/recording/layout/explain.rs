//! What was found of a layout, in one line for people.

use super::Layout;
use super::columns::{Chosen, NO_TIME};
use super::words::{DecimalSign, Encoding, Separator};
use crate::recording::log::format::LogFormat;
use crate::recording::text::lines::shown;
use crate::wording::counted;

impl Layout {
    /// What was found, as it could have been given; the rest stays as it was given.
    pub(in crate::recording) fn format(&self, chosen: &Chosen, given: &LogFormat) -> LogFormat {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "lines of the first ones, columns of a line"
        )]
        let whole = |count: usize| Some(count as u32);
        // A name of which there are two, or that is a number, would mean another column.
        let name = |index: usize| {
            let name = self.name(index).unwrap_or_default();
            let same = self.names.iter().filter(|other| **other == name).count();
            if same == 1 {
                name
            } else {
                (index + 1).to_string()
            }
        };
        let names = |indices: &mut dyn Iterator<Item = usize>| Some(indices.map(name).collect());
        let (time, time_unit) = match chosen.time[..] {
            [] => (Some(vec![NO_TIME.to_owned()]), None),
            _ => (
                names(&mut chosen.time.iter().map(|(index, _)| *index)),
                Some(chosen.time.iter().map(|(_, unit)| *unit).collect()),
            ),
        };
        let beside = given.beside().count();
        let data = &chosen.data[..chosen.data.len().saturating_sub(beside)];
        LogFormat {
            column: names(&mut data.iter().copied()),
            time,
            time_unit,
            skip_lines: whole(self.skip_lines),
            heading_line: whole(self.heading_line.unwrap_or(0)),
            units_line: whole(self.units_line.unwrap_or(0)),
            separator: Some(self.separator),
            decimal: Some(self.decimal),
            encoding: Some(self.encoding),
            ..given.clone()
        }
    }

    /// What the file was taken for: `3 columns between commas, heading in line 1, ...`.
    pub(in crate::recording) fn line(&self, chosen: &Chosen) -> String {
        let mut parts = Vec::new();
        if self.encoding != Encoding::Utf8 {
            parts.push(self.encoding.to_string());
        }
        parts.push(match (self.wrapped, self.cells) {
            (Some(columns), _) => format!("records of {} row by row", counted(columns, "value")),
            (None, 1) => "1 column".to_owned(),
            (None, cells) => {
                let between = match self.separator {
                    Separator::Comma => "commas",
                    Separator::Semicolon => "semicolons",
                    Separator::Tab => "tabs",
                    Separator::Blanks => "blanks",
                };
                format!("{cells} columns between {between}")
            }
        });
        if self.decimal == DecimalSign::Comma {
            parts.push("decimal comma".to_owned());
        }
        if self.skip_lines > 0 {
            parts.push(format!("{} passed over", counted(self.skip_lines, "line")));
        }
        if self.preamble > 0 {
            parts.push(format!("{} of text above", counted(self.preamble, "line")));
        }
        if self.comments > 0 {
            parts.push(counted(self.comments, "comment"));
        }
        parts.push(match self.heading_line {
            Some(line) => format!("heading in line {line}"),
            None => "no heading".to_owned(),
        });
        if let Some(line) = self.units_line {
            parts.push(format!("units in line {line}"));
        }
        parts.push(format!("rows from line {}", self.first_row_line));
        let names = |indices: &mut dyn Iterator<Item = usize>| {
            let names = indices.map(|index| {
                self.name(index)
                    .map_or_else(|| "1".to_owned(), |name| shown(&name))
            });
            names.collect::<Vec<_>>().join(", ")
        };
        parts.push(format!("data {}", names(&mut chosen.data.iter().copied())));
        if !chosen.time.is_empty() {
            let units: Vec<String> = chosen
                .time
                .iter()
                .map(|(_, unit)| unit.to_string())
                .collect();
            parts.push(format!(
                "time {} in {}",
                names(&mut chosen.time.iter().map(|(index, _)| *index)),
                units.join(", ")
            ));
        }
        parts.join(", ")
    }
}
