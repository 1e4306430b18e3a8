//! Which words count pulses, and how the noise below them can be found.

use super::answer::Agreement;
use super::passage::Passages;
use super::sawtooth::Sawtooth;
use super::step::common_step;
use crate::metrics::allan::noise_fit::FIT_TAU_PER_RECORD_MAX;
use crate::metrics::allan::overlapping::{AllanPoint, overlapping_allan};
use crate::metrics::estimate::interval;

/// Averaging times, from the one at which pulses lose their phase, that must agree in it.
const AGREEING_TAU_RATIO: f64 = 10.0;

/// Margin of the walk in that: a curve says it with some scatter.
const MARGIN: f64 = 1.3;

/// Longest over shortest averaging time of a fit, at least.
pub(crate) const TAU_RATIO_MIN: f64 = 8.0;

/// How much finer the times between pulses must be than the curve: else the curve tells.
const FINER: f64 = 3.0;

/// Part of the Allan variance that the pulses must have to be compared with it.
const SHARE: f64 = 0.2;

/// They are compared up to such a part of the time in which they lose their phase, and at least up to so
/// many shortest averaging times: further on slow noise adds to them.
const COMPARED_PER_DEPHASING: f64 = 0.125;
const COMPARED_TAU_RATIO: f64 = 4.0;

/// Logarithm of the ratio of variances up to which the curve is that of the pulses, and its scatter in
/// standard errors of as many draws as there are phases.
const DISAGREEMENT: f64 = 0.2;
const SCATTER: f64 = 4.0;

/// Largest Allan variance of pulses, in squares of pulse over averaging time, without any walk; what a walk
/// adds that just does not dephase them; and a factor for chance.
const UNMOVED: f64 = 0.5;
const UNDEPHASED: f64 = 0.3;
const CHANCE: f64 = 2.0;

/// Fall of `tau AVAR` that no rounding of words makes.
const FALL: f64 = 10.0;

/// Words of a gyro that counts pulses.
#[derive(Clone, Debug)]
pub(crate) struct PulseWords {
    /// The sawtooth at the mean rate, dephased by what is known of the walk.
    pub(crate) sawtooth: Sawtooth,
    /// How the curve agrees with it; none where the walk is not known.
    pub(crate) agreement: Option<Agreement>,
    /// Whether the words show that they carry their remainder; few of them cannot.
    pub(crate) carries: bool,
    /// Curve of the words.
    pub(crate) points: Vec<AllanPoint>,
    /// Intervals between pulses, where they tell more than the curve.
    pub(crate) passages: Option<Passages>,
}

impl PulseWords {
    /// Recognises words that count pulses: whole multiples of one step, whose Allan variance is that
    /// of counts that carry their remainder.
    ///
    /// Words whose step is lost in their noise, and all others, are none.
    ///
    /// * `tau_min_s`: averaging time from which on the noise of the gyro itself is white.
    pub(crate) fn recognise(words: &[f64], sample_period_s: f64, tau_min_s: f64) -> Option<Self> {
        let step = common_step(words)?;
        let step_arcsec = step * sample_period_s;
        let tau_max_s = FIT_TAU_PER_RECORD_MAX * words.len() as f64 * sample_period_s;
        let points: Vec<AllanPoint> = overlapping_allan(words, sample_period_s);
        let used: Vec<AllanPoint> = points
            .iter()
            .copied()
            .filter(|point| point.tau_s <= tau_max_s)
            .collect();
        let sawtooth = |white: f64| Sawtooth {
            step_arcsec,
            rate_deg_per_h: interval::mean(words),
            white,
        };
        let curve = walk_of_curve(&used, step_arcsec).map(sawtooth);
        let resolution_s = curve.map_or(f64::INFINITY, |it| {
            it.dephasing_time_s().max(sample_period_s)
        });
        let passages = Passages::new(words, step, sample_period_s)
            .filter(|it| it.period_s * TAU_RATIO_MIN <= tau_max_s)
            .filter(|it| it.period_s * FINER <= resolution_s);
        let best = passages.as_ref().map(|it| sawtooth(it.white)).or(curve);
        let duration_s = words.len() as f64 * sample_period_s;
        let agreement = best.and_then(|sawtooth| {
            let last_s = (COMPARED_PER_DEPHASING * sawtooth.dephasing_time_s())
                .max(COMPARED_TAU_RATIO * tau_min_s);
            let from = used
                .iter()
                .filter(|it| it.tau_s >= tau_min_s * (1.0 - 1e-9));
            let found = agreement(from.filter(|it| it.tau_s <= last_s), &sawtooth)?;
            let holds = found.holds(sawtooth.phases(duration_s));
            holds.then_some((sawtooth, found.told))
        });
        if let Some((sawtooth, agreement)) = agreement {
            return Some(Self {
                sawtooth,
                agreement: Some(agreement),
                carries: true,
                points,
                passages,
            });
        }
        let carries = carries(&used);
        // Pulses whose phase no averaging time loses, however far slow noise takes the angle.
        let is_undecided = best.is_none() && (carries || hardly_moves(&used, step_arcsec));
        let is_unmoved = carries && hardly_moves(&used, step_arcsec);
        (is_undecided || is_unmoved).then(|| Self {
            sawtooth: sawtooth(0.0),
            agreement: None,
            carries,
            points,
            passages: None,
        })
    }

