//! Plans and runs scenarios: the only module that knows every stage.
//!
//! Invariant: wiring only; what a stage does stands in the stage.
