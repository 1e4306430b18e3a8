//! A calibration campaign of a scenario: what its plan can determine, and its groups once it ran.

use super::encoder_rate::calibrate_samples;
use super::metrics::mean;
use super::sheet::calibration_sheet;
use super::units::observation;
use crate::calibration::{
    Averaging, Calibration, CalibrationError, GroupDesign, GroupObservation, GroupSamples,
    TemperatureColumns, check_plan, group_means, horizontal_residue_deg_per_s, whole_turns_s,
};
use crate::experiment::run::{
    Progress, RecordLength, Simulation, Unfinished, axis_index, simulate,
};
use crate::gyro::{self, coil_temperatures_c};
use crate::scenario::{CampaignConfig, CampaignGroup, MotionConfig, Scenario, TurntableConfig};
use crate::signal::{AssemblyParameters, CalibrationGroup, CalibrationSheet, CalibrationTruth};
use crate::turntable::{Turntable, campaign_angles_rad, earth_rate_rad_per_s};
use crate::units::{
    EARTH_RATE_RAD_PER_S, deg_per_h_to_deg_per_s, deg_per_s_to_deg_per_h, deg_to_rad,
    rad_per_s_to_deg_per_s, rad_to_deg,
};
use crate::vocabulary::EstimatorKind;

/// The campaign of a scenario; none if the table does something else.
pub(crate) fn campaign(scenario: &Scenario) -> Option<&CampaignConfig> {
    scenario.turntable.motion.campaign()
}

/// Rates that a laboratory knows its gyros ought to see in each group, deg/s about the case axes.
///
/// While the table turns: its rate and the projection of Earth rate on its nominal axis, as in the
/// patent's equations (20) to (22); the horizontal part is left to the average. At rest: Earth rate
/// on all three axes, at the table angle that was commanded. Errors of axis and mounting are not
/// known, nor what the servo leaves.
fn reference_rates(scenario: &Scenario, campaign: &CampaignConfig) -> Vec<[f64; 3]> {
    let period_s = gyro::sample_period_s(&scenario.gyro);
    let warm_up = RecordLength::new(scenario, period_s).warm_up;
    #[expect(
        clippy::cast_precision_loss,
        reason = "a count of samples far below 2^53"
    )]
    let warm_up_s = warm_up as f64 * period_s;
    let along = rad_per_s_to_deg_per_s(earth_rate_rad_per_s(&scenario.turntable.site));
    let angles = campaign_angles_rad(campaign, warm_up_s);
    let groups = campaign.groups();
    let rates = groups.iter().zip(angles).map(|(group, angle_rad)| {
        if group.rate_deg_per_s.abs() > 0.0 {
            let mut rates = [0.0; 3];
            rates[axis_index(group.axis)] = along + group.rate_deg_per_s;
            rates
        } else {
            at_rest(&scenario.turntable, group, angle_rad)
        }
    });
    rates.collect()
}

/// Earth rate about the case axes of a table without errors at rest, deg/s.
pub(super) fn at_rest(table: &TurntableConfig, group: &CampaignGroup, turned_rad: f64) -> [f64; 3] {
    let mut still = table.clone();
    still.motion = MotionConfig::rest();
    still.servo = crate::scenario::ServoConfig::ideal();
    still.axis.tilt_north_arcsec = 0.0;
    still.axis.tilt_east_arcsec = 0.0;
    still.axis.wobble_arcsec = 0.0;
    still.mounting.misalignment_arcsec = 0.0;
    still.mounting.axis_along_table = group.axis;
    still.mounting.start_angle_deg += rad_to_deg(turned_rad);
    let segments = Turntable::new(&still, 0.0, 1.0).next_platform_segments();
    segments.map(|segment| rad_per_s_to_deg_per_s(segment.rate_at(1.0)))
}

/// Temperatures that the thermometer of the coil shows from `start_s` of the record on, deg C, about
/// one a second.
fn temperatures_c(scenario: &Scenario, start_s: f64, time_s: f64) -> Vec<f64> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the reader bounds the time of a group to 1e6 s"
    )]
    let count = time_s.ceil() as u32;
    let spacing_s = time_s / f64::from(count);
    let first_s = scenario.warm_up_s + start_s + 0.5 * spacing_s;
    coil_temperatures_c(&scenario.gyro, first_s, spacing_s, count)
}

