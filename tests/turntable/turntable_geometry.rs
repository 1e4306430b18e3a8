//! Pointing of axis and gyro: exact kinematics against rotations written apart from the library.

use std::f64::consts::TAU;

use fogbench::scenario::{
    AxisConfig, MotionConfig, MountingConfig, RotationConfig, ServoConfig, SiteConfig, StepsConfig,
    SwingConfig, TurntableConfig,
};
use fogbench::turntable::{Turntable, earth_rate_rad_per_s, input_axis_bounds};
use fogbench::units::{
    EARTH_RATE_RAD_PER_S, arcsec_to_rad, deg_per_s_to_rad_per_s, deg_to_rad,
    rad_per_s_to_deg_per_h, rad_to_arcsec,
};
use fogbench::vocabulary::CaseAxis;

use crate::support::assert_close;
use crate::support::turntable_cases::{no_encoder, true_axis, true_mounting};

const PERIOD_S: f64 = 0.000_25;
const LATITUDE_DEG: f64 = 34.27;

fn upright() -> SiteConfig {
    SiteConfig {
        latitude_deg: LATITUDE_DEG,
        axis_elevation_deg: 90.0,
        ..SiteConfig::reference()
    }
}

fn rotation(rate_deg_per_s: f64) -> MotionConfig {
    MotionConfig::Rotation(RotationConfig {
        rate_deg_per_s,
        soft_start_s: 0.0,
        ..RotationConfig::reference()
    })
}

fn swing() -> MotionConfig {
    MotionConfig::Swing(SwingConfig {
        rate_amplitude_deg_per_s: Some(300.0),
        frequency_hz: 0.7,
        soft_start_s: 0.5,
        ..SwingConfig::reference()
    })
}

fn config(motion: MotionConfig, axis: AxisConfig, mounting: MountingConfig) -> TurntableConfig {
    TurntableConfig {
        motion,
        servo: ServoConfig::ideal(),
        encoder: no_encoder(),
        site: upright(),
        axis,
        mounting,
        ..TurntableConfig::reference()
    }
}

fn askew(misalignment_arcsec: f64, misalignment_azimuth_deg: f64) -> MountingConfig {
    MountingConfig {
        misalignment_arcsec,
        misalignment_azimuth_deg,
        ..true_mounting()
    }
}

fn table(config: &TurntableConfig) -> Turntable {
    Turntable::new(config, 1.0, PERIOD_S)
}

type Vector = [f64; 3];

