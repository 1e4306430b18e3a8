//! Winding of the coil and the bias that changing temperatures make in it (Shupe effect).

use crate::gyro::thermal::NetworkState;
use crate::gyro::{GyroConfig, Winding};
use crate::units::{MICRO, MILLI};

/// Layer met at each position along the fibre, 0 being the innermost.
///
/// Plain: 0, 1, 2 ... from one end to the other. Dipole and quadrupole are wound from the middle
/// of the fibre outwards with both halves; half A takes the layers 0, 2, 4, 6 ... of a dipole and
/// 0, 3, 4, 7 ... of a quadrupole (A B B A), half B the others. The path along the fibre is A from
/// its outer end inwards, then B outwards.
#[must_use]
pub fn layer_order(winding: Winding, layers: usize) -> Vec<usize> {
    let half_a = |pair: usize| match winding {
        Winding::Quadrupole => 2 * pair + pair % 2,
        Winding::Plain | Winding::Dipole => 2 * pair,
    };
    if winding == Winding::Plain {
        return (0..layers).collect();
    }
    let inwards = (0..layers / 2).rev().map(half_a);
    let outwards = (0..layers / 2).map(|pair| 4 * pair + 1 - half_a(pair));
    inwards.chain(outwards).collect()
}

/// `integral T'(z) (L - 2 z) dz / L^2` over a coil whose M layers have one temperature rate each.
///
/// Exact layer by layer: position i of M spans `z = i L / M .. (i + 1) L / M` and weighs
/// `(M - 2 i - 1) / M^2`. `order` is the layer at each position, `rates` the rate of each layer.
#[must_use]
pub fn layer_integral(order: &[usize], rates: &[f64]) -> f64 {
    let count = order.len() as f64;
    let sum: f64 = order
        .iter()
        .enumerate()
        .map(|(position, &layer)| rates[layer] * (count - 2.0 * position as f64 - 1.0))
        .sum();
    sum / (count * count)
}

/// The bias of a coil whose temperature changes.
///
/// Light that runs one way passes the point z of the fibre at another time than light that runs
/// the other way; a temperature that changes between gives the rate
///
/// ```text
/// Omega = n (dn/dT + n alpha) / (D L) integral_0^L T'(z, t) (L - 2 z) dz
/// ```
///
/// Only the part of `T'` that is odd about the middle of the fibre counts. For a radial profile
/// that is a straight line from the inner to the outer layer, with `d = To' - Ti'`, the integral is
/// `S L^2 d`:
///
/// * plain `S = -(M + 1) / (6 M)`,
/// * dipole `S = -1 / (4 (M - 1))`,
/// * quadrupole `S = 1 / (2 M (M - 1))`, `3 / (M^2 - 1)` of plain.
///
/// If the middle of the fibre lies `delta` beside the middle of the winding, the halves of the
/// coil differ in length and the leads make up for it: `2 delta L (T'coil - T'leads)` is added.
///
/// # Source
/// Shupe, Applied Optics 19 (1980) 654; sums over layers derived. Checked by known answer K25.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shupe {
    /// Rate per difference of temperature rates, outer minus inner layer, rad/s per K/s.
    pub gradient_rad_per_k: f64,
    /// Rate per difference of temperature rates, coil minus leads, rad/s per K/s.
    pub lead_rad_per_k: f64,
}

impl Shupe {
    /// The coil of a configuration.
    #[must_use]
    pub fn new(config: &GyroConfig) -> Self {
        let (thermal, coil) = (&config.thermal, &config.coil);
        let layers = thermal.layers as usize;
        let last = f64::from(thermal.layers) - 1.0;
        let profile: Vec<f64> = (0..layers).map(|layer| layer as f64 / last).collect();
        let factor = layer_integral(&layer_order(thermal.winding, layers), &profile);
        let phase_per_k = thermal.index_per_k + coil.group_index * thermal.length_ppm_per_k * MICRO;
        let whole = coil.group_index * phase_per_k * coil.length_m / (coil.diameter_mm * MILLI);
        Self {
            gradient_rad_per_k: factor * whole,
            lead_rad_per_k: 2.0 * thermal.midpoint_offset_m / coil.length_m * whole,
        }
    }

    /// Bias at the temperature rates of the network (K/s), rad/s.
    #[must_use]
    pub fn bias_rad_per_s(&self, slopes_c_per_s: &NetworkState) -> f64 {
        self.gradient_rad_per_k * (slopes_c_per_s.outer_c - slopes_c_per_s.inner_c)
            + self.lead_rad_per_k * (slopes_c_per_s.coil_c() - slopes_c_per_s.case_c)
    }
}
