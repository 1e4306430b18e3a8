//! From merged values to a resolved scenario, or to everything that is wrong with them.

use std::sync::Arc;

use crate::scenario::check::cross;
use crate::scenario::check::faults::Taken;
use crate::scenario::check::numbers;
use crate::scenario::check::presence::check_presence;
use crate::scenario::check::stand_in::{Variant, make_whole};
use crate::scenario::check::values::check_values;
use crate::scenario::document::emit::to_toml;
use crate::scenario::keys::defaults::fill;
use crate::scenario::keys::renamed;
use crate::scenario::message::error::{ScenarioError, in_both};
use crate::scenario::read::draft::{Draft, Recorded};
use crate::scenario::read::files::compensation_source;
use crate::scenario::read::files::log_source;
use crate::scenario::read::files::named_files;
use crate::scenario::read::files::script;
use crate::scenario::read::resolved::{Resolved, broken, configuration, digest};

/// What is wrong with a scenario, and as what it can be checked further.
#[derive(Debug, Default)]
pub(crate) struct Unsound {
    pub(crate) errors: Vec<ScenarioError>,
    /// None where nothing more can be said.
    pub(crate) reading: Option<UnsoundReading>,
}

/// A scenario that is not sound, as it can be checked further.
#[derive(Debug)]
pub(crate) struct UnsoundReading {
    /// The scenario, once for every set of made-up values: a complaint counts if all of them give it.
    pub(crate) variants: Vec<Resolved>,
    /// Whether its values contradict one another: only names can then be checked.
    pub(crate) is_contradictory: bool,
}

impl From<Vec<ScenarioError>> for Unsound {
    fn from(errors: Vec<ScenarioError>) -> Self {
        Self {
            errors,
            reading: None,
        }
    }
}

impl Draft {
    /// Checks every value, fills in the defaults and checks across values.
    ///
    /// What is faulty or missing is made up for the later checks, so that all complaints come at once.
    ///
    /// # Errors
    /// Every complaint about the scenario.
    pub(crate) fn resolve(mut self) -> Result<Resolved, Unsound> {
        let mut errors = Vec::new();
        let campaign = self.read_named_files(&mut errors);
        let sources = &self.sources;
        let named = (&mut self.root, &mut self.inputs);
        match named_files::read_all(named.0, sources, named.1, self.recorded.as_ref()) {
            Ok(found) => self.named_files = found,
            Err(more) => errors.extend(more),
        }
        let faults = check_values(&mut self.root, self.root_mark, &self.sources);
        errors.extend(faults.errors);
        if faults.is_other_version || self.is_partial {
            return Err(errors.into());
        }
        numbers::settle(&mut self.root);
        if errors.is_empty() {
            match log_source::read_into(&mut self.root, &self.sources, &self.named_files) {
                Ok(log) => self.log = log,
                Err(error) => return Err([errors, vec![error]].concat().into()),
            }
        }
        if !errors.is_empty() {
            log_source::make_up_length(&mut self.root);
        }
        let mut whole = self.root.clone();
        fill(&mut whole);
        let missing = check_presence(&whole, self.root_mark, &self.sources, &faults.taken);
        errors.extend(missing);
        if !errors.is_empty() {
            return Err(self.made_up(&faults.taken, campaign.as_ref(), errors));
        }
        self.root = whole;
        let (resolved, errors) = self.settle(campaign)?;
        if errors.is_empty() {
            return Ok(resolved);
        }
        let reading = UnsoundReading {
            variants: vec![resolved],
            is_contradictory: true,
        };
        Err(Unsound {
            errors,
            reading: Some(reading),
        })
    }

    /// Reads the files that keys name. Without one of them most of the later complaints would follow
    /// from its lack.
    fn read_named_files(&mut self, errors: &mut Vec<ScenarioError>) -> Option<Arc<Resolved>> {
        let sources = Arc::make_mut(&mut self.sources);
        if let Err(error) = script::read_into(&mut self.root, sources, &mut self.inputs) {
            errors.push(error);
            self.is_partial = true;
        }
        match compensation_source::read_into(&mut self.root, sources, &mut self.inputs) {
            Ok(campaign) => campaign,
            Err(more) => {
                errors.extend(more);
                self.is_partial = true;
                None
            }
        }
    }

    /// The complaints that stand whatever was meant by what is faulty or missing.
    fn made_up(
        &self,
        taken: &[Taken],
        campaign: Option<&Arc<Resolved>>,
        mut errors: Vec<ScenarioError>,
    ) -> Unsound {
        let mut variants = Vec::new();
        let mut common: Option<Vec<ScenarioError>> = None;
        let mut is_contradictory = false;
        for variant in Variant::ALL {
            let mut draft = self.clone();
            make_whole(&mut draft.root, taken, variant);
            let Ok((resolved, found)) = draft.settle(campaign.cloned()) else {
                return errors.into();
            };
            is_contradictory |= !found.is_empty();
            variants.push(resolved);
            common = Some(match common {
                None => found,
                Some(common) => in_both(common, &found),
            });
        }
        errors.extend(common.unwrap_or_default());
        Unsound {
            errors,
            reading: Some(UnsoundReading {
                variants,
                is_contradictory,
            }),
        }
    }

    /// The configuration of a whole tree, and what is wrong across its values.
    fn settle(
        self,
        campaign: Option<Arc<Resolved>>,
    ) -> Result<(Resolved, Vec<ScenarioError>), Vec<ScenarioError>> {
        let scenario = configuration(&self.root, self.root_mark, &self.sources)?;
        let digest = digest(&to_toml(&self.root, ""));
        let origin = match self.recorded {
            Some(recorded)
                if recorded.digest == digest && recorded.broken_point(&self.root).is_none() =>
            {
                recorded
            }
            // The record is of another scenario: what was read now is the origin. A sweep point
            // stays one as long as the swept keys have their values.
            recorded => Recorded {
                digest,
                file: self.file,
                inputs: self.inputs,
                sweep: recorded
                    .and_then(|recorded| recorded.sweep)
                    .filter(|point| broken(&self.root, point).is_none()),
                gate_places: Vec::new(),
                assumed_keys: None,
            },
        };
        let resolved = Resolved {
            scenario,
            file: origin.file,
            digest: origin.digest,
            inputs: origin.inputs,
            named_files: self.named_files,
            log: self.log,
            sweep: origin.sweep,
            warnings: [self.warnings, renamed::warnings(&self.root)].concat(),
            remarks: self.remarks,
            is_base_point: false,
            campaign,
            gate_places: origin.gate_places,
            assumed_keys: origin.assumed_keys,
            tree: self.root,
            sources: self.sources,
            root_mark: self.root_mark,
            is_record: self.is_record,
            purpose: self.purpose,
        };
        let errors = cross::check(&resolved);
        Ok((resolved, errors))
    }
}
