//! The values of a metric at the points of a sweep, and how they are laid out.

use std::collections::BTreeMap;

use super::super::drawing::axis::Axis;
use super::super::drawing::picture::text_width;
use super::super::drawing::series::extent;
use super::keys::{SweptKey, is_log_span, others_text};
use super::names;
use crate::metrics::{Estimate, MetricKey};
use crate::report::layout::text::with_unit;
use crate::report::record::run::RunOutcome;
use crate::wording::{counted, plain};

/// Which key is the axis, and how the settings of the others are told apart.
pub(super) struct Layout<'a> {
    pub(super) along: &'a SweptKey,
    /// The other keys that differ.
    pub(super) others: Vec<&'a SweptKey>,
    /// Settings of the others: their texts, in the order in which they occur.
    pub(super) settings: Vec<String>,
    /// Values alone of each setting, in the order of the others.
    pub(super) values: Vec<String>,
    /// Number of the setting of every point.
    pub(super) setting_of: Vec<usize>,
    /// Keys that are the same at every point.
    fixed: Vec<&'a SweptKey>,
}

impl<'a> Layout<'a> {
    pub(super) fn of(keys: &'a [SweptKey], points: usize) -> Option<Self> {
        let (differing, fixed): (Vec<&SweptKey>, Vec<&SweptKey>) =
            keys.iter().partition(|key| key.labels.len() > 1);
        // A number before a word, and of two of them the one with more values; the first of equals.
        let rank = |key: &&&SweptKey| (key.is_number, key.labels.len());
        let all = || differing.iter().rev();
        let along = *all().max_by_key(rank).or(fixed.first())?;
        let others: Vec<&SweptKey> = differing
            .iter()
            .copied()
            .filter(|key| !std::ptr::eq(*key, along))
            .collect();
        let (mut settings, mut values) = (Vec::new(), Vec::new());
        let mut known = BTreeMap::new();
        let setting_of = (0..points).map(|point| {
            let text = others_text(&others, point);
            *known.entry(text.clone()).or_insert_with(|| {
                settings.push(text);
                let own = others.iter().map(|key| key.label(point));
                values.push(own.collect::<Vec<_>>().join(", "));
                settings.len() - 1
            })
        });
        let setting_of = setting_of.collect();
        Some(Self {
            along,
            others,
            settings,
            values,
            setting_of,
            fixed: fixed
                .into_iter()
                .filter(|key| !std::ptr::eq(*key, along))
                .collect(),
        })
    }

    /// The keys that differ in words, each by the name that is taken of it.
    pub(super) fn names(&self, name: fn(&SweptKey) -> &str) -> String {
        let others = self.others.iter().map(|key| name(key));
        let names = std::iter::once(name(self.along)).chain(others);
        names.collect::<Vec<_>>().join(" and ")
    }

    /// What is the same at every point, in words that fit a room in pixels.
    pub(super) fn fixed_text(&self, size: f64, room: f64) -> String {
        let text = |title: fn(&SweptKey) -> String| {
            let fixed = self.fixed.iter();
            let fixed = fixed.map(|key| format!("{} = {}", title(key), key.labels[0]));
            fixed.collect::<Vec<_>>().join(", ")
        };
        let whole = text(SweptKey::title);
        if text_width(&whole, size) <= room {
            return whole;
        }
        names::start(&text(SweptKey::short_title), size, room)
    }
}

/// A channel's values, by point.
pub(super) struct Channel {
    pub(super) name: String,
    /// Number among the channels of the sweep: its colour.
    pub(super) index: usize,
    pub(super) values: Vec<Option<Estimate>>,
}

/// The values of a metric.
pub(super) struct Sheet {
    /// Heading with unit.
    pub(super) title: String,
    pub(super) channels: Vec<Channel>,
}

impl Sheet {
    pub(super) fn of(points: &[&RunOutcome], key: &'static MetricKey, plan: &Layout) -> Self {
        let mut channels: Vec<Channel> = Vec::new();
        let mut times_s = Vec::new();
        for (place, point) in points.iter().enumerate() {
            for (own, outcome) in point.channels.iter().enumerate() {
                let index = match channels.iter().position(|it| it.name == outcome.name) {
                    Some(index) => index,
                    None => {
                        channels.push(Channel {
                            name: outcome.name.clone(),
                            index: channels.len(),
                            values: vec![None; plan.setting_of.len()],
                        });
                        channels.len() - 1
                    }
                };
                let mut figures = point.swept.iter();
                let figure = figures.find(|figure| figure.channel == own && figure.key == key);
                if let Some(figure) = figure.filter(|figure| figure.estimate.value.is_finite()) {
                    channels[index].values[place] = Some(figure.estimate);
                    times_s.push(figure.averaging_time_s);
                }
            }
        }
        channels.retain(|channel| channel.values.iter().any(Option::is_some));
        times_s.dedup();
        let unit = Some(key.unit.to_owned()).filter(|unit| unit != "1");
        let time = match times_s[..] {
            [Some(time_s)] => Some(format!("{} s", plain(time_s))),
            _ => None,
        };
        let parts: Vec<String> = unit.into_iter().chain(time).collect();
        Self {
            title: with_unit(&key.title(), &parts.join(", ")),
            channels,
        }
    }

    /// The axis of the values of some channels: logarithmic where they span more than a decade and a half.
    pub(super) fn axis<'a>(
        &self,
        channels: impl Iterator<Item = &'a Channel> + Clone,
        title: &str,
    ) -> Axis {
        let values = channels.flat_map(|channel| channel.values.iter().flatten());
        let is_log = extent(values.clone().map(|it| it.value)).is_some_and(is_log_span);
        let ends = values.flat_map(|it| [it.value, it.low, it.high]);
        let ends = ends.filter(|end| !is_log || *end > 0.0);
        let range = extent(ends).unwrap_or((0.0, 1.0));
        if is_log {
            Axis::log(range, 0.06, title)
        } else {
            Axis::linear(range, 0.08, title)
        }
    }
}

/// What is said of points at which a channel has no value; none if it has one everywhere.
pub(super) fn lack(channel: &Channel) -> Option<String> {
    let lacking = channel
        .values
        .iter()
        .filter(|value| value.is_none())
        .count();
    let of = counted(channel.values.len(), "point");
    (lacking > 0).then(|| format!("no value at {lacking} of {of}"))
}
