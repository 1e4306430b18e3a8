//! The patent's recursion as printed: twelve states, covariance form.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use super::estimator::RecursiveSettings;
use super::forgetting::Reading;
use super::observations::GroupObservation;

type Covariance = SMatrix<f64, 12, 12>;

/// `x1..x12` by equations (14) to (16).
///
/// ```text
/// E = Y - alpha X            K = P alpha^T (mu + alpha P alpha^T)^-1
/// X <- X + K E               P <- lambda^-1/2 (I - K alpha) P lambda^-1/2
/// ```
///
/// with `alpha = blockdiag(a, a, a)` (3 x 12), `lambda = sigma (x) I_4` and mu by the reading. In exact
/// arithmetic this is the square-root form; in double precision the subtraction in `I - K alpha`
/// cancels against a large xi.
///
/// Why: after the first group of a mounting, P is of order `sigma / W^2` in one direction and still
/// xi in the others. What is left of it comes from differences of numbers of size xi, whose rounding
/// is `xi 2^-53`; a small forgetting factor divides P and what rounding left of it again with every
/// group. With F2, c = 1 1/K and xi = 1e6 the worked example loses 0.9 deg/h of bias.
///
/// The prior acts on the other side: `P_0^-1 = I / xi` pulls every state towards zero, by
/// `x / (xi sum a^2)` in its direction. In deg/s that is 2e-7 deg/h at xi = 1e8.
///
/// * `factors`: forgetting factors of the gyros x, y, z, `[groups]` each.
pub(super) fn covariance_recursion(
    groups: &[GroupObservation],
    settings: &RecursiveSettings,
    factors: &[&[f64]; 3],
) -> [f64; 12] {
    let mut x = SVector::<f64, 12>::zeros();
    let mut p = Covariance::from_diagonal_element(settings.initial_covariance);
    for (index, group) in groups.iter().enumerate() {
        let sigma = [0, 1, 2].map(|axis: usize| factors[axis][index]);
        let [wx, wy, wz] = group.design.reference_rate_deg_per_s;
        let row = [wx, wy, wz, 1.0];
        let alpha = SMatrix::<f64, 3, 12>::from_fn(|axis, state| {
            if state / 4 == axis {
                row[state % 4]
            } else {
                0.0
            }
        });
        let noise = sigma.map(|factor| match settings.reading {
            Reading::Discount | Reading::RowWeight => factor,
            // Without a step of the temperature the group has no weight: infinite noise.
            Reading::Convex => factor / (1.0 - factor),
        });
        let y = Vector3::from(group.output_deg_per_s);
        let gain = if noise.iter().all(|value| value.is_finite()) {
            let mu = Matrix3::from_diagonal(&Vector3::from(noise));
            (mu + alpha * p * alpha.transpose())
                .try_inverse()
                .map(|inverse| p * alpha.transpose() * inverse)
        } else {
            None
        };
        let discount = SVector::<f64, 12>::from_fn(|state, _| {
            settings.reading.update(sigma[state / 4]).0.sqrt().recip()
        });
        let discount = Covariance::from_diagonal(&discount);
        if let Some(gain) = gain {
            x += gain * (y - alpha * x);
            p = (Covariance::identity() - gain * alpha) * p;
        }
        p = discount * p * discount;
    }
    x.into()
}
