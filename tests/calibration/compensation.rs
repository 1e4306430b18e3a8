//! The compensation of an assembly through the program: known answers, sources of its parameters,
//! refusals, and the statistics of repeats.

use std::path::Path;

use crate::support::transcript::{Transcript, said_to_each};
use crate::support::{
    assert_close, code, field, fogbench, npy, stderr, stdout, summary, tree, write,
};

/// The transcript of compensations.
const COMPENSATION: &str = "compensation";

/// Errors of the worked example, in the units of the keys: 1e-3 rad is 206.26 arcsec.
const ERRORS: &str = "bias_deg_per_h = [1.0, -2.0, 1.5]\n\
    scale_factor_error_ppm = [800.0, -500.0, 300.0]\ntheta_xy_arcsec = 206.26480624709636\n\
    theta_xz_arcsec = -165.01184499767709\ntheta_yx_arcsec = 123.75888374825782\n\
    theta_yz_arcsec = 247.51776749651563\ntheta_zx_arcsec = -185.63832562238672\n\
    theta_zy_arcsec = 103.13240312354818\n";

/// `I + K_G + theta_G` and `B_G` (deg/h) of the above.
const SENSITIVITY: [[f64; 3]; 3] = [
    [1.0008, -0.8e-3, -1.0e-3],
    [-1.2e-3, 0.9995, 0.6e-3],
    [0.5e-3, 0.9e-3, 1.0003],
];
const BIAS_DEG_PER_H: [f64; 3] = [1.0, -2.0, 1.5];

const SILENT: &str = "[gyro.noise]\nshot = false\nthermal = false\namplifier = false\nrin = false\n\
    [gyro.adc]\nbits = 0\n[gyro.modulator]\ndac_bits = 0\n[gyro.output]\nrate_lsb_deg_per_s = 0.0\n\
    [gyro.slow_noise]\nbias_instability_deg_per_h = 0.0\n\
    rate_random_walk_deg_per_h_per_sqrt_h = 0.0\n";

/// On a pole, where the Earth turns about the table axis alone: 90.0022 deg/s about x in all.
fn turning(form: &str) -> String {
    let rate = 90.0022 - 15.041_067_178_669_1 / 3600.0;
    format!(
        "schema = 1\nname = \"turning\"\nfidelity = \"rate\"\nduration_s = 0.5\nwarm_up_s = 2.0\n\
         [turntable.rotation]\nrate_deg_per_s = {rate:?}\n[turntable.site]\nlatitude_deg = 90.0\n\
         [turntable.mounting]\naxis_along_table = \"x\"\n{SILENT}[gyro.assembly]\n{ERRORS}\
         [compensation]\nform = \"{form}\"\n[compensation.parameters]\n{ERRORS}"
    )
}

#[track_caller]
fn run(folder: &Path, file: &str) -> String {
    let output = fogbench(folder, &["run", file, "-o", "out"]);
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    stdout(&output)
}

fn mean_errors(folder: &Path, name: &str, channel: &str) -> [f64; 3] {
    let summary = summary(&folder.join("out"), name);
    ["x", "y", "z"].map(|axis| {
        let metric = format!("{axis}_{channel}.mean_error_deg_per_h");
        field(&summary, &metric, "value")
    })
}

#[test]
fn the_exact_inverse_leaves_nothing_of_a_gyro_without_noise() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(folder.path(), "turning.toml", &turning("exact"));
    let printed = run(folder.path(), "turning.toml");
    let raw = mean_errors(folder.path(), "turning", "raw");
    // K_x W + B_x, -theta_yz W + B_y, theta_zy W + B_z at 324 007.92 deg/h.
    for (error, expected) in raw.iter().zip([260.206_336, -390.809_504, 163.503_960]) {
        assert_close(*error, expected, 0.0, 1e-6);
    }
    for error in mean_errors(folder.path(), "turning", "compensated") {
        // Rounding of words of 3e5 deg/h.
        assert!(error.abs() < 1e-8, "{error}");
    }
    assert!(printed.contains("compensation: exact inverse"), "{printed}");
    assert!(
        printed.contains("first order (-0.3573, 0.0187, 0.1726) deg/h"),
        "{printed}"
    );
}

