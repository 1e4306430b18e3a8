//! Adaptive filters in the order in which the books print their equations, each number after those that
//! it is made of: what the filters that look ahead are held to, in their words and in their speed.

use fogbench::filters::{Core, DivergenceKind, Fault, LmsConfig, Normalisation, Output, RlsConfig};

fn dot(left: &[f64], right: &[f64]) -> f64 {
    left.iter().zip(right).map(|(l, r)| l * r).sum()
}

/// Least mean squares, plain and normalised.
pub(crate) struct Lms {
    config: LmsConfig,
    weights: Vec<f64>,
}

impl Lms {
    pub(crate) fn new(config: &LmsConfig) -> Self {
        let (config, weights) = (config.clone(), vec![0.0; config.taps]);
        Self { config, weights }
    }
}

impl Core for Lms {
    fn update(&mut self, regressors: &[f64], desired: f64) -> Result<Output, Fault> {
        let output = Output {
            value_deg_per_h: dot(&self.weights, regressors),
            weight_sum: self.weights.iter().sum(),
        };
        let mut step = self.config.update_sign.factor()
            * self.config.step_size
            * (desired - output.value_deg_per_h);
        if let Normalisation::Energy {
            regularisation_deg2_per_h2: epsilon,
        } = self.config.normalisation
        {
            let energy = epsilon + dot(regressors, regressors);
            step = if energy > 0.0 { step / energy } else { 0.0 };
        }
        for (weight, regressor) in self.weights.iter_mut().zip(regressors) {
            *weight += step * regressor;
        }
        Ok(output)
    }

    fn weights(&self) -> &[f64] {
        &self.weights
    }
}

/// Recursive least squares, the upper triangle of P mirrored.
pub(crate) struct Rls {
    config: RlsConfig,
    weights: Vec<f64>,
    matrix: Vec<f64>,
    projection: Vec<f64>,
}

impl Rls {
    pub(crate) fn new(config: &RlsConfig) -> Self {
        let taps = config.taps;
        let mut matrix = vec![0.0; taps * taps];
        for diagonal in matrix.iter_mut().step_by(taps + 1) {
            *diagonal = config.initial_inverse_correlation;
        }
        let (config, weights) = (config.clone(), vec![0.0; taps]);
        let projection = vec![0.0; taps];
        Self {
            config,
            weights,
            matrix,
            projection,
        }
    }

    fn fault(&self, denominator: f64) -> Fault {
        let is_finite = self.matrix.iter().all(|p| p.is_finite()) && denominator.is_finite();
        Fault {
            kind: if is_finite {
                DivergenceKind::LostPositiveDefiniteness
            } else {
                DivergenceKind::NotFinite
            },
            message: String::new(),
        }
    }
}

impl Core for Rls {
    fn update(&mut self, regressors: &[f64], desired: f64) -> Result<Output, Fault> {
        let (taps, factor) = (self.weights.len(), self.config.forgetting_factor);
        let output = Output {
            value_deg_per_h: dot(&self.weights, regressors),
            weight_sum: self.weights.iter().sum(),
        };
        let rows = self.matrix.chunks_exact(taps);
        for (projection, row) in self.projection.iter_mut().zip(rows) {
            *projection = dot(row, regressors);
        }
        let denominator = factor + dot(regressors, &self.projection);
        if !(denominator > 0.0 && denominator < f64::INFINITY) {
            return Err(self.fault(denominator));
        }
        let error = desired - output.value_deg_per_h;
        let step = self.config.update_sign.factor() * error / denominator;
        for (weight, projection) in self.weights.iter_mut().zip(&self.projection) {
            *weight += step * projection;
        }
        let inverse = 1.0 / factor;
        let mut is_definite = true;
        for row in 0..taps {
            let gain = self.projection[row] / denominator;
            for column in row..taps {
                let index = row * taps + column;
                let updated = (self.matrix[index] - gain * self.projection[column]) * inverse;
                self.matrix[index] = updated;
                self.matrix[column * taps + row] = updated;
            }
            let diagonal = self.matrix[row * (taps + 1)];
            is_definite &= diagonal > 0.0 && diagonal < f64::INFINITY;
        }
        if is_definite {
            Ok(output)
        } else {
            Err(self.fault(denominator))
        }
    }

    fn weights(&self) -> &[f64] {
        &self.weights
    }
}
