//! Allan deviations, the fit of noise terms, and what is made of them.

mod allan_coverage;
mod allan_curves;
mod gap_aware;
mod kalman_export;
mod known_answers_allan;
mod known_answers_allan_variants;
mod noise_fit_coverage;
mod noise_fit_judged;
mod pulse_words;
