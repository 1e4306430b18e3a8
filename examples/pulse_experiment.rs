//! The noise fit of words that count pulses of angle, their remainder carried.

use fogbench::metrics::catalogue::{ANGLE_RANDOM_WALK, QUANTISATION};
use fogbench::metrics::{
    AllanOptions, ChannelMetrics, Motion, Record, Settings, measure, record_fit_tau_min_s,
};
use fogbench::random::Streams;

/// Angle random walk of all records, (deg/h) sqrt(s): 0.006 deg/sqrt(h).
const WALK: f64 = 0.36;

fn normals(seed: u64, source: &str, count: usize) -> Vec<f64> {
    let mut values = vec![0.0; count];
    Streams::new(seed, 0)
        .stream(source)
        .fill_normal(&mut values);
    values
}

/// Flicker of B deg/h as Gauss-Markov noise of equal variance per octave, in words of a period.
fn flicker(seed: u64, bias_instability: f64, count: usize, period_s: f64) -> Vec<f64> {
    let mut values = vec![0.0; count];
    let held = (1.0 / period_s).ceil() as usize;
    let octaves = 14;
    let deviation = bias_instability * (std::f64::consts::LN_2 / std::f64::consts::PI * 2.0).sqrt();
    for octave in 0..octaves {
        let time_s = 2.0 * 2.0_f64.powi(octave);
        let decay = (-(held as f64) * period_s / time_s).exp();
        let drives = normals(seed, &format!("flicker {octave}"), count / held + 2);
        let mut state = drives[0];
        for (block, drive) in values.chunks_mut(held).zip(&drives[1..]) {
            for value in block {
                *value += deviation * state;
            }
            state = decay * state + (1.0 - decay * decay).sqrt() * drive;
        }
    }
    values
}

/// Words that count pulses of a walk beside a mean rate and flicker, deg/h.
fn words(seed: u64, step: f64, rate: f64, period_s: f64, duration_s: f64) -> Vec<f64> {
    let count = (duration_s / period_s).round() as usize;
    let mut values = normals(seed, "walk", count);
    let slow = flicker(seed, 0.045, count, period_s);
    // The angle starts anywhere within a pulse.
    let mut left = step * (normals(seed, "start", 1)[0].rem_euclid(1.0) - 0.5);
    for (value, slow) in values.iter_mut().zip(slow) {
        let angle = (rate + slow) * period_s + WALK * period_s.sqrt() * *value + left;
        let pulses = (angle / step).round();
        left = angle - pulses * step;
        *value = pulses * step / period_s;
    }
    values
}

fn measured(values: &[f64], sample_period_s: f64, tau_min_s: f64) -> ChannelMetrics {
    let record = Record {
        channel_deg_per_h: values,
        raw_deg_per_h: values,
        truth_deg_per_h: &[],
        response_deg_per_h: &[],
        encoder_rad: None,
        sample_period_s,
        first_stamp_s: 0.0,
    };
    let settings = Settings {
        motion: Motion::Steady,
        bias_averaging_time_s: 10.0,
        fit_tau_min_s: tau_min_s,
        allan: AllanOptions::default(),
    };
    measure(&record, &settings, None)
}



fn main() {
    let seeds: u64 = std::env::var("SEEDS").ok().and_then(|x| x.parse().ok()).unwrap_or(1);
    let seed0: u64 = std::env::var("SEED0").ok().and_then(|x| x.parse().ok()).unwrap_or(1);
    let rates: Vec<f64> = std::env::var("HZ").unwrap_or("10,100".into()).split(',').map(|x| x.parse().unwrap()).collect();
    let log = std::env::var("LOG").is_ok();
    for hz in rates {
        for rate in [0.0, 8.47] {
            for step in std::env::var("STEPS").unwrap_or("0.02,0.05,0.1,0.2,0.5,1,2,5,10,20".into()).split(',').map(|x| x.parse::<f64>().unwrap()) {
                for seed in seed0..seed0 + seeds {
                    let period = 1.0 / hz;
                    let values = words(seed, step, rate, period, 3600.0);
                    let tau = if log { record_fit_tau_min_s(&values, period) } else { 10.0 * period };
                    let start = std::time::Instant::now();
                    let m = measured(&values, period, tau);
                    let show = |key| match m.metric(key) {
                        Ok(x) => format!("{:.5} [{:.5} {:.5}]", x.value, x.low, x.high),
                        Err(e) => format!("- {e}"),
                    };
                    let sheet = m.noise_fit.as_ref();
                    println!(
                        "{hz} Hz v {rate} L {step} s{seed} tau {tau:.4}: N {} {} | Q {} (true {:.5}) {} | p {:?} {:.2?}",
                        show(&ANGLE_RANDOM_WALK),
                        m.pulse_words.get(ANGLE_RANDOM_WALK.name).map_or("", String::as_str),
                        show(&QUANTISATION),
                        step / 12f64.sqrt(),
                        m.pulse_words.get(QUANTISATION.name).map_or("UNRECOGNISED", String::as_str),
                        sheet.map(|s| s.number("p_value").unwrap()),
                        start.elapsed()
                    );
                }
            }
        }
    }
}
