//! Bandwidth by electronic injection (`gyro.injection`).

use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};
use std::path::Path;

use fogbench::metrics::bandwidth_hz;
use nalgebra::Complex;

use crate::support::transcript::Transcript;
use crate::support::{
    assert_close, code, field, fogbench, npy, repository, run_audits, stderr, summary, write,
};

/// Transit time of the 800 m of fibre of the default gyro, s.
const TRANSIT_S: f64 = 800.0 * 1.4677 / 299_792_458.0;
/// Half modulation periods in a word, and the loop periods in it.
const HALF_PERIODS: u32 = 4;
const PERIODS: u32 = HALF_PERIODS / 2;

/// Neither noise nor rounding.
const QUIET: &str = "[gyro.noise]\nshot = false\nthermal = false\namplifier = false\nrin = false\n\
                     [gyro.adc]\nbits = 0\n[gyro.modulator]\ndac_bits = 0\n";

/// Gain of `H = g z^-(1+d) / (1 - z^-1 + g z^-(1+d))` from its squared magnitude.
fn loop_gain(g: f64, latency: i32, frequency_hz: f64) -> f64 {
    let angle = TAU * frequency_hz * 2.0 * TRANSIT_S;
    let late = f64::from(1 + latency) * angle;
    let real = 1.0 - angle.cos() + g * late.cos();
    let imaginary = angle.sin() - g * late.sin();
    g / real.hypot(imaginary)
}

/// The same with the mean of the two half periods of an error and of the registers of a word.
fn word_gain(g: f64, latency: i32, frequency_hz: f64) -> f64 {
    let half_angle = TAU * frequency_hz * TRANSIT_S;
    let count = f64::from(PERIODS);
    let registers = (count * half_angle).sin() / (count * half_angle.sin());
    loop_gain(g, latency, frequency_hz) * (0.5 * half_angle).cos() * registers
}

/// Where a function that changes its sign once does so.
fn root(mut low: f64, mut high: f64, function: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if function(low) * function(middle) <= 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high)
}

/// Integrator gain of a loop of a bandwidth.
fn gain_of(bandwidth_hz: f64, latency: i32) -> f64 {
    root(1e-3, 0.5, |g| {
        loop_gain(g, latency, bandwidth_hz) - FRAC_1_SQRT_2
    })
}

fn scenario(name: &str, bandwidth_hz: f64, latency: i32, tones: &[f64], rest: &str) -> String {
    format!(
        "schema = 1\nname = \"{name}\"\nduration_s = 0.2\nwarm_up_s = 0.05\n{rest}\
         [gyro.controller]\nloop_bandwidth_hz = {bandwidth_hz:?}\n\
         loop_latency_periods = {latency}\n\
         [gyro.output]\nhalf_periods_per_sample = {HALF_PERIODS}\nrate_lsb_deg_per_s = 0.0\n\
         [output]\nsamples = \"npy\"\n\
         [gyro.injection]\nfrequencies_hz = {tones:?}\nrate_amplitudes_deg_per_s = [0.1]\n\
         soft_start_s = 0.02\n"
    )
}

