//! The configuration of the gyro: names are the keys of the scenario file, units included.

use serde::Deserialize;

use super::assembly_config::AssemblyConfig;
use super::injection_config::InjectionConfig;
use super::thermal_config::{TemperatureConfig, ThermalConfig};
use super::vibration_config::VibrationConfig;

/// The gyro.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GyroConfig {
    /// Fibre coil.
    pub coil: CoilConfig,
    /// Light source.
    pub source: SourceConfig,
    /// Phase modulator and its converter.
    pub modulator: ModulatorConfig,
    /// Photodetector and amplifier.
    pub detector: DetectorConfig,
    /// Analogue-to-digital converter.
    pub adc: AdcConfig,
    /// Feedback loop.
    pub controller: ControllerConfig,
    /// Fast noise sources and how they are drawn.
    pub noise: NoiseConfig,
    /// Slow noise of the rate.
    pub slow_noise: SlowNoiseConfig,
    /// Temperature of the chamber.
    pub temperature: TemperatureConfig,
    /// How temperature reaches the gyro and what it does there.
    pub thermal: ThermalConfig,
    /// Vibration of the case.
    pub vibration: VibrationConfig,
    /// Test signal added inside the loop; none is the gyro at work.
    pub injection: Option<InjectionConfig>,
    /// Rate word.
    pub output: RateOutputConfig,
    /// Three such gyros in one case; none is a single gyro on the table axis.
    pub assembly: Option<AssemblyConfig>,
}

/// Fibre coil.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CoilConfig {
    /// Fibre length, m.
    pub length_m: f64,
    /// Mean coil diameter, mm.
    pub diameter_mm: f64,
    /// Group index of the fibre; sets the transit time, not the scale factor.
    pub group_index: f64,
}

/// Light source and interferometer.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SourceConfig {
    /// Mean vacuum wavelength, nm.
    pub wavelength_nm: f64,
    /// Mean detected power P0 over a fringe, uW (half of the fringe maximum).
    pub power_uw: f64,
    /// Full width at half maximum of the Gaussian spectrum, nm.
    pub linewidth_nm: f64,
    /// Degree of polarisation at the detector, 0..1.
    pub polarisation_degree: f64,
    /// Fringe visibility V, 0..1.
    pub visibility: f64,
}

/// Phase modulator.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModulatorConfig {
    /// Bias modulation depth `phi_m`, deg; the four-state schemes stand at `180 +- (180 - phi_m)`.
    pub depth_deg: f64,
    /// Bits of the ramp converter over 2 pi; 0 = ideal.
    pub dac_bits: u32,
    /// Bias wave.
    pub scheme: ModulationScheme,
    /// Applied over commanded phase, less one, ppm.
    pub gain_error_ppm: f64,
    /// What becomes of the loop period in which the ramp resets.
    pub reset_sample: ResetSample,
    /// Amplitude of the error phase that follows the ramp voltage, urad.
    pub cross_coupling_urad: f64,
    /// Ramp phase at which that error crosses zero upwards, with opposite sign, deg.
    pub cross_coupling_phase_deg: f64,
    /// Random jumps of the ramp against the dead band, deg rms; 0 = none.
    pub dither_deg: f64,
    /// Loop periods from jump to jump.
    pub dither_interval_periods: u32,
    /// Half modulation period over transit time, less one.
    pub half_period_mismatch: f64,
    /// Relative intensity modulation that goes with the bias wave.
    pub intensity_modulation: f64,
}

/// Bias wave of the modulator.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ModulationScheme {
    /// Square wave: two states of tau.
    TwoState,
    /// Four states of tau, period 4 tau.
    FourState,
    /// Four states of tau / 2, period 2 tau.
    FourStateHalf,
}

/// What becomes of the loop period in which the ramp resets by 2 pi.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ResetSample {
    /// Demodulated as any other.
    Demodulated,
    /// Discarded.
    Blanked,
}

