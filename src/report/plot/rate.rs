//! `rate.svg`: the rate of every channel against time.

use super::drawing::axis::Axis;
use super::drawing::panel::{Legend, Panel, WIDTH};
use super::drawing::picture::{Picture, Point};
use super::drawing::series::{Series, columns, extent, index, real, series, truth_stroke};
use crate::report::record::measured::Measured;
use crate::scenario::{MotionClass, MotionConfig};
use crate::signal::{Rates, RunSignals};
use crate::units::s_to_ms;
use crate::wording::to_digits;

/// Pixel columns of an envelope, all series together: bounds the size of the file.
const ENVELOPE_COLUMNS: usize = 6000;
/// Points of the lines of a panel, all series together.
const LINE_POINTS: usize = 12_000;
/// Opacity of the bands: none may hide another.
const BAND_OPACITY: f64 = 0.5;
/// Means drawn over a long record.
const MEANS: usize = 200;
/// Time before and after a step that its window shows, s.
const STEP_WINDOW_S: (f64, f64) = (0.01, 0.03);
/// Cycles that the window of a swing shows.
const SWING_CYCLES: f64 = 2.0;

/// Every channel over the measured record, and below it what the whole record hides: a window of a
/// swing or of the largest step, or means.
pub(in crate::report) fn picture(report: &Measured, signals: &RunSignals) -> Option<Picture> {
    let channels = series(report, signals);
    let (_, raw) = signals.channels.first()?;
    let samples = raw.len().checked_sub(signals.first_measured)?;
    if samples < 2 {
        return None;
    }
    // Empty where nobody knows it.
    let truth = signals.truth_deg_per_h.from(signals.first_measured);
    let drawing = Drawing {
        channels,
        truth,
        samples,
        period_s: signals.sample_period_s,
        start_s: real(signals.first_measured + 1) * signals.sample_period_s,
    };
    let mut picture = Picture::new(WIDTH, 860.0);
    let title = format!("{}: rate against time", report.name);
    picture.heading((90.0, 28.0), &title, 18.0);
    let mut legend = Legend::new(56.0);
    drawing.envelope(&mut picture, (56.0, 400.0), &mut legend);
    let mut legend = Legend::below(&legend, 476.0);
    let lower = (476.0, 800.0);
    match window(&report.motion, truth, samples, signals.sample_period_s) {
        Some((range, name)) => drawing.window(&mut picture, lower, range, (&mut legend, &name)),
        None => drawing.means(&mut picture, lower, &mut legend),
    }
    Some(picture)
}

/// Samples of the readable window of a motion, with its name; none where means say more.
fn window(
    motion: &MotionConfig,
    truth: Rates,
    samples: usize,
    period_s: f64,
) -> Option<(std::ops::Range<usize>, String)> {
    match motion.class() {
        MotionClass::Swing { frequency_hz, .. } => {
            let length = index(SWING_CYCLES / (frequency_hz * period_s)).clamp(2, samples);
            let name = format!("first {SWING_CYCLES} cycles of the measured part");
            Some((0..length, name))
        }
        MotionClass::MultiSine { frequencies_hz } => {
            let lowest_hz = frequencies_hz.first()?;
            let length = index(1.0 / (lowest_hz * period_s)).clamp(2, samples);
            let name = "first cycle of the lowest sine".to_owned();
            Some((0..length, name))
        }
        MotionClass::Steps(_) => {
            let truth = truth.words();
            let step = (1_usize..truth.len())
                .max_by(|a, b| {
                    let rise = |at: usize| (truth[at] - truth[at - 1]).abs();
                    rise(*a).total_cmp(&rise(*b)).then(b.cmp(a))
                })
                .filter(|at| (truth[*at] - truth[*at - 1]).abs() > 0.0)?;
            let start = step.saturating_sub(index(STEP_WINDOW_S.0 / period_s));
            let end = (step + index(STEP_WINDOW_S.1 / period_s)).min(truth.len());
            (end > start + 1).then(|| (start..end, "around the largest step".to_owned()))
        }
        // Their motion shows in the envelope and in the means.
        MotionClass::General | MotionClass::Campaign(_) => None,
        MotionClass::Rest | MotionClass::Rotation => None,
    }
}

struct Drawing<'a> {
    channels: Vec<Series<'a>>,
    truth: Rates<'a>,
    samples: usize,
    period_s: f64,
    start_s: f64,
}

