//! The RLS recursion without clocks: same words, no control machine.
//!
//! ```text
//! t[i]    = ((+0 + L0*R[i][0]) + L1*R[i][1]) + ...      each product and each sum rounded
//! den     = ((alpha + L0*t0) + L1*t1) + ...             alpha first
//! rcp     = 1 / den
//! R[i][j] = (R[i][j] - (t[i]*t[j])*rcp) * ialpha        Element: (t[i]*t[j]) / den
//! M[i]    = ((+0 + L0*R[i][0]) + ...                    with the updated R
//! y       = ((+0 + L0*W0) + L1*W1) + ...                with the weights before the update
//! e       = d - y
//! W[i]    = W[i] + M[i]*e
//! ```

use super::config::RlsConfig;
use crate::fpga::engine::{Engine, InverseCorrelation};
use crate::fpga::float_unit::Fp;
use crate::fpga::front_end::Pair;
use crate::fpga::line::ring;
use crate::vocabulary::{Division, UpdateOrder, UpdateSign};

/// Clock-less RLS engine.
#[derive(Clone, Debug)]
pub struct RlsEngine<F> {
    config: RlsConfig<F>,
    order: UpdateOrder,
    head: usize,
    core: Core<F>,
}

#[derive(Clone, Debug)]
enum Core<F> {
    Four(FixedCore<F, 4>),
    Any(AnyCore<F>),
}

impl<F: Fp> RlsEngine<F> {
    /// An engine in the pipeline's reset state and order.
    #[must_use]
    pub fn new(config: RlsConfig<F>) -> Self {
        Self::with_order(config, UpdateOrder::Schedule)
    }

    /// An engine with another order of the update; only [`UpdateOrder::Schedule`] has the
    /// pipeline's bits.
    #[must_use]
    pub fn with_order(config: RlsConfig<F>, order: UpdateOrder) -> Self {
        let core = if config.tap_count == 4 && order == UpdateOrder::Schedule {
            Core::Four(FixedCore::new(&config))
        } else {
            Core::Any(AnyCore::new(&config))
        };
        Self {
            config,
            order,
            head: config.tap_count - 1,
            core,
        }
    }

    /// Back to the state after reset.
    pub fn reset(&mut self) {
        *self = Self::with_order(self.config, self.order);
    }

    /// The constants.
    #[must_use]
    pub fn config(&self) -> &RlsConfig<F> {
        &self.config
    }

    fn matrix(&self) -> &[F] {
        match &self.core {
            Core::Four(core) => core.inverse.as_flattened(),
            Core::Any(core) => &core.inverse,
        }
    }

    /// The words RAMA holds after the last sample: ring of L, then M.
    #[must_use]
    pub fn rama(&self) -> Vec<F> {
        let (line, gain): (&[F], &[F]) = match &self.core {
            Core::Four(core) => (&core.line, &core.gain),
            Core::Any(core) => (&core.line, &core.gain),
        };
        [&ring(line, self.head), gain].concat()
    }

    /// The words RAMB holds after the last sample: W, t, R.
    #[must_use]
    pub fn ramb(&self) -> Vec<F> {
        let intermediate: &[F] = match &self.core {
            Core::Four(core) => &core.intermediate,
            Core::Any(core) => &core.intermediate,
        };
        [self.weights(), intermediate, self.matrix()].concat()
    }

    fn advance_head(&mut self, samples: usize) {
        self.head = (self.head + samples) % self.config.tap_count;
    }
}

impl<F: Fp> Engine<F> for RlsEngine<F> {
    #[inline]
    fn process(&mut self, pair: Pair<F>) -> F {
        self.advance_head(1);
        match &mut self.core {
            Core::Four(core) => core.process(&self.config, pair),
            Core::Any(core) => core.process(&self.config, self.order, pair),
        }
    }

    fn run(&mut self, pairs: &[Pair<F>], outputs: &mut Vec<F>) {
        self.advance_head(pairs.len());
        match &mut self.core {
            Core::Four(core) => {
                // A local copy lets the state live in registers through the loop.
                let mut local = *core;
                let config = self.config;
                outputs.extend(pairs.iter().map(|pair| local.process(&config, *pair)));
                *core = local;
            }
            Core::Any(core) => {
                for pair in pairs {
                    outputs.push(core.process(&self.config, self.order, *pair));
                }
            }
        }
    }

    fn weights(&self) -> &[F] {
        match &self.core {
            Core::Four(core) => &core.weights,
            Core::Any(core) => &core.weights,
        }
    }

    fn inverse_correlation(&self) -> Option<InverseCorrelation<'_, F>> {
        Some(InverseCorrelation {
            matrix: self.matrix(),
            tap_count: self.config.tap_count,
            delta: self.config.delta,
            alpha: self.config.alpha,
        })
    }
}

/// State for any tap count.
#[derive(Clone, Debug)]
struct AnyCore<F> {
    /// Regressors, newest first.
    line: Vec<F>,
    intermediate: Vec<F>,
    gain: Vec<F>,
    weights: Vec<F>,
    inverse: Vec<F>,
}

impl<F: Fp> AnyCore<F> {
    fn new(config: &RlsConfig<F>) -> Self {
        let p = config.tap_count;
        let mut inverse = vec![F::ZERO; p * p];
        for i in 0..p {
            inverse[i * p + i] = config.delta;
        }
        Self {
            line: vec![F::ZERO; p],
            intermediate: vec![F::ZERO; p],
            gain: vec![F::ZERO; p],
            weights: vec![F::ZERO; p],
            inverse,
        }
    }

