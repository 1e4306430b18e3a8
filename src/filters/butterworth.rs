//! Butterworth low pass.

use std::f64::consts::PI;

use super::common::sections::{check_cutoff, checked};
use super::common::{Complaints, Filter, RecursiveFilter};
use super::kind::{ExpectedWords, FilterSettings};
use crate::declare::table;
use crate::signal::Section;
use crate::vocabulary::OutputRegister;

/// Least half-power frequency over the output rate. The gain at DC is the quotient of sums in which
/// a pair of poles leaves the square of `2 pi f T`: rounding moves it by 1e-5 there.
const CUTOFF_SHARE_MIN: f64 = 1e-6;

table! {
    /// Butterworth low pass.
    pub struct ButterworthFilterConfig {
        /// Number of poles. Source of the default: assumed.
        order: u32 = 2, in 1..=12;
        /// Half-power frequency, below half the output rate. Source of the default: assumed.
        cutoff_hz: f64 = 100.0, in 1e-9..=1e6, "Hz";
        /// When the result appears: at the next sample tick, or as soon as it is computed.
        output_register: OutputRegister = "next-sample";
    }
}

impl FilterSettings for ButterworthFilterConfig {
    fn check_on(&self, words: &ExpectedWords, complaints: &mut Complaints) {
        check_cutoff(
            self.cutoff_hz,
            CUTOFF_SHARE_MIN,
            words.sample_rate_hz,
            complaints,
        );
    }

    fn build(&self, sample_period_s: f64) -> Option<Box<dyn Filter>> {
        let sections = butterworth(self.order as usize, self.cutoff_hz * sample_period_s);
        Some(Box::new(RecursiveFilter::new(
            sections,
            self.output_register,
        )))
    }
}

/// Butterworth low pass of any order with half power at a frequency, as second-order sections.
///
/// The bilinear transform of the analogue prototype, the frequency prewarped so that it is exact:
/// with `w = tan(pi f T)` and `q_i = 2 sin((2 i + 1) pi / 2 n)` each pole pair gives
/// `w^2 (1 + z^-1)^2 / (1 + q w + w^2 + 2 (w^2 - 1) z^-1 + (1 - q w + w^2) z^-2)`; an odd order has
/// `w (1 + z^-1) / (1 + w + (w - 1) z^-1)` besides.
///
/// # Panics
/// If the order is 0 or the frequency is not below half the sample rate.
///
/// # Source
/// Oppenheim and Schafer, Discrete-Time Signal Processing, chapter 7.
#[must_use]
pub fn butterworth(order: usize, cycles_per_sample: f64) -> Vec<Section> {
    assert!(order > 0, "a low pass has at least one pole");
    let w = (PI * checked(cycles_per_sample)).tan();
    let mut sections: Vec<Section> = (0..order / 2)
        .map(|pair| {
            let q = 2.0 * ((2 * pair + 1) as f64 * PI / (2 * order) as f64).sin();
            let scale = 1.0 / (1.0 + q * w + w * w);
            let gain = w * w * scale;
            Section {
                numerator: [gain, 2.0 * gain, gain],
                denominator: [2.0 * (w * w - 1.0) * scale, (1.0 - q * w + w * w) * scale],
            }
        })
        .collect();
    if order % 2 == 1 {
        let gain = w / (1.0 + w);
        sections.push(Section {
            numerator: [gain, gain, 0.0],
            denominator: [(w - 1.0) / (1.0 + w), 0.0],
        });
    }
    sections
}
