//! Writing of the files that a report consists of.

use crate::recording::csv_text;
use crate::report::{Contents, OutputFile};
use crate::store::{Staged, StoreError, put_npy};

/// Writes one file into a folder that is being built.
pub(super) fn write_file(folder: &Staged, file: &OutputFile) -> Result<(), StoreError> {
    match &file.contents {
        Contents::Text(text) => folder.write(&file.name, text.as_bytes()),
        Contents::Npy(values) => folder.write_npy(&file.name, values),
        Contents::TimedCsv {
            rate_deg_per_h,
            sample_period_s,
        } => {
            let text = csv_text(rate_deg_per_h, *sample_period_s);
            folder.write(&file.name, text.as_bytes())
        }
    }
}

/// What [`write_file`] would write.
pub(super) fn bytes_of(file: &OutputFile) -> Vec<u8> {
    match &file.contents {
        Contents::Text(text) => text.clone().into_bytes(),
        Contents::Npy(values) => {
            let mut bytes = Vec::new();
            // Memory refuses nothing.
            put_npy(&mut bytes, values)
                .map(|()| bytes)
                .unwrap_or_default()
        }
        Contents::TimedCsv {
            rate_deg_per_h,
            sample_period_s,
        } => csv_text(rate_deg_per_h, *sample_period_s).into_bytes(),
    }
}
