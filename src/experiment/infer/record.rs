//! Figures of one record in closed form, again and again with other numbers.

use std::sync::Arc;

use crate::experiment::infer::forms::Form;
use crate::experiment::infer::geometry::{BLOCKS_MAX, Geometries, Staircase, staircase};
use crate::experiment::infer::response::{bandwidth_hz, line, sine};
use crate::filters::FilterConfig;
use crate::gyro::{self, GyroConfig, WordNoise};
use crate::inference::Forecast;
use crate::metrics::{
    AllanGeometry, BlockGeometry, ChannelTheory, ExpectedFigure, NoiseCoefficients, Words,
    lags_needed, samples_in,
};
use crate::scenario::{MotionClass, MotionConfig, Movable, NotMovable, Resolved};
use crate::signal::FilterShape;
use crate::turntable::earth_rate_rad_per_s;
use crate::units::{
    deg_per_h_per_sqrt_h_to_deg_per_h_per_sqrt_s, deg_per_s_to_rad_per_s,
    deg_per_sqrt_h_to_deg_per_h_sqrt_s, rad_per_s_to_deg_per_h, ratio_to_ppm, s_to_ms,
};

/// Fewest lags of the autocovariance: Bartlett's formula reaches as far.
const LAGS_MIN: usize = 16;
/// Lags over which an Allan variance takes the noise of the words to be correlated.
const ALLAN_LAGS: usize = 64;

/// Why a figure has no closed form.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(crate) enum Lack {
    /// Nobody knows the channel.
    #[error("no channel `{name}`: expected one of {known}")]
    Channel {
        /// What was asked for.
        name: String,
        /// What there is.
        known: String,
    },
    /// The blocks of a bias stability are too few or too many.
    #[error("{length_s} s do not hold from 2 to {BLOCKS_MAX} blocks of {block_s} s")]
    Blocks {
        /// Length of the record, s.
        length_s: f64,
        /// Averaging time, s.
        block_s: f64,
    },
    /// The record is none of which it holds.
    #[error("it has no closed form {0}")]
    Form(&'static str),
    /// The metric is simulated alone.
    #[error("it has no closed form")]
    Metric,
    /// The record does not hold the averaging time twice, or a word is longer.
    #[error("{time_s} s are shorter than a word or longer than half of {length_s} s")]
    AveragingTime {
        /// Averaging time, s.
        time_s: f64,
        /// Length of the record, s.
        length_s: f64,
    },
    /// Theory of filters ends.
    #[error("{0}")]
    Theory(&'static str),
}

/// A channel of a record.
#[derive(Clone, Debug)]
struct Channel {
    name: String,
    /// None of raw.
    shape: Option<FilterShape>,
}

/// A figure of a record.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Figure {
    /// Place among the figures of the problem.
    pub(crate) index: usize,
    /// Place among the channels of the record.
    channel: usize,
    form: Form,
}

/// A record of which figures are forecast.
#[derive(Clone, Debug)]
pub(crate) struct RecordTheory {
    movable: Movable,
    /// Which parameters move its keys, in the order of these.
    parameters: Vec<usize>,
    channels: Vec<Channel>,
    figures: Vec<Figure>,
    lags: usize,
    geometries: Vec<(f64, Arc<BlockGeometry>)>,
    /// Averaging times of the Allan curve that are asked for, s, and what follows from them.
    allan: (Vec<f64>, Option<AllanGeometry>),
    staircase: Option<Staircase>,
}

/// What one set of numbers makes of the words.
struct Moment {
    words: Words,
    walk: f64,
    coefficients: NoiseCoefficients,
}

impl RecordTheory {
    /// A record with keys to move.
    ///
    /// * `keys`: with the parameter that moves each.
    ///
    /// # Errors
    /// What is wrong with a key, by its place.
    pub(crate) fn new(resolved: &Resolved, keys: &[(String, usize)]) -> Result<Self, NotMovable> {
        let written: Vec<String> = keys.iter().map(|(key, _)| key.clone()).collect();
        let movable = resolved.movable(&written)?;
        let scenario = movable.scenario();
        let period_s = gyro::sample_period_s(&scenario.gyro);
        let raw = Channel {
            name: "raw".to_owned(),
            shape: None,
        };
        let filters = scenario.filters.iter().map(|filter| Channel {
            name: filter.name.clone(),
            shape: shape_of(filter, period_s),
        });
        let channels: Vec<Channel> = std::iter::once(raw).chain(filters).collect();
        let shapes = channels.iter().filter_map(|channel| channel.shape.as_ref());
        let lags = shapes.map(lags_needed).fold(LAGS_MIN, usize::max);
        let staircase = staircase(scenario);
        Ok(Self {
            parameters: keys.iter().map(|(_, parameter)| *parameter).collect(),
            channels,
            figures: Vec::new(),
            lags,
            geometries: Vec::new(),
            allan: (Vec::new(), None),
            staircase,
            movable,
        })
    }

