//! Fixed-point LMS, NLMS and line enhancer: engine, clocked pipeline and RTL hold the same words in every
//! clock, and wide words those of the floating-point filter.

use fogbench::fpga::engine::Engine as _;
use fogbench::fpga::fixed::lms::{FixedLmsConfig, FixedLmsSettings};
use fogbench::fpga::fixed::sign_lms::{FixedSignLmsConfig, FixedSignLmsSettings};
use fogbench::fpga::fixed::{
    CodePair, FixedConfig, Format, LmsFormats, Overflow, Rounding, SignalName, fixed_board_usage,
    fixed_clearing_clocks, fixed_usage,
};
use fogbench::fpga::front_end::Pair;
use fogbench::fpga::lms::{DesiredSource, LmsConfig, LmsEngine, LmsSettings};
use fogbench::fpga::sign_lms::{SignLmsConfig, SignLmsEngine, SignLmsSettings};
use fogbench::vocabulary::UpdateSign;

use crate::support::fixed::{
    Draws, OVERFLOWS, ROUNDINGS, check_noticed, check_resets, check_rtl, export, for_each_seed,
    has, pairs, pipelined, run, simulate,
};
use crate::support::{code, fogbench, is_long_rtl, stderr, stdout, summary, write};

/// Mixes of each kind: plain LMS, NLMS, line enhancer by the sign, line enhancer normalised.
const MIXES: u32 = 48;

/// Formats of one width.
fn uniform(width: u32, rounding: Rounding, overflow: Overflow) -> LmsFormats {
    let format = |integer_bits| Format {
        integer_bits,
        fraction_bits: width - integer_bits,
        rounding,
        overflow,
    };
    LmsFormats {
        input: format(1),
        desired: format(1),
        intermediate: format(3),
        denominator: format(5),
        gain: format(6),
        weight: format(3),
        output: format(1),
    }
}

/// A filter of one of the four forms.
fn filter(form: u32, tap_count: usize, formats: LmsFormats) -> Option<FixedConfig> {
    let normalised = form % 2 == 1;
    if form < 2 {
        let settings = FixedLmsSettings {
            tap_count,
            step_size: if normalised { 0.5 } else { 0.1 },
            regularisation: normalised.then_some(0.01),
            formats,
        };
        return FixedLmsConfig::new(settings).ok().map(FixedConfig::Lms);
    }
    let settings = FixedSignLmsSettings {
        tap_count,
        delay_samples: 2,
        normalised,
        step: if normalised { 0.5 } else { 0.05 },
        regularisation: 0.01,
        initial_weight: 0.25,
        guard: (tap_count != 4).then_some(0.125),
        formats,
    };
    FixedSignLmsConfig::new(settings)
        .ok()
        .map(FixedConfig::SignLms)
}

/// A mix: every form in turn, every rounding with every overflow, widths and points drawn by the seed.
fn mix(seed: u32) -> FixedConfig {
    let mut draws = Draws(u64::from(seed) << 20 | 1);
    let rounding = ROUNDINGS[seed as usize / 4 % 3];
    let overflow = OVERFLOWS[seed as usize / 12 % 2];
    let mut formats = uniform(15, rounding, overflow);
    for format in [
        &mut formats.input,
        &mut formats.desired,
        &mut formats.intermediate,
        &mut formats.denominator,
        &mut formats.gain,
        &mut formats.weight,
        &mut formats.output,
    ] {
        let width = 12 + draws.below(37);
        format.integer_bits = (format.integer_bits + draws.below(3)).min(width - 1);
        format.fraction_bits = width - format.integer_bits;
    }
    let taps = [1, 4, 8, 2, 3][seed as usize / 4 % 5];
    // A few of the drawn formats need more exact bits than there are: the next seed of the form then.
    filter(seed % 4, taps, formats).unwrap_or_else(|| mix(seed + 1000))
}

#[test]
fn fixed_lms_engines_and_pipelines_agree_in_forty_eight_mixes() {
    let mut overflowed = [0; 4];
    for seed in 0..MIXES {
        let config = mix(seed);
        let pairs = pairs(&config, 150);
        let mut engine = config.as_pipeline().engine();
        let wanted: Vec<i64> = pairs.iter().map(|pair| engine.process(*pair)).collect();
        let (words, [rama, ramb]) = run(&config, &pairs);
        assert_eq!(words, wanted, "{seed}");
        assert_eq!(ramb, engine.weights(), "{seed}");
        // The ring holds the newest words, the newest of all in the slot of its number.
        for (age, pair) in pairs.iter().rev().take(rama.len()).enumerate() {
            let slot = (pairs.len() - 1 - age) % rama.len();
            assert_eq!(rama[slot], pair.input, "{seed}");
        }
        assert!(wanted.iter().any(|word| *word != wanted[0]), "{seed}");
        let overflows = engine.health().overflows;
        let counts = SignalName::ALL.map(|name| overflows.of(name));
        overflowed[seed as usize % 4] += counts.iter().sum::<u64>();
    }
    assert!(overflowed.iter().all(|count| *count > 0), "{overflowed:?}");
}

