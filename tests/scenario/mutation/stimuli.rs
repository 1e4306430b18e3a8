//! Stimuli of exports: text and NPY, through every kind of pipeline, at times written.

use std::path::Path;
use std::sync::OnceLock;

use fogbench::filters::hardware::{PipelineSettings, Stimulus, export_pipeline};
use fogbench::recording::read_stimulus;
use fogbench::scenario::load_suite;
use fogbench::vocabulary::ExportForm;

use super::values::{Spelling, mutate_bytes, mutate_table, record};
use super::{Outcome, assert_complaint, campaign};
use crate::support::seeded::Draws;

/// A pipeline of each kind and word.
fn pipelines() -> &'static [PipelineSettings] {
    static FOUND: OnceLock<Vec<PipelineSettings>> = OnceLock::new();
    FOUND.get_or_init(|| {
        let mut text = "schema = 1\nname = \"x\"\nduration_s = 2.0\n".to_owned();
        for (index, keys) in [
            "[filter.rls]\ntaps = 2\n",
            "[filter.rls]\ntaps = 3\nnumber_format = \"binary32\"\n",
            "[filter.lms]\nnormalised = true\n",
            "[filter.lms]\nnormalised = false\nstep_size = 1e-9\nallow_unstable = true\n",
            "[filter.sign_lms]\n",
            "[filter.rls]\ntaps = 1\nnumber_format = \"binary64-ftz\"\n",
        ]
        .into_iter()
        .enumerate()
        {
            text.push_str(&format!(
                "[[filter]]\nname = \"f{index}\"\n{keys}pipeline = \"fpga\"\nclock_mhz = 200.0\n"
            ));
        }
        let folder = tempfile::tempdir().expect("a scratch folder");
        let path = crate::support::write(folder.path(), "x.toml", &text);
        let runs = load_suite(&[path], &[]).unwrap_or_else(|errors| panic!("{errors:?}"));
        let filters = runs[0].scenario.filters.iter();
        filters
            .filter_map(|filter| filter.kind.settings().hardware())
            .collect()
    })
}

fn case(draws: &mut Draws, folder: &Path) -> Outcome {
    let count = if draws.chance(0.05) {
        draws.below(3)
    } else {
        4 + draws.below(60)
    };
    let values = record(draws, count);
    let width = if draws.chance(0.8) { 1 } else { 2 };
    let mut lines: Vec<Vec<String>> = values
        .iter()
        .map(|value| vec![format!("{value:?}"); width])
        .collect();
    let first = usize::from(draws.chance(0.4));
    if first > 0 {
        lines.insert(
            0,
            ["rate", "b"][..width]
                .iter()
                .map(|it| (*it).to_owned())
                .collect(),
        );
    }
    mutate_table(draws, &mut lines, first);
    let mut bytes = Spelling::draw(draws).text(&lines).into_bytes();
    if draws.chance(0.2) {
        mutate_bytes(draws, &mut bytes);
    }
    let path = folder.join("stimulus.csv");
    std::fs::write(&path, &bytes).expect("writable");
    let column = (width > 1 || draws.chance(0.05)).then_some("1");
    let samples_max = if draws.chance(0.8) {
        1000
    } else {
        1 + draws.below(20)
    };
    let words = match read_stimulus(&path, column, samples_max) {
        Ok(words) => words,
        Err(error) => {
            assert_complaint(&error.to_string(), "stimulus.csv");
            return Outcome::Refused;
        }
    };
    assert!(!words.is_empty() && words.len() <= samples_max);
    assert!(words.iter().all(|word| word.is_finite()));
    let settings = draws.pick(pipelines());
    let mut filter = settings.filter(0).expect("a sound pipeline");
    for word in &words {
        // What the words grow to is the filter's affair; that it says so is enough.
        if filter.step(*word).is_err() {
            break;
        }
    }
    if !draws.chance(0.04) {
        return Outcome::Measured;
    }
    let form = *draws.pick(&[ExportForm::Vectors, ExportForm::Waveform]);
    let stimulus = Stimulus { words, codes: None };
    match export_pipeline(&folder.join("out"), form, settings, stimulus, 1) {
        Ok(files) => {
            assert!(files.iter().all(|file| file.is_file()));
            Outcome::Measured
        }
        Err(error) => {
            assert!(error.to_string().len() < 300, "{error}");
            Outcome::Read
        }
    }
}

#[test]
fn a_mutated_stimulus_is_exported_or_refused() {
    campaign("stimuli", 400, case);
}
