//! What may be said of a hardware pipeline on the command line.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::cli::options::format::Format;
use crate::cli::options::numbers::{OptionError, count_within, within};
use crate::filters::hardware::{Around, HardwareParts, PipelineSettings};
use crate::filters::{HardwareWords, LmsWords, RlsWords, SignLmsWords};
use crate::fpga::export::RtlParts;
use crate::fpga::kinds::CoreSettings;
use crate::fpga::lms::{DesiredSource, LmsSettings};
use crate::fpga::rls::{RlsCore, RlsSettings};
use crate::fpga::sign_lms::SignLmsSettings;
use crate::fpga::timing::{UnitTiming, Units};
use crate::vocabulary::{
    DesiredSignal, Device, Division, ExportForm, NumberFormat, OutputRegister, UnitSource,
    UpdateOrder, UpdateSign, WordFormat,
};

/// Delay of a line enhancer described on the command line, samples; the default of scenarios.
const LINE_ENHANCER_DELAY: usize = 15;
/// Samples between two fresh sums of its norm; the default of scenarios.
const LINE_ENHANCER_RECOMPUTE: u32 = 1000;

/// Initial inverse correlation; the default of scenarios.
const INVERSE_CORRELATION: f64 = 7.716e-4;
/// The same that the formats of the reference hold: about 1024 in their full scale.
const FIXED_INVERSE_CORRELATION: f64 = 1.97e-5;

/// Step size of least mean squares.
const STEP_SIZE: f64 = 0.8;
/// The same that the formats of the reference hold without normalisation: about 0.8 in their full scale.
const FIXED_STEP_SIZE: f64 = 1.5e-8;

/// Clocks that hardware runs at, MHz: as of the keys of a scenario.
const CLOCK_MHZ: (f64, f64) = (1e-3, 1e4);
/// Sizes of a constant of a filter in whatever unit the words have; all of them are numbers of binary32
/// too.
const CONSTANT: (f64, f64) = (1e-30, 1e30);
/// Most samples of an export: an hour at 2.8 kHz.
const EXPORT_SAMPLES_MAX: usize = 10_000_000;

/// Most clocks of one operation.
const CLOCKS_MAX: usize = 1000;

/// Kind of filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Kind {
    /// Recursive least squares
    Rls,
    /// Least mean squares
    Lms,
    /// Least mean squares, the step divided by the energy of the input
    Nlms,
    /// Line enhancer by the sign of the error, behind a delay of 15 samples, mean weights at first
    SignLms,
}

/// The filter and its constants.
#[derive(Args, Debug)]
pub(in crate::cli) struct FilterOptions {
    /// Kind of filter
    #[arg(long, value_enum, default_value_t = Kind::Rls)]
    pub(in crate::cli) kind: Kind,
    /// Number of weights, 1 to 64
    #[arg(long, value_name = "P", default_value_t = 4)]
    pub(in crate::cli) taps: usize,
    /// Clock of the hardware, MHz
    #[arg(
        long,
        value_name = "F",
        allow_negative_numbers = true,
        default_value_t = 40.0,
        value_parser = within(CLOCK_MHZ.0, CLOCK_MHZ.1, "MHz")
    )]
    pub(in crate::cli) clock_mhz: f64,
    /// Where recursive least squares divides
    #[arg(long, value_enum, default_value_t = Division::Reciprocal)]
    division: Division,
    /// Forgetting factor alpha, 0.001 to 1
    #[arg(
        long,
        value_name = "A",
        allow_negative_numbers = true,
        default_value_t = 1.0,
        value_parser = within(1e-3, 1.0, "")
    )]
    forgetting_factor: f64,
    /// Initial inverse correlation, in the inverse square of the words' unit [default: 7.716e-4; of fixed
    /// words 1.97e-5]
    #[arg(
        long,
        value_name = "D",
        allow_negative_numbers = true,
        value_parser = within(CONSTANT.0, CONSTANT.1, "")
    )]
    pub(in crate::cli) initial_inverse_correlation: Option<f64>,
    /// Step size of least mean squares; of lms in the inverse square of the words' unit, of sign-lms in that
    /// unit [default: 0.8; of lms on fixed words 1.5e-8]
    #[arg(
        long,
        value_name = "MU",
        allow_negative_numbers = true,
        value_parser = within(CONSTANT.0, CONSTANT.1, "")
    )]
    pub(in crate::cli) step_size: Option<f64>,
    /// Added to the energy of the input (nlms, sign-lms), in the square of the words' unit
    #[arg(
        long,
        value_name = "E",
        allow_negative_numbers = true,
        default_value_t = 1.0,
        value_parser = within(CONSTANT.0, CONSTANT.1, "")
    )]
    pub(in crate::cli) regularisation: f64,
    /// Words of the hardware; fixed has the formats of the reference
    #[arg(long, value_enum, default_value_t = WordFormat::Float(NumberFormat::Binary64))]
    pub(in crate::cli) number_format: WordFormat,
}

