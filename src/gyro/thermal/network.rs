//! Thermal network: chamber to case to outer to inner coil layer.

use crate::gyro::ThermalConfig;

/// Temperatures inside the gyro and the time constants between.
const STATE: usize = 3;
/// The state, the temperature that drives it and its slope.
const JOINT: usize = STATE + 2;

/// Temperatures of the network, deg C.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NetworkState {
    /// Case: electronics, source, leads of the coil.
    pub case_c: f64,
    /// Outer layer of the coil.
    pub outer_c: f64,
    /// Inner layer of the coil.
    pub inner_c: f64,
}

impl NetworkState {
    /// Everything at one temperature.
    #[must_use]
    pub fn uniform(temperature_c: f64) -> Self {
        Self {
            case_c: temperature_c,
            outer_c: temperature_c,
            inner_c: temperature_c,
        }
    }

    /// Mean of the coil, its radial profile being a straight line, deg C.
    #[must_use]
    pub fn coil_c(&self) -> f64 {
        // Not half the sum: equal layers give their temperature to the bit.
        self.inner_c + 0.5 * (self.outer_c - self.inner_c)
    }
}

/// Three first-order stages in a row.
///
/// ```text
/// dTc/dt = (u - Tc) / tau_c      dTo/dt = (Tc - To) / tau_o      dTi/dt = (To - Ti) / tau_i
/// ```
///
/// with `u` = chamber temperature + settled rise by self-heating. A stage does not load the one
/// before: the coil is taken as light against the case, its inside as light against its outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Network {
    /// `tau_c`, s.
    pub case_s: f64,
    /// `tau_o`, s.
    pub outer_s: f64,
    /// `tau_i`, s.
    pub inner_s: f64,
}

impl Network {
    /// The network of a configuration.
    #[must_use]
    pub fn new(thermal: &ThermalConfig) -> Self {
        Self {
            case_s: thermal.case_time_constant_s,
            outer_s: thermal.outer_time_constant_s,
            inner_s: thermal.inner_time_constant_s,
        }
    }

    /// Time derivatives at a state driven by `source_c`, K/s, in the fields of a state.
    #[must_use]
    pub fn slopes_c_per_s(&self, state: &NetworkState, source_c: f64) -> NetworkState {
        NetworkState {
            case_c: (source_c - state.case_c) / self.case_s,
            outer_c: (state.case_c - state.outer_c) / self.outer_s,
            inner_c: (state.outer_c - state.inner_c) / self.inner_s,
        }
    }

    /// The exact solution over an interval.
    #[must_use]
    pub fn propagator(&self, interval_s: f64) -> Propagator {
        let mut matrix = [[0.0; JOINT]; JOINT];
        let rates = [self.case_s, self.outer_s, self.inner_s].map(|tau_s| interval_s / tau_s);
        for (row, rate) in rates.into_iter().enumerate() {
            matrix[row][row] = -rate;
            let driver = if row == 0 { STATE } else { row - 1 };
            matrix[row][driver] = rate;
        }
        // The source is a line: its change over the interval is the slope in these units of time.
        matrix[STATE][STATE + 1] = 1.0;
        Propagator {
            matrix: exponential(&matrix),
        }
    }
}

/// Exact step of the network for a source that changes linearly over the interval.
///
/// With `y = (T - u0, 0, u1 - u0)` the solution is `exp(A h) y`, A being the network with its
/// source and the source's slope as two more states. Differences from the source keep an
/// equilibrium to the bit.
///
/// # Source
/// Van Loan, IEEE Trans. Automatic Control 23 (1978) 395 (input as states). Checked by known
/// answer K26 against the closed forms of step and ramp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Propagator {
    matrix: [[f64; JOINT]; JOINT],
}

impl Propagator {
    /// State at the end of an interval over which the source goes from one temperature to another.
    #[must_use]
    pub fn advance(
        &self,
        state: &NetworkState,
        source_start_c: f64,
        source_end_c: f64,
    ) -> NetworkState {
        let start = [
            state.case_c - source_start_c,
            state.outer_c - source_start_c,
            state.inner_c - source_start_c,
            0.0,
            source_end_c - source_start_c,
        ];
        let end = |row: usize| -> f64 {
            let products = self.matrix[row].iter().zip(&start);
            source_start_c + products.map(|(factor, value)| factor * value).sum::<f64>()
        };
        NetworkState {
            case_c: end(0),
            outer_c: end(1),
            inner_c: end(2),
        }
    }
}

/// Matrix exponential by scaling and squaring: Taylor's series of the matrix over 2^k, squared.
///
/// Below a norm of 1/2 eighteen terms are right to rounding, `0.5^19 / 19! < 1e-22`.
fn exponential(matrix: &[[f64; JOINT]; JOINT]) -> [[f64; JOINT]; JOINT] {
    const TERMS: u32 = 18;
    let norm = matrix
        .iter()
        .map(|row| row.iter().map(|entry| entry.abs()).sum::<f64>())
        .fold(0.0, f64::max);
    let mut squarings = 0;
    let mut scale = 1.0;
    while norm * scale > 0.5 {
        scale *= 0.5;
        squarings += 1;
    }
    let scaled = matrix.map(|row| row.map(|entry| entry * scale));
    let mut sum = identity();
    let mut term = identity();
    for order in 1..=TERMS {
        term = product(&term, &scaled).map(|row| row.map(|entry| entry / f64::from(order)));
        for (row, added) in sum.iter_mut().zip(&term) {
            for (entry, value) in row.iter_mut().zip(added) {
                *entry += value;
            }
        }
    }
    for _ in 0..squarings {
        sum = product(&sum, &sum);
    }
    sum
}

fn identity() -> [[f64; JOINT]; JOINT] {
    let mut matrix = [[0.0; JOINT]; JOINT];
    for (index, row) in matrix.iter_mut().enumerate() {
        row[index] = 1.0;
    }
    matrix
}

fn product(left: &[[f64; JOINT]; JOINT], right: &[[f64; JOINT]; JOINT]) -> [[f64; JOINT]; JOINT] {
    let mut result = [[0.0; JOINT]; JOINT];
    for (row, entries) in result.iter_mut().zip(left) {
        for (column, entry) in row.iter_mut().enumerate() {
            *entry = entries
                .iter()
                .zip(right)
                .map(|(factor, other)| factor * other[column])
                .sum();
        }
    }
    result
}
