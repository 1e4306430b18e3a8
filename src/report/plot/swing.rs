//! `swing.svg`: the channels over one another, and their delays made visible.

use super::drawing::axis::Axis;
use super::drawing::panel::{Legend, Panel, WIDTH};
use super::drawing::picture::{Dash, GREY, Picture, Stroke};
use super::drawing::series::{Series, extent, index, real, series, truth_stroke};
use crate::gate::estimate_text;
use crate::metrics::Estimate;
use crate::metrics::MetricKey;
use crate::metrics::catalogue::{DELAY_VS_RAW, DELAY_VS_TRUTH};
use crate::report::record::measured::Measured;
use crate::signal::RunSignals;
use crate::units::s_to_ms;

/// Points of each averaged line.
const POINTS: usize = 241;
/// Points of each line of the overlay.
const OVERLAY_POINTS: usize = 700;
/// Cycles averaged at most.
const CYCLES_MAX: usize = 2000;
/// Shortest half width of the zoom, ms.
const HALF_WIDTH_MS: f64 = 0.8;

/// Two cycles as sampled; below them the mean of all cycles around the rising zero crossing of the
/// true rate, with the measured delays marked.
pub(in crate::report) fn picture(
    measured: &Measured,
    signals: &RunSignals,
    frequency_hz: f64,
) -> Option<Picture> {
    let truth = &signals.truth_deg_per_h.from(signals.first_measured).words();
    let channels = series(measured, signals);
    let fold = Fold::new(truth, signals.sample_period_s, frequency_hz)?;
    let mut picture = Picture::new(WIDTH, 900.0);
    let title = format!(
        "{}: swing at {} Hz",
        measured.name,
        crate::gate::plain(frequency_hz)
    );
    picture.heading((90.0, 28.0), &title, 18.0);
    let mut legend = Legend::new(56.0);
    for channel in &channels {
        legend.line(&mut picture, channel.stroke, channel.name);
        if let Some(failure) = channel.failure() {
            legend.detail(&mut picture, &failure);
        }
        for (key, words) in [
            (&DELAY_VS_TRUTH, "ms behind truth"),
            (&DELAY_VS_RAW, "ms behind raw"),
        ] {
            if let Some(estimate) = delay(channel, key) {
                let text = format!("{} {words}", estimate_text(&estimate, 2));
                legend.detail(&mut picture, &text);
            }
        }
    }
    legend.line(&mut picture, truth_stroke(), "true rate");
    overlay(&mut picture, &fold, truth, &channels);
    zoom(&mut picture, &fold, truth, &channels);
    let mut legend = Legend::new(426.0);
    let average = format!("below: mean of {} cycles around the", fold.cycles);
    legend.text(&mut picture, &average);
    legend.text(&mut picture, "rising zero crossing of the true rate;");
    legend.text(&mut picture, "arrows: fitted delays of the table");
    Some(picture)
}

fn delay(channel: &Series, key: &MetricKey) -> Option<Estimate> {
    Some(channel.metrics?.get(key)?.estimate)
}

/// Where the cycles of a record begin.
struct Fold {
    period_s: f64,
    /// Samples per cycle.
    cycle: f64,
    /// First rising zero crossing used, in samples.
    first: f64,
    cycles: usize,
    margin: f64,
}

impl Fold {
    /// Finds the first rising crossing of the truth through its mean, a quarter cycle inside.
    fn new(truth: &[f64], period_s: f64, frequency_hz: f64) -> Option<Self> {
        let cycle = 1.0 / (frequency_hz * period_s);
        let whole = index((real(truth.len()) / cycle).floor() * cycle);
        if whole < 8 || cycle < 8.0 {
            return None;
        }
        let mean = truth[..whole].iter().sum::<f64>() / real(whole);
        let margin = 0.25 * cycle;
        let start = index(margin.ceil());
        let crossing =
            (start..truth.len() - 1).find(|at| truth[*at] < mean && truth[*at + 1] >= mean)?;
        let (before, after) = (truth[crossing], truth[crossing + 1]);
        let first = real(crossing) + (mean - before) / (after - before);
        let room = real(truth.len() - 1) - margin - first;
        if room < 0.0 {
            return None;
        }
        Some(Self {
            period_s,
            cycle,
            first,
            cycles: (index(room / cycle) + 1).min(CYCLES_MAX),
            margin,
        })
    }

    /// Mean over the cycles at `offset` samples from the crossing, by linear interpolation.
    fn mean_at(&self, values: &[f64], offset: f64) -> f64 {
        let sum: f64 = (0..self.cycles)
            .map(|cycle| {
                let position = self.first + real(cycle) * self.cycle + offset;
                let at = index(position).min(values.len() - 2);
                let part = position - real(at);
                values[at] * (1.0 - part) + values[at + 1] * part
            })
            .sum();
        sum / real(self.cycles)
    }

    /// Mean over whole cycles.
    fn level(&self, values: &[f64]) -> f64 {
        let whole = index((real(values.len()) / self.cycle).floor() * self.cycle);
        values[..whole].iter().sum::<f64>() / real(whole)
    }
}

