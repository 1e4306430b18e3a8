//! Three gyros in one case: the patent's equations, independence of the axes, names and refusals.

use fogbench::gyro::{CaseGyro, Gyro, InputAxis};
use fogbench::random::Streams;
use fogbench::scenario::{AssemblyConfig, Fidelity, GyroConfig};
use fogbench::signal::MotionSegment;

use crate::support::gyro_cases::{budget_of, silent_gyro};
use crate::support::reference_gyro::reference_gyro;
use crate::support::transcript::{Transcript, said_to_each};
use crate::support::{
    assert_close, code, field, fogbench, npy, stderr, stdout, summary, tree, write,
};

/// Case of three gyros whose errors are those of the worked example of the patent's equations.
const ASSEMBLY: &str = "[gyro.assembly]\nbias_deg_per_h = [1.0, -2.0, 1.5]\n\
    scale_factor_error_ppm = [800.0, -500.0, 300.0]\ntheta_xy_arcsec = 206.26480624709636\n\
    theta_xz_arcsec = -165.01184499767709\ntheta_yx_arcsec = 123.75888374825782\n\
    theta_yz_arcsec = 247.51776749651563\ntheta_zx_arcsec = -185.63832562238672\n\
    theta_zy_arcsec = 103.13240312354818\n";

/// `[I + K_G + theta_G | B_G]` of the above as the patent's x1..x12, rows of gyros x, y, z; deg/h.
const ROWS: [[f64; 4]; 3] = [
    [1.0008, -0.8e-3, -1.0e-3, 1.0],
    [-1.2e-3, 0.9995, 0.6e-3, -2.0],
    [0.5e-3, 0.9e-3, 1.0003, 1.5],
];

/// No fast noise, no slow noise, no converter and no rounding.
const SILENT: &str = "[gyro.noise]\nshot = false\nthermal = false\namplifier = false\nrin = false\n\
    [gyro.adc]\nbits = 0\n[gyro.modulator]\ndac_bits = 0\n[gyro.output]\nrate_lsb_deg_per_s = 0.0\n\
    [gyro.slow_noise]\nbias_instability_deg_per_h = 0.0\n\
    rate_random_walk_deg_per_h_per_sqrt_h = 0.0\n";

const SHORT: &str = "schema = 1\nname = \"short\"\nduration_s = 0.5\nwarm_up_s = 0.1\n";

fn ideal() -> AssemblyConfig {
    AssemblyConfig::reference()
}

fn assembly(config: GyroConfig, fidelity: Fidelity) -> Vec<CaseGyro> {
    let config = GyroConfig {
        assembly: Some(ideal()),
        ..config
    };
    CaseGyro::assembly(&config, fidelity, 10.0, &Streams::new(3, 0)).expect("a sound gyro")
}

/// Words of gyro `axis` of an ideal case at rest, deg/h.
fn words_at_rest(gyro: &mut CaseGyro, count: usize) -> Vec<f64> {
    let rest = [MotionSegment::constant(0.0); 3];
    (0..count).map(|_| gyro.next_word(&rest)).collect()
}

