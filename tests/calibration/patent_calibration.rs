//! Calibration campaigns: how estimators rank, what one sense of rotation hides, mistakes in the data.

use fogbench::calibration::{
    Averaging, CalibrationError, Compensation, ErrorParameters, Estimator, Finding, Forgetting,
    GroupDesign, GroupObservation, GroupSamples, Misalignment, OUTLIER_THRESHOLD, Reading,
    RecursiveSettings, Scope, TemperatureColumns, diagnose, estimate, group_means,
    normalised_error_squared, unmodelled_rms,
};
use fogbench::random::{Stream, Streams};
use fogbench::units::{deg_per_h_to_deg_per_s, deg_per_s_to_deg_per_h};
use fogbench::vocabulary::{CompensationForm, ForgettingForm};

use crate::support::assert_close;
use crate::support::patent_cases::{NINE, WARM_UP_C, observed, plan, truth, warm_plan};
use crate::support::transcript::Transcript;

const BATCH: Estimator = Estimator::Batch {
    temperature: TemperatureColumns::NONE,
};

const BATCH_T: Estimator = Estimator::Batch {
    temperature: TemperatureColumns::BIAS,
};

/// Starts of the nine groups, s.
const START_S: [f64; 9] = [
    0.0, 660.0, 1320.0, 2280.0, 2940.0, 3600.0, 4560.0, 5220.0, 5880.0,
];

/// Standard error of a mean over 600 s, ARW 0.05 deg/sqrt(h), deg/h.
const NOISE_600_S_DEG_PER_H: f64 = 0.1225;

/// What drifts in a campaign.
#[derive(Clone, Copy, PartialEq)]
enum Drift {
    None,
    Linear,
    Shupe,
    Scale,
    Hidden,
    Curved,
}

/// Parts of a warm-up from 20 deg C: rise in K and time constant in s.
fn warm_up(drift: Drift) -> Vec<(f64, f64)> {
    if drift == Drift::Shupe {
        vec![(6.0, 300.0), (14.0, 2500.0)]
    } else {
        vec![(20.0, 1800.0)]
    }
}

/// Mean of `exp(-t / tau)` from `start_s` over `time_s`.
fn mean_decay(tau_s: f64, start_s: f64, time_s: f64) -> f64 {
    (-start_s / tau_s).exp() * (1.0 - (-time_s / tau_s).exp()) * tau_s / time_s
}

fn uniform(stream: &mut Stream, half_width: f64) -> f64 {
    // The normal distribution function of a normal draw is uniform; its logistic form is close
    // enough for parameters that only have to be scattered.
    half_width * (2.0 / (1.0 + (-1.702 * stream.normal()).exp()) - 1.0)
}

fn drawn(stream: &mut Stream) -> ErrorParameters {
    let bias = deg_per_h_to_deg_per_s(5.0);
    ErrorParameters {
        scale_error: [0; 3].map(|_| uniform(stream, 1e-3)),
        misalignment_rad: Misalignment {
            xy: uniform(stream, 1.5e-3),
            xz: uniform(stream, 1.5e-3),
            yx: uniform(stream, 1.5e-3),
            yz: uniform(stream, 1.5e-3),
            zx: uniform(stream, 1.5e-3),
            zy: uniform(stream, 1.5e-3),
        },
        bias_deg_per_s: [0; 3].map(|_| uniform(stream, bias)),
    }
}

