//! `allan.svg`: the Allan deviation, or another of its family, with intervals, fitted lines and labelled markers.

use super::drawing::axis::Axis;
use super::drawing::panel::{Legend, Panel, WIDTH};
use super::drawing::picture::{Dash, GREY, Picture, Shape, Stroke};
use super::drawing::series::{extent, real, stroke_of};
use crate::gate::estimate_text;
use crate::metrics::ChannelMetrics;
use crate::metrics::Estimate;
use crate::metrics::MetricKey;
use crate::metrics::catalogue::ALLAN;
use crate::metrics::catalogue::ANGLE_RANDOM_WALK;
use crate::metrics::catalogue::{BIAS_INSTABILITY, QUANTISATION, RATE_RAMP, RATE_RANDOM_WALK};
use crate::metrics::catalogue::{CORRELATED_NOISE, CORRELATION_TIME, SINE_AMPLITUDE, SINE_PERIOD};
use crate::metrics::columns::allan as column;
use crate::metrics::{correlated_allan_variance, sine_allan_variance};
use crate::report::record::measured::Measured;
use crate::units::{
    deg_per_h_per_s_to_deg_per_h_per_h, deg_per_h_per_sqrt_h_to_deg_per_h_per_sqrt_s,
    deg_per_sqrt_h_to_deg_per_h_sqrt_s,
};

/// The flicker floor of the Allan deviation over B: `sqrt(2 ln 2 / pi)` (IEEE Std 952-1997, C).
const FLOOR_OVER_B: f64 = 0.664;

/// Steps of the curves of terms that are no straight lines.
const CURVE_STEPS: usize = 400;

/// The estimator that the noise is fitted to.
const OVERLAPPING: &str = "overlapping";

/// A noise term read off its line: the line, and the point at which the standard reads it.
struct Reading {
    shape: Shape,
    /// Exponent of tau along the line.
    slope: f64,
    /// Where the coefficient is read, s; the floor has no such place.
    tau_s: Option<f64>,
    /// The deviation there, deg/h.
    deviation_deg_per_h: f64,
    /// Symbol, value and unit.
    text: String,
}

/// The Allan deviation of every channel that has one.
pub(in crate::report) fn picture(report: &Measured) -> Option<Picture> {
    let tables = || {
        report
            .channels
            .iter()
            .enumerate()
            .filter_map(|(index, (name, metrics))| {
                let curve = metrics.curve(&ALLAN)?;
                let (tau, deviation) = (column::TAU.get(curve)?, column::DEVIATION.get(curve)?);
                let low = column::LOW.get(curve).unwrap_or(deviation);
                let high = column::HIGH.get(curve).unwrap_or(deviation);
                Some((index, name.as_str(), metrics, tau, [deviation, low, high]))
            })
    };
    let positive = |value: &f64| *value > 0.0;
    let tau = tables().flat_map(|(.., tau, _)| tau.iter().copied());
    let read_at = tables().flat_map(|(_, _, metrics, ..)| readings(metrics));
    let estimator = estimator_of(report);
    // The terms are read off the Allan deviation; the lines of the others lie elsewhere.
    let is_read = matches!(estimator, OVERLAPPING | "plain");
    let x = extent(
        tau.chain(read_at.filter_map(|reading| reading.tau_s))
            .filter(positive),
    )?;
    let drawn = tables().flat_map(|(.., curves)| curves.into_iter().flatten().copied());
    let read = tables().flat_map(|(_, _, metrics, ..)| readings(metrics));
    let levels = drawn.chain(read.map(|reading| reading.deviation_deg_per_h));
    let y = extent(levels.filter(positive))?;

    let mut picture = Picture::new(WIDTH, 700.0);
    let quantity = deviation_name(estimator);
    let title = format!("{}: {quantity}", report.name);
    picture.heading((90.0, 28.0), &title, 18.0);
    let x = Axis::log(x, 0.01, "averaging time τ [s]");
    let y = Axis::log(y, 0.04, &format!("{quantity} σ(τ) [deg/h]"));
    let panel = Panel::new(&mut picture, (56.0, 640.0), x, y);
    let mut legend = Legend::new(56.0);
    let opacity = band_opacity(tables().count());
    for (index, name, metrics, tau, [deviation, low, high]) in tables() {
        let stroke = stroke_of(index);
        let band: Vec<(f64, f64, f64)> = (0..tau.len())
            .filter_map(|at| Some((tau[at], *low.get(at)?, *high.get(at)?)))
            .filter(|(_, low, high)| *low > 0.0 && *high > 0.0)
            .collect();
        panel.band(&mut picture, &band, stroke.colour, opacity);
        let line: Vec<(f64, f64)> = tau.iter().copied().zip(deviation.iter().copied()).collect();
        panel.line(&mut picture, &line, stroke);
        let thin = Stroke::solid(stroke.colour, 0.75);
        panel.line(&mut picture, &fit_line(metrics, tau), thin);
        legend.line(&mut picture, stroke, name);
        legend.gain(&mut picture, metrics);
        for reading in readings(metrics) {
            if is_read {
                draw_reading(&mut picture, &panel, &reading, stroke);
                legend.marker(&mut picture, (reading.shape, stroke.colour), &reading.text);
            } else {
                legend.text(&mut picture, &reading.text);
            }
        }
        for (curve, text) in extra_terms(metrics, tau) {
            if is_read {
                panel.line(&mut picture, &curve, mixed(stroke));
            }
            legend.text(&mut picture, &text);
        }
        legend.space();
    }
    notes(&mut legend, &mut picture, report, is_read);
    Some(picture)
}

