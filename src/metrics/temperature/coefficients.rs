//! Coefficients of the temperature, their significance, hysteresis, and the words without it.

use statrs::distribution::{ContinuousCDF, StudentsT};

use super::correlated_fit::{CorrelatedFit, fit_correlated, fit_plainly};
use super::keys::{
    APPLIED, BEFORE, BIAS, BIAS_PER_K, BIAS_PER_K_PER_MIN, BIAS_PER_K2, FITTED, HYSTERESIS,
    HYSTERESIS_LEFT, LEFT, MEAN_LENGTH, P_VALUE, RATE, REFERENCE, SCALE_FACTOR_PER_K, STD_LEFT,
    TEMPERATURE, TEMPERATURE_C, TEMPERATURE_METRICS, TIME,
};
use super::means::{WarmMeans, WarmRecord};
use super::without::Warmed;
use crate::metrics::estimate::interval::{mean, sample_variance, student_quantile};
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::metric::MetricKey;
use crate::signal::TemperatureModel;
use crate::units::ratio_to_ppm;

/// Probability below which a coefficient counts as told from nothing.
const SIGNIFICANCE: f64 = 0.05;
/// Part of the rms of the temperature's rate below which it neither rises nor falls.
const STILL: f64 = 0.2;
/// Fewest means of either sense for a hysteresis.
const OF_SENSE_MIN: usize = 10;
/// Least spread of the true rate, over its largest, from which a scale factor is told.
const TRUTH_SPREAD_MIN: f64 = 1e-3;

/// One column of the design.
struct Regressor {
    /// The metric that it gives; none of what stands beside the temperature.
    key: Option<&'static MetricKey>,
    values: Vec<f64>,
    /// From the coefficient to the unit of the metric.
    to_unit: f64,
}

/// A coefficient that was found.
#[derive(Clone, Copy)]
struct Coefficient {
    value: f64,
    deviation: f64,
    freedom: f64,
}

impl Coefficient {
    fn of(fit: &CorrelatedFit, at: usize, to_unit: f64) -> Self {
        Self {
            value: fit.coefficients[at] * to_unit,
            deviation: fit.variances[at].sqrt() * to_unit,
            freedom: fit.freedom,
        }
    }

    fn estimate(&self) -> Estimate {
        Estimate::symmetric(self.value, student_quantile(self.freedom) * self.deviation)
    }

    /// Probability of a coefficient as far from zero where the true one is zero.
    fn p_value(&self) -> f64 {
        let t = (self.value / self.deviation).abs();
        StudentsT::new(0.0, 1.0, self.freedom).map_or(f64::NAN, |law| 2.0 * law.sf(t))
    }

    fn is_significant(&self) -> bool {
        self.p_value() < SIGNIFICANCE
    }
}

/// Enters what a temperature says of a record; gives the significant coefficients with the means, nothing where
/// none is told.
///
/// * `reference_c`: temperature that coefficients are told at; the mean of the record without one.
pub fn measure_temperature(
    record: &WarmRecord,
    reference_c: Option<f64>,
    metrics: &mut ChannelMetrics,
) -> Option<Warmed> {
    match Warmth::of(record, reference_c) {
        Ok(found) => {
            let model = found.enter(metrics)?;
            let means = found.means;
            Some(Warmed { model, means })
        }
        Err(reason) => {
            for key in TEMPERATURE_METRICS {
                metrics.miss(key, reason.clone());
            }
            None
        }
    }
}

/// A record with its coefficients.
struct Warmth {
    means: WarmMeans,
    reference_c: f64,
    /// Kelvins above the reference.
    warmer_k: Vec<f64>,
}

impl Warmth {
    fn of(record: &WarmRecord, reference_c: Option<f64>) -> Result<Self, Unavailable> {
        let means = WarmMeans::of(record)?;
        let present = means.temperature_c.iter().copied();
        let present: Vec<f64> = present.filter(|it| !it.is_nan()).collect();
        // A reference of a tenth is as good as one of fifteen digits, and can be told.
        let reference_c = reference_c.unwrap_or((10.0 * mean(&present)).round() / 10.0);
        let warmer_k = means
            .temperature_c
            .iter()
            .map(|it| it - reference_c)
            .collect();
        Ok(Self {
            means,
            reference_c,
            warmer_k,
        })
    }

