//! When each key acts: the table of keys that others can leave without effect.
//!
//! A key that is not here acts in every run. A condition that only a run could find out, such as a
//! limit that the motion never reaches, is none.

use std::sync::OnceLock;

use crate::filters::conditional_keys;
use crate::gyro::Fidelity;
use crate::gyro::VibrationMotion;
use crate::gyro::{NoiseDraw, OutputQuantisation};
use crate::gyro::{PowerConfig, TemperatureConfig, ThermalWarmUp};
use crate::scenario::config::{GateConfig, GateDecision, Scenario};
use crate::scenario::keys::schema::keys;
use crate::turntable::{MotionClass, ServoConfig};
use crate::vocabulary::EstimatorKind;

/// The condition under which a key acts.
#[derive(Clone, Copy)]
pub(in crate::scenario) enum Acts {
    /// One of the run as a whole.
    Run(fn(&Scenario) -> bool),
    /// One of the motion whose key it is.
    Motion,
    /// One of the filter whose key it is: the kind, which knows, and the name of the key.
    Filter(&'static str, &'static str),
    /// One of the gate whose key it is.
    Gate(fn(&GateConfig) -> bool),
}

/// A key that does not always act.
#[derive(Clone, Copy)]
pub(in crate::scenario) struct Rule {
    /// Its schema path.
    pub(in crate::scenario) path: &'static str,
    /// When it acts.
    pub(in crate::scenario) acts: Acts,
    /// What must be set for it to act; a reason, where it helps, stands before it with a semicolon.
    pub(in crate::scenario) needs: &'static str,
}

const fn run(path: &'static str, needs: &'static str, acts: fn(&Scenario) -> bool) -> Rule {
    Rule {
        path,
        acts: Acts::Run(acts),
        needs,
    }
}

/// A key of a motion, which knows itself when it acts.
const fn motion(path: &'static str, needs: &'static str) -> Rule {
    Rule {
        path,
        acts: Acts::Motion,
        needs,
    }
}

const ENCODER: &str = "the table has no encoder; turntable.encoder.resolution_arcsec (0.0 for one that \
                       does not round)";
const CAMPAIGN: &str = "the motion [turntable.calibration]";
const RECURSION: &str = "\"arls\" or \"arls-covariance\" among calibration.estimators or as \
                         calibration.apply";
const ACCELERATION: &str = "gyro.vibration.sine.acceleration_g or \
                            gyro.vibration.random.acceleration_psd_g2_per_hz above 0";
const SENSITIVE: &str = "gyro.vibration.intensity_per_g or gyro.vibration.rate_error_deg_per_h_per_g \
                         other than 0";
const CHANGE: &str = "a temperature that changes: gyro.temperature.ramp, gyro.temperature.profile, \
                      gyro.thermal.ripple_amplitude_c above 0, or gyro.thermal.warm_up = \"cold\" with \
                      self_heating_c above 0";
const EXPANDING: &str = "a temperature that changes (gyro.temperature.ramp or profile, \
                         gyro.thermal.ripple_amplitude_c, warm_up = \"cold\") and a fibre whose phase \
                         follows it (gyro.thermal.index_per_k or length_ppm_per_k other than 0)";
const DEPARTURE: &str = "a temperature other than gyro.thermal.reference_c: gyro.temperature or \
                         gyro.thermal.self_heating_c";
/// Why a source of noise does not act.
const REPLACED: &str = "gyro.noise.angle_random_walk_deg_per_sqrt_h stands in the place of the sources of noise; \
                        the sources instead of it";
const LIGHT: &str = "no gyro.noise.angle_random_walk_deg_per_sqrt_h, or with gyro.adc.bits above 0";
const RIN: &str = "gyro.noise.rin = true and no gyro.noise.angle_random_walk_deg_per_sqrt_h";
const AMPLIFIER: &str =
    "gyro.noise.amplifier = true and no gyro.noise.angle_random_walk_deg_per_sqrt_h";
const STEADY: &str = "a steady motion, [turntable.static] or [turntable.rotation]";
const TURNING: &str = "a motion other than [turntable.static]";

