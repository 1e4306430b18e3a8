//! Whose wish a key is: that of `--set`, of a sweep, of the scenario itself, never that of a record.

use std::fs;

use crate::scenario::check::inert_tests::{idle, load};
use crate::scenario::load_suite;

#[test]
fn a_set_key_is_refused_if_it_acts_nowhere() {
    let least = "name = \"x\"\nduration_s = 20.0\n";
    let set = ["gyro.slow_noise.gauss_markov_correlation_time_s=50"];
    let found = idle(least, "", &set);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].contains("it acts only with gyro.slow_noise.gauss_markov_deg_per_h above 0"));
    let acting = format!("{least}gyro.slow_noise.gauss_markov_deg_per_h = 1.0\n");
    assert!(load(&acting, "", &set).is_ok());
    // It acts in one scenario of the suite.
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.toml"), least).unwrap();
    fs::write(
        folder.path().join("b.toml"),
        acting.replace("\"x\"", "\"y\""),
    )
    .unwrap();
    let sets = set.map(str::to_owned);
    assert!(load_suite(&[folder.path().to_owned()], &sets).is_ok());
    // On a manifest it is a wish as well.
    let run = load(least, "", &[]).unwrap().remove(0);
    let manifest = crate::scenario::manifest_toml(&run, env!("CARGO_PKG_VERSION"), "unknown");
    assert_eq!(idle(&manifest, "", &set).len(), 1);
}

#[test]
fn a_swept_key_acts_if_it_acts_in_one_point() {
    let sweep = |amplitudes: &str| {
        format!(
            "name = \"x\"\nduration_s = 20.0\n[matrix]\n\
             \"gyro.slow_noise.gauss_markov_correlation_time_s\" = [10.0, 20.0]\n\
             \"gyro.slow_noise.gauss_markov_deg_per_h\" = {amplitudes}\n"
        )
    };
    assert!(load(&sweep("[0.0, 1.0]"), "", &[]).is_ok());
    let found = idle(&sweep("[0.0]"), "", &[]);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].contains("gauss_markov_correlation_time_s is swept without effect"));
    // A key of the file that acts in one point only.
    let text = "name = \"x\"\nduration_s = 20.0\ngyro.thermal.ripple_period_s = 33.0\n[matrix]\n\
                \"gyro.thermal.ripple_amplitude_c\" = [0.0, 1.0]\n";
    assert!(load(text, "", &[]).is_ok());
    // A sweep that is inherited is nobody's wish.
    let own = "name = \"x\"\nextends = \"base.toml\"\n";
    let base = sweep("[0.0]").replace("name = \"x\"\n", "");
    assert!(load(own, &base, &[]).is_ok());
}

#[test]
fn what_a_record_says_by_default_contradicts_nothing() {
    let steps = "name = \"x\"\nduration_s = 20.0\n[turntable.steps]\nrates_deg_per_s = [0.0, 1.0]\n\
                 dwell_s = 0.1\n";
    let run = load(steps, "", &[]).unwrap().remove(0);
    let settle_s = run.number_of("turntable.steps.settle_s").unwrap();
    assert!(settle_s >= 0.1, "the default is longer than the dwell");
    let manifest = crate::scenario::manifest_toml(&run, env!("CARGO_PKG_VERSION"), "unknown");
    for record in [&manifest, &run.to_toml()] {
        assert_eq!(load(record, "", &[]).unwrap().remove(0).digest, run.digest);
    }
    // It stays refused where somebody asks for it.
    let refused = |text: &str, sets: &[&str]| {
        let errors = load(text, "", sets).err().unwrap_or_default();
        errors
            .iter()
            .any(|error| error.message.contains("leaves nothing"))
    };
    let set = format!("turntable.steps.settle_s={settle_s:?}");
    assert!(refused(&format!("{steps}settle_s = {settle_s:?}\n"), &[]));
    assert!(refused(steps, &[&set]) && refused(&manifest, &[&set]));
    let changed = manifest.replace(&format!("settle_s = {settle_s:?}"), "settle_s = 7.5");
    assert!(refused(&changed, &[]));
}

#[test]
fn a_swept_key_that_acts_in_the_last_of_many_points_is_accepted() {
    let sweep = |last: &str| {
        let amplitudes = "0.0, ".repeat(300);
        format!(
            "name = \"x\"\nduration_s = 20.0\ngyro.thermal.ripple_period_s = 33.0\n[matrix]\n\
             \"gyro.thermal.ripple_amplitude_c\" = [{amplitudes}{last}]\n"
        )
    };
    assert_eq!(load(&sweep("1.0"), "", &[]).unwrap().len(), 301);
    let found = idle(&sweep("0.0"), "", &[]);
    assert_eq!(found.len(), 1, "{found:?}");
}
