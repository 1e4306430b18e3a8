//! Fixed-point RLS: engine, clocked pipeline and RTL hold the same words in every clock.

use fogbench::filters::RlsWords;
use fogbench::fpga::fixed::rls::{
    FixedRlsConfig, FixedRlsEngine, FixedRlsPipeline, FixedRlsSettings, FixedRlsState, RlsFormats,
};
use fogbench::fpga::fixed::{
    CodePair, FixedConfig, FixedEngine as _, FixedPipeline as _, Format, Overflow, Rounding,
    SignalName, fixed_board_usage, fixed_usage,
};
use fogbench::fpga::timing::Units;

use crate::support::fixed::{
    Draws, OVERFLOWS, ROUNDINGS, check_noticed, check_resets, check_rtl, export, for_each_seed,
    has, pairs, pipelined, run,
};
use crate::support::stimulus::samples;
use crate::support::{is_long_rtl, repository};

/// Formats with the integer bits of the trial that is known to work, all of one width.
fn uniform(width: u32, rounding: Rounding, overflow: Overflow) -> RlsFormats {
    let format = |integer_bits| Format {
        integer_bits,
        fraction_bits: width - integer_bits,
        rounding,
        overflow,
    };
    RlsFormats {
        input: format(1),
        desired: format(1),
        intermediate: format(11),
        denominator: format(12),
        gain: format(9),
        inverse: format(14),
        weight: format(3),
        output: format(1),
    }
}

/// A mix: every rounding with every overflow in turn, widths and points drawn by the seed.
fn mix(seed: u32) -> FixedRlsConfig {
    let mut draws = Draws(u64::from(seed) << 20 | 1);
    let rounding = ROUNDINGS[seed as usize % 3];
    let overflow = OVERFLOWS[seed as usize / 3 % 2];
    let mut formats = uniform(12 + 3, rounding, overflow);
    for format in [
        &mut formats.input,
        &mut formats.desired,
        &mut formats.intermediate,
        &mut formats.denominator,
        &mut formats.gain,
        &mut formats.inverse,
        &mut formats.weight,
        &mut formats.output,
    ] {
        let width = 12 + draws.below(37);
        format.integer_bits = (format.integer_bits + draws.below(3)).min(width - 1);
        format.fraction_bits = width - format.integer_bits;
    }
    let alpha = [1.0, 0.99, 0.9][draws.below(3) as usize];
    let largest = formats.inverse.value(formats.inverse.code_max());
    let settings = FixedRlsSettings {
        tap_count: [1, 4, 8, 2, 3][seed as usize % 5],
        forgetting_factor: alpha,
        initial_inverse_correlation: (largest / 8.0).min(1024.0),
        inverse_floor: [0, 0, 1, 3][seed as usize % 4],
        formats,
    };
    // A few of the drawn formats need more exact bits than there are: the next seed then.
    FixedRlsConfig::new(settings).unwrap_or_else(|_| mix(seed + 1000))
}

#[test]
fn fixed_point_engine_and_pipeline_agree_in_forty_mixes() {
    let mut overflowed = 0;
    for seed in 0..40 {
        let config = mix(seed);
        let pairs = pairs(&FixedConfig::Rls(config), 150);
        let mut engine = FixedRlsEngine::new(config);
        let wanted: Vec<i64> = pairs.iter().map(|pair| engine.process(*pair)).collect();
        let (words, [rama, ramb]) = run(&FixedConfig::Rls(config), &pairs);
        assert_eq!(words, wanted, "{seed}");
        assert_eq!(rama, engine.rama(), "{seed}");
        assert_eq!(ramb, engine.ramb(), "{seed}");
        assert!(wanted.iter().any(|word| *word != wanted[0]), "{seed}");
        let overflows = engine.health().overflows;
        let count = overflows.of(SignalName::W) + overflows.of(SignalName::R);
        overflowed += usize::from(count > 0);
    }
    assert!(overflowed > 5, "the mixes reach the ends of their words");
}

