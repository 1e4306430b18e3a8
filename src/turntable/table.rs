//! The table: command, servo, platform and Earth rate joined.

use super::axis::fixed_earth_rate;
use super::encoder::Encoder;
use super::motion::{Command, remountings};
use super::platform::Platform;
use super::servo::Servo;
use crate::signal::MotionSegment;
use crate::turntable::TurntableConfig;
use crate::units::deg_to_rad;
use crate::vocabulary::CaseAxis;

/// A rate table that carries one gyro, or the case of a three-axis assembly.
///
/// Delivers truth: the inertial rate of axes fixed in the platform after the servo, table motion
/// and the Earth's rotation as the pointing of axis and mounting make them. Nothing it does depends
/// on anything but its configuration.
#[derive(Clone, Debug)]
pub struct Turntable {
    command: Command,
    servo: Servo,
    encoder: Option<Encoder>,
    angle: TableAngle,
    platform: Platform,
    /// Samples of a campaign's new mountings and the case axis along the table from there, in order.
    remountings: Vec<(u64, CaseAxis)>,
    /// Index of the next sample.
    index: u64,
    /// Rate of the Earth on an input axis that stays along the table axis, rad/s.
    fixed_earth_rate: Option<f64>,
}

impl Turntable {
    /// A table at the start of the warm-up, settled on the first rate it is told to hold.
    ///
    /// * `warm_up_s`: s, >= 0; soft starts lie inside it and are shortened to it.
    /// * `sample_period_s`: s, > 0; one segment is delivered per sample.
    ///
    /// # Panics
    /// If a swing or a sweep has not exactly one amplitude, several sines neither one amplitude nor
    /// one for each, a staircase no rate, or a script not either rates or angles; the scenario
    /// reader refuses all of these.
    #[must_use]
    pub fn new(config: &TurntableConfig, warm_up_s: f64, sample_period_s: f64) -> Self {
        let course = config.motion.kind().course(warm_up_s, sample_period_s);
        let command = Command::new(course);
        let initial_rate = command.initial_rate();
        let start_angle = deg_to_rad(config.mounting.start_angle_deg);
        Self {
            servo: Servo::new(
                &config.servo,
                &config.encoder,
                initial_rate,
                sample_period_s,
            ),
            encoder: Encoder::new(&config.encoder, initial_rate, sample_period_s),
            command,
            angle: TableAngle::new(start_angle, sample_period_s),
            platform: Platform::new(config, start_angle, sample_period_s),
            remountings: config.motion.campaign().map_or_else(Vec::new, |campaign| {
                remountings(campaign, warm_up_s, sample_period_s)
            }),
            index: 0,
            fixed_earth_rate: fixed_earth_rate(config),
        }
    }

    /// Motion of the input axis over the next output sample, rad/s; the rate at its end is truth at
    /// that stamp.
    ///
    /// The first call covers the time from 0 to T. Cubics join with equal rate and slope, except at
    /// the steps of a staircase on an ideal table. Against the exact sine of angular frequency `w`
    /// an ideal table errs by nothing at the stamps and by at most `(w T)^4 / 384` of the amplitude
    /// between them (2e-10 at 10 Hz and 4 kHz); a servo has its amplitude low by that much at most.
    pub fn next_segment(&mut self) -> MotionSegment {
        let mut motion = self.turn();
        match self.fixed_earth_rate {
            Some(rate) => {
                motion.rate_rad_per_s[0] += rate;
                motion
            }
            None => self.platform.input_segment(&motion, self.angle.rad()),
        }
    }

    /// Motion of the case axes x, y and z of an assembly over the next output sample, rad/s; the
    /// rates at its end are truth at that stamp.
    ///
    /// The case axis named by `turntable.mounting.axis_along_table` moves as the input axis of
    /// [`Turntable::next_segment`], misalignment included, up to rounding. The next two of the cycle
    /// x, y, z, x complete it to a right-handed triad: without misalignment the first points along
    /// the mark of the platform, which is the zero of the table angle, the second a quarter turn, in
    /// the positive sense of rotation, from it. A campaign names the axis of each group in its stead;
    /// how the case is carried from one mounting to the next is not simulated. Both functions advance the table by one sample: a
    /// table is asked by one of them only.
    pub fn next_platform_segments(&mut self) -> [MotionSegment; 3] {
        while let Some((_, axis)) = self.remountings.first().filter(|(at, _)| *at <= self.index) {
            self.platform.mount(*axis);
            self.remountings.remove(0);
        }
        let motion = self.turn();
        self.platform.case_segments(&motion, self.angle.rad())
    }

    /// Table angle at the end of the last segment, rad, whole turns included: the start angle plus
    /// the integral of every segment of table motion.
    #[must_use]
    pub fn angle_rad(&self) -> f64 {
        self.angle.rad()
    }

    /// Motion of the table about its own axis over the next sample.
    fn turn(&mut self) -> MotionSegment {
        self.index += 1;
        let motion = self.servo.follow(self.command.next_segment());
        self.angle.add(&motion);
        if let Some(encoder) = &mut self.encoder {
            encoder.advance(&motion);
        }
        motion
    }

    /// What the encoder shows at the stamp of the last sample, rad; none without an encoder.
    #[must_use]
    pub fn encoder_rad(&self) -> Option<f64> {
        self.encoder.as_ref().map(Encoder::reading_rad)
    }
}

/// The table angle as a sum with its rounding carried along (Neumaier), so that hours of rotation
/// lose nothing.
#[derive(Clone, Copy, Debug)]
struct TableAngle {
    sum: f64,
    carry: f64,
    sample_period_s: f64,
}

impl TableAngle {
    fn new(start_rad: f64, sample_period_s: f64) -> Self {
        Self {
            sum: start_rad,
            carry: 0.0,
            sample_period_s,
        }
    }

    fn rad(&self) -> f64 {
        self.sum + self.carry
    }

    fn add(&mut self, motion: &MotionSegment) {
        let [c0, c1, c2, c3] = motion.rate_rad_per_s;
        let step = self.sample_period_s * (c0 + c1 / 2.0 + c2 / 3.0 + c3 / 4.0);
        let sum = self.sum + step;
        self.carry += if self.sum.abs() >= step.abs() {
            (self.sum - sum) + step
        } else {
            (step - sum) + self.sum
        };
        self.sum = sum;
    }
}
