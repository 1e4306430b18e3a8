//! Watch over the matrix of recursive least squares while its pipeline runs.
//!
//! The matrix is looked at every [`LOOK_SAMPLES`] samples (every p squared for more taps): a look
//! costs p cubed.

use crate::filters::common::{DivergenceKind, Fault};
use crate::fpga::engine::InverseCorrelation;
use crate::fpga::float_unit::Fp;
use crate::fpga::health::{ASYMMETRY_LIMIT, HealthMonitor, LargestCondition, MatrixHealth};

/// Samples between two looks at the matrix.
const LOOK_SAMPLES: u64 = 64;

/// The matrix of recursive least squares over the record.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct HealthSummary {
    /// Largest asymmetry seen, relative.
    pub asymmetry_max: f64,
    /// Smallest pivot seen, over the largest diagonal element.
    pub smallest_pivot: f64,
    /// Largest condition number seen; infinite once the matrix is not positive definite.
    pub condition_number: f64,
    /// Largest diagonal element over its initial value at the newest look.
    pub wind_up: f64,
    /// Looks at the matrix.
    pub looks: u64,
}

/// When to look at the matrix, and the worst that was seen within the record.
pub(super) struct Monitor {
    monitor: HealthMonitor,
    interval: u64,
    first_sample: u64,
    condition: LargestCondition,
    worst: Option<HealthSummary>,
}

impl Monitor {
    pub(super) fn new(tap_count: usize, warm_up_samples: u64) -> Self {
        Self {
            // The bench judges outputs by its own watch.
            monitor: HealthMonitor::new(f64::INFINITY),
            interval: LOOK_SAMPLES.max((tap_count * tap_count) as u64),
            first_sample: warm_up_samples,
            condition: LargestCondition::default(),
            worst: None,
        }
    }

    pub(super) fn is_due(&self, sample: u64) -> bool {
        (sample + 1).is_multiple_of(self.interval)
    }

    pub(super) fn look<F: Fp>(
        &mut self,
        inverse: InverseCorrelation<F>,
        sample: u64,
    ) -> Result<(), Fault> {
        let InverseCorrelation {
            matrix,
            tap_count,
            delta,
            ..
        } = inverse;
        self.monitor.matrix(matrix, tap_count, delta);
        let Some(health) = self.monitor.latest().copied() else {
            return Ok(());
        };
        let fault = fault(&health);
        if sample >= self.first_sample || fault.is_err() {
            self.note(&health, matrix, tap_count);
        }
        fault
    }

    /// The worst that was seen; none if nothing was.
    pub(super) fn worst(&self) -> Option<HealthSummary> {
        self.worst
    }

    /// The matrix at the newest look.
    pub(super) fn latest(&self) -> Option<&MatrixHealth> {
        self.monitor.latest()
    }

    fn note<F: Fp>(&mut self, health: &MatrixHealth, matrix: &[F], tap_count: usize) {
        if !health.is_finite {
            return;
        }
        let worst = self.worst.get_or_insert(HealthSummary {
            asymmetry_max: 0.0,
            smallest_pivot: f64::INFINITY,
            condition_number: 0.0,
            wind_up: 0.0,
            looks: 0,
        });
        worst.asymmetry_max = worst.asymmetry_max.max(health.asymmetry);
        worst.smallest_pivot = worst.smallest_pivot.min(health.pivot_min);
        self.condition.look(matrix, tap_count);
        worst.condition_number = self.condition.value();
        worst.wind_up = health.wind_up;
        worst.looks += 1;
    }
}

/// What is wrong with the matrix, if anything.
fn fault(health: &MatrixHealth) -> Result<(), Fault> {
    let (kind, message) = if !health.is_finite {
        (
            DivergenceKind::NotFinite,
            "the inverse correlation matrix is not finite".to_owned(),
        )
    } else if health.asymmetry > ASYMMETRY_LIMIT {
        let message = format!(
            "the inverse correlation matrix is no longer symmetric: relative asymmetry {:.3e}, \
             limit {ASYMMETRY_LIMIT}",
            health.asymmetry
        );
        (DivergenceKind::LostSymmetry, message)
    } else if health.pivot_min.is_nan() || health.pivot_min <= 0.0 {
        let message = format!(
            "the inverse correlation matrix is no longer positive definite: smallest pivot {:.3e} \
             of the largest diagonal element, which is {:.3e} of its initial value",
            health.pivot_min, health.wind_up
        );
        (DivergenceKind::LostPositiveDefiniteness, message)
    } else {
        return Ok(());
    };
    Err(Fault { kind, message })
}
