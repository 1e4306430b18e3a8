//! Every row of the table of inert keys: refused alone, accepted with its partner.

use std::fs;

use crate::scenario::check::inert_rules::rules;
use crate::scenario::{Resolved, ScenarioError, load_suite};

/// A key with a value that is not its default, what stands beside it, and what makes it act.
struct Case {
    key: &'static str,
    value: &'static str,
    beside: &'static str,
    partner: &'static str,
}

const fn case(
    key: &'static str,
    value: &'static str,
    beside: &'static str,
    partner: &'static str,
) -> Case {
    Case {
        key,
        value,
        beside,
        partner,
    }
}

const CAMPAIGN: &str = "turntable.calibration.axes = [\"x\", \"y\", \"z\"]\n\
                        turntable.calibration.rates_deg_per_s = [10.0, 10.0, 10.0]\n\
                        gyro.assembly = {}\n";
const ALL_ESTIMATORS: &str = "turntable.calibration.axes = [\"x\", \"y\", \"z\"]\n\
     turntable.calibration.rates_deg_per_s = [10.0, 10.0, 10.0]\ngyro.assembly = {}\n\
     calibration.estimators = [\"batch\", \"arls\", \"arls-covariance\", \"arls-temperature\"]\n";
const NO_FORGETTING: &str = "turntable.calibration.axes = [\"x\", \"y\", \"z\"]\n\
     turntable.calibration.rates_deg_per_s = [10.0, 10.0, 10.0]\ngyro.assembly = {}\n\
     calibration.estimators = [\"batch\"]\ncalibration.apply = \"batch\"\n";
const SWING: &str =
    "turntable.swing.frequency_hz = 5.0\nturntable.swing.rate_amplitude_deg_per_s = 1.0\n";
/// A walk as a data sheet states it, behind a converter that does not round.
const DATA_SHEET: &str = "gyro.noise.angle_random_walk_deg_per_sqrt_h = 0.005\ngyro.adc.bits = 0\n";
const STATIC: &str = "turntable.static = {}\n";
const AT_REFERENCE: &str = "gyro.thermal.reference_c = 25.0\ngyro.temperature.soak.temperature_c = 25.0\n\
                            gyro.thermal.self_heating_c = 0.0\n";
const WARMER: &str =
    "gyro.thermal.reference_c = 25.0\ngyro.temperature.soak.temperature_c = 30.0\n";
const RIPPLE: &str = "gyro.thermal.ripple_amplitude_c = 1.0\n";
const NO_ENCODER: &str = "";
const ENCODER: &str = "turntable.encoder.resolution_arcsec = 0.1\n";
const ENCODER_WITH_ERRORS: &str = "turntable.encoder.resolution_arcsec = 0.1\n\
     turntable.encoder.eccentricity_error_arcsec = 1.0\n\
     turntable.encoder.interpolation_error_arcsec = 1.0\n";
const SINE: &str = "gyro.vibration.sine.frequency_hz = 100.0\ngyro.vibration.intensity_per_g = 0.0\n\
     gyro.vibration.rate_error_deg_per_h_per_g = 0.0\n";
const RANDOM: &str = "gyro.vibration.random.from_hz = 100.0\ngyro.vibration.random.to_hz = 200.0\n\
     gyro.vibration.intensity_per_g = 0.0\ngyro.vibration.rate_error_deg_per_h_per_g = 0.0\n";
const BOTH_PSDS: &str = "gyro.vibration.random.from_hz = 100.0\ngyro.vibration.random.to_hz = 200.0\n\
     gyro.vibration.random.acceleration_psd_g2_per_hz = 0.001\n\
     gyro.vibration.random.rate_psd_deg2_per_s2_per_hz = 0.001\ngyro.vibration.intensity_per_g = 0.001\n";
const COHERENT: &str = "gyro.vibration.random.from_hz = 100.0\ngyro.vibration.random.to_hz = 200.0\n\
     gyro.vibration.random.acceleration_psd_g2_per_hz = 0.001\n\
     gyro.vibration.random.rate_psd_deg2_per_s2_per_hz = 0.001\ngyro.vibration.intensity_per_g = 0.001\n\
     gyro.vibration.random.coherent = true\n";
