//! Savitzky-Golay filter at the newest sample.

use super::common::{Complaints, Filter, FixedFilter};
use super::kind::FilterSettings;
use crate::declare::table;
use crate::vocabulary::OutputRegister;
use nalgebra::{DMatrix, DVector};

table! {
    /// Value at the newest sample of a polynomial fitted to the newest samples.
    pub struct SavitzkyGolayFilterConfig {
        /// Number of samples the polynomial is fitted to. Source of the default: assumed.
        taps: u32 = 16, in 2..=4096;
        /// Degree of the polynomial, below the number of samples. Source of the default: a straight line.
        polynomial_order: u32 = 1, in 0..=8;
        /// When the result appears: at the next sample tick, or as soon as it is computed.
        output_register: OutputRegister = "next-sample";
    }
}

impl FilterSettings for SavitzkyGolayFilterConfig {
    fn check(&self, complaints: &mut Complaints) {
        if self.polynomial_order >= self.taps {
            let message = format!(
                "= {} is too high for {} samples: allowed up to taps - 1 = {}",
                self.polynomial_order,
                self.taps,
                self.taps - 1
            );
            complaints.key("polynomial_order", &message);
        }
    }

    fn build(&self, _sample_period_s: f64) -> Option<Box<dyn Filter>> {
        let weights = savitzky_golay(self.taps as usize, self.polynomial_order as usize);
        Some(Box::new(FixedFilter::new(weights, self.output_register)))
    }
}

/// Weights of a Savitzky-Golay filter that gives the smoothed value at the newest sample.
///
/// The value at age 0 of the polynomial of degree `order` fitted by least squares to the newest
/// `taps` samples. Every polynomial signal of that degree passes without error and so without
/// delay; the price is noise, for a straight line `(4 p - 2) / (p (p + 1))` of the power.
///
/// Computed with orthogonal columns (QR) of powers of the age scaled to [-1, 1].
///
/// # Panics
/// If there are not more taps than the order; the scenario reader refuses that.
///
/// # Source
/// Savitzky and Golay, Anal. Chem. 36 (1964) 1627, at the end point of the window.
#[must_use]
pub fn savitzky_golay(taps: usize, order: usize) -> Vec<f64> {
    assert!(taps > order, "{taps} samples cannot fix degree {order}");
    let half = 0.5 * (taps as f64 - 1.0).max(1.0);
    let powers = DMatrix::from_fn(taps, order + 1, |age, power| {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_possible_wrap,
            reason = "the order of a smoothing polynomial is small"
        )]
        let power = power as i32;
        (age as f64 / half - 1.0).powi(power)
    });
    let decomposition = powers.qr();
    let newest = DVector::from_fn(
        order + 1,
        |power, _| {
            if power % 2 == 0 { 1.0 } else { -1.0 }
        },
    );
    // The value at the newest sample is c'R^-1 Q'x, and so the weights are Q R^-T c.
    let solved = decomposition
        .r()
        .transpose()
        .solve_lower_triangular(&newest)
        .expect("distinct ages give independent powers");
    (decomposition.q() * solved).as_slice().to_vec()
}
