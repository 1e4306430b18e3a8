//! The words of a gyro at rest, measured while they come in.

use crate::metrics::allan::extra_terms::{SINE_AMPLITUDE, SINE_PERIOD};
use crate::metrics::allan::noise_fit::{FIT_TAU_PER_RECORD_MAX, FitRange, NoiseFit, fit_noise};
use crate::metrics::allan::noise_identification::identify_by_means;
use crate::metrics::allan::overlapping::averaging_factors;
use crate::metrics::allan::pulses::recognition::PulseWords;
use crate::metrics::allan::stream::{AllanStream, StreamedSum};
use crate::metrics::allan::variants::{
    AllanEstimator, AllanOptions, AllanVariantPoint, FoundSum, points_of,
};
use crate::metrics::estimate::blocks::{
    BlockStream, CoarseStream, RATIO_BLOCKS, equal_block_means, is_sample_or_longer, samples_in,
};
use crate::metrics::estimate::influence::Spread;
use crate::metrics::estimate::interval;
use crate::metrics::estimate::paired::MeanScatter;
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::key::metric::MetricKey;
use crate::metrics::measure::{Recorded, SPECTRUM_POINTS_MAX, explain_absence};
use crate::metrics::motion::mean::{GYRO_REACH, extremes, put_range};
use crate::metrics::motion::steady::{
    Curves, LAGS_MIN, NO_CHANGE, TENTHS, averaging_times_s, enter_allan, enter_mean, measure_bias,
    slow_variance,
};
use crate::metrics::noise::autocovariance::LaggedStream;
use crate::metrics::noise::by_weights::NoiseByWeights;
use crate::metrics::noise::level::put_noise_std;
use crate::metrics::noise::pulse_fit::RecordFit;
use crate::metrics::noise::spectrum::{WelchStream, log_binned, put_spectrum, segment_samples};
use crate::metrics::quality::examine::put_outliers;
use crate::metrics::quality::outliers::{OUTLIERS, OutlierStream};
use crate::metrics::quality::smoothing::SMOOTHING_TIME;
use crate::metrics::record::{Motion, Settings};
use crate::vocabulary::AveragingTimes;

/// Longest averaging factor whose differences start at every sample: a quarter of ten million words.
const DENSE_FACTOR_MAX: usize = 2_500_000;

/// Words from whose number on differences of long averaging times start at some words only.
const THINNED_FROM: usize = 10_000_000;

/// Longest averaging factor that is served, samples.
const FACTOR_MAX: usize = 1 << 40;

/// Words that are taken at a time.
const PIECE: usize = 1 << 17;

/// Most block means of an averaging time that are kept.
const BLOCKS_MAX: usize = 1 << 20;

/// Fewest means of the whole record that its mean is judged by.
const COARSE_MEANS: usize = 1 << 16;

/// Metrics of a log that are not measured of a record that streams, with the reason.
pub static NOT_STREAMED: [(&MetricKey, &str); 3] = [
    (
        &SMOOTHING_TIME,
        "does not stream: the spectrum that shows it is one of the whole record",
    ),
    (
        &SINE_AMPLITUDE,
        "does not stream: a sine is taken out of all words before they are fitted",
    ),
    (
        &SINE_PERIOD,
        "does not stream: a sine is taken out of all words before they are fitted",
    ),
];

/// Why a record is not measured while its words come in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum StreamLack {
    /// The table moves.
    #[error("the metrics of a motion do not stream")]
    Motion,
    /// Another curve than the overlapping Allan deviation.
    #[error("the Allan deviation `{0}` does not stream: expected overlapping")]
    Estimator(&'static str),
    /// All averaging times.
    #[error("the averaging times `all` do not stream: expected octave or decade")]
    AllTimes,
}

