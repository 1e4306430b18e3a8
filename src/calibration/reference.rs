//! What the gyros ought to see: table rate and Earth rate about the case axes.

use std::f64::consts::{PI, TAU};

use crate::units::{EARTH_RATE_RAD_PER_S, deg_to_rad, rad_per_s_to_deg_per_s};

/// One group as the table turns it, its axis vertical.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableGroup {
    /// Case axis along the table axis: 0 = x (mounting a), 1 = y (b), 2 = z (c).
    pub axis: usize,
    /// Whether that case axis points up; the patent's mountings do.
    pub is_up: bool,
    /// Rate of the table, deg/s, right-handed about up.
    pub table_rate_deg_per_s: f64,
    /// Time averaged over, s.
    pub averaging_time_s: f64,
    /// Angle of the next case axis (x after z) from north at the start, right-handed about up, deg;
    /// none: unknown, and horizontal Earth rate is left out as in the patent.
    pub start_azimuth_deg: Option<f64>,
}

/// Mean inertial rate about the case axes, deg/s: equations (20) to (22), and what of the horizontal
/// Earth rate the average leaves if the azimuth is known.
#[must_use]
pub fn reference_rate(group: &TableGroup, latitude_deg: f64) -> [f64; 3] {
    let earth = rad_per_s_to_deg_per_s(EARTH_RATE_RAD_PER_S);
    let latitude_rad = deg_to_rad(latitude_deg);
    let up = if group.is_up { 1.0 } else { -1.0 };
    let mut rates = [0.0; 3];
    rates[group.axis % 3] = up * (earth * latitude_rad.sin() + group.table_rate_deg_per_s);
    if let Some(azimuth_deg) = group.start_azimuth_deg {
        let turned_rad = deg_to_rad(group.table_rate_deg_per_s) * group.averaging_time_s;
        let middle_rad = deg_to_rad(azimuth_deg) + turned_rad / 2.0;
        let mean = earth * latitude_rad.cos() * sinc(turned_rad / 2.0);
        rates[(group.axis + 1) % 3] += mean * middle_rad.cos();
        // The third axis is a quarter turn further about the case axis, which may point down.
        rates[(group.axis + 2) % 3] -= up * mean * middle_rad.sin();
    }
    rates
}

/// Largest mean that a horizontal rate leaves in a level gyro after turning by `A = rate time`:
/// `WH |2 sin(A/2) / A|`, deg/s; at rest all of it.
///
/// * `horizontal_deg_per_s`: WH, for Earth `we cos L`.
#[must_use]
pub fn horizontal_residue_deg_per_s(
    horizontal_deg_per_s: f64,
    table_rate_deg_per_s: f64,
    time_s: f64,
) -> f64 {
    let half_rad = deg_to_rad(table_rate_deg_per_s) * time_s / 2.0;
    horizontal_deg_per_s * sinc(half_rad).abs()
}

/// Longest averaging time after which the horizontal Earth rate has gone round whole times.
///
/// Longest time of whole turns of the table within `time_s`, s, and the turns.
///
/// At rest, or in less than a turn, there is none.
#[must_use]
pub fn whole_turns_s(table_rate_deg_per_s: f64, time_s: f64) -> Option<(f64, f64)> {
    let rate_rad_per_s = deg_to_rad(table_rate_deg_per_s.abs());
    // A turn that ends with the record is whole in spite of rounding.
    let turns = (rate_rad_per_s * time_s / TAU * (1.0 + 1e-9)).floor();
    (turns >= 1.0).then(|| (turns * 2.0 * PI / rate_rad_per_s, turns))
}

fn sinc(angle_rad: f64) -> f64 {
    if angle_rad.abs() < 1e-9 {
        1.0
    } else {
        angle_rad.sin() / angle_rad
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_turns_of_the_patents_rates_last_576_597_6_and_600_s() {
        for (rate, time_s, turns) in [
            (10.0, 576.0, 16.0),
            (50.0, 597.6, 83.0),
            (-90.0, 600.0, 150.0),
        ] {
            let (got_s, got_turns) = whole_turns_s(rate, 600.0).expect("more than a turn");
            assert!((got_s - time_s).abs() < 1e-9 && (got_turns - turns).abs() < 1e-12);
        }
        assert!(whole_turns_s(0.0, 600.0).is_none() && whole_turns_s(0.1, 600.0).is_none());
    }

    #[test]
    fn horizontal_earth_rate_does_not_average_out_in_600_s() {
        let horizontal_deg_per_h = 12.751_373_115;
        let residue = |rate| horizontal_residue_deg_per_s(horizontal_deg_per_h, rate, 600.0);
        assert!((residue(10.0) - 0.2109).abs() < 1e-4);
        assert!((residue(50.0) - 0.0422).abs() < 1e-4);
        assert!(residue(90.0) < 1e-12);
        assert!((residue(0.0) - horizontal_deg_per_h).abs() < 1e-12);
    }

    #[test]
    fn the_mean_over_a_part_of_a_turn_is_that_of_the_turning_horizontal() {
        let group = TableGroup {
            axis: 2,
            is_up: false,
            table_rate_deg_per_s: 10.0,
            averaging_time_s: 13.0,
            start_azimuth_deg: Some(30.0),
        };
        let got = reference_rate(&group, 40.0);
        // z down, so y is a quarter turn left-handed about up from x: midpoint rule over the turn.
        let (mut x, mut y) = (0.0, 0.0);
        let horizontal = rad_per_s_to_deg_per_s(EARTH_RATE_RAD_PER_S) * deg_to_rad(40.0).cos();
        for step in 0..13_000 {
            let azimuth_rad = deg_to_rad(30.0 + 10.0 * (f64::from(step) + 0.5) * 1e-3);
            x += horizontal * azimuth_rad.cos() / 13_000.0;
            y += horizontal * (azimuth_rad - PI / 2.0).cos() / 13_000.0;
        }
        assert!(
            (got[0] - x).abs() < 1e-10 && (got[1] - y).abs() < 1e-10,
            "{got:?} {x} {y}"
        );
    }
}
