//! What never changes while the fixed-point pipeline runs, and what each exact value becomes.

use super::format::{EXACT_BITS, Format, Stored};
use crate::fpga::check::check_tap_count;
use crate::fpga::error::FpgaError;
use crate::vocabulary::{Overflow, Rounding};

/// Formats of the signals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RlsFormats {
    /// Regressor words x and the ring of L.
    pub input: Format,
    /// Desired word d.
    pub desired: Format,
    /// Intermediate `t = R L`.
    pub intermediate: Format,
    /// Denominator `alpha + L't`.
    pub denominator: Format,
    /// Gain `k = t / den`.
    pub gain: Format,
    /// Inverse correlation R.
    pub inverse: Format,
    /// Weights W.
    pub weight: Format,
    /// Output y and error e.
    pub output: Format,
}

impl RlsFormats {
    /// All of them by name.
    #[must_use]
    pub fn named(&self) -> [(&'static str, Format); 8] {
        [
            ("x", self.input),
            ("d", self.desired),
            ("t", self.intermediate),
            ("den", self.denominator),
            ("k", self.gain),
            ("R", self.inverse),
            ("W", self.weight),
            ("y", self.output),
        ]
    }
}

/// Settings of a fixed-point RLS pipeline in plain numbers, before any check.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedRlsSettings {
    /// Number of weights p, 1 to 64.
    pub tap_count: usize,
    /// Forgetting factor alpha, 0.001 to 1.
    pub forgetting_factor: f64,
    /// Initial inverse correlation delta, > 0, in the inverse square of the input's full scale.
    pub initial_inverse_correlation: f64,
    /// Smallest code of a diagonal element of R; 0: none.
    pub inverse_floor: i64,
    /// Formats of the signals.
    pub formats: RlsFormats,
}

/// Checked constants of a fixed-point RLS pipeline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedRlsConfig {
    pub(super) tap_count: usize,
    pub(super) formats: RlsFormats,
    /// Alpha at the scale of the denominator's sum.
    pub(super) alpha: i128,
    /// Code of `1/alpha`; none at alpha = 1.
    pub(super) inverse_alpha: Option<i64>,
    pub(super) inverse_alpha_fraction_bits: u32,
    pub(super) delta: i64,
    /// Smallest code of a diagonal element of R; 0: none.
    pub(super) floor: i64,
}

impl FixedRlsConfig {
    /// Rounds the constants to their formats and checks them.
    ///
    /// # Errors
    /// [`FpgaError::TapCount`]; [`FpgaError::OutOfRange`] for alpha; [`FpgaError::DoesNotFit`] if
    /// delta or `1/alpha` does not fit R; [`FpgaError::CountOutOfRange`] for a format, or if an
    /// exact value would need more than 126 bits.
    pub fn new(settings: FixedRlsSettings) -> Result<Self, FpgaError> {
        check_tap_count(settings.tap_count)?;
        let formats = settings.formats;
        for (name, format) in formats.named() {
            format.check(name)?;
        }
        let alpha = settings.forgetting_factor;
        if !(1e-3..=1.0).contains(&alpha) {
            return Err(FpgaError::OutOfRange {
                name: "forgetting factor",
                value: alpha,
                range: ">= 0.001 and <= 1",
                format: "fixed point",
            });
        }
        check_exact_bits(&formats)?;
        let delta = settings.initial_inverse_correlation;
        let stored = formats.inverse.of(delta);
        if stored.overflowed {
            let name = "initial inverse correlation";
            return Err(does_not_fit(name, delta, "R", formats.inverse));
        }
        if stored.code <= 0 {
            return Err(FpgaError::OutOfRange {
                name: "initial inverse correlation",
                value: delta,
                range: "at least one step of R",
                format: "fixed point",
            });
        }
        if !(0..=stored.code).contains(&settings.inverse_floor) {
            return Err(FpgaError::CountOutOfRange {
                name: "floor of R",
                value: settings.inverse_floor.unsigned_abs(),
                range: "0 to the code of the initial inverse correlation",
            });
        }
        let (inverse_alpha, inverse_alpha_fraction_bits) = inverse_alpha(alpha, formats.inverse)?;
        let scale = formats.input.fraction_bits + formats.intermediate.fraction_bits;
        Ok(Self {
            tap_count: settings.tap_count,
            formats,
            alpha: scaled(alpha, scale),
            inverse_alpha,
            inverse_alpha_fraction_bits,
            delta: stored.code,
            floor: settings.inverse_floor,
        })
    }

