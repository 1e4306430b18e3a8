//! Logs: how they are read, the parts that are taken, their words.

pub(super) mod facts;
pub(super) mod format;
pub(super) mod gaps;
pub(super) mod motion;
pub(super) mod rates;
pub(super) mod read;
pub(super) mod record;
pub(super) mod rows;
pub(super) mod stream;
pub(super) mod stretches;
pub(super) mod words;
