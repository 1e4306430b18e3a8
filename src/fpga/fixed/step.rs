//! What the least-mean-squares filters share: their signals, the step over the energy, and what each exact
//! value becomes.

use super::exact::{CONSTANT_BITS_MAX, Exact, constant, scaled};
use super::format::Stored;
use super::signal::{Overflows, SignalName};
use super::taps::signal_formats;
use crate::fpga::error::FpgaError;

signal_formats! {
    /// Formats of the signals.
    pub struct LmsFormats {
        /// Regressor words x and the ring of L.
        input: X;
        /// Desired word d.
        desired: D;
        /// Step of the taps `t = k e`, or k with the sign of e.
        intermediate: T;
        /// Denominator `eps + L'L`.
        denominator: Den;
        /// Gain k: the step, over the denominator if there is one.
        gain: K;
        /// Weights W.
        weight: W;
        /// Output y and error e.
        output: Y;
    }
}

impl LmsFormats {
    /// Refuses formats that the models do not hold.
    ///
    /// * `by_sign`: whether t is k with a sign.
    pub(super) fn check(&self, by_sign: bool) -> Result<(), FpgaError> {
        for signal in self.signals() {
            signal.format.check(signal.name.name())?;
        }
        let (x, t, y) = (self.input, self.intermediate, self.output);
        Exact::dot(x, self.weight, 0).check("exact y", y)?;
        let error = Exact::word(self.desired).plus(Exact::word(y));
        error.check("exact error", y)?;
        let step = if by_sign {
            Exact::word(self.gain)
        } else {
            Exact::product(y, self.gain)
        };
        step.check("exact t", t)?;
        let weight = Exact::word(self.weight).plus(Exact::product(x, t));
        weight.check("exact W", self.weight)
    }

    /// `Q_t(e*k)`.
    pub(super) fn step(&self, product: i128) -> Stored {
        let scale = self.output.fraction_bits + self.gain.fraction_bits;
        self.intermediate.store(product, scale)
    }

    /// `Q_t(sgn(e)*k)`: no product, the sign of an error of zero is zero.
    pub(super) fn signed_step(&self, error: i64, gain: i64) -> Stored {
        let gain = i128::from(gain);
        let signed = match error.signum() {
            1 => gain,
            -1 => -gain,
            _ => 0,
        };
        self.intermediate.store(signed, self.gain.fraction_bits)
    }

    /// `Q_W(W + L*t)`.
    pub(super) fn weight(&self, weight: i64, product: i128) -> Stored {
        let product_scale = self.input.fraction_bits + self.intermediate.fraction_bits;
        let scales = [self.weight.fraction_bits, product_scale];
        self.weight.store_sum([i128::from(weight), product], scales)
    }

    /// Corrects every weight by the step t of the taps; words beyond the ends are counted.
    ///
    /// * `line`: regressors, newest first.
    pub(super) fn correct(
        &self,
        weights: &mut [i64],
        line: &[i64],
        step: i64,
        overflows: &mut Overflows,
    ) {
        for (w_j, l_j) in weights.iter_mut().zip(line) {
            let product = i128::from(*l_j) * i128::from(step);
            *w_j = overflows.counted(SignalName::W, self.weight(*w_j, product));
        }
    }
}

/// A step over the energy of the taps, `mu / (eps + L'L)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct EnergyStep {
    /// Code of mu, in a word of 48 bits with as few integer bits as hold it.
    pub(super) code: i64,
    pub(super) fraction_bits: u32,
    /// Eps at the scale of the sum of squares.
    pub(super) regularisation: i128,
}

impl EnergyStep {
    /// Rounds the constants and checks them; in the full scale of x.
    ///
    /// * `name`: that of the step.
    pub(super) fn new(
        name: &'static str,
        step: f64,
        regularisation: f64,
        formats: &LmsFormats,
    ) -> Result<Self, FpgaError> {
        let denominator = formats.denominator;
        let (code, fraction_bits) = constant(name, step, CONSTANT_BITS_MAX, "a constant")?;
        at_least_a_step(name, step, code)?;
        if !(0.0..f64::INFINITY).contains(&regularisation) {
            return Err(out_of_range("regularisation", regularisation, ">= 0"));
        }
        denominator.holding("regularisation", regularisation, "den")?;
        let x = formats.input;
        // The regularisation takes at most the integer bits of the denominator.
        Exact::dot(x, x, denominator.integer_bits + 1).check("exact denominator", denominator)?;
        let step = Exact {
            bits: CONSTANT_BITS_MAX,
            scale: fraction_bits,
        };
        let quotient = Exact::quotient(step, Exact::word(denominator), formats.gain);
        quotient.check("exact quotient", formats.gain)?;
        Ok(Self {
            code,
            fraction_bits,
            regularisation: scaled(regularisation, 2 * x.fraction_bits),
        })
    }

    /// `Q_den` of eps and a sum of squares.
    pub(super) fn denominator(formats: &LmsFormats, sum: i128) -> Stored {
        let scale = 2 * formats.input.fraction_bits;
        formats.denominator.store(sum, scale)
    }

    /// `Q_k(mu / den)`.
    pub(super) fn gain(&self, formats: &LmsFormats, denominator: i64) -> Stored {
        let scales = [self.fraction_bits, formats.denominator.fraction_bits];
        formats.gain.store_ratio([self.code, denominator], scales)
    }
}

/// Refuses a constant that is not above zero once it is rounded.
pub(super) fn at_least_a_step(name: &'static str, value: f64, code: i64) -> Result<(), FpgaError> {
    if code > 0 {
        return Ok(());
    }
    Err(out_of_range(name, value, "at least one step of its words"))
}

/// A constant is out of its range.
fn out_of_range(name: &'static str, value: f64, range: &'static str) -> FpgaError {
    FpgaError::OutOfRange {
        name,
        value,
        range,
        format: "fixed point",
    }
}
