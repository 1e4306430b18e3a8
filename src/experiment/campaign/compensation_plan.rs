//! How a run comes by the parameters of its compensation.

use super::compensation::Parameters;
use super::groups::run_campaign;
use crate::calibration::CalibrationError;
use crate::experiment::run::{Progress, Unfinished};
use crate::scenario::{Resolved, Scenario};
use crate::vocabulary::CompensationForm;

/// How a run comes by its parameters.
#[derive(Clone, Debug)]
pub(crate) enum CompensationPlan {
    /// They are given.
    Given(Box<Parameters>),
    /// A campaign finds them.
    Campaign {
        /// The calibration scenario, which has passed the checks of a plan.
        scenario: Box<Scenario>,
        /// How rates follow from the outputs.
        form: CompensationForm,
    },
}

impl CompensationPlan {
    /// The plan of a scenario; none without a compensation. A campaign is still to be checked.
    ///
    /// # Errors
    /// [`CalibrationError::SingularSensitivity`] if given parameters have no inverse.
    pub(crate) fn of(resolved: &Resolved) -> Result<Option<Self>, CalibrationError> {
        let Some(config) = &resolved.scenario.compensation else {
            return Ok(None);
        };
        let form = config.form;
        if let Some(campaign) = &resolved.campaign {
            let scenario = Box::new(campaign.scenario.clone());
            return Ok(Some(Self::Campaign { scenario, form }));
        }
        let given = config.parameters.as_ref();
        let parameters = given
            .map(|given| Parameters::given(form, given))
            .transpose()?;
        Ok(parameters.map(|known| Self::Given(Box::new(known))))
    }

    /// The parameters; a campaign is run for them, its first repeat.
    ///
    /// # Errors
    /// Why the campaign gives none, or that the listener has stopped it.
    pub(crate) fn parameters(&self, progress: &dyn Progress) -> Result<Parameters, Unfinished> {
        let (scenario, form) = match self {
            Self::Given(known) => return Ok(Parameters::clone(known)),
            Self::Campaign { scenario, form } => (scenario, *form),
        };
        let failed =
            |error: String| Unfinished::Failed(format!("campaign {}: {error}", scenario.name));
        let (sheet, calibration) =
            run_campaign(scenario, 0, &Unseen(progress)).map_err(|error| match error {
                Unfinished::Failed(error) => failed(error),
                Unfinished::Stopped => Unfinished::Stopped,
            })?;
        let source = format!("campaign {}, {}", scenario.name, sheet.applied);
        Parameters::found(form, &calibration, source).map_err(|error| failed(error.to_string()))
    }
}

/// Hears nothing of a campaign, whose time is no part of the run's, but stops with the run.
struct Unseen<'a>(&'a dyn Progress);

impl Progress for Unseen<'_> {
    fn should_stop(&self) -> bool {
        self.0.should_stop()
    }
}