#[test]
fn known_answer_of_what_the_first_order_form_leaves() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(folder.path(), "turning.toml", &turning("first-order"));
    run(folder.path(), "turning.toml");
    let left = mean_errors(folder.path(), "turning", "compensated");
    for (error, expected) in left.iter().zip([-0.3573, 0.0187, 0.1726]) {
        assert_close(*error, expected, 0.0, 5.1e-5);
    }
    let summary = summary(&folder.path().join("out"), "turning");
    let told = &summary["compensation"]["first_order_residual_deg_per_h"];
    for (axis, error) in left.iter().enumerate() {
        let told = told[axis].as_f64().expect("a residual");
        assert_close(told, *error, 0.0, 1e-6);
    }
}

/// Three noisy gyros at rest, with a filter that does nothing.
fn noisy(more: &str) -> String {
    format!(
        "schema = 1\nname = \"noisy\"\nfidelity = \"rate\"\nduration_s = 0.2\nwarm_up_s = 0.1\n\
         [output]\nsamples = \"npy\"\n[gyro.assembly]\n{ERRORS}\
         [[filter]]\nname = \"same\"\n[filter.moving_average]\ntaps = 1\n\
         output_register = \"immediate\"\n{more}"
    )
}

#[test]
fn compensated_words_solve_the_error_equations_sample_by_sample_and_filters_get_them() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let text = noisy(&format!("[compensation.parameters]\n{ERRORS}"));
    write(folder.path(), "noisy.toml", &text);
    run(folder.path(), "noisy.toml");
    let samples = folder.path().join("out/noisy/samples");
    let of =
        |name: &str| ["x", "y", "z"].map(|axis| npy(&samples.join(format!("{axis}_{name}.npy"))));
    let (raw, compensated, filtered) = (of("raw"), of("compensated"), of("same"));
    assert!(raw[0].len() > 1000);
    for index in 0..raw[0].len() {
        for axis in 0..3 {
            let row = SENSITIVITY[axis];
            let rebuilt: f64 = (0..3)
                .map(|other| row[other] * compensated[other][index])
                .sum();
            assert_close(
                rebuilt + BIAS_DEG_PER_H[axis],
                raw[axis][index],
                1e-12,
                1e-10,
            );
            let same = compensated[axis][index].to_bits();
            assert_eq!(filtered[axis][index].to_bits(), same);
        }
    }
    let summary = summary(&folder.path().join("out"), "noisy");
    let gain = field(&summary, "y_same.noise_gain", "value");
    assert_close(gain, 1.0, 0.0, 1e-12);
    let names: Vec<&String> = summary["channels"]
        .as_object()
        .expect("channels")
        .keys()
        .collect();
    assert_eq!(names.len(), 9, "{names:?}");
}

