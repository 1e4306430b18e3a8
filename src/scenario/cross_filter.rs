//! Checks across the keys of a line enhancer.

use super::filter_config::{FilterConfig, FilterKind, SignLmsFilterConfig};
use crate::vocabulary::{InitialWeights, Pipeline, SignLmsForm};

/// Step at and beyond which the normalised forms are unstable in any input.
const NORMALISED_STEP_BOUND: f64 = 2.0;

/// Every complaint about the line enhancers: the key to blame and what is wrong.
pub(crate) fn check(filters: &[FilterConfig]) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for (index, filter) in filters.iter().enumerate() {
        if let FilterKind::SignLms(config) = &filter.kind {
            found.extend(check_one(&format!("filter[{index}].sign_lms"), config));
        }
    }
    found
}

fn check_one(path: &str, config: &SignLmsFilterConfig) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut complain = |key: &str, message: String| {
        let key = format!("{path}.{key}");
        found.push((key.clone(), format!("{key} {message}")));
    };
    if config.form != SignLmsForm::Sign && config.step >= NORMALISED_STEP_BOUND {
        complain(
            "step",
            format!(
                "= {:?} is unstable: the step of the normalised forms has no unit and must be in \
                 (0, {NORMALISED_STEP_BOUND})",
                config.step
            ),
        );
    }
    let recompute = config.norm_recompute_samples;
    if recompute != 0 && recompute < config.taps {
        complain(
            "norm_recompute_samples",
            format!(
                "= {recompute} is too short: a fresh sum takes taps = {} samples; allowed 0 or \
                 {} and more",
                config.taps, config.taps
            ),
        );
    }
    if config.form == SignLmsForm::UnityGain {
        if config.pipeline == Pipeline::Fpga {
            complain(
                "pipeline",
                "= \"fpga\" has no form \"unity-gain\": use form = \"sign\" or \"nlms\", or \
                 pipeline = \"textbook\""
                    .to_owned(),
            );
        }
        if config.initial_weights == InitialWeights::Zero {
            complain(
                "initial_weights",
                "= \"zero\" has the sum 0, which form = \"unity-gain\" would hold for ever: use \
                 \"mean\""
                    .to_owned(),
            );
        }
    }
    found
}