/// One campaign on group means over whole turns: the truth at 40 deg C and the groups.
fn campaign(drift: Drift, index: u64) -> (ErrorParameters, Vec<GroupObservation>) {
    let mut stream = Streams::new(1, index).stream("campaign");
    let parameters = drawn(&mut stream);
    let linear = [0; 3].map(|_| 0.10 * stream.normal());
    let special = [0; 3].map(|_| stream.normal());
    let time_s = [576.0, 597.6, 600.0];
    let group = |index: usize| {
        let (start_s, time_s) = (START_S[index], time_s[index % 3]);
        let mut temperature_c = 40.0;
        let mut k_per_min = 0.0;
        let mut warmer_squared = 0.0;
        for (rise_k, tau_s) in warm_up(drift) {
            temperature_c -= rise_k * mean_decay(tau_s, start_s, time_s);
            k_per_min += 60.0 / tau_s * rise_k * mean_decay(tau_s, start_s, time_s);
            // exp(-t/tau)^2 is a decay of half the time constant; used with one part only.
            warmer_squared = rise_k * rise_k * mean_decay(tau_s / 2.0, start_s, time_s);
        }
        let design = GroupDesign {
            temperature_c: [temperature_c; 3],
            temperature_rate_k_per_min: [k_per_min; 3],
            ..plan(&NINE[index..=index])[0]
        };
        let noise_deg_per_h = NOISE_600_S_DEG_PER_H * (600.0 / time_s).sqrt();
        let shift: [f64; 3] = std::array::from_fn(|axis| {
            let of_bias = if drift == Drift::None {
                0.0
            } else {
                linear[axis]
            };
            let warmer_k = temperature_c - 40.0;
            of_bias * warmer_k
                + match drift {
                    Drift::None | Drift::Linear | Drift::Scale => 0.0,
                    Drift::Shupe => special[axis] * k_per_min,
                    Drift::Hidden => 2.0 * special[axis] * mean_decay(400.0, start_s, time_s),
                    Drift::Curved => 0.005 * special[axis] * warmer_squared,
                }
        });
        let mut seen = parameters.predict(design.reference_rate_deg_per_s);
        for (axis, output) in seen.iter_mut().enumerate() {
            if drift == Drift::Scale {
                let warmer_k = temperature_c - 40.0;
                let own = design.reference_rate_deg_per_s[axis];
                *output += 1e-5 * special[axis] * warmer_k * own;
            }
            let noise = noise_deg_per_h * stream.normal();
            *output += deg_per_h_to_deg_per_s(shift[axis] + noise);
        }
        GroupObservation {
            design,
            output_deg_per_s: seen,
            standard_error_deg_per_s: [deg_per_h_to_deg_per_s(noise_deg_per_h); 3],
        }
    };
    let groups = (0..9).map(group).collect();
    (parameters, groups)
}

fn thermal(form: ForgettingForm, constant_per_k: f64) -> Forgetting {
    Forgetting::Temperature {
        form,
        constant_per_k,
    }
}

fn recursive(forgetting: Forgetting) -> Estimator {
    Estimator::Recursive(RecursiveSettings {
        initial_temperature_c: Some([20.0; 3]),
        ..RecursiveSettings::new(forgetting)
    })
}

fn weighted(constant_per_k: f64) -> Estimator {
    Estimator::Weighted {
        forgetting: thermal(ForgettingForm::Exponential, constant_per_k),
        reading: Reading::Discount,
        temperature: TemperatureColumns::BIAS,
    }
}

/// Published bias errors (deg/h) and scale errors (ppm) without drift, with linear drift, Shupe
/// effect, scale tempco, hidden transient and curved drift, in the order of [`estimators`].
const PUBLISHED: [[f64; 12]; 13] = [
    [
        0.078, 0.45, 0.807, 2.11, 0.823, 1.95, 1.295, 50.6, 0.868, 2.38, 1.014, 2.76,
    ],
    [
        0.080, 0.46, 0.642, 1.69, 0.668, 1.51, 1.006, 51.2, 0.680, 1.84, 0.784, 2.12,
    ],
    [
        0.126, 0.59, 0.233, 1.51, 0.289, 1.26, 0.385, 51.7, 0.238, 1.50, 0.244, 1.75,
    ],
    [
        0.095, 0.50, 0.326, 1.30, 0.404, 1.11, 0.513, 51.1, 0.330, 1.30, 0.346, 1.50,
    ],
    [
        0.080, 0.46, 0.611, 1.63, 0.665, 1.51, 0.962, 51.1, 0.641, 1.75, 0.734, 2.01,
    ],
    [
        0.095, 0.50, 0.330, 1.32, 0.409, 1.12, 0.510, 51.2, 0.335, 1.32, 0.355, 1.53,
    ],
    [
        0.129, 0.58, 0.199, 1.30, 0.259, 1.13, 0.340, 49.3, 0.205, 1.29, 0.206, 1.45,
    ],
    [
        0.107, 0.53, 0.256, 1.34, 0.325, 1.13, 0.402, 50.9, 0.261, 1.34, 0.268, 1.55,
    ],
    [
        0.103, 0.52, 0.261, 1.17, 0.333, 1.03, 0.436, 49.3, 0.266, 1.16, 0.271, 1.32,
    ],
    [
        0.117, 0.50, 0.117, 0.50, 0.186, 0.63, 0.691, 49.2, 0.249, 0.94, 0.269, 0.79,
    ],
    [
        0.132, 0.53, 0.132, 0.53, 0.165, 0.58, 0.610, 47.2, 0.174, 0.69, 0.202, 0.63,
    ],
    [
        0.184, 0.72, 0.184, 0.72, 0.213, 0.66, 0.524, 48.9, 0.188, 0.73, 0.193, 0.75,
    ],
    [
        0.133, 2.09, 0.133, 2.09, 0.209, 3.17, 0.133, 2.09, 0.280, 2.74, 0.290, 2.36,
    ],
];