/// Photodetector, transimpedance amplifier and gate.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DetectorConfig {
    /// Responsivity, A/W.
    pub responsivity_a_per_w: f64,
    /// Dark current, nA.
    pub dark_current_na: f64,
    /// Transimpedance, kOhm.
    pub transimpedance_kohm: f64,
    /// Voltage gain after the transimpedance stage.
    pub post_gain: f64,
    /// Amplifier voltage noise, nV/sqrt(Hz).
    pub voltage_noise_nv_per_sqrt_hz: f64,
    /// Amplifier current noise, pA/sqrt(Hz).
    pub current_noise_pa_per_sqrt_hz: f64,
    /// Fraction of each half period that is gated into the demodulator.
    pub gate_duty: f64,
    /// Whether the gate leaves out the spikes between the states of the bias wave.
    pub gate_spikes: bool,
}

/// Analogue-to-digital converter.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AdcConfig {
    /// Bits; 0 = ideal (no quantisation, no saturation).
    pub bits: u32,
    /// Range, V: codes cover 0 .. range.
    pub range_v: f64,
    /// Samples averaged per half period.
    pub samples_per_half_period: u32,
}

/// Digital controller.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ControllerConfig {
    /// Closed-loop -3 dB bandwidth, Hz; sets the integrator gain.
    pub loop_bandwidth_hz: f64,
    /// Pipeline latency in modulation periods, 0..=3.
    pub loop_latency_periods: u32,
    /// Whether the loop gain is held against changes of the detected power.
    pub automatic_gain_control: bool,
    /// Gain of the second loop, which corrects the modulator's gain; 0 = off.
    pub second_loop_gain: f64,
    /// Bits of the ramp's step over 2 pi, the rest cut off; 0 = ideal.
    pub step_bits: u32,
    /// Largest ramp step, deg; 0 = not limited.
    pub step_limit_deg: f64,
}

/// Fast noise sources.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NoiseConfig {
    /// Shot noise of the photocurrent.
    pub shot: bool,
    /// Thermal (Johnson) noise of the transimpedance.
    pub thermal: bool,
    /// Amplifier voltage and current noise.
    pub amplifier: bool,
    /// Relative intensity noise of the source.
    pub rin: bool,
    /// Technical phase noise, one-sided, urad/sqrt(Hz); 0 = none.
    pub technical_phase_urad_per_sqrt_hz: f64,
    /// How the noise is drawn.
    pub draw: NoiseDraw,
}

/// How fast noise is drawn in the loop model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NoiseDraw {
    /// One normal per half period with the variance of all sources.
    Combined,
    /// Every source and every ADC sample drawn on its own.
    Exact,
}

/// Slow noise of the rate.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SlowNoiseConfig {
    /// Constant bias, deg/h.
    pub bias_deg_per_h: f64,
    /// Standard deviation of a bias drawn at each start, deg/h; 0 = none.
    pub turn_on_bias_deg_per_h: f64,
    /// Flicker (bias instability) coefficient B, deg/h.
    pub bias_instability_deg_per_h: f64,
    /// Standard deviation of an exponentially correlated (Gauss-Markov) rate, deg/h; 0 = none.
    pub gauss_markov_deg_per_h: f64,
    /// Its correlation time Tc, s.
    pub gauss_markov_correlation_time_s: f64,
    /// Rate random walk coefficient K, deg/h/sqrt(h).
    pub rate_random_walk_deg_per_h_per_sqrt_h: f64,
    /// Rate ramp R, deg/h/h.
    pub rate_ramp_deg_per_h_per_h: f64,
}

/// Rate word.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RateOutputConfig {
    /// Half modulation periods averaged into one rate word (even).
    pub half_periods_per_sample: u32,
    /// Rate words averaged into one sample of the output; 1 puts out every word.
    pub average_samples: u32,
    /// What is rounded: each rate word, or the angle turned since the start.
    pub quantisation: OutputQuantisation,
    /// Least significant bit of the rate word, deg/s, rounded without carry; 0 = not rounded.
    pub rate_lsb_deg_per_s: f64,
    /// Angle of one pulse, arcsec, where pulses are counted.
    pub angle_lsb_arcsec: f64,
}

/// What the output rounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum OutputQuantisation {
    /// Each rate word to its least significant bit; the remainder is thrown away.
    RateWord,
    /// The angle to whole pulses; the remainder is carried into the next word.
    AngleCarry,
}