#[test]
fn fixed_point_reset_in_any_clock_leaves_nothing_of_the_past() {
    let config = mix(1);
    let taps = config.tap_count();
    check_resets(&FixedConfig::Rls(config), taps * taps + 2 * taps);
    let mut pipeline = FixedRlsPipeline::new(config);
    let fresh = *pipeline.registers();
    for _ in 0..100 {
        pipeline.tick(Some(CodePair {
            input: 3,
            desired: 5,
        }));
    }
    pipeline.reset();
    while pipeline.registers().state != FixedRlsState::Idle {
        pipeline.tick(None);
    }
    assert_eq!(*pipeline.registers(), fresh);
}

#[test]
fn wide_fixed_point_words_follow_the_floating_point_filter() {
    let formats = uniform(48, Rounding::HalfUp, Overflow::Saturate);
    let config = FixedRlsConfig::new(FixedRlsSettings {
        tap_count: 4,
        forgetting_factor: 0.999,
        initial_inverse_correlation: 1024.0,
        inverse_floor: 0,
        formats,
    })
    .expect("sound settings");
    let mut fixed = FixedRlsEngine::new(config);
    let mut line = [0.0; 4];
    let mut weights = [0.0; 4];
    let mut inverse = [[0.0; 4]; 4];
    for (i, row) in inverse.iter_mut().enumerate() {
        row[i] = 1024.0;
    }
    let mut worst: f64 = 0.0;
    for pair in pairs(&FixedConfig::Rls(config), 2000) {
        let input = formats.input.value(pair.input);
        let desired = formats.desired.value(pair.desired);
        line.rotate_right(1);
        line[0] = input;
        let dot = |a: &[f64; 4], b: &[f64; 4]| (0..4).map(|j| a[j] * b[j]).sum::<f64>();
        let t: Vec<f64> = inverse.iter().map(|row| dot(row, &line)).collect();
        let denominator = 0.999 + (0..4).map(|j| line[j] * t[j]).sum::<f64>();
        let output = dot(&line, &weights);
        for i in 0..4 {
            weights[i] += t[i] / denominator * (desired - output);
            for j in 0..4 {
                inverse[i][j] = (inverse[i][j] - t[i] * t[j] / denominator) / 0.999;
            }
        }
        let word = formats.output.value(fixed.process(pair));
        worst = worst.max((word - output.clamp(-1.0, 1.0)).abs());
    }
    assert!(worst < 1e-6, "{worst:e}");
    assert_eq!(fixed.health().indefinite_at, None);
}

#[test]
fn short_fixed_point_words_die_under_a_swing_and_long_ones_live() {
    // One deg/s at 10 Hz and noise at 4 kHz, full scale 2 deg/s, alpha 1: R shrinks as 1/k until its
    // words no longer hold it. In 5 s words of 22 bits get there, and words of 32 bits do not.
    let swing = samples("rocking", 20_000);
    let run = |width: u32, floor: i64| {
        let formats = uniform(width, Rounding::HalfUp, Overflow::Saturate);
        let config = FixedRlsConfig::new(FixedRlsSettings {
            tap_count: 4,
            forgetting_factor: 1.0,
            initial_inverse_correlation: 1024.0,
            inverse_floor: floor,
            formats,
        })
        .expect("sound settings");
        let mut engine = FixedRlsEngine::new(config);
        for pair in swing.windows(2) {
            engine.process(CodePair {
                input: formats.input.of(pair[0] / 2.0).code,
                desired: formats.desired.of(pair[1] / 2.0).code,
            });
        }
        engine.health()
    };
    let died = run(22, 0).indefinite_at.expect("words of 22 bits die");
    assert!(died > 100, "{died}");
    assert_eq!(run(32, 0).indefinite_at, None);
    // A floor of one step keeps the diagonal above zero.
    let held = run(22, 1);
    assert!(held.floored > 0, "{held:?}");
}