/// Every key that does not always act.
#[rustfmt::skip]
const RULES: &[Rule] = &[
    run("bias_averaging_time_s", STEADY, is_steady),
    motion("turntable.rotation.soft_start_s", "turntable.rotation.rate_deg_per_s other than 0"),
    motion("turntable.trapezoid.rest_s", "turntable.trapezoid.cycles above 1 or both_senses = true"),
    motion("turntable.chirp.progression", "start and end frequencies that differ"),
    motion("turntable.chirp.soft_stop_s", "duration_s beyond turntable.chirp.sweep_s"),
    motion("turntable.calibration.change_s", "two groups in a row of one axis in turntable.calibration.axes"),
    motion("turntable.calibration.remount_s", "different axes in turntable.calibration.axes"),
    motion("turntable.calibration.whole_turns", "a group that turns in turntable.calibration.rates_deg_per_s"),
    run("turntable.servo.second_order.natural_frequency_hz", TURNING, is_turning),
    run("turntable.servo.second_order.damping_ratio", TURNING, is_turning),
    run("turntable.servo.direct_drive.rate_feed_forward", TURNING, is_turning),
    run("turntable.servo.direct_drive.acceleration_feed_forward", TURNING, is_turning),
    run("turntable.servo.direct_drive.stribeck_rate_rad_per_s",
        "turntable.servo.direct_drive.static_n_m above coulomb_n_m",
        |s| !matches!(&s.turntable.servo, ServoConfig::DirectDrive(servo)
            if servo.static_n_m <= servo.coulomb_n_m)),
    run("turntable.servo.direct_drive.friction_smoothing_rad_per_s",
        "turntable.servo.direct_drive.static_n_m above 0",
        |s| !matches!(&s.turntable.servo, ServoConfig::DirectDrive(servo) if servo.static_n_m <= 0.0)),
    run("turntable.servo.direct_drive.cogging_per_revolution",
        "turntable.servo.direct_drive.cogging_n_m above 0",
        |s| !matches!(&s.turntable.servo, ServoConfig::DirectDrive(servo) if servo.cogging_n_m <= 0.0)),
    run("turntable.servo.direct_drive.unbalance_phase_deg",
        "turntable.servo.direct_drive.unbalance_n_m above 0",
        |s| !matches!(&s.turntable.servo, ServoConfig::DirectDrive(servo) if servo.unbalance_n_m <= 0.0)),
    run("turntable.encoder.latency_us", ENCODER, has_encoder),
    run("turntable.encoder.eccentricity_error_arcsec", ENCODER, has_encoder),
    run("turntable.encoder.eccentricity_phase_deg",
        "an encoder (turntable.encoder.resolution_arcsec) with eccentricity_error_arcsec above 0",
        |s| has_encoder(s) && s.turntable.encoder.eccentricity_error_arcsec > 0.0),
    run("turntable.encoder.interpolation_error_arcsec", ENCODER, has_encoder),
    run("turntable.encoder.interpolation_phase_deg",
        "an encoder (turntable.encoder.resolution_arcsec) with interpolation_error_arcsec above 0",
        |s| has_encoder(s) && s.turntable.encoder.interpolation_error_arcsec > 0.0),
    run("turntable.encoder.lines_per_revolution",
        "an encoder (turntable.encoder.resolution_arcsec) with interpolation_error_arcsec above 0",
        |s| has_encoder(s) && s.turntable.encoder.interpolation_error_arcsec > 0.0),
    run("turntable.site.axis_azimuth_deg",
        "turntable.site.axis_elevation_deg other than 90 or -90, a gyro that leans \
         (turntable.mounting.misalignment_arcsec, turntable.axis.wobble_arcsec) or gyro.assembly",
        |s| s.turntable.site.axis_elevation_deg.abs() < 90.0 || is_leaning(s)),
    run("turntable.axis.wobble_harmonic", "turntable.axis.wobble_arcsec above 0",
        |s| s.turntable.axis.wobble_arcsec > 0.0),
    run("turntable.mounting.misalignment_azimuth_deg", "turntable.mounting.misalignment_arcsec above 0",
        |s| s.turntable.mounting.misalignment_arcsec > 0.0),
    run("turntable.mounting.start_angle_deg",
        "a gyro that leans (turntable.mounting.misalignment_arcsec, turntable.axis.wobble_arcsec), \
         gyro.assembly, an encoder (turntable.encoder.resolution_arcsec) or \
         turntable.servo.direct_drive",
        |s| is_leaning(s) || has_encoder(s) || matches!(s.turntable.servo, ServoConfig::DirectDrive(_))),
    run("turntable.mounting.axis_along_table",
        "gyro.assembly and a motion other than [turntable.calibration], whose axes say it for each group",
        |s| s.gyro.assembly.is_some() && !is_campaign(s)),
    run("gyro.source.power_uw", LIGHT, |s| is_by_source(s) || s.gyro.adc.bits > 0),
    run("gyro.source.linewidth_nm", RIN, |s| s.gyro.noise.rin && is_by_source(s)),
    run("gyro.source.polarisation_degree", RIN, |s| s.gyro.noise.rin && is_by_source(s)),
    run("gyro.detector.responsivity_a_per_w", LIGHT, |s| is_by_source(s) || s.gyro.adc.bits > 0),
    run("gyro.modulator.cross_coupling_phase_deg", "gyro.modulator.cross_coupling_urad above 0",
        |s| s.gyro.modulator.cross_coupling_urad > 0.0),
    run("gyro.modulator.dither_interval_periods", "gyro.modulator.dither_deg above 0",
        |s| s.gyro.modulator.dither_deg > 0.0),
    run("gyro.modulator.intensity_modulation",
        "gyro.detector.gate_spikes = false and gyro.modulator.half_period_mismatch other than 0",
        |s| !s.gyro.detector.gate_spikes && !is_zero(s.gyro.modulator.half_period_mismatch)),
    run("gyro.detector.gate_spikes", "gyro.modulator.half_period_mismatch other than 0",
        |s| !is_zero(s.gyro.modulator.half_period_mismatch)),
    run("gyro.detector.dark_current_na",
        "gyro.noise.shot = true and no gyro.noise.angle_random_walk_deg_per_sqrt_h, or gyro.adc.bits above 0",
        |s| s.gyro.noise.shot && is_by_source(s) || s.gyro.adc.bits > 0),
    run("gyro.detector.transimpedance_kohm",
        "gyro.noise.thermal or gyro.noise.amplifier = true and no \
         gyro.noise.angle_random_walk_deg_per_sqrt_h, or gyro.adc.bits above 0",
        |s| (s.gyro.noise.thermal || s.gyro.noise.amplifier) && is_by_source(s) || s.gyro.adc.bits > 0),
    run("gyro.detector.post_gain", "gyro.adc.bits above 0", |s| s.gyro.adc.bits > 0),
    run("gyro.detector.voltage_noise_nv_per_sqrt_hz", AMPLIFIER,
        |s| s.gyro.noise.amplifier && is_by_source(s)),
    run("gyro.detector.current_noise_pa_per_sqrt_hz", AMPLIFIER,
        |s| s.gyro.noise.amplifier && is_by_source(s)),
    run("gyro.adc.range_v", "gyro.adc.bits above 0", |s| s.gyro.adc.bits > 0),
    run("gyro.adc.samples_per_half_period", "gyro.adc.bits above 0 or gyro.noise.draw = \"exact\"",
        |s| s.gyro.adc.bits > 0 || s.gyro.noise.draw == NoiseDraw::Exact),
    run("gyro.controller.automatic_gain_control",
        "a detected power that changes: a temperature other than gyro.thermal.reference_c and \
         gyro.thermal.power other than constant",
        |s| departs(s) && !matches!(s.gyro.thermal.power, PowerConfig::Constant(_))),
    run("gyro.noise.shot", REPLACED, is_by_source),
    run("gyro.noise.thermal", REPLACED, is_by_source),
    run("gyro.noise.amplifier", REPLACED, is_by_source),
    run("gyro.noise.rin", REPLACED, is_by_source),
    run("gyro.noise.technical_phase_urad_per_sqrt_hz", REPLACED, is_by_source),
    run("gyro.noise.draw", "fidelity = \"loop\"", |s| s.fidelity == Fidelity::Loop),
    run("gyro.slow_noise.gauss_markov_correlation_time_s", "gyro.slow_noise.gauss_markov_deg_per_h above 0",
        |s| s.gyro.slow_noise.gauss_markov_deg_per_h > 0.0),
    run("gyro.vibration.intensity_per_g", ACCELERATION, is_accelerated),
    run("gyro.vibration.rate_error_deg_per_h_per_g", ACCELERATION, is_accelerated),
    run("gyro.vibration.sine.acceleration_g", SENSITIVE, is_sensitive),
    run("gyro.vibration.sine.rate_phase_deg", "gyro.vibration.sine.rate_amplitude_deg_per_s above 0",
        |s| !matches!(&s.gyro.vibration.motion, VibrationMotion::Sine(sine)
            if sine.rate_amplitude_deg_per_s <= 0.0)),
    run("gyro.vibration.random.acceleration_psd_g2_per_hz", SENSITIVE, is_sensitive),
    run("gyro.vibration.random.coherent",
        "gyro.vibration.random.acceleration_psd_g2_per_hz and rate_psd_deg2_per_s2_per_hz above 0",
        |s| !matches!(&s.gyro.vibration.motion, VibrationMotion::Random(random)
            if random.rate_psd_deg2_per_s2_per_hz <= 0.0 || random.acceleration_psd_g2_per_hz <= 0.0)),
    run("gyro.vibration.random.rate_phase_deg",
        "the rate has no fixed phase to the acceleration; gyro.vibration.random.coherent = true and \
         rate_psd_deg2_per_s2_per_hz above 0",
        |s| !matches!(&s.gyro.vibration.motion, VibrationMotion::Random(random)
            if !random.coherent || random.rate_psd_deg2_per_s2_per_hz <= 0.0)),
    run("gyro.output.rate_lsb_deg_per_s",
        "quantisation = \"angle-carry\" does not read it; gyro.output.quantisation = \"rate-word\"",
        |s| s.gyro.output.quantisation == OutputQuantisation::RateWord),
    run("gyro.output.angle_lsb_arcsec",
        "quantisation = \"rate-word\" does not read it; gyro.output.quantisation = \"angle-carry\"",
        |s| s.gyro.output.quantisation == OutputQuantisation::AngleCarry),
    run("gyro.assembly.bias_deg_per_h_per_k", DEPARTURE, departs),
    run("gyro.assembly.scale_factor_ppm_per_k", DEPARTURE, departs),
    run("gyro.thermal.ripple_period_s", "gyro.thermal.ripple_amplitude_c above 0",
        |s| s.gyro.thermal.ripple_amplitude_c > 0.0),
    run("gyro.thermal.warm_up", "there is nothing to warm up; gyro.thermal.self_heating_c above 0",
        |s| s.gyro.thermal.self_heating_c > 0.0),
    run("gyro.thermal.case_time_constant_s", CHANGE, changes),
    run("gyro.thermal.outer_time_constant_s", CHANGE, changes),
    run("gyro.thermal.inner_time_constant_s", CHANGE, changes),
    run("gyro.thermal.winding", EXPANDING, |s| changes(s) && follows_temperature(s)),
    run("gyro.thermal.layers", EXPANDING, |s| changes(s) && follows_temperature(s)),
    run("gyro.thermal.midpoint_offset_m", EXPANDING, |s| changes(s) && follows_temperature(s)),
    run("gyro.thermal.index_per_k", CHANGE, changes),
    run("gyro.thermal.length_ppm_per_k", DEPARTURE, departs),
    run("gyro.thermal.diameter_ppm_per_k", DEPARTURE, departs),
    run("gyro.thermal.wavelength_nm_per_k",
        "gyro.thermal.wavelength_feed_through above 0 and a temperature other than \
         gyro.thermal.reference_c",
        |s| departs(s) && s.gyro.thermal.wavelength_feed_through > 0.0),
    run("gyro.thermal.wavelength_feed_through",
        "gyro.thermal.wavelength_nm_per_k other than 0 and a temperature other than \
         gyro.thermal.reference_c",
        |s| departs(s) && !is_zero(s.gyro.thermal.wavelength_nm_per_k)),
    run("gyro.thermal.compensation_ppm_per_k", DEPARTURE, departs),
    run("gyro.thermal.compensation_ppm_per_k2", DEPARTURE, departs),
    run("gyro.thermal.bias_deg_per_h_per_k", DEPARTURE, departs),
    run("gyro.thermal.bias_deg_per_h_per_k2", DEPARTURE, departs),
    run("gyro.thermal.bias_deg_per_h_per_c_per_min", CHANGE, changes),
    run("gyro.thermal.half_wave_voltage_ppm_per_k", DEPARTURE, departs),
    run("gyro.thermal.power.quadratic.cold_c", DEPARTURE, departs),
    run("gyro.thermal.power.quadratic.cold_ratio", DEPARTURE, departs),
    run("gyro.thermal.power.quadratic.hot_c", DEPARTURE, departs),
    run("gyro.thermal.power.quadratic.hot_ratio", DEPARTURE, departs),
    run("gyro.thermal.power.exponential.fall_k", DEPARTURE, departs),
    run("compensation.parameters.reference_temperature_c",
        "a coefficient of the temperature in [compensation.parameters] other than 0",
        |s| s.compensation.as_ref().and_then(|one| one.parameters.as_ref()).is_none_or(|parameters| {
            let coefficients = [
                parameters.bias_deg_per_h_per_k,
                parameters.bias_deg_per_h_per_k2,
                parameters.bias_deg_per_h_per_k_per_min,
                parameters.scale_factor_ppm_per_k,
            ];
            coefficients.as_flattened().iter().any(|coefficient| !is_zero(*coefficient))
        })),
    run("calibration.estimators", CAMPAIGN, is_campaign),
    run("calibration.apply", CAMPAIGN, is_campaign),
    run("calibration.forgetting_form",
        "the motion [turntable.calibration] and an estimator that forgets (\"arls\", \
         \"arls-covariance\", \"arls-temperature\")",
        |s| runs_any(s, &[EstimatorKind::Arls, EstimatorKind::ArlsCovariance, EstimatorKind::ArlsTemperature])),
    run("calibration.forgetting_constant_per_k", RECURSION,
        |s| runs_any(s, &[EstimatorKind::Arls, EstimatorKind::ArlsCovariance])),
    run("calibration.forgetting_constant_with_temperature_per_k",
        "\"arls-temperature\" among calibration.estimators or as calibration.apply",
        |s| runs_any(s, &[EstimatorKind::ArlsTemperature])),
    run("calibration.initial_covariance", RECURSION,
        |s| runs_any(s, &[EstimatorKind::Arls, EstimatorKind::ArlsCovariance])),
    run("calibration.outlier_threshold", CAMPAIGN, is_campaign),
    run("allan.estimator", STEADY, is_steady),
    run("allan.averaging_times", STEADY, is_steady),
    run("trial.rate_gain", "a [[filter]]", |s| !s.filters.is_empty()),
    run("trial.black_box", "a [[filter]]", |s| !s.filters.is_empty()),
    run("trial.filter_state",
        "it needs dwells to begin afresh at, and filters; [turntable.steps] or \
         [turntable.scale_factor_test] and a [[filter]]",
        |s| !s.filters.is_empty() && s.turntable.motion.stairs().is_some()),
    Rule { path: "gate[].inconclusive", acts: Acts::Gate(|gate| gate.decide == GateDecision::Interval),
        needs: "a value alone is never inconclusive; decide = \"interval\"" },
];