#[test]
fn means_in_each_mounting_are_those_of_equation_7_of_the_patent() {
    // One turn at 10 deg/s takes 36 s, in which 50 and 90 deg/s make five and nine: the horizontal
    // Earth rate averages out but for the part of a sample that is cut off, 1 in 143 600 of it.
    let folder = tempfile::tempdir().expect("a scratch folder");
    let text = format!(
        "schema = 1\nname = \"mountings\"\nfidelity = \"rate\"\nduration_s = 36.0\n\
         warm_up_s = 2.0\n[turntable.rotation]\nrate_deg_per_s = 10.0\n\
         [turntable.site]\nlatitude_deg = 32.03\n{SILENT}{ASSEMBLY}\
         [matrix]\n\"turntable.mounting.axis_along_table\" = [\"x\", \"y\", \"z\"]\n\
         \"turntable.rotation.rate_deg_per_s\" = [10.0, 50.0, 90.0]\n"
    );
    write(folder.path(), "mountings.toml", &text);
    let output = fogbench(folder.path(), &["run", "mountings.toml", "-o", "out"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    // The Earth turns by 15.041067 deg/h; 7.977228854 deg/h of it about the vertical.
    let cut_off_deg_per_h = 12.751373115 / 143_600.0;
    let mut seen = 0;
    for point in 0..9 {
        let summary = summary(&folder.path().join("out"), &format!("mountings/{point:04}"));
        let values = &summary["scenario"]["sweep"]["point"];
        let along = values["turntable.mounting.axis_along_table"].as_str();
        let along = match along.expect("a swept text") {
            "x" => 0,
            "y" => 1,
            _ => 2,
        };
        let rate = values["turntable.rotation.rate_deg_per_s"].as_f64();
        let rate = rate.expect("a swept number");
        let turning = 3600.0 * rate + 7.977_228_854;
        for (name, row) in ["x", "y", "z"].iter().zip(ROWS) {
            let expected = row[along] * turning + row[3];
            let got = field(&summary, &format!("{name}_raw.mean_deg_per_h"), "value");
            // The printed Earth rate is right to 1e-9 deg/h; 1e-11 is the rounding of a mean.
            assert_close(got, expected, 1e-11, 1.01 * cut_off_deg_per_h + 2e-9);
            seen += 1;
        }
    }
    assert_eq!(seen, 27);
}

#[test]
fn known_answer_first_and_last_group_of_the_worked_example() {
    // Means of group 1 (10 deg/s about x) and of group 9 (90 deg/s about z), deg/s to ten digits.
    let groups: [(usize, f64, [f64; 3]); 2] = [
        (
            0,
            10.0,
            [10.010_495_447_4, -0.012_558_214_6, 0.005_417_774_6],
        ),
        (
            2,
            90.0,
            [-0.089_724_438_1, 0.053_445_774_0, 90.029_633_228_3],
        ),
    ];
    let table = ASSEMBLY.split_once('\n').expect("a header line").1;
    let table = format!(
        "{table}bias_deg_per_h_per_k = [0.0, 0.0, 0.0]\nscale_factor_ppm_per_k = [0.0, 0.0, 0.0]\n"
    );
    let config: AssemblyConfig = toml::from_str(&table).expect("a sound assembly");
    for (along, rate, expected) in groups {
        let turning_deg_per_s: f64 = rate + 7.977_228_854 / 3600.0;
        let mut case = [MotionSegment::constant(0.0); 3];
        case[along] = MotionSegment::constant(turning_deg_per_s.to_radians());
        for (axis, expected) in InputAxis::of_assembly(&config).iter().zip(expected) {
            let got = axis.sensed(&case).rate_at(1.0).to_degrees();
            assert_close(got, expected, 0.0, 6e-11);
        }
    }
}

#[test]
fn the_words_of_a_moving_case_follow_the_truth_files_sample_by_sample() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let text = format!(
        "{SHORT}fidelity = \"rate\"\n[turntable.rotation]\nrate_deg_per_s = 30.0\n\
         soft_start_s = 0.0\n[turntable.mounting]\naxis_along_table = \"y\"\n\
         [output]\nsamples = \"npy\"\n{SILENT}{ASSEMBLY}"
    );
    write(folder.path(), "short.toml", &text);
    let output = fogbench(folder.path(), &["run", "short.toml", "-o", "out"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let samples = folder.path().join("out/short/samples");
    let truth = ["x", "y", "z"].map(|axis| npy(&samples.join(format!("{axis}_truth.npy"))));
    for (axis, row) in ["x", "y", "z"].iter().zip(ROWS) {
        let words = npy(&samples.join(format!("{axis}_raw.npy")));
        assert_eq!(words.len(), truth[0].len());
        // The word is 0.2 ms late, in which the horizontal Earth rate turns by 1e-4 rad: less than
        // 15 deg/h * 1.1e-4. The loop has settled after 100 samples (25 ms, 300 time constants).
        for index in 100..words.len() {
            let expected: f64 = (0..3).map(|other| row[other] * truth[other][index]).sum();
            assert_close(words[index], expected + row[3], 1e-11, 1.7e-3);
        }
    }
}

#[test]
fn each_gyro_of_an_ideal_silent_assembly_makes_the_words_of_a_single_gyro() {
    let moves = |index: u32| MotionSegment::hermite(0.1 * f64::from(index), 0.1, 0.2, 0.05);
    let still = MotionSegment::constant(0.0);
    for fidelity in [Fidelity::Loop, Fidelity::Rate] {
        let mut single =
            Gyro::new(&silent_gyro(), fidelity, 10.0, &Streams::new(3, 0)).expect("a sound gyro");
        let single: Vec<f64> = (0..50)
            .map(|index| single.next_word(&moves(index)))
            .collect();
        for (axis, gyro) in assembly(silent_gyro(), fidelity).iter_mut().enumerate() {
            for (index, expected) in (0..50).zip(&single) {
                let mut case = [still; 3];
                case[axis] = moves(index);
                assert_eq!(gyro.next_word(&case).to_bits(), expected.to_bits());
            }
        }
    }
}

#[test]
fn the_axes_have_independent_noise_of_the_budget_each() {
    // White noise: the mean square of the difference of words one sample apart would see the loop,
    // so that means of 64 words are compared; their variance is N^2 / (64 T), spread sqrt(2/n).
    const BLOCK: usize = 64;
    const BLOCKS: usize = 4000;
    let config = reference_gyro();
    let budget = budget_of(&config, "total");
    let period_s = fogbench::gyro::sample_period_s(&config);
    let blocks: Vec<Vec<f64>> = assembly(config, Fidelity::Rate)
        .iter_mut()
        .map(|gyro| {
            words_at_rest(gyro, BLOCK * BLOCKS)
                .chunks(BLOCK)
                .map(|block| block.iter().sum::<f64>() / BLOCK as f64)
                .collect()
        })
        .collect();
    let product =
        |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / BLOCKS as f64;
    let walk_deg_per_sqrt_h = |words: &[f64]| {
        // N = sigma sqrt(T), from deg/h sqrt(s) to deg/sqrt(h).
        (product(words, words) * BLOCK as f64 * period_s).sqrt() / 60.0
    };
    let spread = 1.0 / (BLOCKS as f64).sqrt();
    for words in &blocks {
        let walk = walk_deg_per_sqrt_h(words);
        assert_close(
            walk / budget,
            1.0,
            0.0,
            5.0 * spread / 2.0_f64.sqrt() + 2e-3,
        );
    }
    for (one, other) in [(0, 1), (1, 2), (2, 0)] {
        let (one, other) = (&blocks[one], &blocks[other]);
        let scale = (product(one, one) * product(other, other)).sqrt();
        assert_close(product(one, other) / scale, 0.0, 0.0, 5.0 * spread);
    }
}

#[test]
fn channels_samples_pictures_and_tables_are_named_by_axis() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let text = format!(
        "{SHORT}fidelity = \"rate\"\n[turntable.swing]\nrate_amplitude_deg_per_s = 1.0\n\
         frequency_hz = 20.0\nsoft_start_s = 0.1\n[output]\nsamples = \"npy\"\n{ASSEMBLY}\
         [[filter]]\nname = \"lms\"\n[filter.lms]\n[[gate]]\nmetric = \"y_lms.noise_gain\"\n\
         relative_to = \"x_lms\"\nmin = 0.8\nmax = 1.25\ninconclusive = \"allow\"\n\
         [[published]]\nmetric = \"z_lms.delay_vs_raw_ms\"\nvalue = 0.4\nunit = \"ms\"\n\
         source = \"nowhere\"\n"
    );
    write(folder.path(), "short.toml", &text);
    let output = fogbench(folder.path(), &["run", "short.toml", "-o", "out"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let summary = summary(&folder.path().join("out"), "short");
    let channels: Vec<&String> = summary["channels"]
        .as_object()
        .expect("channels")
        .keys()
        .collect();
    assert_eq!(
        channels,
        ["x_raw", "y_raw", "z_raw", "x_lms", "y_lms", "z_lms"]
    );
    let run = folder.path().join("out/short");
    for channel in channels {
        let file = run.join(format!("samples/{channel}.npy"));
        assert!(file.is_file(), "{channel}");
    }
    for name in [
        "samples/x_truth.npy",
        "samples/time_s.npy",
        "x-rate.svg",
        "z-swing.svg",
    ] {
        assert!(run.join(name).is_file(), "{name}");
    }
    let picture = std::fs::read_to_string(run.join("y-rate.svg")).expect("written");
    assert!(picture.contains("y_lms") && !picture.contains("x_lms"));
    // The table turns about z alone: across it there is no delay behind the truth.
    let reason = &summary["channels"]["x_raw"]["unavailable"]["delay_vs_truth_ms"];
    assert_eq!(reason, "the table does not turn about this axis");
    assert!(field(&summary, "z_lms.delay_vs_truth_ms", "value") > 0.3);
    let table = stdout(&output);
    assert!(table.contains("z_lms.delay_vs_raw_ms"), "{table}");
}

#[test]
fn one_and_two_threads_write_the_same_bytes_for_three_axes() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let text = format!(
        "schema = 1\nname = \"case\"\nduration_s = 6.0\nwarm_up_s = 1.0\nfidelity = \"rate\"\n\
         [turntable.rotation]\nrate_deg_per_s = 10.0\n[output]\nsamples = \"npy\"\n{ASSEMBLY}\
         [[filter]]\nname = \"lms\"\n[filter.lms]\n\
         [[filter]]\nname = \"rls\"\n[filter.rls]\npipeline = \"fpga\"\n"
    );
    write(folder.path(), "case.toml", &text);
    for jobs in ["1", "2"] {
        let output = fogbench(folder.path(), &["run", "case.toml", "-j", jobs, "-o", jobs]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
    }
    let one = tree(&folder.path().join("1"));
    assert!(one.len() > 20, "{} files", one.len());
    assert!(one == tree(&folder.path().join("2")), "bytes differ");
    // A manifest is a scenario that repeats the run, assembly included.
    let output = fogbench(folder.path(), &["run", "1/case/manifest.toml", "-o", "3"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(
        one == tree(&folder.path().join("3")),
        "the manifest differs"
    );
}

#[test]
fn channels_that_do_not_exist_are_refused_with_those_that_do() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let gate = |metric: &str| format!("[[gate]]\nmetric = \"{metric}\"\nmin = 0.0\n");
    let filter = "[[filter]]\nname = \"lms\"\n[filter.lms]\n";
    let steps = "[turntable.steps]\nrates_deg_per_s = [0.0, 1.0]\ndwell_s = 0.25\n";
    let cases = [
        format!("{ASSEMBLY}{filter}{}", gate("raw.mean_deg_per_h")),
        format!("{ASSEMBLY}{filter}{}", gate("lms.mean_deg_per_h")),
        format!("{filter}{}", gate("x_raw.mean_deg_per_h")),
        format!("{ASSEMBLY}{}", gate("y_raw.noise_gain")),
        format!("{ASSEMBLY}{steps}{}", gate("x_raw.settling_time_s")),
        "[gyro.assembly]\nbias_deg_per_h = [1.0, 2.0]\n".to_owned(),
        "[gyro.assembly]\nscale_factor_error_ppm = [0, 2e5, 0]\n".to_owned(),
        "[gyro.assembly]\ntheta_xx_arcsec = 1.0\n".to_owned(),
    ];
    said_to_each(
        "assembly",
        "Channels and keys that an assembly has not",
        cases,
        |more| {
            write(folder.path(), "short.toml", &format!("{SHORT}{more}"));
            let output = fogbench(folder.path(), &["check", "short.toml"]);
            assert_eq!(code(&output), 2, "{more}");
            stderr(&output)
        },
    );
}

#[test]
fn records_that_do_not_fit_into_memory_are_refused() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let filters =
        "[[filter]]\nname = \"a\"\n[filter.lms]\n[[filter]]\nname = \"b\"\n[filter.lms]\n";
    let case = |duration_s: f64| {
        let head = format!("name = \"long\"\nduration_s = {duration_s}\nfidelity = \"rate\"\n");
        write(
            folder.path(),
            "long.toml",
            &format!("{head}{ASSEMBLY}{filters}"),
        );
        fogbench(folder.path(), &["check", "long.toml"])
    };
    // Twelve records: truth, raw and two filters for each of three gyros, 1.8e8 words in all.
    let hour = case(3600.0);
    assert_eq!(code(&hour), 0, "{}", stderr(&hour));
    let longer = case(3800.0);
    assert_eq!(code(&longer), 2);
    let mut transcript = Transcript::of("assembly", "Records that do not fit into memory");
    transcript.case("twelve records of 3800 s", stderr(&longer));
    transcript.check();
}

#[test]
fn the_expanded_scenario_shows_the_assembly_with_its_defaults_and_none_without() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(folder.path(), "short.toml", SHORT);
    let expanded = |sets: &[&str]| {
        let output = fogbench(folder.path(), &[&["expand", "short.toml"], sets].concat());
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        stdout(&output)
    };
    assert!(!expanded(&[]).contains("assembly"));
    let text = expanded(&["--set", "gyro.assembly.theta_xy_arcsec=2"]);
    assert!(text.contains("[gyro.assembly]\nbias_deg_per_h = [0.0, 0.0, 0.0]\n"));
    assert!(text.contains("theta_xy_arcsec = 2.0\n") && text.contains("theta_zy_arcsec = 0.0\n"));
}