fn run(folder: &Path, name: &str, text: &str) -> serde_json::Value {
    write(folder, &format!("{name}.toml"), text);
    let output = fogbench(folder, &["run", &format!("{name}.toml"), "-o", "out"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    summary(&folder.join("out"), name)
}

#[test]
fn the_bandwidth_of_both_models_is_that_of_the_closed_form_beyond_any_table() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let parts = [0.05, 0.2, 0.5, 0.8, 0.9, 0.95, 0.98, 1.0, 1.02, 1.05, 1.1];
    for (bandwidth_hz, latency) in [(1000.0, 0), (2000.0, 1), (5000.0, 1)] {
        let g = gain_of(bandwidth_hz, latency);
        let tones = parts.map(|part: f64| (part * bandwidth_hz).round());
        let limit = FRAC_1_SQRT_2 * word_gain(g, latency, tones[0]);
        let expected = root(0.5 * bandwidth_hz, 1.5 * bandwidth_hz, |frequency_hz| {
            word_gain(g, latency, frequency_hz) - limit
        });
        for fidelity in ["loop", "rate"] {
            let name = format!("{fidelity}-{bandwidth_hz}");
            let model = format!("fidelity = \"{fidelity}\"\n{QUIET}");
            let text = scenario(&name, bandwidth_hz, latency, &tones, &model);
            let measured = field(
                &run(folder.path(), &name, &text),
                "raw.bandwidth_hz",
                "value",
            );
            assert_close(measured, expected, 3e-4, 0.0);
            assert!(folder.path().join(format!("out/{name}/bode.svg")).exists());
        }
    }
}

#[test]
fn truth_is_the_rate_of_the_earth_and_that_which_the_signal_equals() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let site = "[turntable.site]\nlatitude_deg = 30.0\naxis_elevation_deg = 90.0\n";
    let tones = [200.0, 6000.0];
    let text = scenario("sum", 2000.0, 1, &tones, site) + "phases = \"zero\"\n";
    let measured = run(folder.path(), "sum", &text);
    let truth = npy(&folder.path().join("out/sum/samples/truth.npy"));
    let times = npy(&folder.path().join("out/sum/samples/time_s.npy"));
    let earth_deg_per_h = 0.5 * 7.292_115e-5 * 3600.0 * 360.0 / TAU;
    assert_close(
        field(&measured, "raw.mean_deg_per_h", "value"),
        earth_deg_per_h,
        0.0,
        5.0,
    );
    assert_eq!(truth.len(), times.len());
    // From the end of the warm-up on, by when the signal has its full size.
    let samples = times.iter().zip(&truth).filter(|(time, _)| **time > 0.05);
    assert!(samples.clone().count() > 12_000);
    for (time_s, truth) in samples {
        let sines: f64 = tones.iter().map(|tone| (TAU * tone * time_s).sin()).sum();
        assert_close(*truth, earth_deg_per_h + 360.0 * sines, 0.0, 1e-6);
    }
}

/// The rounding of converters, which hides a signal far below their steps; all noise stays on.
const UNROUNDED: &str = "[gyro.adc]\nbits = 0\n[gyro.modulator]\ndac_bits = 0\n";

#[test]
fn a_signal_of_the_least_size_adds_its_response_to_the_words_and_nothing_else() {
    const LEAST_DEG_PER_S: f64 = 1e-9;
    const TONE_HZ: f64 = 200.0;
    let folder = tempfile::tempdir().expect("a scratch folder");
    let folder = folder.path();
    let on = scenario("on", 2000.0, 1, &[TONE_HZ], UNROUNDED).replace("[0.1]", "[1e-9]");
    let (off, _) = on.split_once("[gyro.injection]").expect("the signal");
    let off = off.replace("\"on\"", "\"off\"");
    run(folder, "on", &on);
    run(folder, "off", &off);
    let words = |name: &str| npy(&folder.join(format!("out/{name}/samples/raw.npy")));
    let times = npy(&folder.join("out/on/samples/time_s.npy"));
    let (on, off) = (words("on"), words("off"));
    assert_eq!(on.len(), off.len());
    // The noise is the same to the bit, so the difference is the response to the sine alone, a
    // million times smaller than the noise. Whole cycles, once the signal has its full size.
    let steady: Vec<(f64, f64)> = (times.iter().zip(on.iter().zip(&off)))
        .filter(|(time_s, _)| **time_s > 0.05)
        .map(|(time_s, (on, off))| (TAU * TONE_HZ * time_s, on - off))
        .collect();
    let mean = |wave: fn(f64) -> f64| -> f64 {
        let sum: f64 = steady
            .iter()
            .map(|(angle, excess)| excess * wave(*angle))
            .sum();
        2.0 * sum / steady.len() as f64
    };
    let (sine, cosine) = (mean(f64::sin), mean(f64::cos));
    let expected = 3600.0 * LEAST_DEG_PER_S * word_gain(gain_of(2000.0, 1), 1, TONE_HZ);
    assert_close(sine.hypot(cosine), expected, 0.01, 0.0);
    for (angle, excess) in &steady {
        let response = sine * angle.sin() + cosine * angle.cos();
        assert_close(*excess, response, 0.0, 0.05 * expected);
    }
}