fn is_zero(value: f64) -> bool {
    value.abs() <= 0.0
}

/// Whether the gyro's white noise is made of its sources, and not of the walk of a data sheet.
fn is_by_source(scenario: &Scenario) -> bool {
    let noise = &scenario.gyro.noise;
    noise.angle_random_walk_deg_per_sqrt_h.is_none()
}

fn is_steady(scenario: &Scenario) -> bool {
    let motion = scenario.measured_motion();
    matches!(motion.class(), MotionClass::Rest | MotionClass::Rotation)
}

fn is_turning(scenario: &Scenario) -> bool {
    !scenario.turntable.motion.is_at_rest()
}

fn is_campaign(scenario: &Scenario) -> bool {
    scenario.turntable.motion.campaign().is_some()
}

fn has_encoder(scenario: &Scenario) -> bool {
    scenario.turntable.encoder.resolution_arcsec.is_some()
}

/// Whether an input axis is not the axis of the table.
fn is_leaning(scenario: &Scenario) -> bool {
    let table = &scenario.turntable;
    scenario.gyro.assembly.is_some()
        || table.mounting.misalignment_arcsec > 0.0
        || table.axis.wobble_arcsec > 0.0
}

fn is_accelerated(scenario: &Scenario) -> bool {
    match &scenario.gyro.vibration.motion {
        VibrationMotion::Off(_) => false,
        VibrationMotion::Sine(sine) => sine.acceleration_g > 0.0,
        VibrationMotion::Random(random) => random.acceleration_psd_g2_per_hz > 0.0,
    }
}

