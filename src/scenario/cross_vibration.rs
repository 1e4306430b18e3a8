//! Checks across the keys of the vibration.

use crate::units::SPEED_OF_LIGHT_M_PER_S;

use crate::gyro::{GyroConfig, ModulationScheme};
use crate::gyro::{RandomVibrationConfig, SineVibrationConfig, VibrationMotion};

/// Every complaint about a gyro's vibration: the key to blame and what is wrong.
pub(crate) fn check(gyro: &GyroConfig) -> Vec<(&'static str, String)> {
    let vibration = &gyro.vibration;
    let found = match &vibration.motion {
        VibrationMotion::Off(_) => vec![],
        VibrationMotion::Sine(sine) => check_sine(gyro, sine),
        VibrationMotion::Random(random) => check_random(gyro, random),
    };
    let peak_g = acceleration_max_g(&vibration.motion);
    let change = vibration.intensity_per_g.abs() * peak_g;
    let dark = (change >= 1.0).then(|| {
        let message = format!(
            "gyro.vibration.intensity_per_g = {:?} 1/g leaves no light at the peak of {peak_g:.3} g: \
             intensity times peak must be below 1",
            vibration.intensity_per_g
        );
        ("gyro.vibration.intensity_per_g", message)
    });
    let pair = no_pair(gyro);
    found.into_iter().chain(dark).chain(pair).collect()
}

/// Vibration of a gyro that does not demodulate two plain states a half period apart.
///
/// What vibration rectifies to is the product of a change of power and a change of phase within one
/// demodulation: other states, or spikes beside them, weigh the two differently.
fn no_pair(gyro: &GyroConfig) -> Option<(&'static str, String)> {
    if matches!(gyro.vibration.motion, VibrationMotion::Off(_)) {
        return None;
    }
    let modulator = &gyro.modulator;
    if modulator.scheme != ModulationScheme::TwoState {
        let message = "gyro.modulator.scheme has four states under gyro.vibration: the mean that \
                       vibration rectifies to is known for a pair of states only, use \"two-state\"";
        return Some(("gyro.modulator.scheme", message.to_owned()));
    }
    (modulator.half_period_mismatch != 0.0 && !gyro.detector.gate_spikes).then(|| {
        let message = "gyro.detector.gate_spikes = false under gyro.vibration with a \
                       gyro.modulator.half_period_mismatch: the mean that vibration rectifies to is \
                       known without spikes only, gate them";
        ("gyro.detector.gate_spikes", message.to_owned())
    })
}

/// Largest acceleration: all tones of a band in step.
fn acceleration_max_g(motion: &VibrationMotion) -> f64 {
    match motion {
        VibrationMotion::Off(_) => 0.0,
        VibrationMotion::Sine(sine) => sine.acceleration_g,
        VibrationMotion::Random(random) => {
            let band_hz = (random.to_hz - random.from_hz).max(0.0);
            let power = random.acceleration_psd_g2_per_hz * band_hz;
            (2.0 * power * f64::from(random.tones)).sqrt()
        }
    }
}

fn check_sine(gyro: &GyroConfig, sine: &SineVibrationConfig) -> Vec<(&'static str, String)> {
    let mut found = Vec::new();
    let key = "gyro.vibration.sine.frequency_hz";
    found.extend(too_fast(gyro, key, sine.frequency_hz));
    if sine.acceleration_g + sine.rate_amplitude_deg_per_s <= 0.0 {
        let message = "gyro.vibration.sine vibrates by nothing: give acceleration_g, \
                       rate_amplitude_deg_per_s or both";
        found.push(("gyro.vibration.sine", message.to_owned()));
    }
    found
}

fn check_random(gyro: &GyroConfig, random: &RandomVibrationConfig) -> Vec<(&'static str, String)> {
    let mut found = Vec::new();
    if random.from_hz >= random.to_hz {
        let message = format!(
            "gyro.vibration.random.from_hz = {:?} Hz is not below to_hz = {:?} Hz",
            random.from_hz, random.to_hz
        );
        found.push(("gyro.vibration.random.from_hz", message));
    }
    let key = "gyro.vibration.random.to_hz";
    found.extend(too_fast(gyro, key, random.to_hz));
    if random.acceleration_psd_g2_per_hz + random.rate_psd_deg2_per_s2_per_hz <= 0.0 {
        let message = "gyro.vibration.random vibrates by nothing: give acceleration_psd_g2_per_hz, \
                       rate_psd_deg2_per_s2_per_hz or both";
        found.push(("gyro.vibration.random", message.to_owned()));
    }
    found
}

/// Two samples a cycle at the rate of the half periods, `1 / tau`.
fn too_fast(
    gyro: &GyroConfig,
    key: &'static str,
    frequency_hz: f64,
) -> Option<(&'static str, String)> {
    // A half modulation period is the transit time n L / c of the coil.
    let limit_hz = 0.5 * SPEED_OF_LIGHT_M_PER_S / (gyro.coil.group_index * gyro.coil.length_m);
    (frequency_hz >= limit_hz).then(|| {
        let message = format!(
            "{key} = {frequency_hz:?} Hz is too fast: expected below {limit_hz:.3} Hz, two half \
             modulation periods a cycle"
        );
        (key, message)
    })
}
