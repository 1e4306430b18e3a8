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
    has, pairs, run,
};
use crate::support::is_long_rtl;

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
    let (input, desired) = (pipeline.input(), pipeline.desired());
    let mut engine = pipeline.engine();
    let (mut worst, mut squares): (f64, f64) = (0.0, 0.0);
    let pairs = pairs(config, 4000);
    for CodePair {
        input: x,
        desired: d,
    } in &pairs
    {
        let pair = Pair::from_f64(input.value(*x), desired.value(*d));
        let word = engine.process(CodePair {
            input: *x,
            desired: *d,
        });
        let off = (pipeline.output().value(word) - float(pair)).abs();
        worst = worst.max(off);
        squares += off * off;
    }
    assert_eq!(engine.health().indefinite_at, None);
    (worst, (squares / 4000.0).sqrt())
}

#[test]
fn wide_fixed_lms_words_follow_the_floating_point_filters() {
    let formats = uniform(44, Rounding::HalfUp, Overflow::Saturate);
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
        assert_eq!(pipeline.stalled_clocks(9), clocks + 8 * divisions);
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
fn fixed_lms_rtl_has_a_million_words_of_the_model_under_verilator() {
    // A minute of C++ compilation each.
    if !is_long_rtl() || !has("verilator") {
        eprintln!("skipped: runs with FOGBENCH_RTL_LONG and verilator only");
        return;
    }
    for_each_seed(0..4, |seed| {
        let config = mix(seed + 16);
        check_rtl(&export(&config, 250_000, 10), &[("SIM", "verilator")]);
    });
}

#[test]
fn a_wrong_constant_of_fixed_lms_is_noticed() {
    if !has("iverilog") {
        return;
    }
    check_noticed(
        &export(&mix(5), 21, 10),
        &[
            (".RN(1)", ".RN(0)"),
            (".RK(1)", ".RK(0)"),
            (".RT(1)", ".RT(0)"),
            (".RW(1)", ".RW(2)"),
        ],
    );
    check_noticed(
        &export(&mix(6), 21, 10),
        &[(".RY(1)", ".RY(0)"), (".HOLD(", ".HOLD(0*")],
    );
}
