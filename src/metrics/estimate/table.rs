//! Filling a channel's table: units from the catalogue, fits and curves in their fixed form.

use std::collections::BTreeMap;

use super::value::{ChannelMetrics, Estimate, Metric};
use crate::metrics::allan::noise_fit::{
    ANGLE_RANDOM_WALK, BIAS_INSTABILITY, NoiseFit, QUANTISATION, RATE_RAMP, RATE_RANDOM_WALK, Term,
};
use crate::metrics::key::metric::MetricKey;
use crate::metrics::noise::spectrum::Spectrum;
use crate::units;

/// Field of a bias stability: correlation of its means with those of raw.
pub(crate) const RAW_CORRELATION: &str = "raw_correlation";
/// Field of every metric whose interval is a chi-square one.
pub(crate) const DEGREES_OF_FREEDOM: &str = "degrees_of_freedom";

/// Field of a bias stability: what the fitted noise makes one expect.
pub(crate) const EXPECTED: &str = "expected_deg_per_h";

/// Upper end beyond which an interval says nothing, whatever the unit.
const BOUND_MAX: f64 = 1e6;

/// Column of the two-sided density in the curve `psd`; `psd_deg2_per_h2_per_hz` is one-sided.
pub(crate) const TWO_SIDED_PSD: &str = "two_sided_psd_deg2_per_h2_per_hz";
/// Reason of a metric or curve that came out as no finite number.
const NOT_FINITE: &str = "the record gives no finite number";
/// Width of an interval, as a part of its value, that rounding makes.
const ROUNDING: f64 = 1e-12;

impl ChannelMetrics {
    /// Enters a metric under its catalogue unit, and returns it for its defining fields.
    pub(crate) fn put(&mut self, key: &MetricKey, estimate: Estimate) -> &mut Metric {
        self.unavailable.remove(key.name);
        self.metrics.remove(key.name);
        self.metrics
            .entry(key.name.to_owned())
            .or_insert_with(|| Metric::new(estimate, key.unit))
    }

    /// Says why a metric is missing.
    pub(crate) fn miss(&mut self, key: &MetricKey, reason: impl Into<String>) {
        self.unavailable.insert(key.name.to_owned(), reason.into());
    }

    /// Takes a metric out and says why, if it is there.
    pub(crate) fn withdraw(&mut self, key: &MetricKey, reason: impl Into<String>) {
        if self.metrics.remove(key.name).is_some() {
            self.miss(key, reason);
        }
    }

    /// A metric of the channel; none if the record does not support it.
    #[must_use]
    pub fn get(&self, key: &MetricKey) -> Option<&Metric> {
        self.metrics.get(key.name)
    }

    pub(crate) fn get_mut(&mut self, key: &MetricKey) -> Option<&mut Metric> {
        self.metrics.get_mut(key.name)
    }

    /// Why a metric is missing; none if it is there.
    #[must_use]
    pub fn why_unavailable(&self, key: &MetricKey) -> Option<&str> {
        self.unavailable.get(key.name).map(String::as_str)
    }

    /// Leaves only finite numbers in the table: the one gate between measuring and reporting.
    ///
    /// A metric whose value or interval came out as no number (a ratio to nothing, a sum beyond
    /// binary64) becomes unavailable with the reason, a curve with such a point is left out whole and
    /// stands among the unavailable ones as `curves.<name>`. A defining field that is no number says
    /// nothing and is dropped from its metric, as are statistics over repeats.
    pub fn keep_finite(&mut self) {
        let is_finite = |estimate: &Estimate| {
            let Estimate {
                value,
                low,
                high,
                confidence,
            } = *estimate;
            [value, low, high, confidence]
                .iter()
                .all(|it| it.is_finite())
        };
        let mut lost: Vec<(String, String)> = Vec::new();
        self.metrics.retain(|name, metric| {
            metric.fields.retain(|_, value| value.is_finite());
            let is_kept = is_finite(&metric.estimate);
            if !is_kept {
                lost.push((name.clone(), NOT_FINITE.to_owned()));
            }
            is_kept
        });
        self.curves.retain(|name, columns| {
            let mut columns = columns.iter();
            let broken = columns.find(|(_, values)| !values.iter().all(|it| it.is_finite()));
            if let Some((column, _)) = broken {
                let reason = format!("{NOT_FINITE} for a point of {column}");
                lost.push((format!("curves.{name}"), reason));
            }
            broken.is_none()
        });
        let curves = &self.curves;
        self.curve_labels
            .retain(|name, _| curves.contains_key(name));
        self.repeats.retain(|_, of| {
            let own = [of.mean, of.standard_deviation, of.minimum, of.maximum];
            own.iter().chain(&of.values).all(|it| it.is_finite())
        });
        self.unavailable.extend(lost);
    }

