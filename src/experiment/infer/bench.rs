//! A problem with its scenarios read: what forecasts its figures under every reading.

use std::collections::BTreeMap;

use crate::experiment::infer::forms::Form;
use crate::experiment::infer::geometry::Geometries;
use crate::experiment::infer::measurand::Measurand;
use crate::experiment::infer::record::{Lack, RecordTheory};
use crate::experiment::infer::surface::Surfaces;
use crate::inference::{
    Forecast, Forecasts, Parameter, Print, Printed, PrintedConfig, ProblemConfig, Reading,
};
use crate::scenario::{Problem, Purpose, Resolved, ScenarioError, load_base_or_scenario};

/// Most readings of one problem.
const READINGS_MAX: usize = 4096;

/// A problem, ready to be searched.
#[derive(Clone, Debug)]
pub(crate) struct Bench {
    /// What is open in numbers.
    pub(crate) parameters: Vec<Parameter>,
    /// What is open in words.
    pub(crate) readings: Vec<Reading>,
    /// The figures as printed.
    pub(crate) printed: Vec<Printed>,
    /// Why a figure has no closed form, by figure; none where it has one.
    pub(crate) lacks: Vec<Option<String>>,
    /// Record and figure of what has no closed form but may be simulated, by reading.
    pub(super) lacking: Vec<Vec<(usize, usize)>>,
    /// What stands for these, by reading; empty before it is simulated.
    pub(super) surfaces: Vec<Surfaces>,
    /// Forms of the figures.
    forms: Vec<Option<Form>>,
    /// Standard errors of the figures that logs bring, the scatter of their records included.
    standard_errors: Vec<Option<f64>>,
    /// Records of every reading.
    records: Vec<Vec<RecordTheory>>,
    /// Records of the experiments of every reading; none where the reading has no such experiment.
    experiments: Vec<Vec<Option<RecordTheory>>>,
}

/// Resolved scenarios by record and what is set.
type Known = BTreeMap<(usize, Vec<String>), Resolved>;

/// Reads the scenarios of a problem under every reading.
struct Builder<'a> {
    problem: &'a Problem,
    known: Known,
    geometries: Geometries,
}

impl Bench {
    /// Reads the scenarios that a problem names.
    ///
    /// # Errors
    /// Every complaint about the problem and its scenarios.
    pub(crate) fn new(problem: &Problem) -> Result<Self, Vec<ScenarioError>> {
        let config = &problem.config;
        let readings = readings(problem)?;
        let mut builder = Builder {
            problem,
            known: Known::new(),
            geometries: Geometries::default(),
        };
        let forms = builder.forms()?;
        let mut lacks = vec![None; config.published.len()];
        let (mut records, mut experiments) = (Vec::new(), Vec::new());
        let mut lacking = Vec::new();
        for reading in &readings {
            let mut own = Vec::new();
            records.push(builder.records(reading, &forms, &mut lacks, &mut own)?);
            lacking.push(own);
            experiments.push(builder.experiments(reading)?);
        }
        let parameters = builder.parameters()?;
        let is_logged = |index: usize| index >= problem.logged_from;
        let figures = config.published.iter().enumerate();
        let printed = figures.clone().map(|(index, figure)| Printed {
            value: figure.value,
            print: print_of(figure, is_logged(index)),
        });
        let standard_errors = figures.map(|(index, figure)| {
            let known = figure.standard_uncertainty;
            known.filter(|_| is_logged(index))
        });
        Ok(Self {
            parameters,
            readings,
            printed: printed.collect(),
            lacks,
            surfaces: vec![Surfaces::default(); lacking.len()],
            lacking,
            forms: forms.into_iter().map(|(_, form)| form).collect(),
            standard_errors: standard_errors.collect(),
            records,
            experiments,
        })
    }

    /// Number of experiments.
    pub(crate) fn experiments(&self) -> usize {
        self.experiments.first().map_or(0, Vec::len)
    }

