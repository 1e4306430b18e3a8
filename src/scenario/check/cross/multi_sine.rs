//! Checks of several sines: can they be sampled, and told apart in the record?

use crate::scenario::config::Scenario;
use crate::turntable::{MotionConfig, MultiSineConfig};

/// Most sines: the fit grows with the square of their number.
const TONES_MAX: usize = 64;

/// Fewest cycles of the lowest sine in the record.
const CYCLES_MIN: f64 = 3.0;

/// Relative slack when frequencies are compared, so that 1 Hz apart is told in 1 s.
const SLACK: f64 = 1e-9;

/// Where an injected signal stands.
pub(in crate::scenario) const INJECTION: &str = "gyro.injection";

/// Key and text of every complaint about an injected signal but those about its sines.
pub(in crate::scenario) fn injection_complaints(
    scenario: &Scenario,
) -> Vec<(&'static str, String)> {
    let mut found = Vec::new();
    if scenario.gyro.injection.is_none() {
        return found;
    }
    if !matches!(scenario.turntable.motion, MotionConfig::Static(_)) {
        let text = format!(
            "{INJECTION} needs a table at rest: a motion would add to the response, use turntable.static"
        );
        found.push((INJECTION, text));
    }
    if scenario.gyro.assembly.is_some() {
        let text = format!("{INJECTION} is for one gyro: leave out gyro.assembly");
        found.push((INJECTION, text));
    }
    found
}

/// Key and text of every complaint about the sines of the table `table`.
///
/// A joint least-squares fit tells two sines apart once the record holds one cycle of their
/// difference; whole cycles are not asked for.
pub(in crate::scenario) fn complaints(
    table: &str,
    config: &MultiSineConfig,
    duration_s: f64,
    output_rate_hz: f64,
    samples_per_cycle_min: f64,
) -> Vec<(String, String)> {
    let frequencies = format!("{table}.frequencies_hz");
    let tones = &config.frequencies_hz;
    let mut found = Vec::new();
    let mut complain = |key: String, text: String| {
        let message = format!("{key} {text}");
        found.push((key, message));
    };
    if tones.len() > TONES_MAX {
        let text = format!("holds {} frequencies: at most {TONES_MAX}", tones.len());
        complain(frequencies.clone(), text);
    }
    let amplitudes = config.rate_amplitudes_deg_per_s.len();
    if amplitudes != 1 && amplitudes != tones.len() {
        let text = format!(
            "holds {amplitudes} amplitudes for {} frequencies: give one for all, or one for each",
            tones.len()
        );
        complain(format!("{table}.rate_amplitudes_deg_per_s"), text);
    }
    let lowest = tones.first().copied().unwrap_or(0.0);
    if lowest * duration_s < CYCLES_MIN * (1.0 - SLACK) {
        let text = format!(
            "= {lowest:?} Hz is too slow: duration_s = {duration_s:?} s must hold {CYCLES_MIN} cycles"
        );
        complain(format!("{frequencies}[0]"), text);
    }
    let frequency_hz_max = output_rate_hz / samples_per_cycle_min;
    for (index, frequency_hz) in tones.iter().enumerate() {
        if *frequency_hz > frequency_hz_max {
            let text = format!(
                "= {frequency_hz:?} Hz is too fast: allowed up to {frequency_hz_max:.6} Hz, \
                 {samples_per_cycle_min} samples a cycle at the output rate of {output_rate_hz:.6} Hz"
            );
            complain(format!("{frequencies}[{index}]"), text);
        }
    }
    for (index, pair) in tones.windows(2).enumerate() {
        let key = format!("{frequencies}[{}]", index + 1);
        let apart_hz = pair[1] - pair[0];
        if apart_hz <= 0.0 {
            let text = format!("= {:?} Hz does not ascend from {:?} Hz", pair[1], pair[0]);
            complain(key, text);
        } else if apart_hz * duration_s < 1.0 - SLACK {
            let text = format!(
                "= {:?} Hz cannot be told from {:?} Hz in duration_s = {duration_s:?} s: \
                 it must hold a cycle of the difference",
                pair[1], pair[0]
            );
            complain(key, text);
        }
    }
    found
}
