//! What may be said of calibrations.

use std::path::PathBuf;

use clap::Args;

use crate::cli::options::format::Format;
use crate::cli::options::numbers::{OptionError, within};
use crate::experiment::GroupsSettings;
use crate::scenario::CalibrationConfig;
use crate::vocabulary::{EstimatorKind, ForgettingForm};

/// Options of `calibrate`.
#[derive(Args, Debug)]
pub(in crate::cli) struct CalibrateOptions {
    /// Groups file (CSV with the columns mounting, rate_deg_per_s, temperature_c,
    /// output_x_deg_per_h, output_y_deg_per_h, output_z_deg_per_h; other rates by the end of the
    /// name: deg_per_s, mdeg_per_s, arcsec_per_s, rad_per_s, rad_per_h), or a calibration scenario
    /// (`*.toml`)
    pub(in crate::cli) path: PathBuf,
    /// Latitude for the Earth rate about the table axis, deg; not where the groups file gives
    /// reference_x_deg_per_s, reference_y_deg_per_s and reference_z_deg_per_s
    #[arg(long, value_name = "DEG", value_parser = latitude, allow_negative_numbers = true)]
    pub(in crate::cli) latitude_deg: Option<f64>,
    /// Estimator to apply: batch, batch-temperature, arls, arls-covariance, arls-temperature, and of a scenario
    /// whose table has an encoder encoder-rate
    /// [default: calibration.apply; batch where the groups determine no temperature coefficient]
    #[arg(long, value_name = "NAME")]
    pub(in crate::cli) estimator: Option<EstimatorKind>,
    /// How the forgetting factor falls with the step of temperature: linear, exponential, rational,
    /// gaussian [default: calibration.forgetting_form]
    #[arg(long, value_name = "FORM")]
    pub(in crate::cli) forgetting_form: Option<ForgettingForm>,
    /// Its constant without a temperature coefficient, 1/K
    /// [default: calibration.forgetting_constant_per_k]
    #[arg(long, value_name = "C", value_parser = within(0.0, 1000.0, "1/K"))]
    pub(in crate::cli) forgetting_constant_per_k: Option<f64>,
    /// Its constant beside a temperature coefficient, 1/K
    /// [default: calibration.forgetting_constant_with_temperature_per_k]
    #[arg(long, value_name = "C", value_parser = within(0.0, 1000.0, "1/K"))]
    pub(in crate::cli) forgetting_constant_with_temperature_per_k: Option<f64>,
    /// Override a key of the scenario
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(in crate::cli) set: Vec<String>,
    /// Folder for calibration.toml and groups.csv [default: neither is written]
    #[arg(short, long, value_name = "DIR")]
    pub(in crate::cli) output: Option<PathBuf>,
    /// Replace files in the folder that fogbench did not write
    #[arg(long, requires = "output")]
    pub(in crate::cli) force: bool,
    /// Form of the results on stdout
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(in crate::cli) format: Format,
}

impl CalibrateOptions {
    /// Whether the path is a scenario; anything else is a groups file.
    pub(in crate::cli) fn is_scenario(&self) -> bool {
        self.path.extension().is_some_and(|ending| ending == "toml")
    }

    /// Settings for a groups file.
    pub(in crate::cli) fn groups_settings(&self) -> GroupsSettings {
        let mut calibration = CalibrationConfig::reference();
        let settings = &mut calibration;
        settings.apply = self.estimator.unwrap_or(settings.apply);
        settings.forgetting_form = self.forgetting_form.unwrap_or(settings.forgetting_form);
        settings.forgetting_constant_per_k = self
            .forgetting_constant_per_k
            .unwrap_or(settings.forgetting_constant_per_k);
        settings.forgetting_constant_with_temperature_per_k = self
            .forgetting_constant_with_temperature_per_k
            .unwrap_or(settings.forgetting_constant_with_temperature_per_k);
        GroupsSettings {
            latitude_deg: self.latitude_deg,
            calibration,
            is_estimator_asked_for: self.estimator.is_some(),
        }
    }

    /// Overrides of a scenario; the options for estimators stand behind `--set`.
    pub(in crate::cli) fn scenario_sets(&self) -> Vec<String> {
        let given = self.keys().into_iter();
        let named = given.filter_map(|(_, key, value)| Some(format!("{key}={}", value?)));
        self.set.iter().cloned().chain(named).collect()
    }

    /// The options given that stand for a key of a scenario, with that key.
    pub(in crate::cli) fn keys_given(&self) -> Vec<(&'static str, String)> {
        let given = self
            .keys()
            .into_iter()
            .filter(|(_, _, value)| value.is_some());
        given.map(|(option, key, _)| (option, key)).collect()
    }

    /// Options, the keys that they stand for and their values.
    fn keys(&self) -> [(&'static str, String, Option<String>); 4] {
        let number = |value: Option<f64>| value.map(|it| format!("{it:?}"));
        [
            (
                "--estimator",
                "apply",
                self.estimator.map(|it| it.word().to_owned()),
            ),
            (
                "--forgetting-form",
                "forgetting_form",
                self.forgetting_form.map(|it| it.word().to_owned()),
            ),
            (
                "--forgetting-constant-per-k",
                "forgetting_constant_per_k",
                number(self.forgetting_constant_per_k),
            ),
            (
                "--forgetting-constant-with-temperature-per-k",
                "forgetting_constant_with_temperature_per_k",
                number(self.forgetting_constant_with_temperature_per_k),
            ),
        ]
        .map(|(option, key, value)| (option, format!("calibration.{key}"), value))
    }
}

fn latitude(text: &str) -> Result<f64, OptionError> {
    match text.parse::<f64>() {
        Ok(number) if (-90.0..=90.0).contains(&number) => Ok(number),
        _ => Err(OptionError::Latitude),
    }
}