#[test]
fn a_signal_needs_a_table_at_rest_one_gyro_and_sines_that_can_be_sampled() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let swing = "[turntable.swing]\nrate_amplitude_deg_per_s = 1.0\nfrequency_hz = 10.0\n\
                 soft_start_s = 0.02\n";
    let mut transcript = Transcript::of("motion", "Injected signals that cannot be");
    for (rest, tone_hz, amplitude) in [
        (swing, 200.0, "0.1"),
        ("[gyro.assembly]\n", 200.0, "0.1"),
        ("", 17000.0, "0.1"),
        ("", 2.0, "0.1"),
        ("", 7000.0, "500.0"),
    ] {
        let text =
            scenario("x", 2000.0, 1, &[tone_hz], rest).replace("[0.1]", &format!("[{amplitude}]"));
        write(folder.path(), "x.toml", &text);
        let output = fogbench(folder.path(), &["check", "x.toml"]);
        // What may lose the lock is a warning.
        assert_eq!(
            code(&output),
            if tone_hz.to_bits() == 7000.0_f64.to_bits() {
                0
            } else {
                2
            },
            "{text}"
        );
        let given = format!("{rest}{amplitude} deg/s at {tone_hz} Hz");
        transcript.case(given, stderr(&output));
    }
    transcript.check();
}

#[test]
fn the_shipped_bandwidth_is_measured_within_its_gates() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    run_audits(folder.path(), &["injected-bandwidth"]);
    let out = folder.path().join("out");
    let run = summary(&out, "injected-bandwidth");
    let half_width_hz =
        0.5 * (field(&run, "raw.bandwidth_hz", "high") - field(&run, "raw.bandwidth_hz", "low"));
    assert!(half_width_hz < 2.0, "{half_width_hz} Hz");
}

/// Bandwidth in Hz and mean error in deg/h of the shipped scenario.
///
/// With the phase errors x and y of the two halves the demodulated error is
/// `(sin x + sin y + cot(phi_m) (cos y - cos x)) / 2`. What it is more than their mean is, to the first
/// terms, a small signal of its own at the input of the linear loop: of the tones it has, it takes from
/// each what falls on it, and its mean is rectified.
fn bent_and_rectified(tones: &[f64]) -> (f64, f64) {
    const PERIODS_PER_WORD: f64 = 4.0;
    // All tones are multiples of 50 Hz.
    const INSTANTS: usize = 4000;
    let scale_s = TAU * 800.0 * 0.07 / (1310e-9 * 299_792_458.0);
    let amplitude = scale_s * 1.0_f64.to_radians();
    let cotangent = 1.0 / 120.0_f64.to_radians().tan();
    let g = gain_of(2000.0, 1);
    let one = Complex::new(1.0, 0.0);
    let turn = |angle: f64| Complex::from_polar(1.0, angle);
    let response = |tone: f64| {
        let late = turn(-TAU * tone * 2.0 * TRANSIT_S);
        late * late * g / (one - late + late * late * g)
    };
    let word_gain = |tone: f64| {
        let half_angle = TAU * tone * TRANSIT_S;
        let registers = (PERIODS_PER_WORD * half_angle).sin() / half_angle.sin();
        response(tone).norm() * (0.5 * half_angle).cos() * registers / PERIODS_PER_WORD
    };
    // Mean of the phases of the two halves over that at the start of the first.
    let mean = |tone: f64| 0.5 * (one + turn(TAU * tone * TRANSIT_S));
    // Schroeder's phases of equal tones: cosines of -pi k (k - 1) / K.
    let count = tones.len() as f64;
    let inputs: Vec<(f64, Complex<f64>)> = tones
        .iter()
        .enumerate()
        .map(|(k, &tone)| (tone, turn(-PI * (k * (k + 1)) as f64 / count) * amplitude))
        .collect();
    let phase = |tone: f64, instant: usize| turn(TAU * tone * instant as f64 / (50.0 * 4000.0));
    let extra: Vec<f64> = (0..INSTANTS)
        .map(|instant| {
            let (mut x, mut y) = (0.0, 0.0);
            for (tone, input) in &inputs {
                let now = input * phase(*tone, instant);
                let step = response(*tone) * mean(*tone);
                x += ((one - step) * now).re;
                y += ((turn(TAU * tone * TRANSIT_S) - step) * now).re;
            }
            -(x.powi(3) + y.powi(3)) / 12.0 + 0.25 * cotangent * (x * x - y * y)
        })
        .collect();
    let gains: Vec<f64> = inputs
        .iter()
        .map(|(tone, input)| {
            let samples = extra.iter().enumerate();
            let on_tone: Complex<f64> = samples
                .map(|(instant, sample)| phase(*tone, instant).conj() * *sample)
                .sum();
            let share = on_tone * (2.0 / INSTANTS as f64) / (input * mean(*tone));
            word_gain(*tone) * (one + share).norm()
        })
        .collect();
    let mean_rad_per_s = extra.iter().sum::<f64>() / INSTANTS as f64 / scale_s;
    (
        bandwidth_hz(tones, &gains).expect("the gain falls through the limit"),
        mean_rad_per_s.to_degrees() * 3600.0,
    )
}

