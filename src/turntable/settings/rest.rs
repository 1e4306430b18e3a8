//! The table at rest.

use crate::declare::table;

table! {
    /// Nothing to set.
    pub struct StaticConfig {
    }
}
