//! What a measurement is given: samples, motion and the filter's outline.

use crate::signal::FilterShape;

/// The samples of one channel with the two references it is compared to.
///
/// All slices have the same length and are cut to the measured window.
#[derive(Clone, Copy, Debug)]
pub struct Record<'a> {
    /// The channel, deg/h.
    pub channel_deg_per_h: &'a [f64],
    /// The unfiltered gyro, deg/h; the channel itself when raw is measured.
    pub raw_deg_per_h: &'a [f64],
    /// The true rate at the stamps, deg/h.
    pub truth_deg_per_h: &'a [f64],
    /// Sample period, s.
    pub sample_period_s: f64,
    /// Stamp of the first sample, s.
    pub first_stamp_s: f64,
}

/// What the table did during the record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// At rest or turning at a constant rate.
    Steady,
    /// Sine swing.
    Swing {
        /// Swing frequency, Hz.
        frequency_hz: f64,
    },
    /// Any other known motion, such as trapezoids or a sweep.
    General,
    /// Steps of rate.
    Steps {
        /// First sample of the last rate, counted within the record.
        last_step_index: usize,
        /// Height of the last step, deg/h.
        step_deg_per_h: f64,
    },
}

/// What is known of a filter besides its output.
#[derive(Clone, Debug, PartialEq)]
pub struct FilterFacts {
    /// Samples weighed and aim.
    pub shape: FilterShape,
    /// Response to a small added rate with the weight sequence replayed.
    pub dc_gain: Option<f64>,
    /// The same with the filter free to adapt.
    pub dc_gain_adapted: Option<f64>,
    /// Time mean of every weight over the measured record, newest sample first.
    pub mean_weights: Option<Vec<f64>>,
    /// The added rate, deg/h.
    pub added_rate_deg_per_h: f64,
    /// How long after their sample's stamp the outputs appear, s: the latency of a pipeline whose
    /// result is used at once; 0 where a register holds it until the next stamp.
    pub latency_s: f64,
}

impl FilterFacts {
    /// Delay at DC of the mean weights, samples: `sum age w / sum w`, the register included; `None`
    /// without weights or DC gain.
    #[must_use]
    pub fn mean_delay_at_dc_samples(&self) -> Option<f64> {
        let weights = self.mean_weights.as_ref()?;
        let newest = self.shape.newest_age_samples;
        let (first_moment, sum) = weights
            .iter()
            .enumerate()
            .fold((0.0, 0.0), |(moment, sum), (tap, weight)| {
                (moment + (newest + tap) as f64 * weight, sum + weight)
            });
        let delay = first_moment / sum;
        delay.is_finite().then_some(delay)
    }
}

/// How to measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Motion of the table.
    pub motion: Motion,
    /// Averaging time of the plain `bias_stability_deg_per_h`, s.
    pub bias_averaging_time_s: f64,
    /// Shortest averaging time the noise fit uses, s: longer than the correlation of the channel's
    /// noise (ten samples or some twenty time constants of the loop).
    pub fit_tau_min_s: f64,
}