    /// Parameters that move its keys, each once.
    pub(super) fn acting(&self) -> Vec<usize> {
        let mut acting = self.parameters.clone();
        acting.sort_unstable();
        acting.dedup();
        acting
    }

    /// Takes a figure in.
    ///
    /// * `name`: channel.
    ///
    /// # Errors
    /// Why it has no closed form here.
    pub(super) fn add(
        &mut self,
        index: usize,
        (name, form): (&str, Form),
        known: &mut Geometries,
    ) -> Result<(), Lack> {
        let found = self
            .channels
            .iter()
            .position(|channel| channel.name == name);
        let channel = found.ok_or_else(|| {
            let known = self.channels.iter().map(|channel| channel.name.as_str());
            Lack::Channel {
                name: name.to_owned(),
                known: known.collect::<Vec<_>>().join(", "),
            }
        })?;
        self.supports(form, channel)?;
        let period_s = gyro::sample_period_s(&self.movable.scenario().gyro);
        if let Form::Allan(time_s) = form {
            self.add_allan(time_s, period_s)?;
        }
        if let Form::Autocovariance(lag_s) = form {
            let taps = self.channels[channel].shape.as_ref().map_or(0, lags_needed);
            self.lags = self
                .lags
                .max(lag_samples(lag_s, period_s) + taps + LAGS_MIN);
        }
        if let Form::Blocks(time_s) = form {
            let scenario = self.movable.scenario();
            let time_s = time_s.unwrap_or(scenario.bias_averaging_time_s);
            let count = samples_in(scenario.duration_s, period_s) / samples_in(time_s, period_s);
            let geometry = known
                .of(time_s, count, scenario.warm_up_s)
                .ok_or(Lack::Blocks {
                    length_s: scenario.duration_s,
                    block_s: time_s,
                })?;
            self.geometries.push((time_s, geometry));
        }
        self.figures.push(Figure {
            index,
            channel,
            form,
        });
        Ok(())
    }

    /// Takes an averaging time of the Allan curve in.
    fn add_allan(&mut self, time_s: f64, period_s: f64) -> Result<(), Lack> {
        let length_s = self.movable.scenario().duration_s;
        self.lags = self.lags.max(ALLAN_LAGS);
        self.allan.0.push(time_s);
        self.allan.1 = AllanGeometry::new(&self.allan.0, period_s, length_s);
        if self.allan.1.is_some() {
            return Ok(());
        }
        self.allan.0.pop();
        self.allan.1 = AllanGeometry::new(&self.allan.0, period_s, length_s);
        Err(Lack::AveragingTime { time_s, length_s })
    }

    /// Whether the record is one of which the form holds.
    fn supports(&self, form: Form, channel: usize) -> Result<(), Lack> {
        let scenario = self.movable.scenario();
        let no_form = |what| Err(Lack::Form(what));
        if scenario.gyro.assembly.is_some() {
            return no_form("for three axes");
        }
        let motion = scenario.measured_motion();
        let class = motion.class();
        let is_swing = matches!(
            class,
            MotionClass::Swing {
                is_from_rest: false,
                ..
            }
        );
        let is_steps = matches!(class, MotionClass::Steps(_));
        let wants_swing = matches!(form, Form::DelayVsRaw | Form::DelayVsTruth);
        let wants_steps = matches!(form, Form::Scale | Form::Nonlinearity);
        match form {
            _ if wants_swing && !is_swing => return no_form("without a swing"),
            _ if wants_steps && self.staircase.is_none() => {
                return no_form("without steps of the rate");
            }
            Form::Bandwidth | Form::Allan(_) if channel > 0 => return no_form("of a filter"),
            Form::Allan(_) | Form::Autocovariance(_) if is_swing => {
                return no_form("in a swing");
            }
            Form::Bandwidth if !matches!(class, MotionClass::MultiSine { .. }) => {
                return no_form("without several sines");
            }
            _ if !wants_steps && is_steps => return no_form("under steps of the rate"),
            Form::Bandwidth => {}
            _ if matches!(
                class,
                MotionClass::MultiSine { .. }
                    | MotionClass::Campaign(_)
                    | MotionClass::General
                    | MotionClass::Swing {
                        is_from_rest: true,
                        ..
                    }
            ) =>
            {
                return no_form("under this motion");
            }
            _ => {}
        }
        self.supports_filter(form, channel)
    }