    /// What forecasts the figures of a reading at parts of the priors.
    pub(crate) fn forecaster(
        &self,
        reading: usize,
    ) -> impl FnMut(&[f64]) -> Option<Forecasts> + use<'_> {
        let mut records = self.records[reading].clone();
        let mut shared = Vec::new();
        move |parts| {
            let values = self.values(parts);
            let mut forecasts = Forecasts {
                figures: vec![None; self.printed.len()],
                correlations: Vec::new(),
            };
            shared.clear();
            for record in &mut records {
                let Forecasts {
                    figures,
                    correlations,
                } = &mut forecasts;
                record.forecast(
                    &values,
                    &mut shared,
                    &mut |index, forecast| {
                        let own = self.standard_errors[index];
                        let own = own.map(|error| forecast.with_deviation(error));
                        figures[index] = Some(own.unwrap_or(forecast));
                    },
                    &mut |one, other, correlation| correlations.push((one, other, correlation)),
                )?;
            }
            let own = &self.surfaces[reading];
            for surface in &own.surfaces {
                forecasts.figures[surface.figure] = Some(surface.at(parts));
            }
            forecasts.correlations.extend(&own.correlations);
            Some(forecasts)
        }
    }

    /// Parameters that move a record under a reading.
    pub(super) fn acting(&self, reading: usize, record: usize) -> Vec<usize> {
        self.records[reading][record].acting()
    }

    /// Whether a figure scatters as the root of a sum of squares.
    pub(super) fn scatters_as_squares(&self, figure: usize) -> bool {
        matches!(
            self.forms[figure],
            Some(Form::Blocks(_) | Form::Noise | Form::Allan(_))
        )
    }

    /// What forecasts the outcome of every experiment under a reading.
    pub(crate) fn oracle(
        &self,
        reading: usize,
    ) -> impl FnMut(&[f64]) -> Vec<Option<Forecast>> + use<'_> {
        let mut records = self.experiments[reading].clone();
        move |parts| {
            let values = self.values(parts);
            let forecasts = records.iter_mut().map(|record| {
                let mut found = None;
                let mut shared = Vec::new();
                record.as_mut()?.forecast(
                    &values,
                    &mut shared,
                    &mut |_, forecast| found = Some(forecast),
                    &mut |_, _, _| {},
                )?;
                found
            });
            forecasts.collect()
        }
    }

    /// Values of the parameters at parts of their priors.
    pub(crate) fn values(&self, parts: &[f64]) -> Vec<f64> {
        let parameters = self.parameters.iter().zip(parts);
        parameters
            .map(|(parameter, part)| parameter.at(*part))
            .collect()
    }
}

/// How a figure was printed.
///
/// One of a log is known to many digits: what its record scatters is that of the forecast.
fn print_of(figure: &PrintedConfig, is_logged: bool) -> Print {
    const DIGITS: f64 = 1e-3;
    let deviation = figure.standard_uncertainty;
    match figure.rounding {
        Some(step) => Print::Rounded { step },
        None if is_logged => Print::Stated {
            deviation: DIGITS * deviation.unwrap_or(DIGITS * figure.value.abs()),
        },
        None => Print::Stated {
            deviation: deviation.unwrap_or(f64::MIN_POSITIVE),
        },
    }
}

/// Every combination of answers, the last question fastest.
fn readings(problem: &Problem) -> Result<Vec<Reading>, Vec<ScenarioError>> {
    let mut questions: Vec<(&str, Vec<(&str, f64)>)> = Vec::new();
    for row in &problem.config.choices {
        let place = questions
            .iter()
            .position(|(question, _)| *question == row.question);
        let place = place.unwrap_or_else(|| {
            questions.push((&row.question, Vec::new()));
            questions.len() - 1
        });
        let answers = &mut questions[place].1;
        if !answers.iter().any(|(answer, _)| *answer == row.answer) {
            answers.push((&row.answer, row.weight));
        }
    }
    let mut found = vec![Reading {
        answers: Vec::new(),
        weight: 1.0,
    }];
    for (question, answers) in &questions {
        let whole: f64 = answers.iter().map(|(_, weight)| weight).sum();
        let grown = found.iter().flat_map(|reading| {
            answers.iter().map(move |(answer, weight)| {
                let own = ((*question).to_owned(), (*answer).to_owned());
                Reading {
                    answers: [reading.answers.as_slice(), &[own]].concat(),
                    weight: reading.weight * weight / whole,
                }
            })
        });
        found = grown.collect();
        if found.len() > READINGS_MAX {
            let message = format!("the answers combine to more than {READINGS_MAX} readings");
            return Err(vec![problem.complaint("choice", message)]);
        }
    }
    Ok(found)
}

