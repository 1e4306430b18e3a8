//! A hardware pipeline as a filter of the bench.
//!
//! The words are those of the clock-less engines, which are the clocked pipelines' bit for bit. A
//! word that is not finite goes through the engine first, as through the hardware, and is then
//! reported. The matrix of recursive least squares is looked at every [`LOOK_SAMPLES`] samples
//! (every p squared for more taps): a look costs p cubed.

use crate::filters::{Divergence, DivergenceKind, Fault, Filter, Output, Register, Watch};
use crate::fpga::engine::{Engine, InverseCorrelation};
use crate::fpga::float_unit::Fp;
use crate::fpga::front_end::FrontEnd;
use crate::fpga::health::{ASYMMETRY_LIMIT, HealthMonitor, MatrixHealth, Warning, wind_up_warning};
use crate::signal::FilterShape;

use super::pipeline_settings::PipelineSettings;

/// Samples between two looks at the matrix.
const LOOK_SAMPLES: u64 = 64;

/// The matrix of recursive least squares over the record.
#[derive(Clone, Copy, Debug, PartialEq)]
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

/// A filter of the bench that is a piece of hardware.
pub trait HardwareFilter: Filter {
    /// Looks at the matrix once more and sums up; none for filters without one.
    fn health(&mut self) -> Option<HealthSummary>;
    /// Whether forgetting has wound the matrix up by the newest look.
    fn wind_up(&self) -> Option<Warning>;
}

/// Pipeline behind its front end, with the output register and the watch for divergence.
pub(super) struct PipelineFilter<F, E> {
    front_end: FrontEnd<F>,
    engine: E,
    weights: Vec<f64>,
    register: Register,
    watch: Watch,
    shape: FilterShape,
    monitor: Monitor,
    samples: u64,
    diverged: Option<Divergence>,
}

impl<F: Fp, E: Engine<F>> PipelineFilter<F, E> {
    /// The engine of a pipeline in its reset state.
    pub(super) fn new(settings: &PipelineSettings, engine: E, warm_up_samples: u64) -> Self {
        Self {
            front_end: settings.front_end(),
            weights: engine.weights().iter().map(|word| word.to_f64()).collect(),
            engine,
            register: Register::new(settings.output_register),
            watch: Watch::new(),
            shape: settings.shape(),
            monitor: Monitor::new(settings.tap_count(), warm_up_samples),
            samples: 0,
            diverged: None,
        }
    }

    fn advance(&mut self, input: f64, sample: u64) -> Result<Output, Fault> {
        let pair = self.front_end.pair(F::from_f64(input));
        let weight_sum = self.weights.iter().sum();
        let value = self.engine.process(pair);
        for (held, word) in self.weights.iter_mut().zip(self.engine.weights()) {
            *held = word.to_f64();
        }
        let result = Output {
            value_deg_per_h: value.to_f64(),
            weight_sum,
        };
        // Diagnosis only from here on: the hardware has done its work, whatever the words were.
        let output = self.register.clock(result);
        self.watch.check_input(input)?;
        self.watch.check_output(result)?;
        if let Some(inverse) = self.engine.inverse_correlation()
            && self.monitor.is_due(sample)
        {
            self.monitor.look(inverse, sample)?;
        }
        Ok(output)
    }
}

impl<F: Fp, E: Engine<F> + Send> Filter for PipelineFilter<F, E> {
    fn step(&mut self, input_deg_per_h: f64) -> Result<Output, Divergence> {
        let sample = self.samples;
        self.samples += 1;
        let result = self.advance(input_deg_per_h, sample);
        if let Some(divergence) = &self.diverged {
            return Err(divergence.clone());
        }
        result.map_err(|fault| {
            let divergence = fault.at(sample);
            self.diverged = Some(divergence.clone());
            divergence
        })
    }

    fn weights(&self) -> &[f64] {
        &self.weights
    }

    fn shape(&self) -> FilterShape {
        self.shape.clone()
    }
}

impl<F: Fp, E: Engine<F> + Send> HardwareFilter for PipelineFilter<F, E> {
    fn health(&mut self) -> Option<HealthSummary> {
        if let Some(inverse) = self.engine.inverse_correlation() {
            // What it finds is part of the summary; the run is over, so nothing can fail any more.
            drop(self.monitor.look(inverse, self.samples.saturating_sub(1)));
        }
        self.monitor.worst
    }

    fn wind_up(&self) -> Option<Warning> {
        let inverse = self.engine.inverse_correlation()?;
        let health = self.monitor.monitor.latest()?;
        wind_up_warning(health, inverse.alpha.to_f64())
    }
}

/// When to look at the matrix, and the worst that was seen within the record.
struct Monitor {
    monitor: HealthMonitor,
    interval: u64,
    first_sample: u64,
    worst: Option<HealthSummary>,
}

impl Monitor {
    fn new(tap_count: usize, warm_up_samples: u64) -> Self {
        Self {
            // The bench judges outputs by its own watch.
            monitor: HealthMonitor::new(f64::INFINITY),
            interval: LOOK_SAMPLES.max((tap_count * tap_count) as u64),
            first_sample: warm_up_samples,
            worst: None,
        }
    }

    fn is_due(&self, sample: u64) -> bool {
        (sample + 1).is_multiple_of(self.interval)
    }

    fn look<F: Fp>(&mut self, inverse: InverseCorrelation<F>, sample: u64) -> Result<(), Fault> {
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
            self.note(&health);
        }
        fault
    }

    fn note(&mut self, health: &MatrixHealth) {
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
        worst.condition_number = worst.condition_number.max(health.condition);
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