    /// Whether the form holds of a channel, where that is a filter.
    fn supports_filter(&self, form: Form, channel: usize) -> Result<(), Lack> {
        let no_form = |what| Err(Lack::Form(what));
        let Some(own) = self.channels.get(channel).filter(|_| channel > 0) else {
            return Ok(());
        };
        let Some(shape) = &own.shape else {
            return no_form("of words from outside");
        };
        // Whatever the noise, the same question has the same answer.
        let probe = Words {
            autocovariance: (0..self.lags)
                .map(|lag| if lag == 0 { 1.0 } else { 0.0 })
                .collect(),
            mean_deg_per_h: 1.0,
            walk_scatter: 0.0,
            slow_deviation_deg_per_h: 0.0,
            sine: None,
            period_s: 1.0,
            warm_up_s: 1.0,
            duration_s: 1.0,
        };
        let theory = ChannelTheory::of_filter(shape, &probe).map_err(Lack::Theory)?;
        if matches!(form, Form::Autocovariance(_)) {
            if theory.gain_variance_s > 0.0 {
                return no_form("of weights that learn");
            }
            if theory.weights().is_none() {
                return no_form("of an infinite response");
            }
        }
        if matches!(form, Form::Scale | Form::Nonlinearity) && theory.gain_variance_s > 0.0 {
            return no_form("of weights that learn under steps of the rate");
        }
        Ok(())
    }

    /// Forecasts at values of the parameters; none where no gyro has them.
    ///
    /// Known noise of a gyro is taken from `shared`, which records of one gyro fill.
    pub(crate) fn forecast(
        &mut self,
        values: &[f64],
        shared: &mut Vec<(GyroConfig, WordNoise)>,
        into: &mut dyn FnMut(usize, Forecast),
        correlate: &mut dyn FnMut(usize, usize, f64),
    ) -> Option<()> {
        let own = self.parameters.iter().map(|parameter| values[*parameter]);
        self.movable.at(own);
        let moment = self.moment(shared)?;
        let theories: Option<Vec<ChannelTheory>> = self
            .channels
            .iter()
            .enumerate()
            .map(|(index, channel)| {
                let is_asked = self.figures.iter().any(|figure| figure.channel == index);
                match &channel.shape {
                    Some(shape) if is_asked => ChannelTheory::of_filter(shape, &moment.words).ok(),
                    _ => Some(ChannelTheory::raw()),
                }
            })
            .collect();
        let theories = theories?;
        for figure in &self.figures {
            let forecast = self.figure(figure, &moment, &theories[figure.channel])?;
            (forecast.value.is_finite() && forecast.deviation.is_finite()).then_some(())?;
            into(figure.index, forecast);
        }
        for (place, one) in self.figures.iter().enumerate() {
            for other in &self.figures[place + 1..] {
                let own = (one, &theories[one.channel]);
                let against = (other, &theories[other.channel]);
                let correlation = self.correlation(own, against, &moment);
                if correlation.abs() > 1e-3 {
                    let (first, second) = (one.index.min(other.index), one.index.max(other.index));
                    correlate(first, second, correlation.clamp(1e-9 - 1.0, 1.0 - 1e-9));
                }
            }
        }
        Some(())
    }

