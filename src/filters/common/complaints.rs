//! Complaints about the settings of a filter.

/// A key that is to blame and what is wrong with it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Complaint {
    /// Path of the key, of its table where no key alone is to blame.
    pub key: String,
    /// The complaint; it begins with the path.
    pub message: String,
}

/// Complaints about the settings of one filter.
#[derive(Clone, Debug)]
pub struct Complaints {
    table: String,
    found: Vec<Complaint>,
}

impl Complaints {
    /// No complaint yet about the settings in a table.
    #[must_use]
    pub fn about(table: String) -> Self {
        Self {
            table,
            found: Vec::new(),
        }
    }

    /// Blames a key of the table; the message goes on behind its path.
    pub fn key(&mut self, key: &str, message: &str) {
        let key = format!("{}.{key}", self.table);
        let message = format!("{key} {message}");
        self.found.push(Complaint { key, message });
    }

    /// Blames the table as a whole.
    pub fn table(&mut self, message: &str) {
        let key = self.table.clone();
        let message = format!("{key}: {message}");
        self.found.push(Complaint { key, message });
    }

    /// The complaints in the order in which they came.
    #[must_use]
    pub fn found(self) -> Vec<Complaint> {
        self.found
    }
}
