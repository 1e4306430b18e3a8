//! Waveforms read back by a viewer's library hold the words of the trace.

use std::path::Path;

use fogbench::fpga::export::{ExportSettings, PipelineConfig, write_waveform};
use fogbench::fpga::front_end::Pair;
use fogbench::fpga::lms::{DesiredSource, LmsConfig, LmsSettings};
use fogbench::fpga::rls::{RlsConfig, RlsPipeline, RlsSettings};
use fogbench::fpga::trace::{ClockRecord, Recorder, Window};
use fogbench::vocabulary::{Division, UpdateSign};

use crate::support::stimulus::predictor_pairs;

fn config() -> RlsConfig<f64> {
    RlsConfig::new(RlsSettings {
        tap_count: 4,
        forgetting_factor: 0.99,
        initial_inverse_correlation: 1e4,
        division: Division::Reciprocal,
        update_sign: UpdateSign::Corrected,
    })
    .expect("settings are in range")
}

fn settings(pipeline: PipelineConfig<f64>) -> ExportSettings<f64> {
    ExportSettings {
        pipeline,
        clock_mhz: 40.0,
        front_end: "one-step predictor".to_string(),
        trace_samples: 0,
        codes: None,
        top: None,
    }
}

fn records(pairs: &[Pair<f64>], window: Window) -> Vec<ClockRecord<f64>> {
    let mut records = Vec::new();
    let mut recorder = Recorder::new(window, |record: &ClockRecord<f64>| records.push(*record));
    RlsPipeline::new(config()).run_probed(pairs, &mut Vec::new(), &mut recorder);
    recorder.finish();
    records
}

/// A signal's values as text (bits, or a number), one per time in ps.
fn values(path: &Path, scopes: &[&str], name: &str, times: &[u64]) -> Vec<String> {
    let mut wave = wellen::simple::read(path).expect("a readable waveform");
    let variable = wave
        .hierarchy()
        .lookup_var(scopes, name)
        .unwrap_or_else(|| panic!("{}: no signal {scopes:?} {name}", path.display()));
    let signal = wave.hierarchy()[variable].signal_ref();
    wave.load_signals(&[signal]);
    let table = wave.time_table().to_vec();
    let changes: Vec<(u64, String)> = wave
        .get_signal(signal)
        .expect("a loaded signal")
        .iter_changes()
        .map(|(index, value)| {
            let text = match value {
                wellen::SignalValueRef::Real(number) => format!("{:016x}", number.to_bits()),
                wellen::SignalValueRef::String(text) => text.to_string(),
                other => other.to_bit_string().expect("a vector of bits"),
            };
            (table[usize::try_from(index).expect("an index fits")], text)
        })
        .collect();
    times
        .iter()
        .map(|time| {
            let last = changes.iter().rev().find(|(when, _)| when <= time);
            last.unwrap_or_else(|| panic!("{name} has no value at {time}"))
                .1
                .clone()
        })
        .collect()
}

type Show = fn(&ClockRecord<f64>) -> String;

fn word(word: f64) -> String {
    format!("{:064b}", word.to_bits())
}

fn bit(high: bool) -> String {
    u8::from(high).to_string()
}

/// Scopes, names and expected texts of signals of every kind.
#[rustfmt::skip]
const COLUMNS: [(&[&str], &str, Show); 11] = [
    (&["rls"], "p", |r| word(r.registers.product)),
    (&["rls"], "acc_real", |r| format!("{:016x}", r.registers.accumulator.to_bits())),
    (&["rls"], "y", |r| word(r.registers.output)),
    (&["rls"], "out_valid", |r| bit(r.ports.output_valid)),
    (&["rls", "ctrl"], "state", |r| format!("{:04b}", r.registers.state)),
    (&["rls", "ramb"], "addr", |r| format!("{:013b}", r.ramb.address)),
    (&["rls", "ramb"], "we", |r| bit(r.ramb.write.is_some())),
    (&["rls", "ramb"], "wdata", |r| word(r.ramb.write.unwrap_or(0.0))),
    (&["rls", "mul"], "q", |r| word(r.multiplier.map_or(0.0, |unit| unit.q))),
    (&["rls", "add"], "sub", |r| bit(r.adder.is_some_and(|unit| unit.subtracts))),
    (&["rls", "div"], "done", |r| bit(r.divider.is_some())),
];