impl FilterOptions {
    /// The pipeline: the paper's front end for its kind.
    pub(in crate::cli) fn settings(&self) -> PipelineSettings {
        let update_sign = UpdateSign::Corrected;
        let (core, desired, input_lag_samples) = match self.kind {
            Kind::Rls => {
                let settings = self.rls();
                let order = UpdateOrder::Schedule;
                let core = CoreSettings::Rls(RlsCore { settings, order });
                (core, DesiredSignal::Current, 1)
            }
            Kind::Lms | Kind::Nlms => {
                let core = CoreSettings::Lms(LmsSettings {
                    tap_count: self.taps,
                    step_size: self.step(),
                    regularisation: (self.kind == Kind::Nlms).then_some(self.regularisation),
                    desired: DesiredSource::MeanOfTwoNewest,
                    update_sign,
                });
                (core, DesiredSignal::TwoSampleMean, 0)
            }
            Kind::SignLms => {
                let core = CoreSettings::SignLms(SignLmsSettings {
                    tap_count: self.taps,
                    delay_samples: LINE_ENHANCER_DELAY,
                    normalised: false,
                    step: self.step(),
                    regularisation: self.regularisation,
                    initial_weight: self.mean_weight(),
                    guard: None,
                    norm_recompute_samples: LINE_ENHANCER_RECOMPUTE,
                });
                (core, DesiredSignal::Current, LINE_ENHANCER_DELAY)
            }
        };
        let around = Around {
            desired,
            input_lag_samples,
            output_register: OutputRegister::NextSample,
            clock_mhz: self.clock_mhz,
        };
        PipelineSettings::of(core, around, &self.words())
    }

    /// The words; fixed-point ones are those of the reference.
    fn words(&self) -> HardwareWords {
        match self.number_format {
            WordFormat::Float(format) => HardwareWords::Float(format),
            WordFormat::Fixed => HardwareWords::Fixed(match self.kind {
                Kind::Rls => RlsWords::reference().resolved(),
                Kind::Lms | Kind::Nlms => LmsWords::reference().resolved(),
                Kind::SignLms => SignLmsWords::reference().resolved(),
            }),
        }
    }

    /// Step of least mean squares.
    fn step(&self) -> f64 {
        self.step_size
            .unwrap_or(match (self.kind, self.number_format) {
                (Kind::Lms, WordFormat::Fixed) => FIXED_STEP_SIZE,
                _ => STEP_SIZE,
            })
    }

    /// Recursive least squares.
    fn rls(&self) -> RlsSettings {
        RlsSettings {
            tap_count: self.taps,
            forgetting_factor: self.forgetting_factor,
            initial_inverse_correlation: self.initial_inverse_correlation.unwrap_or(
                match self.number_format {
                    WordFormat::Float(_) => INVERSE_CORRELATION,
                    WordFormat::Fixed => FIXED_INVERSE_CORRELATION,
                },
            ),
            division: self.division,
            update_sign: UpdateSign::Corrected,
        }
    }

    /// Kind of filter, as given.
    pub(in crate::cli) fn kind_name(&self) -> String {
        let value = self.kind.to_possible_value();
        value.map_or_else(String::new, |value| value.get_name().to_owned())
    }

    /// One over the number of taps.
    #[expect(clippy::cast_precision_loss, reason = "a handful of taps")]
    fn mean_weight(&self) -> f64 {
        1.0 / self.taps.max(1) as f64
    }
}

/// Latencies of the units.
#[derive(Args, Debug)]
pub(in crate::cli) struct LatencyOptions {
    /// Clocks of an addition
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clocks())]
    adder_latency: u64,
    /// Clocks of a multiplication
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clocks())]
    multiplier_latency: u64,
    /// Clocks of a division
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clocks())]
    divider_latency: u64,
}

