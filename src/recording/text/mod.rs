//! Numbers in text: lines and their cells, other encodings, columns, rate words written.

pub(super) mod csv;
pub(super) mod decimal;
mod first_rows;
pub(super) mod head;
pub(super) mod lines;
pub(super) mod plain;
pub(super) mod table;
pub(super) mod transcode;
