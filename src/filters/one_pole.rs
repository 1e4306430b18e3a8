//! One-pole low pass.

use std::f64::consts::PI;

use super::common::sections::{check_cutoff, checked};
use super::common::{Complaints, Filter, RecursiveFilter};
use super::kind::{ExpectedWords, FilterSettings};
use crate::declare::table;
use crate::signal::Section;
use crate::vocabulary::OutputRegister;

/// Least half-power frequency over the output rate. The gain at DC is the quotient of sums in which
/// the pole leaves `2 pi f T`: rounding moves it by 1e-8 there.
const CUTOFF_SHARE_MIN: f64 = 1e-9;

table! {
    /// One-pole low pass.
    pub struct OnePoleFilterConfig {
        /// Half-power frequency, below half the output rate. Source of the default: assumed.
        cutoff_hz: f64 = 100.0, in 1e-9..=1e6, "Hz";
        /// When the result appears: at the next sample tick, or as soon as it is computed.
        output_register: OutputRegister = "next-sample";
    }
}

impl FilterSettings for OnePoleFilterConfig {
    fn check_on(&self, words: &ExpectedWords, complaints: &mut Complaints) {
        check_cutoff(
            self.cutoff_hz,
            CUTOFF_SHARE_MIN,
            words.sample_rate_hz,
            complaints,
        );
    }

    fn build(&self, sample_period_s: f64) -> Option<Box<dyn Filter>> {
        let sections = one_pole(self.cutoff_hz * sample_period_s);
        Some(Box::new(RecursiveFilter::new(
            sections,
            self.output_register,
        )))
    }
}

/// One-pole low pass `y += k (x - y)` with half power at a frequency.
///
/// With `s = sin(pi f T)` the gain that puts `|H|^2 = 1/2` at f exactly is
/// `k = 2 s (sqrt(1 + s^2) - s)`.
///
/// * `cycles_per_sample`: `f T`, (0, 1/2).
///
/// # Panics
/// If the frequency is not below half the sample rate.
///
/// # Source
/// Derived from `|H|^2 = k^2 / (k^2 + 4 (1 - k) s^2)`.
#[must_use]
pub fn one_pole(cycles_per_sample: f64) -> Vec<Section> {
    let sine = (PI * checked(cycles_per_sample)).sin();
    one_pole_of_gain(2.0 * sine * ((1.0 + sine * sine).sqrt() - sine))
}

pub(super) fn one_pole_of_gain(gain: f64) -> Vec<Section> {
    vec![Section {
        numerator: [gain, 0.0, 0.0],
        denominator: [gain - 1.0, 0.0],
    }]
}
