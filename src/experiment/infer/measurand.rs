//! What a figure is of: a metric of a channel, or a point of one of its curves.

use super::forms::{Form, form_of};
use crate::metrics::catalogue::{ALLAN, AUTOCOVARIANCE};
use crate::metrics::columns::{allan, autocovariance};
use crate::metrics::{self, ChannelMetrics, Column, Curve, CurveKey, Estimate, MetricKey};

/// What a figure is of.
#[derive(Clone, Copy, Debug)]
pub(super) enum Measurand {
    /// A metric.
    Metric(&'static MetricKey),
    /// A point of a curve.
    Point {
        /// The curve.
        curve: &'static PointCurve,
        /// Place on it, in the unit of its first column.
        place: f64,
    },
}

/// A name that is nobody's.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(super) enum NoMeasurand {
    /// It is not made of two parts.
    #[error("expected channel and metric, as in raw.dc_gain")]
    Parts,
    /// Nobody knows the metric.
    #[error("{0}")]
    Metric(String),
    /// Nobody knows the curve.
    #[error("no curve `{0}` of which points are forecast: expected {known}", known = curve_names())]
    Curve(String),
    /// The place is no number.
    #[error("`{0}` is no place on a curve: expected a number from 0 on, as in raw.allan[10]")]
    Place(String),
}

/// A curve whose points have a closed form.
#[derive(Debug)]
pub(super) struct PointCurve {
    key: &'static CurveKey,
    place: &'static Column,
    value: &'static Column,
    /// Columns of both ends of the interval; none where it has none.
    ends: Option<[&'static Column; 2]>,
    form: fn(f64) -> Form,
    /// Points that are taken of a whole curve.
    chosen: fn(&Curve) -> Vec<f64>,
}

/// The curves.
static CURVES: [PointCurve; 2] = [
    PointCurve {
        key: &ALLAN,
        place: &allan::TAU,
        value: &allan::DEVIATION,
        ends: Some([&allan::LOW, &allan::HIGH]),
        form: Form::Allan,
        chosen: octaves,
    },
    PointCurve {
        key: &AUTOCOVARIANCE,
        place: &autocovariance::LAG,
        value: &autocovariance::PRODUCT,
        ends: None,
        form: Form::Autocovariance,
        chosen: first_lags,
    },
];

/// Words of the shortest averaging time that is taken: what a loop leaves of noise below is not white.
const ALLAN_WORDS_MIN: f64 = 10.0;
/// Fewest degrees of freedom of a time that is taken.
const ALLAN_FREEDOM_MIN: f64 = 10.0;
/// Lags that are taken.
const LAGS: usize = 8;

fn curve_names() -> String {
    CURVES.each_ref().map(|own| own.key.name).join(" or ")
}

/// Averaging times twice as long one after the other: those between tell little more.
fn octaves(curve: &Curve) -> Vec<f64> {
    let times = allan::TAU.of(curve);
    let freedom = allan::FREEDOM.of(curve);
    let mut least = times.first().map_or(0.0, |first| ALLAN_WORDS_MIN * first);
    let mut chosen = Vec::new();
    for (time, freedom) in times.iter().zip(freedom) {
        // A hair less: times are whole words.
        if *time >= 0.999 * least && *freedom >= ALLAN_FREEDOM_MIN {
            chosen.push(*time);
            least = 2.0 * time;
        }
    }
    chosen
}

fn first_lags(curve: &Curve) -> Vec<f64> {
    autocovariance::LAG
        .of(curve)
        .iter()
        .take(LAGS)
        .copied()
        .collect()
}

impl Measurand {
    /// Channel and measurand of a name.
    ///
    /// # Errors
    /// Why it is nobody's.
    pub(super) fn of(written: &str) -> Result<(String, Self), NoMeasurand> {
        let Some((name, place)) = written
            .strip_suffix(']')
            .and_then(|own| own.split_once('['))
        else {
            let (channel, name) = written.rsplit_once('.').ok_or(NoMeasurand::Parts)?;
            let unknown = || NoMeasurand::Metric(metrics::unknown(name).unwrap_or_default());
            let metric = metrics::find(name).ok_or_else(unknown)?;
            return Ok((channel.to_owned(), Self::Metric(metric)));
        };
        let (channel, curve) = curve_of(name)?;
        let number = place.trim().parse::<f64>().ok();
        let place = number.filter(|place| place.is_finite() && *place >= 0.0);
        let place = place.ok_or_else(|| NoMeasurand::Place(written.to_owned()))?;
        Ok((channel, Self::Point { curve, place }))
    }

