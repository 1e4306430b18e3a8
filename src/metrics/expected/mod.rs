//! What the figures of a record are expected to be, and how far records scatter about that.

pub(super) mod allan;
pub(super) mod blocks;
pub(super) mod channel;
