//! Names that people give to things whose keys are called otherwise, or which have no key.
//!
//! A row is found by the words of the written name, its unit left aside, in any table whose path
//! begins as the row says.

use std::sync::OnceLock;

use crate::wording::words_of;

/// What a name means.
#[derive(Clone, Copy, Debug)]
pub(in crate::scenario) enum Meaning {
    /// A key: its path.
    Key(&'static str),
    /// No key: what to do instead.
    Advice(&'static str),
}

/// Tables in which a name has a meaning.
#[derive(Clone, Copy, Debug)]
enum Where {
    /// Whose path begins so; an empty one is everywhere.
    Below(&'static str),
    /// These alone: what is called so elsewhere is something else.
    In(&'static [&'static str]),
}

/// A row: names, where they may stand, meaning.
type Row = (&'static [&'static str], Where, Meaning);

use Meaning::{Advice, Key};
use Where::{Below, In};

/// Tables in which a word of noise is one of the gyro's, not of its source, converter or table.
const OF_NOISE: Where = In(&["gyro", "gyro.noise", "gyro.slow_noise"]);

const ROWS: &[Row] = &[
    (
        &["sweep", "scan", "grid"],
        In(&[""]),
        Advice(
            "points are listed in [matrix], as in \"gyro.coil.length_m\" = [500, 1000], or given as a \
             range, { from = 500, to = 1000, count = 6 }",
        ),
    ),
    (
        &["angle_random_walk", "angular_random_walk", "random_walk"],
        In(&[
            "",
            "gyro",
            "gyro.noise",
            "gyro.slow_noise",
            "gyro.source",
            "gyro.detector",
            "gyro.coil",
        ]),
        Key("gyro.noise.angle_random_walk_deg_per_sqrt_h"),
    ),
    (
        &[
            "bias_instability",
            "flicker",
            "flicker_noise",
            "bias_stability",
        ],
        Below(""),
        Key("gyro.slow_noise.bias_instability_deg_per_h"),
    ),
    (
        &["rate_random_walk"],
        Below("gyro"),
        Key("gyro.slow_noise.rate_random_walk_deg_per_h_per_sqrt_h"),
    ),
    (
        &["rate_random_walk"],
        Below("filter[]"),
        Key("filter[].kalman.rate_random_walk_deg_per_h_per_sqrt_h"),
    ),
    (
        &["drift", "rate_ramp", "bias_drift"],
        OF_NOISE,
        Key("gyro.slow_noise.rate_ramp_deg_per_h_per_h"),
    ),
    (
        &["bias", "offset", "constant_bias"],
        OF_NOISE,
        Key("gyro.slow_noise.bias_deg_per_h"),
    ),
    (
        &["correlation_time", "tau", "tc"],
        OF_NOISE,
        Key("gyro.slow_noise.gauss_markov_correlation_time_s"),
    ),
    (
        &["markov", "gauss_markov", "first_order_markov"],
        OF_NOISE,
        Key("gyro.slow_noise.gauss_markov_deg_per_h"),
    ),
    (
        &["dac", "dac_bit"],
        Below(""),
        Key("gyro.modulator.dac_bits"),
    ),
    (
        &[
            "sample_rate",
            "output_rate",
            "sampling_rate",
            "sampling_frequency",
            "sample_period",
        ],
        Below(""),
        Advice(
            "the output rate is no key: it follows from gyro.coil, \
             gyro.output.half_periods_per_sample and gyro.output.average_samples; `fogbench budget \
             FILE` prints it",
        ),
    ),
    (
        &["loop_gain", "controller_gain", "integrator_gain"],
        Below(""),
        Key("gyro.controller.loop_bandwidth_hz"),
    ),
    (
        &["scale_factor"],
        Below(""),
        Advice(
            "the scale factor is no key: it follows from gyro.coil and gyro.source.wavelength_nm; \
             gyro.assembly.scale_factor_error_ppm sets its error",
        ),
    ),
    (
        &["turn", "number_turn", "winding_count"],
        Below("gyro.coil"),
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
        Below("filter[].rls"),
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
        Below("filter[].lms"),
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
        Below("filter[].moving_average"),
        Key("filter[].moving_average.taps"),
    ),
    (
        &["lambda", "alpha", "forgetting"],
        Below("filter[].rls"),
        Key("filter[].rls.forgetting_factor"),
    ),
    (
        &["delta", "initial_covariance"],
        Below("filter[].rls"),
        Key("filter[].rls.initial_inverse_correlation"),
    ),
    (
        &["mu", "step"],
        Below("filter[].lms"),
        Key("filter[].lms.step_size"),
    ),
    (
        &["mu", "step_size"],
        Below("filter[].sign_lms"),
        Key("filter[].sign_lms.step"),
    ),
    (
        &[
            "cutoff_frequency",
            "corner_frequency",
            "bandwidth",
            "frequency",
        ],
        Below("filter[].one_pole"),
        Key("filter[].one_pole.cutoff_hz"),
    ),
    (
        &[
            "cutoff_frequency",
            "corner_frequency",
            "bandwidth",
            "frequency",
        ],
        Below("filter[].butterworth"),
        Key("filter[].butterworth.cutoff_hz"),
    ),
    (
        &["kind", "type"],
        Below("filter[]"),
        Advice("the kind of a filter is the name of its table, as in [filter.rls]"),
    ),
    (
        &["motion", "profile", "kind", "type"],
        Below("turntable"),
        Advice("the motion is the name of its table, as in [turntable.swing]"),
    ),
    (
        &["channel"],
        Below("gate[]"),
        Advice("the channel stands before its metric, as in metric = \"raw.noise_std_deg_per_h\""),
    ),
    (
        &["limit", "upper", "below"],
        Below("gate[]"),
        Key("gate[].max"),
    ),
    (&["lower", "above"], Below("gate[]"), Key("gate[].min")),
];

impl Where {
    fn holds(self, schema_path: &str) -> bool {
        match self {
            Below(start) => schema_path.starts_with(start),
            In(tables) => tables.contains(&schema_path),
        }
    }
}

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
pub(in crate::scenario) fn meaning(schema_path: &str, name: &str) -> Option<Meaning> {
    let words = words_of(name);
    let mut rows = ROWS.iter().zip(row_words());
    let means = |(row, names): &(&Row, &Vec<Vec<String>>)| {
        row.1.holds(schema_path) && names.contains(&words)
    };
    rows.find(means).map(|((.., meaning), _)| *meaning)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::keys::schema::keys;

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
        assert!(found("gyro.noise", "arw").contains("gyro.noise.angle_random_walk"));
        assert!(found("gyro", "rrw").ends_with("rate_random_walk_deg_per_h_per_sqrt_h"));
        assert!(found("gyro.slow_noise", "BI").ends_with("bias_instability_deg_per_h"));
        assert!(found("filter[].lms", "mu").ends_with("step_size"));
        assert!(found("turntable", "mu").is_empty());
        assert!(found("", "sweep").contains("[matrix]"));
        // The drift of a source and the offset of a converter are not those of the rate.
        assert!(found("gyro", "drift").ends_with("rate_ramp_deg_per_h_per_h"));
        assert!(found("gyro.source", "drift_ppm").is_empty());
        assert!(found("gyro.adc", "offset").is_empty());
    }
}
