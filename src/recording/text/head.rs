//! The first lines of a text, from which its layout is found.

use std::io::BufRead;

use super::lines::{Lines, TextError};
use crate::recording::layout::{HeadLine, last_line_above};
use crate::recording::log::format::LogFormat;

/// Lines from which the layout is found.
pub(in crate::recording) const HEAD_LINES: usize = 1000;
/// The same where the words are wanted as they come.
pub(in crate::recording) const LIVE_HEAD_LINES: usize = 50;
/// Most bytes of them.
const HEAD_BYTES: usize = 1 << 20;

/// The first lines, comments among them; those that are to be passed over left out.
///
/// # Errors
/// Bytes that are no text.
pub(super) fn head(
    lines: &mut Lines<impl BufRead>,
    format: &LogFormat,
    head_lines: usize,
) -> Result<Vec<HeadLine>, TextError> {
    let skipped = format.skip_lines.unwrap_or(0) as usize;
    let above = skipped.max(last_line_above(format));
    let (mut head, mut count, mut bytes) = (Vec::new(), 0, 0);
    while count < head_lines && bytes < HEAD_BYTES {
        let Some(line) = lines.next_unless(|_| false)? else {
            break;
        };
        if line.number > above {
            count += 1;
            bytes += line.text.len();
        }
        if line.number <= skipped {
            continue;
        }
        head.push(HeadLine {
            number: line.number,
            text: line.text.to_owned(),
            empty_before: line.empty_before,
        });
    }
    Ok(head)
}
