//! A direct-drive table: its clocks, and the motion it hands on.

use super::controller::{Controller, Setpoint};
use super::plant::{Axis, Plant};
use crate::signal::MotionSegment;
use crate::turntable::encoder::Scale;
use crate::turntable::{DirectDriveServoConfig, EncoderConfig};
use crate::units::us_to_s;

/// Motor, friction, encoder and controller, each on its own clock.
///
/// ```text
///            tick n - latency      tick n = n / f_controller      stamp k + 1
///  ──────────────┬───────────────────────┬──────────────────────────┬──────> t
///        encoder reads the axis   controller demands torque   motion is handed on
/// ```
///
/// The controller's ticks and the gyro's stamps need not be commensurate: the axis is integrated
/// from one event to the next, whatever it is. Demands are held between ticks.
///
/// Motion leaves as the cubic through rate and acceleration at both stamps, which is exact there.
/// Between them the acceleration is continuous (the current loop sees to that) but its slope jumps
/// at ticks. If that slope spreads over `D` within a sample, the cubic errs by at most `D T^2 / 32`
/// (half of it times 1/16, the integral of the Peano kernel of the middle) and the angle it turns
/// by `D T^3 / (36 sqrt(3))`. The controller holds the angle the plant has turned; the sum of the
/// cubics is what gyro and encoder channel turn.
#[derive(Clone, Debug)]
pub(in crate::turntable) struct DirectDrive {
    plant: Plant,
    controller: Controller,
    scale: Scale,
    latency_s: f64,
    controller_rate_hz: f64,
    sample_period_s: f64,
    axis: Axis,
    /// Rate and its slope per sample at the last stamp.
    handed: (f64, f64),
    /// Torque demanded, N m.
    demand: f64,
    /// Newest reading of the encoder, rad.
    reading: f64,
    /// Whether the reading for the next tick has been taken.
    has_reading: bool,
    /// Number of the next tick.
    tick: u64,
    /// Time reached, s.
    now_s: f64,
    /// Number of the sample under way.
    index: u64,
    /// Commanded angle at the start of it, rad.
    commanded_angle: f64,
}

impl DirectDrive {
    /// A drive that has turned at `initial_rate` (rad/s) for ever and passes angle 0 at time 0,
    /// its controller's integral part holding the friction.
    pub(super) fn new(
        config: &DirectDriveServoConfig,
        encoder: &EncoderConfig,
        initial_rate: f64,
        sample_period_s: f64,
    ) -> Self {
        let plant = Plant::new(config);
        let scale = Scale::new(encoder);
        let latency_s = us_to_s(encoder.latency_us);
        let drag = plant.drag(initial_rate);
        let shown = |time_s: f64| scale.reading_rad(initial_rate * (time_s - latency_s));
        let axis = Axis {
            angle: 0.0,
            rate: initial_rate,
            torque: drag,
        };
        let reading_before = shown(-1.0 / config.controller_rate_hz);
        Self {
            controller: Controller::new(config, reading_before, initial_rate, drag),
            reading: shown(0.0),
            handed: (initial_rate, plant.acceleration(&axis) * sample_period_s),
            plant,
            scale,
            latency_s,
            controller_rate_hz: config.controller_rate_hz,
            sample_period_s,
            axis,
            demand: drag,
            has_reading: true,
            tick: 0,
            now_s: 0.0,
            index: 0,
            commanded_angle: 0.0,
        }
    }

    pub(super) fn follow(&mut self, command: &MotionSegment) -> MotionSegment {
        let start_s = count(self.index) * self.sample_period_s;
        let end_s = count(self.index + 1) * self.sample_period_s;
        loop {
            let tick_s = count(self.tick) / self.controller_rate_hz;
            let event_s = if self.has_reading {
                tick_s
            } else {
                (tick_s - self.latency_s).max(self.now_s)
            };
            if event_s > end_s {
                break;
            }
            self.move_to(event_s);
            if self.has_reading {
                let elapsed = ((tick_s - start_s) / self.sample_period_s).clamp(0.0, 1.0);
                let setpoint = self.setpoint(command, elapsed);
                self.demand = self.controller.demand(&setpoint, self.reading);
                self.tick += 1;
            } else {
                self.reading = self.scale.reading_rad(self.axis.angle);
            }
            self.has_reading = !self.has_reading;
        }
        self.move_to(end_s);
        self.index += 1;
        self.commanded_angle += command.angle_at(1.0, self.sample_period_s);
        let (rate, slope) = self.handed;
        let end_slope = self.plant.acceleration(&self.axis) * self.sample_period_s;
        self.handed = (self.axis.rate, end_slope);
        MotionSegment::hermite(rate, slope, self.axis.rate, end_slope)
    }

    fn move_to(&mut self, time_s: f64) {
        if time_s > self.now_s {
            let step_s = time_s - self.now_s;
            self.plant.advance(&mut self.axis, self.demand, step_s);
            self.now_s = time_s;
        }
    }

    /// The command at normalised time `elapsed` of the sample; its angle is the integral of its
    /// rate in closed form.
    fn setpoint(&self, command: &MotionSegment, elapsed: f64) -> Setpoint {
        Setpoint {
            angle: self.commanded_angle + command.angle_at(elapsed, self.sample_period_s),
            rate: command.rate_at(elapsed),
            acceleration: command.slope_at(elapsed) / self.sample_period_s,
        }
    }
}

#[expect(
    clippy::cast_precision_loss,
    reason = "counts of ticks and samples are far below 2^53"
)]
fn count(events: u64) -> f64 {
    events as f64
}