/// Measures the words of a gyro at rest while they come in, in memory that hardly grows with their number.
///
/// Mean, standard deviation, extremes, block means, Allan deviations with the noise fitted to them, spectrum
/// and outliers are those of the whole record. By its first words alone are found: the shortest averaging
/// time of the fit, which the settings hold, whether the words count pulses, and how they scatter beside
/// outliers. Behind ten million words differences of averaging times from 2048 words on start a thousandth
/// of it apart, and beyond 2.5 million words averaging times are rounded to as much. What is not measured
/// stands in [`NOT_STREAMED`].
///
/// Kept are the angles of twice the longest dense averaging time, block means up to a million for each
/// averaging time, and a few segments of the spectrum, however long the record is.
pub struct WordStream {
    settings: Settings,
    sample_period_s: f64,
    /// Rate near the mean, deg/h.
    centre: f64,
    samples: usize,
    sum: f64,
    range: [f64; 2],
    counts_pulses: bool,
    allan: AllanStream,
    products: LaggedStream,
    welch: WelchStream,
    blocks: Vec<BlockStream>,
    coarse: CoarseStream,
    outliers: Result<OutlierStream, Unavailable>,
}

impl WordStream {
    /// A record that begins with these words, of which it takes none yet.
    ///
    /// * `settings`: with the shortest averaging time of the fit, as
    ///   [`record_fit_tau_min_s`](crate::metrics::record_fit_tau_min_s) finds it from the first words.
    ///
    /// # Errors
    /// Settings under which a record does not stream.
    pub fn new(
        first_words: &[f64],
        sample_period_s: f64,
        settings: Settings,
    ) -> Result<Self, StreamLack> {
        if settings.motion != Motion::Steady {
            return Err(StreamLack::Motion);
        }
        let AllanOptions {
            estimator, taus, ..
        } = settings.allan;
        if estimator != AllanEstimator::Overlapping {
            return Err(StreamLack::Estimator(estimator.name()));
        }
        if taus == AveragingTimes::All {
            return Err(StreamLack::AllTimes);
        }
        let centre = interval::mean(first_words);
        let own = taus.averaging_factors(FACTOR_MAX);
        let mut factors = [averaging_factors(FACTOR_MAX), own.clone()].concat();
        factors.sort_unstable();
        factors.dedup();
        let times = averaging_times_s(settings.bias_averaging_time_s).map(|(_, time_s)| time_s);
        let times = times
            .into_iter()
            .filter(|time_s| is_sample_or_longer(*time_s, sample_period_s));
        let tau_min_s = settings.fit_tau_min_s;
        Ok(Self {
            counts_pulses: PulseWords::recognise(first_words, sample_period_s, tau_min_s).is_some(),
            allan: AllanStream::of_factors(sample_period_s, DENSE_FACTOR_MAX, factors)
                .thinned_from(THINNED_FROM)
                .with_means(&own),
            products: LaggedStream::new(centre, LAGS_MIN, RATIO_BLOCKS),
            welch: WelchStream::new(segment_samples(first_words.len()), centre),
            blocks: times
                .map(|time_s| BlockStream::new(samples_in(time_s, sample_period_s), BLOCKS_MAX))
                .collect(),
            coarse: CoarseStream::new(COARSE_MEANS),
            outliers: OutlierStream::new(first_words),
            settings,
            sample_period_s,
            centre,
            samples: 0,
            sum: 0.0,
            range: [f64::INFINITY, f64::NEG_INFINITY],
        })
    }

    /// Takes the next words, deg/h, all of which are there.
    pub fn extend(&mut self, rate_deg_per_h: &[f64]) {
        // What waits for the words to come is as long as a piece.
        for words in rate_deg_per_h.chunks(PIECE) {
            self.take(words);
        }
    }

    fn take(&mut self, words: &[f64]) {
        let centre = self.centre;
        self.samples += words.len();
        self.sum += words.iter().map(|word| word - centre).sum::<f64>();
        let [smallest, largest] = extremes(words);
        self.range = [self.range[0].min(smallest), self.range[1].max(largest)];
        // Each has a state of its own, so that the number of threads leaves no trace.
        rayon::scope(|scope| {
            scope.spawn(|_| self.allan.extend(words));
            scope.spawn(|_| self.welch.extend(words));
            scope.spawn(|_| self.products.extend(words));
            scope.spawn(|_| {
                self.blocks.iter_mut().for_each(|it| it.extend(words));
                self.coarse.extend(words);
                if let Ok(outliers) = &mut self.outliers {
                    outliers.extend(words);
                }
            });
        });
    }

