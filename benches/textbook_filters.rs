//! Cost of one sample of the textbook filters at the sizes the paper uses.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use fogbench::filters::{Filter, FrontEndConfig, Lms, LmsConfig, Normalisation, Rls, RlsConfig};
use fogbench::random::Streams;
use fogbench::vocabulary::{DesiredSignal, OutputRegister, UpdateSign};

/// Samples per iteration: 2.5 s of a 4 kHz gyro.
const SAMPLES: usize = 10_000;

fn front_end(desired: DesiredSignal, input_lag_samples: usize) -> FrontEndConfig {
    FrontEndConfig {
        desired,
        input_lag_samples,
        output_register: OutputRegister::NextSample,
    }
}

fn run(filter: &mut dyn Filter, input: &[f64]) -> f64 {
    let step = |sample: &f64| filter.step(*sample).map_or(f64::NAN, |o| o.value_deg_per_h);
    input.iter().map(step).sum()
}

fn textbook_filters(criterion: &mut Criterion) {
    let mut input = vec![0.0; SAMPLES];
    Streams::new(1, 0).stream("bench").fill_normal(&mut input);
    let mut group = criterion.benchmark_group("textbook_filters");
    group.throughput(Throughput::Elements(SAMPLES as u64));
    let mut rls = Rls::new(&RlsConfig {
        taps: 4,
        forgetting_factor: 0.999,
        initial_inverse_correlation: 1.0,
        update_sign: UpdateSign::Corrected,
        front_end: front_end(DesiredSignal::Current, 1),
    });
    group.bench_function("rls_4", |bencher| {
        bencher.iter(|| run(&mut rls, black_box(&input)));
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
    group.bench_function("nlms_10", |bencher| {
        bencher.iter(|| run(&mut lms, black_box(&input)));
    });
    group.finish();
}

criterion_group!(benches, textbook_filters);
criterion_main!(benches);