    /// The same for a channel from which motion was taken: the times between pulses still have it.
    pub(crate) fn without_times(self) -> Self {
        Self {
            passages: None,
            ..self
        }
    }

    /// Time over which means of the words tell the noise below the pulses, s.
    pub(crate) fn resolution_s(&self) -> f64 {
        self.sawtooth.dephasing_time_s()
    }
}

/// Square of the angle random walk by the curve at averaging times over which it dephases the pulses;
/// nothing where it does so over none.
fn walk_of_curve(points: &[AllanPoint], step_arcsec: f64) -> Option<f64> {
    let white = |point: &AllanPoint| {
        point.tau_s * point.variance() - Sawtooth::three_squares(step_arcsec) / point.tau_s
    };
    let dephases = |point: &AllanPoint| {
        let sawtooth = Sawtooth {
            step_arcsec,
            rate_deg_per_h: 0.0,
            white: white(point),
        };
        sawtooth.dephasing_time_s() * MARGIN <= point.tau_s
    };
    let within = |first_s: f64| {
        let last_s = first_s * AGREEING_TAU_RATIO;
        let from = points.iter().skip_while(move |it| it.tau_s < first_s);
        from.take_while(move |it| it.tau_s <= last_s)
    };
    let longest = points.last()?.tau_s;
    let first = points
        .iter()
        .take_while(|first| first.tau_s * TAU_RATIO_MIN <= longest)
        .find(|first| within(first.tau_s).all(dephases))?;
    // The shorter times scatter least, and see least of the slow terms.
    within(first.tau_s).map(white).reduce(f64::min)
}

/// Whether a curve is that of pulses that an unknown walk does not dephase: of an angle that hardly
/// moves from one pulse to the next.
///
/// What the pulses make is half a square of them over `tau^2` at most; a walk that does not dephase
/// them over the longest time that a fit may begin with adds three tenths of one at that time.
fn hardly_moves(points: &[AllanPoint], step_arcsec: f64) -> bool {
    let Some(longest) = points.last() else {
        return false;
    };
    let square = step_arcsec * step_arcsec;
    points.iter().all(|point| {
        let walked = UNDEPHASED * TAU_RATIO_MIN * point.tau_s / longest.tau_s;
        let most = CHANCE * (UNMOVED + walked) * square;
        point.variance() * point.tau_s * point.tau_s <= most
    })
}

/// Whether `tau AVAR` falls as no rounding of words makes it: of counts that carry their remainder.
fn carries(points: &[AllanPoint]) -> bool {
    let level = |point: &AllanPoint| point.tau_s * point.variance();
    let first = points.first().map_or(0.0, level);
    points.iter().map(level).any(|it| it * FALL <= first)
}

/// An agreement that is to be judged.
struct Compared {
    told: Agreement,
    /// Logarithm of the ratio of Allan variances found and predicted.
    off: f64,
    /// The same of predicted and of the noise alone.
    of_pulses: f64,
}

impl Compared {
    /// Whether the curve is that of the pulses, and nearer to them than to words without carry.
    fn holds(&self, phases: f64) -> bool {
        let chance = SCATTER * (2.0 / phases.max(1.0)).sqrt();
        self.off.abs() <= (DISAGREEMENT + chance).min(self.of_pulses / 2.0)
    }
}

/// Compares a curve with the sawtooth and its walk where the sawtooth is a good part of it.
fn agreement<'a>(
    points: impl Iterator<Item = &'a AllanPoint>,
    sawtooth: &Sawtooth,
) -> Option<Compared> {
    // Times the square of the averaging time the pulses weigh the same at all of them, and the depth of
    // the dips at whole numbers of them does not matter.
    let (mut found, mut predicted, mut of_noise) = (0.0, 0.0, 0.0);
    let mut tau_range_s = [f64::INFINITY, 0.0];
    for point in points {
        let noise = sawtooth.white / point.tau_s;
        let pulses = sawtooth.allan_variance(point.tau_s);
        if pulses < SHARE * (noise + pulses) {
            continue;
        }
        let weight = point.tau_s * point.tau_s;
        found += weight * point.variance();
        predicted += weight * (noise + pulses);
        of_noise += weight * noise;
        tau_range_s = [
            tau_range_s[0].min(point.tau_s),
            tau_range_s[1].max(point.tau_s),
        ];
    }
    (found > 0.0).then(|| Compared {
        told: Agreement {
            ratio: (found / predicted).sqrt(),
            tau_range_s,
        },
        off: (found / predicted).ln(),
        of_pulses: (predicted / of_noise).ln(),
    })
}
