//! A hardware pipeline as a filter of the bench.
//!
//! The words are those of the clock-less engines, which are the clocked pipelines' bit for bit. A
//! word that is not finite goes through the engine first, as through the hardware, and is then
//! reported.

use super::fixed::FixedSummary;
use super::monitor::{HealthSummary, Monitor};
use super::settings::FloatSettings;
use crate::filters::common::{Divergence, Fault, Filter, Life, Output, Register, Watch};
use crate::fpga::engine::Engine;
use crate::fpga::float_unit::Fp;
use crate::fpga::front_end::FrontEnd;
use crate::fpga::health::{Warning, wind_up_warning};
use crate::signal::FilterShape;

/// A filter of the bench that is a piece of hardware.
pub trait HardwareFilter: Filter {
    /// Looks at the matrix once more and sums up; none for filters without one.
    fn health(&mut self) -> Option<HealthSummary>;
    /// Whether forgetting has wound the matrix up by the newest look.
    fn wind_up(&self) -> Option<Warning>;
    /// What became of fixed-point words; none for filters without them.
    fn fixed(&self) -> Option<FixedSummary> {
        None
    }
    /// The newest output of the same filter in binary64, of fixed-point words.
    fn twin(&self) -> Option<Output> {
        None
    }
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
    life: Life,
}

impl<F: Fp, E: Engine<F>> PipelineFilter<F, E> {
    /// The engine of a pipeline in its reset state.
    pub(super) fn new(settings: &FloatSettings, engine: E, warm_up_samples: u64) -> Self {
        Self {
            front_end: settings.front_end(),
            weights: engine.weights().iter().map(|word| word.to_f64()).collect(),
            engine,
            register: Register::new(settings.output_register),
            watch: Watch::new(),
            shape: settings.shape(),
            monitor: Monitor::new(settings.tap_count(), warm_up_samples),
            life: Life::default(),
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
        let sample = self.life.next_sample();
        // Hardware goes on whatever its words were.
        let result = self.advance(input_deg_per_h, sample);
        self.life.judge(sample, result)
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
            drop(self.monitor.look(inverse, self.life.newest_sample()));
        }
        self.monitor.worst()
    }

    fn wind_up(&self) -> Option<Warning> {
        let inverse = self.engine.inverse_correlation()?;
        let health = self.monitor.latest()?;
        wind_up_warning(health, inverse.alpha.to_f64())
    }
}
