//! The state of the optics at an instant, and how it changes with the temperature.

use crate::gyro::error::GyroError;
use crate::gyro::thermal::{Chamber, Network, NetworkState, Propagator, Sensitivities};
use crate::gyro::{GyroConfig, ThermalWarmUp};
use crate::signal::TemperatureRecord;
use crate::units::{k_per_s_to_k_per_min, rad_per_s_to_deg_per_h};

/// Longest time over which a condition is held, s.
///
/// A fortieth of the shortest time constant a network may have: a value taken at the middle of
/// the interval errs by less than `(1 / 40)^2 / 24` = 3e-5 of the change within a time constant.
const INTERVAL_S: f64 = 0.25;
/// Points of a temperature record.
const RECORD_POINTS: u32 = 400;
/// Longest step of the network while a record is made, s.
const RECORD_STEP_S: f64 = 1.0;

/// What temperature makes of the gyro at one instant; neutral at the reference temperature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition {
    /// Temperature of case and electronics, deg C.
    pub case_c: f64,
    /// Mean temperature of the coil, deg C.
    pub coil_c: f64,
    /// Detected power over its nominal value.
    pub power_ratio: f64,
    /// Scale factor of the rate word over its nominal value.
    pub scale_ratio: f64,
    /// Bias, an equivalent input rate, rad/s.
    pub bias_rad_per_s: f64,
    /// Phase applied over phase commanded, minus 1.
    pub modulator_gain_error: f64,
}

impl Condition {
    /// The condition at the start of the simulation.
    #[must_use]
    pub fn at_start(config: &GyroConfig) -> Self {
        Course::new(config).condition()
    }
}

/// The network under way.
#[derive(Clone, Debug)]
struct Course {
    chamber: Chamber,
    network: Network,
    sensitivities: Sensitivities,
    self_heating_c: f64,
    state: NetworkState,
    time_s: f64,
}

impl Course {
    /// In equilibrium with the chamber, the self-heating settled or just begun.
    fn new(config: &GyroConfig) -> Self {
        let thermal = &config.thermal;
        let chamber = Chamber::new(&config.temperature, thermal);
        let rise_c = match thermal.warm_up {
            ThermalWarmUp::Settled => thermal.self_heating_c,
            ThermalWarmUp::Cold => 0.0,
        };
        Self {
            state: NetworkState::uniform(chamber.temperature_c(0.0) + rise_c),
            chamber,
            network: Network::new(thermal),
            sensitivities: Sensitivities::new(config),
            self_heating_c: thermal.self_heating_c,
            time_s: 0.0,
        }
    }

    fn source_c(&self, time_s: f64) -> f64 {
        self.chamber.temperature_c(time_s) + self.self_heating_c
    }

    /// Advances by an interval; the chamber's course within is taken as a straight line.
    fn advance(&mut self, propagator: &Propagator, interval_s: f64) {
        let end_s = self.time_s + interval_s;
        let (start_c, end_c) = (self.source_c(self.time_s), self.source_c(end_s));
        self.state = propagator.advance(&self.state, start_c, end_c);
        self.time_s = end_s;
    }

    fn condition(&self) -> Condition {
        let source_c = self.source_c(self.time_s);
        let slopes = self.network.slopes_c_per_s(&self.state, source_c);
        self.sensitivities.condition(&self.state, &slopes)
    }

    /// Whether nothing ever changes.
    fn is_constant(&self) -> bool {
        let is_settled = self.state.case_c.to_bits() == self.source_c(0.0).to_bits();
        self.chamber.is_constant() && is_settled
    }

    /// Bounds of every temperature of the network: each stage stays between those of its source.
    fn range_c(&self) -> (f64, f64) {
        let (low_c, high_c) = self.chamber.range_c();
        let (low_c, high_c) = (low_c + self.self_heating_c, high_c + self.self_heating_c);
        (low_c.min(self.state.case_c), high_c.max(self.state.case_c))
    }
}

/// Conditions of a run, one per update interval.
#[derive(Clone, Debug)]
pub(in crate::gyro) struct Schedule {
    course: Course,
    interval_s: f64,
    step: Propagator,
    samples_per_update: u32,
    samples_to_update: u32,
}

