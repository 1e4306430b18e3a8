//! The metrics a channel can have: name, unit, definition.
//!
//! `raw` is what a filter is given and compared with: the output of the gyro, or its compensated output
//! where there is a compensation.

use super::known_metric::{Applies, KnownMetric};

const fn any(
    name: &'static str,
    unit: &'static str,
    applies: Applies,
    definition: &'static str,
) -> KnownMetric {
    KnownMetric {
        name,
        unit,
        definition,
        applies,
        filters_only: false,
    }
}

const fn filter(
    name: &'static str,
    unit: &'static str,
    applies: Applies,
    definition: &'static str,
) -> KnownMetric {
    KnownMetric {
        name,
        unit,
        definition,
        applies,
        filters_only: true,
    }
}

const fn estimate(name: &'static str, unit: &'static str, definition: &'static str) -> KnownMetric {
    any(name, unit, Applies::Calibration, definition)
}

#[rustfmt::skip]
const CATALOGUE: &[KnownMetric] = &[
    any("angle_random_walk_deg_per_sqrt_h", "deg/sqrt(h)", Applies::Steady,
        "N of the fit to the overlapping Allan variance, N^2/tau"),
    any("bias_instability_deg_per_h", "deg/h", Applies::Steady,
        "B of the fit to the overlapping Allan variance, (0.664 B)^2: the flicker floor over 0.664"),
    any("rate_random_walk_deg_per_h_per_sqrt_h", "deg/h/sqrt(h)", Applies::Steady,
        "K of the fit to the overlapping Allan variance, K^2 tau/3"),
    any("rate_ramp_deg_per_h_per_h", "deg/h/h", Applies::Steady,
        "R of the fit to the overlapping Allan variance, R^2 tau^2/2"),
    any("quantisation_arcsec", "arcsec", Applies::Steady,
        "Q of the fit to the overlapping Allan variance, 3 Q^2/tau^2"),
    any("bias_stability_1s_deg_per_h", "deg/h", Applies::Steady,
        "standard deviation of non-overlapping 1 s means"),
    any("bias_stability_10s_deg_per_h", "deg/h", Applies::Steady,
        "standard deviation of non-overlapping 10 s means"),
    any("bias_stability_100s_deg_per_h", "deg/h", Applies::Steady,
        "standard deviation of non-overlapping 100 s means"),
    any("bias_stability_deg_per_h", "deg/h", Applies::Steady,
        "standard deviation of non-overlapping means over the scenario's bias_averaging_time_s"),
    any("bias_repeatability_deg_per_h", "deg/h", Applies::Steady,
        "standard deviation of the means of six repeats or more, each a start of its own"),
    any("mean_deg_per_h", "deg/h", Applies::Always,
        "mean over the record; in a swing the offset of the sine fit over whole cycles"),
    any("mean_error_deg_per_h", "deg/h", Applies::Always,
        "the mean minus that of the true rate"),
    any("minimum_deg_per_h", "deg/h", Applies::Always,
        "smallest sample of the record"),
    any("maximum_deg_per_h", "deg/h", Applies::Always,
        "largest sample of the record"),
    any("noise_std_deg_per_h", "deg/h", Applies::Separable,
        "standard deviation of the samples about the signal: mean, fitted sine, or settled rate"),
    any("lag1_correlation", "1", Applies::Separable,
        "correlation of neighbouring samples about the signal, autocovariance at lag 1 over lag 0"),
    filter("mean_ratio", "1", Applies::Always,
        "mean of the channel over the mean of raw"),
    filter("noise_gain", "1", Applies::Separable,
        "variance about the signal over that of raw"),
    filter("dc_gain", "1", Applies::Always,
        "response to a small added rate with the weight sequence of the unperturbed run replayed"),
    filter("dc_gain_adapted", "1", Applies::Always,
        "response to a small added rate present from the first sample, the filter free to adapt"),
    filter("dc_gain_predicted", "1", Applies::SteadyOrSwing,
        "sum of the Wiener weights for the second moments of the raw record, mean included"),
    filter("angle_random_walk_over_dc_gain_deg_per_sqrt_h", "deg/sqrt(h)", Applies::Steady,
        "angle random walk once the scale factor is restored"),
    filter("weight_noise_ratio", "1", Applies::Steady,
        "Allan deviation at averaging_time_s over DC gain times raw's: 1 when the weights stand still"),
    filter("bias_stability_over_dc_gain_deg_per_h", "deg/h", Applies::Steady,
        "bias stability once the scale factor is restored"),
    filter("noise_delay_bound_noise_gain", "1", Applies::SteadyOrSwing,
        "least noise gain any fixed filter of as many taps has at this delay with unit DC gain"),
    filter("noise_gain_over_bound", "1", Applies::SteadyOrSwing,
        "noise gain over that least one; below 1 the weights adapt or the signal is attenuated"),
    filter("delay_at_dc_ms", "ms", Applies::Steady,
        "delay at DC of the mean weights, register and latency included"),
    filter("delay_vs_raw_ms", "ms", Applies::Tones,
        "phase delay behind the raw channel at the swing frequency; of several sines the lowest"),
    any("delay_vs_truth_ms", "ms", Applies::Tones,
        "phase delay behind the true rate at the swing frequency; of several sines the lowest"),
    any("delay_vs_encoder_ms", "ms", Applies::Swing,
        "phase delay behind the rate implied by a sine fit of the encoder's angle"),
    filter("delay_predicted_ms", "ms", Applies::Swing,
        "phase delay of the Wiener weights behind raw at the swing frequency, register included"),
    any("delay_by_correlation_ms", "ms", Applies::Swing,
        "delay behind the true rate again, by the peak of their correlation: a check of the sine fit"),
    any("amplitude_ratio", "1", Applies::Tones,
        "fitted amplitude over raw's, for raw itself over the true rate's; of several sines the lowest"),
    any("bandwidth_hz", "Hz", Applies::MultiSine,
        "where the gain against the true rate first falls through 1/sqrt(2) of that of the lowest sine"),
    any("harmonic_distortion_percent", "%", Applies::Swing,
        "root sum of squares of harmonics 2 to 5 over the fundamental, noise power subtracted"),
    any("tracking_error_rms_deg_per_h", "deg/h", Applies::Moving,
        "root mean square difference from the true rate at the same stamps"),
    any("settling_time_s", "s", Applies::Steps,
        "time after the last step until the rate stays within max(1 % of the step, 5 sigma)"),
    filter("settled_gain", "1", Applies::Steps,
        "mean of the channel over that of raw in the last quarter after the last step"),
    filter("readaptation_time_s", "s", Applies::Onset,
        "time from the start of a motion until the gain stays within 1 % of what it teaches"),
    any("overshoot_percent", "%", Applies::Steps,
        "largest excess over the settled rate after the last step, of the step; 0 within the noise"),
    any("rise_time_s", "s", Applies::Steps,
        "time from 10 % to 90 % of the last step, linear between samples"),
    any("scale_factor_error_ppm", "ppm", Applies::Steps,
        "slope of the line through mean output against mean true rate of the settled dwells, minus 1"),
    any("scale_factor_nonlinearity_ppm", "ppm", Applies::Steps,
        "largest distance of a dwell from that line over the largest output (of full scale)"),
    any("scale_factor_nonlinearity_of_reading_ppm", "ppm", Applies::Steps,
        "largest distance of a dwell from that line over the line there (of reading)"),
    any("scale_factor_asymmetry_ppm", "ppm", Applies::Steps,
        "difference of the slopes of separate lines for the two senses over their mean"),
    any("scale_factor_repeatability_ppm", "ppm", Applies::Steps,
        "standard deviation of the scale factors of six repeats or more over their mean"),
    any("threshold_deg_per_h", "deg/h", Applies::Steps,
        "smallest input of the record from which on all give half of themselves, from zero input"),
    any("dead_band_deg_per_h", "deg/h", Applies::Steps,
        "sum of the smallest such inputs of both senses: where the output stays below half"),
    any("resolution_deg_per_h", "deg/h", Applies::Steps,
        "the same from the rate held most often: smallest answered increment"),
    any("diverged_at_s", "s", Applies::Always,
        "time at which the channel failed, from the start of the warm-up; absent if it did not"),
    filter("predicted_failure_s", "s", Applies::Pipeline,
        "time to failure ln(0.01/eps)/(1-alpha) of the gain-first update, in samples and s"),
    filter("clocks_per_sample", "1", Applies::Pipeline,
        "clocks from one accepted sample to the next, back to back, counted on the model"),
    filter("sample_period_us", "us", Applies::Pipeline,
        "time of these clocks"),
    filter("latency_us", "us", Applies::Pipeline,
        "from accepting a sample to its result, counted on the model"),
    filter("sample_rate_max_khz", "kHz", Applies::Pipeline,
        "largest sample rate the pipeline keeps up with, 1/sample_period_us"),
    filter("asymmetry_max", "1", Applies::Pipeline,
        "largest difference of mirrored elements of the inverse correlation matrix over its largest"),
    filter("smallest_pivot", "1", Applies::Pipeline,
        "smallest Cholesky pivot of that matrix over its largest diagonal element"),
    filter("condition_number", "1", Applies::Pipeline,
        "largest ratio of the extreme eigenvalues of that matrix"),
    estimate("bias_error_rms_deg_per_h", "deg/h",
        "root mean square error of the three biases that an estimator finds"),
    estimate("scale_factor_error_rms_ppm", "ppm",
        "root mean square error of the three scale factors that an estimator finds"),
    estimate("misalignment_error_rms_arcsec", "arcsec",
        "root mean square error of the six misalignments that an estimator finds"),
    estimate("normalised_error_squared", "1",
        "squared errors of the twelve parameters over their covariance, 12 if that tells all"),
    estimate("compensated_rate_error_deg_per_h", "deg/h",
        "largest error of the plan's rates compensated with the estimate, exact form"),
    estimate("plan_condition_number", "1",
        "largest condition number of the weighted rows of the three gyros"),
    estimate("rounding_loss_deg_per_h", "deg/h",
        "largest difference of a bias of the covariance recursion from its square-root form"),
];

/// Every metric a channel can have, in the order tables print them.
#[must_use]
pub fn known_metrics() -> &'static [KnownMetric] {
    CATALOGUE
}

/// The entry of a name.
pub(crate) fn find(name: &str) -> Option<&'static KnownMetric> {
    CATALOGUE.iter().find(|known| known.name == name)
}