#[test]
fn a_calibration_file_a_manifest_and_the_parameters_themselves_give_the_same_words() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let file = format!("schema = 1\n[compensation]\n{ERRORS}[provenance]\nestimator = \"batch\"\n");
    let source = write(folder.path(), "found/calibration.toml", &file);
    let text = noisy("[compensation]\nfile = \"found/calibration.toml\"\n");
    write(folder.path(), "noisy.toml", &text);
    run(folder.path(), "noisy.toml");
    let first = tree(&folder.path().join("out/noisy"));
    let words = |files: &[(std::path::PathBuf, Vec<u8>)]| -> Vec<Vec<u8>> {
        let samples = files.iter().filter(|(path, _)| path.starts_with("samples"));
        samples.map(|(_, bytes)| bytes.clone()).collect()
    };
    // The manifest holds the parameters and needs the file no more.
    std::fs::copy(
        folder.path().join("out/noisy/manifest.toml"),
        folder.path().join("again.toml"),
    )
    .expect("a copy");
    std::fs::remove_file(source).expect("removed");
    let output = fogbench(folder.path(), &["run", "again.toml", "-o", "out"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert_eq!(tree(&folder.path().join("out/noisy")), first);
    let text = noisy(&format!("[compensation.parameters]\n{ERRORS}"));
    write(folder.path(), "noisy.toml", &text);
    run(folder.path(), "noisy.toml");
    let given = tree(&folder.path().join("out/noisy"));
    assert_eq!(words(&given), words(&first));
    assert_eq!(words(&given).len(), 13);
}

#[test]
fn a_bias_that_follows_the_coil_is_compensated_by_its_thermometer() {
    // The bias of all three gyros follows the coil by 0.3 deg/h per K through a ramp of 20 K.
    let folder = tempfile::tempdir().expect("a scratch folder");
    let silent = SILENT.replace(
        "[gyro.output]\n",
        "[gyro.output]\nhalf_periods_per_sample = 8192\n",
    );
    let text = |coefficient: f64| {
        format!(
            "schema = 1\nname = \"warm\"\nfidelity = \"rate\"\nduration_s = 600.0\nwarm_up_s = 2.0\n\
             {silent}[gyro.temperature.ramp]\nstart_c = 25.0\nend_c = 45.0\nrate_c_per_min = 4.0\n\
             [gyro.thermal]\nreference_c = 25.0\nindex_per_k = 0.0\nlength_ppm_per_k = 0.0\nbias_deg_per_h_per_k = 0.3\n\
             diameter_ppm_per_k = 0.0\nbias_deg_per_h_per_k2 = 0.0\nbias_deg_per_h_per_c_per_min = 0.0\n[gyro.assembly]\n\
             [compensation.parameters]\nreference_temperature_c = [25.0, 25.0, 25.0]\n\
             bias_deg_per_h_per_k = [{coefficient:?}, {coefficient:?}, {coefficient:?}]\n"
        )
    };
    let left = |coefficient: f64| {
        write(folder.path(), "warm.toml", &text(coefficient));
        run(folder.path(), "warm.toml");
        mean_errors(folder.path(), "warm", "compensated")
    };
    let without = left(0.0);
    let with = left(0.3);
    for (without, with) in without.iter().zip(with) {
        assert!(*without > 0.2, "{without}");
        assert!(with.abs() < 0.02 * without, "{without} -> {with}");
    }
}

#[test]
fn coefficients_that_a_log_has_shown_are_taken_out_of_a_simulated_gyro() {
    // 0.3 deg/h per K and 0.005 per K^2 about 25 C are 0.35 per K about 30 C; z is told nothing of itself.
    let folder = tempfile::tempdir().expect("a scratch folder");
    let silent = SILENT.replace(
        "[gyro.output]\n",
        "[gyro.output]\nhalf_periods_per_sample = 8192\n",
    );
    write(
        folder.path(),
        "warm.toml",
        &format!(
            "schema = 1\nname = \"warm\"\nfidelity = \"rate\"\nduration_s = 600.0\nwarm_up_s = 2.0\n\
             {silent}[gyro.temperature.ramp]\nstart_c = 25.0\nend_c = 45.0\nrate_c_per_min = 4.0\n\
             [gyro.thermal]\nreference_c = 25.0\nindex_per_k = 0.0\nlength_ppm_per_k = 0.0\n\
             bias_deg_per_h_per_k = 0.3\ndiameter_ppm_per_k = 0.0\nbias_deg_per_h_per_k2 = 0.005\n\
             bias_deg_per_h_per_c_per_min = 0.0\n[gyro.assembly]\n\
             [compensation]\nfile = \"calibration.toml\"\n"
        ),
    );
    let table = |axis: &str| {
        format!(
            "[temperature.{axis}]\nreference_temperature_c = 30.0\nbias_deg_per_h_per_k = 0.35\n\
             bias_deg_per_h_per_k2 = 0.005\n"
        )
    };
    let head = "schema = 1\n[compensation]\nreference_temperature_c = [25.0, 25.0, 25.0]\n";
    let file = [head, &table("x"), &table("y")].concat();
    write(folder.path(), "calibration.toml", &file);
    run(folder.path(), "warm.toml");
    let [x, y, z] = mean_errors(folder.path(), "warm", "compensated");
    assert!(z > 0.2, "{z}");
    assert!(
        x.abs() < 0.02 * z && y.abs() < 0.02 * z,
        "{x}, {y} beside {z}"
    );
}

#[track_caller]
fn refused(folder: &Path, compensation: &str, more: &str) -> String {
    let text = format!(
        "schema = 1\nname = \"x\"\nduration_s = 1.0\n[gyro.assembly]\n{compensation}{more}"
    );
    write(folder, "x.toml", &text);
    let output = fogbench(folder, &["check", "x.toml"]);
    assert_eq!(code(&output), 2, "{}{}", stdout(&output), stderr(&output));
    stderr(&output)
}

#[test]
fn a_compensation_that_cannot_be_is_refused_where_it_is_wrong() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    let mut transcript = Transcript::of(COMPENSATION, "Compensations that cannot be");
    for compensation in [
        "[compensation]\nform = \"exact\"\n",
        "[compensation]\nfile = \"none.toml\"\n",
        "[compensation]\nfile = \"a.toml\"\ncampaign = \"b.toml\"\n",
        "[compensation.parameters]\nscale_factor_error_ppm = [-1e6, 0.0, 0.0]\n",
        "[compensation.parameters]\n[[filter]]\nname = \"compensated\"\n[filter.lms]\n",
        "[compensation]\nform = \"second-order\"\n[compensation.parameters]\n",
    ] {
        transcript.case(compensation, refused(at, compensation, ""));
    }
    write(
        at,
        "alone.toml",
        "name = \"alone\"\nduration_s = 1.0\n[compensation.parameters]\n",
    );
    let output = fogbench(at, &["check", "alone.toml"]);
    assert_eq!(code(&output), 2);
    transcript.case(
        "[compensation.parameters] of a single gyro",
        stderr(&output),
    );
    transcript.check();
}