#[test]
fn constants_that_do_not_fit_name_bits_and_limit() {
    let settings = |delta, width, alpha| FixedRlsSettings {
        tap_count: 4,
        forgetting_factor: alpha,
        initial_inverse_correlation: delta,
        inverse_floor: 0,
        formats: uniform(width, Rounding::HalfUp, Overflow::Saturate),
    };
    let refused = |settings| FixedRlsConfig::new(settings).unwrap_err().to_string();
    assert_eq!(
        refused(settings(20_000.0, 32, 1.0)),
        "initial inverse correlation = 20000 does not fit R: Q14.18 (32 bits) holds less than 8192"
    );
    assert_eq!(
        refused(settings(1e-9, 32, 1.0)),
        "initial inverse correlation = 1e-9 is out of range: expected at least one step of R in fixed \
         point"
    );
    let floor = FixedRlsSettings {
        inverse_floor: i64::MAX,
        ..settings(1024.0, 32, 1.0)
    };
    assert!(refused(floor).contains("floor of R"));
    assert!(refused(settings(1024.0, 32, 0.0)).contains("forgetting factor"));
    assert!(refused(settings(1024.0, 49, 1.0)).contains("2 to 48 bits"));
    let mut wide = settings(1024.0, 48, 1.0);
    wide.formats.gain.integer_bits = 1;
    wide.formats.gain.fraction_bits = 47;
    wide.formats.denominator = wide.formats.gain;
    wide.formats.intermediate.integer_bits = 48;
    wide.formats.intermediate.fraction_bits = 0;
    assert!(refused(wide).contains("at most 126 bits"));
}

#[test]
fn fixed_point_rtl_has_the_words_and_every_clock_of_the_model() {
    if !has("iverilog") {
        return;
    }
    // All mixes with a thousand samples where time does not matter; elsewhere each rounding with each
    // overflow once.
    let (mixes, count) = if is_long_rtl() { (40, 1000) } else { (6, 20) };
    for_each_seed(0..mixes, |seed| {
        let config = FixedConfig::Rls(mix(seed));
        check_rtl(&export(&config, count, 10), &[]);
        if seed < 5 {
            check_rtl(&export(&config, 20, 10), &[("DIV_LATENCY", "9")]);
        }
    });
}

#[test]
fn fixed_point_rtl_has_half_a_million_words_of_the_model_under_verilator() {
    // A minute of C++ compilation each.
    if !is_long_rtl() || !has("verilator") {
        eprintln!("skipped: runs with FOGBENCH_RTL_LONG and verilator only");
        return;
    }
    for_each_seed(0..4, |seed| {
        let config = FixedConfig::Rls(mix(seed));
        check_rtl(&export(&config, 125_000, 10), &[("SIM", "verilator")]);
    });
}

#[test]
fn clocks_of_fixed_point_are_counted_on_the_model() {
    for seed in 0..5 {
        let config = mix(seed);
        let p = config.tap_count() as u64;
        let usage = fixed_usage(&config);
        assert_eq!(usage.clocks_per_sample, 3 * p * p + 7 * p + 4);
        assert_eq!(usage.latency_clocks, 3 * p * p + 5 * p + 3);
        assert_eq!(usage.wake_up_clocks, 1);
        let by_state: u64 = usage.states.iter().map(|state| state.clocks).sum();
        assert_eq!(by_state, usage.clocks_per_sample);
        assert_eq!(usage.divisions, p);
        let triangle = p * (p + 1) / 2;
        let scaling = u64::from(config.inverse_alpha().is_some()) * triangle;
        assert_eq!(usage.multiplies, p * p + 3 * p + triangle + scaling);
        assert_eq!(usage.additions, p * p + p + p + triangle + 1 + p);
        let board = fixed_board_usage(&config);
        assert_eq!(board.clocks_per_sample, usage.clocks_per_sample);
        // One clock for the pair, one to wake the core up.
        assert_eq!(board.latency_clocks, usage.latency_clocks + 2);
        let with_divider = |clocks| config.stalled_clocks(pipelined(1, 1, clocks));
        assert_eq!(with_divider(1), usage.clocks_per_sample);
        assert_eq!(with_divider(9), usage.clocks_per_sample + 8 * p);
    }
}

