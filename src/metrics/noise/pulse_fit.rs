//! The record without pulses that the noise terms are fitted to in the place of words that count them.

use super::line::fit_beside_sine;
use crate::metrics::allan::noise_fit::{FitRange, NoiseFit, fit_beside_known};
use crate::metrics::allan::overlapping::{AllanPoint, overlapping_allan};
use crate::metrics::allan::pulses::answer::{PulseAnswer, PulseMethod};
use crate::metrics::allan::pulses::recognition::{PulseWords, TAU_RATIO_MIN};
use crate::metrics::allan::pulses::sawtooth::Sawtooth;
use crate::metrics::estimate::interval;
use crate::metrics::estimate::reason::Unavailable;
use crate::wording::{plain, to_digits};

/// Shortest averaging times that a mean must last for what a loop takes from the shortest of the curve to be
/// nothing beside the pulses, whose square is then known.
const KNOWN_FROM: f64 = 4.0;

/// A fit and the record that it was made to.
pub(crate) struct RecordFit {
    /// The fit.
    pub(crate) fit: NoiseFit,
    /// Curve that it was made to.
    pub(crate) points: Vec<AllanPoint>,
    /// Samples of the record.
    pub(crate) samples: usize,
}

/// A record in the place of words.
struct Substitute {
    rates_deg_per_h: Vec<f64>,
    period_s: f64,
    /// `tau^2` times the Allan variance of its own quantisation, arcsec^2, where that is known.
    known: Option<f64>,
    method: PulseMethod,
}

impl PulseWords {
    /// Fits the noise terms of a channel, raw or what a filter made of it.
    ///
    /// # Errors
    /// The reason, in words, where neither the curve nor the times between pulses tell the noise.
    pub(crate) fn fit(
        &self,
        channel_deg_per_h: &[f64],
        sample_period_s: f64,
        range: FitRange,
        is_raw: bool,
    ) -> Result<RecordFit, Unavailable> {
        let from_times = is_raw.then(|| self.times(sample_period_s, range)).flatten();
        let record = match from_times {
            Some(record) => record,
            None => self.means(channel_deg_per_h, sample_period_s, range, is_raw)?,
        };
        let range = FitRange {
            tau_min_s: range.tau_min_s.max(record.period_s),
            ..range
        };
        let rates = &record.rates_deg_per_h;
        let points = overlapping_allan(rates, record.period_s);
        let fit = fit_beside_sine(rates, record.period_s, &points, range, record.known)
            .map_or_else(|| fit_beside_known(&points, range, record.known), Ok)?;
        let sawtooth = Sawtooth {
            white: fit.angle_random_walk_deg_per_h_sqrt_s.square.max(0.0),
            ..self.sawtooth
        };
        let answer = self.agreement.map(|agreement| PulseAnswer {
            method: record.method,
            counts: is_raw,
            agreement,
            sawtooth,
        });
        Ok(RecordFit {
            fit: fit.of_pulses(answer),
            samples: rates.len(),
            points,
        })
    }

    /// The rates by the times between pulses, stamped to a word.
    fn times(&self, sample_period_s: f64, range: FitRange) -> Option<Substitute> {
        let passages = self.passages.as_ref()?;
        let stamps = passages.stamps(sample_period_s);
        let is_long = passages.period_s >= KNOWN_FROM * range.tau_min_s;
        Some(Substitute {
            rates_deg_per_h: passages.rates_deg_per_h.clone(),
            period_s: passages.period_s,
            known: is_long.then_some(stamps),
            method: PulseMethod::Times {
                pulses: passages.pulses,
                intervals: passages.rates_deg_per_h.len(),
            },
        })
    }

    /// Means of the words over the time in which the pulses lose their phase.
    fn means(
        &self,
        channel: &[f64],
        sample_period_s: f64,
        range: FitRange,
        is_raw: bool,
    ) -> Result<Substitute, Unavailable> {
        let time_s = self.resolution_s();
        if time_s * TAU_RATIO_MIN > range.tau_max_s {
            return Err(self.lack(range));
        }
        let block = interval::round_to_count((time_s / sample_period_s).ceil()).max(1);
        let period_s = block as f64 * sample_period_s;
        let is_known = is_raw && period_s >= KNOWN_FROM * range.tau_min_s;
        Ok(Substitute {
            rates_deg_per_h: channel.chunks_exact(block).map(interval::mean).collect(),
            period_s,
            known: is_known.then(|| Sawtooth::three_squares(self.sawtooth.step_arcsec)),
            method: if block > 1 {
                PulseMethod::Means { period_s }
            } else {
                PulseMethod::Words
            },
        })
    }

    /// Why the noise below the pulses cannot be told.
    fn lack(&self, range: FitRange) -> Unavailable {
        let step = plain(to_digits(self.sawtooth.step_arcsec, 6));
        let of_curve = if self.resolution_s().is_finite() {
            format!(
                "lose their phase over {} s, of which a fit needs eight in a ninth of the record",
                plain(to_digits(self.resolution_s(), 3))
            )
        } else {
            format!(
                "do not lose their phase within {} s, a ninth of the record",
                plain(to_digits(range.tau_max_s, 3))
            )
        };
        format!(
            "not bounded: pulses of {step} arcsec {of_curve}, and too few come one after the other for \
             their times to tell it"
        )
        .into()
    }

    /// Largest angle random walk that the words allow, (deg/h) sqrt(s).
    ///
    /// A second difference of the counted angle misses the true one by two pulses at most.
    pub(crate) fn walk_at_most(&self, range: FitRange) -> f64 {
        let of_point = |point: &AllanPoint| {
            let tau_s = point.tau_s;
            let counted = (2.0 * point.variance()).sqrt() * tau_s;
            let most = (counted + 2.0 * self.sawtooth.step_arcsec) / (2.0 * tau_s).sqrt();
            interval::deviation(most, point.degrees_of_freedom).high
        };
        let used = self.points.iter().filter(|it| it.tau_s <= range.tau_max_s);
        used.map(of_point).fold(f64::INFINITY, f64::min)
    }
}