fn is_sensitive(scenario: &Scenario) -> bool {
    let vibration = &scenario.gyro.vibration;
    !is_zero(vibration.intensity_per_g) || !is_zero(vibration.rate_error_deg_per_h_per_g)
}

/// Whether the temperature of the gyro changes.
fn changes(scenario: &Scenario) -> bool {
    let thermal = &scenario.gyro.thermal;
    let is_moved = match &scenario.gyro.temperature {
        TemperatureConfig::Soak(_) => false,
        TemperatureConfig::Ramp(_) => true,
        TemperatureConfig::Profile(profile) => profile
            .temperatures_c
            .windows(2)
            .any(|pair| !is_zero(pair[1] - pair[0])),
    };
    let is_warming = thermal.warm_up == ThermalWarmUp::Cold && thermal.self_heating_c > 0.0;
    is_moved || is_warming || thermal.ripple_amplitude_c > 0.0
}

/// Whether the gyro is ever at another temperature than that of its calibration.
fn departs(scenario: &Scenario) -> bool {
    let thermal = &scenario.gyro.thermal;
    let start_c = match &scenario.gyro.temperature {
        TemperatureConfig::Soak(soak) => soak.temperature_c,
        TemperatureConfig::Ramp(ramp) => ramp.start_c,
        TemperatureConfig::Profile(profile) => profile
            .temperatures_c
            .first()
            .copied()
            .unwrap_or(thermal.reference_c),
    };
    changes(scenario) || !is_zero(start_c + thermal.self_heating_c - thermal.reference_c)
}

