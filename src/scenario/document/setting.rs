//! Values as a program sets them.

use std::sync::Arc;

use crate::scenario::document::tree::{Node, Value};

/// Value of a scenario key: a number, a text, a truth value, or an array of these.
///
/// ```
/// use fogbench::scenario::Setting;
///
/// assert_eq!(Setting::from(0.5).as_toml(), "0.5");
/// assert_eq!(Setting::from("static").as_toml(), "\"static\"");
/// assert_eq!(Setting::from([1.0, 2.0]).as_toml(), "[1.0, 2.0]");
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Setting(Value);

impl Setting {
    /// The value of a document.
    pub(crate) fn into_value(self) -> Value {
        self.0
    }

    /// The value as a scenario file spells it.
    #[must_use]
    pub fn as_toml(&self) -> String {
        self.0.to_toml()
    }
}

impl From<f64> for Setting {
    fn from(number: f64) -> Self {
        Self(Value::Float(number))
    }
}

impl From<i64> for Setting {
    fn from(number: i64) -> Self {
        Self(Value::Integer(number))
    }
}

impl From<i32> for Setting {
    fn from(number: i32) -> Self {
        i64::from(number).into()
    }
}

impl From<u32> for Setting {
    fn from(number: u32) -> Self {
        i64::from(number).into()
    }
}

impl From<usize> for Setting {
    /// Counts beyond 63 bits are set as the largest number that a file can hold, which no key takes.
    fn from(count: usize) -> Self {
        i64::try_from(count).unwrap_or(i64::MAX).into()
    }
}

impl From<bool> for Setting {
    fn from(is_on: bool) -> Self {
        Self(Value::Boolean(is_on))
    }
}

impl From<&str> for Setting {
    fn from(text: &str) -> Self {
        Self(Value::Text(text.to_owned()))
    }
}

impl From<String> for Setting {
    fn from(text: String) -> Self {
        Self(Value::Text(text))
    }
}

impl<T: Into<Setting>> FromIterator<T> for Setting {
    fn from_iter<I: IntoIterator<Item = T>>(elements: I) -> Self {
        let nodes = elements.into_iter().map(|element| Node {
            value: element.into().0,
            mark: None,
        });
        Self(Value::Array(Arc::new(nodes.collect())))
    }
}

impl<T: Into<Setting>> From<Vec<T>> for Setting {
    fn from(elements: Vec<T>) -> Self {
        elements.into_iter().collect()
    }
}

impl<T: Into<Setting>, const N: usize> From<[T; N]> for Setting {
    fn from(elements: [T; N]) -> Self {
        elements.into_iter().collect()
    }
}
