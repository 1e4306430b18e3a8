//! The words of a record without what coefficients say of its temperature.

use super::means::{WarmMeans, WarmRecord};
use crate::metrics::estimate::interval::sample_variance;
use crate::signal::TemperatureModel;

/// The significant coefficients of a record, and its means.
#[derive(Clone, Debug)]
pub struct Warmed {
    /// The coefficients, those that are not significant 0.
    pub model: TemperatureModel,
    pub(super) means: WarmMeans,
}

impl Warmed {
    /// The words of the record without what the coefficients say of their temperature; nothing where none
    /// is significant.
    #[must_use]
    pub fn words_without(&self, record: &WarmRecord) -> Option<Vec<f64>> {
        (!self.model.is_flat()).then(|| {
            let rate_k_per_min = &self.means.rate_k_per_min;
            words_by(&self.model, record, &self.means, rate_k_per_min)
        })
    }

    /// Lowest and highest temperature of the means, deg C.
    #[must_use]
    pub fn range_c(&self) -> (f64, f64) {
        self.means.range_c()
    }
}

/// Words as they would be at the temperature of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct WarmWords {
    /// Words, deg/h; NaN where one is missing.
    pub words_deg_per_h: Vec<f64>,
    /// Lowest and highest temperature, deg C.
    pub range_c: (f64, f64),
    /// Whether the rate of the temperature is told from the noise of its readings; else it is taken to be 0.
    pub tells_rate: bool,
}

/// The words of a record as they would be at the reference of a model that another record has shown; nothing
/// where no temperature is known.
#[must_use]
pub fn words_at_reference(model: &TemperatureModel, record: &WarmRecord) -> Option<WarmWords> {
    let means = WarmMeans::of_any(record)?;
    let tells_rate = tells_rate(&means);
    let rate_k_per_min = match tells_rate {
        true => means.rate_k_per_min.as_slice(),
        false => &[],
    };
    Some(WarmWords {
        words_deg_per_h: words_by(model, record, &means, rate_k_per_min),
        range_c: means.range_c(),
        tells_rate,
    })
}

/// Rates of the temperature at the words of a record, K/min; nothing where they are not told from the noise of its
/// readings.
#[must_use]
pub fn temperature_rates_k_per_min(record: &WarmRecord) -> Option<Vec<f64>> {
    let means = WarmMeans::of_any(record).filter(tells_rate)?;
    let mut rate = Between::of(&means.time_s, &means.rate_k_per_min);
    let words = 0..record.words_deg_per_h.len();
    let times = words.map(|index| record.first_stamp_s + index as f64 * record.sample_period_s);
    Some(times.map(|time_s| rate.at(time_s)).collect())
}

/// Whether the rate of the temperature is told from the noise of its readings.
fn tells_rate(means: &WarmMeans) -> bool {
    let present = means.rate_k_per_min.iter().copied();
    let present: Vec<f64> = present.filter(|rate| rate.is_finite()).collect();
    means.tells_rate(sample_variance(&present).sqrt())
}

/// The words of a record at the reference of a model.
///
/// The temperature at a word is that between the means on either side, as a thermometer is read in steps.
fn words_by(
    model: &TemperatureModel,
    record: &WarmRecord,
    means: &WarmMeans,
    rate_k_per_min: &[f64],
) -> Vec<f64> {
    let mut warmth = Between::of(&means.time_s, &means.temperature_c);
    let mut rate = Between::of(&means.time_s, rate_k_per_min);
    let words = record.words_deg_per_h.iter().enumerate();
    let words = words.map(|(index, word)| {
        let time_s = record.first_stamp_s + index as f64 * record.sample_period_s;
        model.compensated(*word, warmth.at(time_s), rate.at(time_s))
    });
    words.collect()
}

/// Values at rising times, with straight lines between them, held at either end; missing ones left out.
struct Between {
    points: Vec<(f64, f64)>,
    behind: usize,
}

impl Between {
    fn of(times: &[f64], values: &[f64]) -> Self {
        let points = times.iter().copied().zip(values.iter().copied());
        Self {
            points: points.filter(|(_, value)| value.is_finite()).collect(),
            behind: 0,
        }
    }

    /// The value at a time no earlier than the one before; 0 without any.
    fn at(&mut self, time: f64) -> f64 {
        let is_behind = |point: Option<&(f64, f64)>| point.is_some_and(|(at, _)| *at <= time);
        while is_behind(self.points.get(self.behind + 1)) {
            self.behind += 1;
        }
        let at = |index: usize| self.points.get(index).copied();
        match (at(self.behind), at(self.behind + 1)) {
            (Some(one), Some(next)) => {
                let part = ((time - one.0) / (next.0 - one.0)).clamp(0.0, 1.0);
                one.1 + part * (next.1 - one.1)
            }
            (Some(one), None) => one.1,
            (None, _) => 0.0,
        }
    }
}