    /// The columns of the bias: a constant, both powers, the rate where it is told, and the true rate.
    fn regressors(&self) -> Vec<Regressor> {
        let beside = |values| Regressor {
            key: None,
            values,
            to_unit: 1.0,
        };
        let of = |key, values| Regressor {
            key: Some(key),
            values,
            to_unit: 1.0,
        };
        let mut all = vec![
            beside(vec![1.0; self.warmer_k.len()]),
            of(&BIAS_PER_K, self.warmer_k.clone()),
            of(&BIAS_PER_K2, self.warmer_k.iter().map(|k| k * k).collect()),
        ];
        if self.tells_rate() {
            all.push(of(&BIAS_PER_K_PER_MIN, self.means.rate_k_per_min.clone()));
        }
        if self.tells_scale() {
            let truth = &self.means.truth_deg_per_h;
            all.push(beside(truth.clone()));
            let by_warmth = truth.iter().zip(&self.warmer_k);
            all.push(Regressor {
                to_unit: ratio_to_ppm(1.0),
                ..of(&SCALE_FACTOR_PER_K, by_warmth.map(|(w, k)| w * k).collect())
            });
        }
        all
    }

    /// Whether the rate of the temperature varies beside the temperature itself.
    fn tells_rate(&self) -> bool {
        let squares = self.warmer_k.iter().map(|k| k * k).collect();
        let others = [
            vec![1.0; self.warmer_k.len()],
            self.warmer_k.clone(),
            squares,
        ];
        let left = left_of(&self.means.rate_k_per_min, &others);
        left.is_some_and(|left| self.means.tells_rate(sample_variance(&left).sqrt()))
    }

    /// Whether the true rate varies from mean to mean.
    fn tells_scale(&self) -> bool {
        // The means over a swing do not, whose amplitudes do.
        if !self.means.gain_error.is_empty() {
            return false;
        }
        let truth = self.means.truth_deg_per_h.iter().copied();
        let truth: Vec<f64> = truth.filter(|it| !it.is_nan()).collect();
        let largest = truth.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
        sample_variance(&truth).sqrt() > TRUTH_SPREAD_MIN * largest
    }

    /// Enters coefficients, hysteresis, what is left, and the curve.
    fn enter(&self, metrics: &mut ChannelMetrics) -> Option<TemperatureModel> {
        let regressors = self.regressors();
        let errors = &self.means.error_deg_per_h;
        let mut model = TemperatureModel {
            reference_temperature_c: self.reference_c,
            ..TemperatureModel::default()
        };
        let Some(full) = fit_of(&regressors, errors) else {
            for key in TEMPERATURE_METRICS {
                metrics.miss(key, "the temperature and its rate do not determine them");
            }
            return None;
        };
        let found = |at: usize| Coefficient::of(&full, at, regressors[at].to_unit);
        let is_kept = |at: usize| regressors[at].key.is_none() || found(at).is_significant();
        let kept: Vec<usize> = (0..regressors.len()).filter(|at| is_kept(*at)).collect();
        let columns: Vec<Vec<f64>> = kept
            .iter()
            .map(|at| regressors[*at].values.clone())
            .collect();
        let refit = fit_correlated(&columns, errors);
        for (at, regressor) in regressors.iter().enumerate() {
            let Some(key) = regressor.key else { continue };
            let place = kept.iter().position(|own| *own == at);
            let applied = place.zip(refit.as_ref()).map_or(0.0, |(place, refit)| {
                refit.coefficients[place] * regressor.to_unit
            });
            self.put(key, &found(at), applied, metrics);
            *part_of(&mut model, key) = applied;
        }
        if regressors
            .iter()
            .all(|it| it.key != Some(&SCALE_FACTOR_PER_K))
        {
            self.put_swing_gain(&mut model, metrics);
        }
        let by_rows = |coefficients: &[f64], columns: &[&Vec<f64>]| -> Vec<f64> {
            (0..errors.len())
                .map(|row| {
                    let parts = coefficients.iter().zip(columns);
                    parts.map(|(by, column)| by * column[row]).sum()
                })
                .collect()
        };
        let all: Vec<&Vec<f64>> = regressors.iter().map(|it| &it.values).collect();
        let fitted = by_rows(&full.coefficients, &all);
        self.put_rest(&fitted, &model, metrics);
        for key in [&BIAS_PER_K_PER_MIN, &SCALE_FACTOR_PER_K] {
            if metrics.get(key).is_none() {
                metrics.miss(key, self.lack(key));
            }
        }
        Some(model)
    }