    fn process(&mut self, config: &RlsConfig<F>, order: UpdateOrder, pair: Pair<F>) -> F {
        let p = config.tap_count;
        self.line.rotate_right(1);
        self.line[0] = pair.input;
        for i in 0..p {
            let row = &self.inverse[i * p..(i + 1) * p];
            self.intermediate[i] = dot(F::ZERO, &self.line, row);
        }
        let denominator = dot(config.alpha, &self.line, &self.intermediate);
        let reciprocal = F::ONE.div(denominator);
        for i in 0..p {
            let t_i = self.intermediate[i];
            for j in 0..p {
                let t_j = self.intermediate[j];
                let correction = match (order, config.division) {
                    (UpdateOrder::Schedule, Division::Reciprocal) => t_i.mul(t_j).mul(reciprocal),
                    (UpdateOrder::Schedule, Division::Elementwise) => t_i.mul(t_j).div(denominator),
                    (UpdateOrder::GainFirst, Division::Reciprocal) => t_i.mul(reciprocal).mul(t_j),
                    (UpdateOrder::GainFirst, Division::Elementwise) => {
                        t_i.div(denominator).mul(t_j)
                    }
                };
                let element = &mut self.inverse[i * p + j];
                *element = element.sub(correction).mul(config.inverse_alpha);
            }
        }
        for i in 0..p {
            let row = &self.inverse[i * p..(i + 1) * p];
            self.gain[i] = dot(F::ZERO, &self.line, row);
        }
        let output = dot(F::ZERO, &self.line, &self.weights);
        let error = pair.desired.sub(output);
        for i in 0..p {
            self.weights[i] = update(config, self.weights[i], self.gain[i].mul(error));
        }
        output
    }
}

/// `((first + a0*b0) + a1*b1) + ...`
#[inline]
fn dot<F: Fp>(first: F, a: &[F], b: &[F]) -> F {
    let mut sum = first;
    for (a_j, b_j) in a.iter().zip(b) {
        sum = sum.add(a_j.mul(*b_j));
    }
    sum
}

#[inline]
fn update<F: Fp>(config: &RlsConfig<F>, weight: F, correction: F) -> F {
    match config.update_sign {
        UpdateSign::Corrected => weight.add(correction),
        UpdateSign::AsPrinted => weight.sub(correction),
    }
}

/// State for a tap count known to the compiler, for the schedule's order only.
#[derive(Clone, Copy, Debug)]
struct FixedCore<F, const P: usize> {
    line: [F; P],
    intermediate: [F; P],
    gain: [F; P],
    weights: [F; P],
    inverse: [[F; P]; P],
}

impl<F: Fp, const P: usize> FixedCore<F, P> {
    fn new(config: &RlsConfig<F>) -> Self {
        let mut inverse = [[F::ZERO; P]; P];
        for (i, row) in inverse.iter_mut().enumerate() {
            row[i] = config.delta;
        }
        Self {
            line: [F::ZERO; P],
            intermediate: [F::ZERO; P],
            gain: [F::ZERO; P],
            weights: [F::ZERO; P],
            inverse,
        }
    }

    /// `R L`, each row summed in tap order. R is symmetric to the bit in the schedule's order,
    /// so `R[j][i]` stands for `R[i][j]` and the P sums advance side by side along a row.
    #[inline]
    fn product_with_line(&self) -> [F; P] {
        let mut sums = [F::ZERO; P];
        for (l_j, row) in self.line.iter().zip(&self.inverse) {
            for (sum, r_ji) in sums.iter_mut().zip(row) {
                *sum = sum.add(l_j.mul(*r_ji));
            }
        }
        sums
    }

    #[inline]
    fn process(&mut self, config: &RlsConfig<F>, pair: Pair<F>) -> F {
        for j in (1..P).rev() {
            self.line[j] = self.line[j - 1];
        }
        self.line[0] = pair.input;
        let t = self.product_with_line();
        let mut denominator = config.alpha;
        for (l_j, t_j) in self.line.iter().zip(&t) {
            denominator = denominator.add(l_j.mul(*t_j));
        }
        match config.division {
            Division::Reciprocal => {
                let reciprocal = F::ONE.div(denominator);
                self.correct(config, &t, |product| product.mul(reciprocal));
            }
            Division::Elementwise => self.correct(config, &t, |product| product.div(denominator)),
        }
        let mut output = F::ZERO;
        for j in 0..P {
            output = output.add(self.line[j].mul(self.weights[j]));
        }
        self.intermediate = t;
        self.gain = self.product_with_line();
        let error = pair.desired.sub(output);
        for i in 0..P {
            self.weights[i] = update(config, self.weights[i], self.gain[i].mul(error));
        }
        output
    }

    #[inline]
    fn correct(&mut self, config: &RlsConfig<F>, t: &[F; P], scale: impl Fn(F) -> F) {
        for i in 0..P {
            for j in 0..P {
                let correction = scale(t[i].mul(t[j]));
                self.inverse[i][j] = self.inverse[i][j].sub(correction).mul(config.inverse_alpha);
            }
        }
    }
}