impl Schedule {
    /// The schedule of a configuration; `None` where the condition never changes.
    pub(in crate::gyro) fn new(config: &GyroConfig, sample_period_s: f64) -> Option<Self> {
        let mut course = Course::new(config);
        if course.is_constant() {
            return None;
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "at least one and at most the interval over a transit time"
        )]
        let samples_per_update = (INTERVAL_S / sample_period_s).floor().max(1.0) as u32;
        let interval_s = f64::from(samples_per_update) * sample_period_s;
        // The condition of an interval is that of its middle.
        let half_s = 0.5 * interval_s;
        course.advance(&course.network.propagator(half_s), half_s);
        Some(Self {
            step: course.network.propagator(interval_s),
            course,
            interval_s,
            samples_per_update,
            samples_to_update: 0,
        })
    }

    /// The condition of the next output sample if it differs from that of the sample before.
    pub(in crate::gyro) fn next_change(&mut self) -> Option<Condition> {
        if self.samples_to_update > 0 {
            self.samples_to_update -= 1;
            return None;
        }
        self.samples_to_update = self.samples_per_update - 1;
        let condition = self.course.condition();
        self.course.advance(&self.step, self.interval_s);
        Some(condition)
    }
}

/// A thermometer on the coil: its mean temperature, one reading an output sample.
#[derive(Clone, Debug)]
pub struct CoilThermometer {
    schedule: Option<Schedule>,
    coil_c: f64,
    rate_k_per_min: f64,
}

impl CoilThermometer {
    /// The thermometer at the start of the simulation.
    #[must_use]
    pub fn new(config: &GyroConfig, sample_period_s: f64) -> Self {
        Self {
            schedule: Schedule::new(config, sample_period_s),
            coil_c: Condition::at_start(config).coil_c,
            rate_k_per_min: 0.0,
        }
    }

    /// The reading of the next output sample, deg C; held for up to 0.25 s, as the conditions are.
    pub fn next_c(&mut self) -> f64 {
        if let Some(schedule) = &mut self.schedule
            && let Some(condition) = schedule.next_change()
        {
            let change_k = condition.coil_c - self.coil_c;
            self.rate_k_per_min = k_per_s_to_k_per_min(change_k / schedule.interval_s);
            self.coil_c = condition.coil_c;
        }
        self.coil_c
    }

    /// How fast the readings change from the one before the last one on, K/min.
    #[must_use]
    pub fn rate_k_per_min(&self) -> f64 {
        self.rate_k_per_min
    }
}

/// Smallest and largest power ratio of a run.
///
/// # Errors
/// [`GyroError::NoPower`] if the power law gives no light at a temperature of the run,
/// [`GyroError::ThermalLawTooSteep`] if another law leaves the small changes it holds for.
pub(in crate::gyro) fn power_range(config: &GyroConfig) -> Result<(f64, f64), GyroError> {
    let course = Course::new(config);
    course.sensitivities.check(course.range_c())?;
    course.sensitivities.power_range(course.range_c())
}

/// Temperatures and predicted bias between two times, s from the start of the simulation.
///
/// `None` where the temperature never changes.
#[must_use]
pub fn temperature_record(
    config: &GyroConfig,
    start_s: f64,
    end_s: f64,
) -> Option<TemperatureRecord> {
    let mut course = Course::new(config);
    if course.is_constant() {
        return None;
    }
    travel(&mut course, start_s);
    let spacing_s = (end_s - start_s) / f64::from(RECORD_POINTS);
    let mut record = TemperatureRecord::default();
    for point in 0..=RECORD_POINTS {
        if point > 0 {
            travel(&mut course, spacing_s);
        }
        let condition = course.condition();
        record.time_s.push(course.time_s);
        let chamber_c = course.chamber.temperature_c(course.time_s);
        record.chamber_c.push(chamber_c);
        record.case_c.push(condition.case_c);
        record.coil_c.push(condition.coil_c);
        let bias_deg_per_h = rad_per_s_to_deg_per_h(condition.bias_rad_per_s);
        record.bias_deg_per_h.push(bias_deg_per_h);
        record.scale_ratio.push(condition.scale_ratio);
    }
    Some(record)
}

/// Mean temperature of the coil at `count` times from `first_s` on, s from the start of the
/// simulation: what a thermometer in the coil shows, deg C.
#[must_use]
pub fn coil_temperatures_c(
    config: &GyroConfig,
    first_s: f64,
    spacing_s: f64,
    count: u32,
) -> Vec<f64> {
    let mut course = Course::new(config);
    if course.is_constant() {
        return (0..count).map(|_| course.state.coil_c()).collect();
    }
    travel(&mut course, first_s);
    let step = course.network.propagator(spacing_s);
    let temperatures = (0..count).map(|_| {
        let shown_c = course.state.coil_c();
        course.advance(&step, spacing_s);
        shown_c
    });
    temperatures.collect()
}

/// Advances a course by a time in equal steps.
fn travel(course: &mut Course, time_s: f64) {
    if time_s <= 0.0 {
        return;
    }
    let steps = (time_s / RECORD_STEP_S).ceil();
    let step_s = time_s / steps;
    let step = course.network.propagator(step_s);
    let mut done = 0.0;
    while done < steps {
        course.advance(&step, step_s);
        done += 1.0;
    }
}