    /// Unit as printed.
    pub(super) fn unit(&self) -> &'static str {
        match self {
            Self::Metric(metric) => metric.unit,
            Self::Point { curve, .. } => curve.value.unit(),
        }
    }

    /// How it follows from a record in closed form; none where it does not.
    pub(super) fn form(&self) -> Option<Form> {
        match self {
            Self::Metric(metric) => form_of(metric),
            Self::Point { curve, place } => Some((curve.form)(*place)),
        }
    }

    /// Its value in what was measured of a channel; none where that lacks it.
    pub(super) fn read(&self, channel: &ChannelMetrics) -> Option<Estimate> {
        match self {
            Self::Metric(metric) => Some(channel.get(metric)?.estimate),
            Self::Point { curve, place } => curve.read(channel.curve(curve.key)?, *place),
        }
    }

    /// The names that a name of a log stands for: itself, or those of the points of a whole curve.
    ///
    /// # Errors
    /// Why it is nobody's.
    pub(super) fn names(
        written: &str,
        channel: impl Fn(&str) -> Option<ChannelMetrics>,
    ) -> Result<Vec<String>, NoMeasurand> {
        let Ok((name, curve)) = curve_of(written) else {
            return Self::of(written).map(|_| vec![written.to_owned()]);
        };
        let found = channel(&name);
        let found = found.as_ref().and_then(|own| own.curve(curve.key));
        let places = found.map(curve.chosen).unwrap_or_default();
        let names = places
            .iter()
            .map(|place| format!("{written}[{}]", metrics::plain(*place)));
        Ok(names.collect())
    }
}

/// Channel and curve of a name.
fn curve_of(name: &str) -> Result<(String, &'static PointCurve), NoMeasurand> {
    let (channel, name) = name.rsplit_once('.').ok_or(NoMeasurand::Parts)?;
    let curve = CURVES.iter().find(|own| own.key.name == name);
    let curve = curve.ok_or_else(|| NoMeasurand::Curve(name.to_owned()))?;
    Ok((channel.to_owned(), curve))
}

impl PointCurve {
    /// The point nearest to a place, if it is within a part in ten of it.
    fn read(&self, curve: &Curve, place: f64) -> Option<Estimate> {
        const NEAR: f64 = 0.1;
        let places = self.place.of(curve);
        let distance = |index: &usize| (places[*index] - place).abs();
        let nearest =
            (0..places.len()).min_by(|one, other| distance(one).total_cmp(&distance(other)))?;
        (distance(&nearest) <= NEAR * place).then_some(())?;
        let value = *self.value.of(curve).get(nearest)?;
        let Some([low, high]) = self.ends else {
            return Some(Estimate::without_interval(value, "the curve has none"));
        };
        let (low, high) = (*low.of(curve).get(nearest)?, *high.of(curve).get(nearest)?);
        Some(Estimate::with_interval(value, low, high))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_of_metrics_or_of_points_of_curves() {
        let (channel, found) = Measurand::of("raw.allan[10]").expect("a point");
        assert_eq!((channel.as_str(), found.unit()), ("raw", "deg/h"));
        assert_eq!(found.form(), Some(Form::Allan(10.0)));
        let (channel, found) = Measurand::of("lms.dc_gain").expect("a metric");
        assert_eq!((channel.as_str(), found.form()), ("lms", Some(Form::Gain)));
        let refused = [
            "raw",
            "raw.dc_gian",
            "raw.alan[10]",
            "raw.allan[ten]",
            "raw.allan[-1]",
        ];
        for written in refused {
            assert!(Measurand::of(written).is_err(), "{written}");
        }
    }
}