/// The estimator of the curves.
fn estimator_of<'a>(report: &Measured<'a>) -> &'a str {
    let mut channels = report.channels.iter();
    let estimator = channels.find_map(|(_, metrics)| {
        let words = metrics.words(&ALLAN, &column::ESTIMATOR);
        words.first().copied()
    });
    estimator.unwrap_or(OVERLAPPING)
}

/// A deviation in full.
fn deviation_name(estimator: &str) -> &'static str {
    match estimator {
        "plain" => "Allan deviation",
        "modified" => "modified Allan deviation",
        "hadamard" => "overlapping Hadamard deviation",
        _ => "overlapping Allan deviation",
    }
}

/// The fitted deviation over the range of the fit; below it lies the bandwidth of the channel, which
/// the fit does not know.
fn fit_line(metrics: &ChannelMetrics, tau: &[f64]) -> Vec<(f64, f64)> {
    let walk = metrics.get(&ANGLE_RANDOM_WALK);
    let first_s = walk.and_then(|walk| walk.fields.get("tau_min_s").copied());
    let first_s = first_s.unwrap_or(0.0);
    let fit = metrics
        .curve(&ALLAN)
        .map_or(&[][..], |curve| column::FITTED.of(curve));
    let points = tau.iter().copied().zip(fit.iter().copied());
    points.filter(|(tau, _)| *tau >= first_s).collect()
}

/// Meaning of the marks, each where one is drawn.
const MARKS: [(Shape, &str); 5] = [
    (Shape::Diamond, "diamond: √3 Q/τ (slope -1)"),
    (Shape::Circle, "circle: 60 N at 1 s (slope -1/2)"),
    (Shape::Square, "square: 0.664 B (flat)"),
    (Shape::Triangle, "triangle: K/60 at 3 s (slope 1/2)"),
    (Shape::Wedge, "triangle on its point: R τ/√2 (slope 1)"),
];

/// What the reader of the picture must know, below the legend.
fn notes(legend: &mut Legend, picture: &mut Picture, report: &Measured, is_read: bool) {
    let curves = report.channels.iter();
    let curves = curves.filter(|(_, metrics)| metrics.curve(&ALLAN).is_some());
    let sample = (GREY, 2.0 * band_opacity(curves.count()));
    legend.area(picture, sample, "95 % interval");
    if !is_read {
        legend.text(picture, "N, B, K: fit to the overlapping Allan deviation");
        return;
    }
    legend.line(picture, Stroke::solid(GREY, 0.75), "fit");
    legend.line(picture, dotted(Stroke::solid(GREY, 1.0)), "its terms");
    let channels = || report.channels.iter().map(|(_, metrics)| metrics);
    let drawn: Vec<Reading> = channels().flat_map(readings).collect();
    for (shape, text) in MARKS {
        if drawn.iter().any(|reading| reading.shape == shape) {
            legend.text(picture, text);
        }
    }
    let extra = [&CORRELATED_NOISE, &SINE_AMPLITUDE];
    if channels().any(|metrics| extra.iter().any(|key| metrics.get(key).is_some())) {
        let sample = mixed(Stroke::solid(GREY, 1.0));
        legend.line(picture, sample, "correlated noise, sine");
    }
}

