//! Recursive filters as cascades of second-order sections.

use super::complaints::Complaints;
use super::core_filter::{Core, CoreFilter};
use super::divergence::Fault;
use super::filter::Output;
use super::front_end::FrontEndConfig;
use crate::signal::{Section, WeightRule};
use crate::vocabulary::{DesiredSignal, OutputRegister};

/// A cascade of second-order sections with its state.
#[derive(Clone, Debug)]
pub struct SectionsCore {
    sections: Vec<Section>,
    /// Two delays of each section, of the signal and of the response to a constant 1.
    signal: Vec<[f64; 2]>,
    constant: Vec<[f64; 2]>,
}

/// A recursive filter behind the common front end.
pub type RecursiveFilter = CoreFilter<SectionsCore>;

impl RecursiveFilter {
    /// A cascade at rest.
    ///
    /// # Panics
    /// If there are no sections.
    #[must_use]
    pub fn new(sections: Vec<Section>, output_register: OutputRegister) -> Self {
        assert!(!sections.is_empty(), "a cascade has a section");
        let rest = vec![[0.0; 2]; sections.len()];
        let core = SectionsCore {
            sections,
            signal: rest.clone(),
            constant: rest,
        };
        Self::with_core(core, &FrontEndConfig::direct(output_register))
    }
}

/// One step of the cascade in transposed direct form II, whose rounding stays small.
fn cascade(sections: &[Section], state: &mut [[f64; 2]], input: f64) -> f64 {
    let mut value = input;
    for (section, [first, second]) in sections.iter().zip(state) {
        let [b0, b1, b2] = section.numerator;
        let [a1, a2] = section.denominator;
        let output = b0 * value + *first;
        *first = b1 * value - a1 * output + *second;
        *second = b2 * value - a2 * output;
        value = output;
    }
    value
}

impl Core for SectionsCore {
    fn update(&mut self, regressors: &[f64], _desired: f64) -> Result<Output, Fault> {
        Ok(Output {
            value_deg_per_h: cascade(&self.sections, &mut self.signal, regressors[0]),
            weight_sum: cascade(&self.sections, &mut self.constant, 1.0),
        })
    }

    fn weights(&self) -> &[f64] {
        &[]
    }

    fn regressors(&self) -> usize {
        1
    }

    fn rule(&self, _desired: DesiredSignal) -> WeightRule {
        WeightRule::Sections(self.sections.clone())
    }
}

/// The frequency of a low pass in cycles per sample.
///
/// # Panics
/// If it is not below half the sample rate.
pub(in crate::filters) fn checked(cycles_per_sample: f64) -> f64 {
    assert!(
        cycles_per_sample > 0.0 && cycles_per_sample < 0.5,
        "{cycles_per_sample} cycles a sample lie in (0, 1/2)"
    );
    cycles_per_sample
}

/// Complains of a half-power frequency beyond the reach of the words.
///
/// * `least_share`: least frequency over the sample rate.
pub(in crate::filters) fn check_cutoff(
    cutoff_hz: f64,
    least_share: f64,
    sample_rate_hz: f64,
    complaints: &mut Complaints,
) {
    let (least_hz, limit_hz) = (least_share * sample_rate_hz, 0.5 * sample_rate_hz);
    let range = format!("allowed [{least_hz:.3e}, {limit_hz:.3}) Hz");
    let message = if cutoff_hz >= limit_hz {
        format!("= {cutoff_hz} Hz is not below half the output rate: {range}")
    } else if cutoff_hz < least_hz {
        format!(
            "= {cutoff_hz} Hz is below {least_share:e} of the output rate, where the poles lie too \
             near 1 for binary64: {range}, or a larger gyro.output.average_samples"
        )
    } else {
        return;
    };
    complaints.key("cutoff_hz", &message);
}