impl LatencyOptions {
    /// The three units, with at most this many clocks between two operations.
    fn units(&self, initiation_interval: u64) -> Units {
        let unit = |latency_clocks: u64| UnitTiming {
            latency_clocks,
            interval_clocks: initiation_interval.min(latency_clocks),
        };
        Units {
            adder: unit(self.adder_latency),
            multiplier: unit(self.multiplier_latency),
            divider: unit(self.divider_latency),
        }
    }
}

/// Options of `timing`.
#[derive(Args, Debug)]
pub(in crate::cli) struct TimingOptions {
    #[command(flatten)]
    pub(in crate::cli) filter: FilterOptions,
    #[command(flatten)]
    latencies: LatencyOptions,
    /// Clocks between two operations of a unit; at most its latency counts
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clocks())]
    initiation_interval: u64,
    /// Accesses of each memory per clock in the interleaved model, 1 or 2
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(in crate::cli) ram_ports: u64,
    /// Form of the result
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(in crate::cli) format: Format,
}

/// A parser of clocks that an operation may take.
fn clocks() -> impl Fn(&str) -> Result<u64, OptionError> + Clone + Send + Sync + 'static {
    let parse = count_within(1, CLOCKS_MAX);
    move |text| parse(text).map(|clocks| clocks as u64)
}

impl TimingOptions {
    /// The three units.
    pub(in crate::cli) fn units(&self) -> Units {
        self.latencies.units(self.initiation_interval)
    }
}

/// Options of `export`.
#[derive(Args, Debug)]
pub(in crate::cli) struct ExportOptions {
    /// What to write
    #[arg(value_enum)]
    pub(in crate::cli) what: ExportForm,
    /// Folder to write into
    #[arg(value_name = "DIR")]
    pub(in crate::cli) folder: PathBuf,
    /// Replace files in the folder that fogbench did not write
    #[arg(long)]
    pub(in crate::cli) force: bool,
    /// Scenario whose gyro gives the stimulus
    #[arg(long, value_name = "FILE")]
    pub(in crate::cli) scenario: Option<PathBuf>,
    /// Override a key of the scenario; `filter.<name>.<key>` reaches into a filter
    #[arg(long = "set", value_name = "KEY=VALUE", requires = "scenario")]
    pub(in crate::cli) set: Vec<String>,
    /// Filter of the scenario to export; without it the options below describe one
    #[arg(
        long = "filter",
        value_name = "NAME",
        requires = "scenario",
        conflicts_with = "stimulus"
    )]
    pub(in crate::cli) name: Option<String>,
    /// Recorded stimulus: one column of numbers, NPY or text
    #[arg(long, value_name = "FILE", conflicts_with = "scenario")]
    pub(in crate::cli) stimulus: Option<PathBuf>,
    /// Column of a text by its heading or number from 1 [default: the only one]
    #[arg(
        long,
        value_name = "COLUMN",
        requires = "stimulus",
        conflicts_with = "scenario"
    )]
    pub(in crate::cli) column: Option<String>,
    /// Samples to export [default: 1000, or all of a shorter file]
    #[arg(long, value_name = "N", default_value_t = 1000,
          value_parser = count_within(1, EXPORT_SAMPLES_MAX))]
    pub(in crate::cli) samples: usize,
    /// Samples of which every clock is traced or drawn
    #[arg(long, value_name = "N", default_value_t = 10,
          value_parser = count_within(0, EXPORT_SAMPLES_MAX))]
    pub(in crate::cli) trace_samples: usize,
    #[command(flatten)]
    pub(in crate::cli) filter: FilterOptions,
    #[command(flatten)]
    latencies: LatencyOptions,
    /// Floating-point units of RTL [default: behavioural, with --synth synthesizable]
    #[arg(long, value_enum, value_name = "UNITS")]
    pub(in crate::cli) units: Option<UnitSource>,
    /// Family of devices for which synth.sh, written into the folder, synthesises the filter
    #[arg(long, value_enum, value_name = "DEVICE")]
    pub(in crate::cli) synth: Option<Device>,
}

impl ExportOptions {
    /// What the hardware is made of.
    pub(in crate::cli) fn parts(&self) -> HardwareParts {
        let units = self.units.unwrap_or(match self.synth {
            Some(_) => UnitSource::Synthesizable,
            None => UnitSource::Behavioural,
        });
        HardwareParts {
            latencies: self.latencies.units(1),
            rtl: RtlParts {
                units,
                device: self.synth,
            },
        }
    }
}