/// Keys that a record has under a reading, as key=value.
pub(super) fn sets_of(config: &ProblemConfig, record: usize, reading: &Reading) -> Vec<String> {
    let row = &config.records[record];
    let mut sets = row.set.clone().unwrap_or_default();
    for choice in &config.choices {
        let is_chosen = reading
            .answers
            .iter()
            .any(|(question, answer)| *question == choice.question && *answer == choice.answer);
        let acts = choice
            .records
            .as_ref()
            .is_none_or(|names| names.contains(&row.name));
        if is_chosen && acts {
            sets.extend(choice.set.iter().flatten().cloned());
        }
    }
    sets
}

impl Builder<'_> {
    /// Channel and form of every figure; none of one without a closed form.
    fn forms(&self) -> Result<Vec<(String, Option<Form>)>, Vec<ScenarioError>> {
        let mut errors = Vec::new();
        let mut found = Vec::new();
        for (index, figure) in self.problem.config.published.iter().enumerate() {
            match self.metric(&format!("published[{index}].metric"), &figure.metric) {
                Ok((channel, measurand)) => {
                    let unit = measurand.unit();
                    let is_bare = unit == "1" && figure.unit.is_empty();
                    if figure.unit != unit && !is_bare {
                        let at = format!("published[{index}].unit");
                        let message = format!(
                            "{at} = \"{}\" is not the unit of {}: give the value in \"{}\"",
                            figure.unit, figure.metric, unit
                        );
                        errors.push(self.problem.complaint(&at, message));
                    }
                    found.push((channel, measurand.form()));
                }
                Err(error) => errors.push(error),
            }
        }
        if errors.is_empty() {
            errors.extend(self.repeated(&found));
        }
        if errors.is_empty() {
            Ok(found)
        } else {
            Err(errors)
        }
    }

    /// Figures that tell what another one of their record tells.
    fn repeated(&self, forms: &[(String, Option<Form>)]) -> Option<ScenarioError> {
        let figures = &self.problem.config.published;
        let pairs = (0..figures.len())
            .flat_map(|own| (own + 1..figures.len()).map(move |other| (own, other)));
        let mut repeated = pairs.filter(|(own, other)| {
            let both = forms[*own].1.zip(forms[*other].1);
            figures[*own].record == figures[*other].record
                && both.is_some_and(|(own, other)| own.repeats(other))
        });
        let (own, other) = repeated.next()?;
        let message = format!(
            "{} and {} of record {} are made of the same sums: give one of them",
            figures[own].metric, figures[other].metric, figures[own].record
        );
        let at = format!("published[{own}].metric");
        Some(self.problem.complaint(&at, message))
    }

    /// Channel and measurand of a name.
    fn metric(&self, at: &str, written: &str) -> Result<(String, Measurand), ScenarioError> {
        Measurand::of(written).map_err(|error| {
            let message = format!("{at} = \"{written}\": {error}");
            self.problem.complaint(at, message)
        })
    }

    /// A record under a reading, with what an experiment sets.
    fn resolve(
        &mut self,
        record: usize,
        reading: &Reading,
        more: &[String],
        at: &str,
    ) -> Result<Resolved, Vec<ScenarioError>> {
        let row = &self.problem.config.records[record];
        let mut sets = sets_of(&self.problem.config, record, reading);
        sets.extend(more.iter().cloned());
        if let Some(resolved) = self.known.get(&(record, sets.clone())) {
            return Ok(resolved.clone());
        }
        let file = self.problem.beside(&row.scenario);
        let mut runs = load_base_or_scenario(&file, &sets, Purpose::Run)?;
        if runs.len() != 1 {
            let message = format!(
                "{at}: {} is a sweep of {} runs: expected a single one; give the values with set",
                row.scenario,
                runs.len()
            );
            return Err(vec![self.problem.complaint(at, message)]);
        }
        let resolved = runs.remove(0);
        self.known.insert((record, sets), resolved.clone());
        Ok(resolved)
    }

    /// Keys that parameters move in a record.
    fn keys(&self, record: &str) -> Vec<(String, usize)> {
        let parameters = self.problem.config.parameters.iter().enumerate();
        let acting = parameters.filter(|(_, parameter)| {
            let records = parameter.records.as_ref();
            records.is_none_or(|names| names.iter().any(|name| name == record))
        });
        acting
            .flat_map(|(index, parameter)| {
                parameter.keys.iter().map(move |key| (key.clone(), index))
            })
            .collect()
    }

    /// Theory of a record.
    fn theory(
        &self,
        record: usize,
        resolved: &Resolved,
    ) -> Result<RecordTheory, Vec<ScenarioError>> {
        let keys = self.keys(&self.problem.config.records[record].name);
        RecordTheory::new(resolved, &keys).map_err(|error| {
            let at = format!("parameter[{}].keys", keys[error.index].1);
            vec![self.problem.complaint(&at, format!("{at}: {error}"))]
        })
    }

    /// Theories of the records under a reading, with their figures.
    fn records(
        &mut self,
        reading: &Reading,
        forms: &[(String, Option<Form>)],
        lacks: &mut [Option<String>],
        lacking: &mut Vec<(usize, usize)>,
    ) -> Result<Vec<RecordTheory>, Vec<ScenarioError>> {
        let mut found = Vec::new();
        for record in 0..self.problem.config.records.len() {
            let resolved =
                self.resolve(record, reading, &[], &format!("record[{record}].scenario"))?;
            let mut theory = self.theory(record, &resolved)?;
            let name = &self.problem.config.records[record].name;
            for (index, figure) in self.problem.config.published.iter().enumerate() {
                if figure.record != *name {
                    continue;
                }
                let (channel, form) = &forms[index];
                let added = match form {
                    Some(form) => theory.add(index, (channel, *form), &mut self.geometries),
                    None => Err(Lack::Metric),
                };
                if let Err(lack) = added {
                    lacks[index] = Some(lack.to_string());
                    if !matches!(lack, Lack::Channel { .. }) {
                        lacking.push((record, index));
                    }
                }
            }
            found.push(theory);
        }
        Ok(found)
    }

    /// Theories of the experiments under a reading; none where one has no closed form.
    fn experiments(
        &mut self,
        reading: &Reading,
    ) -> Result<Vec<Option<RecordTheory>>, Vec<ScenarioError>> {
        let problem = self.problem;
        let mut found = Vec::new();
        for (index, row) in problem.config.experiments.iter().enumerate() {
            let at = format!("experiment[{index}].metric");
            let (channel, metric) = self.metric(&at, &row.metric).map_err(|error| vec![error])?;
            let records = &problem.config.records;
            let record = records.iter().position(|record| record.name == row.record);
            let record = record.unwrap_or(0);
            let more = row.set.clone().unwrap_or_default();
            let resolved =
                self.resolve(record, reading, &more, &format!("experiment[{index}].set"))?;
            let own = |set: &String| set.split('=').next().unwrap_or_default().trim().to_owned();
            let fixed: Vec<String> = more.iter().map(own).collect();
            let keys: Vec<(String, usize)> = self
                .keys(&row.record)
                .into_iter()
                .filter(|(key, _)| !fixed.contains(key))
                .collect();
            let theory = RecordTheory::new(&resolved, &keys).ok();
            found.push(theory.and_then(|mut theory| {
                theory
                    .add(0, (&channel, metric.form()?), &mut self.geometries)
                    .ok()?;
                Some(theory)
            }));
        }
        Ok(found)
    }

    /// The parameters, their ranges within those of their keys.
    fn parameters(&self) -> Result<Vec<Parameter>, Vec<ScenarioError>> {
        let mut errors = Vec::new();
        let mut found = Vec::new();
        for (index, row) in self.problem.config.parameters.iter().enumerate() {
            let mut unit = "";
            if let Some(resolved) = self.known.values().next() {
                for key in &row.keys {
                    unit = resolved.unit_of(key);
                    let Some((low, high)) = resolved.range_of(key) else {
                        continue;
                    };
                    if row.low < low || row.high > high {
                        let at = format!("parameter[{index}].low");
                        let message = format!(
                            "parameter {} reaches from {} to {} {unit}: {key} is allowed from {low} to \
                             {high} {unit}",
                            row.name, row.low, row.high
                        );
                        errors.push(self.problem.complaint(&at, message));
                    }
                }
            }
            found.push(Parameter {
                name: row.name.clone(),
                unit,
                low: row.low,
                high: row.high,
                prior: row.prior,
            });
        }
        if errors.is_empty() {
            Ok(found)
        } else {
            Err(errors)
        }
    }
}
