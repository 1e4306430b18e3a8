//! A report out of its own `summary.json`: what a run measured, without running it again.
//!
//! Whoever restores a report must compare the summary that it makes with the one it came from; only
//! equal bytes show that nothing was lost on the way.

use crate::report::restore::values::{indices, interned, numbers, real, reals, texts};
use std::collections::BTreeMap;

use serde_json::{Map, Value};

use crate::metrics::{
    ChannelFailure, ChannelMetrics, Estimate, FitSheet, FitTerm, Metric, RepeatStatistics,
};
use crate::report::calibration::documents::THETAS;
use crate::report::layout::json::{EXACT, INTERVAL, METRICS};
use crate::report::restore::calibration::calibration_sheet;
use crate::signal::{CalibrationSheet, CompensationSheet};

/// What a summary tells that does not follow from the scenario.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct RestoredRun {
    /// Channels with their metrics, in order.
    pub channels: Vec<(String, ChannelMetrics)>,
    /// What was taken out of the outputs.
    pub compensation: Option<CompensationSheet>,
    /// What came of a calibration campaign; covariances are not in a summary and are zero.
    pub calibration: Option<CalibrationSheet>,
    /// What was worth saying.
    pub notes: Vec<String>,
}

impl RestoredRun {
    /// Reads the text of a `summary.json`; none if it is not that of a run that finished.
    #[must_use]
    pub fn of_summary(text: &str) -> Option<Self> {
        let root: Value = serde_json::from_str(text).ok()?;
        let channels = root.get("channels")?.as_object()?.iter();
        let channels = channels.map(|(name, record)| Some((name.clone(), channel(record)?)));
        let notes = root.get("notes").map_or(Some(Vec::new()), texts)?;
        let part = |key| root.get(key).filter(|part: &&Value| !part.is_null());
        let compensation = match part("compensation") {
            None => None,
            Some(record) => Some(compensation(record)?),
        };
        let calibration = match part("calibration") {
            None => None,
            Some(record) => Some(calibration_sheet(record)?),
        };
        Some(Self {
            channels: channels.collect::<Option<_>>()?,
            compensation,
            calibration,
            notes,
        })
    }
}

fn channel(record: &Value) -> Option<ChannelMetrics> {
    let mut channel = ChannelMetrics::default();
    for (key, value) in record.as_object()? {
        match key.as_str() {
            // Of these a summary does not keep all.
            "verdict" | "repeats" | "smoothing" | "outlier_list" | METRICS => {}
            "noise_fit" => channel.noise_fit = Some(noise_fit(value)?),
            "pulse_words" => {
                for (name, words) in value.as_object()? {
                    let words = words.as_str()?.to_owned();
                    channel.pulse_words.insert(name.clone(), words);
                }
            }
            "curves" => curves(value.as_object()?, &mut channel)?,
            "unavailable" => {
                for (name, reason) in value.as_object()? {
                    let reason = reason.as_str()?.to_owned();
                    channel.unavailable.insert(name.clone(), reason.into());
                }
            }
            "error" => {
                channel.error = Some(ChannelFailure {
                    kind: value.get("kind")?.as_str()?.to_owned(),
                    sample: value.get("sample")?.as_u64()?,
                    message: value.get("message")?.as_str()?.to_owned(),
                });
            }
            _ => drop(channel.metrics.insert(key.clone(), metric(value)?)),
        }
    }
    let repeats = record.get("repeats").and_then(Value::as_object);
    for (key, record) in repeats.into_iter().flatten() {
        let measured = channel.metrics.get(key);
        let statistics = RepeatStatistics {
            unit: interned(record.get("unit")?.as_str()?),
            averaging_time_s: measured
                .and_then(|metric| metric.fields.get("averaging_time_s").copied()),
            values: numbers(record.get("values")?)?,
            lacking: record.get("lacking").map_or(Some(Vec::new()), indices)?,
            mean: real(record, "mean")?,
            standard_deviation: real(record, "standard_deviation")?,
            minimum: real(record, "minimum")?,
            maximum: real(record, "maximum")?,
        };
        channel.repeats.insert(key.clone(), statistics);
    }
    Some(channel)
}