const FILTER: &str = "filter = [{ name = \"f\", rls = {} }]\n";

#[rustfmt::skip]
const CASES: &[Case] = &[
    case("bias_averaging_time_s", "0.5", SWING, STATIC),
    case("turntable.rotation.soft_start_s", "0.5", "turntable.rotation.rate_deg_per_s = 0.0\n",
        "turntable.rotation.rate_deg_per_s = 1.0\n"),
    case("turntable.trapezoid.rest_s", "0.25",
        "turntable.trapezoid.rate_deg_per_s = 1.0\nturntable.trapezoid.acceleration_deg_per_s2 = 10.0\n\
         turntable.trapezoid.hold_s = 1.0\nturntable.trapezoid.cycles = 1\nturntable.trapezoid.both_senses = false\n",
        "turntable.trapezoid.rate_deg_per_s = 1.0\nturntable.trapezoid.acceleration_deg_per_s2 = 10.0\n\
         turntable.trapezoid.hold_s = 1.0\nturntable.trapezoid.cycles = 2\n"),
    case("turntable.chirp.progression", "\"linear\"",
        "turntable.chirp.rate_amplitude_deg_per_s = 1.0\nturntable.chirp.start_frequency_hz = 1.0\n\
         turntable.chirp.end_frequency_hz = 1.0\nturntable.chirp.sweep_s = 5.0\n",
        "turntable.chirp.rate_amplitude_deg_per_s = 1.0\nturntable.chirp.start_frequency_hz = 1.0\n\
         turntable.chirp.end_frequency_hz = 2.0\nturntable.chirp.sweep_s = 5.0\n"),
    case("turntable.chirp.soft_stop_s", "0.25",
        "turntable.chirp.rate_amplitude_deg_per_s = 1.0\nturntable.chirp.start_frequency_hz = 1.0\n\
         turntable.chirp.end_frequency_hz = 2.0\nturntable.chirp.sweep_s = 20.0\n",
        "turntable.chirp.rate_amplitude_deg_per_s = 1.0\nturntable.chirp.start_frequency_hz = 1.0\n\
         turntable.chirp.end_frequency_hz = 2.0\nturntable.chirp.sweep_s = 5.0\n"),
    case("turntable.calibration.change_s", "33.0", CAMPAIGN,
        "turntable.calibration.axes = [\"x\", \"x\"]\nturntable.calibration.rates_deg_per_s = [10.0, 20.0]\n\
         gyro.assembly = {}\n"),
    case("turntable.calibration.remount_s", "33.0",
        "turntable.calibration.axes = [\"x\", \"x\"]\nturntable.calibration.rates_deg_per_s = [10.0, 20.0]\n\
         gyro.assembly = {}\n", CAMPAIGN),
    case("turntable.calibration.whole_turns", "false",
        "turntable.calibration.axes = [\"x\", \"y\"]\nturntable.calibration.rates_deg_per_s = [0.0, 0.0]\n\
         gyro.assembly = {}\n", CAMPAIGN),
    case("turntable.servo.second_order.natural_frequency_hz", "50.0",
        "turntable.static = {}\nturntable.servo.second_order.damping_ratio = 0.7\n",
        "turntable.rotation.rate_deg_per_s = 1.0\nturntable.servo.second_order.damping_ratio = 0.7\n"),
    case("turntable.servo.second_order.damping_ratio", "0.7",
        "turntable.static = {}\nturntable.servo.second_order.natural_frequency_hz = 50.0\n",
        "turntable.rotation.rate_deg_per_s = 1.0\nturntable.servo.second_order.natural_frequency_hz = 50.0\n"),
    case("turntable.servo.direct_drive.rate_feed_forward", "0.5", STATIC, SWING),
    case("turntable.servo.direct_drive.acceleration_feed_forward", "0.5", STATIC, SWING),
    case("turntable.servo.direct_drive.stribeck_rate_rad_per_s", "0.5",
        "turntable.servo.direct_drive.static_n_m = 0.01\nturntable.servo.direct_drive.coulomb_n_m = 0.01\n",
        "turntable.servo.direct_drive.static_n_m = 0.02\nturntable.servo.direct_drive.coulomb_n_m = 0.01\n"),
    case("turntable.servo.direct_drive.friction_smoothing_rad_per_s", "0.5",
        "turntable.servo.direct_drive.static_n_m = 0.0\nturntable.servo.direct_drive.coulomb_n_m = 0.0\n",
        "turntable.servo.direct_drive.static_n_m = 0.02\nturntable.servo.direct_drive.coulomb_n_m = 0.01\n"),
    case("turntable.servo.direct_drive.cogging_per_revolution", "99",
        "turntable.servo.direct_drive.cogging_n_m = 0.0\n", "turntable.servo.direct_drive.cogging_n_m = 0.01\n"),
    case("turntable.servo.direct_drive.unbalance_phase_deg", "33.0",
        "turntable.servo.direct_drive.unbalance_n_m = 0.0\n", "turntable.servo.direct_drive.unbalance_n_m = 0.01\n"),
    case("turntable.encoder.latency_us", "20.0", NO_ENCODER, ENCODER),
    case("turntable.encoder.eccentricity_error_arcsec", "2.0", NO_ENCODER, ENCODER),
    case("turntable.encoder.eccentricity_phase_deg", "33.0", ENCODER, ENCODER_WITH_ERRORS),
    case("turntable.encoder.interpolation_error_arcsec", "2.0", NO_ENCODER, ENCODER),
    case("turntable.encoder.interpolation_phase_deg", "33.0", ENCODER, ENCODER_WITH_ERRORS),
    case("turntable.encoder.lines_per_revolution", "99", ENCODER, ENCODER_WITH_ERRORS),
    case("turntable.site.axis_azimuth_deg", "33.0", "turntable.site.axis_elevation_deg = 90.0\n",
        "turntable.site.axis_elevation_deg = 45.0\n"),
    case("turntable.axis.wobble_harmonic", "2", "", "turntable.axis.wobble_arcsec = 1.0\n"),
    case("turntable.mounting.misalignment_azimuth_deg", "33.0", "",
        "turntable.mounting.misalignment_arcsec = 1.0\n"),
    case("turntable.mounting.start_angle_deg", "33.0", "", ENCODER),
    case("turntable.mounting.axis_along_table", "\"x\"", "", "gyro.assembly = {}\n"),
    case("gyro.source.power_uw", "1.5", DATA_SHEET, ""),
    case("gyro.detector.responsivity_a_per_w", "0.8", DATA_SHEET, "gyro.noise.angle_random_walk_deg_per_sqrt_h = 0.01\n"),
    case("gyro.noise.shot", "false", DATA_SHEET, ""),
    case("gyro.noise.thermal", "false", DATA_SHEET, ""),
    case("gyro.noise.amplifier", "false", DATA_SHEET, ""),
    case("gyro.noise.rin", "false", DATA_SHEET, ""),
    case("gyro.noise.technical_phase_urad_per_sqrt_hz", "2.0", DATA_SHEET, ""),
    case("gyro.source.linewidth_nm", "33.0", "gyro.noise.rin = false\n", "gyro.noise.rin = true\n"),
    case("gyro.source.polarisation_degree", "0.33", "gyro.noise.rin = false\n", "gyro.noise.rin = true\n"),
    case("gyro.modulator.cross_coupling_phase_deg", "33.0", "", "gyro.modulator.cross_coupling_urad = 1.0\n"),
    case("gyro.modulator.dither_interval_periods", "33", "", "gyro.modulator.dither_deg = 90.0\n"),
    case("gyro.modulator.intensity_modulation", "0.01", "",
        "gyro.detector.gate_spikes = false\ngyro.detector.gate_duty = 1.0\n\
         gyro.modulator.half_period_mismatch = 0.001\n"),
    case("gyro.detector.gate_spikes", "false", "gyro.detector.gate_duty = 1.0\n",
        "gyro.detector.gate_duty = 1.0\ngyro.modulator.half_period_mismatch = 0.001\n"),
    case("gyro.detector.dark_current_na", "33.0", "gyro.noise.shot = false\ngyro.adc.bits = 0\n",
        "gyro.noise.shot = true\ngyro.adc.bits = 0\n"),
    case("gyro.detector.transimpedance_kohm", "33.0",
        "gyro.noise.thermal = false\ngyro.noise.amplifier = false\ngyro.adc.bits = 0\n", "gyro.adc.bits = 14\n"),
    case("gyro.detector.post_gain", "3.3", "gyro.adc.bits = 0\n", "gyro.adc.bits = 14\n"),
    case("gyro.detector.voltage_noise_nv_per_sqrt_hz", "33.0", "gyro.noise.amplifier = false\n",
        "gyro.noise.amplifier = true\n"),
    case("gyro.detector.current_noise_pa_per_sqrt_hz", "33.0", "gyro.noise.amplifier = false\n",
        "gyro.noise.amplifier = true\n"),
    case("gyro.adc.range_v", "3.3", "gyro.adc.bits = 0\n", "gyro.adc.bits = 14\n"),
    case("gyro.adc.samples_per_half_period", "33", "gyro.adc.bits = 0\ngyro.noise.draw = \"combined\"\n",
        "gyro.adc.bits = 14\n"),
    case("gyro.controller.automatic_gain_control", "true", AT_REFERENCE, WARMER),
    case("gyro.noise.draw", "\"exact\"", "fidelity = \"rate\"\n", "fidelity = \"loop\"\n"),
    case("gyro.slow_noise.gauss_markov_correlation_time_s", "33.0", "",
        "gyro.slow_noise.gauss_markov_deg_per_h = 1.0\n"),
    case("gyro.vibration.intensity_per_g", "0.01", "",
        "gyro.vibration.sine.frequency_hz = 100.0\ngyro.vibration.sine.acceleration_g = 1.0\n"),
    case("gyro.vibration.rate_error_deg_per_h_per_g", "0.1", "",
        "gyro.vibration.sine.frequency_hz = 100.0\ngyro.vibration.sine.acceleration_g = 1.0\n"),
    case("gyro.vibration.sine.acceleration_g", "2.0", SINE,
        "gyro.vibration.sine.frequency_hz = 100.0\ngyro.vibration.intensity_per_g = 0.01\n"),
    case("gyro.vibration.sine.rate_phase_deg", "33.0",
        "gyro.vibration.sine.frequency_hz = 100.0\ngyro.vibration.sine.acceleration_g = 1.0\n\
         gyro.vibration.intensity_per_g = 0.01\n",
        "gyro.vibration.sine.frequency_hz = 100.0\ngyro.vibration.sine.rate_amplitude_deg_per_s = 1.0\n"),
    case("gyro.vibration.random.acceleration_psd_g2_per_hz", "0.001", RANDOM,
        "gyro.vibration.random.from_hz = 100.0\ngyro.vibration.random.to_hz = 200.0\n\
         gyro.vibration.intensity_per_g = 0.001\n"),
    case("gyro.vibration.random.coherent", "true",
        "gyro.vibration.random.from_hz = 100.0\ngyro.vibration.random.to_hz = 200.0\n\
         gyro.vibration.random.acceleration_psd_g2_per_hz = 0.0\n\
         gyro.vibration.random.rate_psd_deg2_per_s2_per_hz = 0.001\n", BOTH_PSDS),
    case("gyro.vibration.random.rate_phase_deg", "33.0", BOTH_PSDS, COHERENT),
    case("gyro.output.rate_lsb_deg_per_s", "0.01", "gyro.output.quantisation = \"angle-carry\"\n",
        "gyro.output.quantisation = \"rate-word\"\n"),
    case("gyro.output.angle_lsb_arcsec", "0.5", "gyro.output.quantisation = \"rate-word\"\n",
        "gyro.output.quantisation = \"angle-carry\"\n"),
    case("gyro.assembly.bias_deg_per_h_per_k", "[1.0, 1.0, 1.0]", AT_REFERENCE, WARMER),
    case("gyro.assembly.scale_factor_ppm_per_k", "[1.0, 1.0, 1.0]", AT_REFERENCE, WARMER),
    case("gyro.thermal.ripple_period_s", "33.0", "", RIPPLE),
    case("gyro.thermal.warm_up", "\"cold\"", "gyro.thermal.self_heating_c = 0.0\n",
        "gyro.thermal.self_heating_c = 5.0\n"),
    case("gyro.thermal.case_time_constant_s", "33.0", AT_REFERENCE, RIPPLE),
    case("gyro.thermal.outer_time_constant_s", "33.0", AT_REFERENCE, RIPPLE),
    case("gyro.thermal.inner_time_constant_s", "33.0", AT_REFERENCE, RIPPLE),
    case("gyro.thermal.winding", "\"plain\"", AT_REFERENCE, RIPPLE),
    case("gyro.thermal.layers", "44", AT_REFERENCE, RIPPLE),
    case("gyro.thermal.midpoint_offset_m", "3.3", AT_REFERENCE, RIPPLE),
    case("gyro.thermal.index_per_k", "3e-6", AT_REFERENCE, RIPPLE),
    case("gyro.thermal.length_ppm_per_k", "3.3", AT_REFERENCE, WARMER),
    case("gyro.thermal.diameter_ppm_per_k", "3.3", AT_REFERENCE, WARMER),
    case("gyro.thermal.wavelength_nm_per_k", "0.33", AT_REFERENCE,
        "gyro.temperature.soak.temperature_c = 30.0\ngyro.thermal.wavelength_feed_through = 0.1\n"),
    case("gyro.thermal.wavelength_feed_through", "0.33", AT_REFERENCE,
        "gyro.temperature.soak.temperature_c = 30.0\ngyro.thermal.wavelength_nm_per_k = 0.1\n"),
    case("gyro.thermal.compensation_ppm_per_k", "3.3", AT_REFERENCE, WARMER),
    case("gyro.thermal.compensation_ppm_per_k2", "0.33", AT_REFERENCE, WARMER),
    case("gyro.thermal.bias_deg_per_h_per_k", "0.33", AT_REFERENCE, WARMER),
    case("gyro.thermal.bias_deg_per_h_per_k2", "0.033", AT_REFERENCE, WARMER),
    case("gyro.thermal.bias_deg_per_h_per_c_per_min", "0.33", AT_REFERENCE, RIPPLE),
    case("gyro.thermal.half_wave_voltage_ppm_per_k", "33.0", AT_REFERENCE, WARMER),
    case("gyro.thermal.power.quadratic.cold_c", "-33.0", AT_REFERENCE, WARMER),
    case("gyro.thermal.power.quadratic.cold_ratio", "0.33", AT_REFERENCE, WARMER),
    case("gyro.thermal.power.quadratic.hot_c", "77.0", AT_REFERENCE, WARMER),
    case("gyro.thermal.power.quadratic.hot_ratio", "0.33", AT_REFERENCE, WARMER),
    case("gyro.thermal.power.exponential.fall_k", "333.0", AT_REFERENCE, WARMER),
    case("compensation.parameters.reference_temperature_c", "[1.0, 1.0, 1.0]", "gyro.assembly = {}\n",
        "gyro.assembly = {}\ncompensation.parameters.bias_deg_per_h_per_k = [1.0, 1.0, 1.0]\n"),
    case("calibration.estimators", "[\"arls\"]", "", CAMPAIGN),
    case("calibration.apply", "\"batch\"", "", CAMPAIGN),
    case("calibration.forgetting_form", "\"linear\"", NO_FORGETTING, ALL_ESTIMATORS),
    case("calibration.forgetting_constant_per_k", "0.0333", NO_FORGETTING, ALL_ESTIMATORS),
    case("calibration.forgetting_constant_with_temperature_per_k", "0.0333", NO_FORGETTING, ALL_ESTIMATORS),
    case("calibration.initial_covariance", "333.0", NO_FORGETTING, ALL_ESTIMATORS),
    case("calibration.outlier_threshold", "3.3", "", CAMPAIGN),
    case("filter[].rls.number_format", "\"binary32\"", "", "pipeline = \"fpga\""),
    case("filter[].rls.clock_mhz", "41.0", "", "pipeline = \"fpga\""),
    case("filter[].rls.division", "\"elementwise\"", "", "pipeline = \"fpga\""),
    case("filter[].rls.update_order", "\"gain-first\"", "", "pipeline = \"fpga\""),
    case("filter[].rls.fixed", "{ word_bits = 40 }", "pipeline = \"fpga\"",
        "pipeline = \"fpga\", number_format = \"fixed\", initial_inverse_correlation = 1e-5"),
    case("filter[].lms.regularisation_deg2_per_h2", "3.3", "normalised = false, step_size = 1e-9",
        "normalised = true"),
    case("filter[].lms.allow_unstable", "true", "normalised = true", "normalised = false, step_size = 1e-9"),
    case("filter[].lms.number_format", "\"binary32\"", "", "pipeline = \"fpga\""),
    case("filter[].lms.clock_mhz", "41.0", "", "pipeline = \"fpga\""),
    case("filter[].lms.fixed", "{ word_bits = 40 }", "pipeline = \"fpga\"",
        "pipeline = \"fpga\", number_format = \"fixed\""),
    case("filter[].sign_lms.number_format", "\"binary32\"", "", "pipeline = \"fpga\""),
    case("filter[].sign_lms.clock_mhz", "41.0", "", "pipeline = \"fpga\""),
    case("filter[].sign_lms.norm_recompute_samples", "33", "pipeline = \"fpga\", number_format = \"fixed\"",
        "pipeline = \"fpga\""),
    case("filter[].sign_lms.fixed", "{ word_bits = 40 }", "pipeline = \"fpga\"",
        "pipeline = \"fpga\", number_format = \"fixed\""),
    case("allan.estimator", "\"hadamard\"", SWING, STATIC),
    case("allan.averaging_times", "\"decade\"", SWING, STATIC),
    case("trial.rate_gain", "true", "", FILTER),
    case("trial.black_box", "\"brief\"", "", FILTER),
    case("trial.filter_state", "\"reset\"", FILTER,
        "turntable.steps.rates_deg_per_s = [0.0, 1.0]\nturntable.steps.dwell_s = 5.0\n\
         filter = [{ name = \"f\", rls = {} }]\n"),
    case("gate[].inconclusive", "\"allow\"", "decide = \"value\"", "decide = \"interval\""),
];