#[test]
fn fixed_lms_reset_in_any_clock_leaves_nothing_of_the_past() {
    for seed in 0..4 {
        let config = mix(seed + 4);
        let taps = config.as_pipeline().tap_count();
        check_resets(&config, taps);
        assert_eq!(fixed_clearing_clocks(config.as_pipeline()), taps as u64);
    }
}

/// Largest and root-mean-square distance of the fixed-point words from those of a filter in binary64.
fn distance(config: &FixedConfig, mut float: impl FnMut(Pair<f64>) -> f64) -> (f64, f64) {
    let pipeline = config.as_pipeline();
    let formats = pipeline.tap_formats();
    let mut engine = pipeline.engine();
    let (mut worst, mut squares): (f64, f64) = (0.0, 0.0);
    let pairs = pairs(config, 4000);
    for CodePair {
        input: x,
        desired: d,
    } in &pairs
    {
        let pair = Pair::from_f64(formats.input.value(*x), formats.desired.value(*d));
        let word = engine.process(CodePair {
            input: *x,
            desired: *d,
        });
        let off = (formats.output.value(word) - float(pair)).abs();
        worst = worst.max(off);
        squares += off * off;
    }
    let health = engine.health();
    assert_eq!(health.indefinite_at, None);
    assert!(
        SignalName::ALL
            .iter()
            .all(|name| health.overflows.of(*name) == 0),
        "{health:?}"
    );
    (worst, (squares / 4000.0).sqrt())
}

#[test]
fn wide_fixed_lms_words_follow_the_floating_point_filters() {
    let mut formats = uniform(48, Rounding::HalfUp, Overflow::Saturate);
    // The step over an empty ring is 50, and the first weights overshoot: nothing is to reach an end.
    for (format, integer_bits) in [
        (&mut formats.gain, 8),
        (&mut formats.intermediate, 8),
        (&mut formats.weight, 8),
        (&mut formats.output, 4),
    ] {
        format.integer_bits = integer_bits;
        format.fraction_bits = 48 - integer_bits;
    }
    for (form, regularisation) in [(0, None), (1, Some(0.01))] {
        let config = filter(form, 4, formats).expect("sound settings");
        let mut float = LmsEngine::new(
            LmsConfig::<f64>::new(LmsSettings {
                tap_count: 4,
                step_size: if form == 1 { 0.5 } else { 0.1 },
                regularisation,
                desired: DesiredSource::Port,
                update_sign: UpdateSign::Corrected,
            })
            .expect("sound settings"),
        );
        let (worst, _) = distance(&config, |pair| float.process(pair));
        assert!(worst < 1e-9, "{form}: {worst:e}");
    }
    for form in [2, 3] {
        let config = filter(form, 4, formats).expect("sound settings");
        let mut float = SignLmsEngine::new(
            SignLmsConfig::<f64>::new(SignLmsSettings {
                tap_count: 4,
                delay_samples: 2,
                normalised: form == 3,
                step: if form == 3 { 0.5 } else { 0.05 },
                regularisation: 0.01,
                initial_weight: 0.25,
                guard: None,
                norm_recompute_samples: 0,
            })
            .expect("sound settings"),
        );
        let (_, rms) = distance(&config, |pair| float.process(pair));
        assert!(rms < 1e-9, "{form}: {rms:e}");
    }
}