/// Whether the phase of the fibre follows its temperature.
fn follows_temperature(scenario: &Scenario) -> bool {
    let thermal = &scenario.gyro.thermal;
    !is_zero(thermal.index_per_k) || !is_zero(thermal.length_ppm_per_k)
}

/// Whether a campaign runs one of some estimators.
fn runs_any(scenario: &Scenario, kinds: &[EstimatorKind]) -> bool {
    let runs = scenario.calibration.kinds();
    is_campaign(scenario) && kinds.iter().any(|kind| runs.contains(kind))
}

/// Tables of what a log takes the place of.
const OF_BENCH: [&str; 4] = ["gyro", "turntable", "calibration", "trial"];
/// Keys without a table that only a simulation works by.
const OF_SIMULATION: [&str; 3] = ["seed", "repeats", "fidelity"];

/// Whether only a simulation works by a key, at its schema path.
pub(in crate::scenario) fn is_of_bench(path: &str) -> bool {
    let first = path.split(['.', '[']).next().unwrap_or_default();
    OF_BENCH.contains(&first) || OF_SIMULATION.contains(&path)
}

/// Every key that acts in no run of a log.
pub(in crate::scenario) fn bench_rules() -> &'static [Rule] {
    static ALL: OnceLock<Vec<Rule>> = OnceLock::new();
    ALL.get_or_init(|| {
        let of_bench = keys().filter(|key| is_of_bench(key.path));
        of_bench
            .map(|key| {
                run(
                    key.path,
                    "a gyro that is simulated, in whose place [log] stands",
                    |s| s.log.is_none(),
                )
            })
            .collect()
    })
}

/// Every key that does not always act, those that the kinds of filters declare among them.
pub(in crate::scenario) fn rules() -> &'static [Rule] {
    static ALL: OnceLock<Vec<Rule>> = OnceLock::new();
    ALL.get_or_init(|| {
        let of_filters = conditional_keys().into_iter().map(|key| Rule {
            path: format!("filter[].{}.{}", key.kind, key.key).leak(),
            acts: Acts::Filter(key.kind, key.key),
            needs: key.needs,
        });
        RULES.iter().copied().chain(of_filters).collect()
    })
}