/// The groups as planned: rates, and the temperatures that the thermal model predicts.
fn planned(scenario: &Scenario, campaign: &CampaignConfig) -> Vec<GroupDesign> {
    let groups = campaign.groups();
    let rates = reference_rates(scenario, campaign);
    let designs = groups.iter().zip(rates).map(|(group, rate)| {
        let temperature_c = {
            let time_s = Window::of(campaign, group).time_s;
            mean(&temperatures_c(scenario, group.start_s, time_s))
        };
        GroupDesign {
            reference_rate_deg_per_s: rate,
            temperature_c: [temperature_c; 3],
            temperature_rate_k_per_min: [0.0; 3],
        }
    });
    designs.collect()
}

/// Why a plan determines less than is asked of it.
#[derive(Debug, thiserror::Error)]
pub(crate) enum PlanError {
    /// Motions are missing.
    #[error("{key}: the plan cannot be calibrated: {error}")]
    Undetermined {
        /// Key to blame.
        key: &'static str,
        /// What is missing.
        error: CalibrationError,
    },
    /// The rate of a sample is not known.
    #[error(
        "calibration.estimators: encoder-rate takes an encoder: give turntable.encoder.resolution_arcsec"
    )]
    NoEncoder,
    /// The temperature is the same in every group.
    #[error("{key} = \"{estimator}\" fits a coefficient of temperature: {error}")]
    OneTemperature {
        /// Key to blame.
        key: &'static str,
        /// The estimator that is asked for.
        estimator: &'static str,
        /// What is missing.
        error: CalibrationError,
    },
}

impl PlanError {
    /// The key to blame.
    pub(crate) fn key(&self) -> &'static str {
        match self {
            Self::Undetermined { key, .. } | Self::OneTemperature { key, .. } => key,
            Self::NoEncoder => "calibration.estimators",
        }
    }
}

/// Checks whether a campaign can determine what is asked of it, before it runs.
///
/// Returns what a sound plan can determine, in a sentence, and what is worth saying of it.
///
/// # Errors
/// [`PlanError`]: what is missing.
pub(crate) fn check_campaign(
    scenario: &Scenario,
    campaign: &CampaignConfig,
) -> Result<(String, Vec<String>), PlanError> {
    let takes_samples = |kind: &EstimatorKind| kind.takes_samples();
    let has_encoder = scenario.turntable.encoder.resolution_arcsec.is_some();
    if !has_encoder && scenario.calibration.kinds().iter().any(takes_samples) {
        return Err(PlanError::NoEncoder);
    }
    let designs = planned(scenario, campaign);
    let reference = [scenario.gyro.thermal.reference_c; 3];
    let plan = check_plan(&designs, TemperatureColumns::NONE, reference).map_err(|error| {
        let is_still = |axis: usize| {
            let turned = campaign.groups();
            let mut turned = turned.iter().filter(|group| axis_index(group.axis) == axis);
            !turned.any(|group| group.rate_deg_per_s.abs() > 0.0)
        };
        let key = if (0..3).any(is_still) {
            "turntable.calibration.axes"
        } else {
            "turntable.calibration.rates_deg_per_s"
        };
        PlanError::Undetermined { key, error }
    })?;
    let condition = plan.axes.iter().map(|axis| axis.condition_number);
    let summary = format!(
        "{} groups, rank {} of 4 for each gyro, condition number {:.1}; a standard \
         error of 1 deg/h of every mean makes {:.3} deg/h in the bias of x, {:.3} of y, {:.3} of z",
        plan.groups,
        plan.rank,
        condition.fold(0.0, f64::max),
        plan.axes[0].bias_std_per_sigma,
        plan.axes[1].bias_std_per_sigma,
        plan.axes[2].bias_std_per_sigma,
    );
    let mut notes = Vec::new();
    if scenario
        .calibration
        .kinds()
        .iter()
        .any(|kind| kind.fits_temperature())
        && let Err(error) = check_plan(&designs, TemperatureColumns::BIAS, reference)
    {
        if scenario.calibration.apply.fits_temperature() {
            return Err(PlanError::OneTemperature {
                key: "calibration.apply",
                estimator: scenario.calibration.apply.word(),
                error,
            });
        }
        notes.push(format!(
            "estimators that fit a coefficient of temperature are left out: {error}"
        ));
    }
    notes.extend(one_sense(campaign));
    notes.extend(no_spare(&designs));
    notes.extend(residue(scenario, campaign));
    Ok((summary, notes))
}

/// What one sense of rotation hides.
fn one_sense(campaign: &CampaignConfig) -> Option<String> {
    let rates = &campaign.rates_deg_per_s;
    let has = |sign: f64| rates.iter().any(|rate| rate * sign > 0.0);
    (!(has(1.0) && has(-1.0))).then(|| {
        "every group turns in one sense: half of an asymmetry of the scale factor goes into the scale \
         factor unseen, a curvature of it into bias and misalignments; groups of the other sense \
         would tell"
            .to_owned()
    })
}

