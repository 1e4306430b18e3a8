//! The calibration of an assembly from a file of group means, or from a simulated campaign.

use std::path::Path;

use super::findings::complaint;
use super::groups::{campaign, run_campaign};
use super::sheet::calibration_sheet;
use crate::calibration::{
    CalibrationError, GroupDesign, GroupObservation, TableGroup, diagnose,
    horizontal_residue_deg_per_s, reference_rate,
};
use crate::experiment::build::VERSION;
use crate::experiment::plan::plan_suite;
use crate::experiment::run::{Progress, count};
use crate::recording::{LogError, RecordedGroup, RecordedGroups, read_groups};
use crate::report::{CalibrateReport, CalibrationProvenance, calibration_files};
use crate::scenario::{CalibrationConfig, ScenarioError};
use crate::signal::{CalibrationGroup, CalibrationSheet};
use crate::store::{OutputFolder, StoreError};
use crate::units::{
    EARTH_RATE_RAD_PER_S, deg_per_h_to_deg_per_s, deg_per_s_to_deg_per_h, deg_to_rad,
    rad_per_s_to_deg_per_s,
};
use crate::vocabulary::EstimatorKind;

/// Horizontal Earth rate left in a mean that is worth saying, deg/h.
const RESIDUE_DEG_PER_H: f64 = 0.01;

/// A calibration with what it is from.
#[derive(Clone, Debug)]
pub struct CalibrationTrial {
    file: String,
    digest: String,
    latitude_deg: Option<f64>,
    sheet: CalibrationSheet,
    notes: Vec<String>,
}

impl CalibrationTrial {
    /// Plan, groups and estimates.
    #[must_use]
    pub fn sheet(&self) -> &CalibrationSheet {
        &self.sheet
    }

    /// The report of the calibration, to be printed.
    #[must_use]
    pub fn report(&self) -> CalibrateReport<'_> {
        CalibrateReport {
            tool_version: VERSION,
            file: &self.file,
            digest: &self.digest,
            latitude_deg: self.latitude_deg,
            sheet: &self.sheet,
            notes: &self.notes,
        }
    }

    /// Writes `calibration.toml` and `groups.csv` into `folder`, in place of what stood there, as one.
    ///
    /// # Errors
    /// Whatever the file system says, with the path.
    pub fn write(&self, folder: &OutputFolder) -> Result<(), StoreError> {
        let provenance = CalibrationProvenance {
            tool_version: VERSION,
            file: &self.file,
            digest: &self.digest,
        };
        let staged = folder.stage()?;
        for (name, text) in calibration_files(&self.sheet, &provenance) {
            staged.write(&name, text.as_bytes())?;
        }
        staged.seal_plainly()?;
        staged.put_files_in_place()
    }
}

/// Why there is no calibration.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CalibrateError {
    /// The groups file could not be read, or holds something else.
    #[error(transparent)]
    File(#[from] LogError),
    /// The scenario is wrong.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// The groups do not fit the motion that they state, or do not determine the parameters.
    #[error("{place}: {message}")]
    Refused {
        /// Name of the file, with the line where one is to blame.
        place: String,
        /// What is wrong.
        message: String,
    },
}

/// Which settings to calibrate a groups file with.
#[derive(Clone, Debug)]
pub struct GroupsSettings {
    /// Latitude that the Earth rate about the table axis is from, deg; none where every line gives
    /// the rates about the case axes itself.
    pub latitude_deg: Option<f64>,
    /// Estimators and their settings.
    pub calibration: CalibrationConfig,
    /// Whether the applied estimator was asked for; otherwise `batch` takes its place where the
    /// groups do not determine a coefficient of temperature.
    pub is_estimator_asked_for: bool,
}