    /// Why a coefficient is not told.
    fn lack(&self, key: &MetricKey) -> &'static str {
        if *key == BIAS_PER_K_PER_MIN {
            "the rate of the temperature does not vary beyond the noise of its readings, beside the \
             temperature itself"
        } else if self.means.truth_deg_per_h.is_empty() {
            "it takes a column of the reference, or a swing"
        } else {
            "the reference does not vary"
        }
    }

    fn put(
        &self,
        key: &'static MetricKey,
        found: &Coefficient,
        applied: f64,
        metrics: &mut ChannelMetrics,
    ) {
        let fields = &mut metrics.put(key, found.estimate()).fields;
        fields.insert(APPLIED, applied);
        fields.insert(P_VALUE, found.p_value());
        fields.insert(REFERENCE, self.reference_c);
    }

    /// Enters the coefficient of the scale factor by the amplitudes of a swing.
    fn put_swing_gain(&self, model: &mut TemperatureModel, metrics: &mut ChannelMetrics) {
        if self.means.gain_error.is_empty() {
            return;
        }
        let columns = [vec![1.0; self.warmer_k.len()], self.warmer_k.clone()];
        if let Some(fit) = fit_correlated(&columns, &self.means.gain_error) {
            let found = Coefficient::of(&fit, 1, ratio_to_ppm(1.0));
            let applied = if found.is_significant() {
                found.value
            } else {
                0.0
            };
            self.put(&SCALE_FACTOR_PER_K, &found, applied, metrics);
            model.scale_factor_ppm_per_k = applied;
        }
    }

    /// Enters what is left, both hystereses and the curve.
    fn put_rest(&self, fitted: &[f64], model: &TemperatureModel, metrics: &mut ChannelMetrics) {
        let means = &self.means;
        let rows = 0..means.time_s.len();
        let left: Vec<f64> = rows
            .clone()
            .map(|row| {
                let (warmth, rate) = (means.temperature_c[row], means.rate_k_per_min[row]);
                // At either end the rate is not known, and where it does not count it is not asked for.
                let rate = if rate.is_nan() && model.bias_deg_per_h_per_k_per_min.abs() <= 0.0 {
                    0.0
                } else {
                    rate
                };
                let truth = means.truth_deg_per_h.get(row).copied().unwrap_or(0.0);
                let by_scale = 1e-6 * model.scale_factor_ppm_per_k * self.warmer_k[row] * truth;
                means.error_deg_per_h[row] - model.bias_deg_per_h(warmth, rate) - by_scale
            })
            .collect();
        let present = |values: &[f64]| -> Vec<f64> {
            let both = values.iter().zip(&left);
            both.filter(|(own, left)| !own.is_nan() && !left.is_nan())
                .map(|(own, _)| *own)
                .collect()
        };
        let deviation = |values: &[f64]| sample_variance(&present(values)).sqrt();
        let metric = metrics.put(&STD_LEFT, Estimate::exact(deviation(&left)));
        metric
            .fields
            .insert(BEFORE, deviation(&means.error_deg_per_h));
        metric.fields.insert(MEAN_LENGTH, means.length_s);
        metric.fields.insert("count", present(&left).len() as f64);
        for (key, values) in [
            (&HYSTERESIS, &means.error_deg_per_h),
            (&HYSTERESIS_LEFT, &left),
        ] {
            match self.hysteresis(values) {
                Some(found) => {
                    let fields = &mut metrics.put(key, found.estimate()).fields;
                    fields.insert(P_VALUE, found.p_value());
                }
                None => metrics.miss(key, NO_BOTH_SENSES),
            }
        }
        let told: Vec<usize> = rows
            .filter(|row| fitted[*row].is_finite() && left[*row].is_finite())
            .filter(|row| means.rate_k_per_min[*row].is_finite())
            .collect();
        let column = |values: &[f64]| told.iter().map(|row| values[*row]).collect();
        metrics.put_curve(
            &TEMPERATURE,
            [
                (&TIME, column(&means.time_s)),
                (&TEMPERATURE_C, column(&means.temperature_c)),
                (&RATE, column(&means.rate_k_per_min)),
                (&BIAS, column(&means.error_deg_per_h)),
                (&FITTED, column(fitted)),
                (&LEFT, column(&left)),
            ],
        );
    }

    /// Rising minus falling, at one temperature.
    fn hysteresis(&self, values: &[f64]) -> Option<Coefficient> {
        let rates = &self.means.rate_k_per_min;
        let present: Vec<f64> = rates
            .iter()
            .map(|it| it * it)
            .filter(|it| !it.is_nan())
            .collect();
        let least = STILL * mean(&present).sqrt();
        let sense = |rate: &f64| match *rate {
            rate if rate.is_nan() => f64::NAN,
            rate if rate > least => 0.5,
            rate if rate < -least => -0.5,
            _ => 0.0,
        };
        let senses: Vec<f64> = rates.iter().map(sense).collect();
        let of = |wanted: f64| {
            senses
                .iter()
                .filter(|own| (*own - wanted).abs() < 0.1)
                .count()
        };
        if of(0.5) < OF_SENSE_MIN || of(-0.5) < OF_SENSE_MIN || !self.overlaps(&senses) {
            return None;
        }
        let columns = [
            vec![1.0; values.len()],
            self.warmer_k.clone(),
            self.warmer_k.iter().map(|k| k * k).collect(),
            senses,
        ];
        let fit = fit_plainly(&columns, values)?;
        Some(Coefficient::of(&fit, 3, 1.0))
    }

    /// Whether the temperatures while it rises and those while it falls have a range in common.
    fn overlaps(&self, senses: &[f64]) -> bool {
        let range = |wanted: f64| {
            let own = senses.iter().zip(&self.warmer_k);
            let own = own.filter(|(sense, _)| (**sense - wanted).abs() < 0.1);
            own.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (_, k)| {
                (low.min(*k), high.max(*k))
            })
        };
        let (rising, falling) = (range(0.5), range(-0.5));
        rising.0.max(falling.0) < rising.1.min(falling.1)
    }
}

