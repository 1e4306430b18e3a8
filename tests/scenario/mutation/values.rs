//! Numbers, spellings of tables and mutations of text.

use crate::support::seeded::Draws;

/// Numbers as cells hold them, sound or not.
const CELLS: [&str; 36] = [
    "0",
    "-0",
    "1",
    "-1",
    "1e3",
    "-2.5E-3",
    "+7",
    ".5",
    "5.",
    "1e12",
    "-1e12",
    "1e11",
    "1e-12",
    "1e-300",
    "5e-324",
    "-5e-324",
    "1e100",
    "1e153",
    "1e308",
    "1.7976931348623157e308",
    "1e309",
    "-1e999",
    "nan",
    "inf",
    "-infinity",
    "",
    "x",
    "1,5",
    "0x10",
    "1e",
    "1_000",
    "\u{2212}3",
    "1.0x",
    "--1",
    "\u{fffd}",
    "9007199254740993",
];

/// Pieces of text that readers meet.
const PIECES: [&str; 22] = [
    ",",
    ";",
    "\t",
    " ",
    "\n",
    "\r\n",
    "\r",
    "\n\n",
    "#",
    "\n# c\n",
    "\"",
    "\"\"",
    "\u{feff}",
    "\0",
    "e",
    ".",
    "-",
    "nan",
    "\u{a0}",
    "\u{2028}",
    "\u{1a}",
    "\u{1b}[31m",
];

/// A record of numbers of one of the kinds that estimators stumble over.
pub(super) fn record(draws: &mut Draws, count: usize) -> Vec<f64> {
    let scale = draws.log_uniform(1e-9, 1e9);
    let offset = if draws.chance(0.5) {
        0.0
    } else {
        scale * (draws.unit() - 0.5) * 100.0
    };
    let kind = draws.below(10);
    let mut walk = 0.0;
    let mut values: Vec<f64> = (0..count)
        .map(|k| {
            let noise = draws.unit() + draws.unit() + draws.unit() - 1.5;
            walk += noise;
            let k = k as f64;
            offset
                + scale
                    * match kind {
                        0 => 0.0,
                        1 => k,
                        2 => walk,
                        3 => (k * 0.3).sin(),
                        4 => (k * 0.3).sin() + 0.1 * noise,
                        5 => [1.0, -1.0][usize::from(k.rem_euclid(2.0) > 0.5)],
                        6 => noise.round(),
                        7 => (noise * 1e-15) + 1.0,
                        _ => noise,
                    }
        })
        .collect();
    // A few odd ones among them.
    while draws.chance(0.15) && !values.is_empty() {
        let at = draws.below(values.len());
        let odd = [
            0.0,
            -0.0,
            5e-324,
            1e-300,
            1e12,
            -1e12,
            1e9,
            f64::EPSILON,
            values[0],
        ];
        values[at] = *draws.pick(&odd);
    }
    values
}

/// How a table is written down.
pub(super) struct Spelling {
    pub(super) separator: &'static str,
    line_end: &'static str,
    before: &'static str,
    is_quoted: bool,
    is_trailing: bool,
}

impl Spelling {
    pub(super) fn draw(draws: &mut Draws) -> Self {
        Self {
            separator: draws.pick::<&str>(&[",", ",", ";", "\t", " ", " ; "]),
            line_end: draws.pick::<&str>(&["\n", "\n", "\n", "\r\n", "\r"]),
            before: draws.pick::<&str>(&["", "", "", "\u{feff}", "# a log\n", "\n"]),
            is_quoted: draws.chance(0.05),
            is_trailing: draws.chance(0.1),
        }
    }

    pub(super) fn text(&self, lines: &[Vec<String>]) -> String {
        let mut text = self.before.to_owned();
        for cells in lines {
            for (index, cell) in cells.iter().enumerate() {
                if index > 0 {
                    text.push_str(self.separator);
                }
                let mark = if self.is_quoted { "\"" } else { "" };
                text.push_str(mark);
                text.push_str(cell);
                text.push_str(mark);
            }
            if self.is_trailing {
                text.push_str(self.separator);
            }
            text.push_str(self.line_end);
        }
        text
    }
}

/// Changes a table in its values and its shape; most of what comes out is still a table.
pub(super) fn mutate_table(draws: &mut Draws, lines: &mut Vec<Vec<String>>, first: usize) {
    while draws.chance(0.4) && lines.len() > first {
        let line = first + draws.below(lines.len() - first);
        let width = lines[line].len();
        if width == 0 {
            return;
        }
        let cell = draws.below(width);
        match draws.below(10) {
            0..=3 => lines[line][cell] = (*draws.pick(&CELLS)).to_owned(),
            4 => {
                let other = first + draws.below(lines.len() - first);
                lines.swap(line, other);
            }
            5 => {
                let copy = lines[line].clone();
                lines.insert(line, copy);
            }
            6 if lines.len() > first + 1 => {
                lines.remove(line);
            }
            7 => {
                let block: Vec<_> = lines[line..].iter().take(20).cloned().collect();
                lines.extend(block);
            }
            8 => {
                let rows = lines.split_off(first);
                let order = draws.order(rows.len());
                lines.extend(order.into_iter().map(|row| rows[row].clone()));
            }
            _ => {
                let value = lines[line][cell].clone();
                for other in &mut lines[line..] {
                    if let Some(held) = other.get_mut(cell) {
                        held.clone_from(&value);
                    }
                }
            }
        }
    }
}

/// Changes bytes of a file.
pub(super) fn mutate_bytes(draws: &mut Draws, bytes: &mut Vec<u8>) {
    while draws.chance(0.5) && !bytes.is_empty() {
        let at = draws.below(bytes.len());
        match draws.below(6) {
            0 => bytes[at] ^= 1 << draws.below(8),
            1 => bytes.truncate(at),
            2 => {
                bytes.remove(at);
            }
            3 => {
                let block: Vec<u8> = bytes[at..].iter().take(64).copied().collect();
                bytes.splice(at..at, block);
            }
            _ => {
                let piece = draws.pick(&PIECES).bytes();
                bytes.splice(at..at, piece);
            }
        }
    }
}
