//! A first scenario for somebody's own gyro, with comments that say unit, meaning and what is assumed.

use std::fmt::Write as _;

use crate::gate::three_digits;
use crate::scenario::{Fidelity, GyroConfig, declared_key};
use crate::signal::GyroFacts;

/// Part of a walk by which the gate that is proposed lets it depart.
const GATE_MARGIN: f64 = 0.1;

/// What a first scenario is made of.
#[derive(Clone, Copy, Debug)]
pub struct Starter<'a> {
    /// Its name.
    pub name: &'a str,
    /// The gyro.
    pub gyro: &'a GyroConfig,
    /// What it is in closed form.
    pub facts: &'a GyroFacts,
    /// The model that runs.
    pub fidelity: Fidelity,
    /// Whether the power was given.
    pub has_power: bool,
    /// Whether the bias instability was given.
    pub has_bias_instability: bool,
    /// Time measured, s.
    pub duration_s: f64,
    /// Time before that, s.
    pub warm_up_s: f64,
}

/// The scenario as a file.
#[must_use]
pub fn starter_toml(starter: &Starter) -> String {
    let mut file = File::default();
    head(&mut file, starter);
    gyro(&mut file, starter);
    bench(&mut file, starter);
    file.text
}

/// A file on its way.
#[derive(Default)]
struct File {
    text: String,
}

impl File {
    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    /// A key with its unit and what is to be said of it.
    fn key(&mut self, path: &str, value: &str, remark: &str) {
        let line = format!("{} = {value}", last(path));
        let unit = declared_key(path).map_or("", |key| key.unit);
        let parts = [unit, remark].into_iter().filter(|part| !part.is_empty());
        let comment: Vec<&str> = parts.collect();
        // Writing to a string cannot fail.
        let _ = match comment.is_empty() {
            true => writeln!(self.text, "{line}"),
            false => writeln!(self.text, "{line:<34} # {}", comment.join("; ")),
        };
    }

    /// A key that was not given: its default, in force without the line.
    fn assumed(&mut self, path: &str) {
        let Some(key) = declared_key(path) else {
            return;
        };
        let line = format!("#| {} = {}", last(path), key.literal);
        let unit = key.with_unit("").trim().to_owned();
        let unit = if unit.is_empty() {
            unit
        } else {
            format!("{unit}; ")
        };
        let _ = writeln!(self.text, "{line:<34} # {unit}assumed: {}", key.summary());
    }
}

fn last(path: &str) -> &str {
    path.rsplit('.').next().unwrap_or(path)
}

fn head(file: &mut File, starter: &Starter) {
    let Starter { gyro, facts, .. } = starter;
    let coil = &gyro.coil;
    let total = total(facts);
    let name = starter.name;
    file.text.push_str(&format!(
        "#:schema ./scenario.schema.json
# A gyro of {} m of fibre on {} mm at {} nm, as `fogbench init` began it: the file is yours to edit.
#
# `fogbench run FILE` runs it, `fogbench budget FILE` says where its noise comes from, `fogbench expand FILE`
# prints every value in force, `fogbench reference KEY` says what a key means; `fogbench schema >
# scenario.schema.json` writes what editors read by the first line.
#
# Lines that begin with \"#| \" are defaults in force, or examples: take the mark away to change them.
# Those called \"assumed\" come from no data sheet of yours.
#
# In closed form, from what was given:
#   transit time {} us, proper frequency {} kHz, output rate {} Hz
#   Sagnac scale factor {} rad per rad/s, single-fringe range +-{} deg/s
#   angle random walk {} deg/sqrt(h), loop gain {}
schema = 1
name = \"{name}\"
description = \"the gyro at rest, with two filters\"
seed = 1
",
        coil.length_m,
        coil.diameter_mm,
        gyro.source.wavelength_nm,
        three_digits(facts.transit_time_us),
        three_digits(facts.proper_frequency_khz),
        three_digits(facts.output_rate_hz),
        three_digits(facts.scale_factor_s),
        three_digits(facts.single_fringe_range_deg_per_s),
        three_digits(total),
        three_digits(facts.loop_gain),
    ));
    file.key(
        "duration_s",
        &format!("{:?}", starter.duration_s),
        "measured",
    );
    file.key(
        "warm_up_s",
        &format!("{:?}", starter.warm_up_s),
        "run before it, and left out of every figure",
    );
    match starter.fidelity {
        Fidelity::Loop => file.key(
            "fidelity",
            "\"loop\"",
            "every half modulation period; \"rate\" is as good at rest, and fast",
        ),
        Fidelity::Rate => file.key(
            "fidelity",
            "\"rate\"",
            "the output rate; \"loop\" is every half modulation period, and slow for this coil",
        ),
    }
}

