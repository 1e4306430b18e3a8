//! Checks across the values of the gyro that need no physics.

use crate::gyro::{
    PowerConfig, TemperatureConfig, TemperatureProfileConfig, TemperatureRampConfig, ThermalConfig,
    Winding,
};
use crate::scenario::config::Scenario;

/// Finest step of a rate word, deg/s: a whole number of 53 bits then reaches 9000 deg/s.
const RATE_LSB_MIN_DEG_PER_S: f64 = 1e-12;

/// Key to blame and what is wrong with it, for every contradiction.
pub(crate) fn check(scenario: &Scenario) -> Vec<(String, String)> {
    let thermal = &scenario.gyro.thermal;
    let mut found = match &scenario.gyro.temperature {
        TemperatureConfig::Soak(_) => Vec::new(),
        TemperatureConfig::Ramp(config) => ramp(config),
        TemperatureConfig::Profile(config) => profile(config),
    };
    found.extend(winding(thermal, scenario.gyro.coil.length_m));
    found.extend(power(thermal));
    found.extend(rate_word(scenario.gyro.output.rate_lsb_deg_per_s));
    found
}

fn complaint(key: &str, rest: &str) -> (String, String) {
    (key.to_owned(), format!("{key} = {rest}"))
}

fn rate_word(lsb_deg_per_s: f64) -> Option<(String, String)> {
    let is_senseless = lsb_deg_per_s > 0.0 && lsb_deg_per_s < RATE_LSB_MIN_DEG_PER_S;
    is_senseless.then(|| {
        complaint(
            "gyro.output.rate_lsb_deg_per_s",
            &format!(
                "{lsb_deg_per_s:?} deg/s is out of range: allowed 0 deg/s, no rounding, or \
                 {RATE_LSB_MIN_DEG_PER_S:?} deg/s and more"
            ),
        )
    })
}

fn ramp(config: &TemperatureRampConfig) -> Vec<(String, String)> {
    let rise_c = config.end_c - config.start_c;
    if rise_c.abs() <= 0.0 {
        return vec![complaint(
            "gyro.temperature.ramp.end_c",
            &format!(
                "{:?} C is where the ramp starts: use gyro.temperature.soak",
                config.end_c
            ),
        )];
    }
    if rise_c * config.rate_c_per_min > 0.0 {
        return Vec::new();
    }
    vec![complaint(
        "gyro.temperature.ramp.rate_c_per_min",
        &format!(
            "{:?} K/min never leads from {:?} to {:?} C: it needs the sign of the change",
            config.rate_c_per_min, config.start_c, config.end_c
        ),
    )]
}

fn profile(config: &TemperatureProfileConfig) -> Vec<(String, String)> {
    let (times, temperatures) = (config.times_s.len(), config.temperatures_c.len());
    if times != temperatures {
        let message = format!(
            "gyro.temperature.profile.temperatures_c has {temperatures} values for {times} times: \
             give one for each"
        );
        let key = "gyro.temperature.profile.temperatures_c".to_owned();
        return vec![(key, message)];
    }
    let pairs = config.times_s.windows(2).enumerate();
    pairs
        .filter(|(_, pair)| pair[1] <= pair[0])
        .map(|(index, pair)| {
            let key = format!("gyro.temperature.profile.times_s[{}]", index + 1);
            let message = format!(
                "{key} = {:?} s does not come after {:?} s: times must increase",
                pair[1], pair[0]
            );
            ("gyro.temperature.profile.times_s".to_owned(), message)
        })
        .collect()
}

fn winding(thermal: &ThermalConfig, length_m: f64) -> Vec<(String, String)> {
    let (multiple, name) = match thermal.winding {
        Winding::Plain => (1, "plain"),
        Winding::Dipole => (2, "dipole"),
        Winding::Quadrupole => (4, "quadrupole"),
    };
    let mut found = Vec::new();
    if !thermal.layers.is_multiple_of(multiple) {
        found.push(complaint(
            "gyro.thermal.layers",
            &format!(
                "{}: the layers of a {name} winding come in groups of {multiple}, half of each from \
                 either end of the fibre",
                thermal.layers
            ),
        ));
    }
    if 2.0 * thermal.midpoint_offset_m.abs() > length_m {
        found.push(complaint(
            "gyro.thermal.midpoint_offset_m",
            &format!(
                "{:?} m lies outside the coil: allowed up to half of gyro.coil.length_m = {length_m:?} m",
                thermal.midpoint_offset_m
            ),
        ));
    }
    found
}

fn power(thermal: &ThermalConfig) -> Vec<(String, String)> {
    let PowerConfig::Quadratic(points) = &thermal.power else {
        return Vec::new();
    };
    let reference_c = thermal.reference_c;
    let mut found = Vec::new();
    if points.cold_c >= reference_c {
        found.push(complaint(
            "gyro.thermal.power.quadratic.cold_c",
            &format!(
                "{:?} C is not below gyro.thermal.reference_c = {reference_c:?} C",
                points.cold_c
            ),
        ));
    }
    if points.hot_c <= reference_c {
        found.push(complaint(
            "gyro.thermal.power.quadratic.hot_c",
            &format!(
                "{:?} C is not above gyro.thermal.reference_c = {reference_c:?} C",
                points.hot_c
            ),
        ));
    }
    found
}