impl Case {
    /// The lines of a file in which the key stands beside others.
    fn text(&self, beside: &str) -> String {
        let least = |duration_s: &str| format!("name = \"x\"\nduration_s = {duration_s}\n");
        let rest = self.key.split_once("[].");
        match rest {
            Some(("filter", rest)) => {
                let (kind, name) = rest.split_once('.').unwrap();
                let more = if beside.is_empty() {
                    String::new()
                } else {
                    format!(", {beside}")
                };
                let line = format!(
                    "filter = [{{ name = \"f\", {kind} = {{ {name} = {}{more} }} }}]\n",
                    self.value
                );
                least("20.0") + &line
            }
            Some((_, name)) => {
                let gate = "metric = \"raw.mean_deg_per_h\", max = 1e9";
                let line = format!("gate = [{{ {gate}, {name} = {}, {beside} }}]\n", self.value);
                least("20.0") + &line
            }
            None => {
                let is_long = beside.contains("calibration.axes");
                let text = least(if is_long { "1e5" } else { "20.0" });
                format!("{text}{beside}{} = {}\n", self.key, self.value)
            }
        }
    }
}

/// Loads `x.toml` beside other files.
pub(in crate::scenario) fn load(
    text: &str,
    base: &str,
    sets: &[&str],
) -> Result<Vec<Resolved>, Vec<ScenarioError>> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("base.toml"), base).unwrap();
    let file = folder.path().join("x.toml");
    fs::write(&file, text).unwrap();
    let sets: Vec<String> = sets.iter().map(|&set| set.to_owned()).collect();
    load_suite(&[file], &sets)
}

