//! Columns of the curves, by the room that measures them.

/// Columns of the Allan curves.
pub mod allan {
    pub use crate::metrics::allan::curves::{
        COUNT, DEVIATION, ESTIMATOR, FITTED, FREEDOM, HIGH, LOW, NOISE, NOISE_ALPHA,
        NOISE_IDENTIFIED, TAU,
    };
}

/// Columns of the autocovariance.
pub mod autocovariance {
    pub use crate::metrics::noise::autocovariance::{LAG, PRODUCT};
}

/// Columns of the spectrum.
pub mod spectrum {
    pub use crate::metrics::noise::spectrum::{DENSITY, FREQUENCY, TWO_SIDED_DENSITY};
}

/// Columns of the curves over the rates of a staircase.
pub mod staircase {
    pub use crate::metrics::steps::staircase::{
        ERROR, ERROR_HIGH, ERROR_LOW, INPUT, MEAN_OUTPUT, MEASURED, OUTPUT, RESIDUAL,
        RESIDUAL_HIGH, RESIDUAL_LOW, RESIDUAL_OF_READING, RESIDUAL_OF_READING_HIGH,
        RESIDUAL_OF_READING_LOW, TURNS, WHOLE_TURNS,
    };
}

/// Columns of the means over a temperature.
pub mod temperature {
    pub use crate::metrics::temperature::keys::{BIAS, FITTED, LEFT, RATE, TEMPERATURE_C, TIME};
}

/// Columns of the responses over the frequency.
pub mod tones {
    pub use crate::metrics::sine::tones::{
        DELAY, DELAY_HIGH, DELAY_LOW, FREQUENCY, GAIN, GAIN_HIGH, GAIN_LOW, PHASE, PHASE_HIGH,
        PHASE_LOW,
    };
}

/// Columns of the noise-delay bound.
pub mod noise_delay {
    pub use crate::metrics::trial::noise_delay::{DELAY, LEAST_NOISE_GAIN, LEAST_WHITE_NOISE_GAIN};
}

/// Columns of the gain over the rate.
pub mod rate_gain {
    pub use crate::metrics::trial::rate_gain::{
        GAIN, GAIN_HIGH, GAIN_LOW, MEAN_RATIO, MEAN_RATIO_HIGH, MEAN_RATIO_LOW, RATE,
    };
}
