//! Checks across the values of scale factor tests, trapezoids, chirps and scripts.

use crate::scenario::check::cross::{Checks, SAMPLES_PER_CYCLE_MIN, TIME_SLACK};
use crate::scenario::config::FilterState;
use crate::turntable::{
    ChirpConfig, ScaleFactorTestConfig, ScriptPoints, SwingConfig, TrapezoidConfig,
};
use crate::turntable::{Stairs, TEST_RATES_MIN};
use crate::wording::number;

impl Checks<'_> {
    /// Refuses ramps of a few samples and trapezoids that the record cuts off.
    pub(in crate::scenario) fn trapezoid(&mut self, trapezoid: &TrapezoidConfig) {
        let duration_s = self.resolved.scenario.duration_s;
        let period_s = self.sample_period_s();
        let rate = trapezoid.rate_deg_per_s.abs();
        let acceleration = trapezoid.acceleration_deg_per_s2;
        if rate <= 0.0 {
            let message = "turntable.trapezoid.rate_deg_per_s = 0.0 deg/s is no motion: allowed \
                           [-2000, 2000] deg/s without 0; use [turntable.static]";
            self.complain("turntable.trapezoid.rate_deg_per_s", message.to_owned());
            return;
        }
        let acceleration_max = rate / (SAMPLES_PER_CYCLE_MIN * period_s);
        if acceleration > acceleration_max {
            let message = format!(
                "turntable.trapezoid.acceleration_deg_per_s2 = {acceleration:?} deg/s^2 is too \
                 steep: allowed up to {acceleration_max:.6} deg/s^2, 8 output samples to reach \
                 {rate:?} deg/s"
            );
            self.complain("turntable.trapezoid.acceleration_deg_per_s2", message);
        }
        let needed_s = trapezoid.length_s();
        if needed_s > duration_s * (1.0 + TIME_SLACK) {
            let message = format!(
                "turntable.trapezoid.cycles = {}: the motion takes {} s, but duration_s = \
                 {duration_s:?} s",
                trapezoid.cycles,
                number(needed_s)
            );
            let path = "turntable.trapezoid.cycles";
            let is_written = self.resolved.is_written(path);
            self.complain(if is_written { path } else { "duration_s" }, message);
        }
    }

    /// Refuses to reset filters where twins would go on.
    pub(in crate::scenario) fn filter_state(&mut self) {
        let scenario = &self.resolved.scenario;
        if scenario.trial.filter_state == FilterState::Carried {
            return;
        }
        let key = "trial.filter_state";
        if scenario.trial.rate_gain {
            let message = format!(
                "{key} = \"reset\" contradicts trial.rate_gain = true, which measures filters \
                 that go on through the record"
            );
            self.complain(key, message);
        }
    }

    /// Refuses a scale factor test of too few rates and one that the record cuts off.
    pub(in crate::scenario) fn scale_factor_test(&mut self, test: &ScaleFactorTestConfig) {
        let key = |name: &str| format!("turntable.scale_factor_test.{name}");
        let count = test.rates_deg_per_s().len();
        if count < TEST_RATES_MIN {
            let message = format!(
                "{} = {:?} deg/s leaves {count} rates of each sense up to {:?} deg/s: a scale \
                 factor test needs {TEST_RATES_MIN}; begin lower, take another series, or use \
                 [turntable.steps]",
                key("from_deg_per_s"),
                test.from_deg_per_s,
                test.to_deg_per_s
            );
            self.complain(&key("from_deg_per_s"), message);
        }
        if let Some(longest_s) = test.dwell_max_s
            && longest_s < test.dwell_s
        {
            let message = format!(
                "{} = {longest_s:?} s is too short: allowed from dwell_s = {:?} s",
                key("dwell_max_s"),
                test.dwell_s
            );
            self.complain(&key("dwell_max_s"), message);
        }
        let duration_s = self.resolved.scenario.duration_s;
        let needed_s = Stairs::from(test).length_s();
        if needed_s > duration_s * (1.0 + TIME_SLACK) {
            let message = format!(
                "{} = {:?} s is too long: the test of {count} rates of each sense takes \
                 {needed_s:.6} s, but duration_s = {duration_s:?} s",
                key("dwell_s"),
                test.dwell_s
            );
            self.complain(&key("dwell_s"), message);
        }
    }

    /// Refuses a soft start inside the record.
    pub(in crate::scenario) fn swing_from_rest(&mut self, swing: &SwingConfig) {
        if swing.from_rest && swing.soft_start_s > 0.0 {
            let message = format!(
                "turntable.swing.from_rest = true swings from the start of the record, at once: give \
                 turntable.swing.soft_start_s = 0.0 s (is {:?} s)",
                swing.soft_start_s
            );
            self.complain("turntable.swing.from_rest", message);
        }
    }

    /// Refuses frequencies the record cannot hold and a sweep that outlasts it.
    pub(in crate::scenario) fn chirp(&mut self, chirp: &ChirpConfig) {
        self.soft_start("turntable.chirp.soft_start_s", chirp.soft_start_s);
        self.frequency(
            "turntable.chirp.start_frequency_hz",
            chirp.start_frequency_hz,
        );
        self.frequency("turntable.chirp.end_frequency_hz", chirp.end_frequency_hz);
        let duration_s = self.resolved.scenario.duration_s;
        if chirp.sweep_s > duration_s * (1.0 + TIME_SLACK) {
            let message = format!(
                "turntable.chirp.sweep_s = {:?} s is too long: allowed up to duration_s = \
                 {duration_s:?} s",
                chirp.sweep_s
            );
            self.complain("turntable.chirp.sweep_s", message);
        }
    }

    /// Refuses columns of different lengths, times that do not increase, and a script that is too
    /// short or too fine for the record.
    pub(in crate::scenario) fn script(&mut self, points: &ScriptPoints) {
        let times = &points.time_s;
        let path = |index: usize| format!("turntable.script.points.time_s[{index}]");
        for (name, values) in [
            ("rate_deg_per_s", &points.rate_deg_per_s),
            ("angle_deg", &points.angle_deg),
        ] {
            if let Some(values) = values
                && values.len() != times.len()
            {
                let key = format!("turntable.script.points.{name}");
                let message = format!(
                    "{key} has {} values, but there are {} times: give one for each",
                    values.len(),
                    times.len()
                );
                self.complain(&key, message);
            }
        }
        if let Some(first) = times.first()
            && first.abs() > 0.0
        {
            let message = format!(
                "{} = {first:?} s: the first time must be 0.0 s, the start of the record",
                path(0)
            );
            self.complain(&path(0), message);
        }
        let period_s = self.sample_period_s();
        let close = times
            .windows(2)
            .position(|pair| pair[1] - pair[0] < period_s);
        if let Some(before) = close {
            let (earlier, later) = (times[before], times[before + 1]);
            let message = format!(
                "{} = {later:?} s is too early: allowed from {} s, one output sample after the \
                 {earlier:?} s before it",
                path(before + 1),
                number(earlier + period_s)
            );
            self.complain(&path(before + 1), message);
        }
        let duration_s = self.resolved.scenario.duration_s;
        if let Some(last) = times.last()
            && *last < duration_s * (1.0 - TIME_SLACK)
        {
            let index = times.len() - 1;
            let message = format!(
                "{} = {last:?} s ends the script too early: expected at least duration_s = \
                 {duration_s:?} s",
                path(index)
            );
            self.complain(&path(index), message);
        }
    }
}