/// Why there is no hysteresis.
const NO_BOTH_SENSES: &str = "the temperature does not pass one range both rising and falling";

/// The part of a model that a metric gives.
fn part_of<'a>(model: &'a mut TemperatureModel, key: &MetricKey) -> &'a mut f64 {
    match key {
        key if *key == BIAS_PER_K => &mut model.bias_deg_per_h_per_k,
        key if *key == BIAS_PER_K2 => &mut model.bias_deg_per_h_per_k2,
        key if *key == BIAS_PER_K_PER_MIN => &mut model.bias_deg_per_h_per_k_per_min,
        _ => &mut model.scale_factor_ppm_per_k,
    }
}

fn fit_of(regressors: &[Regressor], values: &[f64]) -> Option<CorrelatedFit> {
    let columns: Vec<Vec<f64>> = regressors.iter().map(|it| it.values.clone()).collect();
    fit_correlated(&columns, values)
}

/// What plain least squares on some columns leave of another, rows with missing numbers left out.
fn left_of(values: &[f64], columns: &[Vec<f64>]) -> Option<Vec<f64>> {
    let rows: Vec<usize> = (0..values.len())
        .filter(|row| values[*row].is_finite() && columns.iter().all(|it| it[*row].is_finite()))
        .collect();
    let at = |row: usize, column: usize| columns[column][rows[row]];
    let matrix = nalgebra::DMatrix::from_fn(rows.len(), columns.len(), at);
    let right = nalgebra::DVector::from_fn(rows.len(), |row, _| values[rows[row]]);
    if rows.len() <= columns.len() {
        return None;
    }
    let by = (matrix.transpose() * &matrix)
        .cholesky()?
        .solve(&(matrix.transpose() * &right));
    Some((right - matrix * by).iter().copied().collect())
}
