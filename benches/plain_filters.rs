//! Adaptive filters as one would write them in C: fixed arrays, nothing generic, nothing checked, the order
//! of operations of the hardware.

use fogbench::fpga::front_end::Pair;

/// Recursive least squares of four taps that forget nothing.
pub(crate) struct PlainRls {
    l: [f64; 4],
    w: [f64; 4],
    r: [[f64; 4]; 4],
}

impl PlainRls {
    pub(crate) fn new(initial_inverse_correlation: f64) -> Self {
        let mut r = [[0.0; 4]; 4];
        for (i, row) in r.iter_mut().enumerate() {
            row[i] = initial_inverse_correlation;
        }
        Self {
            l: [0.0; 4],
            w: [0.0; 4],
            r,
        }
    }

    #[inline(never)]
    pub(crate) fn run(&mut self, pairs: &[Pair<f64>], outputs: &mut [f64]) {
        let Self { l, w, r } = self;
        for (pair, output) in pairs.iter().zip(outputs) {
            *l = [pair.input, l[0], l[1], l[2]];
            let mut t = [0.0; 4];
            for i in 0..4 {
                for j in 0..4 {
                    t[i] += l[j] * r[i][j];
                }
            }
            let mut den = 1.0;
            for j in 0..4 {
                den += l[j] * t[j];
            }
            let rcp = 1.0 / den;
            for i in 0..4 {
                for j in 0..4 {
                    r[i][j] -= (t[i] * t[j]) * rcp;
                }
            }
            let mut y = 0.0;
            for j in 0..4 {
                y += l[j] * w[j];
            }
            let e = pair.desired - y;
            for i in 0..4 {
                let mut m = 0.0;
                for j in 0..4 {
                    m += l[j] * r[i][j];
                }
                w[i] += m * e;
            }
            *output = y;
        }
    }
}
