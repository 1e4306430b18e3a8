//! Names that people give to things whose keys are called otherwise, or which have no key.
//!
//! A row is found by the words of the written name, its unit left aside, in any table whose path
//! begins as the row says.

use std::sync::OnceLock;

use crate::wording::words_of;

/// What a name means.
#[derive(Clone, Copy, Debug)]
pub(super) enum Meaning {
    /// A key: its path.
    Key(&'static str),
    /// No key: what to do instead.
    Advice(&'static str),
}

/// A row: names, where they may stand (a part of the schema path, empty for everywhere), meaning.
type Row = (&'static [&'static str], &'static str, Meaning);

use Meaning::{Advice, Key};

const ROWS: &[Row] = &[
    (
        &["angle_random_walk", "angular_random_walk", "random_walk"],
        "",
        Advice(
            "the angle random walk is no key: it follows from gyro.source, gyro.detector, the sources \
             in gyro.noise and gyro.noise.technical_phase_urad_per_sqrt_hz; `fogbench budget FILE` \
             prints it",
        ),
    ),
    (
        &[
            "bias_instability",
            "flicker",
            "flicker_noise",
            "bias_stability",
        ],
        "",
        Key("gyro.slow_noise.bias_instability_deg_per_h"),
    ),
    (
        &["rate_random_walk"],
        "gyro",
        Key("gyro.slow_noise.rate_random_walk_deg_per_h_per_sqrt_h"),
    ),
    (
        &["rate_random_walk"],
        "filter[]",
        Key("filter[].kalman.rate_random_walk_deg_per_h_per_sqrt_s"),
    ),
    (
        &["drift", "rate_ramp", "bias_drift"],
        "gyro",
        Key("gyro.slow_noise.rate_ramp_deg_per_h_per_h"),
    ),
    (
        &["bias", "offset", "constant_bias"],
        "gyro",
        Key("gyro.slow_noise.bias_deg_per_h"),
    ),
    (
        &["correlation_time", "tau", "tc"],
        "gyro",
        Key("gyro.slow_noise.gauss_markov_correlation_time_s"),
    ),
    (
        &["markov", "gauss_markov", "first_order_markov"],
        "gyro",
        Key("gyro.slow_noise.gauss_markov_deg_per_h"),
    ),
    (&["dac", "dac_bit"], "", Key("gyro.modulator.dac_bits")),
    (
        &[
            "sample_rate",
            "output_rate",
            "sampling_rate",
            "sampling_frequency",
            "sample_period",
        ],
        "",
        Advice(
            "the output rate is no key: it follows from gyro.coil, \
             gyro.output.half_periods_per_sample and gyro.output.average_samples; `fogbench budget \
             FILE` prints it",
        ),
    ),
    (
        &["loop_gain", "controller_gain", "integrator_gain"],
        "",
        Key("gyro.controller.loop_bandwidth_hz"),
    ),
    (
        &["scale_factor"],
        "",
        Advice(
            "the scale factor is no key: it follows from gyro.coil and gyro.source.wavelength_nm; \
             gyro.assembly.scale_factor_error_ppm sets its error",
        ),
    ),
    (
        &["turn", "number_turn", "winding_count"],
        "gyro.coil",
        Advice(
            "the number of turns is no key: it is gyro.coil.length_m over the circumference of \
         gyro.coil.diameter_mm",
        ),
    ),
    (
        &[
            "tap_count",
            "order",
            "length",
            "weight",
            "number_tap",
            "window",
            "n",
        ],
        "filter[].rls",
        Key("filter[].rls.taps"),
    ),
    (
        &[
            "tap_count",
            "order",
            "length",
            "weight",
            "number_tap",
            "window",
            "n",
        ],
        "filter[].lms",
        Key("filter[].lms.taps"),
    ),
    (
        &[
            "tap_count",
            "order",
            "length",
            "weight",
            "number_tap",
            "window",
            "n",
            "sample",
        ],
        "filter[].moving_average",
        Key("filter[].moving_average.taps"),
    ),
    (
        &["lambda", "alpha", "forgetting"],
        "filter[].rls",
        Key("filter[].rls.forgetting_factor"),
    ),
    (
        &["delta", "initial_covariance"],
        "filter[].rls",
        Key("filter[].rls.initial_inverse_correlation"),
    ),
    (
        &["mu", "step"],
        "filter[].lms",
        Key("filter[].lms.step_size"),
    ),
    (
        &["mu", "step_size"],
        "filter[].sign_lms",
        Key("filter[].sign_lms.step"),
    ),
    (
        &[
            "cutoff_frequency",
            "corner_frequency",
            "bandwidth",
            "frequency",
        ],
        "filter[].one_pole",
        Key("filter[].one_pole.cutoff_hz"),
    ),
    (
        &[
            "cutoff_frequency",
            "corner_frequency",
            "bandwidth",
            "frequency",
        ],
        "filter[].butterworth",
        Key("filter[].butterworth.cutoff_hz"),
    ),
    (
        &["kind", "type"],
        "filter[]",
        Advice("the kind of a filter is the name of its table, as in [filter.rls]"),
    ),
    (
        &["motion", "profile", "kind", "type"],
        "turntable",
        Advice("the motion is the name of its table, as in [turntable.swing]"),
    ),
    (
        &["channel"],
        "gate[]",
        Advice("the channel stands before its metric, as in metric = \"raw.noise_std_deg_per_h\""),
    ),
    (&["limit", "upper", "below"], "gate[]", Key("gate[].max")),
    (&["lower", "above"], "gate[]", Key("gate[].min")),
];

/// The words of the names of each row.
fn row_words() -> &'static [Vec<Vec<String>>] {
    static WORDS: OnceLock<Vec<Vec<Vec<String>>>> = OnceLock::new();
    WORDS.get_or_init(|| {
        let rows = ROWS.iter();
        rows.map(|(names, ..)| names.iter().map(|name| words_of(name)).collect())
            .collect()
    })
}

/// What a written name means in a table.
pub(super) fn meaning(schema_path: &str, name: &str) -> Option<Meaning> {
    let words = words_of(name);
    let mut rows = ROWS.iter().zip(row_words());
    let means = |(row, names): &(&Row, &Vec<Vec<String>>)| {
        schema_path.starts_with(row.1) && names.contains(&words)
    };
    rows.find(means).map(|((.., meaning), _)| *meaning)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::schema::keys;

    #[test]
    fn every_key_that_a_name_means_exists() {
        for (names, _, meaning) in ROWS {
            if let Key(path) = meaning {
                assert!(keys().any(|key| key.path == *path), "{names:?}: {path}");
            }
        }
    }

    #[test]
    fn the_names_of_the_field_lead_to_their_keys() {
        let found = |table: &str, name: &str| match meaning(table, name) {
            Some(Key(path)) => path,
            Some(Advice(advice)) => advice,
            None => "",
        };
        assert!(found("gyro.noise", "arw").contains("fogbench budget"));
        assert!(found("gyro.noise", "angle_random_walk_deg_per_sqrt_h").contains("no key"));
        assert!(found("gyro", "rrw").ends_with("rate_random_walk_deg_per_h_per_sqrt_h"));
        assert!(found("gyro.slow_noise", "BI").ends_with("bias_instability_deg_per_h"));
        assert!(found("filter[].lms", "mu").ends_with("step_size"));
        assert!(found("turntable", "mu").is_empty());
    }
}