/// Calibrates an assembly from the groups in a file.
///
/// # Errors
/// A file that cannot be read; a latitude that is lacking or of no effect; groups in which a
/// mounting is missing, a sense is reversed, axes are swapped or a unit is wrong, each named; a plan
/// that leaves parameters open.
pub fn calibrate_groups(
    path: &Path,
    settings: &GroupsSettings,
) -> Result<CalibrationTrial, Vec<CalibrateError>> {
    let recorded = read_groups(path).map_err(|error| vec![error.into()])?;
    let refuse = |message: String| CalibrateError::Refused {
        place: recorded.file.clone(),
        message,
    };
    check_latitude(&recorded, settings).map_err(|error| vec![error])?;
    let kinds = settings.calibration.kinds();
    if let Some(kind) = kinds.iter().find(|kind| kind.takes_samples()) {
        return Err(vec![refuse(format!(
            "--estimator {} takes the samples of a campaign: a groups file holds their means",
            kind.word()
        ))]);
    }
    let observations: Vec<GroupObservation> = recorded
        .groups
        .iter()
        .map(|group| observation(group, settings.latitude_deg))
        .collect();
    let findings = diagnose(&observations);
    if !findings.is_empty() {
        let found = findings.iter().map(|finding| complaint(finding, &recorded));
        return Err(found.map(refuse).collect());
    }
    let groups: Vec<CalibrationGroup> = recorded
        .groups
        .iter()
        .zip(&observations)
        .map(|(group, observation)| table_row(group, observation))
        .collect();
    let mut notes = recorded.notes();
    notes.extend(horizontal_note(&recorded, settings.latitude_deg));
    let unsure = |error: CalibrationError| vec![refuse(error.to_string())];
    let mut sheet = sheet(&groups, settings, &mut notes).map_err(unsure)?;
    if recorded
        .groups
        .iter()
        .all(|group| group.standard_error_deg_per_h.is_none())
    {
        let (errors, note) = errors_of_residuals(&sheet);
        notes.push(note);
        let groups: Vec<CalibrationGroup> = groups
            .into_iter()
            .map(|group| CalibrationGroup {
                standard_error_deg_per_h: errors,
                ..group
            })
            .collect();
        let again = self::sheet(&groups, settings, &mut Vec::new());
        sheet = again.map_err(unsure)?;
    }
    Ok(CalibrationTrial {
        file: recorded.file,
        digest: recorded.digest,
        latitude_deg: settings.latitude_deg,
        sheet,
        notes,
    })
}

/// Simulates the campaign of a scenario and calibrates it: repeat 0, without metrics.
///
/// # Errors
/// Every complaint about the scenario; a sweep, or one without a campaign; groups that do not
/// calibrate.
pub fn calibrate_campaign(
    path: &Path,
    sets: &[String],
    progress: &dyn Progress,
) -> Result<CalibrationTrial, Vec<CalibrateError>> {
    let plans = plan_suite(&[path.to_owned()], sets).map_err(|errors| {
        errors
            .into_iter()
            .map(CalibrateError::from)
            .collect::<Vec<_>>()
    })?;
    let refuse = |message: String| {
        let place = path.display().to_string();
        vec![CalibrateError::Refused { place, message }]
    };
    let [plan] = &plans[..] else {
        let count = plans.len();
        return Err(refuse(format!(
            "{count} runs: name one scenario without a sweep"
        )));
    };
    let resolved = plan.resolved();
    if campaign(&resolved.scenario).is_none() {
        return Err(refuse(
            "the scenario has no [turntable.calibration]: there is no campaign to calibrate from"
                .to_owned(),
        ));
    }
    let (sheet, _) =
        run_campaign(&resolved.scenario, 0, progress).map_err(|error| refuse(error.to_string()))?;
    Ok(CalibrationTrial {
        file: resolved.file.clone(),
        digest: resolved.digest.clone(),
        latitude_deg: Some(resolved.scenario.turntable.site.latitude_deg),
        sheet,
        notes: plan.warnings().to_vec(),
    })
}

/// Standard errors of the means, deg/h, that residuals stand for where a file gives none, and what to
/// say of them; zero where no group is to spare.
///
/// The residuals are those of the estimator without forgetting that fits what the applied one does:
/// groups that count for less are not fitted as well.
fn errors_of_residuals(sheet: &CalibrationSheet) -> ([f64; 3], String) {
    let named = |name: &str| {
        sheet
            .estimates
            .iter()
            .find(|estimate| estimate.name == name)
    };
    let applied = named(&sheet.applied);
    let fits_temperature = applied.is_some_and(|one| one.bias_deg_per_h_per_k.is_some());
    let plain = if fits_temperature {
        EstimatorKind::BatchTemperature
    } else {
        EstimatorKind::Batch
    };
    let judged = named(plain.word()).or(applied);
    let errors = judged.map_or([0.0; 3], |estimate| {
        let unknowns = if estimate.bias_deg_per_h_per_k.is_some() {
            5.0
        } else {
            4.0
        };
        let groups = count(estimate.residual_deg_per_h.len());
        let spare = groups - unknowns;
        estimate.residual_rms_deg_per_h.map(|rms| {
            if spare > 0.0 {
                rms * (groups / spare).sqrt()
            } else {
                0.0
            }
        })
    });
    let [x, y, z] = errors;
    let note = format!(
        "the file gives no standard errors: those printed follow from the residuals of {}, \
         {x:.3}, {y:.3} and {z:.3} deg/h for a mean of x, y and z",
        judged.map_or("no estimator", |estimate| &estimate.name)
    );
    (errors, note)
}

/// The sheet of the groups, by another estimator where the settings leave the choice.
fn sheet(
    groups: &[CalibrationGroup],
    settings: &GroupsSettings,
    notes: &mut Vec<String>,
) -> Result<CalibrationSheet, CalibrationError> {
    let asked = &settings.calibration;
    match calibration_sheet(groups, asked, None, None) {
        Err(CalibrationError::Unobservable(_))
            if asked.apply.fits_temperature() && !settings.is_estimator_asked_for =>
        {
            let mut plain = asked.clone();
            plain.apply = EstimatorKind::Batch;
            let (sheet, _) = calibration_sheet(groups, &plain, None, None)?;
            notes.push(format!(
                "batch is applied in place of {}: the groups do not determine a temperature \
                 coefficient of the biases",
                asked.apply.word()
            ));
            Ok(sheet)
        }
        other => other.map(|(sheet, _)| sheet),
    }
}