fn estimators() -> [Estimator; 13] {
    use ForgettingForm::{Exponential, Gaussian, Linear, Rational};
    let scale = Estimator::Batch {
        temperature: TemperatureColumns {
            scale: true,
            ..TemperatureColumns::BIAS
        },
    };
    [
        BATCH,
        recursive(Forgetting::Constant(0.9)),
        recursive(Forgetting::Constant(0.5)),
        recursive(thermal(Linear, 0.15)),
        recursive(thermal(Exponential, 0.05)),
        recursive(thermal(Exponential, 0.20)),
        recursive(thermal(Exponential, 1.0)),
        recursive(thermal(Rational, 0.5)),
        recursive(thermal(Gaussian, 0.5)),
        BATCH_T,
        weighted(0.2),
        weighted(0.5),
        scale,
    ]
}

/// Estimators with their rows, a pair of errors for each drift.
fn table() -> Vec<(Estimator, [[f64; 2]; 6])> {
    let rows = PUBLISHED.map(|row| std::array::from_fn(|i| [row[2 * i], row[2 * i + 1]]));
    estimators().into_iter().zip(rows).collect()
}

const DRIFTS: [Drift; 6] = [
    Drift::None,
    Drift::Linear,
    Drift::Shupe,
    Drift::Scale,
    Drift::Hidden,
    Drift::Curved,
];

/// Campaigns of each kind; the published table has 400.
const CAMPAIGNS: u64 = 300;

/// What an estimator does over the campaigns of one drift.
struct Tally {
    /// Root mean squares of bias error, deg/h, and scale error, ppm.
    rms: [f64; 2],
    mean_normalised_error: f64,
    unmodelled_bias_deg_per_h: f64,
}

fn tally(estimator: &Estimator, drift: Drift) -> Tally {
    let (mut biases, mut bias_errors, mut scales, mut normalised) = (vec![], vec![], vec![], 0.0);
    for index in 0..CAMPAIGNS {
        let (truth, groups) = campaign(drift, index);
        let found = estimate(&groups, estimator, Some([40.0; 3])).expect("a calibration");
        normalised += normalised_error_squared(&found, &truth).expect("noise");
        let errors = found.standard_errors();
        for axis in 0..3 {
            let bias = found.parameters.bias_deg_per_s[axis] - truth.bias_deg_per_s[axis];
            biases.push(deg_per_s_to_deg_per_h(bias));
            bias_errors.push(deg_per_s_to_deg_per_h(errors[4 * axis + 3]));
            scales.push(1e6 * (found.parameters.scale_error[axis] - truth.scale_error[axis]));
        }
    }
    let zeros = vec![0.0; biases.len()];
    Tally {
        rms: [
            unmodelled_rms(&biases, &zeros),
            unmodelled_rms(&scales, &zeros),
        ],
        mean_normalised_error: normalised / 300.0,
        unmodelled_bias_deg_per_h: unmodelled_rms(&biases, &bias_errors),
    }
}