/// Whether there is nothing left to judge the model by.
fn no_spare(designs: &[GroupDesign]) -> Option<String> {
    (designs.len() <= 4).then(|| {
        format!(
            "{} groups for 4 unknowns of each gyro leave no residual: nothing shows whether the model \
             holds",
            designs.len()
        )
    })
}

/// What averaging over a fixed time leaves of the horizontal Earth rate.
fn residue(scenario: &Scenario, campaign: &CampaignConfig) -> Option<String> {
    let along = earth_rate_rad_per_s(&scenario.turntable.site);
    let across_rad_per_s = (EARTH_RATE_RAD_PER_S.powi(2) - along.powi(2))
        .max(0.0)
        .sqrt();
    let across = rad_per_s_to_deg_per_s(across_rad_per_s);
    let turning = campaign
        .rates_deg_per_s
        .iter()
        .filter(|rate| rate.abs() > 0.0);
    let largest = turning
        .map(|rate| horizontal_residue_deg_per_s(across, *rate, campaign.record_s))
        .fold(0.0, f64::max);
    let largest_deg_per_h = deg_per_s_to_deg_per_h(largest);
    (!campaign.whole_turns && largest_deg_per_h > 1e-3).then(|| {
        format!(
            "means over a fixed time leave up to {largest_deg_per_h:.4} deg/h of the horizontal Earth \
             rate: whole_turns = true averages it out"
        )
    })
}

/// Parameters of the simulated assembly at the reference temperature of its thermal model.
///
/// Those that are configured; what the loop adds by imperfections of its own is not among them.
pub(crate) fn simulated_truth(scenario: &Scenario) -> Option<CalibrationTruth> {
    let assembly = scenario.gyro.assembly.as_ref()?;
    let thermal = &scenario.gyro.thermal;
    let common_deg_per_h = scenario.gyro.slow_noise.bias_deg_per_h;
    Some(CalibrationTruth {
        parameters: AssemblyParameters {
            bias_deg_per_h: assembly.bias_deg_per_h.map(|bias| bias + common_deg_per_h),
            scale_factor_error_ppm: assembly.scale_factor_error_ppm,
            theta_arcsec: [
                assembly.theta_xy_arcsec,
                assembly.theta_xz_arcsec,
                assembly.theta_yx_arcsec,
                assembly.theta_yz_arcsec,
                assembly.theta_zx_arcsec,
                assembly.theta_zy_arcsec,
            ],
        },
        bias_deg_per_h_per_k: assembly
            .bias_deg_per_h_per_k
            .map(|own| own + thermal.bias_deg_per_h_per_k),
        reference_temperature_c: thermal.reference_c,
    })
}

/// Cuts the groups out of the raw channels and reduces them to means.
///
/// A group is averaged from its start over whole turns or all of its time, to the nearest sample; the
/// table has its rate for longer. What goes once round with the table is taken out before the
/// standard error is judged: over whole turns it has no mean.
fn groups(
    scenario: &Scenario,
    campaign: &CampaignConfig,
    simulation: &Simulation,
    first: usize,
) -> Result<Vec<CalibrationGroup>, CalibrationError> {
    let period_s = gyro::sample_period_s(&scenario.gyro);
    let threshold = scenario.calibration.outlier_threshold;
    let rates = reference_rates(scenario, campaign);
    let planned = campaign.groups();
    let groups = planned.iter().zip(rates).map(|(group, reference)| {
        let window = Window::of(campaign, group);
        let start = first + whole(group.start_s / period_s + 1e-6);
        let count = whole(window.time_s / period_s + 0.5);
        let turned_rad = deg_to_rad(group.rate_deg_per_s) * period_s;
        let cut = |gyro: usize| -> Vec<f64> {
            let words = &simulation.gyros[gyro].raw_deg_per_h;
            let words = words[start..(start + count).min(words.len())].iter();
            let words = words.copied().map(deg_per_h_to_deg_per_s).collect();
            if window.turns.is_some() {
                without_turn(words, turned_rad)
            } else {
                words
            }
        };
        let outputs = [0, 1, 2].map(cut);
        let temperatures = temperatures_c(scenario, group.start_s, window.time_s);
        let samples = GroupSamples {
            output_deg_per_s: outputs.each_ref().map(Vec::as_slice),
            temperature_c: [&temperatures; 3],
            sample_rate_hz: period_s.recip(),
        };
        let threshold = (threshold > 0.0).then_some(threshold);
        let means = group_means(&samples, Averaging::FixedTime, threshold)?;
        Ok(CalibrationGroup {
            mounting: axis_index(group.axis),
            rate_deg_per_s: group.rate_deg_per_s,
            reference_rate_deg_per_s: reference,
            temperature_c: means.temperature_c,
            temperature_rate_k_per_min: means.temperature_rate_k_per_min,
            output_deg_per_h: means.output_deg_per_s.map(deg_per_s_to_deg_per_h),
            standard_error_deg_per_h: means.standard_error_deg_per_s.map(deg_per_s_to_deg_per_h),
            start_s: Some(group.start_s),
            averaging_time_s: means.averaging_time_s,
            turns: window.turns,
            samples: means.samples,
            rejected: means.rejected,
        })
    });
    groups.collect()
}

