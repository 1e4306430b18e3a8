//! The line enhancer of patent CN101221046 against known answers of an independent implementation
//! and the laws it obeys.

use fogbench::filters::{
    Core, Filter, FixedFilter, SignLms, SignLmsConfig, SignLmsCore, moving_average,
    sign_lms_slew_samples,
};
use fogbench::metrics::predict;
use fogbench::vocabulary::{OutputRegister, SignLmsForm};

use crate::support::transcript::{Transcript, said_to_each};
use crate::support::{assert_close, code, field, fogbench, stderr, stdout, summary, write};

const TAPS: usize = 20;

/// The patent's constants, in the unit of the words.
fn patent(form: SignLmsForm, initial_weight: f64) -> SignLmsConfig {
    SignLmsConfig {
        taps: TAPS,
        delay_samples: 15,
        form,
        step: 0.005,
        regularisation: 0.0001,
        initial_weight,
        guard: None,
        norm_recompute_samples: 0,
        output_register: OutputRegister::Immediate,
    }
}

/// Uniform noise of unit variance from a linear congruential generator of 32 bits.
fn uniform(count: usize) -> Vec<f64> {
    let mut state = 12_345_u32;
    (0..count)
        .map(|_| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            ((f64::from(state) + 0.5) / 4_294_967_296.0 - 0.5) * 12.0_f64.sqrt()
        })
        .collect()
}

fn stimulus(mean: f64, noise: f64) -> Vec<f64> {
    let draw = |draw: f64| mean + noise * draw;
    uniform(20_000).into_iter().map(draw).collect()
}

fn outputs(filter: &mut dyn Filter, words: &[f64]) -> Vec<f64> {
    words
        .iter()
        .map(|word| filter.step(*word).expect("no divergence").value_deg_per_h)
        .collect()
}

/// One row of the known answers: `y` at samples 16, 100, 1000, 19999, mean and standard deviation
/// of the last 10000 and the sum of the weights after the last, with the digits given.
struct Known {
    mean: f64,
    noise: f64,
    initial_weight: f64,
    y: [f64; 4],
    last: [f64; 2],
    weight_sum: f64,
}

#[track_caller]
fn check(known: &Known) {
    let words = stimulus(known.mean, known.noise);
    // A norm summed afresh now and then changes nothing that these digits show.
    for norm_recompute_samples in [0, 20, 1000] {
        let mut filter = SignLms::new(&SignLmsConfig {
            norm_recompute_samples,
            ..patent(SignLmsForm::Sign, known.initial_weight)
        });
        let y = outputs(&mut filter, &words);
        if known.initial_weight.abs() < f64::MIN_POSITIVE {
            assert!(y[14].abs() < f64::MIN_POSITIVE, "y(14) = {}", y[14]);
        }
        for (sample, want) in [16, 100, 1000, 19_999].into_iter().zip(known.y) {
            assert_close(y[sample], want, 2e-9, 0.0);
        }
        let last = &y[10_000..];
        let mean = last.iter().sum::<f64>() / 1e4;
        let square = last.iter().map(|value| (value - mean).powi(2)).sum::<f64>();
        assert_close(mean, known.last[0], 1e-7, 0.0);
        assert_close((square / 1e4).sqrt(), known.last[1], 1e-7, 0.0);
        let sum: f64 = filter.weights().iter().sum();
        assert_close(sum, known.weight_sum, 3e-8, 0.0);
    }
}

#[test]
fn the_generator_of_the_known_answers_is_theirs() {
    let draws = uniform(20_000);
    for (got, want) in draws
        .iter()
        .zip([-1.661_373_83, -1.674_727_38, 0.149_496_06])
    {
        assert_close(*got, want, 0.0, 5e-9);
    }
    assert_close(draws.iter().sum(), -148.508_074_258_4, 0.0, 1e-9);
}

#[test]
fn patent_k1_climbs_to_fifty_from_zero_weights() {
    check(&Known {
        mean: 50.0,
        noise: 0.02,
        initial_weight: 0.0,
        y: [
            0.004_999_973_075,
            0.425_068_326_1,
            4.924_230_751,
            49.993_996_68,
        ],
        last: [49.999_812, 0.009_991_779_7],
        weight_sum: 0.999_907_68,
    });
}