impl Drawing<'_> {
    fn time_s(&self, index: f64) -> f64 {
        self.start_s + index * self.period_s
    }

    fn end_s(&self) -> f64 {
        self.time_s(real(self.samples))
    }

    /// Smallest to largest value per pixel column, channels over one another.
    fn envelope(&self, picture: &mut Picture, frame: (f64, f64), legend: &mut Legend) {
        let share = (ENVELOPE_COLUMNS / (self.channels.len() + 1)).min(790);
        let truth = columns(self.truth, share);
        let cut: Vec<_> = self
            .channels
            .iter()
            .map(|channel| (columns(channel.samples, share), channel.stroke))
            .collect();
        let ends = cut.iter().flat_map(|(columns, _)| columns).chain(&truth);
        let Some(y) = extent(ends.flat_map(|column| [column.low, column.high])) else {
            return;
        };
        let x = Axis::linear((self.start_s, self.end_s()), 0.0, "time [s]");
        let y = Axis::linear(y, 0.05, "rate [deg/h]");
        let panel = Panel::new(picture, frame, x, y);
        for (columns, stroke) in &cut {
            let band: Vec<(f64, f64, f64)> = columns
                .iter()
                .filter(|column| column.low.is_finite() && column.high.is_finite())
                .map(|column| (self.time_s(column.index), column.low, column.high))
                .collect();
            panel.band(picture, &band, stroke.colour, BAND_OPACITY);
        }
        for channel in &self.channels {
            match channel.failure() {
                None => legend.area(picture, (channel.stroke.colour, BAND_OPACITY), channel.name),
                Some(failure) => legend.text(picture, &format!("{}: {failure}", channel.name)),
            }
        }
        let line: Vec<(f64, f64)> = truth
            .iter()
            .flat_map(|column| {
                let time = self.time_s(column.index);
                [(time, column.low), (time, column.high)]
            })
            .collect();
        let is_quiet = !truth.is_empty()
            && truth
                .iter()
                .all(|column| column.high - column.low < 0.2 * panel_span(&truth));
        if is_quiet {
            panel.line(picture, &line, truth_stroke());
            legend.line(picture, truth_stroke(), "true rate");
        }
        legend.space();
        let step_s = self.period_s * real(self.samples.div_ceil(share));
        legend.text(picture, "above: smallest to largest value");
        let each = format!("in each {} s", crate::gate::plain(to_digits(step_s, 2)));
        legend.text(picture, &each);
    }

    /// Means over equal parts of the record: what the noise hides above.
    fn means(&self, picture: &mut Picture, frame: (f64, f64), legend: &mut Legend) {
        let line_of = |values: Rates| -> Vec<(f64, f64)> {
            columns(values, MEANS)
                .iter()
                .filter(|column| column.mean.is_finite())
                .map(|column| (self.time_s(column.index), column.mean))
                .collect()
        };
        let x = Axis::linear((self.start_s, self.end_s()), 0.0, "time [s]");
        self.lines(picture, frame, (x, legend), &line_of);
        let step_s = self.period_s * real(self.samples.div_ceil(MEANS));
        let each = format!(
            "below: means over {} s",
            crate::gate::plain(to_digits(step_s, 2))
        );
        legend.text(picture, &each);
    }

    /// The samples of a window.
    fn window(
        &self,
        picture: &mut Picture,
        frame: (f64, f64),
        range: std::ops::Range<usize>,
        (legend, name): (&mut Legend, &str),
    ) {
        let stride = (range.len() * (self.channels.len() + 1))
            .div_ceil(LINE_POINTS)
            .max(1);
        let time_ms = |index: usize| s_to_ms(real(index - range.start) * self.period_s);
        let line_of = |values: Rates| -> Vec<(f64, f64)> {
            range
                .clone()
                .step_by(stride)
                .filter_map(|index| Some((time_ms(index), values.get(index)?)))
                .filter(|(_, value)| value.is_finite())
                .collect()
        };
        let start = format!("time after {:.4} s [ms]", self.time_s(real(range.start)));
        let x = Axis::linear((0.0, time_ms(range.end - 1)), 0.0, &start);
        self.lines(picture, frame, (x, legend), &line_of);
        legend.text(picture, "below: samples");
        legend.text(picture, name);
    }

    fn lines(
        &self,
        picture: &mut Picture,
        frame: (f64, f64),
        (x, legend): (Axis, &mut Legend),
        line_of: &dyn Fn(Rates) -> Vec<Point>,
    ) {
        let truth = line_of(self.truth);
        let lines: Vec<_> = self
            .channels
            .iter()
            .map(|channel| (line_of(channel.samples.into()), channel.stroke))
            .collect();
        let points = lines.iter().flat_map(|(line, _)| line).chain(&truth);
        let Some(y) = extent(points.map(|(_, rate)| *rate)) else {
            return;
        };
        let panel = Panel::new(picture, frame, x, Axis::linear(y, 0.05, "rate [deg/h]"));
        for ((line, stroke), channel) in lines.iter().zip(&self.channels) {
            panel.line(picture, line, *stroke);
            if line.len() > 1 {
                legend.line(picture, *stroke, channel.name);
            }
        }
        if truth.len() > 1 {
            panel.line(picture, &truth, truth_stroke());
            legend.line(picture, truth_stroke(), "true rate");
        }
        legend.space();
    }
}

/// Range of a cut record.
fn panel_span(columns: &[super::drawing::series::Column]) -> f64 {
    extent(columns.iter().flat_map(|column| [column.low, column.high]))
        .map_or(0.0, |(low, high)| (high - low).max(f64::MIN_POSITIVE))
}