#[test]
fn errors_in_a_calibration_file_point_into_that_file() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    let named = "[compensation]\nfile = \"found.toml\"\n";
    let files = [
        "schema = 1\n[compensation]\nbias_deg_h = [0.0, 0.0, 0.0]\n",
        "schema = 1\n[compensation]\nbias_deg_per_h = [0.0, 0.0]\n",
        "schema = 1\n[compensation]\n\ntheta_xy_arcsec = 1e9\n",
        "schema = 2\n[compensation]\n",
        "schema = 1\n",
        "schema = = 1\n",
    ];
    said_to_each(
        COMPENSATION,
        "Calibration files that are wrong",
        files,
        |text| {
            write(at, "found.toml", text);
            refused(at, named, "")
        },
    );
}

#[test]
fn every_repeat_of_every_channel_is_kept_printed_and_written() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let text = noisy(&format!("[compensation.parameters]\n{ERRORS}"))
        .replace("samples = \"npy\"", "samples = \"none\"")
        .replace("duration_s = 0.2", "repeats = 3\nduration_s = 0.2");
    write(folder.path(), "noisy.toml", &text);
    let printed = run(folder.path(), "noisy.toml");
    assert!(printed.contains("means over 3 runs"), "{printed}");
    assert!(printed.contains("mean of each run, deg/h"), "{printed}");
    let out = folder.path().join("out");
    let summary = summary(&out, "noisy");
    let csv = std::fs::read_to_string(out.join("noisy/runs.csv")).expect("runs.csv");
    let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 1 + 9 * 3);
    let column = rows[0]
        .iter()
        .position(|name| *name == "mean_deg_per_h")
        .expect("a column");
    let repeats = &summary["channels"]["z_compensated"]["repeats"]["mean_deg_per_h"];
    let values: Vec<f64> = repeats["values"]
        .as_array()
        .expect("values")
        .iter()
        .map(|value| value.as_f64().expect("a number"))
        .collect();
    let written: Vec<f64> = rows
        .iter()
        .filter(|row| row[0] == "z_compensated")
        .map(|row| row[column].parse().expect("a number"))
        .collect();
    let bits = |values: &[f64]| {
        values
            .iter()
            .map(|value| value.to_bits())
            .collect::<Vec<_>>()
    };
    assert_eq!(bits(&written), bits(&values));
    // Independent noise: three means that differ, and their statistics.
    assert!(
        values[0].to_bits() != values[1].to_bits() && values[1].to_bits() != values[2].to_bits()
    );
    let mean = values.iter().sum::<f64>() / 3.0;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    let told = |key: &str| repeats[key].as_f64().expect("a number");
    assert_close(told("mean"), mean, 1e-13, 0.0);
    assert_close(
        told("standard_deviation"),
        (squares / 2.0).sqrt(),
        1e-10,
        0.0,
    );
    assert_close(
        field(&summary, "z_compensated.mean_deg_per_h", "value"),
        mean,
        1e-13,
        0.0,
    );
    let smallest = field(&summary, "z_raw.minimum_deg_per_h", "value");
    let largest = field(&summary, "z_raw.maximum_deg_per_h", "value");
    let middle = field(&summary, "z_raw.mean_deg_per_h", "value");
    assert!(smallest < middle && middle < largest);
}