fn dot(a: Vector, b: Vector) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn unit(a: Vector) -> Vector {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

/// Rodrigues' rotation of `v` about the unit vector `k`.
fn turned(v: Vector, k: Vector, angle: f64) -> Vector {
    let (sine, cosine) = angle.sin_cos();
    let (side, along) = (cross(k, v), dot(k, v) * (1.0 - cosine));
    [0, 1, 2].map(|i| v[i] * cosine + side[i] * sine + k[i] * along)
}

/// The least rotation that takes unit vector `from` to unit vector `to`, applied to `v`.
fn bent(v: Vector, from: Vector, to: Vector) -> Vector {
    let hinge = cross(from, to);
    let sine = dot(hinge, hinge).sqrt();
    if sine < 1e-15 {
        return v;
    }
    turned(v, hinge.map(|x| x / sine), sine.atan2(dot(from, to)))
}

/// Mark, quarter turn and normal of the platform in east, north, up at a table angle.
fn triad(config: &TurntableConfig, angle: f64) -> [Vector; 3] {
    let (el, az) = (
        deg_to_rad(config.site.axis_elevation_deg),
        deg_to_rad(config.site.axis_azimuth_deg),
    );
    let mean = unit([
        el.cos() * az.sin() + arcsec_to_rad(config.axis.tilt_east_arcsec),
        el.cos() * az.cos() + arcsec_to_rad(config.axis.tilt_north_arcsec),
        el.sin(),
    ]);
    let falling = [el.sin() * az.sin(), el.sin() * az.cos(), -el.cos()];
    let along = dot(falling, mean);
    let zero = unit([0, 1, 2].map(|i| falling[i] - along * mean[i]));
    // The normal stands on its cone at `k` times the table angle.
    let k = f64::from(config.axis.wobble_harmonic);
    let towards = turned(zero, mean, k * angle);
    let wobble = arcsec_to_rad(config.axis.wobble_arcsec);
    let normal = [0, 1, 2].map(|i| mean[i] * wobble.cos() + towards[i] * wobble.sin());
    let quarter = cross(mean, zero);
    [zero, quarter, mean].map(|axis| bent(turned(axis, mean, angle), mean, normal))
}

/// Case axes x, y, z in east, north, up at a table angle.
fn case(config: &TurntableConfig, angle: f64) -> [Vector; 3] {
    let [mark, quarter, normal] = triad(config, angle);
    let azimuth = deg_to_rad(config.mounting.misalignment_azimuth_deg);
    let hinge = turned(quarter, normal, azimuth);
    let mu = arcsec_to_rad(config.mounting.misalignment_arcsec);
    let [mark, quarter, normal] = [mark, quarter, normal].map(|axis| turned(axis, hinge, mu));
    match config.mounting.axis_along_table {
        CaseAxis::X => [normal, mark, quarter],
        CaseAxis::Y => [quarter, normal, mark],
        CaseAxis::Z => [mark, quarter, normal],
    }
}

/// Inertial rate of the case axes, the table's part by differences of the axes themselves.
fn inertial(config: &TurntableConfig, angle: f64, rate: f64) -> [f64; 3] {
    const STEP: f64 = 1e-4;
    let here = case(config, angle);
    let (before, after) = (case(config, angle - STEP), case(config, angle + STEP));
    let change = |i: usize| [0, 1, 2].map(|j| (after[i][j] - before[i][j]) / (2.0 * STEP));
    // w . z = x' . y and so on round the cycle.
    let spin = [
        dot(change(1), here[2]),
        dot(change(2), here[0]),
        dot(change(0), here[1]),
    ];
    let latitude = deg_to_rad(config.site.latitude_deg);
    let earth = [0.0, latitude.cos(), latitude.sin()].map(|x| x * EARTH_RATE_RAD_PER_S);
    [0, 1, 2].map(|i| rate * spin[i] + dot(earth, here[i]))
}

fn crooked(axis_along_table: CaseAxis, wobble_harmonic: u32) -> TurntableConfig {
    let mut config = config(
        swing(),
        AxisConfig {
            tilt_north_arcsec: 2000.0,
            tilt_east_arcsec: -3000.0,
            wobble_arcsec: 3000.0,
            wobble_harmonic,
            ..AxisConfig::reference()
        },
        MountingConfig {
            misalignment_arcsec: 90_000.0,
            misalignment_azimuth_deg: 130.0,
            start_angle_deg: 40.0,
            axis_along_table,
            ..MountingConfig::reference()
        },
    );
    config.site.axis_elevation_deg = 35.0;
    config.site.axis_azimuth_deg = 110.0;
    config
}

#[test]
fn platform_rates_are_those_of_the_rotations() {
    for (axis, harmonic) in [
        (CaseAxis::X, 1),
        (CaseAxis::Y, 2),
        (CaseAxis::Z, 2),
        (CaseAxis::Z, 1),
    ] {
        let config = crooked(axis, harmonic);
        let plain = TurntableConfig {
            site: SiteConfig {
                latitude_deg: 0.0,
                axis_elevation_deg: 90.0,
                ..SiteConfig::reference()
            },
            axis: true_axis(),
            mounting: true_mounting(),
            ..config.clone()
        };
        let (mut crooked, mut plain) = (table(&config), table(&plain));
        for index in 0..8000 {
            let got = crooked.next_platform_segments();
            let rate = plain.next_segment().rate_at(1.0);
            if index % 97 != 0 {
                continue;
            }
            let want = inertial(&config, crooked.angle_rad(), rate);
            for (segment, want) in got.iter().zip(want) {
                // Central differences err by STEP^2 / 6 of the rate, here up to 5 rad/s.
                assert_close(segment.rate_at(1.0), want, 0.0, 1e-8 * (rate.abs() + 0.01));
            }
        }
    }
}

#[test]
fn slopes_of_platform_segments_are_derivatives_of_their_rates() {
    for harmonic in [1, 2] {
        let mut table = table(&crooked(CaseAxis::Y, harmonic));
        let segments: Vec<_> = (0..8000).map(|_| table.next_platform_segments()).collect();
        for pair in segments.windows(2) {
            for (first, second) in pair[0].iter().zip(&pair[1]) {
                let [_, c1, c2, c3] = first.rate_rad_per_s;
                assert_close(second.rate_at(0.0), first.rate_at(1.0), 1e-13, 1e-15);
                let slope = c1 + 2.0 * c2 + 3.0 * c3;
                assert_close(second.rate_rad_per_s[1], slope, 1e-9, 1e-14);
            }
        }
        // The mean slope of a segment by Simpson's rule is its rise; with the rise a sixth-order
        // check of the end slopes over two segments: r(2) - r(0) = (s0 + 4 s1 + s2) / 3.
        for pair in segments.windows(2).skip(4000) {
            for (first, second) in pair[0].iter().zip(&pair[1]) {
                let rise = second.rate_at(1.0) - first.rate_at(0.0);
                let [_, c1, c2, c3] = second.rate_rad_per_s;
                let simpson = (first.rate_rad_per_s[1] + 4.0 * c1 + c1 + 2.0 * c2 + 3.0 * c3) / 3.0;
                // h^5 r''''' / 90 with h = w T and w = 2 pi 0.7 Hz or the wobble's 10 rad/s.
                assert_close(rise, simpson, 0.0, 1e-13);
            }
        }
    }
}

#[test]
fn known_answer_k28_a_misaligned_gyro_on_a_rotating_table() {
    // 40,000 samples a turn, two turns; one milliradian.
    const TURN: usize = 40_000;
    let misalignment_arcsec = rad_to_arcsec(1e-3);
    let config = config(
        rotation(36.0),
        true_axis(),
        askew(misalignment_arcsec, 25.0),
    );
    let mut table = table(&config);
    let (mut mean, mut cosine, mut sine) = (0.0, 0.0, 0.0);
    let turning = deg_per_s_to_rad_per_s(36.0) * 1e-3_f64.cos();
    for index in 1..=2 * TURN {
        let earth = rad_per_s_to_deg_per_h(table.next_segment().rate_at(1.0) - turning);
        let angle = TAU * index as f64 / TURN as f64 + deg_to_rad(25.0);
        mean += earth / (2 * TURN) as f64;
        cosine += earth * angle.cos() / TURN as f64;
        sine += earth * angle.sin() / TURN as f64;
    }
    let pole = rad_per_s_to_deg_per_h(EARTH_RATE_RAD_PER_S);
    let latitude = deg_to_rad(LATITUDE_DEG);
    // Unchanged but for cos mu, half a millionth; the differences from 36 deg/s keep 1e-9 deg/h.
    assert_close(mean, pole * latitude.sin(), 1e-6, 0.0);
    assert_close(mean, pole * latitude.sin() * 1e-3_f64.cos(), 0.0, 1e-8);
    assert_close(cosine, 1e-3 * 15.041_07 * latitude.cos(), 1e-6, 0.0);
    assert_close(sine, 0.0, 0.0, 1e-8);
    assert_close(table.angle_rad(), 2.0 * TAU, 1e-14, 0.0);
}

#[test]
fn first_order_formula_holds_to_second_order() {
    // Tilts of 100 and 70 arcsec, wobble of 5 arcsec, 0.5 mrad of misalignment, at 20 deg/s.
    let axis = AxisConfig {
        tilt_north_arcsec: 100.0,
        tilt_east_arcsec: 70.0,
        wobble_arcsec: 5.0,
        wobble_harmonic: 2,
        ..AxisConfig::reference()
    };
    let mu = 5e-4;
    let config = config(rotation(20.0), axis, askew(rad_to_arcsec(mu), 60.0));
    let mut table = table(&config);
    let latitude = deg_to_rad(LATITUDE_DEG);
    let rate = deg_per_s_to_rad_per_s(20.0);
    let (tilt, wobble) = (arcsec_to_rad(100.0), arcsec_to_rad(5.0));
    let mut largest: f64 = 0.0;
    for _ in 0..72_000 {
        let truth = table.next_segment().rate_at(1.0);
        let angle = table.angle_rad();
        let north = tilt + wobble * (2.0 * angle).cos() + mu * (angle + deg_to_rad(60.0)).cos();
        let first_order =
            rate * mu.cos() + EARTH_RATE_RAD_PER_S * (latitude.sin() + north * latitude.cos());
        largest = largest.max((truth - first_order).abs());
    }
    // The remainder: mu w k of the table rate, and squares of the small angles of the Earth's.
    // The wobble also takes k w^2 / 2 off the axial rate.
    let cross_term = rate * 2.0 * mu * wobble;
    let squares = rate * wobble * wobble
        + EARTH_RATE_RAD_PER_S * (tilt + mu + wobble + arcsec_to_rad(70.0)).powi(2);
    assert!(
        largest <= cross_term + squares,
        "{largest} above {cross_term} + {squares}"
    );
    assert!(
        largest > 0.9 * cross_term,
        "{largest} far below {cross_term}"
    );
}

#[test]
fn a_platform_askew_on_its_spindle_is_a_misaligned_gyro() {
    // Wobble of harmonic 1 is a fixed tilt of the platform: the axes differ by no more than names.
    let by_wobble = config(
        swing(),
        AxisConfig {
            wobble_arcsec: 3600.0,
            ..true_axis()
        },
        true_mounting(),
    );
    let by_mounting = config(swing(), true_axis(), askew(3600.0, 0.0));
    let (mut first, mut second) = (table(&by_wobble), table(&by_mounting));
    for _ in 0..8000 {
        let (first, second) = (first.next_segment(), second.next_segment());
        for (a, b) in first.rate_rad_per_s.iter().zip(second.rate_rad_per_s) {
            assert_close(*a, b, 1e-13, 1e-15);
        }
    }
}

#[test]
fn the_case_axis_along_the_table_is_the_input_axis() {
    for (axis, index) in [(CaseAxis::X, 0), (CaseAxis::Y, 1), (CaseAxis::Z, 2)] {
        let config = crooked(axis, 2);
        let (mut single, mut assembly) = (table(&config), table(&config));
        for _ in 0..4000 {
            assert_eq!(
                single.next_segment(),
                assembly.next_platform_segments()[index]
            );
        }
    }
}

#[test]
fn rates_of_the_three_axes_make_the_whole_vector() {
    let mut config = crooked(CaseAxis::X, 1);
    config.motion = MotionConfig::rest();
    let mut table = table(&config);
    let rates = table
        .next_platform_segments()
        .map(|segment| segment.rate_at(1.0));
    assert_close(dot(rates, rates).sqrt(), EARTH_RATE_RAD_PER_S, 1e-14, 0.0);
    // Level axes: with the mark to the north x senses the horizontal component, y nothing.
    let level = self::config(config.motion, true_axis(), true_mounting());
    let rates = self::table(&level)
        .next_platform_segments()
        .map(|segment| segment.rate_at(1.0));
    let latitude = deg_to_rad(LATITUDE_DEG);
    for (rate, part) in rates.iter().zip([latitude.cos(), 0.0, latitude.sin()]) {
        assert_close(*rate, EARTH_RATE_RAD_PER_S * part, 1e-14, 1e-20);
    }
    // A quarter turn later, right-handed about up, the mark points west and y to the south.
    let turned = MountingConfig {
        start_angle_deg: 90.0,
        ..true_mounting()
    };
    let turned = self::config(level.motion, true_axis(), turned);
    let rates = self::table(&turned)
        .next_platform_segments()
        .map(|segment| segment.rate_at(1.0));
    for (rate, part) in rates.iter().zip([0.0, -latitude.cos(), latitude.sin()]) {
        assert_close(*rate, EARTH_RATE_RAD_PER_S * part, 1e-14, 1e-20);
    }
}

#[test]
fn a_true_table_adds_the_rate_of_the_earth_and_nothing_else() {
    let steps = MotionConfig::Steps(StepsConfig {
        rates_deg_per_s: vec![2.0, -1.0],
        dwell_s: 0.1,
        settle_s: 0.0,
        ..StepsConfig::reference()
    });
    for motion in [rotation(7.0), swing(), steps] {
        let config = config(motion, true_axis(), true_mounting());
        let still = TurntableConfig {
            site: SiteConfig {
                latitude_deg: 0.0,
                ..upright()
            },
            ..config.clone()
        };
        let earth = earth_rate_rad_per_s(&upright());
        let nothing = earth_rate_rad_per_s(&still.site);
        assert!(nothing.abs() < 1e-20);
        let (mut turning, mut still) = (table(&config), table(&still));
        for _ in 0..4000 {
            let mut want = still.next_segment().rate_rad_per_s;
            want[0] += earth;
            let got = turning.next_segment().rate_rad_per_s;
            // The still table's own 4e-21 rad/s is in the constant term alone.
            assert_close(got[0], want[0], 1e-15, 1e-20);
            for (got, want) in got.iter().zip(want).skip(1) {
                assert_eq!(got.to_bits(), want.to_bits());
            }
        }
    }
}

#[test]
fn a_tilted_axis_sees_its_new_pointing() {
    // 0.1 deg towards north gains 0.0217 deg/h, towards east the square of it only.
    let seen = |tilt_north_arcsec, tilt_east_arcsec| {
        let axis = AxisConfig {
            tilt_north_arcsec,
            tilt_east_arcsec,
            ..true_axis()
        };
        let config = config(MotionConfig::rest(), axis, true_mounting());
        rad_per_s_to_deg_per_h(table(&config).next_segment().rate_at(1.0))
    };
    let (up, north) = (seen(0.0, 0.0), seen(360.0, 0.0));
    let exact =
        15.041_07 * deg_to_rad(0.1).cos() * deg_to_rad(0.1) * deg_to_rad(LATITUDE_DEG).cos();
    let lost = up * (1.0 - deg_to_rad(0.1).cos());
    assert_close(north - up, exact - lost, 1e-5, 0.0);
    assert_close(seen(0.0, 360.0) - up, -lost, 1e-5, 0.0);
}

#[test]
fn bounds_hold_and_are_reached() {
    for harmonic in [1, 2] {
        let mut config = crooked(CaseAxis::Z, harmonic);
        config.motion = rotation(360.0);
        let bounds = input_axis_bounds(&config);
        let mut table = table(&config);
        let rate = TAU;
        let (mut largest, mut steepest): (f64, f64) = (0.0, 0.0);
        for _ in 0..4000 {
            let segment = table.next_segment();
            largest = largest.max(segment.rate_at(1.0).abs());
            steepest = steepest.max(segment.rate_rad_per_s[1].abs() / PERIOD_S);
        }
        let allowed = bounds.earth_rate_rad_per_s + bounds.rate_ratio * rate;
        assert!(
            largest <= allowed * (1.0 + 1e-12),
            "{largest} above {allowed}"
        );
        if harmonic == 2 {
            // All phases of the wobble pass the input axis, but not those of the Earth.
            assert!(largest > 0.999 * allowed, "{largest} far below {allowed}");
        }
        let allowed = rate * (bounds.acceleration_ratio * rate + bounds.earth_slope_rad_per_s);
        assert!(
            steepest <= allowed * (1.0 + 1e-9),
            "{steepest} above {allowed}"
        );
        assert!(steepest > 0.8 * allowed, "{steepest} far below {allowed}");
    }
    let neutral = config(rotation(1.0), true_axis(), true_mounting());
    let bounds = input_axis_bounds(&neutral);
    assert_close(bounds.rate_ratio, 1.0, 0.0, 0.0);
    assert_close(
        bounds.earth_rate_rad_per_s,
        earth_rate_rad_per_s(&upright()),
        0.0,
        0.0,
    );
}

#[test]
fn the_angle_of_a_swing_is_the_integral_of_its_rate() {
    let motion = MotionConfig::Swing(SwingConfig {
        angle_amplitude_deg: Some(3.0),
        frequency_hz: 5.0,
        soft_start_s: 0.0,
        ..SwingConfig::reference()
    });
    let mounting = MountingConfig {
        start_angle_deg: -20.0,
        ..true_mounting()
    };
    let mut table = table(&config(motion, true_axis(), mounting));
    assert_close(table.angle_rad(), deg_to_rad(-20.0), 1e-15, 0.0);
    for index in 1..=40_000_u32 {
        let _ = table.next_segment();
        let phase = TAU * (f64::from(index) / 800.0).fract();
        let exact = deg_to_rad(-20.0) + deg_to_rad(3.0) * (1.0 - phase.cos());
        // The integral of the cubics misses (w T)^4 / 720 of the amplitude, 5e-12 of 3 deg.
        assert_close(table.angle_rad(), exact, 0.0, 1e-11);
    }
}