    /// Number of weights p.
    #[must_use]
    pub fn tap_count(&self) -> usize {
        self.tap_count
    }

    /// Formats of the signals.
    #[must_use]
    pub fn formats(&self) -> &RlsFormats {
        &self.formats
    }

    /// Alpha at the scale of the denominator's sum, fraction bits of x and t together.
    #[must_use]
    pub fn alpha(&self) -> i128 {
        self.alpha
    }

    /// Fraction bits of [`Self::alpha`].
    #[must_use]
    pub fn alpha_fraction_bits(&self) -> u32 {
        self.formats.input.fraction_bits + self.formats.intermediate.fraction_bits
    }

    /// Code of `1/alpha` and its fraction bits; none at alpha = 1.
    #[must_use]
    pub fn inverse_alpha(&self) -> Option<(i64, u32)> {
        let code = self.inverse_alpha?;
        Some((code, self.inverse_alpha_fraction_bits))
    }

    /// Smallest code of a diagonal element of R; 0: none.
    #[must_use]
    pub fn floor(&self) -> i64 {
        self.floor
    }

    /// The element of a diagonal that the floor holds up.
    pub(super) fn floored(&self, element: i64) -> i64 {
        if self.floor > 0 {
            element.max(self.floor)
        } else {
            element
        }
    }

    /// Code of the initial diagonal of R.
    #[must_use]
    pub fn delta(&self) -> i64 {
        self.delta
    }

    /// `Q_t` of a sum of products of L and R.
    pub(super) fn intermediate(&self, sum: i128) -> Stored {
        let f = &self.formats;
        let scale = f.input.fraction_bits + f.inverse.fraction_bits;
        f.intermediate.store(sum, scale)
    }

    /// `Q_den` of alpha and a sum of products of L and t.
    pub(super) fn denominator(&self, sum: i128) -> Stored {
        let f = &self.formats;
        let scale = f.input.fraction_bits + f.intermediate.fraction_bits;
        f.denominator.store(sum, scale)
    }

    /// `Q_k(t / den)`.
    pub(super) fn gain(&self, t: i64, denominator: i64) -> Stored {
        let f = &self.formats;
        let (t, denominator) = (i128::from(t), i128::from(denominator));
        let up = f.gain.fraction_bits + f.denominator.fraction_bits;
        let down = f.intermediate.fraction_bits;
        if up >= down {
            f.gain.store_quotient(t << (up - down), denominator)
        } else {
            f.gain.store_quotient(t, denominator << (down - up))
        }
    }

    /// `Q_R(Q_R(R - k*t) * ialpha)`; the two of them, the second equal to the first at alpha = 1.
    pub(super) fn inverse(&self, element: i64, product: i128) -> [Stored; 2] {
        let f = &self.formats;
        let product_scale = f.gain.fraction_bits + f.intermediate.fraction_bits;
        let difference = sum_at(
            [i128::from(element), -product],
            [f.inverse.fraction_bits, product_scale],
        );
        let corrected = f.inverse.store(difference.0, difference.1);
        let Some(factor) = self.inverse_alpha else {
            return [corrected; 2];
        };
        let grown = i128::from(corrected.code) * i128::from(factor);
        let scale = f.inverse.fraction_bits + self.inverse_alpha_fraction_bits;
        [corrected, f.inverse.store(grown, scale)]
    }

    /// `Q_y` of a sum of products of L and W.
    pub(super) fn output(&self, sum: i128) -> Stored {
        let f = &self.formats;
        let scale = f.input.fraction_bits + f.weight.fraction_bits;
        f.output.store(sum, scale)
    }

    /// `Q_y(d - y)`.
    pub(super) fn error(&self, desired: i64, output: i64) -> Stored {
        let f = &self.formats;
        let scales = [f.desired.fraction_bits, f.output.fraction_bits];
        let difference = sum_at([i128::from(desired), -i128::from(output)], scales);
        f.output.store(difference.0, difference.1)
    }

    /// `Q_W(W + k*e)`.
    pub(super) fn weight(&self, weight: i64, product: i128) -> Stored {
        let f = &self.formats;
        let product_scale = f.gain.fraction_bits + f.output.fraction_bits;
        let scales = [f.weight.fraction_bits, product_scale];
        let sum = sum_at([i128::from(weight), product], scales);
        f.weight.store(sum.0, sum.1)
    }
}

