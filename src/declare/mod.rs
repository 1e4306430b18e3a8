//! Declarations of keys: a table of a scenario file is written once, in the stage that works by it.
//!
//! `table!` makes of one declaration the configuration struct with its documentation, how it is read,
//! its value in the reference and a [`Table`] of rows; `alternatives!` does so for tables of which one
//! stands, `renamed!` a key with a former name. Checks, suggestions, JSON Schema and `scenarios/reference.toml` read the rows.
//!
//! Invariant: knows no stage and no file format; every stage may import it.

mod key;
mod kind;
mod row;
mod setting;
mod table;

pub use key::{Key, Keys};
pub use kind::{Content, DIGEST_DIGITS, Integers, Kind, Limits, Range, Shape};
pub use row::{Group, Presence, Row, Successor, Table, Told};
pub(crate) use setting::spelled;
pub use setting::{FromLiteral, Reference, Setting};
pub(crate) use table::{alternatives, renamed, table};