    /// The words that the scenario as it stands makes.
    fn moment(&self, shared: &mut Vec<(GyroConfig, WordNoise)>) -> Option<Moment> {
        let scenario = self.movable.scenario();
        let known = shared.iter().find(|(config, noise)| {
            noise.autocovariance_deg2_per_h2.len() >= self.lags && *config == scenario.gyro
        });
        let noise = match known {
            Some((_, noise)) => noise.clone(),
            None => {
                let noise = gyro::word_noise(&scenario.gyro, self.lags.max(LAGS_MIN)).ok()?;
                shared.push((scenario.gyro.clone(), noise.clone()));
                noise
            }
        };
        let slow = &scenario.gyro.slow_noise;
        let walk = noise.angle_random_walk_deg_per_sqrt_h;
        let rotation = match &scenario.turntable.motion {
            MotionConfig::Rotation(rotation) => deg_per_s_to_rad_per_s(rotation.rate_deg_per_s),
            _ => 0.0,
        };
        let rate = earth_rate_rad_per_s(&scenario.turntable.site) + rotation;
        let mean = gyro::expected_mean_rate_rad_per_s(&scenario.gyro, rate);
        let coefficients = NoiseCoefficients {
            angle_random_walk_deg_per_h_sqrt_s: deg_per_sqrt_h_to_deg_per_h_sqrt_s(walk),
            bias_instability_deg_per_h: slow.bias_instability_deg_per_h,
            rate_random_walk_deg_per_h_per_sqrt_s: deg_per_h_per_sqrt_h_to_deg_per_h_per_sqrt_s(
                slow.rate_random_walk_deg_per_h_per_sqrt_h,
            ),
            ..NoiseCoefficients::default()
        };
        let walked = (scenario.duration_s / 3.0).sqrt();
        Some(Moment {
            words: Words {
                autocovariance: noise.autocovariance_deg2_per_h2,
                mean_deg_per_h: rad_per_s_to_deg_per_h(mean),
                walk_scatter: noise.walk_scatter_by_level,
                slow_deviation_deg_per_h: coefficients.bias_instability_deg_per_h
                    + coefficients.rate_random_walk_deg_per_h_per_sqrt_s * walked,
                sine: sine(scenario),
                period_s: noise.sample_period_s,
                warm_up_s: scenario.warm_up_s,
                duration_s: scenario.duration_s,
            },
            walk,
            coefficients,
        })
    }

    /// The forecast of one figure.
    fn figure(&self, figure: &Figure, moment: &Moment, theory: &ChannelTheory) -> Option<Forecast> {
        let Moment {
            words,
            walk,
            coefficients,
        } = moment;
        let plain = |expected: ExpectedFigure| Forecast::normal(expected.value, expected.deviation);
        let scaled = |expected: ExpectedFigure, by: f64| {
            Forecast::normal(expected.value * by, expected.deviation * by.abs())
        };
        Some(match figure.form {
            Form::Walk => plain(theory.angle_random_walk(*walk, words)),
            Form::WalkOverGain => plain(ChannelTheory::raw().angle_random_walk(*walk, words)),
            Form::Blocks(_) => {
                let geometry = self.geometry(figure.form)?;
                let expected = geometry.expected(theory, coefficients, words.mean_deg_per_h);
                Forecast::squares(expected.square, expected.freedom)
            }
            Form::Gain => plain(theory.gain_over_record(words)),
            Form::Mean => {
                let noise =
                    coefficients.angle_random_walk_deg_per_h_sqrt_s / words.duration_s.sqrt();
                let slow = words.slow_deviation_deg_per_h;
                let gain = theory.gain_over_record(words).deviation * words.mean_deg_per_h;
                let deviation = (theory.dc_gain * noise.hypot(slow)).hypot(gain);
                Forecast::normal(theory.dc_gain * words.mean_deg_per_h, deviation)
            }
            Form::Noise => plain(theory.noise_std(words)),
            Form::NoiseGain => noise_gain(theory, words),
            Form::DelayVsRaw => scaled(theory.delay_s(words)?, s_to_ms(1.0)),
            Form::DelayVsTruth => self.delay_behind_truth(moment, theory)?,
            Form::Scale => {
                let staircase = self.staircase.as_ref()?;
                let (error, _) = line(self.movable.scenario(), staircase);
                let density = coefficients.angle_random_walk_deg_per_h_sqrt_s;
                let deviation = staircase.slope_deviation * density;
                Forecast::normal(ratio_to_ppm(error), ratio_to_ppm(deviation))
            }
            Form::Nonlinearity => {
                let staircase = self.staircase.as_ref()?;
                let (_, largest) = line(self.movable.scenario(), staircase);
                let density = coefficients.angle_random_walk_deg_per_h_sqrt_s;
                let noise = staircase.largest;
                let value = largest.hypot(noise.value * density);
                Forecast::normal(ratio_to_ppm(value), ratio_to_ppm(noise.deviation * density))
            }
            Form::Bandwidth => Forecast::normal(bandwidth_hz(self.movable.scenario())?, 0.0),
            Form::Allan(time_s) => {
                let (place, geometry) = self.allan(time_s)?;
                let expected = geometry.expected(place, words, coefficients);
                Forecast::squares(expected.variance, expected.freedom)
            }
            Form::Autocovariance(lag_s) => {
                plain(theory.autocovariance(lag_samples(lag_s, words.period_s), words))
            }
        })
    }

    /// The geometry of the blocks of a form.
    fn geometry(&self, form: Form) -> Option<&BlockGeometry> {
        let Form::Blocks(time_s) = form else {
            return None;
        };
        let time_s = time_s.unwrap_or(self.movable.scenario().bias_averaging_time_s);
        let found = self
            .geometries
            .iter()
            .find(|(own, _)| own.to_bits() == time_s.to_bits())?;
        Some(&found.1)
    }

