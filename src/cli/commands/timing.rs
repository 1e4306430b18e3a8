//! `fogbench timing`: what a filter costs in hardware.

use std::fmt::Write;
use std::io;

use serde_json::{Value, json};

use crate::cli::options::hardware::{FilterOptions, TimingOptions};
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;
use crate::filters::hardware::{PipelineSettings, PipelineTiming};
use crate::fpga::FpgaError;
use crate::fpga::kinds::CoreSettings;
use crate::fpga::rls::{ScheduleReport, ScheduleSettings, TimingRow, schedule_clocks, table};
use crate::fpga::timing::{check_clock, sample_period_us, sample_rate_max_khz};
use crate::vocabulary::WordFormat;
use crate::wording::counted;

/// Prints Table 1, the counted pipeline, and what units with latency do to it.
pub(in crate::cli) fn timing(options: &TimingOptions) -> io::Result<Exit> {
    let report = match Report::new(options) {
        Ok(report) => report,
        Err(error) => {
            output::talk(&format!("error: {error}"));
            return Ok(Exit::Usage);
        }
    };
    let document = || format!("{:#}\n", report.json());
    output::data(&options.format.of(|| report.text(), document)?)?;
    Ok(Exit::Success)
}

/// Everything that is printed.
struct Report<'a> {
    filter: &'a FilterOptions,
    /// Table 1; recursive least squares only.
    table: Vec<TimingRow>,
    measured: PipelineTiming,
    stalled: u64,
    /// Whether the machine has units of these latencies.
    exists: bool,
    /// Recursive least squares only.
    interleaved: Option<ScheduleReport>,
}

impl<'a> Report<'a> {
    fn new(options: &'a TimingOptions) -> Result<Self, FpgaError> {
        let filter = &options.filter;
        let settings = filter.settings();
        let measured = settings.timing()?;
        check_clock(filter.clock_mhz)?;
        let units = options.units();
        let stalled = settings.stalled_clocks(units)?;
        // The RTL of every kind waits for its divider.
        let only_the_divider_waits = units.chain();
        let takes_them = settings.check_units(units).is_ok();
        let mut report = Self {
            filter,
            table: Vec::new(),
            measured,
            stalled,
            exists: takes_them || only_the_divider_waits,
            interleaved: None,
        };
        if let PipelineSettings::Float(settings) = &settings
            && let CoreSettings::Rls(core) = &settings.core
        {
            let load = core.load();
            let rows = table(
                load.tap_count,
                load.division,
                load.forgets,
                filter.clock_mhz,
            )?;
            report.table = rows.to_vec();
            let schedule = ScheduleSettings {
                ram_ports: options.ram_ports,
                symmetric_half: false,
            };
            report.interleaved = Some(schedule_clocks(load, units, schedule)?);
        }
        Ok(report)
    }

    fn json(&self) -> Value {
        let (usage, board) = (&self.measured.usage, &self.measured.board);
        let clock_mhz = self.filter.clock_mhz;
        let rows: Vec<Value> = self
            .table
            .iter()
            .map(|row| {
                json!({
                    "design": row.design.name(), "basis": row.basis.name(),
                    "clocks": row.clocks, "multipliers": row.multipliers,
                    "dividers": row.dividers, "adders": row.adders,
                    "sample_period_us": row.sample_period_us,
                    "sample_rate_max_khz": row.sample_rate_max_khz,
                })
            })
            .collect();
        let model = |clocks: u64| {
            json!({
                "clocks": clocks,
                "sample_period_us": sample_period_us(clocks, clock_mhz),
                "sample_rate_max_khz": sample_rate_max_khz(clocks, clock_mhz),
            })
        };
        let states = usage.states.iter();
        let states: serde_json::Map<String, Value> = states
            .map(|state| (state.state.to_owned(), state.clocks.into()))
            .collect();
        let mut document = json!({
            "kind": self.filter.kind_name(), "taps": self.filter.taps, "clock_mhz": clock_mhz,
            "clocks_per_sample": usage.clocks_per_sample,
            "sample_period_us": self.measured.sample_period_us,
            "latency_clocks": usage.latency_clocks,
            "latency_us": self.measured.latency_us,
            "sample_rate_max_khz": self.measured.sample_rate_max_khz,
            "wake_up_clocks": usage.wake_up_clocks,
            "board": {
                "front_end_clocks": board.front_end_clocks,
                "front_end_us": sample_period_us(board.front_end_clocks, clock_mhz),
                "clocks_per_sample": board.clocks_per_sample,
                "sample_period_us": sample_period_us(board.clocks_per_sample, clock_mhz),
                "latency_clocks": board.latency_clocks,
                "latency_us": sample_period_us(board.latency_clocks, clock_mhz),
            },
            "clocks_per_state": states,
            "rama_accesses": usage.rama_accesses, "ramb_accesses": usage.ramb_accesses,
            "multiplies": usage.multiplies, "additions": usage.additions,
            "divisions": usage.divisions,
            "table": rows,
            "stalled": model(self.stalled),
        });
        document["stalled"]["estimate"] = (!self.exists).into();
        if let Some(report) = &self.interleaved {
            document["interleaved"] = model(report.clocks);
            document["interleaved"]["estimate"] = true.into();
            document["interleaved"]["bound"] = report.bound.name().into();
        }
        document
    }