fn total(facts: &GyroFacts) -> f64 {
    let budget = facts.angle_random_walk_budget_deg_per_sqrt_h.last();
    budget.map_or(0.0, |(_, walk)| *walk)
}

fn gyro(file: &mut File, starter: &Starter) {
    let gyro = starter.gyro;
    let number = |value: f64| format!("{value:?}");
    file.line("\n[gyro.coil]");
    file.key("gyro.coil.length_m", &number(gyro.coil.length_m), "");
    file.key(
        "gyro.coil.diameter_mm",
        &number(gyro.coil.diameter_mm),
        "mean",
    );
    file.assumed("gyro.coil.group_index");

    file.line("\n[gyro.source]");
    file.key(
        "gyro.source.wavelength_nm",
        &number(gyro.source.wavelength_nm),
        "mean",
    );
    let is_of_sheet = gyro.noise.angle_random_walk_deg_per_sqrt_h;
    if starter.has_power {
        file.key(
            "gyro.source.power_uw",
            &number(gyro.source.power_uw),
            "on the detector, mean over a fringe",
        );
    } else if is_of_sheet.is_none() {
        file.assumed("gyro.source.power_uw");
    }

    match is_of_sheet {
        Some(walk) => {
            file.line("\n[gyro.noise]");
            file.key(
                "gyro.noise.angle_random_walk_deg_per_sqrt_h",
                &number(walk),
                "of the data sheet, in the place of shot noise and the like",
            );
        }
        None => {
            file.line("\n[gyro.detector]");
            file.key(
                "gyro.detector.post_gain",
                &number(gyro.detector.post_gain),
                "assumed: the bias point in the middle of the converter's range",
            );
            file.assumed("gyro.detector.responsivity_a_per_w");
            file.assumed("gyro.detector.transimpedance_kohm");
        }
    }
    file.line("\n[gyro.adc]");
    let remark = match gyro.adc.bits {
        0 => "an ideal converter, whose rounding is part of the walk above",
        _ => "assumed",
    };
    file.key("gyro.adc.bits", &gyro.adc.bits.to_string(), remark);
    electronics(file, starter);
}

/// The tables of modulator, loop, words and slow noise.
fn electronics(file: &mut File, starter: &Starter) {
    let gyro = starter.gyro;
    let number = |value: f64| format!("{value:?}");
    file.line("\n[gyro.modulator]");
    file.key(
        "gyro.modulator.dac_bits",
        &gyro.modulator.dac_bits.to_string(),
        "assumed; 0 is ideal",
    );
    file.assumed("gyro.modulator.depth_deg");

    file.line("\n[gyro.controller]");
    file.key(
        "gyro.controller.loop_bandwidth_hz",
        &number(gyro.controller.loop_bandwidth_hz),
        "assumed: half of the output rate, if the loop is fast enough",
    );
    file.assumed("gyro.controller.loop_latency_periods");

    file.line("\n[gyro.output]");
    file.key(
        "gyro.output.half_periods_per_sample",
        &gyro.output.half_periods_per_sample.to_string(),
        "assumed: a rate word every so many half modulation periods",
    );
    file.key(
        "gyro.output.rate_lsb_deg_per_s",
        &number(gyro.output.rate_lsb_deg_per_s),
        "assumed: the step to which a word is rounded",
    );

    file.line("\n[gyro.slow_noise]");
    if starter.has_bias_instability {
        file.key(
            "gyro.slow_noise.bias_instability_deg_per_h",
            &number(gyro.slow_noise.bias_instability_deg_per_h),
            "of the data sheet",
        );
    } else {
        file.assumed("gyro.slow_noise.bias_instability_deg_per_h");
    }
    file.assumed("gyro.slow_noise.rate_random_walk_deg_per_h_per_sqrt_h");
    file.assumed("gyro.slow_noise.bias_deg_per_h");
}

fn bench(file: &mut File, starter: &Starter) {
    file.line("\n# The gyro rests; other motions: `fogbench reference turntable`.");
    file.line("[turntable.static]");
    file.line("\n[turntable.site]");
    file.assumed("turntable.site.latitude_deg");
    let total = total(starter.facts);
    file.text.push_str(&format!(
        "
# Other kinds: `fogbench reference filter`.
[[filter]]
name = \"rls\"
[filter.rls]
taps = 4

[[filter]]
name = \"mean\"
[filter.moving_average]
taps = 8

# A gate that fails ends `fogbench run` with exit code 1. The metrics: docs/metrics.md.
#| [[gate]]
#| metric = \"raw.angle_random_walk_deg_per_sqrt_h\"
#| min = {:.2e}
#| max = {:.2e}
#|
#| [[gate]]
#| metric = \"mean.dc_gain\"
#| min = 0.99
#| max = 1.01
#| decide = \"value\"
",
        total * (1.0 - GATE_MARGIN),
        total * (1.0 + GATE_MARGIN),
    ));
}
