//! Files of samples: what a run or a log keeps of its words, its true rate and its stamps.

use std::borrow::Cow;

use super::{Artefact, Contents, OutputFile};
use crate::signal::RunSignals;
use crate::units::rad_to_arcsec;

/// Samples of the gyros of a run or of a log, and the formats that are asked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Samples<'a, 's> {
    /// Each gyro.
    pub(super) gyros: &'s [RunSignals<'a>],
    /// Whether NPY is asked for.
    pub(super) as_npy: bool,
    /// Whether CSV is asked for.
    pub(super) as_csv: bool,
}

impl<'a, 's> Samples<'a, 's> {
    /// The gyros if NPY is asked for, else none.
    fn npy(&self) -> &'s [RunSignals<'a>] {
        if self.as_npy { self.gyros } else { &[] }
    }
}

/// Name of the file of a channel.
pub(super) const CHANNEL: &str = "samples/<channel>.npy";

/// Name of the file of the digest of the samples that filters are given.
pub(super) const INPUT_DIGEST: &str = "samples/input_digest.toml";

fn npy<'a>(name: String, values: impl Into<Cow<'a, [f64]>>) -> OutputFile<'a> {
    OutputFile {
        name,
        contents: Contents::Npy(values.into()),
    }
}

/// Every channel of every gyro.
pub(super) fn channels<'a>(row: &Artefact, samples: &Samples<'a, '_>) -> Vec<OutputFile<'a>> {
    channels_from(0, row, samples)
}

/// Every channel but the raw one, which a log already is.
pub(super) fn channels_behind_raw<'a>(
    row: &Artefact,
    samples: &Samples<'a, '_>,
) -> Vec<OutputFile<'a>> {
    channels_from(1, row, samples)
}

/// The channels of every gyro from one on, raw being the first.
fn channels_from<'a>(
    first: usize,
    row: &Artefact,
    samples: &Samples<'a, '_>,
) -> Vec<OutputFile<'a>> {
    let channels = samples.npy().iter();
    channels
        .flat_map(|gyro| &gyro.channels[first..])
        .map(|&(name, words)| npy(row.named(name), words))
        .collect()
}

/// The same as text with stamps.
pub(super) fn channels_behind_raw_as_csv<'a>(
    row: &Artefact,
    samples: &Samples<'a, '_>,
) -> Vec<OutputFile<'a>> {
    let mut files = Vec::new();
    for gyro in samples.gyros.iter().filter(|_| samples.as_csv) {
        for &(name, rate_deg_per_h) in &gyro.channels[1..] {
            files.push(OutputFile {
                name: row.named(name),
                contents: Contents::TimedCsv {
                    rate_deg_per_h,
                    sample_period_s: gyro.sample_period_s,
                },
            });
        }
    }
    files
}

/// True rate of every axis.
pub(super) fn truths<'a>(row: &Artefact, samples: &Samples<'a, '_>) -> Vec<OutputFile<'a>> {
    let gyros = samples.npy().iter();
    gyros
        .map(|gyro| npy(row.named(gyro.prefix), gyro.truth_deg_per_h.words()))
        .collect()
}

/// Angle of the encoder: that of the table, whichever gyro stands on it.
pub(super) fn encoder<'a>(row: &Artefact, samples: &Samples<'a, '_>) -> Vec<OutputFile<'a>> {
    let readings_rad = samples.npy().first().and_then(|gyro| gyro.encoder_rad);
    let angles_arcsec = readings_rad.map(|readings_rad| {
        let readings_rad = readings_rad.iter().copied();
        readings_rad.map(rad_to_arcsec).collect::<Vec<_>>()
    });
    angles_arcsec
        .map(|angles_arcsec| npy(row.name.to_owned(), angles_arcsec))
        .into_iter()
        .collect()
}

/// Digest of the words that the filters are given, of a single gyro.
pub(super) fn input_digest<'a>(row: &Artefact, samples: &Samples<'a, '_>) -> Vec<OutputFile<'a>> {
    let digests = samples.npy().iter();
    let digests = digests.filter_map(|gyro| gyro.input_digest.as_deref());
    digests
        .map(|digest| OutputFile::text(row.name, input_digest_toml(digest)))
        .collect()
}

/// The line that says to a filter of the kind `replay` which samples its words are of.
#[must_use]
pub fn input_digest_toml(digest: &str) -> String {
    format!(
        "# BLAKE3 of the samples that the filters are given, as little-endian binary64: for \
         [filter.replay].\ninput_digest = \"{digest}\"\n"
    )
}

/// Stamps, the same for every gyro.
pub(super) fn stamps<'a>(row: &Artefact, samples: &Samples<'a, '_>) -> Vec<OutputFile<'a>> {
    let first = samples.npy().first();
    first
        .map(|gyro| npy(row.name.to_owned(), gyro.stamps_s().collect::<Vec<_>>()))
        .into_iter()
        .collect()
}