#[test]
fn vcd_and_fst_hold_the_words_of_every_clock() {
    let pairs = predictor_pairs::<f64>("rocking", 6);
    let window = Window {
        first_clock: 109,
        clock_count: 300,
    };
    let dir = tempfile::tempdir().unwrap();
    let settings = settings(PipelineConfig::Rls(config()));
    let files = write_waveform(dir.path(), &settings, &pairs, window).unwrap();
    let records = records(&pairs, window);
    assert_eq!(records.len(), 300);
    // A clock of 40 MHz lasts 25,000 ps; values appear with its rising edge.
    let times: Vec<u64> = records.iter().map(|record| 25_000 * record.clock).collect();
    for path in &files[..2] {
        for (scopes, name, show) in COLUMNS {
            let want: Vec<String> = records.iter().map(show).collect();
            let got = values(path, scopes, name, &times);
            assert_eq!(got, want, "{} {name}", path.display());
        }
        let instants = [times[0], times[0] + 12_500, times[1]];
        assert_eq!(values(path, &["rls"], "clk", &instants), ["1", "0", "1"]);
    }
    // The FST holds the names as ASCII, eight bits a character.
    let names = values(&files[0], &["rls", "ctrl"], "state_name", &times);
    let vectors = values(&files[1], &["rls", "ctrl"], "state_name", &times);
    for (record, (name, vector)) in records.iter().zip(names.iter().zip(vectors)) {
        let ascii: String = format!("{:>11}", record.registers.state_name)
            .bytes()
            .map(|byte| format!("{byte:08b}"))
            .collect();
        assert_eq!(name, record.registers.state_name);
        assert_eq!(vector, ascii);
    }
}

#[test]
fn a_waveform_of_other_samples_is_told_apart() {
    // The comparison above can fail: one changed bit of one sample shows in the same columns.
    let pairs = predictor_pairs::<f64>("rocking", 3);
    let mut other = pairs.clone();
    other[1].desired = f64::from_bits(other[1].desired.to_bits() ^ 1);
    let dir = tempfile::tempdir().expect("a temporary folder");
    let settings = settings(PipelineConfig::Rls(config()));
    let files = write_waveform(dir.path(), &settings, &other, Window::ALL).unwrap();
    let records = records(&pairs, Window::ALL);
    let times: Vec<u64> = records.iter().map(|record| 25_000 * record.clock).collect();
    for path in &files[..2] {
        let got = values(path, &["rls"], "dd", &times);
        let differing = records
            .iter()
            .zip(got)
            .filter(|(record, bits)| {
                format!("{:064b}", record.registers.desired.to_bits()) != *bits
            })
            .count();
        // D holds sample 1 from its loading until that of sample 2: one period of 108 clocks.
        assert_eq!(differing, 108, "{}", path.display());
    }
}

#[test]
fn lms_waveforms_open_and_an_empty_window_is_refused() {
    let config = LmsConfig::new(LmsSettings {
        tap_count: 10,
        step_size: 0.8,
        regularisation: Some(1e-3),
        desired: DesiredSource::MeanOfTwoNewest,
        update_sign: UpdateSign::Corrected,
    });
    let settings = settings(PipelineConfig::Lms(config.unwrap()));
    let pairs = predictor_pairs::<f64>("white", 3);
    let dir = tempfile::tempdir().expect("a temporary folder");
    let files = write_waveform(dir.path(), &settings, &pairs, Window::ALL).unwrap();
    for path in &files[..2] {
        // Clock 0 idles, clock 1 loads, clocks 2 to 11 form the energy.
        let states = values(path, &["lms", "ctrl"], "state", &[0, 25_000, 50_000]);
        assert_eq!(states, ["0000", "0001", "0010"]);
    }
    let late = Window {
        first_clock: 1_000_000,
        clock_count: 1,
    };
    assert!(write_waveform(dir.path(), &settings, &pairs, late).is_err());
}