#[test]
fn constants_of_fixed_lms_that_do_not_fit_name_bits_and_limit() {
    let formats = uniform(32, Rounding::HalfUp, Overflow::Saturate);
    let lms = FixedLmsSettings {
        tap_count: 4,
        step_size: 0.1,
        regularisation: None,
        formats,
    };
    let refused = |settings| FixedLmsConfig::new(settings).unwrap_err().to_string();
    assert_eq!(
        refused(FixedLmsSettings {
            step_size: 40.0,
            ..lms
        }),
        "step size = 40 does not fit k: Q6.26 (32 bits) holds less than 32"
    );
    let text = refused(FixedLmsSettings {
        step_size: 1e-9,
        ..lms
    });
    assert!(text.contains("at least one step of its words"), "{text}");
    let text = refused(FixedLmsSettings {
        regularisation: Some(16.0),
        ..lms
    });
    assert!(
        text.contains("regularisation = 16 does not fit den: Q5.27"),
        "{text}"
    );
    let mut wide = lms;
    wide.formats.output.integer_bits = 48;
    wide.formats.output.fraction_bits = 0;
    wide.formats.gain.integer_bits = 48;
    wide.formats.gain.fraction_bits = 0;
    wide.formats.intermediate.integer_bits = 1;
    wide.formats.intermediate.fraction_bits = 47;
    assert!(refused(wide).contains("at most 126 bits"));
    let sign = FixedSignLmsSettings {
        tap_count: 4,
        delay_samples: 2,
        normalised: false,
        step: 0.05,
        regularisation: 0.01,
        initial_weight: 0.25,
        guard: Some(1.5),
        formats,
    };
    let text = FixedSignLmsConfig::new(sign).unwrap_err().to_string();
    assert!(text.contains("guard = 1.5 does not fit y"), "{text}");
    let heavy = FixedSignLmsSettings {
        guard: None,
        initial_weight: 4.0,
        ..sign
    };
    let text = FixedSignLmsConfig::new(heavy).unwrap_err().to_string();
    assert!(text.contains("initial weight = 4 does not fit W"), "{text}");
}

#[test]
fn clocks_of_fixed_lms_are_those_of_the_floating_point_pipelines() {
    for seed in 0..8 {
        let config = mix(seed);
        let pipeline = config.as_pipeline();
        let n = pipeline.tap_count() as u64;
        let usage = fixed_usage(pipeline);
        let (clocks, latency, multiplies, additions, divisions) = match seed % 4 {
            0 => (3 * n + 4, n + 2, 2 * n + 1, 2 * n + 1, 0),
            1 => (4 * n + 5, 2 * n + 3, 3 * n + 1, 3 * n + 1, 1),
            2 => (3 * n + 7, n + 5, 2 * n + 2, 2 * n + 4, 1),
            _ => (3 * n + 7, n + 5, 2 * n + 3, 2 * n + 4, 1),
        };
        assert_eq!(usage.clocks_per_sample, clocks, "{seed}");
        assert_eq!(usage.latency_clocks, latency, "{seed}");
        assert_eq!(usage.multiplies, multiplies, "{seed}");
        assert_eq!(usage.additions, additions, "{seed}");
        assert_eq!(usage.divisions, divisions, "{seed}");
        assert_eq!(usage.wake_up_clocks, 1);
        let by_state: u64 = usage.states.iter().map(|state| state.clocks).sum();
        assert_eq!(by_state, clocks, "{seed}");
        assert_eq!(
            pipeline.stalled_clocks(pipelined(1, 1, 9)),
            clocks + 8 * divisions
        );
        let board = fixed_board_usage(pipeline);
        assert_eq!(board.clocks_per_sample, clocks, "{seed}");
        // One clock for the pair, one to wake the core up.
        assert_eq!(board.latency_clocks, latency + 2, "{seed}");
    }
}

#[test]
fn fixed_lms_rtl_has_the_words_and_every_clock_of_the_model() {
    if !has("iverilog") {
        return;
    }
    // All mixes with a thousand samples where time does not matter; elsewhere each form three times.
    let (mixes, count) = if is_long_rtl() {
        (MIXES, 1000)
    } else {
        (12, 40)
    };
    for_each_seed(0..mixes, |seed| {
        let config = mix(seed);
        check_rtl(&export(&config, count, 10), &[]);
        if seed < 4 {
            check_rtl(&export(&config, 20, 10), &[("DIV_LATENCY", "9")]);
        }
    });
}

#[test]
fn fixed_lms_rtl_has_half_a_million_words_of_the_model_under_verilator() {
    // A minute of C++ compilation each.
    if !is_long_rtl() || !has("verilator") {
        eprintln!("skipped: runs with FOGBENCH_RTL_LONG and verilator only");
        return;
    }
    for_each_seed(0..4, |seed| {
        let config = mix(seed + 16);
        check_rtl(&export(&config, 125_000, 10), &[("SIM", "verilator")]);
    });
}

#[test]
fn a_wrong_constant_of_fixed_lms_is_noticed() {
    if !has("iverilog") {
        return;
    }
    let formats = uniform(20, Rounding::HalfUp, Overflow::Saturate);
    let of = |form, taps| filter(form, taps, formats).expect("sound settings");
    check_noticed(
        &export(&of(1, 4), 21, 10),
        &[
            (".RN(1)", ".RN(0)"),
            (".RK(1)", ".RK(0)"),
            (".RT(1)", ".RT(0)"),
            (".RW(1)", ".RW(0)"),
        ],
    );
    check_noticed(
        &export(&of(2, 8), 21, 10),
        &[(".RY(1)", ".RY(0)"), (".GUARDED(1)", ".GUARDED(0)")],
    );
}