/// Sum of two exact values at the finer of their scales, and that scale.
fn sum_at(values: [i128; 2], scales: [u32; 2]) -> (i128, u32) {
    let scale = scales[0].max(scales[1]);
    let first = values[0] << (scale - scales[0]);
    let second = values[1] << (scale - scales[1]);
    (first + second, scale)
}

/// `value * 2^fraction_bits` for a value in (0, 1], nearest, ties to even.
fn scaled(value: f64, fraction_bits: u32) -> i128 {
    let bits = value.to_bits();
    let fraction = i128::from(bits & ((1 << 52) - 1) | 1 << 52);
    let exponent = u32::try_from(bits >> 52 & 0x7ff).unwrap_or(0);
    // value = fraction * 2^(exponent - 1075), the exponent at most 1023.
    let down = 1075 - exponent;
    if down <= fraction_bits {
        return fraction << (fraction_bits - down);
    }
    let shift = down - fraction_bits;
    if shift > 100 {
        return 0;
    }
    let below = fraction >> shift;
    let rest = fraction - (below << shift);
    let half = 1 << (shift - 1);
    below + i128::from(rest > half || (rest == half && below & 1 != 0))
}

/// Code and fraction bits of `1/alpha` in a word as wide as one of R.
fn inverse_alpha(alpha: f64, inverse: Format) -> Result<(Option<i64>, u32), FpgaError> {
    let value = 1.0 / alpha;
    if value <= 1.0 {
        return Ok((None, 0));
    }
    let mut format = Format {
        integer_bits: 2,
        fraction_bits: inverse.width().saturating_sub(2),
        rounding: Rounding::NearestEven,
        overflow: Overflow::Saturate,
    };
    while format.of(value).overflowed {
        if format.fraction_bits == 0 {
            return Err(does_not_fit(
                "1 / forgetting factor",
                value,
                "a word of R",
                format,
            ));
        }
        format.integer_bits += 1;
        format.fraction_bits -= 1;
    }
    Ok((Some(format.of(value).code), format.fraction_bits))
}

fn does_not_fit(name: &'static str, value: f64, signal: &'static str, format: Format) -> FpgaError {
    FpgaError::DoesNotFit {
        name,
        value,
        signal,
        integer_bits: format.integer_bits,
        fraction_bits: format.fraction_bits,
        limit: 2.0 * format.value(1 << (format.width() - 2)),
    }
}

/// Refuses formats whose exact sums and quotients need more bits than the models hold.
fn check_exact_bits(f: &RlsFormats) -> Result<(), FpgaError> {
    // Products of up to 64 taps and a constant.
    const GROWTH: u32 = 7;
    let check = |name, bits: u32, scale: u32, to: Format| {
        let needed = bits + to.fraction_bits.saturating_sub(scale);
        if needed < EXACT_BITS {
            return Ok(());
        }
        Err(FpgaError::CountOutOfRange {
            name,
            value: u64::from(needed),
            range: "at most 126 bits before it is rounded",
        })
    };
    let dot = |a: Format, b: Format| a.width() + b.width() + GROWTH;
    let scale = |a: Format, b: Format| a.fraction_bits + b.fraction_bits;
    let pair = |a: (u32, u32), b: (u32, u32)| {
        let finer = a.1.max(b.1);
        ((a.0 + finer - a.1).max(b.0 + finer - b.1) + 1, finer)
    };
    let word = |a: Format| (a.width(), a.fraction_bits);
    let product = |a: Format, b: Format| (a.width() + b.width(), scale(a, b));
    let (x, t, den, k) = (f.input, f.intermediate, f.denominator, f.gain);
    check("exact t", dot(x, f.inverse), scale(x, f.inverse), t)?;
    check(
        "exact denominator",
        dot(x, t).max(scale(x, t) + 2),
        scale(x, t),
        den,
    )?;
    check("exact y", dot(x, f.weight), scale(x, f.weight), f.output)?;
    let (bits, finer) = pair(word(f.inverse), product(k, t));
    check("exact R", bits, finer, f.inverse)?;
    let (bits, finer) = pair(word(f.weight), product(k, f.output));
    check("exact W", bits, finer, f.weight)?;
    let (bits, finer) = pair(word(f.desired), word(f.output));
    check("exact error", bits, finer, f.output)?;
    let up = scale(k, den);
    let numerator = t.width() + up.saturating_sub(t.fraction_bits);
    let divisor = den.width() + t.fraction_bits.saturating_sub(up);
    check(
        "exact quotient",
        numerator.max(divisor) + 1,
        0,
        Format {
            fraction_bits: 0,
            ..k
        },
    )
}
