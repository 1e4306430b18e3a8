//! Hardware pipelines as filters of the bench.

use std::path::PathBuf;

use fogbench::experiment::plan_suite;
use fogbench::filters::FilterConfig;
use fogbench::filters::hardware::HardwareFilter;
use fogbench::filters::{
    DivergenceKind, Filter, FrontEndConfig, Lms, LmsConfig, Normalisation, Rls, RlsConfig,
};
use fogbench::fpga::front_end::{FrontEnd, Pair};
use fogbench::fpga::lms::{self, DesiredSource, LmsPipeline, LmsSettings};
use fogbench::fpga::rls::{self, RlsPipeline, RlsSettings};
use fogbench::vocabulary::{DesiredSignal, Division, OutputRegister, UpdateSign};

use crate::support::transcript::said_to_each;
use crate::support::{code, fogbench, stderr, stdout, summary, write};

const RLS: &str = "name = \"rls\"\n[rls]\ntaps = 4\nforgetting_factor = 0.99\n\
    initial_inverse_correlation = 7.716e-4\ndesired = \"current\"\ninput_lag_samples = 1\n\
    output_register = \"next-sample\"\nupdate_sign = \"corrected\"\npipeline = \"fpga\"\n\
    number_format = \"binary64\"\nclock_mhz = 40.0\ndivision = \"reciprocal\"\n\
    update_order = \"schedule\"\n";
const LMS: &str = "name = \"lms\"\n[lms]\ntaps = 10\nstep_size = 0.8\nnormalised = true\n\
    regularisation_deg2_per_h2 = 1.0\nallow_unstable = false\ndesired = \"two-sample-mean\"\n\
    input_lag_samples = 0\noutput_register = \"next-sample\"\nupdate_sign = \"corrected\"\n\
    pipeline = \"fpga\"\nnumber_format = \"binary64\"\nclock_mhz = 40.0\n";

fn filter(text: &str) -> Box<dyn HardwareFilter> {
    let config: FilterConfig = toml::from_str(text).expect("a filter");
    let settings = config.kind.settings().hardware().expect("a pipeline");
    settings.filter(0).expect("sound constants")
}

/// Earth rate and something like the gyro's noise, deg/h.
fn words(count: usize) -> Vec<f64> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    (0..count)
        .map(|_| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let uniform = f64::from(u32::try_from(state >> 32).expect("32 bits")) / 4_294_967_296.0;
            8.47 + 60.0 * (uniform - 0.5)
        })
        .collect()
}

fn outputs(filter: &mut dyn Filter, words: &[f64]) -> Vec<f64> {
    words
        .iter()
        .map(|word| filter.step(*word).expect("no divergence").value_deg_per_h)
        .collect()
}

fn bits(words: &[f64]) -> Vec<u64> {
    words.iter().map(|word| word.to_bits()).collect()
}

/// The words of the clocked pipeline behind the register that holds them for a sample.
fn held(mut words: Vec<f64>) -> Vec<f64> {
    words.insert(0, 0.0);
    words.pop();
    words
}

#[test]
fn the_bench_has_the_bits_of_the_clocked_rls_pipeline() {
    let words = words(2000);
    let settings = RlsSettings {
        tap_count: 4,
        forgetting_factor: 0.99,
        initial_inverse_correlation: 7.716e-4,
        division: Division::Reciprocal,
        update_sign: fogbench::vocabulary::UpdateSign::Corrected,
    };
    let mut front_end = FrontEnd::one_step_predictor();
    let pairs: Vec<Pair<f64>> = words.iter().map(|word| front_end.pair(*word)).collect();
    let mut clocked = Vec::new();
    RlsPipeline::new(rls::RlsConfig::new(settings).expect("sound")).run(&pairs, &mut clocked);
    let bench = outputs(filter(RLS).as_mut(), &words);
    assert_eq!(bits(&bench), bits(&held(clocked.clone())));
    assert_ne!(bits(&bench), bits(&clocked), "the register must show");
}

#[test]
fn the_bench_has_the_bits_of_the_clocked_lms_pipeline() {
    let words = words(2000);
    let settings = LmsSettings {
        tap_count: 10,
        step_size: 0.8,
        regularisation: Some(1.0),
        desired: DesiredSource::MeanOfTwoNewest,
        update_sign: fogbench::vocabulary::UpdateSign::Corrected,
    };
    let pairs: Vec<Pair<f64>> = words
        .iter()
        .map(|word| Pair::from_f64(*word, 0.0))
        .collect();
    let mut clocked = Vec::new();
    LmsPipeline::new(lms::LmsConfig::new(settings).expect("sound")).run(&pairs, &mut clocked);
    let bench = outputs(filter(LMS).as_mut(), &words);
    assert_eq!(bits(&bench), bits(&held(clocked)));
    // Behind a lag the front end forms the mean; with a lag of 0 samples both must agree with it.
    let lagged = LMS.replace("input_lag_samples = 0", "input_lag_samples = 2");
    assert_ne!(
        bits(&outputs(filter(&lagged).as_mut(), &words)),
        bits(&bench)
    );
}

