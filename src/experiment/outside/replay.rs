//! Words that were computed elsewhere, beside the record they are of.

use std::path::Path;

use super::failure::FailureKind;
use super::{Input, OutsideFilter};
use crate::experiment::black_box;
use crate::experiment::channel_filter::{FilterWords, FinishedFilter};
use crate::filters::ReplayFilterConfig;
use crate::metrics::{ChannelFailure, correlation_length_samples};
use crate::recording::read_words;
use crate::seal::digest_of_words;
use crate::signal::{FilterShape, HiddenWeights};
use crate::vocabulary::OutputRegister;
use crate::wording::counted;

/// Why metrics are missing that need the filter to run again.
const NOT_RUN: &str =
    "the words were computed elsewhere: it needs the filter to run again, or its weights";

impl OutsideFilter<'_> {
    /// The channel of words that were computed elsewhere from the input.
    pub(super) fn replay(&self, config: &ReplayFilterConfig, input: &Input) -> FinishedFilter {
        let words = self.replayed(config, input.words_deg_per_h);
        let measured = words
            .as_ref()
            .map_or(&[][..], |words| &words[input.length.warm_up..]);
        let hidden = HiddenWeights {
            reason: NOT_RUN,
            memory_samples: correlation_length_samples(measured).unwrap_or(1),
        };
        let register_samples = config.output_register.samples();
        FinishedFilter {
            name: self.name.clone(),
            kind: None,
            shape: FilterShape::hidden(hidden, register_samples),
            restarts: false,
            words: words.map(|words| FilterWords {
                black_box: black_box::hidden(self.resolved.scenario.trial.black_box, NOT_RUN),
                ..FilterWords::alone(words)
            }),
            pipeline: None,
        }
    }

    fn replayed(
        &self,
        config: &ReplayFilterConfig,
        input_deg_per_h: &[f64],
    ) -> Result<Vec<f64>, ChannelFailure> {
        let digest = digest_of_words(input_deg_per_h);
        if digest != config.input_digest {
            let message = format!(
                "the words of {} were computed from samples with the digest {}, those of this run \
                 have {digest}: compute them from these, which `output.samples = \"npy\"` writes",
                config.samples, config.input_digest
            );
            return Err(FailureKind::OtherInput.failure(0, message));
        }
        let unreadable = |message| FailureKind::Unreadable.failure(0, message);
        let file = self.file("samples");
        let file = file.ok_or_else(|| unreadable(format!("{} was not found", config.samples)))?;
        let samples = input_deg_per_h.len();
        let words = read(&file.path, &config.samples, samples)
            .map_err(|error| unreadable(error.to_string()))?;
        Ok(registered(words, config.output_register))
    }
}

/// Why a file does not hold the words of a record. Messages stand in results, which hold no absolute
/// path.
#[derive(Debug, thiserror::Error)]
pub(in crate::experiment) enum WordsError {
    #[error("{0}")]
    File(String),
    #[error(
        "{shown}: holds {}, the record has {}: expected one word for each, warm-up included",
        counted(*words, "word"),
        counted(*samples, "sample")
    )]
    Length {
        shown: String,
        words: usize,
        samples: usize,
    },
}

/// The words of a file, one for each sample of a record.
///
/// * `shown`: the file as its key names it.
pub(in crate::experiment) fn read(
    path: &Path,
    shown: &str,
    samples: usize,
) -> Result<Vec<f64>, WordsError> {
    let words = read_words(path).map_err(|error| {
        let found = path.display().to_string();
        WordsError::File(error.to_string().replace(&found, shown))
    })?;
    if words.len() == samples {
        return Ok(words);
    }
    Err(WordsError::Length {
        shown: shown.to_owned(),
        words: words.len(),
        samples,
    })
}

/// The words as they appear behind an output register.
pub(super) fn registered(mut words: Vec<f64>, register: OutputRegister) -> Vec<f64> {
    if register == OutputRegister::NextSample && !words.is_empty() {
        words.rotate_right(1);
        words[0] = 0.0;
    }
    words
}