/// The fitted terms of a channel.
fn readings(metrics: &ChannelMetrics) -> Vec<Reading> {
    let read = |key: &MetricKey, symbol: &str, unit: &str| {
        let metric = metrics.get(key)?;
        let text = estimate_text(&metric.estimate, 2);
        let value = metric.estimate.value;
        (value > 0.0).then(|| (value, format!("{symbol} {text} {unit}")))
    };
    let walk = read(&ANGLE_RANDOM_WALK, "N", "deg/sqrt(h)");
    let floor = read(&BIAS_INSTABILITY, "B", "deg/h");
    let rate_walk = read(&RATE_RANDOM_WALK, "K", "deg/h/sqrt(h)");
    let walk = walk.map(|(value, text)| Reading {
        shape: Shape::Circle,
        slope: -0.5,
        tau_s: Some(1.0),
        deviation_deg_per_h: deg_per_sqrt_h_to_deg_per_h_sqrt_s(value),
        text,
    });
    let floor = floor.map(|(value, text)| Reading {
        shape: Shape::Square,
        slope: 0.0,
        tau_s: None,
        deviation_deg_per_h: FLOOR_OVER_B * value,
        text,
    });
    // K sqrt(tau / 3) at tau = 3 s is K in (deg/h)/sqrt(s).
    let rate_walk = rate_walk.map(|(value, text)| Reading {
        shape: Shape::Triangle,
        slope: 0.5,
        tau_s: Some(3.0),
        deviation_deg_per_h: deg_per_h_per_sqrt_h_to_deg_per_h_per_sqrt_s(value),
        text,
    });
    let ramp = read(&RATE_RAMP, "R", "deg/h/h");
    let angle = read(&QUANTISATION, "Q", "arcsec");
    // R tau / sqrt(2) at tau = sqrt(2) s is R in (deg/h)/s; sqrt(3) Q / tau at sqrt(3) s is Q.
    let ramp = ramp.map(|(value, text)| Reading {
        shape: Shape::Wedge,
        slope: 1.0,
        tau_s: Some(2.0_f64.sqrt()),
        deviation_deg_per_h: value / deg_per_h_per_s_to_deg_per_h_per_h(1.0),
        text,
    });
    let angle = angle.map(|(value, text)| Reading {
        shape: Shape::Diamond,
        slope: -1.0,
        tau_s: Some(3.0_f64.sqrt()),
        deviation_deg_per_h: value,
        text,
    });
    let all = [angle, walk, floor, rate_walk, ramp];
    all.into_iter().flatten().collect()
}

/// Terms beyond the five with their curves over the averaging times of the picture.
fn extra_terms(metrics: &ChannelMetrics, tau: &[f64]) -> Vec<(Vec<(f64, f64)>, String)> {
    let (Some(&first), Some(&last)) = (tau.first(), tau.last()) else {
        return Vec::new();
    };
    let time = |step: usize| first * (last / first).powf(step as f64 / CURVE_STEPS as f64);
    let curve = |variance: &dyn Fn(f64) -> f64| -> Vec<(f64, f64)> {
        let points = (0..=CURVE_STEPS).map(|step| (time(step), variance(time(step)).sqrt()));
        points.filter(|(_, deviation)| *deviation > 0.0).collect()
    };
    let pair = |level: &MetricKey, time: &MetricKey| {
        let (level, time) = (metrics.get(level)?.estimate, metrics.get(time)?.estimate);
        Some((level, time))
    };
    let text = |name: &str, level: &Estimate, time: &Estimate| {
        let (level, time) = (estimate_text(level, 2), estimate_text(time, 2));
        format!("{name} {level} deg/h, {time} s")
    };
    let correlated = pair(&CORRELATED_NOISE, &CORRELATION_TIME).map(|(level, time)| {
        let variance =
            |tau: f64| level.value * level.value * correlated_allan_variance(tau, time.value);
        (curve(&variance), text("correlated", &level, &time))
    });
    let sine = pair(&SINE_AMPLITUDE, &SINE_PERIOD).map(|(level, period)| {
        let variance =
            |tau: f64| level.value * level.value * sine_allan_variance(tau, period.value);
        (curve(&variance), text("sine", &level, &period))
    });
    correlated.into_iter().chain(sine).collect()
}

/// The stroke of a term's curve that is no straight line.
fn mixed(stroke: Stroke) -> Stroke {
    Stroke {
        width: 1.0,
        dash: Dash::Mixed,
        opacity: 0.8,
        ..stroke
    }
}

/// The stroke of a term that is a straight line.
fn dotted(stroke: Stroke) -> Stroke {
    Stroke {
        width: 1.0,
        dash: Dash::Dotted,
        opacity: 0.8,
        ..stroke
    }
}

/// Opacity of the bands of so many curves: where all of them coincide, lines are still seen through them.
fn band_opacity(curves: usize) -> f64 {
    (0.7 / real(curves.max(1))).min(0.22)
}

/// The line of a term over the whole frame, and its marker.
fn draw_reading(picture: &mut Picture, panel: &Panel, reading: &Reading, stroke: Stroke) {
    let (low, high) = panel.x_range();
    // The floor has no averaging time of its own: its marker stands where floors are looked for.
    let tau_s = reading
        .tau_s
        .unwrap_or_else(|| high.powf(0.85) * low.powf(0.15));
    let level = |tau: f64| reading.deviation_deg_per_h * (tau / tau_s).powf(reading.slope);
    let line = [(low, level(low)), (high, level(high))];
    panel.line(picture, &line, dotted(stroke));
    let at = (tau_s, reading.deviation_deg_per_h);
    panel.marker(picture, at, reading.shape, stroke.colour);
}