/// Ten silent words a second.
fn slow_and_silent() -> String {
    SILENT.replace(
        "[gyro.output]\n",
        "[gyro.output]\nhalf_periods_per_sample = 25532\n",
    )
}

/// A campaign of silent gyros, by batch least squares: whole turns of 36 s.
fn campaign() -> String {
    format!(
        "schema = 1\nname = \"campaign\"\nfidelity = \"rate\"\nduration_s = 380.0\nwarm_up_s = 5.0\n\
         [turntable.calibration]\naxes = [\"x\", \"x\", \"x\", \"y\", \"y\", \"y\", \"z\", \"z\", \"z\"]\n\
         rates_deg_per_s = [10.0, 50.0, 90.0, 10.0, 50.0, 90.0, 10.0, 50.0, 90.0]\n\
         record_s = 36.0\nchange_s = 5.0\nremount_s = 10.0\n[calibration]\nestimators = [\"batch\"]\n\
         apply = \"batch\"\n{}[gyro.assembly]\n{ERRORS}",
        slow_and_silent()
    )
}

/// A run at 50 deg/s whose compensation is the given one.
fn applied(name: &str, compensation: &str) -> String {
    format!(
        "schema = 1\nname = \"{name}\"\nfidelity = \"rate\"\nduration_s = 36.0\nwarm_up_s = 5.0\n\
         [turntable.rotation]\nrate_deg_per_s = 50.0\n[turntable.mounting]\n\
         axis_along_table = \"y\"\n[output]\nsamples = \"npy\"\n{}[gyro.assembly]\n{ERRORS}\
         [compensation]\n{compensation}",
        slow_and_silent()
    )
}

#[test]
fn a_campaign_is_run_and_its_result_applied() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    let source = write(at, "plans/campaign.toml", &campaign());
    write(
        at,
        "by-campaign.toml",
        &applied("by-campaign", "campaign = \"plans/campaign.toml\"\n"),
    );
    let printed = run(at, "by-campaign.toml");
    assert!(printed.contains("campaign campaign, batch"), "{printed}");
    for error in mean_errors(at, "by-campaign", "raw") {
        assert!(error.abs() > 1.0, "{error}");
    }
    for error in mean_errors(at, "by-campaign", "compensated") {
        // Groups are cut to whole samples: a part in 360 of the last sample's Earth rate stays.
        assert!(error.abs() < 0.02, "{error}");
    }
    // What the campaign writes of itself, applied as a file, gives the same words but for rounding.
    run(at, "plans/campaign.toml");
    write(
        at,
        "by-file.toml",
        &applied("by-file", "file = \"out/campaign/calibration.toml\"\n"),
    );
    run(at, "by-file.toml");
    let words = |name: &str| npy(&at.join(format!("out/{name}/samples/x_compensated.npy")));
    for (one, other) in words("by-campaign").iter().zip(words("by-file")) {
        assert_close(*one, other, 1e-12, 1e-8);
    }
    // The manifest holds the campaign itself.
    let first = tree(&at.join("out/by-campaign"));
    std::fs::copy(
        at.join("out/by-campaign/manifest.toml"),
        at.join("again.toml"),
    )
    .expect("a copy");
    std::fs::remove_file(source).expect("removed");
    run(at, "again.toml");
    assert_eq!(tree(&at.join("out/by-campaign")), first);
}

#[test]
fn a_campaign_that_cannot_be_is_refused_where_it_is_wrong() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    let named = "[compensation]\ncampaign = \"campaign.toml\"\n";
    let mut transcript = Transcript::of(COMPENSATION, "Campaigns that cannot be run");
    for (what, text) in [
        ("a misspelt key", campaign().replace("record_s", "recird_s")),
        ("a compensation of its own", turning("exact")),
        (
            "a table at rest",
            "name = \"rest\"\nduration_s = 1.0\n".to_owned(),
        ),
        (
            "no motion about z",
            campaign().replace("\"z\", \"z\", \"z\"", "\"x\", \"x\", \"x\""),
        ),
    ] {
        write(at, "campaign.toml", &text);
        transcript.case(format!("a campaign with {what}"), refused(at, named, ""));
    }
    transcript.check();
}
