//! What is said of a recorded log: text and JSON.

use std::borrow::Cow;

use serde_json::{Map, Value};

use crate::gate::{Verdict, plain};
use crate::metrics::ChannelMetrics;
use crate::report::json::channel::channel;
use crate::report::json::summary::gate;
use crate::report::layout::json::{SCHEMA, tool};
use crate::report::layout::json::{object, pretty, put};
use crate::report::layout::text::{Tone, toned, wrapped};
use crate::report::record::measured::Measured;
use crate::report::text::quality::quality_text;
use crate::report::text::scale_factor::found_dwells_text;
use crate::report::text::table::{channels_text, failures_text, filter_verdicts, gates_text};
use crate::report::text::temperature::temperature_text;
use crate::scenario::{MotionClass, MotionConfig};
use crate::wording::counted;

/// Everything the report of one log shows.
#[derive(Clone, Debug)]
pub struct LogReport<'a> {
    /// Version of the tool.
    pub tool_version: &'a str,
    /// Name of the file, without its folder.
    pub file: &'a str,
    /// Column of the rate, where the file has several.
    pub column: Option<&'a str>,
    /// Unit it was recorded in.
    pub unit: &'a str,
    /// Sample rate, Hz.
    pub sample_rate_hz: f64,
    /// Samples measured.
    pub samples: usize,
    /// Samples before them, left out.
    pub warm_up_samples: usize,
    /// Name of the scenario or base whose filters ran, with its digest; none without filters.
    pub filters: Option<(&'a str, &'a str)>,
    /// Motion during the record, as the user gives it.
    pub motion: &'a MotionConfig,
    /// Channels, raw first.
    pub channels: &'a [(String, ChannelMetrics)],
    /// Gates, judged.
    pub verdicts: &'a [Verdict],
    /// What else is worth saying.
    pub notes: &'a [String],
}

impl<'a> LogReport<'a> {
    pub(in crate::report) fn measured(&self) -> Measured<'a> {
        Measured {
            name: self.file,
            motion: Cow::Borrowed(self.motion),
            channels: self.channels,
        }
    }

    #[expect(
        clippy::cast_precision_loss,
        reason = "sample counts are far below 2^53"
    )]
    fn seconds(&self, samples: usize) -> f64 {
        samples as f64 / self.sample_rate_hz
    }
}

/// The table of one log: heading, channels by metrics, failures and what is lacking, notes.
#[must_use]
pub fn log_text(report: &LogReport, width: usize, colour: bool) -> String {
    let column = report
        .column
        .map_or_else(String::new, |column| format!(", column {column}"));
    let mut text = format!(
        "{}{column}  recorded log, {}, {} at {} Hz: {} s after {} s of warm-up\n",
        toned(report.file, Tone::Heading, colour),
        report.unit,
        counted(report.samples, "sample"),
        plain(report.sample_rate_hz),
        plain(report.seconds(report.samples)),
        plain(report.seconds(report.warm_up_samples)),
    );
    if let Some((file, _)) = report.filters {
        text.push_str(&wrapped(&format!("filters of {file}"), "  ", width));
    }
    let measured = report.measured();
    text.push_str(&channels_text(&measured, width, colour));
    text.push_str(&found_dwells_text(report.channels, width, colour));
    text.push_str(&failures_text(&measured, &[], width, colour));
    text.push_str(&quality_text(report.channels, width));
    text.push_str(&temperature_text(report.channels, width));
    text.push_str(&filter_verdicts(&measured, width, colour));
    text.push_str(&gates_text(report.verdicts, width, colour, |_| None));
    for note in report.notes {
        let note = format!("{} {note}", toned("note:", Tone::Doubt, colour));
        text.push_str(&wrapped(&note, "  ", width));
    }
    text
}

/// The results as JSON; `channels.<name>` is that of a run's `summary.json`.
#[must_use]
pub fn log_json(report: &LogReport) -> String {
    let channels: Map<String, Value> = report
        .channels
        .iter()
        .map(|(name, metrics)| (name.clone(), channel(metrics)))
        .collect();
    let mut root = object([
        ("schema", SCHEMA.into()),
        ("tool", tool(report.tool_version)),
        ("log", log(report)),
        ("channels", channels.into()),
    ]);
    if !report.verdicts.is_empty() {
        let gates = report.verdicts.iter();
        let gates = gates.map(|verdict| gate(verdict).into()).collect();
        root.insert("gates".to_owned(), Value::Array(gates));
    }
    if !report.notes.is_empty() {
        root.insert("notes".to_owned(), report.notes.to_vec().into());
    }
    pretty(&root.into())
}

fn log(report: &LogReport) -> Value {
    let duration_s = report.seconds(report.samples);
    let warm_up_s = report.seconds(report.warm_up_samples);
    let mut record = object([("file", report.file.into()), ("unit", report.unit.into())]);
    put(&mut record, "rate_hz", report.sample_rate_hz);
    record.insert("samples".to_owned(), report.samples.into());
    put(&mut record, "duration_s", duration_s);
    let warm_up_samples = report.warm_up_samples.into();
    record.insert("warm_up_samples".to_owned(), warm_up_samples);
    put(&mut record, "warm_up_s", warm_up_s);
    if let Some(column) = report.column {
        record.insert("column".to_owned(), column.into());
    }
    if let MotionClass::Swing { frequency_hz, .. } = report.motion.class() {
        put(&mut record, "swing_frequency_hz", frequency_hz);
    }
    if let Some((file, digest)) = report.filters {
        let filters = object([("file", file.into()), ("digest", digest.into())]);
        record.insert("filters".to_owned(), filters.into());
    }
    record.into()
}
