//! Textbook adaptive filters: the oracle for the hardware pipelines, never called by them.
//!
//! Invariant: a filter sees rate words and its own configuration, nothing else.
