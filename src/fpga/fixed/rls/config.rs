//! What never changes while the fixed-point pipeline runs, and what each exact value becomes.

use crate::fpga::check::check_tap_count;
use crate::fpga::error::FpgaError;
use crate::fpga::fixed::exact::{Exact, constant, scaled};
use crate::fpga::fixed::format::{Format, Stored};
use crate::fpga::fixed::taps::signal_formats;
use crate::fpga::timing::Units;

signal_formats! {
    /// Formats of the signals.
    pub struct RlsFormats {
        /// Regressor words x and the ring of L.
        input: X;
        /// Desired word d.
        desired: D;
        /// Intermediate `t = R L`.
        intermediate: T;
        /// Denominator `alpha + L't`.
        denominator: Den;
        /// Gain `k = t / den`.
        gain: K;
        /// Inverse correlation R.
        inverse: R;
        /// Weights W.
        weight: W;
        /// Output y and error e.
        output: Y;
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
    /// Initial diagonal of R, in the inverse square of the input's full scale, and its code.
    pub(super) initial_inverse_correlation: f64,
    pub(super) delta: i64,
    pub(super) forgetting_factor: f64,
    /// Smallest code of a diagonal element of R; 0: none.
    pub(super) floor: i64,
    pub(super) units: Units,
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
        for signal in formats.signals() {
            signal.format.check(signal.name.name())?;
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
        let name = "initial inverse correlation";
        let code = formats.inverse.holding(name, delta, "R")?;
        if code <= 0 {
            return Err(FpgaError::OutOfRange {
                name,
                value: delta,
                range: "at least one step of R",
                format: "fixed point",
            });
        }
        if !(0..=code).contains(&settings.inverse_floor) {
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
            initial_inverse_correlation: delta,
            delta: code,
            forgetting_factor: alpha,
            floor: settings.inverse_floor,
            units: Units::ONE_CLOCK,
        })
    }

    /// The same with units of other latencies: same words, more clocks.
    ///
    /// # Errors
    /// [`FpgaError::CountOutOfRange`] naming the unit.
    pub fn with_units(self, units: Units) -> Result<Self, FpgaError> {
        units.check()?;
        Ok(Self { units, ..self })
    }

    /// Latencies of the units; their intervals do not count, as the control waits for each result.
    #[must_use]
    pub fn units(&self) -> Units {
        self.units
    }

    /// Whether the correction of R takes three steps: difference, product with 1/alpha, its rounding.
    pub(super) fn splits(&self) -> bool {
        self.inverse_alpha.is_some() && !self.units.chain()
    }

    /// Number of weights p.
    #[must_use]
    pub fn tap_count(&self) -> usize {
        self.tap_count
    }

    /// Bits of the widest signal.
    pub(super) fn widest(&self) -> u32 {
        let signals = self.formats.signals();
        let widths = signals.iter().map(|signal| signal.format.width());
        widths.max().unwrap_or(0)
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
        let scales = [f.intermediate.fraction_bits, f.denominator.fraction_bits];
        f.gain.store_ratio([t, denominator], scales)
    }

    /// `Q_R(Q_R(R - k*t) * ialpha)`; the two of them, the second equal to the first at alpha = 1.
    pub(super) fn inverse(&self, element: i64, product: i128) -> [Stored; 2] {
        let corrected = self.inverse_difference(element, product);
        let Some(factor) = self.inverse_alpha else {
            return [corrected; 2];
        };
        let grown = i128::from(corrected.code) * i128::from(factor);
        [corrected, self.inverse_grown(grown)]
    }

    /// `Q_R(R - k*t)`.
    pub(super) fn inverse_difference(&self, element: i64, product: i128) -> Stored {
        let f = &self.formats;
        let product_scale = f.gain.fraction_bits + f.intermediate.fraction_bits;
        let scales = [f.inverse.fraction_bits, product_scale];
        f.inverse.store_sum([i128::from(element), -product], scales)
    }

    /// `Q_R` of a product of a word of R and 1/alpha.
    pub(super) fn inverse_grown(&self, product: i128) -> Stored {
        let f = &self.formats;
        let scale = f.inverse.fraction_bits + self.inverse_alpha_fraction_bits;
        f.inverse.store(product, scale)
    }

    /// `Q_W(W + k*e)`.
    pub(super) fn weight(&self, weight: i64, product: i128) -> Stored {
        let f = &self.formats;
        let product_scale = f.gain.fraction_bits + f.output.fraction_bits;
        let scales = [f.weight.fraction_bits, product_scale];
        f.weight.store_sum([i128::from(weight), product], scales)
    }
}

/// Code and fraction bits of `1/alpha` in a word as wide as one of R.
fn inverse_alpha(alpha: f64, inverse: Format) -> Result<(Option<i64>, u32), FpgaError> {
    let value = 1.0 / alpha;
    if value <= 1.0 {
        return Ok((None, 0));
    }
    let name = "1 / forgetting factor";
    let (code, fraction_bits) = constant(name, value, inverse.width(), "a word of R")?;
    Ok((Some(code), fraction_bits))
}

/// Refuses formats whose exact sums and quotients need more bits than the models hold.
fn check_exact_bits(f: &RlsFormats) -> Result<(), FpgaError> {
    let (x, t, den, k) = (f.input, f.intermediate, f.denominator, f.gain);
    Exact::dot(x, f.inverse, 0).check("exact t", t)?;
    // Alpha is at most 1.
    Exact::dot(x, t, 2).check("exact denominator", den)?;
    Exact::dot(x, f.weight, 0).check("exact y", f.output)?;
    let corrected = Exact::word(f.inverse).plus(Exact::product(k, t));
    corrected.check("exact R", f.inverse)?;
    let weight = Exact::word(f.weight).plus(Exact::product(k, f.output));
    weight.check("exact W", f.weight)?;
    let error = Exact::word(f.desired).plus(Exact::word(f.output));
    error.check("exact error", f.output)?;
    Exact::quotient(Exact::word(t), Exact::word(den), k).check("exact quotient", k)
}