/// What of a group is averaged, from its start.
struct Window {
    time_s: f64,
    /// Whole turns in it, if that is what was asked for and the table turns.
    turns: Option<f64>,
}

impl Window {
    fn of(campaign: &CampaignConfig, group: &CampaignGroup) -> Self {
        let turns = whole_turns_s(group.rate_deg_per_s, group.record_s);
        let turns = turns.filter(|_| campaign.whole_turns);
        Self {
            time_s: turns.map_or(group.record_s, |(time_s, _)| time_s),
            turns: turns.map(|(_, turns)| turns),
        }
    }
}

/// Samples without their sine once per turn of the table, `turned_rad` a sample.
fn without_turn(samples: Vec<f64>, turned_rad: f64) -> Vec<f64> {
    let angles = (0_u32..).map(|index| turned_rad * (f64::from(index) + 0.5));
    let (mut cosine, mut sine, mut count) = (0.0, 0.0, 0.0);
    let centre = mean(&samples);
    for (sample, angle) in samples.iter().zip(angles.clone()) {
        cosine += (sample - centre) * angle.cos();
        sine += (sample - centre) * angle.sin();
        count += 0.5;
    }
    let (cosine, sine) = (cosine / count, sine / count);
    let pairs = samples.iter().zip(angles);
    pairs
        .map(|(sample, angle)| sample - cosine * angle.cos() - sine * angle.sin())
        .collect()
}

/// The calibration of a campaign that has been simulated; none if the table did something else.
///
/// # Errors
/// As [`calibration_sheet`].
pub(crate) fn calibrate_simulation(
    scenario: &Scenario,
    simulation: &Simulation,
) -> Result<Option<(CalibrationSheet, Calibration)>, CalibrationError> {
    let Some(campaign) = campaign(scenario) else {
        return Ok(None);
    };
    let period_s = gyro::sample_period_s(&scenario.gyro);
    let first = RecordLength::new(scenario, period_s).warm_up;
    let groups = groups(scenario, campaign, simulation, first)?;
    let truth = simulated_truth(scenario);
    let settings = &scenario.calibration;
    let takes_samples = settings.kinds().iter().any(|kind| kind.takes_samples());
    let of_samples = takes_samples.then(|| {
        let means: Vec<GroupObservation> = groups.iter().map(observation).collect();
        calibrate_samples(scenario, campaign, simulation, (first, &means))
    });
    calibration_sheet(&groups, settings, truth.as_ref(), of_samples.as_ref()).map(Some)
}

/// Simulates repeat `repeat` of a calibration scenario and calibrates it.
///
/// The scenario must have passed the checks of a plan; what another scenario's compensation needs of
/// it, without files or metrics.
///
/// # Errors
/// The table does not turn as a campaign, the gyro cannot be simulated, the groups do not calibrate,
/// or the listener has stopped it.
pub(crate) fn run_campaign(
    scenario: &Scenario,
    repeat: u32,
    progress: &dyn Progress,
) -> Result<(CalibrationSheet, Calibration), Unfinished> {
    let length = RecordLength::new(scenario, gyro::sample_period_s(&scenario.gyro));
    let simulation = simulate(scenario, length, repeat, None, progress)?;
    let found = calibrate_simulation(scenario, &simulation)
        .map_err(|error| Unfinished::Failed(error.to_string()))?;
    let lacking = "the scenario has no [turntable.calibration]";
    found.ok_or_else(|| Unfinished::Failed(lacking.to_owned()))
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a time within the record over the sample period"
)]
fn whole(count: f64) -> usize {
    count.floor() as usize
}
