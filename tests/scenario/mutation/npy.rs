//! NPY files: every type, byte order and version, their headings and words mutated.

use std::path::Path;

use fogbench::recording::{read_log, read_stimulus};

use super::logs::{format, measure};
use super::values::{mutate_bytes, record};
use super::{Outcome, assert_complaint, campaign};
use crate::support::seeded::Draws;

/// The words of a type, little-endian.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "any bits will do"
)]
fn word(kind: &str, value: f64) -> Vec<u8> {
    match kind {
        "f4" => (value as f32).to_le_bytes().to_vec(),
        "f8" => value.to_le_bytes().to_vec(),
        "i1" => (value as i8).to_le_bytes().to_vec(),
        "i2" => (value as i16).to_le_bytes().to_vec(),
        "i4" => (value as i32).to_le_bytes().to_vec(),
        "i8" => (value as i64).to_le_bytes().to_vec(),
        "u1" => (value as u8).to_le_bytes().to_vec(),
        "u2" => (value as u16).to_le_bytes().to_vec(),
        "u4" => (value as u32).to_le_bytes().to_vec(),
        _ => (value as u64).to_le_bytes().to_vec(),
    }
}

fn bytes(draws: &mut Draws) -> Vec<u8> {
    let kinds = [
        "f8", "f8", "f8", "f4", "i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8",
    ];
    let kind = *draws.pick(&kinds);
    let count = if draws.chance(0.05) {
        draws.below(3)
    } else {
        8 + draws.below(150)
    };
    let values = record(draws, count);
    let is_big = draws.chance(0.3);
    let is_byte = kind.ends_with('1');
    let order = if is_byte {
        "|"
    } else if is_big {
        ">"
    } else {
        "<"
    };
    let mut data = Vec::new();
    for value in values {
        let mut word = word(kind, value);
        if is_big {
            word.reverse();
        }
        data.extend(word);
    }
    while draws.chance(0.15) && !data.is_empty() {
        let at = draws.below(data.len());
        data[at] = (draws.bits() & 0xff) as u8;
    }
    let mut claimed = count;
    if draws.chance(0.05) {
        claimed = draws.below(2 * count + 2);
    }
    let shape = match draws.below(30) {
        0 => "()".to_owned(),
        1 => format!("(1, {claimed})"),
        2 => format!("{claimed}"),
        3 => "(18446744073709551615,)".to_owned(),
        4 => format!("({claimed}L,)"),
        _ => format!("({claimed},)"),
    };
    let mut heading =
        format!("{{'descr': '{order}{kind}', 'fortran_order': False, 'shape': {shape}, }}\n");
    if draws.chance(0.05) {
        let mut mutated = heading.into_bytes();
        mutate_bytes(draws, &mut mutated);
        heading = String::from_utf8_lossy(&mutated).into_owned();
    }
    let mut file = b"\x93NUMPY".to_vec();
    let version = if draws.chance(0.8) {
        1
    } else {
        u8::try_from(draws.between(1, 4)).expect("a digit")
    };
    file.extend([version, 0]);
    let length = u32::try_from(heading.len()).expect("short").to_le_bytes();
    file.extend(&length[..if version == 1 { 2 } else { 4 }]);
    file.extend(heading.bytes());
    file.extend(data);
    if draws.chance(0.05) {
        mutate_bytes(draws, &mut file);
    }
    file
}

fn case(draws: &mut Draws, folder: &Path) -> Outcome {
    let path = folder.join("log.npy");
    std::fs::write(&path, bytes(draws)).expect("writable");
    let format = format(draws);
    let words = read_stimulus(&path, None, usize::MAX);
    match read_log(&path, &format) {
        Ok(log) => {
            assert_eq!(
                words.expect("a log is a stimulus").len(),
                log.rate_deg_per_h.len()
            );
            measure(draws, log, folder)
        }
        Err(error) => {
            assert_complaint(&error.to_string(), "log.npy");
            Outcome::Refused
        }
    }
}

#[test]
fn a_mutated_npy_file_is_measured_or_refused() {
    campaign("npy", 200, case);
}