#[test]
fn patent_k2_noise_as_large_as_the_rate_from_zero_weights() {
    check(&Known {
        mean: 8.0,
        noise: 10.0,
        initial_weight: 0.0,
        y: [
            0.005_077_506_243,
            0.140_351_037_5,
            0.449_085_039_1,
            8.559_636_701,
        ],
        last: [6.270_307, 1.859_852_9],
        weight_sum: 0.870_673_39,
    });
}

#[test]
fn patent_k3_noise_as_large_as_the_rate_from_mean_weights() {
    check(&Known {
        mean: 8.0,
        noise: 10.0,
        initial_weight: 1.0 / 20.0,
        y: [
            -0.862_973_098_7,
            11.438_892_23,
            4.323_002_913,
            9.684_804_281,
        ],
        last: [7.928_303, 2.285_692_3],
        weight_sum: 0.985_429_09,
    });
}

#[test]
fn patent_k4_rates_in_radians_per_second_from_zero_weights() {
    check(&Known {
        mean: 4e-5,
        noise: 5e-5,
        initial_weight: 0.0,
        y: [
            9.418_166_219e-8,
            6.296_822_351e-5,
            1.996_364_241e-6,
            4.155_442_193e-5,
        ],
        last: [3.600_943_4e-5, 1.761_549_9e-5],
        weight_sum: 0.986_577_51,
    });
}

#[test]
fn patent_k5_rates_in_degrees_per_second_from_zero_weights() {
    check(&Known {
        mean: 0.0022,
        noise: 0.0026,
        initial_weight: 0.0,
        y: [
            0.000_218_492_784_8,
            -0.000_791_151_908_7,
            -0.001_338_526_431,
            0.001_316_609_025,
        ],
        last: [0.002_134_094_7, 0.003_066_840_9],
        weight_sum: 2.205_638_1,
    });
}

#[test]
fn patent_known_answers_of_the_norm_and_of_the_normalised_forms() {
    let [k1, k2] = [(50.0, 0.02), (8.0, 10.0)].map(|(mean, noise)| stimulus(mean, noise));
    for (words, want) in [(&k1, 50_007.206_64), (&k2, 3_634.958_857)] {
        let mut core = SignLmsCore::new(&patent(SignLmsForm::Sign, 0.0));
        let mut line = vec![0.0; 15];
        line.extend_from_slice(words);
        for (n, word) in words.iter().enumerate() {
            let taps: Vec<f64> = (0..=TAPS)
                .map(|age| n.checked_sub(age).map_or(0.0, |at| line[at]))
                .collect();
            core.update(&taps, *word).expect("a sound state");
        }
        assert_close(core.norm(), want, 2e-10, 0.0);
    }
    for (words, form, initial_weight, want) in [
        (&k1, SignLmsForm::Nlms, 0.0, [49.633_659_47, 50.004_238_52]),
        (&k2, SignLmsForm::Nlms, 0.0, [3.293_937_85, 9.267_784_801]),
        (
            &k2,
            SignLmsForm::UnityGain,
            0.05,
            [4.000_689_393, 9.498_822_841],
        ),
    ] {
        let mut filter = SignLms::new(&patent(form, initial_weight));
        let y = outputs(&mut filter, words);
        assert_close(y[1000], want[0], 2e-9, 0.0);
        assert_close(y[19_999], want[1], 2e-9, 0.0);
    }
}

#[test]
fn patent_slew_law_of_the_sign_form() {
    // 50 deg/s in deg/s from zero weights: 9916 samples to 99 %, to the noise of the count.
    let config = patent(SignLmsForm::Sign, 0.0);
    for (rate, law) in [(50.0, 9916.0), (8.0, 1600.0)] {
        let y = outputs(&mut SignLms::new(&config), &vec![rate; 12_000]);
        let reached = y.iter().position(|value| *value >= 0.99 * rate);
        let reached = reached.expect("it gets there") as f64;
        assert_close(reached, law, 0.0, 1.0);
        assert_close(sign_lms_slew_samples(&config, rate), reached, 0.0, 1.0);
    }
    let fast = outputs(&mut SignLms::new(&config), &[0.872_665; 400]);
    let reached = fast.iter().position(|value| *value >= 0.99 * 0.872_665);
    assert_eq!(reached, Some(188));
}