/// A mix with units of drawn latencies, some of them of a clock.
fn slow_mix(seed: u32) -> FixedRlsConfig {
    let mut draws = Draws(u64::from(seed) << 24 | 5);
    let mut clocks = |most: u32| match draws.below(4) {
        0 => 1,
        _ => u64::from(1 + draws.below(most)),
    };
    let units = pipelined(clocks(6), clocks(16), clocks(64));
    mix(seed).with_units(units).expect("latencies in range")
}

#[test]
fn slow_units_change_the_clocks_of_fixed_point_and_no_word() {
    let mut chained = 0;
    for seed in 0..60 {
        let (quick, slow) = (mix(seed), slow_mix(seed));
        chained += u32::from(slow.units().chain());
        let pairs = pairs(&FixedConfig::Rls(quick), 40);
        // The run holds every period and latency to the formulas.
        let (words, memories) = run(&FixedConfig::Rls(slow), &pairs);
        assert_eq!(
            (words, memories),
            run(&FixedConfig::Rls(quick), &pairs),
            "{seed}"
        );
        let usage = fixed_usage(&slow);
        assert_eq!(usage.clocks_per_sample, slow.stalled_clocks(slow.units()));
        assert_eq!(usage.latency_clocks, slow.latency_clocks() as u64);
        assert_eq!(
            fixed_board_usage(&slow).clocks_per_sample,
            usage.clocks_per_sample
        );
    }
    assert!((1..60).contains(&chained));
    for latency in [0, 1001] {
        assert!(mix(0).with_units(pipelined(1, latency, 1)).is_err());
    }
}

#[test]
fn slow_fixed_point_units_leave_nothing_of_the_past_after_a_reset() {
    let config = slow_mix(2);
    let taps = config.tap_count();
    assert_ne!(config.units(), Units::ONE_CLOCK);
    check_resets(&FixedConfig::Rls(config), taps * taps + 2 * taps);
}

#[test]
fn fixed_point_rtl_with_slow_units_has_the_words_and_clocks_of_the_model() {
    if !has("iverilog") {
        return;
    }
    let (mixes, count) = if is_long_rtl() { (40, 300) } else { (8, 12) };
    for_each_seed(0..mixes, |seed| {
        let config = FixedConfig::Rls(slow_mix(seed));
        check_rtl(&export(&config, count, 10), &[]);
    });
    // A multiplier in one piece, in two, in pieces of a bit; a divider of a row a clock and of several; roundings
    // in one step, two and three.
    for_each_seed(0..4, |seed| {
        let (add, mul, div) = [
            ("2", "2", "4"),
            ("3", "3", "5"),
            ("4", "4", "60"),
            ("5", "60", "100"),
        ][seed as usize];
        let latencies = [
            ("ADD_LATENCY", add),
            ("MUL_LATENCY", mul),
            ("DIV_LATENCY", div),
        ];
        check_rtl(
            &export(&FixedConfig::Rls(mix(seed + 6)), 12, 10),
            &latencies,
        );
    });
}

#[test]
fn a_wrong_fixed_point_constant_is_noticed() {
    if !has("iverilog") {
        return;
    }
    let export = export(&FixedConfig::Rls(mix(9)), 21, 10);
    check_noticed(
        &export,
        &[
            (".RY(0)", ".RY(1)"),
            (".RR(0)", ".RR(1)"),
            (".RK(0)", ".RK(2)"),
        ],
    );
}

#[test]
fn the_page_says_the_integer_bits_that_stand_by_default() {
    let page = std::fs::read_to_string(repository("docs/hardware.md")).expect("the page is there");
    let words = page.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("x, d and y have 1 integer bit"), "{words}");
    for (name, word) in RlsWords::reference().resolved().signals {
        let said = format!("{name} {}", word.integer_bits);
        let is_said = match name {
            "x" | "d" | "y" => word.integer_bits == 1,
            _ => words.contains(&said),
        };
        assert!(is_said, "{said}");
    }
}
