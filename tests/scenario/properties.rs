//! Laws that hold for any numbers: what undoes each other, and what no order changes.

use fogbench::calibration::{Compensation, ErrorParameters, Misalignment};
use fogbench::metrics::{ChannelMetrics, aggregate};
use fogbench::recording::{LogFormat, RATE_MAX_DEG_PER_H, RateUnit, csv_text, read_log};
use fogbench::store::write_npy;
use fogbench::vocabulary::CompensationForm;
use proptest::prelude::*;

use crate::support::run::{channel, curve};
use crate::support::{assert_close, write};

/// Errors of an assembly of the size that a compensation is for: 1 %, 1 deg and 10 deg/h at most.
fn parameters() -> impl Strategy<Value = ErrorParameters> {
    let triple = |size: f64| prop::array::uniform3(-size..size);
    (
        triple(0.01),
        prop::array::uniform6(-0.017..0.017),
        triple(0.003),
    )
        .prop_map(
            |(scale_error, [xy, xz, yx, yz, zx, zy], bias_deg_per_s)| ErrorParameters {
                scale_error,
                misalignment_rad: Misalignment {
                    xy,
                    xz,
                    yx,
                    yz,
                    zx,
                    zy,
                },
                bias_deg_per_s,
            },
        )
}

/// Words of a log: any number that is a rate, small ones and zeros too.
fn rates() -> impl Strategy<Value = Vec<f64>> {
    let rate = prop_oneof![
        -RATE_MAX_DEG_PER_H..=RATE_MAX_DEG_PER_H,
        -1.0..1.0,
        -1e-300..1e-300,
        Just(0.0),
    ];
    prop::collection::vec(rate, 1..50)
}

/// Metrics and a curve of one repeat. Its values stand near those of the others, so that no sum
/// cancels.
fn repeat() -> impl Strategy<Value = ChannelMetrics> {
    (1.0..2.0, 0.0..0.1, prop::collection::vec(1.0..2.0, 3)).prop_map(|(value, half, powers)| {
        let around = |value: f64| [value, value - half, value + half];
        let mut repeat = channel(&[
            ("mean_deg_per_h", around(value), "deg/h"),
            (
                "tracking_error_rms_deg_per_h",
                around(value * value),
                "deg/h",
            ),
            ("noise_std_deg_per_h", around(2.0 * value), "deg/h"),
        ]);
        let psd = curve(&[
            ("frequency_hz", vec![1.0, 2.0, 4.0]),
            ("psd_deg2_per_h2_per_hz", powers),
        ]);
        repeat.curves.insert("psd".to_owned(), psd);
        repeat
    })
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 100, failure_persistence: None, ..ProptestConfig::default()
    })]

    #[test]
    fn exact_compensation_undoes_the_errors_and_the_first_order_form_leaves_its_residual(
        parameters in parameters(), rate in prop::array::uniform3(-500.0..500.0)
    ) {
        let compensation = Compensation::new(parameters).expect("errors far below 1");
        let output = parameters.predict(rate);
        let exact = compensation.rates(CompensationForm::Exact, output, None);
        let first = compensation.rates(CompensationForm::FirstOrder, output, None);
        let left = compensation.residual(CompensationForm::FirstOrder, rate);
        for axis in 0..3 {
            assert_close(exact[axis], rate[axis], 0.0, 1e-10);
            assert_close(first[axis] - rate[axis], left[axis], 0.0, 1e-10);
        }
        // The other way round: rates that were compensated have the errors put back.
        let back = parameters.predict(exact);
        for axis in 0..3 {
            assert_close(back[axis], output[axis], 0.0, 1e-10);
        }
    }

    #[test]
    fn what_is_written_as_csv_and_npy_is_read_back_to_the_bit(rates in rates()) {
        let folder = tempfile::tempdir().expect("a scratch folder");
        let format = LogFormat {
            rate_hz: Some(400.0),
            unit: Some(RateUnit::DEG_PER_H.into()),
            ..LogFormat::default()
        };
        let path = folder.path().join("log.npy");
        write_npy(&path, &rates).expect("a writable folder");
        let bits = |rates: &[f64]| rates.iter().map(|rate| rate.to_bits()).collect::<Vec<_>>();
        let log = read_log(&path, &format).expect("own NPY");
        prop_assert_eq!(bits(&log.rate_deg_per_h), bits(&rates));

        let path = write(folder.path(), "log.csv", &csv_text(&rates, 1.0 / 400.0));
        let second = LogFormat { column: Some(vec!["2".to_owned()]), ..format };
        let log = read_log(&path, &second).expect("own CSV");
        prop_assert_eq!(bits(&log.rate_deg_per_h), bits(&rates));
    }

    #[test]
    fn repeats_pool_alike_in_any_order(
        (repeats, order) in prop::collection::vec(repeat(), 2..9).prop_flat_map(|repeats| {
            let order: Vec<usize> = (0..repeats.len()).collect();
            (Just(repeats), Just(order).prop_shuffle())
        })
    ) {
        let shuffled: Vec<ChannelMetrics> =
            order.iter().map(|&index| repeats[index].clone()).collect();
        let (pooled, other) = (aggregate(&repeats), aggregate(&shuffled));
        prop_assert!(pooled.metrics.keys().eq(other.metrics.keys()));
        // Sums of nine numbers near each other differ by their order in the last bits.
        for (name, metric) in &pooled.metrics {
            let again = &other.metrics[name];
            assert_close(again.estimate.value, metric.estimate.value, 1e-13, 0.0);
            assert_close(again.estimate.low, metric.estimate.low, 1e-11, 1e-13);
            assert_close(again.estimate.high, metric.estimate.high, 1e-11, 1e-13);
            prop_assert_eq!(again.fields.get("repeats"), metric.fields.get("repeats"));
        }
        for (name, column) in &pooled.curves["psd"] {
            for (power, again) in column.iter().zip(&other.curves["psd"][name]) {
                assert_close(*again, *power, 1e-13, 0.0);
            }
        }
    }
}