/// The complaints that a key has no effect.
pub(in crate::scenario) fn idle(text: &str, base: &str, sets: &[&str]) -> Vec<String> {
    let errors = load(text, base, sets).err().unwrap_or_default();
    let texts = errors.iter().map(|error| error.message.clone());
    texts
        .filter(|text| text.contains("has no effect") || text.contains("without effect"))
        .collect()
}

fn shown(key: &str) -> String {
    key.replace("[]", "[0]")
}

#[test]
fn every_row_is_refused_alone_and_accepted_with_its_partner() {
    let mut wrong = Vec::new();
    for rule in rules() {
        let Some(case) = CASES.iter().find(|case| case.key == rule.path) else {
            wrong.push(format!("{} has no case", rule.path));
            continue;
        };
        let key = shown(case.key);
        let alone = case.text(case.beside);
        let said = idle(&alone, "", &[]);
        if !said
            .iter()
            .any(|text| text.starts_with(&format!("{key} = ")))
        {
            wrong.push(format!("{key} alone: {said:?}\n{alone}"));
        }
        let together = case.text(case.partner);
        if let Err(errors) = load(&together, "", &[]) {
            wrong.push(format!("{key} with its partner: {errors:?}\n{together}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_eq!(CASES.len(), rules().len());
}

#[test]
fn constants_of_the_sources_are_refused_beside_the_walk_of_a_data_sheet() {
    for (key, value) in [
        ("gyro.source.linewidth_nm", "33.0"),
        ("gyro.source.polarisation_degree", "0.33"),
        ("gyro.detector.dark_current_na", "33.0"),
        ("gyro.detector.transimpedance_kohm", "33.0"),
        ("gyro.detector.voltage_noise_nv_per_sqrt_hz", "33.0"),
        ("gyro.detector.current_noise_pa_per_sqrt_hz", "33.0"),
    ] {
        let text = case(key, value, DATA_SHEET, "").text(DATA_SHEET);
        let said = idle(&text, "", &[]);
        let names_it = said.iter().any(|text| {
            text.starts_with(&format!("{key} = "))
                && text.contains("angle_random_walk_deg_per_sqrt_h")
        });
        assert!(names_it, "{key}: {said:?}");
    }
}

#[test]
fn inherited_keys_defaults_and_records_are_never_refused() {
    for case in CASES {
        let base = case.text(case.beside).replace("name = \"x\"\n", "");
        let own = "name = \"x\"\nextends = \"base.toml\"\n";
        let run = match load(own, &base, &[]) {
            Ok(mut runs) => runs.remove(0),
            // A few stand beside contradictions of their own.
            Err(errors) => panic!("{}: {errors:?}", case.key),
        };
        let manifest = crate::scenario::manifest_toml(&run, env!("CARGO_PKG_VERSION"), "unknown");
        assert!(
            load(&manifest, "", &[]).is_ok(),
            "{} in a manifest",
            case.key
        );
        assert!(
            load(&run.to_toml(), "", &[]).is_ok(),
            "{} as expand prints it",
            case.key
        );
    }
    // What the default says asks for nothing.
    let text = "name = \"x\"\nduration_s = 20.0\ncalibration.apply = \"arls\"\n";
    let default = crate::scenario::CalibrationConfig::reference().apply.word();
    assert_eq!(
        idle(&text.replace("arls", default), "", &[]),
        Vec::<String>::new()
    );
}