#[test]
fn patent_campaigns_rank_the_estimators_as_published() {
    let table = table();
    let mut compared = 0;
    for (column, drift) in DRIFTS.into_iter().enumerate() {
        let tallies: Vec<Tally> = table.iter().map(|(e, _)| tally(e, drift)).collect();
        for (one, (estimator, row)) in tallies.iter().zip(&table) {
            // Twelve on average: sqrt(2 12 / 300) is 0.28.
            let knows_drift = estimator.temperature_columns().bias && drift == Drift::Linear;
            if drift == Drift::None || knows_drift {
                assert_close(one.mean_normalised_error, 12.0, 0.0, 1.0);
                assert!(one.unmodelled_bias_deg_per_h < 0.03 + 0.3 * one.rms[0]);
            }
            for quantity in 0..2 {
                let published = row[column][quantity];
                for (other, (_, other_row)) in tallies.iter().zip(&table) {
                    let other_published = other_row[column][quantity];
                    // 1200 and 900 errors: relative sampling sigma 1/sqrt(2 n) of each rms.
                    let sigma = |value: f64| value * (1.0_f64 / 2400.0 + 1.0 / 1800.0).sqrt();
                    let sampling = sigma(published).hypot(sigma(other_published));
                    if other_published - published > 3.0 * sampling {
                        compared += 1;
                        assert!(
                            one.rms[quantity] < other.rms[quantity],
                            "drift {column}, quantity {quantity}: {} {} published {published} {other_published}",
                            one.rms[quantity],
                            other.rms[quantity],
                        );
                    }
                }
            }
        }
    }
    assert!(
        compared > 400,
        "{compared} pairs differ enough to be compared"
    );
}

#[test]
fn patent_drift_that_no_column_models_shows_as_unmodelled_bias() {
    let batch = tally(&BATCH, Drift::Linear);
    assert_close(batch.unmodelled_bias_deg_per_h, batch.rms[0], 0.02, 0.0);
    assert!(batch.mean_normalised_error > 100.0);
    assert!(tally(&BATCH_T, Drift::Linear).unmodelled_bias_deg_per_h < 0.05);
}

#[test]
fn a_rate_of_temperature_in_step_with_the_temperature_is_refused_in_words() {
    let both = Estimator::Batch {
        temperature: TemperatureColumns {
            bias_rate: true,
            ..TemperatureColumns::BIAS
        },
    };
    let (_, groups) = campaign(Drift::Linear, 0);
    let error = estimate(&groups, &both, Some([40.0; 3])).expect_err("one exponential");
    let title = "A rate of temperature in step with the temperature";
    let mut transcript = Transcript::of("calibrate", title);
    transcript.case("one exponential", error);
    transcript.check();
    let (_, groups) = campaign(Drift::Shupe, 0);
    assert!(estimate(&groups, &both, Some([40.0; 3])).is_ok());
}

/// Error of the batch in gyro x: bias deg/h, scale ppm, coefficient of the rate about y in urad.
fn hidden(rows: &[(usize, f64)], effect: impl Fn(usize, (usize, f64)) -> f64) -> [f64; 3] {
    let designs = plan(rows);
    let groups = observed(&designs, &truth(), 0.0, |group| {
        [effect(group, rows[group]), 0.0, 0.0]
    });
    let found = estimate(&groups, &BATCH, None)
        .expect("a calibration")
        .parameters;
    let truth = truth();
    [
        deg_per_s_to_deg_per_h(found.bias_deg_per_s[0] - truth.bias_deg_per_s[0]),
        1e6 * (found.scale_error[0] - truth.scale_error[0]),
        1e6 * (found.misalignment_rad.xz - truth.misalignment_rad.xz),
    ]
}

fn both_senses() -> Vec<(usize, f64)> {
    let rates = [-90.0, 10.0, 90.0];
    (0..3)
        .flat_map(|axis| rates.map(|rate| (axis, rate)))
        .collect()
}

#[track_caller]
fn assert_hidden(got: [f64; 3], want: [f64; 3], tolerance: [f64; 3]) {
    for index in 0..3 {
        assert_close(got[index], want[index], 0.0, tolerance[index]);
    }
}

