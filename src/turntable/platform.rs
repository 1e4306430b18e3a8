//! The inertial rate of axes fixed in the platform: exact kinematics of an imperfect table.

use super::axis::{Vector, cross, dot, earth_in_table_frame};
use crate::signal::MotionSegment;
use crate::turntable::{MountingConfig, TurntableConfig};
use crate::units::{arcsec_to_rad, deg_to_rad};
use crate::vocabulary::CaseAxis;

/// The platform and what is mounted on it.
///
/// From the frame of the table (see `earth_in_table_frame`) the platform is turned by
/// `R = Rz(k theta) Ry(w) Rz((1 - k) theta)`: its normal lies on a cone of half angle `w` (wobble)
/// about the mean axis and goes round it `k` times per turn, and the mark turns by `theta`. The
/// platform therefore turns, per radian of table angle and in its own axes, by
/// `s = (-k sin w cos psi, k sin w sin psi, 1 - k (1 - cos w))` with `psi = (1 - k) theta`. An axis
/// `c` fixed in it senses `c . (theta' s + R^T e)`, `e` being the Earth's rotation.
///
/// # Source
/// Derived: the body rates of the Euler angles z-y-z. To first order it is
/// `theta' cos mu + OmegaE (sin lat + tN cos lat + mu cos lat cos(theta + theta0))`.
/// Known answer: `known_answer_k28_a_misaligned_gyro_on_a_rotating_table`.
#[derive(Clone, Debug)]
pub(super) struct Platform {
    /// Earth's rotation in the frame of the table, rad/s.
    earth: Vector,
    wobble_sine: f64,
    wobble_cosine: f64,
    /// `k`.
    harmonic: f64,
    /// Case axes x, y, z in the platform: mark, a quarter turn from it, normal.
    case: [Vector; 3],
    /// Which of them lies along the platform normal but for the misalignment.
    input: usize,
    mounting: MountingConfig,
    sample_period_s: f64,
    /// At the end of the last segment.
    now: Attitude,
}

/// What depends on the table angle alone.
#[derive(Clone, Copy, Debug)]
struct Attitude {
    /// Table angle, rad.
    angle: f64,
    /// Turning of the platform per radian, in the platform.
    spin: Vector,
    /// Its derivative, per radian.
    spin_slope: Vector,
    /// The Earth's rotation in the platform, rad/s.
    earth: Vector,
    /// Its derivative, rad/s per radian.
    earth_slope: Vector,
}

impl Attitude {
    /// Rate (rad/s) and slope (rad/s per sample) on a platform axis, from those of the table.
    fn sensed(&self, axis: Vector, rate: f64, slope: f64, sample_period_s: f64) -> (f64, f64) {
        let spin = dot(axis, self.spin);
        let turning = rate * dot(axis, self.spin_slope) + dot(axis, self.earth_slope);
        (
            rate * spin + dot(axis, self.earth),
            slope * spin + sample_period_s * rate * turning,
        )
    }
}

impl Platform {
    /// A platform at `angle` (rad) of the table.
    pub(super) fn new(config: &TurntableConfig, angle: f64, sample_period_s: f64) -> Self {
        let (wobble_sine, wobble_cosine) = arcsec_to_rad(config.axis.wobble_arcsec).sin_cos();
        let mut mounting = config.mounting.clone();
        if let Some(campaign) = config.motion.campaign() {
            let first = campaign.axes.first().copied();
            mounting.axis_along_table = first.unwrap_or(mounting.axis_along_table);
        }
        let (case, input) = case_axes(&mounting);
        let nowhere = [0.0; 3];
        let mut platform = Self {
            earth: earth_in_table_frame(&config.site, &config.axis),
            wobble_sine,
            wobble_cosine,
            harmonic: f64::from(config.axis.wobble_harmonic),
            case,
            input,
            mounting,
            sample_period_s,
            now: Attitude {
                angle,
                spin: nowhere,
                spin_slope: nowhere,
                earth: nowhere,
                earth_slope: nowhere,
            },
        };
        platform.now = platform.attitude(angle);
        platform
    }

    /// Mounts the case anew, another of its axes along the normal and the misalignment as before.
    pub(super) fn mount(&mut self, axis: CaseAxis) {
        self.mounting.axis_along_table = axis;
        (self.case, self.input) = case_axes(&self.mounting);
    }