    /// Words taken so far.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.samples
    }

    /// What the words measure.
    ///
    /// * `first_index`: index in the log of the first word that was taken.
    #[must_use]
    pub fn finish(mut self, first_index: usize) -> ChannelMetrics {
        let mut metrics = ChannelMetrics::default();
        let mean = self.centre + self.sum / self.samples.max(1) as f64;
        let spectrum = self.welch.spectrum(self.sample_period_s, mean);
        put_spectrum(log_binned(&spectrum, SPECTRUM_POINTS_MAX), &mut metrics);
        put_range(self.range, &mut metrics);
        let fit = self.put_allan(&mut metrics);
        self.put_blocks(fit.as_ref(), &mut metrics);
        self.put_mean(mean, fit.as_ref(), &mut metrics);
        put_noise_std(
            &self.products.finish(mean),
            &NoiseByWeights::none(),
            (self.samples, 1),
            self.sample_period_s,
            &mut metrics,
        );
        let first_stamp_s = (first_index + 1) as f64 * self.sample_period_s;
        match self.outliers.and_then(OutlierStream::finish) {
            Ok(outliers) => {
                let place = (first_index, first_stamp_s, self.sample_period_s);
                put_outliers(&outliers, place, &mut metrics);
            }
            Err(reason) => metrics.miss(&OUTLIERS, reason),
        }
        metrics.keep_finite();
        for (key, reason) in &NOT_STREAMED {
            metrics.miss(key, *reason);
        }
        let recorded = Recorded {
            samples: self.samples,
            sample_period_s: self.sample_period_s,
            has_truth: false,
            has_encoder: false,
        };
        explain_absence(recorded, &self.settings, None, &mut metrics);
        metrics
    }

    /// Enters the curves and the noise terms.
    fn put_allan(&mut self, metrics: &mut ChannelMetrics) -> Option<NoiseFit> {
        let (angles, period_s) = (self.samples + 1, self.sample_period_s);
        let largest = self.samples / 4;
        let sums = self.allan.sums(largest);
        let served = of_factors(&sums, &averaging_factors(largest)).into_iter();
        let points: Vec<_> = served.map(|sum| sum.point(angles, period_s)).collect();
        let duration_s = self.samples as f64 * period_s;
        let range = FitRange {
            tau_min_s: self.settings.fit_tau_min_s,
            tau_max_s: FIT_TAU_PER_RECORD_MAX * duration_s,
        };
        let fitted = if self.range[0] >= self.range[1] {
            Err(NO_CHANGE.into())
        } else if self.counts_pulses {
            Err("does not stream: words that count pulses are fitted as a whole".into())
        } else {
            fit_noise(&points, range)
        };
        let fitted = fitted.map(|fit| RecordFit {
            fit,
            points: points.clone(),
            samples: self.samples,
        });
        let curves = Curves {
            points,
            variant: self.variant(&sums, largest),
            estimator: self.settings.allan.estimator,
            duration_s,
        };
        enter_allan(curves, fitted, metrics)
    }

    /// The curve of the settings.
    fn variant(&self, sums: &[StreamedSum], largest: usize) -> Vec<AllanVariantPoint> {
        let options = &self.settings.allan;
        let factors = options.taus.averaging_factors(largest);
        let found = of_factors(sums, &factors).into_iter().map(|sum| {
            let means = self.allan.means(sum.averaged_samples);
            FoundSum {
                averaged_samples: sum.averaged_samples,
                noise: means.and_then(|means| identify_by_means(means.to_vec(), 2)),
                sum: sum.sum,
                weight: sum.weight,
                count: sum.count,
                possible: sum.count,
            }
        });
        points_of(found, self.samples + 1, self.sample_period_s, options)
    }

    /// Enters the bias stabilities.
    fn put_blocks(&self, fit: Option<&NoiseFit>, metrics: &mut ChannelMetrics) {
        let means_of = |block: usize| {
            let blocks = self.blocks.iter().find(|it| it.block_samples() == block);
            let means = blocks.and_then(BlockStream::means);
            let means = means.map(|means| (means.to_vec(), means.to_vec()));
            means.ok_or_else(|| {
                format!("does not stream beyond {BLOCKS_MAX} blocks of an averaging time").into()
            })
        };
        let times = (self.sample_period_s, self.settings.bias_averaging_time_s);
        measure_bias(times, means_of, fit, metrics);
    }

    /// Enters the mean, whose spread is that of the means of the record in many parts.
    fn put_mean(&self, mean: f64, fit: Option<&NoiseFit>, metrics: &mut ChannelMetrics) {
        let duration_s = self.samples as f64 * self.sample_period_s;
        let means = self.coarse.means();
        let reach = GYRO_REACH.div_ceil(self.samples.div_ceil(means.len().max(1)));
        let fast = MeanScatter::of(means, reach).over(means.len());
        let slow = fit.map_or(0.0, |fit| {
            slow_variance(fit, &equal_block_means(means, TENTHS), duration_s)
        });
        let estimate = fast.plus(Spread::known(slow)).about(mean);
        enter_mean(estimate, None, duration_s, slow, metrics);
    }
}

