//! A board: front end, core and output register clocked together have the words of the bench.

use fogbench::fpga::board::{Board, CodeScale, Sample, Surroundings};
use fogbench::fpga::engine::Engine as _;
use fogbench::fpga::float_unit::Fp;
use fogbench::fpga::front_end::FrontEnd;
use fogbench::fpga::lms::{DesiredSource, LmsConfig, LmsPipeline, LmsSettings};
use fogbench::fpga::machine::{Machine, Sequencer};
use fogbench::fpga::rls::{RlsConfig, RlsEngine, RlsPipeline, RlsSettings};
use fogbench::vocabulary::{DesiredSignal, Division, OutputRegister, UpdateSign};

fn config<F: Fp>(tap_count: usize) -> RlsConfig<F> {
    RlsConfig::new(RlsSettings {
        tap_count,
        forgetting_factor: 0.99,
        initial_inverse_correlation: 1e-3,
        division: Division::Reciprocal,
        update_sign: UpdateSign::Corrected,
    })
    .expect("settings are in range")
}

fn scale() -> CodeScale {
    CodeScale {
        lsb: 1e-4,
        unit: "deg/s".to_owned(),
        factor: 3600.0,
        word_unit: "deg/h".to_owned(),
    }
}

fn surroundings(desired: DesiredSignal, lag: usize, register: OutputRegister) -> Surroundings {
    Surroundings {
        desired,
        input_lag_samples: lag,
        output_register: register,
        scale: Some(scale()),
    }
}

/// Codes of a rocking gyro: both signs, zero, and the ends of the range.
fn codes() -> Vec<i32> {
    let mut codes: Vec<i32> = (0..40).map(|k| (k * k * 37) % 2001 - 1000).collect();
    codes.extend([0, 1, -1, i32::MAX, i32::MIN, 3]);
    codes
}

/// Results of a board offered a sample in every clock that `offers` names.
fn results<M: Machine>(
    board: &mut Board<M>,
    samples: &[Sample<M::Word>],
    offers: impl Fn(usize) -> bool,
) -> Vec<u64> {
    let (mut next, mut clock, mut words) = (0, 0, Vec::new());
    while words.len() < samples.len() {
        let offered = samples.get(next).copied().filter(|_| offers(clock));
        let tick = board.tick(offered);
        next += usize::from(tick.accepted);
        words.extend(tick.result.map(Fp::to_bits));
        clock += 1;
        assert!(clock < 1_000_000, "the board stands still");
    }
    words
}

fn check<F: Fp>(tap_count: usize, desired: DesiredSignal, lag: usize, register: OutputRegister) {
    let config = config::<F>(tap_count);
    let mut front_end = FrontEnd::<F>::new(desired, lag);
    let mut engine = RlsEngine::new(config);
    let mut wanted: Vec<u64> = Vec::new();
    for code in codes() {
        let word = F::from_f64((f64::from(code) * 1e-4) * 3600.0);
        wanted.push(engine.process(front_end.pair(word)).to_bits());
    }
    if register == OutputRegister::NextSample {
        wanted.insert(0, 0);
        wanted.pop();
    }
    let samples: Vec<Sample<F>> = codes().into_iter().map(Sample::Code).collect();
    let mut board = Board::new(
        RlsPipeline::new(config),
        surroundings(desired, lag, register),
    );
    assert_eq!(results(&mut board, &samples, |_| true), wanted);
    for clock in [0, 3, 50, 111] {
        board.reset();
        for _ in 0..clock {
            board.tick(samples.first().copied());
        }
        board.reset();
        assert_eq!(results(&mut board, &samples, |_| true), wanted, "{clock}");
    }
}

#[test]
fn board_has_the_words_of_engine_front_end_and_register() {
    for register in [OutputRegister::NextSample, OutputRegister::Immediate] {
        for (desired, lag) in [
            (DesiredSignal::Current, 0),
            (DesiredSignal::Current, 1),
            (DesiredSignal::Current, 15),
            (DesiredSignal::TwoSampleMean, 1),
        ] {
            check::<f64>(4, desired, lag, register);
            check::<f32>(1, desired, lag, register);
        }
    }
}

#[test]
fn front_end_adds_latency_and_no_clock_to_the_period() {
    fn check<M: Machine + Clone>(core: &Sequencer<M>, period: u64, latency: u64) {
        for (desired, clocks) in [
            (DesiredSignal::Current, 3),
            (DesiredSignal::TwoSampleMean, 5),
        ] {
            let around = surroundings(desired, 1, OutputRegister::NextSample);
            let used = Board::new(core.clone(), around).usage();
            assert_eq!(used.front_end_clocks, clocks);
            assert_eq!(used.clocks_per_sample, period);
            // One clock wakes the core up.
            assert_eq!(used.latency_clocks, clocks + 1 + latency);
        }
    }
    for p in 1..=8 {
        let core = RlsPipeline::new(config::<f64>(p));
        let p = p as u64;
        check(&core, 4 + 6 * p + 5 * p * p, 3 + 4 * p + 5 * p * p);
    }
    // The shortest period there is: seven clocks.
    let settings = LmsSettings {
        tap_count: 1,
        step_size: 0.5,
        regularisation: None,
        desired: DesiredSource::Port,
        update_sign: UpdateSign::Corrected,
    };
    let core = LmsPipeline::new(LmsConfig::<f64>::new(settings).expect("settings are in range"));
    check(&core, 7, 3);
}

#[test]
fn one_product_with_the_whole_factor_has_other_bits() {
    let codes = (-2000..2000).filter(|code| *code != 0);
    let other = codes.filter(|code| {
        let at_once = f64::from(*code) * (1e-4 * 3600.0);
        scale().word(*code).to_bits() != at_once.to_bits()
    });
    assert!(other.count() > 1000);
}
