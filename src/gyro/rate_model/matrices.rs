//! The linear loop over a whole output sample, as matrices.

use crate::gyro::controller::Controller;
use crate::gyro::parts::place_in_cubics;

/// Largest state: register and three delayed errors.
const STATE: usize = 4;
/// State and output together.
const JOINT: usize = STATE + 1;

/// One output sample of the linear loop: exact response to a cubic input and to white noise.
///
/// The state is `(r, e_1 .. e_d)`, the register and the errors not yet integrated. Over the
/// `periods` of an output sample, with input polynomial c (rad) and unit white noise per period,
///
/// ```text
/// (state', y) = transition state + sum input c + innovation z,      z: independent unit normals
/// ```
///
/// the sum being over the cubics of the sample, of equal length, where y is the mean of the register over the periods, taken after each update. Every column is
/// found by running the recursion itself once; `innovation` is the Cholesky factor of the noise
/// covariance `sum_k v_k v_k^T`, `v_k` being state and mean at the sample's end after a unit
/// impulse k periods before its last.
///
/// # Source
/// Derived: exact discretisation of a linear recursion over a block.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RateMatrices {
    state_count: usize,
    transition: [[f64; STATE]; JOINT],
    /// For each cubic of the sample.
    input: Vec<[[f64; 4]; JOINT]>,
    innovation: [[f64; JOINT]; JOINT],
    controller: Controller,
    periods: u32,
}

impl RateMatrices {
    /// The matrices of a loop averaged over `periods` loop periods, its input given as `cubics` cubics
    /// of equal length.
    pub(super) fn new(controller: &Controller, periods: u32, cubics: usize) -> Self {
        let latency = controller.latency_periods as usize;
        let state_count = latency + 1;
        let recursion = Recursion {
            gain: controller.gain,
            latency,
        };
        let mut transition = [[0.0; STATE]; JOINT];
        for column in 0..state_count {
            let mut start = [0.0; STATE];
            start[column] = 1.0;
            let end = recursion.run(start, periods, |_| 0.0);
            for (row, value) in transition.iter_mut().zip(end) {
                row[column] = value;
            }
        }
        let input = (0..cubics).map(|cubic| {
            let mut input = [[0.0; 4]; JOINT];
            let states = controller.states_per_period;
            let instants = (states * periods) as usize;
            for power in 0..4_i32 {
                let end = recursion.run([0.0; STATE], periods, |period| {
                    let within = (0..states).map(|state| {
                        let place =
                            place_in_cubics((states * period + state) as usize, instants, cubics);
                        match place {
                            (own, u) if own == cubic => u.powi(power),
                            _ => 0.0,
                        }
                    });
                    f64::from(states).recip() * within.sum::<f64>()
                });
                for (row, value) in input.iter_mut().zip(end) {
                    row[power.unsigned_abs() as usize] = value;
                }
            }
            input
        });
        Self {
            state_count,
            transition,
            input: input.collect(),
            innovation: cholesky(&recursion.noise_covariance(periods)),
            controller: *controller,
            periods,
        }
    }

    /// The same for an input of another number of cubics.
    pub(super) fn with_cubics(&self, cubics: usize) -> Self {
        Self::new(&self.controller, self.periods, cubics)
    }

    /// Autocovariance of the mean register by lag in output samples, for white noise of unit variance
    /// per loop period.
    ///
    /// With the stationary covariance `P = A P A^T + Q` of the state, `y' = c x + v` and the joint
    /// covariance `(Q, s, q)` of what a sample adds to state and mean, it is `c P c^T + q` at lag 0 and
    /// `c A^(l-1) (A P c^T + s)` at lag l.
    pub(super) fn word_autocovariance(&self, lags: usize) -> Vec<f64> {
        let added =
            |row: usize, column: usize| dot(&self.innovation[row], &self.innovation[column]);
        let mut power: [[f64; STATE]; STATE] = std::array::from_fn(|row| self.transition[row]);
        let mut covariance: [[f64; STATE]; STATE] =
            std::array::from_fn(|row| std::array::from_fn(|column| added(row, column)));
        for _ in 0..DOUBLINGS {
            let passed = product(&power, &product(&covariance, &transposed(&power)));
            for (row, more) in covariance.iter_mut().zip(passed) {
                for (entry, more) in row.iter_mut().zip(more) {
                    *entry += more;
                }
            }
            power = product(&power, &power);
        }
        let read = &self.transition[STATE];
        let seen: [f64; STATE] = std::array::from_fn(|row| dot(&covariance[row], read));
        let mut reach: [f64; STATE] =
            std::array::from_fn(|row| dot(&self.transition[row], &seen) + added(row, STATE));
        let mut found = vec![dot(read, &seen) + added(STATE, STATE)];
        for _ in 1..lags {
            found.push(dot(read, &reach));
            reach = std::array::from_fn(|row| dot(&self.transition[row], &reach));
        }
        found
    }