fn metric(record: &Value) -> Option<Metric> {
    let [value, low, high] = ["value", "low", "high"].map(|key| real(record, key));
    let estimate = Estimate {
        confidence: real(record, "confidence")?,
        ..match record.get(INTERVAL).map(Value::as_str) {
            None => Estimate::with_interval(value?, low?, high?),
            Some(Some(EXACT)) => Estimate::exact(value?),
            Some(reason) => Estimate::without_interval(value?, interned(reason?)),
        }
    };
    let mut fields = BTreeMap::new();
    for (key, value) in record.as_object()? {
        let own = ["value", "low", "high", "confidence", INTERVAL, "unit"];
        if !own.contains(&key.as_str()) {
            fields.insert(interned(key), value.as_f64()?);
        }
    }
    Some(Metric {
        estimate,
        unit: interned(record.get("unit")?.as_str()?),
        fields,
    })
}

fn noise_fit(record: &Value) -> Option<FitSheet> {
    let mut sheet = FitSheet::default();
    for (key, value) in record.as_object()? {
        match key.as_str() {
            "criterion" => {}
            "adequate" => sheet.is_adequate = value.as_bool()?,
            "missed_tau_s" => sheet.missed_tau_s = numbers(value)?,
            "terms" => {
                for (name, term) in value.as_object()? {
                    let term = FitTerm {
                        square: real(term, "square")?,
                        standard_error: real(term, "standard_error")?,
                        unit: term.get("unit")?.as_str()?.to_owned(),
                        is_in_model: term.get("in_model")?.as_bool()?,
                    };
                    sheet.terms.insert(name.clone(), term);
                }
            }
            _ => drop(sheet.numbers.insert(key.clone(), value.as_f64()?)),
        }
    }
    Some(sheet)
}

/// Columns of numbers, and columns of words, a single one of which stands alone.
fn curves(record: &Map<String, Value>, channel: &mut ChannelMetrics) -> Option<()> {
    for (name, columns) in record {
        let curve = channel.curves.entry(name.clone()).or_default();
        for (column, values) in columns.as_object()? {
            let words = match values {
                Value::String(word) => vec![interned(word)],
                Value::Array(all) if all.first().is_some_and(Value::is_string) => {
                    let words = all.iter().map(|word| word.as_str().map(interned));
                    words.collect::<Option<Vec<_>>>()?
                }
                numeric => {
                    curve.insert(column.clone(), numbers(numeric)?);
                    continue;
                }
            };
            let labels = channel.curve_labels.entry(name.clone()).or_default();
            labels.insert(column.clone(), words);
        }
    }
    Some(())
}

fn compensation(record: &Value) -> Option<CompensationSheet> {
    let mut theta_arcsec = [("", 0.0); 6];
    for (theta, name) in theta_arcsec.iter_mut().zip(THETAS) {
        *theta = (name, real(record, &format!("theta_{name}_arcsec"))?);
    }
    Some(CompensationSheet {
        form: interned(record.get("form")?.as_str()?),
        source: record.get("source")?.as_str()?.to_owned(),
        bias_deg_per_h: reals(record, "bias_deg_per_h")?,
        scale_factor_error_ppm: reals(record, "scale_factor_error_ppm")?,
        theta_arcsec,
        follows_temperature: record.get("follows_temperature")?.as_bool()?,
        rate_deg_per_h: reals(record, "rate_deg_per_h")?,
        exact_residual_deg_per_h: reals(record, "exact_residual_deg_per_h")?,
        first_order_residual_deg_per_h: reals(record, "first_order_residual_deg_per_h")?,
    })
}