/// Two cycles from the first crossing, as sampled.
fn overlay(picture: &mut Picture, fold: &Fold, truth: &[f64], channels: &[Series]) {
    let start = index(fold.first);
    let end = (start + index(2.0 * fold.cycle)).min(truth.len());
    let stride = (end - start).div_ceil(OVERLAY_POINTS).max(1);
    let line_of = |values: &[f64]| -> Vec<(f64, f64)> {
        (start..end)
            .step_by(stride)
            .filter_map(|at| Some((at, *values.get(at)?)))
            .map(|(at, value)| (s_to_ms((real(at) - fold.first) * fold.period_s), value))
            .collect()
    };
    let lines: Vec<_> = channels
        .iter()
        .map(|channel| (line_of(channel.samples), channel.stroke))
        .chain([(line_of(truth), truth_stroke())])
        .collect();
    let points = || lines.iter().flat_map(|(line, _)| line);
    let (Some(x), Some(y)) = (
        extent(points().map(|(time, _)| *time)),
        extent(points().map(|(_, rate)| *rate)),
    ) else {
        return;
    };
    let x = Axis::linear(
        x,
        0.0,
        "time after a rising zero crossing of the true rate [ms]",
    );
    let panel = Panel::new(
        picture,
        (56.0, 350.0),
        x,
        Axis::linear(y, 0.05, "rate [deg/h]"),
    );
    for (line, stroke) in &lines {
        panel.line(picture, line, *stroke);
    }
}

/// The crossing itself, averaged over cycles, with arrows from raw to each channel.
fn zoom(picture: &mut Picture, fold: &Fold, truth: &[f64], channels: &[Series]) {
    let drawn = || {
        channels
            .iter()
            .filter(|channel| channel.samples.len() >= truth.len())
    };
    let longest = drawn()
        .filter_map(|channel| delay(channel, &DELAY_VS_TRUTH))
        .map(|estimate| estimate.value.abs())
        .fold(0.0, f64::max);
    // Not beyond the margin that every cycle has on both sides.
    let most_ms = s_to_ms(fold.margin * fold.period_s);
    let high_ms = (2.2 * longest).max(HALF_WIDTH_MS).min(most_ms);
    let low_ms = -(0.8 * longest).max(HALF_WIDTH_MS).min(most_ms);
    let line_of = |values: &[f64]| -> Vec<(f64, f64)> {
        let level = fold.level(values);
        (0..POINTS)
            .map(|at| {
                let part = real(at) / real(POINTS - 1);
                let offset_ms = low_ms + part * (high_ms - low_ms);
                let offset = offset_ms / s_to_ms(fold.period_s);
                (offset_ms, fold.mean_at(values, offset) - level)
            })
            .collect()
    };
    let lines: Vec<_> = drawn()
        .map(|channel| (line_of(channel.samples), channel.stroke))
        .chain([(line_of(truth), truth_stroke())])
        .collect();
    let Some(y) = extent(
        lines
            .iter()
            .flat_map(|(line, _)| line)
            .map(|(_, rate)| *rate),
    ) else {
        return;
    };
    let x_title = "time after the rising zero crossing of the true rate [ms]";
    let x = Axis::linear((low_ms, high_ms), 0.0, x_title);
    let y = Axis::linear(y, 0.03, "rate minus its mean [deg/h]");
    let (low, high) = y.range();
    let panel = Panel::new(picture, (426.0, 840.0), x, y);
    let helper = Stroke::solid(GREY, 1.0);
    panel.line(picture, &[(low_ms, 0.0), (high_ms, 0.0)], helper);
    for (line, stroke) in &lines {
        panel.line(picture, line, *stroke);
    }
    let channels: Vec<_> = drawn().collect();
    arrows(picture, &panel, &channels, (low, high));
}

/// From the raw crossing to the crossing of each channel, and from the truth to raw, one below the
/// other where the rising lines leave room.
fn arrows(picture: &mut Picture, panel: &Panel, channels: &[&Series], (low, high): (f64, f64)) {
    let raw_ms = channels
        .iter()
        .find(|channel| channel.is_raw)
        .and_then(|channel| delay(channel, &DELAY_VS_TRUTH))
        .map_or(0.0, |estimate| estimate.value);
    let mut row = 0.0_f64;
    for channel in channels {
        let Some(to_truth) = delay(channel, &DELAY_VS_TRUTH) else {
            continue;
        };
        let end_ms = to_truth.value;
        let (start_ms, delay_ms, from) = match delay(channel, &DELAY_VS_RAW) {
            Some(to_raw) if !channel.is_raw => (raw_ms, to_raw.value, "raw"),
            _ => (0.0, end_ms, "truth"),
        };
        row += 1.0;
        let y = low * (0.34 + 0.11 * row).min(0.95);
        let thin = Stroke {
            dash: Dash::Dotted,
            ..Stroke::solid(channel.stroke.colour, 1.0)
        };
        for x in [start_ms, end_ms] {
            panel.line(picture, &[(x, 0.0), (x, y)], thin);
        }
        let bar = Stroke::solid(channel.stroke.colour, 2.5);
        panel.line(picture, &[(start_ms, y), (end_ms, y)], bar);
        let tip = 0.012 * (high - low);
        for x in [start_ms, end_ms] {
            panel.line(picture, &[(x, y - tip), (x, y + tip)], bar);
        }
        let (x, y) = panel.place((start_ms.max(end_ms), y));
        let text = format!("{}: {delay_ms:.3} ms behind {from}", channel.name);
        picture.coloured_text((x + 8.0, y), &text, 13.0, channel.stroke.colour);
    }
}