#[test]
fn hardware_and_textbook_agree_to_rounding() {
    let words = words(5000);
    let front_end = |desired, input_lag_samples| FrontEndConfig {
        desired,
        input_lag_samples,
        output_register: OutputRegister::NextSample,
    };
    let mut rls = Rls::new(&RlsConfig {
        taps: 4,
        forgetting_factor: 0.99,
        initial_inverse_correlation: 7.716e-4,
        update_sign: UpdateSign::Corrected,
        front_end: front_end(DesiredSignal::Current, 1),
    });
    let mut lms = Lms::new(&LmsConfig {
        taps: 10,
        step_size: 0.8,
        normalisation: Normalisation::Energy {
            regularisation_deg2_per_h2: 1.0,
        },
        update_sign: UpdateSign::Corrected,
        front_end: front_end(DesiredSignal::TwoSampleMean, 0),
    });
    let pairs: [(&mut dyn Filter, Box<dyn HardwareFilter>); 2] =
        [(&mut rls, filter(RLS)), (&mut lms, filter(LMS))];
    for (textbook, mut hardware) in pairs {
        assert_eq!(textbook.shape(), hardware.shape());
        let textbook = outputs(textbook, &words);
        let hardware = outputs(hardware.as_mut(), &words);
        // Some thousand roundings of 38 deg/h, none of which is amplified: 1e-10 of it is ample.
        for (index, (got, want)) in hardware.iter().zip(&textbook).enumerate() {
            assert!((got - want).abs() < 4e-9, "sample {index}: {got}, {want}");
        }
        assert_ne!(
            bits(&textbook),
            bits(&hardware),
            "the orders of operations differ"
        );
    }
}

#[test]
fn a_word_that_is_not_finite_poisons_the_hardware_and_is_reported() {
    for text in [RLS, LMS] {
        let mut hardware = filter(text);
        for word in words(100) {
            hardware.step(word).expect("finite so far");
        }
        let divergence = hardware.step(f64::NAN).expect_err("a NaN is reported");
        assert_eq!(divergence.sample, 100);
        assert_eq!(divergence.kind, DivergenceKind::NotFinite);
        for word in words(20) {
            assert_eq!(hardware.step(word).expect_err("for good"), divergence);
        }
        let poisoned = hardware.weights().iter().all(|weight| weight.is_nan());
        assert!(poisoned, "{:?}", hardware.weights());
    }
}

fn scenario(more: &str) -> String {
    format!(
        "schema = 1\nname = \"s\"\nduration_s = 4.0\nwarm_up_s = 1.0\nfidelity = \"rate\"\n{more}"
    )
}

fn planned(more: &str) -> Result<Vec<String>, Vec<String>> {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(folder.path(), "s.toml", &scenario(more));
    let path: PathBuf = folder.path().join("s.toml");
    match plan_suite(&[path], &[]) {
        Ok(plans) => Ok(plans[0].warnings().to_vec()),
        Err(errors) => Err(errors.iter().map(ToString::to_string).collect()),
    }
}

#[test]
fn lost_digits_are_warned_of_by_word_format() {
    let turning = |rate: &str, filter: &str| {
        planned(&format!(
            "[turntable.rotation]\nrate_deg_per_s = {rate}\n[[filter]]\nname = \"f\"\n\
             [filter.rls]\npipeline = \"fpga\"\n{filter}"
        ))
        .expect("sound")
    };
    // delta p x^2 = 7.716e-4 * 4 * (10 * 3600)^2 = 4.0e6.
    assert!(turning("10.0", "").is_empty());
    let lossy = [
        "number_format = \"binary32\"\n",
        "initial_inverse_correlation = 10.0\n",
    ];
    said_to_each(
        "hardware",
        "Lost digits are warned of by word format",
        lossy,
        |filter| turning("10.0", filter).join("\n"),
    );
}

#[test]
fn hardware_that_cannot_be_is_refused_where_it_is_written() {
    let cases = [
        "[filter.rls]\npipeline = \"fpga\"\nclock_mhz = 0.4\n",
        "[filter.rls]\ndivision = \"elementwise\"\n",
        "[filter.lms]\npipeline = \"fpga\"\nregularisation_deg2_per_h2 = 0.0\n",
        "[filter.lms]\n[[gate]]\nmetric = \"f.latency_us\"\nmax = 1.0\n",
    ];
    said_to_each(
        "hardware",
        "Filters that cannot be put into hardware",
        cases,
        |more| {
            let planned = planned(&format!("[[filter]]\nname = \"f\"\n{more}"));
            planned.expect_err(more).join("\n")
        },
    );
    // A default that is spelt out is no contradiction: a manifest spells out everything.
    assert!(planned("[[filter]]\nname = \"f\"\n[filter.rls]\nclock_mhz = 40.0\n").is_ok());
}

#[test]
fn the_delay_of_an_immediate_result_includes_the_latency_of_the_pipeline() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let filters: String = [
        ("immediate", "fpga", "immediate"),
        ("textbook", "textbook", "immediate"),
        ("held", "fpga", "next-sample"),
    ]
    .map(|(name, pipeline, register)| {
        format!(
            "[[filter]]\nname = \"{name}\"\n[filter.lms]\npipeline = \"{pipeline}\"\n\
             output_register = \"{register}\"\n"
        )
    })
    .concat();
    let swing = "[turntable.swing]\nrate_amplitude_deg_per_s = 1.0\nfrequency_hz = 5.0\n";
    let text = scenario(&format!("{swing}{filters}"));
    write(folder.path(), "s.toml", &text);
    let output = fogbench(folder.path(), &["run", "s.toml"]);
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    let summary = summary(&folder.path().join("output"), "s");
    let delay = |channel: &str, metric: &str| {
        summary["channels"][channel][metric]["value"]
            .as_f64()
            .expect("a delay")
    };
    for metric in ["delay_vs_raw_ms", "delay_vs_truth_ms"] {
        // NLMS of 10 taps: 23 clocks of 25 ns. Rounding differs by 1e-9 of the sample period.
        let latency = delay("immediate", metric) - delay("textbook", metric);
        assert!((latency - 23.0 * 25e-6).abs() < 1e-8, "{metric}: {latency}");
        let register = delay("held", metric) - delay("textbook", metric);
        assert!(
            (register - 1e3 / 3989.45).abs() < 1e-5,
            "{metric}: {register}"
        );
    }
}
