//! Checks of several sines: can they be sampled, and told apart in the record?

use super::turntable_config::MultiSineConfig;

/// Most sines: the fit grows with the square of their number.
const TONES_MAX: usize = 64;

/// Fewest cycles of the lowest sine in the record.
const CYCLES_MIN: f64 = 3.0;

/// Relative slack when frequencies are compared, so that 1 Hz apart is told in 1 s.
const SLACK: f64 = 1e-9;

const FREQUENCIES: &str = "turntable.multi_sine.frequencies_hz";
const AMPLITUDES: &str = "turntable.multi_sine.rate_amplitudes_deg_per_s";

/// Key and text of every complaint.
///
/// A joint least-squares fit tells two sines apart once the record holds one cycle of their
/// difference; whole cycles are not asked for.
pub(super) fn complaints(
    config: &MultiSineConfig,
    duration_s: f64,
    output_rate_hz: f64,
    samples_per_cycle_min: f64,
) -> Vec<(String, String)> {
    let tones = &config.frequencies_hz;
    let mut found = Vec::new();
    let mut complain = |key: String, text: String| {
        let message = format!("{key} {text}");
        found.push((key, message));
    };
    if tones.len() > TONES_MAX {
        let text = format!("holds {} frequencies: at most {TONES_MAX}", tones.len());
        complain(FREQUENCIES.to_owned(), text);
    }
    let amplitudes = config.rate_amplitudes_deg_per_s.len();
    if amplitudes != 1 && amplitudes != tones.len() {
        let text = format!(
            "holds {amplitudes} amplitudes for {} frequencies: give one for all, or one for each",
            tones.len()
        );
        complain(AMPLITUDES.to_owned(), text);
    }
    let lowest = tones.first().copied().unwrap_or(0.0);
    if lowest * duration_s < CYCLES_MIN * (1.0 - SLACK) {
        let text = format!(
            "= {lowest:?} Hz is too slow: duration_s = {duration_s:?} s must hold {CYCLES_MIN} cycles"
        );
        complain(format!("{FREQUENCIES}[0]"), text);
    }
    let frequency_hz_max = output_rate_hz / samples_per_cycle_min;
    for (index, frequency_hz) in tones.iter().enumerate() {
        if *frequency_hz > frequency_hz_max {
            let text = format!(
                "= {frequency_hz:?} Hz is too fast: allowed up to {frequency_hz_max:.6} Hz, \
                 {samples_per_cycle_min} samples a cycle at the output rate of {output_rate_hz:.6} Hz"
            );
            complain(format!("{FREQUENCIES}[{index}]"), text);
        }
    }
    for (index, pair) in tones.windows(2).enumerate() {
        let key = format!("{FREQUENCIES}[{}]", index + 1);
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