#[test]
fn a_recursive_norm_in_binary64_keeps_what_a_fast_rotation_leaves_in_it() {
    let final_norm = |norm_recompute_samples| {
        let mut filter = SignLms::new(&SignLmsConfig {
            norm_recompute_samples,
            ..patent(SignLmsForm::Sign, 0.05)
        });
        let noise = uniform(200_000);
        let words: Vec<f64> = noise
            .iter()
            .enumerate()
            .map(|(n, draw)| if n < 100_000 { 50.0 } else { 0.0 } + 0.003 * draw)
            .collect();
        outputs(&mut filter, &words);
        let window = words[words.len() - 15 - TAPS..words.len() - 15].iter();
        let exact: f64 = window.map(|word| word * word).sum();
        (filter.core().norm(), exact)
    };
    let (recursive, exact) = final_norm(0);
    // Some 2e5 roundings of 5e4: 7e-12 each, 3e-9 as a walk; the digits of binary64 allow no more.
    assert_close(recursive, exact, 0.0, 3e-8);
    assert!((recursive - exact).abs() > 1e-12, "{recursive} {exact}");
    let (fresh, exact) = final_norm(1000);
    assert_close(fresh, exact, 1e-12, 0.0);
}

#[test]
fn the_converged_filter_is_24_and_a_half_samples_late() {
    // On a ramp slow enough for the weights to stay what they are, from 1/M with a tiny step.
    let mut filter = SignLms::new(&SignLmsConfig {
        step: 1e-9,
        ..patent(SignLmsForm::Sign, 0.05)
    });
    let words: Vec<f64> = (0..1000).map(|n| 1.0 + 0.01 * f64::from(n)).collect();
    let y = outputs(&mut filter, &words);
    assert_close((words[999] - y[999]) / 0.01, 24.5, 1e-4, 0.0);
    // Behind the register one more; the fixed mean behind the same delay has just this delay.
    let mut fixed = FixedFilter::delayed(moving_average(TAPS), 15, OutputRegister::NextSample);
    let y = outputs(&mut fixed, &words);
    assert_close((words[999] - y[999]) / 0.01, 25.5, 1e-9, 0.0);
    let shape = filter.shape();
    assert_eq!((shape.taps, shape.newest_age_samples), (Some(TAPS), 15));
    // White noise of variance 90 on a rate of 8: g = M s^2 / (M s^2 + sigma^2).
    let second_moment: Vec<f64> = (0..60)
        .map(|lag| 64.0 + if lag == 0 { 90.0 } else { 0.0 })
        .collect();
    let gain = predict(&shape, &second_moment).expect("power").dc_gain();
    assert_close(gain, 1280.0 / 1370.0, 1e-9, 0.0);
}

#[test]
fn the_guard_carries_the_weights_over_a_step_of_rate() {
    // 0 to 50 deg/s in deg/h with noise of 0.003 deg/s.
    let noise = uniform(12_000);
    let words: Vec<f64> = noise
        .iter()
        .enumerate()
        .map(|(n, draw)| 3600.0 * (if n < 6000 { 0.0 } else { 50.0 } + 0.003 * draw))
        .collect();
    let gains = |guard: Option<f64>| {
        let mut filter = SignLms::new(&SignLmsConfig {
            guard,
            ..patent(SignLmsForm::Sign, 0.05)
        });
        let mut gain_after = |words: &[f64]| {
            outputs(&mut filter, words);
            filter.weights().iter().sum::<f64>()
        };
        [
            gain_after(&words[..6000]),
            gain_after(&words[6000..6034]),
            gain_after(&words[6034..]),
        ]
    };
    let [before, after, later] = gains(Some(10.0 * 0.003 * 3600.0));
    assert_eq!(before.to_bits(), after.to_bits());
    // What is left of the error is that of the gain, which noise alone has worn at rest. It stays
    // beyond the guard, which lets go: each sample then raises the output by the step.
    assert!(before > 0.8 && before < 0.99, "{before}");
    assert!(later > after, "{after} {later}");
    let [before, after, _] = gains(None);
    assert!((after - before).abs() > 1e-5, "{before} {after}");
}

fn run(more: &str) -> (serde_json::Value, String) {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let text = format!(
        "schema = 1\nname = \"s\"\nduration_s = 6.0\nwarm_up_s = 2.0\nfidelity = \"rate\"\n{more}"
    );
    write(folder.path(), "s.toml", &text);
    let output = fogbench(folder.path(), &["run", "s.toml"]);
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    let text = stdout(&output);
    (summary(&folder.path().join("output"), "s"), text)
}

