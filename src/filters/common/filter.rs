//! What every filter can do.

use super::divergence::Divergence;
use crate::signal::FilterShape;

/// One output word of a filter and the weights it was made with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Output {
    /// Filtered rate, in the unit of the input words (deg/h).
    pub value_deg_per_h: f64,
    /// Sum of the weights that made this value: its response to a small constant added to the
    /// input, with the weights left as they were. Dimensionless; 1 for an honest denoiser.
    pub weight_sum: f64,
}

impl Output {
    /// What an output register holds after reset.
    pub(super) const RESET: Self = Self {
        value_deg_per_h: 0.0,
        weight_sum: 0.0,
    };
}

/// A filter that takes one rate word and gives one rate word per sample.
pub trait Filter: Send {
    /// Takes the sample of this tick and returns the word that is stamped with it.
    ///
    /// # Errors
    /// [`Divergence`] in the very sample in which the filter is seen to have diverged, and the
    /// same one in every later call.
    fn step(&mut self, input_deg_per_h: f64) -> Result<Output, Divergence>;

    /// Takes consecutive samples and appends the words stamped with them, to the bit those of
    /// [`step`](Self::step) for one after another.
    ///
    /// # Errors
    /// As [`step`](Self::step), once the words before that sample are appended.
    fn step_all(
        &mut self,
        inputs_deg_per_h: &[f64],
        outputs: &mut Vec<Output>,
    ) -> Result<(), Divergence> {
        step_each(self, inputs_deg_per_h, outputs)
    }

    /// Weights after the newest update, the one on the newest regressor first.
    fn weights(&self) -> &[f64];

    /// Input samples that the outputs weigh, and the rule of the weights.
    fn shape(&self) -> FilterShape;
}

/// Takes samples one after another.
pub(super) fn step_each<F: Filter + ?Sized>(
    filter: &mut F,
    inputs_deg_per_h: &[f64],
    outputs: &mut Vec<Output>,
) -> Result<(), Divergence> {
    for &input_deg_per_h in inputs_deg_per_h {
        outputs.push(filter.step(input_deg_per_h)?);
    }
    Ok(())
}
