//! Three gyros in one case, as patent CN101221046 models them.

use crate::gyro::error::GyroError;
use crate::gyro::input_axis::InputAxis;
use crate::gyro::instrument::Gyro;
use crate::gyro::{AssemblyConfig, Fidelity, GyroConfig};
use crate::random::Streams;
use crate::signal::MotionSegment;

/// Names of the case axes; the noise streams of each gyro are named after its axis.
const AXES: [&str; 3] = ["x", "y", "z"];

/// The configuration of gyro `axis` with its own temperature coefficients joined to the common ones.
///
/// Bias and expansion of the coil's diameter are linear in the temperature of the coil: the second
/// acts on the scale factor alone, so that a coefficient of the scale factor is one more of it.
fn with_own_temperature(config: &GyroConfig, assembly: &AssemblyConfig, axis: usize) -> GyroConfig {
    let mut own = config.clone();
    own.thermal.bias_deg_per_h_per_k += assembly.bias_deg_per_h_per_k[axis];
    own.thermal.diameter_ppm_per_k += assembly.scale_factor_ppm_per_k[axis];
    own
}

/// One gyro of an assembly: a whole gyro behind its own input axis, with noise of its own.
///
/// A scale-factor error acts on the sensed rate; the noise, which it would change by the same few
/// parts per million, is left as that of an ideal gyro. No source is shared between the gyros: an
/// assembly whose three coils share one light source has correlated intensity noise, this one not.
#[derive(Clone, Debug)]
pub struct CaseGyro {
    input_axis: InputAxis,
    gyro: Gyro,
    /// What the input axis sensed of the last word.
    sensed: Vec<MotionSegment>,
}

impl CaseGyro {
    /// The gyros x, y, z of an assembly, alike but for their input axes; a configuration without
    /// an assembly has none.
    ///
    /// Noise streams are those of a single gyro, each within the scope `x`, `y` or `z`.
    ///
    /// # Errors
    /// Any [`GyroError`], as [`Gyro::new`].
    pub fn assembly(
        config: &GyroConfig,
        fidelity: Fidelity,
        simulated_time_s: f64,
        streams: &Streams,
    ) -> Result<Vec<Self>, GyroError> {
        let Some(assembly) = &config.assembly else {
            return Ok(Vec::new());
        };
        let input_axes = InputAxis::of_assembly(assembly);
        let gyros = AXES.into_iter().zip(input_axes);
        gyros
            .enumerate()
            .map(|(index, (axis, input_axis))| {
                let streams = streams.scoped(axis);
                let own = with_own_temperature(config, assembly, index);
                let gyro = Gyro::new(&own, fidelity, simulated_time_s, &streams)?;
                Ok(Self {
                    input_axis,
                    gyro,
                    sensed: Vec::new(),
                })
            })
            .collect()
    }

    /// Rate word of the output sample over which the case moves as `case`, deg/h.
    pub fn next_word(&mut self, case: &[MotionSegment; 3]) -> f64 {
        self.gyro.next_word(&self.input_axis.sensed(case))
    }

    /// Rate word of the output sample over which the case moves as `cases`, which share it equally,
    /// deg/h.
    pub fn next_word_over(&mut self, cases: &[[MotionSegment; 3]]) -> f64 {
        self.sensed.clear();
        let sensed = cases.iter().map(|case| self.input_axis.sensed(case));
        self.sensed.extend(sensed);
        self.gyro.next_word_over(&self.sensed)
    }

    /// The gyro behind the input axis.
    #[must_use]
    pub fn gyro(&self) -> &Gyro {
        &self.gyro
    }
}