    /// Advances the state by one output sample and returns the mean register, rad.
    ///
    /// `phases_rad`: coefficients of the Sagnac phase in normalised time, for each cubic; `noise_rad`:
    /// standard deviation of the error noise per loop period; `normal` draws a unit normal.
    pub(super) fn advance(
        &self,
        state: &mut [f64; STATE],
        phases_rad: &[[f64; 4]],
        noise_rad: f64,
        mut normal: impl FnMut() -> f64,
    ) -> f64 {
        let mut draws = [0.0; JOINT];
        if noise_rad > 0.0 {
            // The output's draw stands last, behind unused states, whose rows are zero.
            for draw in &mut draws[..self.state_count] {
                *draw = noise_rad * normal();
            }
            draws[STATE] = noise_rad * normal();
        }
        let mut joint = [0.0; JOINT];
        for (row, value) in joint.iter_mut().enumerate() {
            let inputs = self.input.iter().zip(phases_rad);
            let driven: f64 = inputs.map(|(input, phase)| dot(&input[row], phase)).sum();
            *value =
                dot(&self.transition[row], state) + driven + dot(&self.innovation[row], &draws);
        }
        state.copy_from_slice(&joint[..STATE]);
        joint[STATE]
    }
}

/// Output samples, as a power of two, after which nothing is left of a state.
const DOUBLINGS: u32 = 24;

fn product(left: &[[f64; STATE]; STATE], right: &[[f64; STATE]; STATE]) -> [[f64; STATE]; STATE] {
    let columns = transposed(right);
    std::array::from_fn(|row| std::array::from_fn(|column| dot(&left[row], &columns[column])))
}

fn transposed(matrix: &[[f64; STATE]; STATE]) -> [[f64; STATE]; STATE] {
    std::array::from_fn(|row| std::array::from_fn(|column| matrix[column][row]))
}

fn dot<const N: usize>(left: &[f64; N], right: &[f64; N]) -> f64 {
    left.iter().zip(right).map(|(a, b)| a * b).sum()
}

/// The recursion `r += g e_(m-d)`, `e = input - r`.
struct Recursion {
    gain: f64,
    latency: usize,
}

impl Recursion {
    fn step(&self, state: &mut [f64; STATE], input: f64) {
        let error = input - state[0];
        let due = if self.latency == 0 {
            error
        } else {
            state[self.latency]
        };
        for slot in (2..=self.latency).rev() {
            state[slot] = state[slot - 1];
        }
        if self.latency > 0 {
            state[1] = error;
        }
        state[0] += self.gain * due;
    }

    /// State at the end of `periods` periods and mean register over them.
    fn run(
        &self,
        mut state: [f64; STATE],
        periods: u32,
        input: impl Fn(u32) -> f64,
    ) -> [f64; JOINT] {
        let mut sum = 0.0;
        for period in 0..periods {
            self.step(&mut state, input(period));
            sum += state[0];
        }
        joined(&state, sum / f64::from(periods))
    }

    /// Covariance of end state and mean for unit white noise, one input per period.
    fn noise_covariance(&self, periods: u32) -> [[f64; JOINT]; JOINT] {
        let mut covariance = [[0.0; JOINT]; JOINT];
        let mut state = [0.0; STATE];
        let mut sum = 0.0;
        // Running on after one impulse visits the responses of all impulses, the last period's first.
        for age in 0..periods {
            self.step(&mut state, if age == 0 { 1.0 } else { 0.0 });
            sum += state[0];
            let response = joined(&state, sum / f64::from(periods));
            for (row, &left) in covariance.iter_mut().zip(&response) {
                for (entry, &right) in row.iter_mut().zip(&response) {
                    *entry += left * right;
                }
            }
        }
        covariance
    }
}

fn joined(state: &[f64; STATE], mean: f64) -> [f64; JOINT] {
    let mut joint = [0.0; JOINT];
    joint[..STATE].copy_from_slice(state);
    joint[STATE] = mean;
    joint
}

/// Lower factor L with `L L^T` = the matrix, for a positive semi-definite matrix.
///
/// A pivot at rounding level is a combination of earlier rows (a delayed error that one short
/// sample cannot reach, or an unused state): its column is left zero.
fn cholesky(matrix: &[[f64; JOINT]; JOINT]) -> [[f64; JOINT]; JOINT] {
    let mut factor = [[0.0; JOINT]; JOINT];
    for column in 0..JOINT {
        let rest = |row: usize, factor: &[[f64; JOINT]; JOINT]| {
            let done: f64 = (0..column)
                .map(|k| factor[row][k] * factor[column][k])
                .sum();
            matrix[row][column] - done
        };
        let pivot = rest(column, &factor);
        if pivot <= 1e-12 * matrix[column][column] {
            continue;
        }
        let root = pivot.sqrt();
        for row in column..JOINT {
            factor[row][column] = rest(row, &factor) / root;
        }
    }
    factor
}
