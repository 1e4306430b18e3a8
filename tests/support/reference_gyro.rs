//! The reference gyro: what a scenario that says nothing gets, without slow noise and rounding.

use fogbench::scenario::{GyroConfig, Scenario, load_suite};

/// What the reader makes of a scenario that gives nothing but a motion, e.g. `static = {}`.
pub(crate) fn default_scenario(motion: &str) -> Scenario {
    scenario_with("", motion)
}

/// The gyro of a scenario that gives nothing but these keys below `gyro`, as `noise.rin = false`.
pub(crate) fn gyro(settings: &[String]) -> GyroConfig {
    let lines = settings.iter().map(|setting| format!("gyro.{setting}\n"));
    scenario_with(&lines.collect::<String>(), "static = {}").gyro
}

fn scenario_with(settings: &str, motion: &str) -> Scenario {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let text = format!(
        "schema = 1\nname = \"fixture\"\n\
         description = \"A fixture with every kind of record.\"\n\
         duration_s = 3600.0\n{settings}[turntable]\n{motion}\n"
    );
    let path = folder.path().join("fixture.toml");
    std::fs::write(&path, text).expect("a writable folder");
    let mut runs = load_suite(&[path], &[]).expect("the fixture is a scenario");
    runs.remove(0).scenario
}

/// All fast noise on, drawn combined, one nanoampere of dark current; no slow noise; rate word not
/// rounded.
pub(crate) fn reference_gyro() -> GyroConfig {
    undisturbed(gyro(&[]))
}

/// One nanoampere of dark current; no slow noise; rate word not rounded.
pub(crate) fn undisturbed(mut gyro: GyroConfig) -> GyroConfig {
    gyro.detector.dark_current_na = 1.0;
    gyro.slow_noise.bias_instability_deg_per_h = 0.0;
    gyro.slow_noise.rate_random_walk_deg_per_h_per_sqrt_h = 0.0;
    gyro.output.rate_lsb_deg_per_s = 0.0;
    gyro
}
