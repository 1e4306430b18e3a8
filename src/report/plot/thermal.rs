//! `thermal.svg`: the error of the raw channel against the predicted thermal one, over the
//! temperatures.

use super::drawing::axis::Axis;
use super::drawing::panel::{Legend, Panel, WIDTH};
use super::drawing::picture::{Dash, Picture, Stroke};
use super::drawing::series::{columns, extent, index, real, stroke_of, truth_stroke};
use crate::report::RunReport;
use crate::signal::{RunSignals, TemperatureRecord};

/// Means drawn of the error.
const MEANS: usize = 120;

/// Means of raw minus truth with the prediction; below them chamber, case and coil.
pub(in crate::report) fn picture(report: &RunReport, signals: &RunSignals) -> Option<Picture> {
    let record = signals.temperature.as_ref()?;
    let (_, raw) = signals.channels.iter().find(|(name, _)| *name == "raw")?;
    let first = signals.first_measured;
    let (raw, truth) = (raw.get(first..)?, signals.truth_deg_per_h.from(first));
    let error: Vec<f64> = raw
        .iter()
        .zip(truth.iter())
        .map(|(word, rate)| word - rate)
        .collect();
    let time_s = |at: f64| (real(first + 1) + at) * signals.sample_period_s;
    let means: Vec<(f64, f64)> = columns(&error, MEANS)
        .iter()
        .filter(|column| column.mean.is_finite())
        .map(|column| (time_s(column.index), column.mean))
        .collect();
    let predicted = predicted(record, signals);
    let ends = (*record.time_s.first()?, *record.time_s.last()?);
    let x = || Axis::linear(ends, 0.0, "time [s]");

    let mut picture = Picture::new(WIDTH, 860.0);
    let title = format!("{}: rate error and temperature", report.scenario.name);
    picture.heading((90.0, 28.0), &title, 18.0);
    let rates = extent(means.iter().chain(&predicted).map(|(_, rate)| *rate))?;
    let y = Axis::linear(rates, 0.05, "raw - true rate [deg/h]");
    let panel = Panel::new(&mut picture, (56.0, 400.0), x(), y);
    panel.line(&mut picture, &means, stroke_of(0));
    panel.line(&mut picture, &predicted, truth_stroke());
    let mut legend = Legend::new(56.0);
    let each_s = signals.sample_period_s * real(error.len().div_ceil(MEANS));
    legend.line(&mut picture, stroke_of(0), "raw - true rate");
    legend.detail(&mut picture, &format!("means over {each_s:.3} s"));
    legend.line(&mut picture, truth_stroke(), "predicted");
    legend.detail(&mut picture, "bias and scale factor");

    let lines = [
        ("chamber", &record.chamber_c, dashed(1, Dash::Long)),
        ("case", &record.case_c, dashed(2, Dash::Solid)),
        ("coil, mean", &record.coil_c, dashed(3, Dash::Mixed)),
    ];
    let values = lines.iter().flat_map(|(_, values, _)| values.iter());
    let y = Axis::linear(extent(values.copied())?, 0.05, "temperature [C]");
    let panel = Panel::new(&mut picture, (476.0, 800.0), x(), y);
    let mut legend = Legend::new(476.0);
    for (name, values, stroke) in lines {
        let times = record.time_s.iter().copied();
        let line: Vec<_> = times.zip(values.iter().copied()).collect();
        panel.line(&mut picture, &line, stroke);
        legend.line(&mut picture, stroke, name);
    }
    Some(picture)
}

fn dashed(colour_of: usize, dash: Dash) -> Stroke {
    Stroke {
        dash,
        ..stroke_of(colour_of)
    }
}

/// Bias and the scale factor's error at the true rate.
fn predicted(record: &TemperatureRecord, signals: &RunSignals) -> Vec<(f64, f64)> {
    let rows = record.time_s.iter().zip(&record.bias_deg_per_h);
    rows.zip(&record.scale_ratio)
        .map(|((time_s, bias), scale)| {
            let at = index(time_s / signals.sample_period_s);
            let last = signals.truth_deg_per_h.len().saturating_sub(1);
            let truth = signals.truth_deg_per_h.get(at.min(last));
            (*time_s, bias + (scale - 1.0) * truth.unwrap_or(0.0))
        })
        .collect()
}