#[test]
fn patent_one_sense_of_rotation_hides_asymmetry_and_bends_on_curvature() {
    // K(+) - K(-) = 20 ppm: half of it each way.
    let asymmetric = |_: usize, (axis, rate): (usize, f64)| {
        if axis == 0 { 10e-6 * rate.abs() } else { 0.0 }
    };
    let tolerance = [1e-3, 1e-3, 1e-3];
    assert_hidden(hidden(&NINE, asymmetric), [0.0, 10.0, 0.0], [0.01; 3]);
    let [bias, ..] = hidden(&both_senses(), asymmetric);
    assert_close(bias, 0.76, 0.0, 0.01);
    // A scale factor that grows with the magnitude of the rate, by 50 ppm at 90 deg/s.
    let curved = |_: usize, (axis, rate): (usize, f64)| {
        if axis == 0 {
            50e-6 * rate * rate.abs() / 90.0
        } else {
            0.0
        }
    };
    assert_hidden(hidden(&NINE, curved), [-0.956, 48.1, 3.7], [0.01, 0.1, 0.1]);
    assert_hidden(
        hidden(&both_senses(), curved),
        [-0.177, 49.8, 0.03],
        [0.01, 0.1, 0.1],
    );
    // A table rate wrong by 1 ppm is a scale error of 1 ppm.
    let fast = |_: usize, (axis, rate): (usize, f64)| if axis == 0 { 1e-6 * rate } else { 0.0 };
    assert_hidden(hidden(&NINE, fast), [0.0, 1.0, 0.0], tolerance);
}

#[test]
fn patent_bias_steps_between_mountings_and_forgotten_earth_rate_have_their_price() {
    let step = deg_per_h_to_deg_per_s(1.0);
    let after_a = |group: usize, _| if group >= 3 { step } else { 0.0 };
    let [bias, scale, _] = hidden(&NINE, after_a);
    assert_close(bias, 0.667, 0.0, 1e-3);
    assert_close(scale, -2.6, 0.0, 0.1);
    let after_b = |group: usize, _| if group >= 6 { step } else { 0.0 };
    assert_close(hidden(&NINE, after_b)[0], 0.333, 0.0, 1e-3);
    // Earth rate left out of the reference.
    let mut groups = observed(&plan(&NINE), &truth(), 0.0, |_| [0.0; 3]);
    for (group, (axis, rate)) in groups.iter_mut().zip(NINE) {
        group.design.reference_rate_deg_per_s[axis] = rate;
    }
    let found = estimate(&groups, &BATCH, None)
        .expect("a calibration")
        .parameters;
    let bias = found.bias_deg_per_h()[0] - 1.0;
    assert_close(bias, 2.659, 0.0, 0.01);
    assert_close(1e6 * (found.scale_error[0] - 800e-6), 20.7, 0.0, 0.1);
}

fn example() -> Vec<GroupObservation> {
    observed(&warm_plan(&NINE, &WARM_UP_C), &truth(), 0.0, |_| [0.0; 3])
}

#[test]
fn patent_reversed_sense_is_refused_and_named() {
    assert!(diagnose(&example()).is_empty());
    let mut groups = example();
    for group in &mut groups[3..6] {
        group.design.reference_rate_deg_per_s[1] *= -1.0;
    }
    assert_eq!(
        diagnose(&groups),
        [Finding::ReversedSense(Scope::Mounting(1))]
    );
    let error = estimate(&groups, &BATCH, None).expect_err("K = -2");
    let CalibrationError::Implausible {
        axis, scale_error, ..
    } = &error
    else {
        panic!("{error}");
    };
    assert_eq!(*axis, "y");
    assert_close(*scale_error, -2.0, 1e-3, 0.0);
    let mut transcript = Transcript::of("calibrate", "A reversed sense is refused and named");
    transcript.case("the mounting that turns about y, reversed", &error);
    transcript.check();
    let mut single = example();
    single[7].design.reference_rate_deg_per_s[2] *= -1.0;
    assert_eq!(
        diagnose(&single),
        [Finding::ReversedSense(Scope::Groups(vec![8]))]
    );
}

#[test]
fn swapped_axes_wrong_units_and_a_missing_mounting_are_named() {
    let mut swapped = example();
    for group in &mut swapped {
        group.output_deg_per_s.swap(0, 1);
    }
    let found = diagnose(&swapped);
    for (stated, seen) in [(0, 1), (1, 0)] {
        let scope = Scope::Mounting(stated);
        assert!(
            found.contains(&Finding::SwappedAxes {
                stated,
                seen,
                scope
            }),
            "{found:?}"
        );
    }
    let error = estimate(&swapped, &BATCH, None).expect_err("no such gyro");
    let title = "Swapped axes, wrong units and a missing mounting";
    let mut transcript = Transcript::of("calibrate", title);
    transcript.case("gyros x and y swapped", error);
    let cases = [
        (3600.0, "outputs in deg/h"),
        (1.0_f64.to_radians(), "outputs in rad/s"),
        (1.0_f64.to_degrees(), "reference rates in rad/s"),
        (1.0 / 3600.0, "reference rates in deg/h"),
    ];
    for (ratio, what) in cases {
        let mut groups = example();
        for group in &mut groups {
            group.output_deg_per_s = group.output_deg_per_s.map(|output| ratio * output);
        }
        let error = estimate(&groups, &BATCH, None).expect_err("wrong units");
        transcript.case(what, error);
    }
    assert_eq!(diagnose(&example()[..6]), [Finding::MountingMissing(2)]);
    let error = estimate(&example()[..6], &BATCH, None).expect_err("no mounting c");
    transcript.case("no mounting that turns about z", error);
    transcript.check();
}