    fn text(&self) -> String {
        let mut text = String::new();
        let usage = &self.measured.usage;
        let clock_mhz = self.filter.clock_mhz;
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{}, {} taps, {}{clock_mhz} MHz, every operation in one clock (counted on the model)\n  \
             {} clocks a sample, {:.2} us, {:.1} kHz; result after {} clocks, {:.3} us; \
             {} more clock after idling",
            self.filter.kind_name(),
            self.filter.taps,
            match self.filter.number_format {
                WordFormat::Fixed => "fixed point, ",
                WordFormat::Float(_) => "",
            },
            usage.clocks_per_sample,
            self.measured.sample_period_us,
            self.measured.sample_rate_max_khz,
            usage.latency_clocks,
            self.measured.latency_us,
            usage.wake_up_clocks,
        );
        self.write_board(&mut text);
        self.write_usage(&mut text);
        if !self.table.is_empty() {
            let _ = writeln!(
                text,
                "\nTable 1   basis     clocks  multipliers  dividers  adders       us      kHz"
            );
        }
        for row in &self.table {
            let _ = writeln!(
                text,
                "{:8}  {:8} {:>7} {:>12} {:>9} {:>7} {:>8.3} {:>8.1}",
                row.design.name(),
                row.basis.name(),
                row.clocks,
                row.multipliers,
                row.dividers,
                row.adders,
                row.sample_period_us,
                row.sample_rate_max_khz,
            );
        }
        let _ = writeln!(text, "\nwith the latencies given");
        let mut line = |name: &str, clocks: u64, bound: &str| {
            let _ = writeln!(
                text,
                "  {name:11} {clocks:>7} clocks {:>9.3} us {:>9.1} kHz  {bound}",
                sample_period_us(clocks, clock_mhz),
                sample_rate_max_khz(clocks, clock_mhz)
            );
        };
        line("stalled", self.stalled, self.stalled_basis());
        if let Some(report) = &self.interleaved {
            let bound = format!("estimate; bound by: {}", report.bound.name());
            line("interleaved", report.clocks, &bound);
        }
        text
    }

    /// What the front end of a board adds.
    fn write_board(&self, text: &mut String) {
        let usage = &self.measured.usage;
        let clock_mhz = self.filter.clock_mhz;
        let board = &self.measured.board;
        let sample = match self.filter.number_format {
            WordFormat::Fixed => ("a word of d", "the word"),
            WordFormat::Float(_) => ("an integer code", "the code"),
        };
        let _ = writeln!(
            text,
            "  on a board: core {} clocks a sample; front end {} from {} to its pair, \
             {:.3} us;\n  system {} clocks a sample, {:.2} us; result {} clocks after {}, {:.3} us, \
             from idle",
            usage.clocks_per_sample,
            counted(board.front_end_clocks, "clock"),
            sample.0,
            sample_period_us(board.front_end_clocks, clock_mhz),
            board.clocks_per_sample,
            sample_period_us(board.clocks_per_sample, clock_mhz),
            board.latency_clocks,
            sample.1,
            sample_period_us(board.latency_clocks, clock_mhz),
        );
    }

    /// What the stalled count stands for.
    fn stalled_basis(&self) -> &'static str {
        if self.exists {
            "the control waits for each result"
        } else {
            "estimate; the control waits for each result"
        }
    }

    /// Clocks per state, ports and units.
    fn write_usage(&self, text: &mut String) {
        let usage = &self.measured.usage;
        let states = usage.states.iter().filter(|state| state.clocks > 0);
        let states: Vec<String> = states
            .map(|state| format!("{} {}", state.state, state.clocks))
            .collect();
        for line in states.chunks(5) {
            let _ = writeln!(text, "  {}", line.join(", "));
        }
        let _ = writeln!(
            text,
            "  ports in use: RAMA {}, RAMB {}; multiplier {}, adder {}, divider {} of {} clocks",
            usage.rama_accesses,
            usage.ramb_accesses,
            usage.multiplies,
            usage.additions,
            usage.divisions,
            usage.clocks_per_sample,
        );
    }
}