    /// Delay behind the true rate at a swing.
    fn delay_behind_truth(&self, moment: &Moment, theory: &ChannelTheory) -> Option<Forecast> {
        let words = &moment.words;
        let behind = theory.delay_s(words)?;
        let sine = words.sine?;
        let scenario = self.movable.scenario();
        let response = gyro::word_response(&scenario.gyro, &[sine.frequency_hz]).ok()?;
        let (_, phase) = *response.first()?;
        let angular = std::f64::consts::TAU * sine.frequency_hz;
        // Of a sine of amplitude A in white noise over T: 2 N^2 / (A^2 T), in phase squared.
        let density = moment.coefficients.angle_random_walk_deg_per_h_sqrt_s;
        let fitted = density * (2.0 / words.duration_s).sqrt() / sine.amplitude_deg_per_h / angular;
        let value = behind.value - phase / angular;
        Some(Forecast::normal(
            s_to_ms(value),
            s_to_ms(fitted.hypot(behind.deviation)),
        ))
    }

    /// Place of an averaging time among those of the Allan curve, with their geometry.
    fn allan(&self, time_s: f64) -> Option<(usize, &AllanGeometry)> {
        let (times, geometry) = &self.allan;
        let place = times
            .iter()
            .position(|own| own.to_bits() == time_s.to_bits())?;
        Some((place, geometry.as_ref()?))
    }

    /// Correlation of two figures of the record.
    fn correlation(
        &self,
        (one, own): (&Figure, &ChannelTheory),
        (two, other): (&Figure, &ChannelTheory),
        moment: &Moment,
    ) -> f64 {
        let words = &moment.words;
        match (one.form, two.form) {
            (Form::Blocks(first), Form::Blocks(second)) => {
                let default_s = self.movable.scenario().bias_averaging_time_s;
                let [one_s, two_s] = [first, second].map(|own| own.unwrap_or(default_s));
                if one_s.to_bits() != two_s.to_bits() {
                    return 0.0;
                }
                let coefficients = &moment.coefficients;
                self.geometry(one.form).map_or(0.0, |geometry| {
                    geometry.correlation((own, other), coefficients, words.mean_deg_per_h)
                })
            }
            // What the fit and the closed form leave is common, what the gain scatters is not.
            (Form::Walk, Form::Walk) => {
                let raw = ChannelTheory::raw().angle_random_walk(moment.walk, words);
                let common = raw.deviation / raw.value;
                let part = |theory: &ChannelTheory| {
                    let walk = theory.angle_random_walk(moment.walk, words);
                    common / (walk.deviation / walk.value)
                };
                part(own) * part(other)
            }
            (Form::Allan(first), Form::Allan(second)) => {
                let (first, second) = (self.allan(first), self.allan(second));
                let both = first.zip(second);
                both.map_or(0.0, |((first, geometry), (second, _))| {
                    geometry.correlation(first, second, &moment.coefficients)
                })
            }
            (Form::Autocovariance(first), Form::Autocovariance(second)) => {
                let [first, second] =
                    [first, second].map(|lag_s| lag_samples(lag_s, words.period_s));
                own.autocovariance_correlation(first, (other, second), words)
            }
            (Form::Nonlinearity, Form::Nonlinearity) | (Form::Scale, Form::Scale) => 1.0,
            _ => 0.0,
        }
    }
}

/// Words of a lag; none of one below half a word.
fn lag_samples(lag_s: f64, period_s: f64) -> usize {
    if lag_s < 0.5 * period_s {
        0
    } else {
        samples_in(lag_s, period_s)
    }
}

/// Noise power over that of raw.
fn noise_gain(theory: &ChannelTheory, words: &Words) -> Forecast {
    let own = theory.noise_std(words);
    let raw = ChannelTheory::raw().noise_std(words);
    let ratio = own.value / raw.value;
    let relative = (own.deviation / own.value).powi(2) - (raw.deviation / raw.value).powi(2);
    Forecast::normal(
        ratio * ratio,
        2.0 * ratio * ratio * relative.max(0.0).sqrt(),
    )
}

/// What a filter weighs; none of words from outside.
fn shape_of(filter: &FilterConfig, period_s: f64) -> Option<FilterShape> {
    let settings = filter.kind.settings();
    if let Some(pipeline) = settings.hardware() {
        return Some(pipeline.filter(0).ok()?.shape());
    }
    Some(settings.build(period_s)?.shape())
}
