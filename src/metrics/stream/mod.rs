//! Records too long to be kept: what can be measured while their words come in.

pub(super) mod words;