/// A second of the rate model with a filter of each form.
const SCENARIO: &str = "schema = 1\nname = \"a\"\nduration_s = 1.0\nwarm_up_s = 0.5\nfidelity = \"rate\"\n\
    [[filter]]\nname = \"nlms\"\n[filter.lms]\npipeline = \"fpga\"\nnumber_format = \"fixed\"\n\
    [[filter]]\nname = \"plain\"\n[filter.lms]\nnormalised = false\nstep_size = 1e-6\n\
    pipeline = \"fpga\"\nnumber_format = \"fixed\"\n\
    [[filter]]\nname = \"sign\"\n[filter.sign_lms]\npipeline = \"fpga\"\nnumber_format = \"fixed\"\n";

#[test]
fn fixed_lms_filters_of_a_scenario_run_beside_their_twins_and_their_export_proves_itself() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(folder.path(), "a.toml", SCENARIO);
    let output = fogbench(folder.path(), &["run", "a.toml", "-o", "out"]);
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    let channels = summary(&folder.path().join("out"), "a")["channels"].clone();
    for (name, clocks) in [("nlms", 45.0), ("plain", 34.0), ("sign", 67.0)] {
        let figure = |key: &str| channels[name][key]["value"].as_f64();
        assert_eq!(figure("clocks_per_sample"), Some(clocks), "{name}");
        let error = figure("rounding_error_over_signal").expect("an error");
        assert!(error > 0.0 && error < 1e-3, "{name}: {error:e}");
        for signal in ["x", "d", "t", "w", "y"] {
            let count = figure(&format!("overflows_{signal}"));
            assert_eq!(count, Some(0.0), "{name}.{signal}");
        }
        assert_eq!(figure("overflows_r"), None, "{name} has no R");
        assert_eq!(figure("asymmetry_max"), None, "{name} has no R");
    }
    if !has("iverilog") {
        return;
    }
    for name in ["nlms", "plain", "sign"] {
        let arguments = format!("export rtl {name} --scenario a.toml --filter {name} --samples 50");
        let arguments: Vec<&str> = arguments.split(' ').collect();
        let output = fogbench(folder.path(), &arguments);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let (passed, text) = simulate(&folder.path().join(name), &[]);
        // The core, its top level, and the stream ports around it.
        assert!(passed && text.matches("PASS").count() == 3, "{text}");
    }
}

#[test]
fn what_fixed_lms_cannot_have_names_key_and_way_out() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    for (find, put, said) in [
        (
            "name = \"nlms\"\n[filter.lms]\n",
            "name = \"nlms\"\n[filter.lms]\nupdate_sign = \"as-printed\"\n",
            "filter[0].lms.update_sign = \"as-printed\" has no hardware in fixed point",
        ),
        (
            "step_size = 1e-6\n",
            "step_size = 1e-2\nallow_unstable = true\n",
            "step_size = 1.0000e-2 (deg/h)^-2, at a full scale of 7200 deg/h: step size = 518400 does not \
             fit k: Q17.15",
        ),
        (
            "[filter.sign_lms]\n",
            "[filter.sign_lms]\nguard_deg_per_h = 8000.0\n",
            "less than 7.2000e3 deg/h, or more integer bits in fixed.y",
        ),
        (
            "[filter.sign_lms]\n",
            "[filter.sign_lms]\nnorm_recompute_samples = 500\n",
            "norm_recompute_samples = 500 has no effect: the recursive norm of fixed-point words is exact",
        ),
        (
            "[filter.sign_lms]\n",
            "[filter.sign_lms]\nfixed.w = { integer_bits = 40 }\n",
            "fixed.w.integer_bits = 40 is more than the 32 bits of a word",
        ),
    ] {
        assert!(SCENARIO.contains(find), "{find}");
        write(folder.path(), "a.toml", &SCENARIO.replace(find, put));
        let output = fogbench(folder.path(), &["check", "a.toml"]);
        let talk = stderr(&output);
        assert_eq!(code(&output), 2, "{put}: {talk}");
        let words = talk.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.contains(said), "{put}: {talk}");
    }
    let gate = "[[gate]]\nmetric = \"nlms.overflows_r\"\nmax = 0.0\n";
    write(folder.path(), "a.toml", &format!("{SCENARIO}{gate}"));
    let output = fogbench(folder.path(), &["check", "a.toml"]);
    assert!(
        stderr(&output).contains("the filter has no such signal"),
        "{}",
        stderr(&output)
    );
}
