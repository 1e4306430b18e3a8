//! Stimulus of an export from the gyro of a scenario.

use super::plan::Plan;
use super::run::first_words;
use crate::filters::hardware::Stimulus;
use crate::fpga::board::CodeScale;
use crate::fpga::export::IntegerCodes;
use crate::gyro::{self, GyroError};
use crate::scenario::OutputQuantisation;
use crate::seal::digest_of_words;
use crate::units::{arcsec_per_s_to_deg_per_h, deg_per_h_to_deg_per_s, deg_per_s_to_deg_per_h};

/// Digest of samples, as a filter whose words were computed elsewhere states it.
#[must_use]
pub fn input_digest(words: &[f64]) -> String {
    digest_of_words(words)
}

/// The first rate words of a scenario's gyro, warm-up included, deg/h, and their integer codes.
///
/// # Errors
/// What the gyro refuses.
pub fn scenario_stimulus(plan: &Plan, samples: usize) -> Result<Stimulus, GyroError> {
    let scenario = &plan.resolved().scenario;
    let words = first_words(scenario, samples)?;
    let output = &scenario.gyro.output;
    let lsb = match output.quantisation {
        OutputQuantisation::RateWord => output.rate_lsb_deg_per_s,
        // One pulse in a word.
        OutputQuantisation::AngleCarry => deg_per_h_to_deg_per_s(arcsec_per_s_to_deg_per_h(
            output.angle_lsb_arcsec / gyro::word_period_s(&scenario.gyro),
        )),
    };
    // The mean of rounded words is a multiple of the step over their number.
    let lsb = lsb / f64::from(output.average_samples);
    let codes = (lsb > 0.0).then(|| IntegerCodes {
        codes: words.iter().map(|word| code(*word, lsb)).collect(),
        scale: CodeScale {
            lsb,
            unit: "deg/s".to_owned(),
            factor: deg_per_s_to_deg_per_h(1.0),
            word_unit: "deg/h".to_owned(),
        },
    });
    Ok(Stimulus { words, codes })
}

/// The integer that a rate word is a multiple of the least significant bit by.
#[expect(
    clippy::cast_possible_truncation,
    reason = "the cast saturates; the reader keeps rates within 2000 deg/s"
)]
fn code(word_deg_per_h: f64, lsb_deg_per_s: f64) -> i32 {
    (deg_per_h_to_deg_per_s(word_deg_per_h) / lsb_deg_per_s).round() as i32
}