    /// Gives metrics without width the field `exact_to_word`: words that never change determine their
    /// mean exactly, and leave open where within its rounding the rate lies.
    pub(crate) fn mark_exact(&mut self, keys: &[&MetricKey]) {
        for key in keys {
            if let Some(metric) = self.get_mut(key)
                && metric.estimate.high - metric.estimate.low
                    <= ROUNDING * metric.estimate.value.abs()
            {
                metric.fields.insert("exact_to_word", 1.0);
            }
        }
    }

    /// Enters the five fitted coefficients or the reasons for their absence.
    pub(crate) fn put_noise_fit(&mut self, fit: &NoiseFit) {
        type Conversion = fn(f64) -> f64;
        let entries: [(&MetricKey, &Term, Conversion); 5] = [
            (
                &ANGLE_RANDOM_WALK,
                &fit.angle_random_walk_deg_per_h_sqrt_s,
                units::deg_per_h_sqrt_s_to_deg_per_sqrt_h,
            ),
            (
                &BIAS_INSTABILITY,
                &fit.bias_instability_deg_per_h,
                std::convert::identity,
            ),
            (
                &RATE_RANDOM_WALK,
                &fit.rate_random_walk_deg_per_h_per_sqrt_s,
                units::deg_per_h_per_sqrt_s_to_deg_per_h_per_sqrt_h,
            ),
            (
                &RATE_RAMP,
                &fit.rate_ramp_deg_per_h_per_s,
                units::deg_per_h_per_s_to_deg_per_h_per_h,
            ),
            (
                &QUANTISATION,
                &fit.quantisation_arcsec,
                std::convert::identity,
            ),
        ];
        for (key, term, convert) in entries {
            match term {
                Term::Found(estimate) => {
                    let estimate = estimate.scaled(convert(1.0));
                    let metric = self.put(key, estimate);
                    metric.fields.insert("tau_min_s", fit.tau_range_s[0]);
                    metric.fields.insert("tau_max_s", fit.tau_range_s[1]);
                }
                Term::LeftOut { reason, allowed } => {
                    self.metrics.remove(key.name);
                    let high = convert(allowed.high);
                    // A bound of nothing is that of a record that these five terms do not describe.
                    let bound = if high > 0.0 && high < BOUND_MAX {
                        format!("; it is {} {} at most (95 %)", three_digits(high), key.unit)
                    } else {
                        String::new()
                    };
                    self.miss(key, format!("{reason}{bound}"));
                }
            }
        }
    }

    /// Enters the spectrum.
    pub(crate) fn put_spectrum(&mut self, spectrum: Spectrum) {
        let mut curve = BTreeMap::new();
        // Half the one-sided density at either sign of the frequency: N^2 of white noise.
        let halves = spectrum.density_deg2_per_h2_per_hz.iter();
        curve.insert(
            TWO_SIDED_PSD.into(),
            halves.map(|density| density / 2.0).collect(),
        );
        curve.insert("frequency_hz".into(), spectrum.frequency_hz);
        curve.insert(
            "psd_deg2_per_h2_per_hz".into(),
            spectrum.density_deg2_per_h2_per_hz,
        );
        self.curves.insert("psd".into(), curve);
    }
}

/// A bound to three digits, as plain as its size allows.
fn three_digits(value: f64) -> String {
    if (1e-3..1e4).contains(&value) {
        let magnitude = value.log10().floor();
        let decimals = (2.0 - magnitude).max(0.0);
        format!("{value:.*}", super::interval::round_to_count(decimals))
    } else {
        format!("{value:.2e}")
    }
}
