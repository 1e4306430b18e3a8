//! Numbers with their intervals, and the table of one channel that holds them.

pub(super) mod blocks;
pub(super) mod fit_sheet;
pub(super) mod influence;
pub(super) mod interval;
pub(super) mod magnitude;
pub(super) mod missing;
pub(super) mod outlier_sheet;
pub(super) mod paired;
pub(super) mod reason;
pub(super) mod repeat_statistics;
pub(super) mod table;
pub(super) mod text;
pub(super) mod two_runs;
pub(super) mod value;