    /// The attitude at a table angle, rad.
    fn attitude(&self, angle: f64) -> Attitude {
        let k = self.harmonic;
        let (turned_sine, turned_cosine) = (k * angle).sin_cos();
        let (psi_sine, psi_cosine) = ((1.0 - k) * angle).sin_cos();
        let leaning = k * self.wobble_sine;
        let spin = [
            -leaning * psi_cosine,
            leaning * psi_sine,
            1.0 - k * (1.0 - self.wobble_cosine),
        ];
        let spin_slope = [
            (1.0 - k) * leaning * psi_sine,
            (1.0 - k) * leaning * psi_cosine,
            0.0,
        ];
        // The three rotations undone one after the other.
        let [x, y, z] = self.earth;
        let (x, y) = (
            turned_cosine * x + turned_sine * y,
            turned_cosine * y - turned_sine * x,
        );
        let (x, z) = (
            self.wobble_cosine * x - self.wobble_sine * z,
            self.wobble_sine * x + self.wobble_cosine * z,
        );
        let earth = [
            psi_cosine * x + psi_sine * y,
            psi_cosine * y - psi_sine * x,
            z,
        ];
        Attitude {
            angle,
            spin,
            spin_slope,
            earth,
            // A direction that stands still turns backwards as seen from the platform.
            earth_slope: cross(earth, spin),
        }
    }

    /// Attitudes at the start and the end of a segment that ends at `end_angle`, rad.
    fn advance(&mut self, end_angle: f64) -> (Attitude, Attitude) {
        let start = self.now;
        // A table at rest costs no trigonometry.
        if end_angle.to_bits() != start.angle.to_bits() {
            self.now = self.attitude(end_angle);
        }
        (start, self.now)
    }

    /// Motion of one platform axis over a segment of table motion.
    fn segment(&self, axis: Vector, ends: &[Attitude; 2], table: &MotionSegment) -> MotionSegment {
        let [c0, c1, c2, c3] = table.rate_rad_per_s;
        let period = self.sample_period_s;
        let (start, start_slope) = ends[0].sensed(axis, c0, c1, period);
        let (end, end_slope) =
            ends[1].sensed(axis, table.rate_at(1.0), c1 + 2.0 * c2 + 3.0 * c3, period);
        MotionSegment::hermite(start, start_slope, end, end_slope)
    }

    /// Motion of the input axis while the table moves by `table` to `end_angle`, rad.
    pub(super) fn input_segment(&mut self, table: &MotionSegment, end_angle: f64) -> MotionSegment {
        let (start, end) = self.advance(end_angle);
        self.segment(self.case[self.input], &[start, end], table)
    }

    /// Motion of the case axes x, y, z while the table moves by `table` to `end_angle`, rad.
    pub(super) fn case_segments(
        &mut self,
        table: &MotionSegment,
        end_angle: f64,
    ) -> [MotionSegment; 3] {
        let (start, end) = self.advance(end_angle);
        self.case
            .map(|axis| self.segment(axis, &[start, end], table))
    }
}

/// Case axes x, y, z in the platform, and the index of the one along the normal.
///
/// With the misalignment `mu` towards azimuth `alpha` the case is turned by
/// `Rz(alpha) Ry(mu) Rz(-alpha)`, the least rotation that takes the normal to its place.
fn case_axes(mounting: &MountingConfig) -> ([Vector; 3], usize) {
    let (sine, cosine) = arcsec_to_rad(mounting.misalignment_arcsec).sin_cos();
    let (azimuth_sine, azimuth_cosine) = deg_to_rad(mounting.misalignment_azimuth_deg).sin_cos();
    let bend = 1.0 - cosine;
    let mark = [
        1.0 - bend * azimuth_cosine * azimuth_cosine,
        -bend * azimuth_cosine * azimuth_sine,
        -sine * azimuth_cosine,
    ];
    let quarter = [
        -bend * azimuth_cosine * azimuth_sine,
        1.0 - bend * azimuth_sine * azimuth_sine,
        -sine * azimuth_sine,
    ];
    let normal = [sine * azimuth_cosine, sine * azimuth_sine, cosine];
    match mounting.axis_along_table {
        CaseAxis::X => ([normal, mark, quarter], 0),
        CaseAxis::Y => ([quarter, normal, mark], 1),
        CaseAxis::Z => ([mark, quarter, normal], 2),
    }
}