/// The sums nearest to some averaging factors, rising, each once.
fn of_factors(sums: &[StreamedSum], factors: &[usize]) -> Vec<StreamedSum> {
    let nearest = |factor: &usize| {
        let above = sums.partition_point(|sum| sum.averaged_samples < *factor);
        let near = [above.checked_sub(1), Some(above)].into_iter().flatten();
        let near = near.filter(|place| *place < sums.len());
        near.min_by_key(|place| sums[*place].averaged_samples.abs_diff(*factor))
    };
    let mut places: Vec<usize> = factors.iter().filter_map(nearest).collect();
    places.dedup();
    places.into_iter().map(|place| sums[place]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::catalogue::known_metrics;
    use crate::metrics::noise::memory::record_fit_tau_min_s;
    use crate::metrics::quality::examine::Examination;
    use crate::metrics::record::Record;
    use crate::metrics::{Estimate, measure};
    use crate::random::Streams;
    use crate::signal::Rates;

    const PERIOD_S: f64 = 0.01;

    /// White noise on a walk about a mean, with two glitches.
    fn words(count: usize) -> Vec<f64> {
        let streams = Streams::new(3, 0);
        let (mut white, mut steps) = (vec![0.0; count], vec![0.0; count]);
        streams.stream("white").fill_normal(&mut white);
        streams.stream("walk").fill_normal(&mut steps);
        let mut walk = 15.0;
        let mut words: Vec<f64> = white
            .iter()
            .zip(&steps)
            .map(|(white, step)| {
                walk += 2e-4 * step;
                walk + white
            })
            .collect();
        words[count / 3] += 30.0;
        words[count / 2] -= 20.0;
        words
    }

    fn settings(words: &[f64]) -> Settings {
        Settings {
            motion: Motion::Steady,
            bias_averaging_time_s: 20.0,
            fit_tau_min_s: record_fit_tau_min_s(words, PERIOD_S),
            allan: AllanOptions::default(),
            bridges: Vec::new(),
        }
    }

    fn whole(words: &[f64]) -> ChannelMetrics {
        let record = Record {
            channel_deg_per_h: words,
            raw_deg_per_h: words,
            truth_deg_per_h: Rates::UNKNOWN,
            response_deg_per_h: &[],
            encoder_rad: None,
            sample_period_s: PERIOD_S,
            first_stamp_s: PERIOD_S,
            drift: None,
        };
        let settings = settings(words);
        let mut metrics = measure(&record, &settings, None);
        let examination = Examination::of(&record, &settings);
        let _ = examination.enter(&record, &settings, false, 0, &mut metrics);
        metrics
    }

    fn streamed(words: &[f64], first: usize, piece: usize) -> ChannelMetrics {
        let first = &words[..first];
        let mut stream = WordStream::new(first, PERIOD_S, settings(first)).unwrap();
        for part in words.chunks(piece) {
            stream.extend(part);
        }
        assert_eq!(stream.samples(), words.len());
        stream.finish(0)
    }

    fn assert_close(name: &str, found: f64, wanted: f64, tolerance: f64) {
        let scale = wanted.abs().max(1e-9);
        assert!(
            (found - wanted).abs() <= tolerance * scale,
            "{name}: {found}, want {wanted}"
        );
    }

    /// Whether an interval is about as wide as another.
    fn assert_as_wide(name: &str, found: &Estimate, wanted: &Estimate) {
        let [found, wanted] = [found, wanted].map(|it| it.high - it.low);
        assert!(
            found <= 1.6 * wanted && wanted <= 1.6 * found,
            "{name}: {found} wide, want {wanted}"
        );
    }

    #[test]
    fn a_record_that_streams_has_the_figures_of_the_whole_one() {
        let words = words(120_000);
        let whole = whole(&words);
        let streamed = streamed(&words, words.len(), 7919);
        let mut compared = 0;
        for key in known_metrics() {
            let found = streamed.get(key);
            if let Some((_, reason)) = NOT_STREAMED.iter().find(|(it, _)| *it == *key) {
                assert!(found.is_none() && reason.starts_with("does not stream"));
                continue;
            }
            let Some(wanted) = whole.get(key) else {
                let reasons = [&streamed, &whole].map(|it| it.why_unavailable(key).is_some());
                assert!(found.is_none() && reasons[0] == reasons[1], "{}", key.name);
                continue;
            };
            let found = found.unwrap_or_else(|| panic!("{} is missing", key.name));
            let wanted = &wanted.estimate;
            assert_close(key.name, found.estimate.value, wanted.value, 1e-9);
            assert_as_wide(key.name, &found.estimate, wanted);
            compared += 1;
        }
        assert!(compared >= 10, "{compared}");
        assert_eq!(streamed.outliers, whole.outliers);
        assert_eq!(streamed.outliers.len(), 2);
        for curve in ["allan", "allan_fit", "psd", "autocovariance"] {
            let key = crate::metrics::known_curves()
                .iter()
                .find(|key| key.name == curve)
                .unwrap();
            let columns = whole.curve(key).unwrap();
            let found = streamed.curve(key).unwrap();
            let tolerance = if curve == "autocovariance" {
                1e-4
            } else {
                1e-9
            };
            for (column, wanted) in columns {
                let found = &found[column];
                assert_eq!(found.len(), wanted.len(), "{curve} {column}");
                for (found, wanted) in found.iter().zip(wanted) {
                    let scale = if curve == "autocovariance" {
                        1.0
                    } else {
                        wanted.abs()
                    };
                    assert!(
                        (found - wanted).abs() <= tolerance * scale.max(1e-12),
                        "{curve} {column}: {found} {wanted}"
                    );
                }
            }
        }
        assert_eq!(streamed.noise_fit.is_some(), whole.noise_fit.is_some());
    }

    #[test]
    fn the_pieces_of_a_stream_leave_no_trace() {
        let words = words(90_000);
        let [one, other] = [1000, 65_536].map(|piece| streamed(&words, 40_000, piece));
        for (name, metric) in &one.metrics {
            let wanted = other.metrics[name].estimate.value;
            assert_close(name, metric.estimate.value, wanted, 1e-11);
        }
    }

    #[test]
    fn what_does_not_stream_is_refused_with_the_way_out() {
        let words = words(2000);
        let lack = |change: fn(&mut Settings)| {
            let mut settings = settings(&words);
            change(&mut settings);
            let stream = WordStream::new(&words, PERIOD_S, settings);
            stream.err().expect("it is refused").to_string()
        };
        let swing = lack(|it| it.motion = Motion::Swing { frequency_hz: 1.0 });
        assert_eq!(swing, "the metrics of a motion do not stream");
        let modified = lack(|it| it.allan.estimator = AllanEstimator::Modified);
        assert!(modified.contains("expected overlapping"), "{modified}");
        let all = lack(|it| it.allan.taus = AveragingTimes::All);
        assert!(all.contains("expected octave or decade"), "{all}");
    }
}