fn check_latitude(
    recorded: &RecordedGroups,
    settings: &GroupsSettings,
) -> Result<(), CalibrateError> {
    let lacks = |group: &&RecordedGroup| group.reference_rate_deg_per_s.is_none();
    let lacking = recorded.groups.iter().find(lacks);
    let file = &recorded.file;
    let (place, message) = match (lacking, settings.latitude_deg) {
        (Some(group), None) => (
            format!("{file}:{}", group.line),
            "the Earth rate about the table axis is not known: give --latitude-deg, or the rates \
             about the case axes with the Earth rate in them as reference_x_deg_per_s, \
             reference_y_deg_per_s and reference_z_deg_per_s",
        ),
        (None, Some(_)) => (
            file.clone(),
            "--latitude-deg has no effect where every line gives reference_x, reference_y and \
             reference_z: leave it out",
        ),
        _ => return Ok(()),
    };
    Err(CalibrateError::Refused {
        place,
        message: message.to_owned(),
    })
}

fn observation(group: &RecordedGroup, latitude_deg: Option<f64>) -> GroupObservation {
    let table = TableGroup {
        axis: group.mounting.axis,
        is_up: group.mounting.is_up,
        table_rate_deg_per_s: group.rate_deg_per_s,
        averaging_time_s: group.averaging_time_s.unwrap_or_default(),
        start_azimuth_deg: None,
    };
    let reference = group.reference_rate_deg_per_s;
    let errors = group.standard_error_deg_per_h.unwrap_or_default();
    GroupObservation {
        design: GroupDesign {
            reference_rate_deg_per_s: reference
                .unwrap_or_else(|| reference_rate(&table, latitude_deg.unwrap_or_default())),
            temperature_c: group.temperature_c,
            temperature_rate_k_per_min: group.temperature_rate_k_per_min.unwrap_or_default(),
        },
        output_deg_per_s: group.output_deg_per_h.map(deg_per_h_to_deg_per_s),
        standard_error_deg_per_s: errors.map(deg_per_h_to_deg_per_s),
    }
}

fn table_row(group: &RecordedGroup, observation: &GroupObservation) -> CalibrationGroup {
    CalibrationGroup {
        mounting: group.mounting.axis,
        rate_deg_per_s: group.rate_deg_per_s,
        reference_rate_deg_per_s: observation.design.reference_rate_deg_per_s,
        temperature_c: group.temperature_c,
        temperature_rate_k_per_min: observation.design.temperature_rate_k_per_min,
        output_deg_per_h: group.output_deg_per_h,
        standard_error_deg_per_h: group.standard_error_deg_per_h.unwrap_or_default(),
        start_s: group.start_s,
        averaging_time_s: group.averaging_time_s.unwrap_or_default(),
        turns: group.turns,
        samples: group.samples.unwrap_or_default(),
        rejected: group.rejected.unwrap_or_default(),
    }
}

/// What the averages leave of the horizontal Earth rate in the gyros that lie level.
///
/// The rates that a latitude gives hold over whole turns; at rest nothing averages it out.
fn horizontal_note(recorded: &RecordedGroups, latitude_deg: Option<f64>) -> Option<String> {
    let horizontal = rad_per_s_to_deg_per_s(EARTH_RATE_RAD_PER_S) * deg_to_rad(latitude_deg?).cos();
    let groups = recorded.groups.iter();
    let left = groups.filter(|group| group.reference_rate_deg_per_s.is_none());
    let left = left.filter_map(|group| {
        let rate = group.rate_deg_per_s;
        let time_s = group.averaging_time_s.filter(|time_s| *time_s > 0.0);
        let is_still = rate.abs() * time_s.unwrap_or(1.0) < f64::MIN_POSITIVE;
        if time_s.is_none() && !is_still {
            return None;
        }
        let residue = horizontal_residue_deg_per_s(horizontal, rate, time_s.unwrap_or(1.0));
        Some((deg_per_s_to_deg_per_h(residue), group))
    });
    let (largest, group) = left.max_by(|(a, _), (b, _)| a.total_cmp(b))?;
    (largest > RESIDUE_DEG_PER_H).then(|| {
        format!(
            "the mean of line {} leaves up to {largest:.3} deg/h of the horizontal Earth rate in the \
             level gyros: average over whole turns, or give the rates about the case axes as \
             reference_x_deg_per_s, reference_y_deg_per_s and reference_z_deg_per_s",
            group.line
        )
    })
}