#[test]
fn the_shipped_signal_bends_the_loop_and_is_rectified_as_its_gates_say() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let folder = folder.path();
    let scenario = repository("scenarios/audit/injected-bandwidth.toml");
    let text = std::fs::read_to_string(&scenario).expect("the scenario");
    let resolved: toml::Table = text.parse().expect("TOML");
    let tones: Vec<f64> = resolved["gyro"]["injection"]["frequencies_hz"]
        .as_array()
        .expect("tones")
        .iter()
        .filter_map(toml::Value::as_float)
        .collect();
    let (bandwidth, mean) = bent_and_rectified(&tones);
    assert_close(bandwidth, 1975.76, 0.0, 0.01);
    assert_close(mean, 2.598, 0.0, 1e-3);
    // The gates stand about the theory.
    for (gate, theory) in resolved["gate"]
        .as_array()
        .expect("gates")
        .iter()
        .zip([bandwidth, 0.9997, mean])
    {
        let limit = |name: &str| gate[name].as_float().expect("a limit");
        let (low, high) = (limit("min"), limit("max"));
        assert!(low < theory && theory < high, "{gate}");
    }
    // Without noise a short record shows both.
    let path = scenario.to_str().expect("a path");
    let sets = [
        "duration_s=0.4",
        "gyro.noise.shot=false",
        "gyro.noise.thermal=false",
        "gyro.noise.amplifier=false",
        "gyro.noise.rin=false",
        "gyro.adc.bits=0",
        "gyro.modulator.dac_bits=0",
        "gyro.output.rate_lsb_deg_per_s=0.0",
        "gyro.slow_noise.bias_instability_deg_per_h=0.0",
    ];
    let sets = sets.iter().flat_map(|set| ["--set", set]);
    let arguments: Vec<&str> = ["run", path, "-o", "out"].into_iter().chain(sets).collect();
    let output = fogbench(folder, &arguments);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let run = summary(&folder.join("out"), "injected-bandwidth");
    let bandwidth_hz = field(&run, "raw.bandwidth_hz", "value");
    assert_close(bandwidth_hz, bandwidth, 0.0, 0.03);
    let mean_error = field(&run, "raw.mean_error_deg_per_h", "value");
    assert_close(mean_error, mean, 0.0, 0.01);
}
