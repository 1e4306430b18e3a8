//! Formats results: JSON, JUnit, SVG, CSV, text.
//!
//! Invariant: formats, does not compute.