#[test]
fn the_dc_gain_of_a_line_enhancer_shows_in_its_trial() {
    let filters: String = ["sign", "nlms", "unity-gain"]
        .map(|form| {
            format!(
                "[[filter]]\nname = \"{form}\"\n[filter.sign_lms]\nform = \"{form}\"\nstep = 0.02\n"
            )
        })
        .concat();
    let fixed = "[[filter]]\nname = \"mean\"\n[filter.moving_average]\ntaps = 20\n\
                 delay_samples = 15\n";
    let (summary, text) = run(&format!("{filters}{fixed}"));
    // The replayed gain equals mean out over mean in where the weights hardly correlate with the
    // words; the unity-gain form and the fixed mean have it exactly.
    for form in ["unity-gain", "mean"] {
        let gain = field(&summary, &format!("{form}.dc_gain"), "value");
        assert_close(gain, 1.0, 1e-9, 0.0);
    }
    let at = |metric: &str| field(&summary, metric, "value");
    for form in ["sign", "nlms"] {
        let gain = at(&format!("{form}.dc_gain"));
        assert!(gain < 0.97, "{form}: {gain}");
        assert_close(gain, at(&format!("{form}.mean_ratio")), 0.1, 0.0);
        // The prediction is the equilibrium M s^2 / (M s^2 + sigma^2).
        let predicted = at(&format!("{form}.dc_gain_predicted"));
        assert_close(gain, predicted, 0.15, 0.0);
    }
    let delay_ms = at("sign.delay_at_dc_ms");
    assert_close(delay_ms, 25.5 * 1e3 / 3989.45, 0.05, 0.0);
    assert!(text.contains("step = 0.02 deg/h"), "{text}");
}

#[test]
fn three_line_enhancers_stand_behind_the_three_gyros_of_an_assembly() {
    let (summary, _) = run(
        "[turntable.rotation]\nrate_deg_per_s = 10.0\n[gyro.assembly]\n\
         theta_yx_arcsec = 200.0\n[[filter]]\nname = \"ale\"\n[filter.sign_lms]\n\
         guard_deg_per_h = 2000.0\n",
    );
    for axis in ["x", "y", "z"] {
        let gain = field(&summary, &format!("{axis}_ale.dc_gain"), "value");
        assert!(gain > 0.2 && gain < 1.1, "{axis}: {gain}");
    }
}

/// Exit code of a check of a line enhancer with more keys, and all that is said.
fn checked(more: &str) -> (i32, String) {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let text = format!(
        "schema = 1\nname = \"s\"\nduration_s = 6.0\nwarm_up_s = 2.0\nfidelity = \"rate\"\n\
         [turntable.rotation]\nrate_deg_per_s = 50.0\n\
         [[filter]]\nname = \"ale\"\n[filter.sign_lms]\n{more}"
    );
    write(folder.path(), "s.toml", &text);
    let output = fogbench(folder.path(), &["check", "s.toml"]);
    let said = format!("{}{}", stdout(&output), stderr(&output));
    (code(&output), said)
}

#[test]
fn constants_of_a_line_enhancer_that_contradict_each_other_are_refused() {
    let cases = [
        "form = \"nlms\"\nstep = 2.0\n",
        "norm_recompute_samples = 19\n",
        "form = \"unity-gain\"\npipeline = \"fpga\"\n",
        "form = \"unity-gain\"\ninitial_weights = \"zero\"\n",
        "clock_mhz = 41.0\n",
    ];
    said_to_each(
        "filters",
        "Constants of a line enhancer that contradict each other",
        cases,
        |more| {
            let (code, said) = checked(more);
            assert_eq!(code, 2, "{said}");
            said
        },
    );
}

#[test]
fn a_step_too_small_for_the_record_or_too_large_for_the_noise_is_warned_of() {
    // From zero: 0.99 * 180000 deg/h at 0.005 deg/h a sample and 3989 samples a second: 2.5 h.
    // In rad/s the step is coarse; the reference line enhancer is sound.
    let cases = ["initial_weights = \"zero\"\n", "unit = \"rad/s\"\n", ""];
    let title = "Steps of a line enhancer too small for the record or too large for the noise";
    let mut transcript = Transcript::of("filters", title);
    for more in cases {
        let (code, said) = checked(more);
        assert_eq!(code, 0, "{said}");
        transcript.case(if more.is_empty() { "(no key)" } else { more }, said);
    }
    transcript.check();
}