#[test]
fn a_temperature_column_gives_the_bias_at_any_temperature() {
    let designs = warm_plan(&NINE, &WARM_UP_C);
    let groups = observed(&designs, &truth(), 0.0, |group| {
        [
            deg_per_h_to_deg_per_s(0.1) * (WARM_UP_C[group] - 40.0),
            0.0,
            0.0,
        ]
    });
    let found = estimate(&groups, &BATCH_T, Some([40.0; 3])).expect("a calibration");
    let compensation = Compensation::of(&found).expect("an inverse");
    let bias = compensation.bias_deg_per_s(Some([30.0; 3]))[0];
    assert_close(deg_per_s_to_deg_per_h(bias), 0.0, 0.0, 1e-9);
    for group in &groups {
        let temperature = Some(group.design.temperature_c);
        let rates =
            compensation.rates(CompensationForm::Exact, group.output_deg_per_s, temperature);
        for (got, want) in rates.iter().zip(group.design.reference_rate_deg_per_s) {
            assert_close(*got, want, 0.0, 1e-12);
        }
    }
}

#[test]
fn patent_outliers_are_rejected_and_cost_nothing() {
    // 10 Hz, sigma 9.49 deg/h, 0.2 % outliers of 50 sigma, 600 s: rms of group means, deg/h.
    let (mut kept, mut all, mut errors, mut rejected) = (vec![], vec![], vec![], 0);
    for index in 0..100 {
        let mut stream = Streams::new(2, index).stream("samples");
        let mut axes = [vec![], vec![], vec![]];
        for samples in &mut axes {
            for sample in 0..6000_u32 {
                let outlier = if (sample * 7919) % 500 == 3 {
                    50.0
                } else {
                    0.0
                };
                let sign = if sample % 2 == 0 { 1.0 } else { -1.0 };
                let value = 9.49
                    * (stream.normal()
                        + if stream.normal() > 0.0 {
                            outlier
                        } else {
                            sign * outlier
                        });
                samples.push(deg_per_h_to_deg_per_s(value) + 10.0);
            }
        }
        let outputs = axes.each_ref().map(Vec::as_slice);
        let record = GroupSamples {
            output_deg_per_s: outputs,
            temperature_c: [&[25.0, 26.0]; 3],
            sample_rate_hz: 10.0,
        };
        let turns = Averaging::WholeTurns(10.0);
        let means = group_means(&record, turns, Some(OUTLIER_THRESHOLD)).expect("means");
        assert_eq!(means.samples, 5760);
        assert_close(means.averaging_time_s, 576.0, 1e-12, 0.0);
        rejected += means.rejected.iter().sum::<usize>();
        let none = group_means(&record, Averaging::FixedTime, None).expect("means");
        for axis in 0..3 {
            kept.push(deg_per_s_to_deg_per_h(means.output_deg_per_s[axis] - 10.0));
            errors.push(deg_per_s_to_deg_per_h(means.standard_error_deg_per_s[axis]));
            all.push(deg_per_s_to_deg_per_h(none.output_deg_per_s[axis] - 10.0));
        }
    }
    let zeros = vec![0.0; kept.len()];
    // 300 means: relative sampling sigma 1/sqrt(600) = 4 %.
    let white = 9.49 / 5760_f64.sqrt();
    assert_close(unmodelled_rms(&kept, &zeros), white, 0.13, 0.0);
    assert_close(unmodelled_rms(&errors, &zeros), white, 0.05, 0.0);
    assert!(unmodelled_rms(&all, &zeros) > 2.0 * white);
    assert!((3300..3900).contains(&rejected), "{rejected}");
}
