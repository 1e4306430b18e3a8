//! Motion that is fast against the rate words: amplitude, phase and images.

use std::f64::consts::TAU;

use fogbench::gyro::{Fidelity, Gyro, GyroConfig, word_period_s, word_response};
use fogbench::random::Streams;
use fogbench::signal::{MotionSegment, cubics_per_word};
use fogbench::turntable::{MotionConfig, SwingConfig, Turntable, TurntableConfig};

use crate::support::assert_close;
use crate::support::gyro_cases::silent_gyro;

/// Gain, phase (rad) and what is left of the words over their amplitude, at a frequency.
fn measured(gyro: &GyroConfig, fidelity: Fidelity, frequency_hz: f64, cubics: usize) -> [f64; 3] {
    const SETTLING: usize = 400;
    const WORDS: usize = 4000;
    let period_s = word_period_s(gyro);
    let reference = TurntableConfig::reference();
    let motion = MotionConfig::Swing(SwingConfig {
        rate_amplitude_deg_per_s: Some(0.01),
        angle_amplitude_deg: None,
        frequency_hz,
        soft_start_s: 0.0,
        from_rest: true,
    });
    let mut table = Turntable::new(
        &TurntableConfig {
            motion,
            ..reference
        },
        0.0,
        period_s / cubics as f64,
    );
    let mut gyro =
        Gyro::new(gyro, fidelity, 1.0, &Streams::new(1, 0)).expect("a gyro of the reference");
    // Normal equations of sine, cosine and mean.
    let (mut normal, mut right) = (nalgebra::Matrix3::zeros(), nalgebra::Vector3::zeros());
    let mut record = Vec::new();
    for word in 0..SETTLING + WORDS {
        let segments: Vec<MotionSegment> = (0..cubics).map(|_| table.next_segment()).collect();
        let rate = gyro.next_word_over(&segments);
        if word >= SETTLING {
            let angle = TAU * (frequency_hz * period_s * (word + 1) as f64).fract();
            let row = nalgebra::Vector3::new(angle.sin(), angle.cos(), 1.0);
            normal += row * row.transpose();
            right += row * rate;
            record.push((row, rate));
        }
    }
    let fit = normal.lu().solve(&right).expect("a sine beside a mean");
    let squares: f64 = record
        .iter()
        .map(|(row, rate)| (rate - fit.dot(row)).powi(2))
        .sum();
    let amplitude = fit[0].hypot(fit[1]);
    [
        amplitude / 36.0,
        fit[1].atan2(fit[0]),
        (squares / WORDS as f64).sqrt() / amplitude,
    ]
}

#[test]
fn a_word_is_split_into_as_many_cubics_as_five_ppm_need() {
    assert_eq!(cubics_per_word(0.0, 1.0), 1);
    assert_eq!(cubics_per_word(10.0, 2.5e-4), 1);
    assert_eq!(cubics_per_word(1.0 / 26.0, 1.0), 1);
    assert_eq!(cubics_per_word(1.0 / 25.0, 1.0), 2);
    assert_eq!(cubics_per_word(0.25, 1.0), 7);
    for (turns, cubics) in [(0.25_f64, 7.0_f64), (0.125, 4.0)] {
        assert!((TAU * turns / cubics).powi(4) / 720.0 < 5e-6);
        assert!((TAU * turns / (cubics - 1.0)).powi(4) / 720.0 > 5e-6);
    }
}

#[test]
fn fast_sines_keep_their_gain_and_phase_and_have_no_images() {
    let gyro = silent_gyro();
    let rate_hz = 1.0 / word_period_s(&gyro);
    for turns in [0.249_73, 0.197_31, 0.124_11, 0.061_7, 0.031_3] {
        let frequency_hz = turns * rate_hz;
        let cubics = cubics_per_word(frequency_hz, 1.0 / rate_hz);
        let (gain, phase) = word_response(&gyro, &[frequency_hz]).unwrap()[0];
        for fidelity in [Fidelity::Rate, Fidelity::Loop] {
            let [own, lag, rest] = measured(&gyro, fidelity, frequency_hz, cubics);
            assert_close(own / gain, 1.0, 0.0, 6e-6);
            let off = (lag - phase) / TAU;
            assert_close((off - off.round()) * TAU, 0.0, 0.0, 1e-5);
            assert!(rest < 5e-6, "{turns} {rest}");
        }
    }
    // One cubic a word loses (2 pi / 8)^4 / 720 = 528 ppm at eight words a cycle.
    let frequency_hz = 0.124_11 * rate_hz;
    let (gain, _) = word_response(&gyro, &[frequency_hz]).unwrap()[0];
    let [own, _, _] = measured(&gyro, Fidelity::Rate, frequency_hz, 1);
    assert_close(1.0 - own / gain, (TAU * 0.124_11).powi(4) / 720.0, 0.1, 0.0);
}
