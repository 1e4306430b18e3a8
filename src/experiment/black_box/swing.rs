//! Delay of a swing that begins at mid-record, and how long it takes to be learned.

use std::f64::consts::{PI, TAU};

use super::Figure;
use super::subject::{Lack, Twins};
use crate::metrics::catalogue::{DELAY_UNDER_SWING, SWING_READAPTATION};
use crate::metrics::{GainUnits, MetricKey, SwingClock, TwinFigure, fit_sine};

/// Keys of what is told here.
pub(super) const KEYS: [&MetricKey; 2] = [&DELAY_UNDER_SWING, &SWING_READAPTATION];

/// Shortest period of the swing, samples.
const PERIOD_MIN: usize = 200;

/// Periods of the swing that the memory must leave: a delay is known to half a period.
const MEMORIES: usize = 4;

/// Fewest cycles in the last quarter of the record.
const CYCLES_MIN: usize = 4;

/// Amplitude in standard deviations of the noise.
const AMPLITUDE: f64 = 10.0;

/// The swing and what it changes in the outputs, from its first word on.
struct Swung {
    swing: Vec<f64>,
    change: Vec<f64>,
    clock: SwingClock,
    period: usize,
}

/// Delay and readaptation.
///
/// * `memory_s`: how long one word is remembered, where that is known.
pub(super) fn swing(twins: &Twins, memory_s: Option<f64>) -> [Figure; 2] {
    match swung(twins, memory_s) {
        Ok(swung) => [delay(&swung), readaptation(&swung)],
        Err(lack) => [Err(lack.again()), Err(lack)],
    }
}

fn swung(twins: &Twins, memory_s: Option<f64>) -> Result<Swung, Lack> {
    let memory_s =
        memory_s.ok_or("the period of a swing goes by the memory, which is not known")?;
    let memory = twins.samples(memory_s);
    let period = PERIOD_MIN.max(MEMORIES * memory);
    let middle = twins.middle();
    let quarter = (twins.words.len() - middle) / 2;
    if quarter < CYCLES_MIN * period {
        return Err(format!(
            "the last quarter of the record holds less than {CYCLES_MIN} cycles of {period} words, \
             {MEMORIES} times the memory"
        )
        .into());
    }
    let amplitude = AMPLITUDE * twins.sigma;
    let of = |since: usize| amplitude * (TAU * (since % period) as f64 / period as f64).sin();
    let words = twins.changed(|at, word| word + if at < middle { 0.0 } else { of(at - middle) });
    let mut change = twins.difference(&words)?;
    change.drain(..middle);
    Ok(Swung {
        swing: (0..change.len()).map(of).collect(),
        change,
        clock: SwingClock {
            frequency_hz: 1.0 / (period as f64 * twins.sample_period_s),
            sample_period_s: twins.sample_period_s,
            first_stamp_s: 0.0,
        },
        period,
    })
}

/// Gain and phase over the whole cycles of the last quarter of the record, rad behind the swing.
fn last(swung: &Swung) -> Result<(f64, f64), Lack> {
    let cycles = swung.change.len() / 2 / swung.period;
    let all = swung.change.len() / swung.period;
    let at = (all - cycles) * swung.period..all * swung.period;
    let fits =
        [&swung.change, &swung.swing].map(|words| fit_sine(&words[at.clone()], &swung.clock));
    match fits {
        [Some(own), Some(swing)] => {
            let behind = (swing.phase_rad - own.phase_rad + PI).rem_euclid(TAU) - PI;
            Ok((own.amplitude / swing.amplitude, behind))
        }
        _ => Err("no sine can be fitted to the outputs".into()),
    }
}

fn delay(swung: &Swung) -> Figure {
    let (gain, behind_rad) = last(swung)?;
    let delay_s = behind_rad / (TAU * swung.clock.frequency_hz);
    let figure = TwinFigure::alone(1e3 * delay_s).with("gain", gain);
    Ok(figure.with("frequency_hz", swung.clock.frequency_hz))
}

fn readaptation(swung: &Swung) -> Figure {
    let (final_gain, _) = last(swung)?;
    let units = GainUnits::of_swing(&swung.change, &swung.swing, &swung.clock);
    let found = units.readaptation(final_gain).map_err(Lack::Reason)?;
    Ok(TwinFigure::alone(found.time_s.value)
        .with("first_gain", found.first_gain)
        .with("final_gain", final_gain)
        .with("window_s", found.window_s))
}
